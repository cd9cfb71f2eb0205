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
//! Sides that end at a pole are left out of the first check: there the chart has many points for one of the
//! surface. Signs of areas are exact; only against moved boundaries, whose coordinates are rounded, a
//! crossing must be wider than rounding.

use crate::box_tree::BoxTree;
use crate::chart::Chart;
use crate::halves::Half;
use crate::triangle_pair::turn2;
use chordal_nurbs::{Box3, DVec2, UvBox};

/// A crossing with a moved side counts if its ends lie this far beyond the other side, relative to the chart.
const MOVED: f64 = 1e-7;

/// A chart may be longer than a period by this share without coming back over itself: seams bend.
const OVER_PERIOD: f64 = 1e-9;

/// A face that runs round a closed direction more often is not checked against itself beyond.
const MOST_TURNS: i32 = 8;

/// A side of the boundary, with the face on its left.
#[derive(Clone, Copy)]
struct Side {
    a: DVec2,
    b: DVec2,
    /// One end is on a pole, where the chart has many points for one of the surface: the side may lie
    /// anywhere.
    at_pole: bool,
}

impl Side {
    fn moved(&self, by: DVec2) -> Self {
        Self { a: self.a + by, b: self.b + by, ..*self }
    }
}

/// The number of places found at which triangles of the face lie one on another. `single` are the sides of
/// triangles without a partner; all triangles must run the same way round.
pub(crate) fn overlaps(chart: &Chart<'_>, single: &[Half]) -> usize {
    let uv = |corner: u32| chart.mesh.corners[corner as usize].uv;
    let side = |h: &Half| {
        let (a, b) = if chart.turned { (uv(h.b), uv(h.a)) } else { (uv(h.a), uv(h.b)) };
        Side { a, b, at_pole: chart.touches_pole(h) }
    };
    let sides: Vec<Side> = single.iter().map(side).collect();
    let tree = BoxTree::new(sides.iter().map(|s| flat_box(s.a, s.b)));
    let mut found = 0;
    tree.own_pairs(&mut |i, j| found += usize::from(cross(&sides[i as usize], &sides[j as usize], 0.0)));
    let inside = places_inside(chart, single);
    found += wrong_windings(&sides, &tree, &inside, 1);
    for shift in shifts(chart) {
        let moved: Vec<Side> = sides.iter().map(|s| s.moved(shift)).collect();
        let moved_tree = BoxTree::new(moved.iter().map(|s| flat_box(s.a, s.b)));
        let depth = MOVED * chart.uv_box.size().max_element();
        tree.pairs_with(&moved_tree, &mut |i, j| {
            found += usize::from(cross(&sides[i as usize], &moved[j as usize], depth));
        });
        found += wrong_windings(&moved, &moved_tree, &inside, 0);
    }
    found
}

fn flat_box(a: DVec2, b: DVec2) -> Box3 {
    Box3::from_points([a.extend(0.0), b.extend(0.0)])
}

/// True where two sides cross inside both; each end lies farther than `depth` from the line of the other
/// side.
fn cross(s: &Side, t: &Side, depth: f64) -> bool {
    let apart = |line: &Side, other: &Side| {
        let (c, d) = (turn2(line.a, line.b, other.a), turn2(line.a, line.b, other.b));
        let least = depth * line.a.distance(line.b);
        c * d < 0.0 && c.abs() > least && d.abs() > least
    };
    !s.at_pole && !t.at_pole && apart(s, t) && apart(t, s)
}

/// One place inside the face beside each connected piece of its boundary: the middle of its largest triangle
/// there.
fn places_inside(chart: &Chart<'_>, single: &[Half]) -> Vec<DVec2> {
    let mut piece_of: Vec<u32> = (0..chart.mesh.corners.len() as u32).collect();
    for h in single {
        let (a, b) = (root(&mut piece_of, h.a), root(&mut piece_of, h.b));
        piece_of[a.max(b) as usize] = a.min(b);
    }
    let mut largest: Vec<(u32, f64, u32)> = single
        .iter()
        .map(|h| {
            let [a, b, c] = corners(chart, h.triangle);
            (root(&mut piece_of, h.a), turn2(a, b, c).abs(), h.triangle)
        })
        .collect();
    largest.sort_unstable_by(|x, y| x.0.cmp(&y.0).then(y.1.total_cmp(&x.1)).then(x.2.cmp(&y.2)));
    largest.dedup_by_key(|entry| entry.0);
    largest.iter().map(|&(_, _, t)| corners(chart, t).iter().sum::<DVec2>() / 3.0).collect()
}

fn corners(chart: &Chart<'_>, triangle: u32) -> [DVec2; 3] {
    chart.mesh.triangles[triangle as usize].map(|c| chart.mesh.corners[c as usize].uv)
}

/// The representative of a corner's piece; the path to it is shortened.
fn root(piece_of: &mut [u32], corner: u32) -> u32 {
    let mut at = corner;
    while piece_of[at as usize] != at {
        let above = piece_of[piece_of[at as usize] as usize];
        piece_of[at as usize] = above;
        at = above;
    }
    at
}

/// How many of `places` the sides do not wind around `wanted` times.
fn wrong_windings(sides: &[Side], tree: &BoxTree, places: &[DVec2], wanted: i32) -> usize {
    let far = sides.iter().fold(f64::NEG_INFINITY, |m, s| m.max(s.a.x).max(s.b.x));
    let mut winding = vec![0i32; places.len()];
    // A ray to the right of each place.
    let rays = BoxTree::new(places.iter().map(|p| flat_box(*p, DVec2::new(far.max(p.x), p.y))));
    tree.pairs_with(&rays, &mut |i, j| {
        let (s, p) = (&sides[i as usize], places[j as usize]);
        let upward = s.a.y <= p.y && p.y < s.b.y;
        let downward = s.b.y <= p.y && p.y < s.a.y;
        if upward && turn2(s.a, s.b, p) > 0.0 {
            winding[j as usize] += 1;
        } else if downward && turn2(s.a, s.b, p) < 0.0 {
            winding[j as usize] -= 1;
        }
    });
    winding.iter().filter(|&&w| w != wanted).count()
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
