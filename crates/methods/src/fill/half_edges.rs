//! Trimming by walking along half-edges.
//!
//! Source: Balázs, Guthe, Klein 2004, section 6. Borders of cells and trimming loops together are a planar
//! graph. A trimming edge is *directed*, with the face on its left, and *marked*; a border of a cell is
//! passed from either side.
//!
//! ```text
//! while there is a directed edge:            handle: a directed edge is taken out;
//!     walk from it, always leftmost,                 any other becomes directed, against the walk:
//!     handling every edge, back to its start         what lies behind it is to be visited, too
//!     → one polygon
//! ```
//!
//! What lies to the right of the loops is never visited. A part of the graph that hangs together with nothing
//! else, as a hole within one cell, is tied to the rest by two *bridges*, edges like borders of cells: one to
//! its left, one to its right, each to the nearest vertex that it can see. A polygon around a hole so becomes
//! two without one. The paper ties the corners of the cell to the hole's nearest vertices, which may cross
//! another hole; here bridges cross nothing. All decisions are exact.

use chordal_nurbs::DVec2;
use chordal_tessellate::method::orient;
use std::cmp::Ordering;

/// A polygon that the walk found, counter-clockwise.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Polygon {
    pub nodes: Vec<u32>,
    /// It has a trimming edge, so it need not be convex.
    pub is_marked: bool,
}

/// What the walk found.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Walked {
    pub polygons: Vec<Polygon>,
    pub bridges: usize,
}

/// What may still be done with a half-edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    /// Of an edge without direction.
    Free,
    Directed,
    Gone,
}

/// Borders and trimming loops; half-edge `2k` runs along edge `k`, `2k + 1` against it.
struct Graph<'p> {
    points: &'p [DVec2],
    ends: Vec<[u32; 2]>,
    marked: Vec<bool>,
    state: Vec<State>,
    /// Half-edges that leave each node, counter-clockwise.
    around: Vec<Vec<u32>>,
}

/// Finds the polygons to the left of the `trimming` edges. Edges are pairs of indices of `points`, each pair
/// once, and meet at common points only.
pub fn walk(points: &[DVec2], trimming: &[[u32; 2]], borders: &[[u32; 2]]) -> Walked {
    let mut ends: Vec<[u32; 2]> = trimming.to_vec();
    ends.extend_from_slice(borders);
    let bridges = bridges(points, &ends);
    ends.extend_from_slice(&bridges);
    let mut graph = Graph::new(points, ends, trimming.len());
    let mut found = Walked { bridges: bridges.len(), ..Walked::default() };
    let mut next = 0;
    while let Some(start) = graph.directed_from(&mut next) {
        let mut at = Some(start);
        while let Some(first) = at {
            found.polygons.push(graph.polygon(first));
            at = graph.outgoing(graph.origin(first));
        }
    }
    found
}

impl<'p> Graph<'p> {
    fn new(points: &'p [DVec2], ends: Vec<[u32; 2]>, trimming: usize) -> Self {
        let mut state = vec![State::Free; 2 * ends.len()];
        for k in 0..trimming {
            state[2 * k] = State::Directed;
            state[2 * k + 1] = State::Gone;
        }
        let mut around = vec![Vec::new(); points.len()];
        for (k, [a, b]) in ends.iter().enumerate() {
            around[*a as usize].push(2 * k as u32);
            around[*b as usize].push(2 * k as u32 + 1);
        }
        let marked = (0..ends.len()).map(|k| k < trimming).collect();
        let mut graph = Self { points, ends, marked, state, around };
        let mut around = std::mem::take(&mut graph.around);
        for leaving in &mut around {
            leaving.sort_unstable_by(|&g, &h| graph.turn(g, h));
        }
        graph.around = around;
        graph
    }

    fn origin(&self, h: u32) -> u32 {
        self.ends[h as usize / 2][h as usize % 2]
    }

    fn target(&self, h: u32) -> u32 {
        self.origin(h ^ 1)
    }

    /// Which of two half-edges of one node comes first counter-clockwise from the direction of −x on.
    fn turn(&self, g: u32, h: u32) -> Ordering {
        let [node, p, q] = [self.origin(g), self.target(g), self.target(h)].map(|v| self.points[v as usize]);
        let is_upper = |p: DVec2| p.y > node.y || p.y == node.y && p.x > node.x;
        is_upper(p)
            .cmp(&is_upper(q))
            .then_with(|| 0.0f64.total_cmp(&(orient(node, p, q) + 0.0)))
            .then(g.cmp(&h))
    }

    /// The next directed half-edge in the order of edges.
    fn directed_from(&self, next: &mut usize) -> Option<u32> {
        // A half-edge behind may have become directed since: begin anew once.
        let found =
            |range: std::ops::Range<usize>| range.into_iter().find(|&h| self.state[h] == State::Directed);
        let h = found(*next..self.state.len()).or_else(|| found(0..(*next).min(self.state.len())))?;
        *next = h + 1;
        Some(h as u32)
    }

    /// A directed half-edge that leaves the node.
    fn outgoing(&self, node: u32) -> Option<u32> {
        self.around[node as usize].iter().copied().find(|&h| self.state[h as usize] == State::Directed)
    }

    /// The leftmost way on: the one before the way back, counter-clockwise.
    fn leftmost(&self, h: u32) -> u32 {
        let leaving = &self.around[self.target(h) as usize];
        let back = leaving.partition_point(|&g| self.turn(g, h ^ 1).is_lt());
        leaving[(back + leaving.len() - 1) % leaving.len()]
    }

    fn handle(&mut self, h: u32) {
        let (own, twin) = (h as usize, h as usize ^ 1);
        if self.state[own] == State::Free {
            self.state[twin] = State::Directed;
        }
        self.state[own] = State::Gone;
    }

    /// The polygon to the left of a directed half-edge.
    fn polygon(&mut self, first: u32) -> Polygon {
        let mut polygon = Polygon { nodes: Vec::new(), is_marked: false };
        let mut at = first;
        loop {
            self.handle(at);
            polygon.nodes.push(self.origin(at));
            polygon.is_marked |= self.marked[at as usize / 2];
            at = self.leftmost(at);
            if at == first {
                return polygon;
            }
        }
    }
}

/// Edges that tie the parts of the graph together, two for each part but one.
fn bridges(points: &[DVec2], edges: &[[u32; 2]]) -> Vec<[u32; 2]> {
    let parts = Parts::new(points.len(), edges);
    let mut sorted: Vec<u32> = edges.iter().flatten().copied().collect();
    sorted.sort_unstable_by(|&a, &b| by_x(points, a, b));
    sorted.dedup();
    // Leftmost and rightmost node of each part, parts by their leftmost.
    let mut extremes: Vec<(u32, u32, u32)> = Vec::new();
    for &v in &sorted {
        let part = parts.of(v);
        match extremes.iter_mut().find(|e| e.0 == part) {
            Some(e) => e.2 = v,
            None => extremes.push((part, v, v)),
        }
    }
    let mut made: Vec<[u32; 2]> = Vec::new();
    for &(part, left, right) in extremes.iter().skip(1) {
        for (from, is_left) in [(left, true), (right, false)] {
            let beyond =
                |v: u32| by_x(points, v, from) == if is_left { Ordering::Less } else { Ordering::Greater };
            let mut candidates: Vec<u32> =
                sorted.iter().copied().filter(|&v| parts.of(v) != part && beyond(v)).collect();
            let far = |v: u32| points[v as usize].distance_squared(points[from as usize]);
            candidates.sort_unstable_by(|&a, &b| far(a).total_cmp(&far(b)).then(a.cmp(&b)));
            let sees = |v: &u32| edges.iter().chain(&made).all(|&e| is_clear(points, [from, *v], e));
            if let Some(to) = candidates.into_iter().find(sees) {
                made.push([from, to]);
            }
        }
    }
    made
}

fn by_x(points: &[DVec2], a: u32, b: u32) -> Ordering {
    let (p, q) = (points[a as usize], points[b as usize]);
    p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y)).then(a.cmp(&b))
}

/// A bridge meets an edge at a common end only.
fn is_clear(points: &[DVec2], [a, b]: [u32; 2], [c, d]: [u32; 2]) -> bool {
    let [p, q, r, s] = [a, b, c, d].map(|v| points[v as usize]);
    if p.max(q).cmplt(r.min(s)).any() || r.max(s).cmplt(p.min(q)).any() {
        return true;
    }
    let (r_side, s_side) = (orient(p, q, r), orient(p, q, s));
    let (p_side, q_side) = (orient(r, s, p), orient(r, s, q));
    let between = |x: DVec2, y: DVec2, z: DVec2| {
        let along = (z - x).dot(y - x);
        along > 0.0 && along < (y - x).length_squared()
    };
    let on = [(r_side, p, q, r), (s_side, p, q, s), (p_side, r, s, p), (q_side, r, s, q)]
        .iter()
        .any(|&(side, x, y, z)| side == 0.0 && z != x && z != y && between(x, y, z));
    let is_same = [a, b] == [c, d] || [a, b] == [d, c];
    let crosses = r_side * s_side < 0.0 && p_side * q_side < 0.0;
    !(on || crosses || is_same)
}

/// Which nodes hang together.
struct Parts(Vec<u32>);

impl Parts {
    fn new(nodes: usize, edges: &[[u32; 2]]) -> Self {
        let mut parts = Self((0..nodes as u32).collect());
        for &[a, b] in edges {
            let (x, y) = (parts.of(a), parts.of(b));
            parts.0[x.max(y) as usize] = x.min(y);
            // Shorter ways for later questions.
            parts.0[a as usize] = x.min(y);
            parts.0[b as usize] = x.min(y);
        }
        parts
    }

    fn of(&self, mut node: u32) -> u32 {
        while self.0[node as usize] != node {
            node = self.0[node as usize];
        }
        node
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use chordal_nurbs::math;
    use proptest::prelude::*;

    fn area(points: &[DVec2], nodes: &[u32]) -> f64 {
        let p = |i: usize| points[nodes[i % nodes.len()] as usize];
        (0..nodes.len()).map(|i| 0.5 * (p(i) - p(0)).perp_dot(p(i + 1) - p(0))).sum()
    }

    fn ring(from: u32, count: u32) -> Vec<[u32; 2]> {
        (0..count).map(|i| [from + i, from + (i + 1) % count]).collect()
    }

    #[test]
    fn a_hole_within_a_face_gets_two_bridges() {
        let points =
            [(0., 0.), (4., 0.), (4., 4.), (0., 4.), (1., 1.), (1., 3.), (3., 3.), (3., 1.)].map(DVec2::from);
        let loops = [ring(0, 4), ring(4, 4)].concat();
        let found = walk(&points, &loops, &[]);
        assert_eq!((found.polygons.len(), found.bridges), (2, 2));
        let areas: Vec<f64> = found.polygons.iter().map(|p| area(&points, &p.nodes)).collect();
        assert_eq!(areas.iter().sum::<f64>(), 12.0);
        assert!(areas.iter().all(|a| *a > 0.0) && found.polygons.iter().all(|p| p.is_marked));
    }

    #[test]
    fn only_polygons_at_the_loops_are_marked() {
        // Three by three cells; the loop runs around all of them.
        let points: Vec<DVec2> = (0..16).map(|k| DVec2::new(f64::from(k % 4), f64::from(k / 4))).collect();
        let loops = [
            [0, 1],
            [1, 2],
            [2, 3],
            [3, 7],
            [7, 11],
            [11, 15],
            [15, 14],
            [14, 13],
            [13, 12],
            [12, 8],
            [8, 4],
            [4, 0],
        ];
        let mut borders = Vec::new();
        for j in 1..3 {
            borders.extend((0..3).map(|i| [4 * j + i, 4 * j + i + 1]));
            borders.extend((0..3).map(|i| [4 * i + j, 4 * i + j + 4]));
        }
        let found = walk(&points, &loops, &borders);
        assert_eq!((found.polygons.len(), found.bridges), (9, 0));
        assert_eq!(found.polygons.iter().filter(|p| !p.is_marked).count(), 1);
        assert!(found.polygons.iter().all(|p| p.nodes.len() == 4 && area(&points, &p.nodes) == 1.0));
    }

    proptest! {
        /// Any set of cells of a grid, bounded by trimming edges, some with a hole inside: each cell is
        /// found, nothing else.
        #[test]
        fn sets_of_cells_with_holes_are_covered(kept in prop::collection::vec(0u8..4, 36),
            turn in 0.0f64..6.3) {
            let mut points: Vec<DVec2> =
                (0..49).map(|k| DVec2::new(f64::from(k % 7), f64::from(k / 7))).collect();
            let is_kept = |i: i32,
                j: i32| (0..6).contains(&i) && (0..6).contains(&j) && kept[(6 * j + i) as usize] > 0;
            let node = |i: i32, j: i32| (7 * j + i) as u32;
            let (mut trimming, mut borders) = (Vec::new(), Vec::new());
            let mut side = |a: u32, b: u32, left: bool, right: bool| match (left, right) {
                (true, true) => borders.push([a, b]),
                (true, false) => trimming.push([a, b]),
                (false, true) => trimming.push([b, a]),
                (false, false) => {}
            };
            for j in 0..7 {
                for i in 0..7 {
                    side(node(i, j), node(i + 1, j), is_kept(i, j), is_kept(i, j - 1));
                    side(node(i, j), node(i, j + 1), is_kept(i - 1, j), is_kept(i, j));
                }
            }
            let (mut expected, mut holes) = (0.0, 0);
            for (k, &what) in kept.iter().enumerate() {
                expected += f64::from(u8::from(what > 0));
                // Up to two holes in a cell.
                for hole in 2..what.max(1) + 1 {
                    let first = points.len() as u32;
                    let middle =
                        DVec2::new((k % 6) as f64, (k / 6) as f64) + [0.3, 0.7][usize::from(hole - 2)];
                    let corners = (0..3).map(|c| middle + 0.2 * math::direction(turn - 2.1 * f64::from(c)));
                    points.extend(corners);
                    trimming.extend(ring(first, 3));
                    let nodes = [first, first + 1, first + 2];
                    expected += area(&points, &nodes);
                    holes += 1;
                }
            }
            let found = walk(&points, &trimming, &borders);
            let covered: f64 = found.polygons.iter().map(|p| area(&points, &p.nodes)).sum();
            prop_assert!((covered - expected).abs() < 1e-9, "{covered} {expected}");
            prop_assert!(found.polygons.iter().all(|p| area(&points, &p.nodes) > 0.0));
            if holes > 0 {
                prop_assert!(found.bridges >= 2 * holes);
            }
            // Every trimming edge belongs to one polygon, every border to two.
            let sides: usize = found.polygons.iter().map(|p| p.nodes.len()).sum();
            prop_assert_eq!(sides,
                trimming.len() + 2 * borders.len()
                    + found.polygons.iter().map(|p| bridged(p, &trimming, &borders)).sum::<usize>());
        }
    }

    /// Sides of a polygon that are neither trimming edges nor borders.
    fn bridged(p: &Polygon, trimming: &[[u32; 2]], borders: &[[u32; 2]]) -> usize {
        let n = p.nodes.len();
        let side = |i: usize| [p.nodes[i], p.nodes[(i + 1) % n]];
        (0..n)
            .filter(|&i| {
                let [a, b] = side(i);
                !(trimming.contains(&[a, b]) || borders.contains(&[a, b]) || borders.contains(&[b, a]))
            })
            .count()
    }
}
