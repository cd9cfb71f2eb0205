//! The polygons between fixed edges, and how they become triangles.
//!
//! Source: Balázs, Guthe, Klein 2004, section 7. A polygon without a reflex corner is cut from its upper left
//! corner in linear time; others by the plane sweep into monotone pieces (Garey and others 1978). Kahlesz,
//! Balázs, Klein 2001, section 7, keeps the constrained Delaunay triangulation instead. The test for
//! convexity costs one turn per corner, and is made only where a trimming loop passes. Polygons are found by
//! walking along half-edges ([`super::half_edges`]); where that does not account for every triangle, or would
//! make a sliver, the constrained Delaunay triangles of the region stay.
//!
//! ```text
//! o──1──o──3──o        from the upper left corner the front (l, r) moves down and right; the next
//! │ ╱  ╱   ╱  │        corner is the one of the two ahead that lies further up and to the left
//! 2  4   …
//! ```

use super::half_edges::{Polygon, walk};
use chordal_nurbs::{DVec2, UvBox};
use chordal_tessellate::Trace;
use chordal_tessellate::method::{NONE, Triangulation, orient, sweep};
use rustc_hash::{FxHashMap, FxHashSet};

/// How polygons become triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Filling {
    /// Convex polygons from their upper left corner, others in monotone pieces.
    FanOrMonotone,
    /// All by constrained Delaunay triangulation.
    Delaunay,
}

/// Triangulates every polygon between `fixed` edges anew.
pub fn retriangulate(
    mesh: &mut Triangulation,
    fixed: &FxHashSet<(u32, u32)>,
    filling: Filling,
    trace: &mut Trace,
) {
    let regions = polygons(mesh, fixed);
    if filling == Filling::Delaunay {
        trace.add("constrained Delaunay polygons", regions.len());
        return;
    }
    let mut count = Count::default();
    let walked = walked(mesh, fixed, &regions, &mut count);
    let on_boundary = on_boundary(mesh);
    let mut triangles = Vec::with_capacity(mesh.triangles.len());
    for (region, own) in regions.iter().zip(&walked) {
        let bounds = own.iter().flat_map(|p| &p.nodes).map(|&v| mesh.points[v as usize]);
        let size = UvBox::from_points(bounds).size();
        let start = triangles.len();
        let before = count;
        for polygon in own {
            triangles.extend(triangulated(&mesh.points, polygon, &on_boundary, size, &mut count));
        }
        let sound = |t: &[u32; 3]| is_sound(t.map(|v| mesh.points[v as usize]), size);
        if triangles.len() - start != region.len() || !triangles[start..].iter().all(sound) {
            triangles.truncate(start);
            triangles.extend(region.iter().map(|&t| mesh.triangles[t as usize]));
            count = Count { kept: before.kept + 1, ..before };
        }
    }
    trace.add("half-edge polygons", walked.iter().map(Vec::len).sum());
    trace.add("bridges to holes", count.bridges);
    trace.add("polygons with a trimming edge", count.marked);
    trace.add("convex polygons", count.convex);
    trace.add("monotone polygons", count.monotone);
    trace.add("polygons kept as constrained Delaunay", count.kept);
    let points = std::mem::take(&mut mesh.points);
    *mesh = Triangulation::new(points, triangles);
}

/// How many polygons were triangulated in each way.
#[derive(Clone, Copy, Default)]
struct Count {
    bridges: usize,
    marked: usize,
    convex: usize,
    monotone: usize,
    kept: usize,
}

/// The polygons that the walk along half-edges finds, by the region of triangles that they cover; none for
/// regions where the boundary is no set of simple loops.
fn walked(
    mesh: &Triangulation,
    fixed: &FxHashSet<(u32, u32)>,
    regions: &[Vec<u32>],
    count: &mut Count,
) -> Vec<Vec<Polygon>> {
    let mut found = vec![Vec::new(); regions.len()];
    // Loops that cross leave triangles turned over; edges then cross, and there is no planar graph.
    let is_plane = (0..mesh.triangles.len() as u32).all(|t| {
        let [a, b, c] = mesh.corners(t);
        orient(a, b, c) > 0.0
    });
    if !is_plane {
        return found;
    }
    let mut region_of: FxHashMap<(u32, u32), u32> = FxHashMap::default();
    let (mut trimming, mut borders) = (Vec::new(), Vec::new());
    for (r, region) in regions.iter().enumerate() {
        for &t in region {
            for i in 0..3 {
                let (a, b) = edge(mesh, t, i);
                region_of.insert((a, b), r as u32);
                if mesh.neighbors[t as usize][i] == NONE {
                    trimming.push([a, b]);
                } else if a < b && fixed.contains(&(a, b)) {
                    borders.push([a, b]);
                }
            }
        }
    }
    let walked = walk(&mesh.points, &trimming, &borders);
    count.bridges = walked.bridges;
    for polygon in walked.polygons {
        let n = polygon.nodes.len();
        let side = |i: usize| (polygon.nodes[i], polygon.nodes[(i + 1) % n]);
        // Bridges are not among the sides of regions; every polygon has others.
        if let Some(&r) = (0..n).find_map(|i| region_of.get(&side(i))) {
            found[r as usize].push(polygon);
        }
    }
    found
}

/// Vertices of the trimming loops.
fn on_boundary(mesh: &Triangulation) -> Vec<bool> {
    let mut found = vec![false; mesh.points.len()];
    for t in 0..mesh.triangles.len() as u32 {
        for i in (0..3).filter(|&i| mesh.neighbors[t as usize][i] == NONE) {
            let (a, b) = edge(mesh, t, i);
            found[a as usize] = true;
            found[b as usize] = true;
        }
    }
    found
}

/// Only polygons that touch a trimming loop are tested for convexity: others are cells with vertices in their
/// sides.
fn triangulated(
    points: &[DVec2],
    polygon: &Polygon,
    on_boundary: &[bool],
    size: DVec2,
    count: &mut Count,
) -> Vec<[u32; 3]> {
    let nodes = &polygon.nodes;
    count.marked += usize::from(polygon.is_marked);
    let is_cell = !polygon.is_marked && nodes.iter().all(|&v| !on_boundary[v as usize]);
    if is_cell || is_convex(points, nodes, size) {
        count.convex += 1;
        return zigzag(points, nodes);
    }
    count.monotone += 1;
    monotone_pieces(points, std::slice::from_ref(nodes)).unwrap_or_default()
}

/// Triangles that no fixed edge separates, polygon by polygon.
pub fn polygons(mesh: &Triangulation, fixed: &FxHashSet<(u32, u32)>) -> Vec<Vec<u32>> {
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
pub fn outline(mesh: &Triangulation, polygon: &[u32]) -> Option<Vec<Vec<u32>>> {
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

/// Heights below this share of the polygon's extent are rounding: samples along a line of constant parameter
/// are in line only as far as parameters can be computed, and a triangle of three of them, flat here, stands
/// up in space.
const ROUNDING: f64 = 1e-7;

/// Triangles lower than this share of their longest side, in a polygon stretched to a square, are slivers:
/// flat in the plane of parameters they may stand up in space. A polygon that would get one keeps its
/// Delaunay triangles.
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
    // Largest for the corner furthest up and to the left, relative to the size of the polygon in each
    // direction.
    let rank = |i: usize| {
        let t = (points[polygon[i] as usize] - bounds.min) / bounds.size();
        t.y - t.x
    };
    let Some(first) = (0..n).max_by(|&a, &b| rank(a).total_cmp(&rank(b))) else { return Vec::new() };
    let mut triangles = Vec::with_capacity(n - 2);
    // From the upper left corner, the left side runs counter-clockwise and the right side clockwise.
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
    use chordal_nurbs::math;
    use proptest::prelude::*;

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

    /// A star around (x, y); the radius changes from corner to corner.
    fn star(middle: DVec2, radii: &[f64]) -> Vec<DVec2> {
        let turn = std::f64::consts::TAU / radii.len() as f64;
        let at = |(i, r): (usize, &f64)| middle + *r * math::direction(turn * i as f64);
        radii.iter().enumerate().map(at).collect()
    }

    fn area(points: &[DVec2], triangles: &[[u32; 3]]) -> f64 {
        let of = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|v| points[v as usize]);
            0.5 * (b - a).perp_dot(c - a)
        };
        triangles.iter().map(of).sum()
    }

    proptest! {
        /// A star with stars cut out: as many triangles as Euler says, all counter-clockwise, the same area
        /// as earcut's.
        #[test]
        fn walk_and_monotone_pieces_agree_with_earcut(
            outer in prop::collection::vec(4.0f64..6.0, 5..40),
            holes in prop::collection::vec(prop::collection::vec(0.2f64..0.9, 3..9), 0..4),
        ) {
            let mut points = star(DVec2::ZERO, &outer);
            let mut loops = vec![(0..points.len() as u32).collect::<Vec<u32>>()];
            for (i, radii) in holes.iter().enumerate() {
                let start = points.len() as u32;
                let middle = [DVec2::new(1.5, 0.3), DVec2::new(-1.4, 0.2), DVec2::new(0.1, 1.6),
                    DVec2::new(0.2, -1.7)][i];
                points.extend(star(middle, radii).into_iter().rev());
                loops.push((start..points.len() as u32).collect());
            }
            let next = |l: &Vec<u32>, i: usize| [l[i], l[(i + 1) % l.len()]];
            let trimming: Vec<[u32; 2]> =
                loops.iter().flat_map(|l| (0..l.len()).map(move |i| next(l, i))).collect();
            let found = walk(&points, &trimming, &[]);
            let mut triangles = Vec::new();
            for polygon in &found.polygons {
                let own = monotone_pieces(&points, std::slice::from_ref(&polygon.nodes)).expect("simple");
                prop_assert_eq!(own.len(), polygon.nodes.len() - 2);
                triangles.extend(own);
            }
            prop_assert_eq!(triangles.len(), points.len() + 2 * loops.len() - 4);
            for t in &triangles {
                let [a, b, c] = t.map(|v| points[v as usize]);
                prop_assert!(orient(a, b, c) >= 0.0);
            }
            let starts: Vec<u32> = loops[1..].iter().map(|l| l[0]).collect();
            let mut ears: Vec<u32> = Vec::new();
            earcut::Earcut::new().earcut(points.iter().map(|p| [p.x, p.y]), &starts, &mut ears);
            let ears: Vec<[u32; 3]> = ears.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect();
            let (ours, theirs) = (area(&points, &triangles), area(&points, &ears).abs());
            prop_assert!((ours - theirs).abs() < 1e-9 * ours, "{ours} {theirs}");
        }

        /// Convex polygons, vertices in their sides included, from the upper left corner on: linear,
        /// complete, and recognised as convex.
        #[test]
        fn convex_polygons_are_cut_completely(
            angles in prop::collection::vec(0.0..std::f64::consts::TAU, 3..20), stretch in 0.01f64..100.0,
                dent: bool,
        ) {
            let mut angles = angles;
            angles.sort_unstable_by(f64::total_cmp);
            angles.dedup_by(|a, b| *a - *b < 0.05);
            // The middle must be inside, so that a dent is one.
            let around = angles.windows(2).map(|w| w[1] - w[0])
                .fold(angles[0] + 6.29 - angles[angles.len() - 1], f64::max);
            prop_assume!(angles.len() >= 4 && around < 3.0);
            let mut points: Vec<DVec2> =
                angles.iter().map(|&a| math::direction(a) * DVec2::new(stretch, 1.0)).collect();
            if dent {
                points[1] *= 0.01;
            }
            let polygon: Vec<u32> = (0..points.len() as u32).collect();
            let size = UvBox::from_points(points.iter().copied()).size();
            let brute = (0..points.len()).all(|i| {
                let n = points.len();
                (0..n).all(|k| orient(points[i], points[(i + 1) % n], points[k]) >= 0.0)
            });
            prop_assert_eq!(is_convex(&points, &polygon, size), brute);
            if brute {
                let triangles = zigzag(&points, &polygon);
                prop_assert_eq!(triangles.len(), points.len() - 2);
                let whole: f64 =
                    (0..points.len()).map(|i| 0.5 * points[i].perp_dot(points[(i + 1) % points.len()])).sum();
                prop_assert!((area(&points, &triangles) - whole).abs() < 1e-9 * whole);
            }
        }
    }
}
