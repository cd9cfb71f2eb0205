//! The borders of leaves as a mesh: unique vertices, edges that know their faces, edges that can be split.
//!
//! Source: Kahlesz, Balázs, Klein 2001, section 2. Vertices are kept in lexicographic order, so that no place
//! can have two; an edge has the faces on its sides (more than two where a mesh is not manifold) and a
//! direction, once a curve ran along it.

use super::borders::Borders;
use chordal_nurbs::{DVec2, UvBox};
use std::collections::BTreeMap;

/// An edge between two vertices.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LeafEdge {
    pub faces: Vec<u32>,
    /// The curve along it ran from the smaller vertex to the larger one, or back.
    pub forward: Option<bool>,
}

/// Rectangular leaves with the vertices and edges around them.
#[derive(Debug)]
pub struct LeafMesh {
    pub leaves: Vec<UvBox>,
    pub vertices: Vec<DVec2>,
    /// Smaller vertex first.
    pub edges: BTreeMap<(u32, u32), LeafEdge>,
    /// The vertices at the ends of each vertex's edges.
    neighbors: Vec<Vec<u32>>,
    /// The edges around each leaf.
    around: Vec<Vec<(u32, u32)>>,
    bins: Vec<Vec<u32>>,
    side: usize,
    bounds: UvBox,
    /// Places nearer than this along both parameters are one.
    pub same: DVec2,
}

/// The share of the whole that is one place.
const SAME: f64 = 1e-11;

fn key(a: u32, b: u32) -> (u32, u32) {
    (a.min(b), a.max(b))
}

impl LeafMesh {
    /// Of leaves that tile their common box.
    pub fn new(leaves: Vec<UvBox>) -> Self {
        let borders = Borders::new(&leaves);
        let bounds = UvBox::from_points(leaves.iter().flat_map(|b| [b.min, b.max]));
        let side = ((leaves.len() as f64).sqrt().ceil() as usize).clamp(1, 512);
        let mut mesh = Self {
            neighbors: vec![Vec::new(); borders.corners.len()],
            vertices: borders.corners.clone(),
            edges: BTreeMap::new(),
            around: Vec::with_capacity(leaves.len()),
            bins: vec![Vec::new(); side * side],
            side,
            bounds,
            same: bounds.size() * SAME,
            leaves,
        };
        for leaf in 0..mesh.leaves.len() {
            let ring = borders.ring(mesh.leaves[leaf]);
            mesh.add_face(leaf as u32, &ring);
            for bin in mesh.bins_of(mesh.leaves[leaf]) {
                mesh.bins[bin].push(leaf as u32);
            }
        }
        mesh
    }

    fn add_face(&mut self, face: u32, ring: &[u32]) {
        let n = ring.len();
        let sides: Vec<(u32, u32)> = (0..n).map(|i| key(ring[i], ring[(i + 1) % n])).collect();
        sides.iter().for_each(|&(a, b)| self.add_edge(a, b).faces.push(face));
        self.around.push(sides);
    }

    fn add_edge(&mut self, a: u32, b: u32) -> &mut LeafEdge {
        if !self.edges.contains_key(&key(a, b)) {
            self.neighbors[a as usize].push(b);
            self.neighbors[b as usize].push(a);
        }
        self.edges.entry(key(a, b)).or_default()
    }

    fn bins_of(&self, b: UvBox) -> impl Iterator<Item = usize> + use<> {
        let side = self.side;
        let bin = |t: f64, axis: usize| {
            let at = (t - self.bounds.min[axis]) / self.bounds.size()[axis] * side as f64;
            if at > 0.0 { (at as usize).min(side - 1) } else { 0 }
        };
        let [u0, u1] = [bin(b.min.x, 0), bin(b.max.x, 0)];
        let [v0, v1] = [bin(b.min.y, 1), bin(b.max.y, 1)];
        (v0..=v1).flat_map(move |j| (u0..=u1).map(move |i| j * side + i))
    }

    /// The leaves that hold a place, their borders included.
    pub fn leaves_at(&self, p: DVec2) -> Vec<u32> {
        let around = UvBox::new(p, p).inflated(self.same);
        let mut found: Vec<u32> = self.bins_of(around).flat_map(|b| self.bins[b].iter().copied()).collect();
        found.sort_unstable();
        found.dedup();
        found.retain(|&leaf| {
            let b = self.leaves[leaf as usize];
            b.min.cmple(around.max).all() && b.max.cmpge(around.min).all()
        });
        found
    }

    /// True where two places are one.
    pub fn is_same(&self, p: DVec2, q: DVec2) -> bool {
        (p - q).abs().cmple(self.same).all()
    }

    /// The vertex at this place on the border of a leaf: one that is there, or a new one that splits an edge.
    pub fn vertex_on(&mut self, leaf: u32, p: DVec2) -> Option<u32> {
        let sides = &self.around[leaf as usize];
        let at = |v: u32| self.vertices[v as usize];
        let there = sides.iter().flat_map(|&(a, b)| [a, b]).find(|&v| self.is_same(at(v), p));
        if there.is_some() {
            return there;
        }
        let holds = |&&(a, b): &&(u32, u32)| {
            let (low, high) = (at(a).min(at(b)) - self.same, at(a).max(at(b)) + self.same);
            p.cmpge(low).all() && p.cmple(high).all()
        };
        let &edge = sides.iter().find(holds)?;
        Some(self.split_edge(edge, p))
    }

    /// Splits an edge at a place on it; both halves keep its faces and its direction.
    pub fn split_edge(&mut self, (a, b): (u32, u32), p: DVec2) -> u32 {
        let (from, to) = (self.vertices[a as usize], self.vertices[b as usize]);
        let mut at = p;
        // Exactly on the line: all leaves there agree on its coordinate.
        let fixed = usize::from(from.x != to.x);
        at[fixed] = from[fixed];
        let new = self.vertices.len() as u32;
        self.vertices.push(at);
        let Some(edge) = self.edges.remove(&(a, b)) else { return new };
        self.neighbors.push(vec![a, b]);
        for (end, other) in [(a, b), (b, a)] {
            self.neighbors[end as usize].iter_mut().filter(|v| **v == other).for_each(|v| *v = new);
        }
        for &face in &edge.faces {
            let sides = &mut self.around[face as usize];
            sides.retain(|&side| side != (a, b));
            sides.extend([key(a, new), key(new, b)]);
        }
        let half = |from: u32, to: u32| {
            let forward = edge.forward.map(|forward| forward == (from < to));
            (key(from, to), LeafEdge { faces: edge.faces.clone(), forward })
        };
        self.edges.extend([half(a, new), half(new, b)]);
        new
    }

    /// The other ends of a vertex's edges.
    pub fn neighbors(&self, v: u32) -> &[u32] {
        &self.neighbors[v as usize]
    }

    /// Books that a curve ran along an edge.
    pub fn direct(&mut self, from: u32, to: u32) {
        if let Some(edge) = self.edges.get_mut(&key(from, to)) {
            edge.forward = Some(from < to);
        }
    }

    /// Edges with more than two faces.
    #[cfg(test)]
    pub fn non_manifold(&self) -> usize {
        self.edges.values().filter(|e| e.faces.len() > 2).count()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cell(a: (f64, f64), b: (f64, f64)) -> UvBox {
        UvBox::new(DVec2::from(a), DVec2::from(b))
    }

    fn three() -> LeafMesh {
        LeafMesh::new(vec![cell((-1., 0.), (1., 2.)), cell((1., 0.), (2., 1.)), cell((1., 1.), (2., 2.))])
    }

    #[test]
    fn vertices_are_unique_and_edges_know_their_faces() {
        let mesh = three();
        assert_eq!((mesh.vertices.len(), mesh.edges.len()), (8, 10));
        let inner = mesh.edges.values().filter(|e| e.faces.len() == 2).count();
        assert_eq!((inner, mesh.non_manifold()), (3, 0));
        // Euler: vertices − edges + faces of a disc.
        assert_eq!(mesh.vertices.len() + mesh.leaves.len() - mesh.edges.len(), 1);
        assert_eq!(mesh.leaves_at(DVec2::ONE), [0, 1, 2]);
        assert_eq!(mesh.leaves_at(DVec2::new(1.5, 0.5)), [1]);
    }

    #[test]
    fn a_third_face_at_an_edge_is_seen() {
        let mut mesh = three();
        let ring: Vec<u32> = [(1., 0.), (1., 1.), (2., 1.)]
            .map(|p| mesh.vertices.iter().position(|&v| v == DVec2::from(p)).expect("there") as u32)
            .to_vec();
        mesh.add_face(3, &ring);
        assert_eq!(mesh.non_manifold(), 2);
    }

    #[test]
    fn a_split_edge_leaves_the_mesh_consistent() {
        let mut mesh = three();
        let before = mesh.edges.len();
        let new = mesh.vertex_on(0, DVec2::new(1.0 + 1e-13, 0.25)).expect("on the border");
        assert_eq!(mesh.vertices[new as usize], DVec2::new(1.0, 0.25));
        assert_eq!(mesh.edges.len(), before + 1);
        assert_eq!(mesh.vertex_on(1, DVec2::new(1.0, 0.25)), Some(new), "the neighbour knows it");
        assert_eq!(mesh.neighbors(new).len(), 2);
        for (leaf, sides) in mesh.around.iter().enumerate() {
            for side in sides {
                assert!(mesh.edges[side].faces.contains(&(leaf as u32)));
            }
        }
        assert_eq!(mesh.vertex_on(0, DVec2::new(0.0, 1.0)), None, "inside");
    }
}
