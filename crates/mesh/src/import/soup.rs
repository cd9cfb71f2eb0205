//! The triangles of a file as read.

use glam::DVec3;
use std::ops::Range;

/// Named triangles of a soup.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SoupGroup {
    /// The name in the file; may be empty.
    pub name: String,
    /// Its triangles, as indices into [`TriangleSoup::triangles`].
    pub triangles: Range<usize>,
}

/// Triangles as a file holds them, in the file's own unit and axes.
#[derive(Clone, Debug, PartialEq)]
pub struct TriangleSoup {
    /// The vertices, in the file's unit and axes.
    pub positions: Vec<DVec3>,
    /// Indices into `positions`, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Solids, objects or placed meshes; together they cover all triangles, in order.
    pub groups: Vec<SoupGroup>,
    /// Per triangle the index of its exact face, −1 for none; empty if the file has no face ids.
    pub face_ids: Vec<i64>,
    /// The length of the file's unit in millimetres, if the file or its format states it.
    pub unit_mm: Option<f64>,
    /// Whether Y points up instead of Z.
    pub y_up: bool,
}

impl TriangleSoup {
    /// The same triangles in millimetres (if the unit is known) and with Z up.
    pub fn into_millimetres_z_up(mut self) -> Self {
        let scale = self.unit_mm.unwrap_or(1.0);
        let turn = |p: DVec3| if self.y_up { DVec3::new(p.x, -p.z, p.y) } else { p };
        self.positions.iter_mut().for_each(|p| *p = turn(*p) * scale);
        self.unit_mm = self.unit_mm.map(|_| 1.0);
        self.y_up = false;
        self
    }
}
