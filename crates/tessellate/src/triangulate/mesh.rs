//! A triangulation that points can be inserted into and whose edges can be flipped.
//!
//! Flips follow the Delaunay criterion in a metric that varies from vertex to vertex: the angles opposite an
//! edge, measured in the mean metric of its four vertices, must not sum to more than π. In a varying metric
//! no theorem guarantees an end, so the number of flips per call is bounded.

use crate::metric::Metric;
use chordal_nurbs::DVec2;
use chordal_nurbs::orient;
use rustc_hash::FxHashMap;

/// No neighbour: the edge is on the boundary.
pub const NONE: u32 = u32::MAX;

/// Where a point lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Location {
    Inside(u32),
    /// On the edge opposite this corner of this triangle.
    OnEdge(u32, usize),
    OnVertex,
    Outside,
}

/// A plane triangulation with neighbours; `neighbors[t][i]` lies across the edge opposite corner `i`.
#[derive(Clone, Debug, Default)]
pub struct Triangulation {
    pub points: Vec<DVec2>,
    pub triangles: Vec<[u32; 3]>,
    pub neighbors: Vec<[u32; 3]>,
    /// Triangles that changed since the list was last cleared; one may occur several times.
    pub changed: Vec<u32>,
    stack: Vec<(u32, u32)>,
}

fn after(i: usize) -> usize {
    if i == 2 { 0 } else { i + 1 }
}
fn before(i: usize) -> usize {
    if i == 0 { 2 } else { i - 1 }
}

impl Triangulation {
    /// Links triangles along their shared edges.
    pub fn new(points: Vec<DVec2>, triangles: Vec<[u32; 3]>) -> Self {
        let mut neighbors = vec![[NONE; 3]; triangles.len()];
        let mut open: FxHashMap<(u32, u32), (u32, u32)> = FxHashMap::default();
        open.reserve(triangles.len() * 3 / 2);
        for (t, corners) in triangles.iter().enumerate() {
            for i in 0..3 {
                let (a, b) = (corners[after(i)], corners[before(i)]);
                if let Some((other, j)) = open.remove(&(b, a)) {
                    neighbors[t][i] = other;
                    neighbors[other as usize][j as usize] = t as u32;
                } else {
                    open.insert((a, b), (t as u32, i as u32));
                }
            }
        }
        Self { points, triangles, neighbors, changed: Vec::new(), stack: Vec::new() }
    }

    pub fn corners(&self, t: u32) -> [DVec2; 3] {
        self.triangles[t as usize].map(|v| self.points[v as usize])
    }

    /// Walks from triangle `from` towards `p`; where the boundary is in the way, searches all triangles.
    pub fn locate(&self, p: DVec2, from: u32) -> Location {
        let mut t = from;
        let mut came_from = NONE;
        for _ in 0..self.triangles.len() + 3 {
            let corners = self.corners(t);
            let mut next = None;
            for i in 0..3 {
                let across = self.neighbors[t as usize][i];
                if across != came_from || across == NONE {
                    let side = orient(corners[after(i)], corners[before(i)], p);
                    if side < 0.0 {
                        next = Some(across);
                        if across != NONE {
                            break;
                        }
                    }
                }
            }
            match next {
                None => return self.place_in(t, p),
                Some(NONE) => return self.search(p),
                Some(across) => {
                    came_from = t;
                    t = across;
                }
            }
        }
        self.search(p)
    }

    fn search(&self, p: DVec2) -> Location {
        let found = (0..self.triangles.len() as u32).find(|&t| {
            let [a, b, c] = self.corners(t);
            let inside_box = p.x >= a.x.min(b.x).min(c.x)
                && p.x <= a.x.max(b.x).max(c.x)
                && p.y >= a.y.min(b.y).min(c.y)
                && p.y <= a.y.max(b.y).max(c.y);
            inside_box && orient(a, b, p) >= 0.0 && orient(b, c, p) >= 0.0 && orient(c, a, p) >= 0.0
        });
        found.map_or(Location::Outside, |t| self.place_in(t, p))
    }

    fn place_in(&self, t: u32, p: DVec2) -> Location {
        let corners = self.corners(t);
        if corners.contains(&p) {
            return Location::OnVertex;
        }
        let on = (0..3).find(|&i| orient(corners[after(i)], corners[before(i)], p) == 0.0);
        on.map_or(Location::Inside(t), |i| Location::OnEdge(t, i))
    }

    /// Inserts `p` and restores the Delaunay criterion around it; `metrics` must already hold one more entry
    /// than there are points. Returns the new vertex, or `None` on a boundary edge, on a vertex or outside.
    pub fn insert(&mut self, p: DVec2, at: Location, metrics: &[Metric]) -> Option<u32> {
        let vertex = self.points.len() as u32;
        match at {
            Location::Inside(t) => {
                self.points.push(p);
                self.split_triangle(t, vertex);
            }
            Location::OnEdge(t, i) if self.neighbors[t as usize][i] != NONE => {
                self.points.push(p);
                self.split_edge(t, i, vertex);
            }
            _ => return None,
        }
        self.flip(metrics, &|_, _, _, _| true);
        Some(vertex)
    }

    /// Where to insert a point on the inner edge of `t` opposite corner `i`, even if rounding moved it off
    /// the edge.
    pub fn locate_on(&self, t: u32, i: usize, p: DVec2) -> Location {
        let other = self.neighbors[t as usize][i];
        let splits = |(apex, a, b): (u32, u32, u32)| {
            let [apex, a, b] = [apex, a, b].map(|v| self.points[v as usize]);
            orient(apex, a, p) > 0.0 && orient(apex, p, b) > 0.0
        };
        if other != NONE
            && splits(self.rotated(t, i))
            && splits(self.rotated(other, self.corner_facing(other, t)))
        {
            return Location::OnEdge(t, i);
        }
        self.locate(p, t)
    }

    fn relink(&mut self, t: u32, old: u32, new: u32) {
        if t != NONE {
            for n in &mut self.neighbors[t as usize] {
                if *n == old {
                    *n = new;
                    return;
                }
            }
        }
    }

    fn add(&mut self, corners: [u32; 3], neighbors: [u32; 3]) -> u32 {
        self.triangles.push(corners);
        self.neighbors.push(neighbors);
        self.triangles.len() as u32 - 1
    }

    fn set(&mut self, t: u32, corners: [u32; 3], neighbors: [u32; 3]) {
        self.triangles[t as usize] = corners;
        self.neighbors[t as usize] = neighbors;
    }

    fn split_triangle(&mut self, t: u32, v: u32) {
        let [a, b, c] = self.triangles[t as usize];
        let [na, nb, nc] = self.neighbors[t as usize];
        let t1 = self.triangles.len() as u32;
        let t2 = t1 + 1;
        // t = (a, b, v), t1 = (b, c, v), t2 = (c, a, v)
        self.set(t, [a, b, v], [t1, t2, nc]);
        self.add([b, c, v], [t2, t, na]);
        self.add([c, a, v], [t, t1, nb]);
        self.relink(na, t, t1);
        self.relink(nb, t, t2);
        for t in [t, t1, t2] {
            self.changed.push(t);
            self.stack.push((t, v));
        }
    }

    fn split_edge(&mut self, t: u32, i: usize, v: u32) {
        let other = self.neighbors[t as usize][i];
        let j = self.corner_facing(other, t);
        let (apex, a, b) = self.rotated(t, i);
        let (apex2, b2, a2) = self.rotated(other, j);
        debug_assert!(a == a2 && b == b2);
        let (n_b, n_a) = (self.neighbors[t as usize][after(i)], self.neighbors[t as usize][before(i)]);
        let (m_a, m_b) =
            (self.neighbors[other as usize][after(j)], self.neighbors[other as usize][before(j)]);
        // Left of a→b: (apex, a, v) stays t, (apex, v, b) is t1; right: (apex2, b, v) is t2, (apex2, v, a)
        // stays other.
        let t1 = self.triangles.len() as u32;
        let t2 = t1 + 1;
        self.set(t, [apex, a, v], [other, t1, n_a]);
        self.add([apex, v, b], [t2, n_b, t]);
        self.add([apex2, b, v], [t1, other, m_b]);
        self.set(other, [apex2, v, a], [t, m_a, t2]);
        self.relink(n_b, t, t1);
        self.relink(m_b, other, t2);
        for t in [t, t1, t2, other] {
            self.changed.push(t);
            self.stack.push((t, v));
        }
    }

    /// The corner of `t` opposite its edge with `neighbor`.
    fn corner_facing(&self, t: u32, neighbor: u32) -> usize {
        (0..3).find(|&i| self.neighbors[t as usize][i] == neighbor).unwrap_or(0)
    }

    /// The corners of `t` from corner `i` on.
    fn rotated(&self, t: u32, i: usize) -> (u32, u32, u32) {
        let c = self.triangles[t as usize];
        (c[i], c[after(i)], c[before(i)])
    }

    /// Flips all edges until the criterion holds everywhere, where `allowed(apex, a, b, apex2)` lets it.
    pub fn flip_all(&mut self, metrics: &[Metric], allowed: &dyn Fn(u32, u32, u32, u32) -> bool) {
        for t in 0..self.triangles.len() {
            for i in 0..3 {
                if self.neighbors[t][i] != NONE && self.neighbors[t][i] > t as u32 {
                    self.stack.push((t as u32, self.triangles[t][i]));
                }
            }
        }
        self.flip(metrics, allowed);
    }

    /// Processes the stack of (triangle, corner opposite the edge in question).
    fn flip(&mut self, metrics: &[Metric], allowed: &dyn Fn(u32, u32, u32, u32) -> bool) {
        let mut left = 64 + 16 * self.triangles.len();
        while let Some((t, apex)) = self.stack.pop() {
            let Some(i) = self.triangles[t as usize].iter().position(|&v| v == apex) else { continue };
            let other = self.neighbors[t as usize][i];
            if other == NONE || left == 0 {
                continue;
            }
            let j = self.corner_facing(other, t);
            let (_, a, b) = self.rotated(t, i);
            let apex2 = self.triangles[other as usize][j];
            if self.wants_flip(apex, a, b, apex2, metrics)
                && allowed(apex, a, b, apex2)
                && self.can_flip(apex, a, b, apex2)
            {
                left -= 1;
                self.flip_edge(t, i);
                for (t, v) in [(t, apex), (other, apex), (t, apex2), (other, apex2)] {
                    self.stack.push((t, v));
                }
            }
        }
    }

    /// Exact: the four corners form a strictly convex quadrilateral.
    pub fn can_flip(&self, apex: u32, a: u32, b: u32, apex2: u32) -> bool {
        let [c, a, b, d] = [apex, a, b, apex2].map(|v| self.points[v as usize]);
        orient(a, d, c) > 0.0 && orient(d, b, c) > 0.0
    }

    fn wants_flip(&self, apex: u32, a: u32, b: u32, apex2: u32, metrics: &[Metric]) -> bool {
        let m = Metric::mean([apex, a, b, apex2].map(|v| metrics[v as usize]));
        let [c, a, b, d] = [apex, a, b, apex2].map(|v| self.points[v as usize]);
        let (ca, cb, da, db) = (a - c, b - c, a - d, b - d);
        let (area_c, area_d) = (ca.perp_dot(cb).abs(), da.perp_dot(db).abs());
        let (dot_c, dot_d) = (m.dot(ca, cb), m.dot(da, db));
        // sin(γ + δ) < 0, with a margin against flipping the same co-circular edge back and forth.
        area_c * dot_d + area_d * dot_c < -1e-9 * (area_c * dot_d.abs() + area_d * dot_c.abs())
    }

    /// Replaces the edge opposite corner `i` of `t` by the other diagonal; `t` keeps (apex, a, apex2), its
    /// neighbour becomes (apex, apex2, b).
    pub fn flip_edge(&mut self, t: u32, i: usize) {
        let other = self.neighbors[t as usize][i];
        let j = self.corner_facing(other, t);
        let (apex, a, b) = self.rotated(t, i);
        let apex2 = self.triangles[other as usize][j];
        let (n_b, n_a) = (self.neighbors[t as usize][after(i)], self.neighbors[t as usize][before(i)]);
        let (m_a, m_b) =
            (self.neighbors[other as usize][after(j)], self.neighbors[other as usize][before(j)]);
        // Opposite a in t lies n_b's edge (b, apex); in `other` opposite b lies the edge (a, apex2) = m_a's.
        self.set(t, [apex, a, apex2], [m_a, other, n_a]);
        self.set(other, [apex, apex2, b], [m_b, n_b, t]);
        self.relink(m_a, other, t);
        self.relink(n_b, t, other);
        self.changed.push(t);
        self.changed.push(other);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn check(mesh: &Triangulation) {
        for t in 0..mesh.triangles.len() as u32 {
            let [a, b, c] = mesh.corners(t);
            assert!(orient(a, b, c) > 0.0);
            for i in 0..3 {
                let other = mesh.neighbors[t as usize][i];
                if other == NONE {
                    continue;
                }
                let j = mesh.corner_facing(other, t);
                assert_eq!(mesh.neighbors[other as usize][j], t);
                let (_, a, b) = mesh.rotated(t, i);
                let (_, b2, a2) = mesh.rotated(other, j);
                assert_eq!((a, b), (a2, b2));
            }
        }
    }

    proptest! {
        #[test]
        fn insertion_keeps_a_delaunay_triangulation(
            inner in prop::collection::vec((0.01f64..0.99, 0.01f64..0.99), 1..80),
            grid in any::<bool>(),
        ) {
            let points = vec![DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
            let mut mesh = Triangulation::new(points, vec![[0, 1, 2], [0, 2, 3]]);
            let unit = Metric { uu: 1.0, uv: 0.0, vv: 1.0 };
            let metrics = vec![unit; 200];
            for (u, v) in inner {
                // Points on a grid hit edges and vertices exactly.
                let free = DVec2::new(u, v);
                let p = if grid { (free * 8.0).round() / 8.0 } else { free };
                let at = mesh.locate(p, 0);
                mesh.insert(p, at, &metrics);
                check(&mesh);
            }
            let total: f64 = (0..mesh.triangles.len() as u32)
                .map(|t| { let [a, b, c] = mesh.corners(t); 0.5 * (b - a).perp_dot(c - a) })
                .sum();
            prop_assert!((total - 1.0).abs() < 1e-12);
            for t in 0..mesh.triangles.len() as u32 {
                for i in 0..3 {
                    let other = mesh.neighbors[t as usize][i];
                    if other != NONE {
                        let (apex, a, b) = mesh.rotated(t, i);
                        let apex2 = mesh.triangles[other as usize][mesh.corner_facing(other, t)];
                        prop_assert!(!mesh.wants_flip(apex, a, b, apex2, &metrics));
                    }
                }
            }
        }
    }
}
