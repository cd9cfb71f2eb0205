//! What a mesh must keep: lengths and angles in the units of the part, and how a facet is judged by them.

use chordal_brep::Part;
use chordal_nurbs::{DVec3, math};

/// How the error of a facet is judged.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Bound {
    /// By an upper bound: the tolerance is guaranteed.
    #[default]
    Proven,
    /// By samples, as in most meshers: faster, without a guarantee.
    Estimated,
}

/// What an edge of the mesh must not exceed, in the part's units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Distance of facets inside a face.
    pub tolerance: f64,
    /// Sagitta of a chord of the model's edges, and distance of the facets that touch one where that is
    /// larger.
    pub boundary: f64,
    /// Turn of the normal between the ends of an edge, radians.
    pub angle: f64,
    /// Length of an edge.
    pub length: f64,
}

impl Limits {
    /// The largest distance that any facet may have.
    pub fn largest(&self) -> f64 {
        self.tolerance.max(self.boundary)
    }
}

/// Edges shorter than this share of the tolerance may turn by any angle. At a singular point the surface
/// turns within no distance at all, so refining would not end. A larger share leaves visible kinks in the
/// shading.
pub const TURN_LENGTH: f64 = 0.1;

/// True where two unit normals enclose more than `limit`, in radians. A zero vector stands for an undefined
/// normal, which encloses no angle with anything.
pub(crate) fn turns_too_far(n: DVec3, m: DVec3, limit: f64) -> bool {
    limit < std::f64::consts::PI
        && n != DVec3::ZERO
        && m != DVec3::ZERO
        && n.dot(m) < math::cos(limit * (1.0 + 1e-9)) - 1e-12
}

/// Points nearer to each other than this share of the tolerance are one point: poles, vertices on them,
/// pcurves that agree with their edge. A larger share would take a visible part of the tolerance, a smaller
/// one is below what files keep.
const SAME_POINT: f64 = 0.02;

/// One point is also smaller than this share of the part, so that a coarse tolerance merges nothing.
const SAME_POINT_OF_PART: f64 = 1e-6;

/// Points of the part nearer together than this are one point.
pub fn resolution(part: &Part, tolerance: f64) -> f64 {
    (SAME_POINT * tolerance).min(SAME_POINT_OF_PART * diagonal(part))
}

/// The diagonal of the box of a part's vertices; infinite where they span none.
fn diagonal(part: &Part) -> f64 {
    let low = part.vertices.iter().fold(DVec3::INFINITY, |m, v| m.min(v.point));
    let high = part.vertices.iter().fold(DVec3::NEG_INFINITY, |m, v| m.max(v.point));
    if low.is_finite() && high != low { (high - low).length() } else { f64::INFINITY }
}
