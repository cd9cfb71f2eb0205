//! Whether triangles of a face lie one on another in its parameter space.
//!
//! All triangles run the same way round, so the number of triangles over a place is the winding number of
//! their boundary around it. It is 1 everywhere inside exactly if
//!
//! 1. no two sides of the boundary cross: on the left of both sides of a crossing the number is 2 or more, or
//!    on the right of both it is below 0;
//! 2. it is 1 beside each connected piece of the boundary.
//!
//! On a closed surface the same is checked against the boundary moved by whole periods: a face that runs
//! round more than once must not come back over itself.
//!
//! At a pole the chart has many points for one of the surface. A side that ends there runs along the
//! parameter line through its other end, as the chord does seen from the axis; where the boundary passes
//! through the pole, it goes on along the line of the chart that the pole is (see [`crate::fan`]). Sides that
//! end at a side of the surface that is only short, and no point, are left out of the first check.
//!
//! Signs of areas are exact; only against moved boundaries, whose coordinates are rounded, a crossing must be
//! wider than rounding.

use crate::boundary_tree::{BoundaryTree, Chains, Side};
use crate::chart::Chart;
use crate::halves::Half;
use crate::triangle_pair::turn2;
use crate::unrolled::beside_poles;
use chordal_nurbs::{DVec2, UvBox};

/// A crossing with a moved side counts if its ends lie this far beyond the other side, relative to the chart.
const MOVED: f64 = 1e-7;

/// A chart may be longer than a period by this share without coming back over itself: seams bend.
const OVER_PERIOD: f64 = 1e-9;

/// A face that runs round a closed direction more often is not checked against itself beyond.
const MOST_TURNS: i32 = 8;

/// The number of places found at which triangles of the face lie one on another. `single` are the sides of
/// triangles without a partner; all triangles must run the same way round.
pub(crate) fn overlaps(chart: &Chart<'_>, single: &[Half]) -> usize {
    let chains = Chains::of(single, chart.mesh.corners.len());
    let tree = BoundaryTree::new(sides(chart, &chains));
    let mut found = 0;
    tree.own_pairs(&mut |s, t| found += usize::from(cross(s, t, 0.0)));
    let inside = places_inside(chart, &chains);
    found += wrong_windings(&tree, &inside, 1);
    for shift in shifts(chart) {
        let moved = tree.moved(shift);
        let depth = MOVED * chart.uv_box.size().max_element();
        tree.pairs_with(&moved, &mut |s, t| found += usize::from(cross(s, t, depth)));
        found += wrong_windings(&moved, &inside, 0);
    }
    found
}

/// The boundary in the chart, with the face on its left.
fn sides(chart: &Chart<'_>, chains: &Chains) -> Vec<Side> {
    let mut sides = Vec::with_capacity(chains.halves.len());
    let uv = |corner: u32| chart.mesh.corners[corner as usize].uv;
    let oriented = |a, b, is_loose| {
        let (a, b) = if chart.turned { (b, a) } else { (a, b) };
        Side { a, b, is_loose }
    };
    if !chart.poles_are_points {
        sides.extend(chains.halves.iter().map(|h| oriented(uv(h.a), uv(h.b), chart.touches_pole(h))));
        return sides;
    }
    for range in &chains.ranges {
        let halves = &chains.halves[range.clone()];
        for (i, half) in halves.iter().enumerate() {
            let [a, b] = beside_poles(chart, half);
            sides.push(oriented(a, b, false));
            let [next, _] = beside_poles(chart, &halves[(i + 1) % halves.len()]);
            if next != b {
                sides.push(oriented(b, next, false));
            }
        }
    }
    sides
}

/// True where two sides cross inside both; each end lies farther than `depth` from the line of the other
/// side.
fn cross(s: &Side, t: &Side, depth: f64) -> bool {
    let apart = |line: &Side, other: &Side| {
        let (c, d) = (turn2(line.a, line.b, other.a), turn2(line.a, line.b, other.b));
        let least = depth * line.a.distance(line.b);
        c * d < 0.0 && c.abs() > least && d.abs() > least
    };
    // Sides that follow each other only touch.
    !s.is_loose && !t.is_loose && s.b != t.a && s.a != t.b && apart(s, t) && apart(t, s)
}

/// One place inside the face beside each chain of its boundary: the middle of its largest triangle there.
fn places_inside(chart: &Chart<'_>, chains: &Chains) -> Vec<DVec2> {
    let size = |triangle: u32| {
        let [a, b, c] = corners(chart, triangle);
        (b - a).perp_dot(c - a).abs()
    };
    let place = |range: &std::ops::Range<usize>| {
        let halves = &chains.halves[range.clone()];
        let sizes = halves.iter().map(|h| (size(h.triangle), h));
        let (_, largest) = sizes.reduce(|best, next| if next.0 > best.0 { next } else { best })?;
        Some(middle(chart, largest.triangle))
    };
    chains.ranges.iter().filter_map(place).collect()
}

/// The middle of a triangle in the chart; of one with a single corner at a pole, of what it stands for.
fn middle(chart: &Chart<'_>, triangle: u32) -> DVec2 {
    let poles = chart.mesh.triangles[triangle as usize].map(|c| chart.pole_axis(c));
    let mut uv = corners(chart, triangle);
    if chart.poles_are_points && poles.iter().flatten().count() == 1 {
        for (i, axis) in poles.iter().enumerate().filter_map(|(i, axis)| Some((i, (*axis)?))) {
            uv[i][1 - axis] = 0.5 * (uv[(i + 1) % 3][1 - axis] + uv[(i + 2) % 3][1 - axis]);
        }
    }
    uv.iter().sum::<DVec2>() / 3.0
}

fn corners(chart: &Chart<'_>, triangle: u32) -> [DVec2; 3] {
    chart.mesh.triangles[triangle as usize].map(|c| chart.mesh.corners[c as usize].uv)
}

/// How many of `places` the sides do not wind around `wanted` times.
fn wrong_windings(tree: &BoundaryTree, places: &[DVec2], wanted: i32) -> usize {
    places.iter().filter(|p| tree.winding(**p) != wanted).count()
}

/// The vectors of whole periods by which the chart may come back over itself; one of each pair of opposites.
fn shifts(chart: &Chart<'_>) -> Vec<DVec2> {
    let UvBox { min, max } = chart.uv_box;
    let turns = |axis: usize| match chart.period(axis) {
        Some(period) => {
            let turns = ((max[axis] - min[axis]) / period - OVER_PERIOD).floor();
            (turns.clamp(0.0, f64::from(MOST_TURNS)) as i32, period)
        }
        None => (0, 0.0),
    };
    let ((nu, pu), (nv, pv)) = (turns(0), turns(1));
    let all = (-nu..=nu).flat_map(|i| (0..=nv).map(move |j| (i, j)));
    all.filter(|&(i, j)| j > 0 || i > 0)
        .map(|(i, j)| DVec2::new(f64::from(i) * pu, f64::from(j) * pv))
        .collect()
}
