//! Edges forced into a triangulation by flips.
//!
//! Source: Sloan 1993, *A fast algorithm for generating constrained Delaunay triangulations*: every edge that
//! crosses the new edge is flipped, as soon as its two triangles form a convex quadrilateral, until no edge
//! crosses it. All decisions are exact. An edge that would cross a fixed edge, or the boundary, is refused,
//! and the triangulation stays valid.

use chordal_tessellate::method::{NONE, Triangulation, orient};
use rustc_hash::FxHashSet;
use std::collections::VecDeque;

/// A triangulation some of whose edges are fixed.
pub struct Constrained<'m> {
    mesh: &'m mut Triangulation,
    /// A triangle at each vertex.
    incident: Vec<u32>,
    /// Fixed edges, smaller vertex first.
    pub fixed: FxHashSet<(u32, u32)>,
}

fn key(a: u32, b: u32) -> (u32, u32) {
    (a.min(b), a.max(b))
}

/// What is found in the direction from one vertex to another.
enum Ahead {
    /// The edge is there.
    Edge,
    /// This vertex lies on the way.
    Vertex(u32),
    /// The edge of this triangle opposite this corner is crossed.
    Crossing(u32, usize),
    /// Out of the triangulation.
    Nothing,
}

impl<'m> Constrained<'m> {
    pub fn new(mesh: &'m mut Triangulation) -> Self {
        let mut incident = vec![NONE; mesh.points.len()];
        for (t, corners) in mesh.triangles.iter().enumerate() {
            corners.iter().for_each(|&v| incident[v as usize] = t as u32);
        }
        Self { mesh, incident, fixed: FxHashSet::default() }
    }

    /// Makes `a`–`b` an edge and fixes it; where vertices lie between them, fixes the pieces. False where a
    /// fixed edge or the boundary is crossed.
    pub fn force(&mut self, a: u32, b: u32) -> bool {
        let mut from = a;
        // A straight line passes through every vertex at most once.
        for _ in 0..self.mesh.points.len() {
            match self.force_to_next(from, b) {
                Some(reached) if reached == b => return true,
                Some(reached) => from = reached,
                None => return false,
            }
        }
        false
    }

    /// Fixes the edge from `a` towards `b` as far as the first vertex on the way, and returns that.
    fn force_to_next(&mut self, a: u32, b: u32) -> Option<u32> {
        let (t, i) = match self.ahead(a, b) {
            Ahead::Edge => {
                self.fixed.insert(key(a, b));
                return Some(b);
            }
            Ahead::Vertex(v) => {
                self.fixed.insert(key(a, v));
                return Some(v);
            }
            Ahead::Crossing(t, i) => (t, i),
            Ahead::Nothing => return None,
        };
        let (crossed, end) = self.crossed(t, i, a, b)?;
        self.flip_away(crossed, a, end)?;
        self.fixed.insert(key(a, end));
        Some(end)
    }

    /// The triangles around a vertex, each with the vertex's corner: one way round from the one that is
    /// known, then the other.
    fn star(&self, v: u32) -> Star<'_> {
        let first = self.incident[v as usize];
        Star { mesh: &*self.mesh, vertex: v, first, at: first, turn: 1 }
    }

    /// The triangle with the directed edge p → q, and the corner opposite to it. Walks around both ends at
    /// once: one of them may have thousands of triangles, where the crossings of borders with a long chord
    /// moved to its end.
    fn find_edge(&self, p: u32, q: u32) -> Option<(u32, usize)> {
        let (mut around_p, mut around_q) = (self.star(p), self.star(q));
        loop {
            let (t, i) = around_p.next()?;
            if self.mesh.triangles[t as usize][(i + 1) % 3] == q {
                return Some((t, (i + 2) % 3));
            }
            let (t, i) = around_q.next()?;
            if self.mesh.triangles[t as usize][(i + 2) % 3] == p {
                return Some((t, (i + 1) % 3));
            }
        }
    }

    fn is_edge(&self, a: u32, b: u32) -> bool {
        self.find_edge(a, b).or_else(|| self.find_edge(b, a)).is_some()
    }

    fn side(&self, a: u32, b: u32, v: u32) -> f64 {
        let [a, b, v] = [a, b, v].map(|i| self.mesh.points[i as usize]);
        orient(a, b, v)
    }

    fn ahead(&self, a: u32, b: u32) -> Ahead {
        let point = |v: u32| self.mesh.points[v as usize];
        if self.is_edge(a, b) {
            return Ahead::Edge;
        }
        for (t, i) in self.star(a) {
            let c = self.mesh.triangles[t as usize];
            let (p, q) = (c[(i + 1) % 3], c[(i + 2) % 3]);
            let (right, left) = (self.side(a, b, p), self.side(a, b, q));
            for (v, side) in [(p, right), (q, left)] {
                let along = point(b) - point(a);
                let step = point(v) - point(a);
                if side == 0.0 && step.dot(along) > 0.0 && step.length_squared() < along.length_squared() {
                    return Ahead::Vertex(v);
                }
            }
            if right < 0.0 && left > 0.0 {
                return Ahead::Crossing(t, i);
            }
        }
        Ahead::Nothing
    }

    /// The edges that a–b crosses, as pairs of vertices, up to `b` or the first vertex on the way.
    fn crossed(&self, t: u32, i: usize, a: u32, b: u32) -> Option<(VecDeque<(u32, u32)>, u32)> {
        let mut crossed = VecDeque::new();
        let (mut t, mut i) = (t, i);
        for _ in 0..self.mesh.triangles.len() {
            let c = self.mesh.triangles[t as usize];
            let (p, q) = (c[(i + 1) % 3], c[(i + 2) % 3]);
            let across = self.mesh.neighbors[t as usize][i];
            if across == NONE || self.fixed.contains(&key(p, q)) {
                return None;
            }
            crossed.push_back((p, q));
            let j = (0..3).find(|&j| self.mesh.neighbors[across as usize][j] == t)?;
            let apex = self.mesh.triangles[across as usize][j];
            if apex == b {
                return Some((crossed, b));
            }
            let side = self.side(a, b, apex);
            if side == 0.0 {
                return Some((crossed, apex));
            }
            // The next edge crossed lies between the apex and the corner on the other side of the line.
            let keep = if side > 0.0 { p } else { q };
            let next = self.mesh.triangles[across as usize];
            i = (0..3).find(|&k| next[k] != apex && next[k] != keep)?;
            t = across;
        }
        None
    }

    fn flip_away(&mut self, mut crossed: VecDeque<(u32, u32)>, a: u32, b: u32) -> Option<()> {
        let mut left = 64 + 16 * crossed.len() * crossed.len().min(1000);
        while let Some((p, q)) = crossed.pop_front() {
            left = left.checked_sub(1)?;
            let (t, i) = self.find_edge(p, q)?;
            let c = self.mesh.triangles[t as usize];
            let other = self.mesh.neighbors[t as usize][i];
            let j = (0..3).find(|&j| self.mesh.neighbors[other as usize][j] == t)?;
            let (apex, apex2) = (c[i], self.mesh.triangles[other as usize][j]);
            if !self.mesh.can_flip(apex, p, q, apex2) {
                crossed.push_back((p, q));
                continue;
            }
            self.flip(t, i, other);
            if [apex, apex2].contains(&a) || [apex, apex2].contains(&b) {
                continue;
            }
            let (x, y) = (self.side(a, b, apex), self.side(a, b, apex2));
            if x > 0.0 && y < 0.0 || x < 0.0 && y > 0.0 {
                crossed.push_back((apex, apex2));
            }
        }
        Some(())
    }

    fn flip(&mut self, t: u32, i: usize, other: u32) {
        self.mesh.flip_edge(t, i);
        for t in [t, other] {
            for v in self.mesh.triangles[t as usize] {
                self.incident[v as usize] = t;
            }
        }
        self.mesh.changed.clear();
    }
}

/// Walks around a vertex.
struct Star<'m> {
    mesh: &'m Triangulation,
    vertex: u32,
    first: u32,
    /// The next triangle.
    at: u32,
    /// 1, then 2 where a border was met.
    turn: usize,
}

impl Iterator for Star<'_> {
    type Item = (u32, usize);

    fn next(&mut self) -> Option<(u32, usize)> {
        loop {
            let corner = |t: u32| self.mesh.triangles[t as usize].iter().position(|&c| c == self.vertex);
            let found = (self.at != NONE).then(|| corner(self.at)).flatten();
            match found {
                Some(i) => {
                    let t = self.at;
                    self.at = self.mesh.neighbors[t as usize][(i + self.turn) % 3];
                    // All the way round.
                    if self.at == self.first {
                        (self.at, self.turn) = (NONE, 2);
                    }
                    return Some((t, i));
                }
                None if self.turn == 1 => {
                    self.turn = 2;
                    let i = (self.first != NONE).then(|| corner(self.first)).flatten()?;
                    self.at = self.mesh.neighbors[self.first as usize][(i + 2) % 3];
                }
                None => return None,
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use chordal_nurbs::DVec2;
    use chordal_tessellate::method::{Location, Metric};
    use proptest::prelude::*;

    /// The unit square with points inside.
    fn square(inner: &[DVec2]) -> Triangulation {
        let points = vec![DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
        let mut mesh = Triangulation::new(points, vec![[0, 1, 2], [0, 2, 3]]);
        let metrics = vec![Metric { uu: 1.0, uv: 0.0, vv: 1.0 }; inner.len() + 4];
        for &p in inner {
            let at = mesh.locate(p, 0);
            if matches!(at, Location::Inside(_) | Location::OnEdge(..)) {
                mesh.insert(p, at, &metrics);
            }
        }
        mesh
    }

    fn has_edge(mesh: &Triangulation, a: u32, b: u32) -> bool {
        mesh.triangles.iter().any(|t| t.contains(&a) && t.contains(&b))
    }

    fn area(mesh: &Triangulation) -> f64 {
        (0..mesh.triangles.len() as u32)
            .map(|t| {
                let [a, b, c] = mesh.corners(t);
                assert!(orient(a, b, c) > 0.0);
                0.5 * (b - a).perp_dot(c - a)
            })
            .sum()
    }

    #[test]
    fn a_diagonal_through_a_vertex_becomes_two_edges() {
        let mut mesh = square(&[DVec2::new(0.5, 0.5), DVec2::new(0.5, 0.3), DVec2::new(0.5, 0.7)]);
        let mut c = Constrained::new(&mut mesh);
        assert!(c.force(1, 3));
        assert!(c.fixed.contains(&(1, 4)) && c.fixed.contains(&(3, 4)));
        assert!(!c.force(0, 2) || c.fixed.contains(&(0, 4)), "through the same vertex");
        assert!(!c.force(5, 2), "crosses a fixed edge");
    }

    proptest! {
        #[test]
        fn forced_edges_are_there_and_the_triangulation_stays_whole(
            inner in prop::collection::vec((1u32..32, 1u32..32), 2..60),
            pairs in prop::collection::vec((0usize..64, 0usize..64), 1..20),
        ) {
            let inner: Vec<DVec2> =
                inner.iter().map(|&(x, y)| DVec2::new(f64::from(x), f64::from(y)) / 32.0).collect();
            let mut mesh = square(&inner);
            let n = mesh.points.len();
            let mut c = Constrained::new(&mut mesh);
            let mut kept = Vec::new();
            for (a, b) in pairs {
                let (a, b) = ((a % n) as u32, (b % n) as u32);
                if a != b && c.force(a, b) {
                    kept.extend(c.fixed.iter().copied());
                }
            }
            for &(a, b) in &kept {
                prop_assert!(has_edge(&mesh, a, b));
            }
            prop_assert!((area(&mesh) - 1.0).abs() < 1e-12);
        }

        #[test]
        fn a_single_edge_is_never_refused(
            inner in prop::collection::vec((0.01f64..0.99, 0.01f64..0.99), 2..60),
        ) {
            let inner: Vec<DVec2> = inner.into_iter().map(DVec2::from).collect();
            let mut mesh = square(&inner);
            let last = mesh.points.len() as u32 - 1;
            let mut c = Constrained::new(&mut mesh);
            prop_assert!(c.force(4, last));
            prop_assert!((area(&mesh) - 1.0).abs() < 1e-12);
        }
    }
}
