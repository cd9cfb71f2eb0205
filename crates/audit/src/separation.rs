//! Pairs of faces whose facets cannot cut each other, found without a look at pairs of facets.
//!
//! Most neighbours of a plane face lie on one side of its plane and touch it along their common edge:
//!
//! ```text
//!     │ │  other face        every vertex of the other face is one of the plane face, or clearly beside its
//!     │ │                    plane, always on the same side; and no facet of it lies in the plane
//!   ──●─●──────── plane
//! ```
//!
//! Facets of the two then meet at the vertices that they share, and nowhere else: above the plane there is no
//! facet of the one, and in it nothing of the other but these vertices and the lines between them. "Clearly"
//! is a million times what the vertices of the plane face themselves lie off the plane, so that a cut that
//! this overlooks is no deeper than their rounding.

use chordal_brep::{FaceGeometry, Part};
use chordal_mesh::{FaceMesh, PartMesh};
use chordal_nurbs::{Box3, DVec3, Surface};

/// Points further from the plane than this multiple of the distance of its own vertices are beside it.
const CLEAR: f64 = 1e6;

/// The rounding error of a height over a plane, relative to the coordinates.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// A face that its facets show to be plane.
pub(crate) struct PlaneFace {
    origin: DVec3,
    normal: DVec3,
    /// Beyond this, a height over the plane is clear.
    clear: f64,
    /// The positions of its vertices, in order.
    positions: Vec<u32>,
}

impl PlaneFace {
    /// `None` for a face on another surface.
    pub fn new(part: &Part, mesh: &PartMesh, face: usize) -> Option<Self> {
        let FaceGeometry::Surface(surface) = &part.faces[face].geometry else { return None };
        let Surface::Plane { frame } = surface.as_ref() else { return None };
        let mut plane = Self { origin: frame.origin, normal: frame.z, clear: 0.0, positions: Vec::new() };
        let mut off = 0.0f64;
        for corner in &mesh.faces[face].corners {
            let p = mesh.positions[corner.position as usize];
            let magnitude = p.abs().max_element() + frame.origin.abs().max_element();
            off = off.max(plane.height(p).abs() + ROUNDING * magnitude);
            plane.positions.push(corner.position);
        }
        plane.clear = CLEAR * off;
        plane.positions.sort_unstable();
        Some(plane)
    }

    fn height(&self, p: DVec3) -> f64 {
        self.normal.dot(p - self.origin)
    }

    /// True where no facet of another face can cut one of this face.
    pub fn is_beside(&self, other: &FaceMesh, bounds: &Box3, positions: &[DVec3]) -> bool {
        let middle = self.height(bounds.center());
        let reach = self.normal.abs().dot(0.5 * (bounds.max - bounds.min));
        if middle.abs() > reach + self.clear {
            return true;
        }
        let mut sides = [false; 2];
        let mut in_plane = 0;
        for corner in &other.corners {
            let height = self.height(positions[corner.position as usize]);
            if height.abs() <= self.clear {
                in_plane += 1;
                if self.positions.binary_search(&corner.position).is_err() {
                    return false;
                }
            } else {
                sides[usize::from(height > 0.0)] = true;
            }
        }
        let is_in_plane = |c: &u32| {
            let position = other.corners[*c as usize].position;
            self.height(positions[position as usize]).abs() <= self.clear
        };
        sides != [true, true] && (in_plane < 3 || !other.triangles.iter().any(|t| t.iter().all(is_in_plane)))
    }
}
