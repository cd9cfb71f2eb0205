//! A second bound of facets, which shares no code with the first: the one that mesher and audit have in
//! common may be wrong, and a fault in it would pass both.
//!
//! A share of the facets of each face, and the largest facet of each fourth face, are bounded again. The
//! surface over a facet is divided until each piece is shown to lie within the error that is claimed for the
//! face:
//!
//! 1. the distance from a convex set is a convex function, so that over the plane piece through the images of
//!    a triangle of parameters it is largest at a corner;
//! 2. the surface is off that plane piece by no more than [`crate::bend`] says, a quarter at each division.
//!
//! ```text
//!        ╱╲            largest distance of a corner + bend ≤ error: done
//!       ╱──╲           otherwise: four quarters
//!      ╱╲  ╱╲          a corner farther off than the error: the bound is refuted
//! ```
//!
//! The convex set is the facet. Where the face goes on across one of its sides, the image of the side may
//! bend over the neighbour: the facet is then extended across the side, and the distance of the extension
//! from the neighbour is added. Across a side at which the face ends the facet's plane goes on: what is there
//! lies between chord and curve, which have a bound of their own, or not in the face at all; points there
//! refute nothing.
//!
//! Proven is that the surface over the facet's parameters is as near to the mesh as is claimed, to within
//! [`SLACK`] and to a quarter of the tolerance; not the way back, nor what lies between the chord of an edge
//! and its curve. A surface without a simple bound, and a facet that takes too many pieces, is looked at in
//! points only, which can refute a bound and not confirm it.

use crate::bend::Bend;
use crate::chart::Chart;
use crate::context::Context;
use crate::fan::Side;
use crate::findings::{FaceFindings, Log};
use crate::simple_bound::{SimpleBound, SimpleScratch};
use crate::triangle_tree::{TriangleTree, closest_point};
use chordal_brep::AuditIssue;
use chordal_nurbs::{DVec2, DVec3, Facet, Surface, UvBox};
use rayon::prelude::*;

/// One facet in this many is bounded again.
const STRIDE: usize = 64;

/// The largest facet of one face in this many is bounded again; on the other faces it is measured at points.
const LARGEST_OF: usize = 4;

/// Pieces into which the surface over a facet is divided at most.
const MOST_PIECES: usize = 512;

/// Points beyond the limit after which no more are looked for.
const MOST_BEYOND: usize = 32;

/// So many divisions share one bound of second derivatives. Over smaller pieces it is smaller, and takes as
/// long as some points.
const LEVELS_OF_ONE_BEND: u32 = 2;

/// Divisions of a facet on a surface that has no simple bound: 15 points.
const LEVELS_WITHOUT_BOUND: u32 = 2;

/// The bound may exceed the error by this share: at the places that are farthest off no division would show
/// less.
const SLACK: f64 = 0.125;

/// Errors below this share of the tolerance need not be confirmed: the facet is within it, and that it is
/// nearer still is looked at in points.
const ENOUGH: f64 = 0.25;

/// Measured distances may exceed the error by this share of the tolerance: rounding on surfaces that are
/// evaluated from large numbers, and far below what a wrong bound is wrong by.
const NEGLIGIBLE: f64 = 1e-4;

/// Facets of a face whose neighbours are looked for; each takes a pass over its triangles.
const MOST_SEARCHES: usize = 64;

/// Bounds a share of the facets again where the face's error is proven.
pub(crate) fn check_second_bound(
    context: &Context<'_>,
    chart: &Chart<'_>,
    sides: &[[Side; 3]],
    found: &FaceFindings,
    log: &mut Log<'_>,
) {
    let claimed = context.claim(log.index).map_or(f64::INFINITY, |c| c.proven_error);
    let error = found.error.min(if claimed.is_nan() { f64::INFINITY } else { claimed });
    if !error.is_finite() || matches!(chart.surface, Surface::Plane { .. }) {
        return;
    }
    let limit = error + (NEGLIGIBLE * context.options.tolerance).max(4.0 * chart.rounding);
    let enough = limit.max(ENOUGH * context.options.tolerance) * (1.0 + SLACK);
    let simple = Some(SimpleBound::new(chart.surface));
    let second = SecondBound { chart, sides, simple, limit, enough };
    if let Some(measured) = second.refuted(&picked(chart, log.index.is_multiple_of(LARGEST_OF))) {
        log.add(AuditIssue::BoundExceeded { proven: context.mm(limit), measured: context.mm(measured) });
    }
}

/// A facet to be bounded, or, cheaper, to be looked at in points only.
#[derive(Clone, Copy, Debug)]
struct Pick {
    triangle: usize,
    is_bounded: bool,
}

/// One facet of each few, to be bounded, and the one with the largest area.
fn picked(chart: &Chart<'_>, is_largest_bounded: bool) -> Vec<Pick> {
    let area = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|c| chart.xyz[c as usize]);
        (b - a).cross(c - a).length_squared()
    };
    let all = chart.mesh.triangles.iter().map(area).enumerate();
    let largest = all.reduce(|best, next| if next.1 > best.1 { next } else { best });
    let share = (STRIDE / 2..chart.mesh.triangles.len()).step_by(STRIDE);
    let share = share.map(|triangle| Pick { triangle, is_bounded: true });
    let largest = largest.map(|(triangle, _)| Pick { triangle, is_bounded: is_largest_bounded });
    share.chain(largest).collect()
}

/// The data of one facet.
#[derive(Clone, Debug, Default, PartialEq)]
struct Verdict {
    /// It is within what is to be confirmed.
    is_confirmed: bool,
    /// Points of the surface that are farther from it than the limit, with their distances.
    beyond: Vec<(DVec3, f64)>,
}

struct SecondBound<'a, 'b> {
    chart: &'a Chart<'b>,
    sides: &'a [[Side; 3]],
    /// A facet with a bound up to this is not divided.
    simple: Option<SimpleBound<'a>>,
    /// No point may be farther off.
    limit: f64,
    /// The error that must be confirmed.
    enough: f64,
}

impl SecondBound<'_, '_> {
    /// The largest distance of a point from the mesh of the face, where it is beyond the limit.
    fn refuted(&self, picked: &[Pick]) -> Option<f64> {
        let judge = |(i, pick): (usize, &Pick)| self.judge(*pick, i < MOST_SEARCHES);
        let open: Vec<(DVec3, f64)> =
            picked.par_iter().enumerate().with_min_len(16).flat_map_iter(|pick| judge(pick).beyond).collect();
        if open.is_empty() {
            return None;
        }
        // A point may lie over another facet than its own and its neighbours.
        let chart = self.chart;
        let triangles = chart.mesh.triangles.iter().map(|t| t.map(|c| chart.xyz[c as usize])).collect();
        let all = TriangleTree::new(triangles);
        let farthest = open.iter().map(|&(p, own)| all.distance(p, own)).fold(0.0, f64::max);
        (farthest > self.limit).then_some(farthest)
    }

    fn judge(&self, Pick { triangle, is_bounded }: Pick, with_neighbours: bool) -> Verdict {
        let t = &self.chart.mesh.triangles[triangle];
        // The sectors at poles are bounded by other parameters than their corners'.
        if t.iter().any(|&c| self.chart.pole_axis(c).is_some()) {
            return Verdict::default();
        }
        let uv = t.map(|c| self.chart.mesh.corners[c as usize].uv);
        let xyz = t.map(|c| self.chart.xyz[c as usize]);
        let Some(target) = Target::new(xyz, self.sides[triangle]) else { return Verdict::default() };
        let facet = Facet { uv, xyz, sag: self.sides[triangle].map(Side::sag) };
        let simple = self
            .simple
            .as_ref()
            .and_then(|simple| simple.of(self.chart, &facet, self.limit, &mut SimpleScratch::default()));
        if simple.is_some_and(|error| error <= self.limit) {
            return Verdict { is_confirmed: true, beyond: Vec::new() };
        }
        let bend = if is_bounded { self.bend(uv) } else { None };
        let whole = Piece { uv, xyz, off: [0.0; 3], bend, level: 0 };
        let mut search = Search { second: self, target, beyond: Vec::new(), pieces: 0 };
        let mut is_confirmed = search.is_within(&whole);
        if with_neighbours && !search.beyond.is_empty() {
            let neighbours = std::array::from_fn(|i| self.neighbour(triangle, i));
            let target = Target { neighbours, ..search.target };
            search = Search { second: self, target, beyond: Vec::new(), pieces: 0 };
            is_confirmed = search.is_within(&whole);
        }
        // Points that are off by no more than the slack refute nothing.
        if is_confirmed && self.limit * (1.0 + SLACK) >= self.enough {
            search.beyond.clear();
        }
        Verdict { is_confirmed, beyond: search.beyond }
    }

    /// The bound of the surface over a triangle; `None` across the seam of its parameters.
    fn bend(&self, uv: [DVec2; 3]) -> Option<Bend> {
        let moved = self.chart.wrap.apply(uv[0]) - uv[0];
        let within = UvBox::from_points(uv.map(|p| p + moved));
        let domain = self.chart.surface.domain();
        let near = 1e-9 * within.size();
        let inside = within.min.cmpge(domain.min - near).all() && within.max.cmple(domain.max + near).all();
        let angles = !matches!(self.chart.surface, Surface::Nurbs(_) | Surface::Extrusion { .. });
        (inside || angles).then(|| Bend::of(self.chart.surface, within)).flatten()
    }

    /// The facet on the other side of the side opposite corner `i`.
    fn neighbour(&self, triangle: usize, i: usize) -> Option<[DVec3; 3]> {
        let triangles = &self.chart.mesh.triangles;
        let t = &triangles[triangle];
        if self.sides[triangle][i] != Side::Inner {
            return None;
        }
        let (from, to) = (t[(i + 1) % 3], t[(i + 2) % 3]);
        let shares = |o: &&[u32; 3]| (0..3).any(|k| o[k] == to && o[(k + 1) % 3] == from);
        triangles.iter().find(shares).map(|o| o.map(|c| self.chart.xyz[c as usize]))
    }
}

/// A triangle of parameters and the surface at its corners.
#[derive(Clone, Copy)]
struct Piece {
    uv: [DVec2; 3],
    xyz: [DVec3; 3],
    /// Their distances from the target, at most.
    off: [f64; 3],
    /// The bound of the surface over the facet.
    bend: Option<Bend>,
    level: u32,
}

/// Divides the surface over one facet.
struct Search<'a, 'b, 'c> {
    second: &'a SecondBound<'b, 'c>,
    target: Target,
    /// Points that are farther from the target than the limit.
    beyond: Vec<(DVec3, f64)>,
    pieces: usize,
}

impl Search<'_, '_, '_> {
    /// True where the piece is known to be within the limit, and its slack, of the target.
    fn is_within(&mut self, whole: &Piece) -> bool {
        let mut open = Vec::new();
        let mut within = true;
        self.divide(whole, &mut open);
        while let Some(piece) = open.pop() {
            self.pieces += 1;
            if self.is_near(&piece) {
                continue;
            }
            let most = if piece.bend.is_some() { u32::MAX } else { LEVELS_WITHOUT_BOUND };
            if self.pieces + open.len() >= MOST_PIECES
                || piece.level >= most
                || self.beyond.len() > MOST_BEYOND
            {
                within = false;
                continue;
            }
            self.divide(&piece, &mut open);
        }
        within
    }

    fn is_near(&self, piece: &Piece) -> bool {
        let Some(bend) = piece.bend else { return false };
        let bend = bend.over(UvBox::from_points(piece.uv).size());
        let enough = self.second.enough;
        let own = piece.off.iter().copied().fold(0.0, f64::max);
        bend <= enough && (own + bend <= enough || self.target.farthest(piece.xyz) + bend <= enough)
    }

    fn divide(&mut self, piece: &Piece, open: &mut Vec<Piece>) {
        let chart = self.second.chart;
        let uv: [DVec2; 3] = std::array::from_fn(|i| piece.uv[(i + 1) % 3].midpoint(piece.uv[(i + 2) % 3]));
        let xyz = uv.map(|p| chart.point(p));
        let off = xyz.map(|p| self.target.farthest([p; 3]));
        let all = xyz.into_iter().zip(off);
        let is_beyond =
            |&(p, distance): &(DVec3, f64)| distance > self.second.limit && !self.target.is_past_an_end(p);
        self.beyond.extend(all.filter(is_beyond));
        let level = piece.level + 1;
        let is_coarse = piece.bend.is_some_and(|bend| bend.is_coarse);
        let child = |uv: [DVec2; 3], xyz, off| {
            let again = is_coarse && level.is_multiple_of(LEVELS_OF_ONE_BEND);
            let bend = if again { self.second.bend(uv) } else { piece.bend };
            Piece { uv, xyz, off, bend, level }
        };
        open.extend((0..3).map(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let off = [piece.off[i], off[k], off[j]];
            child([piece.uv[i], uv[k], uv[j]], [piece.xyz[i], xyz[k], xyz[j]], off)
        }));
        open.push(child(uv, xyz, off));
    }
}

/// A facet, and what is beside it.
struct Target {
    xyz: [DVec3; 3],
    /// In-plane normals of the sides, outwards.
    outward: [DVec3; 3],
    /// For each side (opposite corner i), whether the face ends there.
    ends: [bool; 3],
    /// The facets across the other sides, where they are known.
    neighbours: [Option<[DVec3; 3]>; 3],
}

impl Target {
    /// `None` for a facet without area.
    fn new(xyz: [DVec3; 3], sides: [Side; 3]) -> Option<Self> {
        let normal = (xyz[1] - xyz[0]).cross(xyz[2] - xyz[0]).try_normalize()?;
        let mut outward = [DVec3::ZERO; 3];
        for i in 0..3 {
            outward[i] = (xyz[(i + 2) % 3] - xyz[(i + 1) % 3]).cross(normal).try_normalize()?;
        }
        Some(Self { xyz, outward, ends: sides.map(|s| s != Side::Inner), neighbours: [None; 3] })
    }

    /// True where a point of the surface lies beyond a side at which the face ends. The straight side of the
    /// parameters may bulge over the boundary there, and the face reaches no farther than its curve.
    fn is_past_an_end(&self, p: DVec3) -> bool {
        (0..3).any(|i| self.ends[i] && (p - self.xyz[(i + 1) % 3]).dot(self.outward[i]) > 0.0)
    }

    /// An upper bound of the distance of the triangle between three points from the mesh.
    fn farthest(&self, points: [DVec3; 3]) -> f64 {
        let [p, q, r] = points;
        let first = self.nearest(p, self.ends).1;
        let own = if p == q && q == r {
            first
        } else {
            first.max(self.nearest(q, self.ends).1).max(self.nearest(r, self.ends).1)
        };
        let across = (0..3).filter_map(|i| self.farthest_across(points, i));
        across.fold(own, f64::min)
    }

    /// The same by the facet and its neighbour across a side; `None` if that gives no bound.
    fn farthest_across(&self, points: [DVec3; 3], i: usize) -> Option<f64> {
        let neighbour = self.neighbours[i]?;
        let mut ends = self.ends;
        ends[i] = true;
        let (a, b) = (self.xyz[(i + 1) % 3], self.xyz[(i + 2) % 3]);
        let (mut own, mut other) = (0.0f64, 0.0f64);
        for p in points {
            let (q, distance) = self.nearest(p, ends);
            // Pieces cross the side itself, and not its line beyond.
            let along = (q - a).dot(b - a) / (b - a).length_squared();
            if !(-1e-9..=1.0 + 1e-9).contains(&along) {
                return None;
            }
            own = own.max(distance);
            if (q - a).dot(self.outward[i]) > 0.0 {
                other = other.max(closest_point(q, neighbour).distance(q));
            }
        }
        Some(own + other)
    }

    /// A point of the facet, extended across some of its sides, that is near `p`, and its distance.
    fn nearest(&self, p: DVec3, across: [bool; 3]) -> (DVec3, f64) {
        let mut moved = p;
        for i in (0..3).filter(|&i| across[i]) {
            let out = (moved - self.xyz[(i + 1) % 3]).dot(self.outward[i]).max(0.0);
            moved -= self.outward[i] * out;
        }
        let near = closest_point(moved, self.xyz);
        (near + (p - moved), near.distance(moved))
    }
}

#[cfg(test)]
mod tests;
