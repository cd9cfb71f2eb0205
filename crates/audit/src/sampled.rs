//! A second look at the error bound, by points: what is measured must not exceed what is proven.
//!
//! The bounds that [`crate::prove`] recomputes come from `chordal_nurbs::facet_bound`, which the mesher uses
//! as well: a fault in it would pass both. So a share of the facets of each face, picked by their place in
//! the list, and its largest facet are measured: points of the exact surface over the facet, at a lattice of
//! its parameters, must be within the face's error of the facet. Evaluation of the surface is all that this
//! shares with the bound.
//!
//! A point beyond its own facet may lie over a neighbour; where the distance from the facet is too large, the
//! distance from the whole mesh of the face decides. Points are no proof that a bound holds, and a bound that
//! is a little too small may pass; one that is wrong by more than what lies between lattice points does not.

use crate::boundary::{Boundary, BoundaryChord};
use crate::chart::Chart;
use crate::context::Context;
use crate::findings::{FaceFindings, Log};
use crate::triangle_tree::{TriangleTree, closest_point};
use chordal_brep::AuditIssue;
use chordal_nurbs::{DVec2, DVec3, Surface};
use rayon::prelude::*;
use rustc_hash::FxHashSet;

/// One facet of so many is measured: at 15 points a facet this is one evaluation for four facets, about a
/// percent of what meshing them takes.
const STRIDE: usize = 64;

/// Parts into which the lattice divides each side of a facet; even, so that the middles of sides are in it.
const PARTS: usize = 4;

/// Measured distances may exceed the error by this share of the tolerance: rounding on surfaces that are
/// evaluated from large numbers, and far below what a wrong bound is wrong by.
const NEGLIGIBLE: f64 = 1e-4;

/// Measures facets where the face's error is proven.
pub(crate) fn check_samples(
    context: &Context<'_>,
    chart: &Chart<'_>,
    bounds: &Boundary,
    found: &FaceFindings,
    log: &mut Log<'_>,
) {
    let claimed = context.claim(log.index).map_or(f64::INFINITY, |c| c.proven_error);
    let limit = found.error.min(if claimed.is_nan() { f64::INFINITY } else { claimed });
    if !limit.is_finite() || matches!(chart.surface, Surface::Plane { .. }) {
        return;
    }
    let limit = limit + (NEGLIGIBLE * context.options.tolerance).max(4.0 * chart.rounding);
    let measured = farthest(chart, bounds, limit);
    if measured > limit {
        log.add(AuditIssue::BoundExceeded { proven: context.mm(limit), measured: context.mm(measured) });
    }
}

/// The largest distance of a measured point from the mesh of the face; zero where none is beyond `limit`.
fn farthest(chart: &Chart<'_>, bounds: &Boundary, limit: f64) -> f64 {
    let n = chart.mesh.triangles.len();
    let mut picked: Vec<usize> = (STRIDE / 2..n).step_by(STRIDE).chain(largest(chart)).collect();
    picked.dedup();
    let side = |c: &BoundaryChord| (c.half.triangle, c.half.side);
    let chords: FxHashSet<(u32, u8)> = bounds.chords.iter().map(side).collect();
    let measure = |&t: &usize| Measured::new(chart, t, &chords)?.points_beyond(chart, limit);
    let beyond: Vec<Vec<(DVec3, f64)>> = picked.par_iter().with_min_len(16).filter_map(measure).collect();
    if beyond.is_empty() {
        return 0.0;
    }
    let triangles = chart.mesh.triangles.iter().map(|t| t.map(|c| chart.xyz[c as usize])).collect();
    let all = TriangleTree::new(triangles);
    beyond.iter().flatten().map(|&(p, own)| all.distance(p, own)).fold(0.0, f64::max)
}

/// The facet with the largest area.
fn largest(chart: &Chart<'_>) -> Option<usize> {
    let area = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|c| chart.xyz[c as usize]);
        (b - a).cross(c - a).length_squared()
    };
    let all = chart.mesh.triangles.iter().map(area).enumerate();
    all.reduce(|best, next| if next.1 > best.1 { next } else { best }).map(|(t, _)| t)
}

/// A facet to be measured.
struct Measured {
    uv: [DVec2; 3],
    xyz: [DVec3; 3],
    /// Of each side (opposite corner i), whether the face ends there.
    ends: [bool; 3],
}

impl Measured {
    /// `None` for the sectors at poles, which are bounded by other parameters than their corners'.
    fn new(chart: &Chart<'_>, triangle: usize, chords: &FxHashSet<(u32, u8)>) -> Option<Self> {
        let t = &chart.mesh.triangles[triangle];
        if t.iter().any(|&c| chart.pole_axis(c).is_some()) {
            return None;
        }
        Some(Self {
            uv: t.map(|c| chart.mesh.corners[c as usize].uv),
            xyz: t.map(|c| chart.xyz[c as usize]),
            ends: [0, 1, 2].map(|side| chords.contains(&(triangle as u32, side))),
        })
    }

    /// The points over the facet that are farther from it than `limit`, with their distances; `None` where
    /// none is.
    fn points_beyond(&self, chart: &Chart<'_>, limit: f64) -> Option<Vec<(DVec3, f64)>> {
        let lattice = (0..=PARTS).flat_map(|i| (0..=PARTS - i).map(move |j| (i, j)));
        let at = |(i, j): (usize, usize)| {
            let w = [i, j, PARTS - i - j].map(|k| k as f64 / PARTS as f64);
            let p = chart.point(self.uv[0] * w[0] + self.uv[1] * w[1] + self.uv[2] * w[2]);
            (p, self.distance(p))
        };
        let beyond: Vec<(DVec3, f64)> = lattice.map(at).filter(|&(_, d)| d > limit).collect();
        (!beyond.is_empty()).then_some(beyond)
    }

    /// The distance of a point from the facet. Across a side at which the face ends, the facet goes on in its
    /// plane: the straight line between two parameters may lie outside the face, where there is no mesh.
    fn distance(&self, p: DVec3) -> f64 {
        let [a, b, c] = self.xyz;
        let n = (b - a).cross(c - a);
        let outside = |i: usize| {
            let (from, to) = (self.xyz[(i + 1) % 3], self.xyz[(i + 2) % 3]);
            (to - from).cross(p - from).dot(n) < 0.0
        };
        let across_end = (0..3).any(|i| self.ends[i] && outside(i));
        match n.try_normalize() {
            Some(n) if across_end => n.dot(p - a).abs(),
            _ => closest_point(p, self.xyz).distance(p),
        }
    }
}
