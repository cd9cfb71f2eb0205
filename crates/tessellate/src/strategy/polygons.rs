//! The polygons between fixed edges, and how they become triangles.
//!
//! Source: Balázs, Guthe, Klein 2004, section 7. A polygon without a reflex corner is cut from its upper left corner in linear time;
//! others by the plane sweep into monotone pieces (Garey and others 1978). Kahlesz, Balázs, Klein 2001, section 7, keeps
//! the constrained Delaunay triangulation instead. Whether a polygon is convex costs one turn per corner.
//!
//! ```text
//! o──1──o──3──o        from the upper left corner the front (l, r) moves down and right; the next corner is the one of the
//! │ ╱  ╱   ╱  │        two ahead that lies further up and to the left
//! 2  4   …
//! ```

use super::trace::Trace;
use crate::triangulate::{NONE, Triangulation, orient, sweep};
use chordal_nurbs::{DVec2, UvBox};
use rustc_hash::FxHashSet;

/// How polygons become triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Filling {
    /// Convex ones from their upper left corner, others monotone.
    FanOrMonotone,
    /// All by constrained Delaunay triangulation.
    Delaunay,
}

/// Triangulates every polygon between `fixed` edges anew.
pub(crate) fn retriangulate(
    mesh: &mut Triangulation,
    fixed: &FxHashSet<(u32, u32)>,
    filling: Filling,
    trace: &mut Trace,
) {
    let polygons = polygons(mesh, fixed);
    if filling == Filling::Delaunay {
        trace.add("constrained Delaunay polygons", polygons.len());
        return;
    }
    let mut triangles = Vec::with_capacity(mesh.triangles.len());
    let (mut convex, mut monotone, mut kept) = (0, 0, 0);
    for polygon in &polygons {
        let Some(loops) = outline(mesh, polygon) else {
            kept += 1;
            triangles.extend(polygon.iter().map(|&t| mesh.triangles[t as usize]));
            continue;
        };
        let size = UvBox::from_points(loops.iter().flatten().map(|&v| mesh.points[v as usize])).size();
        let whole = |new: &[[u32; 3]]| {
            let sound = |t: &[u32; 3]| is_sound(t.map(|v| mesh.points[v as usize]), size);
            new.len() == polygon.len() && new.iter().all(sound)
        };
        if let [one] = &loops[..]
            && is_convex(&mesh.points, one, size)
        {
            let new = zigzag(&mesh.points, one);
            if whole(&new) {
                convex += 1;
                triangles.extend(new);
                continue;
            }
        }
        match monotone_pieces(&mesh.points, &loops).filter(|new| whole(new)) {
            Some(new) => {
                monotone += 1;
                triangles.extend(new);
            }
            None => {
                kept += 1;
                triangles.extend(polygon.iter().map(|&t| mesh.triangles[t as usize]));
            }
        }
    }
    trace.add("convex polygons", convex);
    trace.add("monotone polygons", monotone);
    trace.add("polygons kept as constrained Delaunay", kept);
    let points = std::mem::take(&mut mesh.points);
    *mesh = Triangulation::new(points, triangles);
}

/// Triangles that no fixed edge separates, polygon by polygon.
pub(crate) fn polygons(mesh: &Triangulation, fixed: &FxHashSet<(u32, u32)>) -> Vec<Vec<u32>> {
    let mut seen = vec![false; mesh.triangles.len()];
    let mut polygons = Vec::new();
    for start in 0..mesh.triangles.len() as u32 {
        if seen[start as usize] {
            continue;
        }
        seen[start as usize] = true;
        let mut polygon = vec![start];
        let mut next = 0;
        while next < polygon.len() {
            let t = polygon[next];
            next += 1;
            for i in 0..3 {
                let across = mesh.neighbors[t as usize][i];
                let (a, b) = edge(mesh, t, i);
                if across != NONE && !seen[across as usize] && !fixed.contains(&(a.min(b), a.max(b))) {
                    seen[across as usize] = true;
                    polygon.push(across);
                }
            }
        }
        polygons.push(polygon);
    }
    polygons
}

fn edge(mesh: &Triangulation, t: u32, i: usize) -> (u32, u32) {
    let c = mesh.triangles[t as usize];
    (c[(i + 1) % 3], c[(i + 2) % 3])
}

/// The loops around a polygon, interior on the left; `None` where it touches itself or has corners inside.
pub(crate) fn outline(mesh: &Triangulation, polygon: &[u32]) -> Option<Vec<Vec<u32>>> {
    let mut sorted = polygon.to_vec();
    sorted.sort_unstable();
    let is_own = |t: u32| t != NONE && sorted.binary_search(&t).is_ok();
    let sides = polygon.iter().flat_map(|&t| (0..3).map(move |i| (t, i)));
    let outer = sides.filter(|&(t, i)| !is_own(mesh.neighbors[t as usize][i]));
    let mut edges: Vec<(u32, u32)> = outer.map(|(t, i)| edge(mesh, t, i)).collect();
    edges.sort_unstable();
    if edges.windows(2).any(|w| w[0].0 == w[1].0) {
        return None;
    }
    let loops = loops_of(&edges)?;
    // Euler: n corners and h holes make n + 2h − 2 triangles, and every corner inside two more.
    (polygon.len() + 4 == edges.len() + 2 * loops.len()).then_some(loops)
}

/// Chains sorted edges, each with another start, into loops.
fn loops_of(edges: &[(u32, u32)]) -> Option<Vec<Vec<u32>>> {
    let mut used = vec![false; edges.len()];
    let mut loops = Vec::new();
    for start in 0..edges.len() {
        let mut one = Vec::new();
        let mut at = start;
        while !used[at] {
            used[at] = true;
            one.push(edges[at].0);
            at = edges.binary_search_by_key(&edges[at].1, |e| e.0).ok()?;
        }
        if !one.is_empty() {
            loops.push(one);
        }
    }
    Some(loops)
}

/// Heights below this share of the polygon's extent are rounding: samples along a line of constant parameter are in line
/// only as far as parameters can be computed, and a triangle of three of them, flat here, stands up in space.
const ROUNDING: f64 = 1e-7;

/// Triangles lower than this share of their longest side, in a polygon stretched to a square, are slivers: flat in the plane
/// of parameters they may stand up in space. A polygon that would get one keeps its Delaunay triangles.
const SLIVER: f64 = 5e-3;

/// Counter-clockwise, and no sliver.
fn is_sound([a, b, c]: [DVec2; 3], size: DVec2) -> bool {
    let (p, q) = ((b - a) / size, (c - a) / size);
    let longest = p.length_squared().max(q.length_squared()).max((q - p).length_squared());
    orient(a, b, c) > 0.0 && p.perp_dot(q) > SLIVER * longest
}

/// No corner turns right, rounding aside.
fn is_convex(points: &[DVec2], polygon: &[u32], size: DVec2) -> bool {
    let n = polygon.len();
    let p = |i: usize| points[polygon[i % n] as usize];
    (0..n).all(|i| {
        let (a, b, c) = (p(i), p(i + 1), p(i + 2));
        let height = || ((b - a) / size).perp_dot((c - a) / size) / ((c - a) / size).length();
        orient(a, b, c) >= 0.0 || height() > -ROUNDING
    })
}

/// Triangles of a convex polygon from its upper left corner on.
fn zigzag(points: &[DVec2], polygon: &[u32]) -> Vec<[u32; 3]> {
    let n = polygon.len();
    let bounds = UvBox::from_points(polygon.iter().map(|&v| points[v as usize]));
    // The larger, the further up and to the left; directions count alike whatever the cell's proportions.
    let rank = |i: usize| {
        let t = (points[polygon[i] as usize] - bounds.min) / bounds.size();
        t.y - t.x
    };
    let Some(first) = (0..n).max_by(|&a, &b| rank(a).total_cmp(&rank(b))) else { return Vec::new() };
    let mut triangles = Vec::with_capacity(n - 2);
    // Counter-clockwise from the upper left corner runs the left side, the other way the right one.
    let (mut left, mut right) = ((first + 1) % n, (first + n - 1) % n);
    triangles.push([polygon[first], polygon[left], polygon[right]]);
    while triangles.len() < n - 2 {
        let (next_left, next_right) = ((left + 1) % n, (right + n - 1) % n);
        if rank(next_left) >= rank(next_right) {
            triangles.push([polygon[left], polygon[next_left], polygon[right]]);
            left = next_left;
        } else {
            triangles.push([polygon[left], polygon[next_right], polygon[right]]);
            right = next_right;
        }
    }
    triangles
}

fn monotone_pieces(points: &[DVec2], loops: &[Vec<u32>]) -> Option<Vec<[u32; 3]>> {
    let vertices: Vec<u32> = loops.concat();
    let local: Vec<DVec2> = vertices.iter().map(|&v| points[v as usize]).collect();
    let mut runs = Vec::with_capacity(loops.len());
    let mut start = 0;
    for one in loops {
        runs.push((start, start + one.len() as u32));
        start += one.len() as u32;
    }
    let triangles = sweep(&local, &runs).ok()?;
    Some(triangles.into_iter().map(|t| t.map(|i| vertices[i as usize])).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cell_with_points_in_its_sides_is_cut_without_slivers() {
        let points =
            [(0., 0.), (1., 0.), (2., 0.), (2., 1.), (2., 2.), (1., 2.), (0., 2.), (0., 1.)].map(DVec2::from);
        let polygon: Vec<u32> = (0..8).collect();
        assert!(is_convex(&points, &polygon, DVec2::splat(2.0)));
        let triangles = zigzag(&points, &polygon);
        assert_eq!(triangles.len(), 6);
        for t in &triangles {
            let [a, b, c] = t.map(|v| points[v as usize]);
            assert!(orient(a, b, c) > 0.0, "{t:?}");
        }
        assert!(triangles[0].contains(&6), "begins in the upper left corner");
    }

    #[test]
    fn a_fixed_diagonal_separates_two_polygons() {
        let points = [(0., 0.), (2., 0.), (2., 2.), (0., 2.)].map(DVec2::from);
        let mut mesh = Triangulation::new(points.to_vec(), vec![[0, 1, 2], [0, 2, 3]]);
        let fixed: FxHashSet<(u32, u32)> = [(0, 2)].into_iter().collect();
        let mut trace = Trace::default();
        retriangulate(&mut mesh, &fixed, Filling::FanOrMonotone, &mut trace);
        assert_eq!(trace.count("convex polygons"), 2);
        assert!(mesh.triangles.iter().all(|t| t.contains(&0) && t.contains(&2)));
        // Without it the square is one polygon, cut from its upper left corner.
        let mut trace = Trace::default();
        retriangulate(&mut mesh, &FxHashSet::default(), Filling::FanOrMonotone, &mut trace);
        assert_eq!(trace.count("convex polygons"), 1);
        assert!(mesh.triangles[0].contains(&3));
    }

    #[test]
    fn an_l_is_monotone_work() {
        let points = [(0., 0.), (2., 0.), (2., 1.), (1., 1.), (1., 2.), (0., 2.)].map(DVec2::from);
        let triangles = sweep(&points, &[(0, 6)]).expect("simple");
        let mut mesh = Triangulation::new(points.to_vec(), triangles);
        let mut trace = Trace::default();
        retriangulate(&mut mesh, &FxHashSet::default(), Filling::FanOrMonotone, &mut trace);
        assert_eq!(trace.count("monotone polygons"), 1);
        assert_eq!(mesh.triangles.len(), 4);
    }
}
