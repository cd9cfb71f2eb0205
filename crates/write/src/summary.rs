//! What was written, and how far rounding moved it.

use crate::{WriteError, WriteOptions, WriteWarning};
use glam::{DVec3, Vec3};

/// The share of the tolerance by which rounding may move a vertex without a warning.
///
/// A tenth is lost in the noise of most uses, and the mesher keeps back a margin for it. A larger value would
/// let a file miss its tolerance unnoticed; a smaller one would warn about nearly every STL file.
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
    /// Warnings about the file, for its user.
    pub warnings: Vec<WriteWarning>,
}

/// Counts while a writer runs.
#[derive(Debug, Default)]
pub(crate) struct Tally {
    pub triangles: u64,
    pub vertices: u64,
    pub collapsed: u64,
    pub rounding_mm: f64,
    pub warnings: Vec<WriteWarning>,
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
            self.warnings.push(WriteWarning::Collapsed { triangles: self.collapsed });
        }
        if self.triangles == 0 {
            self.warnings.push(WriteWarning::Empty);
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
        let Some(tolerance_mm) = options.tolerance_mm else { return };
        let (format, rounding_mm) = (options.format, self.rounding_mm);
        if rounding_mm > ROUNDING_SHARE * tolerance_mm {
            self.warnings.push(WriteWarning::Rounding { format, rounding_mm, tolerance_mm });
        }
    }
}

/// The point itself.
///
/// # Errors
/// If a coordinate is infinite, not a number, or too large for the format's floats.
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
