//! Builds a soup, welding points whose coordinates agree in every bit.

use super::error::ImportFault;
use super::soup::{SoupGroup, TriangleSoup};
use glam::{DAffine3, DVec3};
use rustc_hash::FxHashMap;

#[derive(Debug, Default)]
pub(super) struct Builder {
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    groups: Vec<SoupGroup>,
    face_ids: Vec<i64>,
    /// The points of the present domain.
    known: FxHashMap<[u64; 3], u32>,
    pub unit_mm: Option<f64>,
    pub y_up: bool,
}

impl Builder {
    /// Starts a named group; points weld only within one.
    pub fn group(&mut self, name: &str) {
        self.close();
        self.known.clear();
        let start = self.triangles.len();
        self.groups.push(SoupGroup { name: name.to_owned(), triangles: start..start });
    }

    /// Ends the present group; an empty one is forgotten.
    fn close(&mut self) {
        let end = self.triangles.len();
        if let Some(last) = self.groups.last_mut() {
            last.triangles.end = end;
        }
        if self.groups.last().is_some_and(|g| g.triangles.is_empty()) {
            self.groups.pop();
        }
    }

    /// The index of a point.
    pub fn point(&mut self, p: DVec3) -> Result<u32, ImportFault> {
        if !p.is_finite() {
            return Err(ImportFault::NotFinite { point: p.to_array() });
        }
        if self.groups.is_empty() {
            self.group("");
        }
        // Adding zero turns −0 into 0, which is the same place.
        let bits = (p + DVec3::ZERO).to_array().map(f64::to_bits);
        let next = u32::try_from(self.positions.len()).map_err(|_| ImportFault::TooManyVertices)?;
        let index = *self.known.entry(bits).or_insert(next);
        if index == next {
            self.positions.push(p + DVec3::ZERO);
        }
        Ok(index)
    }

    pub fn triangle(&mut self, corners: [u32; 3]) {
        self.triangles.push(corners);
    }

    /// A triangle of a known face (−1: of none). All triangles before it without one get −1.
    pub fn face_triangle(&mut self, corners: [u32; 3], face: i64) {
        self.face_ids.resize(self.triangles.len(), -1);
        self.triangle(corners);
        self.face_ids.push(face);
    }

    pub fn finish(mut self) -> Result<TriangleSoup, ImportFault> {
        self.close();
        if self.triangles.is_empty() {
            return Err(ImportFault::NoTriangles);
        }
        if !self.face_ids.is_empty() {
            self.face_ids.resize(self.triangles.len(), -1);
        }
        Ok(TriangleSoup {
            positions: self.positions,
            triangles: self.triangles,
            groups: self.groups,
            face_ids: self.face_ids,
            unit_mm: self.unit_mm,
            y_up: self.y_up,
        })
    }
}

/// Whether a transform reverses orientation, so that triangles must be reversed with it.
pub(super) fn reverses(t: &DAffine3) -> bool {
    t.matrix3.determinant() < 0.0
}
