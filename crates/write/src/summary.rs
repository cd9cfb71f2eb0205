//! What was written, and what rounding did to it.

use crate::{WriteError, WriteOptions};
use glam::{DVec3, Vec3};

/// The share of the tolerance that rounding may eat without a warning.
const ROUNDING_SHARE: f64 = 0.1;

/// What a writer wrote.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WriteSummary {
    /// Triangles, with every instance counted.
    pub triangles: u64,
    /// Vertex records in the file: 3 per triangle in STL, once per mesh (not per instance) in GLB and 3MF.
    pub vertices: u64,
    /// Bytes of the mesh file.
    pub bytes: u64,
    /// The largest distance in millimetres by which rounding to 32 bits moved a vertex; 0 for 64-bit formats.
    pub rounding_mm: f64,
    /// Whether a triangle has two corners at one place after rounding.
    pub collapsed: bool,
    /// Sentences for the user.
    pub warnings: Vec<String>,
}

/// Counts while a writer runs.
#[derive(Debug, Default)]
pub(crate) struct Tally {
    pub triangles: u64,
    pub vertices: u64,
    pub collapsed: u64,
    pub rounding_mm: f64,
    pub warnings: Vec<String>,
}

impl Tally {
    /// The nearest 32-bit point; `mm` is the length of the file's unit in millimetres.
    pub fn round(&mut self, p: DVec3, mm: f64) -> Vec3 {
        let rounded = p.as_vec3();
        self.rounding_mm = self.rounding_mm.max((rounded.as_dvec3() - p).length() * mm);
        rounded
    }

    pub fn count_triangle<P: PartialEq>(&mut self, [a, b, c]: [P; 3]) {
        self.triangles += 1;
        self.collapsed += u64::from(a == b || b == c || c == a);
    }

    pub fn finish(mut self, bytes: u64, options: &WriteOptions) -> WriteSummary {
        self.warn_of_rounding(options);
        if self.collapsed > 0 {
            let s = if self.collapsed == 1 { "triangle has" } else { "triangles have" };
            self.warnings.push(format!("{} {s} two corners at the same place in the file", self.collapsed));
        }
        if self.triangles == 0 {
            self.warnings.push("the file holds no triangle".to_owned());
        }
        WriteSummary {
            triangles: self.triangles,
            vertices: self.vertices,
            bytes,
            rounding_mm: self.rounding_mm,
            collapsed: self.collapsed > 0,
            warnings: self.warnings,
        }
    }

    fn warn_of_rounding(&mut self, options: &WriteOptions) {
        let Some(tolerance) = options.tolerance_mm else { return };
        if self.rounding_mm > ROUNDING_SHARE * tolerance {
            let percent = 100.0 * self.rounding_mm / tolerance;
            self.warnings.push(format!(
                "rounding to the 32-bit numbers of {} moves vertices by up to {:.3e} mm, {percent:.0} % of the tolerance; \
                 PLY, OBJ and 3MF keep 64 bits",
                options.format, self.rounding_mm
            ));
        }
    }
}

/// An error where a point is infinite or not a number.
pub(crate) fn finite(p: DVec3, part: &str, options: &WriteOptions) -> Result<DVec3, WriteError> {
    // The largest 32-bit float; beyond half an ulp above it rounding gives infinity.
    let limit = if options.format.is_single_precision() { f64::from(f32::MAX) } else { f64::MAX };
    if p.abs().max_element() <= limit && p.is_finite() {
        Ok(p)
    } else {
        let format = options.format;
        Err(WriteError::NotFinite { part: part.to_owned(), format, x: p.x, y: p.y, z: p.z })
    }
}
