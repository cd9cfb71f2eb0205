//! Sewing of triangle meshes that come without surfaces: section 8 of Kahlesz, Balázs and Klein 2001, NURBS
//! Rendering in OpenSG Plus.
//!
//! ```text
//!   boundaries ([`boundary`])    border edges in chains; vertices in which chains touch are separated
//!   closest points ([`closest`]) per border vertex, the nearest point of each border within the tolerance
//!   tracking ([`track`])         proximities along both borders, without folds; vertices between two
//!                                correspondences get theirs by length (the common reparametrisation)
//!   sites ([`sites`])            what corresponds on all borders, however many, becomes one site
//!   joining ([`join`])           new vertices split triangles; corresponding ones meet in their middle
//!   shells ([`shells`])          joined meshes get a common orientation
//! ```
//!
//! The paper reparametrises a common border by its whole length. Here this is done between neighbouring
//! correspondences: differences in length do not add up, and no vertex moves by more than the tolerance. A
//! pair that would move a vertex further is rejected, and its edges stay open. In place of a grid there is a
//! tree of boxes.

mod boundary;
mod closest;
mod join;
mod shells;
mod sites;
mod track;

use crate::foot::segment_distance;
use crate::gaps::{AutoTolerance, CLEAR, LARGEST_GAP, RESOLUTION, choose_below};
use crate::run::SewTolerance;
use boundary::Boundaries;
use chordal_nurbs::Box3;
use closest::Approaches;
use glam::DVec3;

/// The sewn mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SewnMesh {
    /// The vertices.
    pub positions: Vec<DVec3>,
    /// Indices into `positions`.
    pub triangles: Vec<[u32; 3]>,
    /// Per triangle, the given triangle that it is (a part of).
    pub sources: Vec<u32>,
    /// Per triangle, its connected shell.
    pub shells: Vec<u32>,
}

/// A border that stays open.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OpenBorder {
    /// How many edges it has.
    pub edges: usize,
    /// The sum of their lengths.
    pub length: f64,
    /// Of the middles of its edges, the smallest and the largest distance from another open edge that is no
    /// neighbour; `None` where there is no other.
    pub nearest: Option<[f64; 2]>,
    /// A point of it.
    pub at: DVec3,
}

/// What sewing a mesh did; lengths in its own unit.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshSewReport {
    /// The merge tolerance.
    pub tolerance: f64,
    /// How the tolerance was found, if it was not given.
    pub auto: Option<AutoTolerance>,
    /// Edges with a single triangle before.
    pub open_before: usize,
    /// The borders that these edges form.
    pub borders: usize,
    /// Stretches along which two borders were sewn.
    pub sewn: usize,
    /// Vertices inserted into borders.
    pub inserted: usize,
    /// Vertices that were merged into others.
    pub merged: usize,
    /// Correspondences that were rejected, because a vertex would have moved too far or a triangle vanished.
    pub refused: usize,
    /// Edges with a single triangle afterwards.
    pub open_after: usize,
    /// The borders that stay open, the longest first.
    pub open: Vec<OpenBorder>,
    /// The largest distance that a vertex was moved by.
    pub largest_move: f64,
    /// Given triangles with two corners in one place, which are omitted.
    pub degenerate: usize,
    /// Triangles whose normal was turned by more than a right angle.
    pub folded: usize,
    /// Triangles that were turned over to agree with their neighbours.
    pub turned: usize,
    /// Edges along which triangles still run the same way, or more than two meet.
    pub inconsistent: usize,
    /// Connected shells.
    pub shells: usize,
    /// Shells without an open edge.
    pub closed_shells: usize,
}

/// Sews the borders of a mesh to each other.
///
/// Corners are the same vertex where they have the same index. No vertex moves by more than the tolerance.
/// `unit` is the finest length that the coordinates can hold (of 32-bit files more than that of the numbers
/// here).
pub fn sew_mesh(
    positions: &[DVec3],
    triangles: &[[u32; 3]],
    tolerance: SewTolerance,
    resolution: Option<f64>,
) -> (SewnMesh, MeshSewReport) {
    let mut report = MeshSewReport::default();
    let boundaries = Boundaries::new(positions, triangles);
    report.degenerate = boundaries.degenerate;
    report.open_before = boundaries.edges();
    report.borders = boundaries.all.len();
    report.auto = match tolerance {
        SewTolerance::Auto => survey(&boundaries, resolution),
        SewTolerance::Length(_) => None,
    };
    report.tolerance = match tolerance {
        SewTolerance::Length(length) => length,
        SewTolerance::Auto => report.auto.as_ref().map_or(0.0, |a| a.tolerance),
    };
    let usable = report.tolerance > 0.0 && report.tolerance.is_finite();
    let joints = if usable {
        let approaches = Approaches::new(&boundaries, report.tolerance);
        track::joints(&boundaries, &approaches, report.tolerance)
    } else {
        track::Joints::default()
    };
    report.sewn = joints.stretches;
    let joined = join_in_attempts(&boundaries, &joints, &mut report);
    let mesh = shells::finish(joined, &mut report);
    (mesh, report)
}

/// Joins what corresponds; what would move a vertex too far, or collapse a triangle, is rejected from the
/// start in another attempt.
fn join_in_attempts(
    boundaries: &Boundaries,
    joints: &track::Joints,
    report: &mut MeshSewReport,
) -> join::Joined {
    let mut refused = sites::Refused::default();
    for _ in 1..ATTEMPTS {
        let sites = sites::Sites::new(boundaries, joints, report.tolerance, &refused);
        let joined = join::join(boundaries, &sites, report.tolerance, report);
        if report.refused == 0 {
            return joined;
        }
        refused.merges.extend(joined.refused.merges);
        refused.insertions.extend(joined.refused.insertions);
    }
    let sites = sites::Sites::new(boundaries, joints, report.tolerance, &refused);
    join::join(boundaries, &sites, report.tolerance, report)
}

/// Attempts at joining. Usually the attempt after a rejection has no further rejection; the last attempt
/// leaves rejected pairs open.
const ATTEMPTS: usize = 4;

/// A border that turns by more than this (cosine) at a vertex has a corner there.
const CORNER: f64 = 0.85;
/// The share of chords whose sagitta the mesh is judged by: the longest few may be what tessellation got
/// wrong.
const TYPICAL: f64 = 0.95;

/// The distance of the chords of the borders from the curves that they approximate: a vertex is four times as
/// far from the chord of its neighbours. Two meshes of one curve, with vertices at different places, cannot
/// meet any better.
fn chord_sag(boundaries: &Boundaries) -> f64 {
    let mut sags = Vec::new();
    for border in &boundaries.all {
        let n = border.vertices.len();
        let at = |i: usize| boundaries.point(border.vertices[i % n]);
        let ends = if border.closed { 0 } else { 1 };
        for i in ends..n.saturating_sub(ends) {
            let (before, here, after) = (at(i + n - 1), at(i), at(i + 1));
            let (a, b) = ((here - before).normalize_or_zero(), (after - here).normalize_or_zero());
            if a.dot(b) > CORNER {
                sags.push(0.25 * segment_distance(here, before, after).0);
            }
        }
    }
    sags.sort_unstable_by(f64::total_cmp);
    sags.get(((sags.len() as f64 * TYPICAL) as usize).min(sags.len().saturating_sub(1)))
        .copied()
        .unwrap_or(0.0)
}

/// How far the borders of a mesh are from each other, if that is more than the coordinates and the chords of
/// the mesh can hold.
fn survey(boundaries: &Boundaries, resolution: Option<f64>) -> Option<AutoTolerance> {
    let box3 = Box3::from_points(boundaries.positions.iter().copied());
    let sag = 2.0 * chord_sag(boundaries);
    let resolution =
        if sag > resolution.unwrap_or(RESOLUTION * box3.diagonal()) { Some(sag) } else { resolution };
    let mut gaps = closest::nearest_gaps(boundaries);
    if gaps.is_empty() {
        return None;
    }
    gaps.sort_unstable_by(f64::total_cmp);
    // The range without gaps must lie above the distances that chords of this length cause.
    let cap = (LARGEST_GAP * box3.diagonal()).max(CLEAR * CLEAR * sag);
    Some(choose_below(&gaps, resolution, box3.diagonal(), cap))
}
