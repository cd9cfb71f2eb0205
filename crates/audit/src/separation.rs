//! Pairs of faces whose facets cannot cut each other, found without a look at pairs of facets.
//!
//! Most neighbours of a plane face lie on one side of its plane and touch it along their common edge:
//!
//! ```text
//!     │ │  other face        every vertex of the other face is one of the plane face, or clearly beside its
//!     │ │                    plane, always on the same side; no facet of it lies in the plane, and no side
//!   ──●─●──────── plane      that is not one of the plane face as well
//! ```
//!
//! Facets of the two then meet at the vertices that they share, and nowhere else: above the plane there is no
//! facet of the one, and in it nothing of the other but these vertices and the lines between them. "Clearly"
//! is a million times what the vertices of the plane face themselves lie off the plane, so that a cut that
//! this overlooks is no deeper than their rounding.

use crate::halves::half_key;
use chordal_brep::{FaceGeometry, Part};
use chordal_mesh::{FaceMesh, PartMesh};
use chordal_nurbs::{Box3, DVec3, Surface};
use std::sync::OnceLock;

/// Points further from the plane than this multiple of the distance of its own vertices are beside it.
const CLEAR: f64 = 1e6;

/// The rounding error of a height over a plane, relative to the coordinates.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// A face that its facets show to be plane.
pub(crate) struct PlaneFace<'a> {
    mesh: &'a FaceMesh,
    origin: DVec3,
    normal: DVec3,
    /// Beyond this, a height over the plane is clear.
    clear: f64,
    /// The positions of its vertices, in order.
    positions: Vec<u32>,
    /// The keys of the sides of its facets, in order.
    sides: OnceLock<Vec<u64>>,
}

/// The key of the side of a facet opposite a corner.
fn side_key(mesh: &FaceMesh, t: &[u32; 3], opposite: usize) -> u64 {
    let [a, b] = [1, 2].map(|k| mesh.corners[t[(opposite + k) % 3] as usize].position);
    half_key(a, b).0
}

impl<'a> PlaneFace<'a> {
    /// `None` for a face on another surface.
    pub fn new(part: &Part, mesh: &'a PartMesh, face: usize) -> Option<Self> {
        let FaceGeometry::Surface(surface) = &part.faces[face].geometry else { return None };
        let Surface::Plane { frame } = surface.as_ref() else { return None };
        let mut plane = Self {
            mesh: &mesh.faces[face],
            origin: frame.origin,
            normal: frame.z,
            clear: 0.0,
            positions: Vec::new(),
            sides: OnceLock::new(),
        };
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
        sides != [true, true] && (in_plane < 2 || self.has_all_in_plane(other, positions))
    }

    /// True where the other face has no facet in the plane, and no side in it that this face does not have.
    fn has_all_in_plane(&self, other: &FaceMesh, positions: &[DVec3]) -> bool {
        let is_in_plane = |c: &u32| {
            let position = other.corners[*c as usize].position;
            self.height(positions[position as usize]).abs() <= self.clear
        };
        other.triangles.iter().all(|t| {
            let mut out = (0..3).filter(|&i| !is_in_plane(&t[i]));
            match (out.next(), out.next()) {
                (None, _) => false,
                (Some(opposite), None) => self.sides().binary_search(&side_key(other, t, opposite)).is_ok(),
                _ => true,
            }
        })
    }

    fn sides(&self) -> &[u64] {
        self.sides.get_or_init(|| {
            let of_facet = |t: &[u32; 3]| [0, 1, 2].map(|i| side_key(self.mesh, t, i));
            let mut sides: Vec<u64> = self.mesh.triangles.iter().flat_map(of_facet).collect();
            sides.sort_unstable();
            sides
        })
    }
}
