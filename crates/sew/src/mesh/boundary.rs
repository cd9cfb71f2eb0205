//! Border edges of a mesh, in chains.
//!
//! Vertices in which several fans of triangles touch are taken apart first, so that a border vertex has two
//! border edges.

use glam::DVec3;

/// A chain of border edges.
#[derive(Clone, Debug, Default)]
pub(crate) struct Boundary {
    /// Vertices in order; of a closed chain the first is not repeated.
    pub vertices: Vec<u32>,
    /// Per edge (from vertex i to i + 1) its triangle, the side of it, and whether the side runs along the
    /// chain.
    pub sides: Vec<(u32, u8, bool)>,
    pub closed: bool,
    /// The length of the chain up to each vertex; of a closed one a last entry with the whole.
    pub along: Vec<f64>,
}

impl Boundary {
    pub fn length(&self) -> f64 {
        self.along[self.along.len() - 1]
    }

    /// Vertices at the ends of edge `k`.
    pub fn edge(&self, k: usize) -> [u32; 2] {
        [self.vertices[k], self.vertices[(k + 1) % self.vertices.len()]]
    }
}

/// A mesh whose vertices were taken apart, with its borders.
#[derive(Clone, Debug, Default)]
pub(crate) struct Boundaries {
    pub positions: Vec<DVec3>,
    pub triangles: Vec<[u32; 3]>,
    /// Per triangle the given one.
    pub sources: Vec<u32>,
    pub all: Vec<Boundary>,
    pub degenerate: usize,
    /// Per vertex, the given vertex.
    pub given: Vec<u32>,
}

/// One side of a triangle, sortable by its edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Side {
    pub edge: [u32; 2],
    pub triangle: u32,
    pub side: u8,
}

/// All sides, those of one edge together.
pub(crate) fn sorted_sides(triangles: &[[u32; 3]]) -> Vec<Side> {
    let mut sides = Vec::with_capacity(3 * triangles.len());
    for (t, corners) in triangles.iter().enumerate() {
        for side in 0..3_u8 {
            let (a, b) = (corners[side as usize], corners[(side as usize + 1) % 3]);
            sides.push(Side { edge: [a.min(b), a.max(b)], triangle: t as u32, side });
        }
    }
    sides.sort_unstable();
    sides
}

impl Boundaries {
    pub fn new(positions: &[DVec3], triangles: &[[u32; 3]]) -> Self {
        let mut found = Self::default();
        for (t, &[a, b, c]) in triangles.iter().enumerate() {
            let p = |i: u32| positions[i as usize];
            if a == b || b == c || c == a || p(a) == p(b) || p(b) == p(c) || p(c) == p(a) {
                found.degenerate += 1;
            } else {
                found.triangles.push([a, b, c]);
                found.sources.push(t as u32);
            }
        }
        found.take_apart(positions);
        found.chain();
        found
    }

    pub fn edges(&self) -> usize {
        self.all.iter().map(|b| b.sides.len()).sum()
    }

    pub fn point(&self, vertex: u32) -> DVec3 {
        self.positions[vertex as usize]
    }

    /// Every fan of triangles around a vertex gets a vertex of its own.
    fn take_apart(&mut self, positions: &[DVec3]) {
        let mut parent: Vec<u32> = (0..3 * self.triangles.len() as u32).collect();
        for group in sorted_sides(&self.triangles).chunk_by(|a, b| a.edge == b.edge) {
            for pair in group.windows(2) {
                for end in 0..2 {
                    let [a, b] = [pair[0], pair[1]].map(|s| corner_at(&self.triangles, s, pair[0].edge[end]));
                    unite(&mut parent, a, b);
                }
            }
        }
        let mut number = vec![u32::MAX; parent.len()];
        for corner in 0..parent.len() {
            let root = root(&mut parent, corner as u32) as usize;
            let given = self.triangles[corner / 3][corner % 3];
            if number[root] == u32::MAX {
                number[root] = self.positions.len() as u32;
                self.positions.push(positions[given as usize]);
                self.given.push(given);
            }
            number[corner] = number[root];
        }
        for (t, triangle) in self.triangles.iter_mut().enumerate() {
            *triangle = std::array::from_fn(|k| number[3 * t + k]);
        }
    }

    /// Follows the edges with a single triangle.
    fn chain(&mut self) {
        let sides = sorted_sides(&self.triangles);
        let border: Vec<Side> =
            sides.chunk_by(|a, b| a.edge == b.edge).filter(|g| g.len() == 1).map(|g| g[0]).collect();
        let mut at: Vec<Vec<u32>> = vec![Vec::new(); self.positions.len()];
        for (i, side) in border.iter().enumerate() {
            side.edge.iter().for_each(|&v| at[v as usize].push(i as u32));
        }
        let mut used = vec![false; border.len()];
        // First the open chains, from their ends; the remaining ones are rings.
        let ends = (0..border.len()).filter(|&i| border[i].edge.iter().any(|&v| at[v as usize].len() != 2));
        let starts: Vec<usize> = ends.chain(0..border.len()).collect();
        for start in starts {
            if used[start] {
                continue;
            }
            let [a, b] = self.along(border[start]);
            let from = if at[a as usize].len() == 2 && at[b as usize].len() != 2 { b } else { a };
            let chain = self.follow(&border, &at, &mut used, start, from);
            self.all.push(chain);
        }
    }

    /// The ends of a side in the direction of its triangle.
    fn along(&self, side: Side) -> [u32; 2] {
        let t = self.triangles[side.triangle as usize];
        [t[side.side as usize], t[(side.side as usize + 1) % 3]]
    }

    fn follow(
        &self,
        border: &[Side],
        at: &[Vec<u32>],
        used: &mut [bool],
        start: usize,
        from: u32,
    ) -> Boundary {
        let mut chain = Boundary { vertices: vec![from], ..Boundary::default() };
        let (mut vertex, mut edge) = (from, start);
        loop {
            used[edge] = true;
            let side = border[edge];
            let next = if side.edge[0] == vertex { side.edge[1] } else { side.edge[0] };
            let runs_along = self.along(side)[0] == vertex;
            chain.sides.push((side.triangle, side.side, runs_along));
            if next == from {
                chain.closed = true;
                break;
            }
            chain.vertices.push(next);
            let on = at[next as usize].iter().find(|&&e| !used[e as usize]);
            match on {
                Some(&e) if at[next as usize].len() == 2 => (vertex, edge) = (next, e as usize),
                _ => break,
            }
        }
        chain.along = vec![0.0];
        for k in 0..chain.sides.len() {
            let [a, b] = chain.edge(k);
            chain.along.push(chain.along[k] + self.point(a).distance(self.point(b)));
        }
        chain
    }
}

/// The corner (three times the triangle and its place) of a side's triangle at a vertex.
fn corner_at(triangles: &[[u32; 3]], side: Side, vertex: u32) -> u32 {
    let place = triangles[side.triangle as usize].iter().position(|&v| v == vertex);
    3 * side.triangle + place.expect("an end of the side") as u32
}

fn root(parent: &mut [u32], mut i: u32) -> u32 {
    while parent[i as usize] != i {
        parent[i as usize] = parent[parent[i as usize] as usize];
        i = parent[i as usize];
    }
    i
}

fn unite(parent: &mut [u32], a: u32, b: u32) {
    let (a, b) = (root(parent, a), root(parent, b));
    parent[a.max(b) as usize] = a.min(b);
}

/// Per vertex of a pair, the vertices that a triangle joins it to: merging them would make the triangle
/// vanish.
pub(crate) fn neighbours(triangles: &[[u32; 3]], pairs: &[(f64, u32, u32)], count: usize) -> Vec<Vec<u32>> {
    let mut paired = vec![false; count];
    pairs.iter().for_each(|p| (paired[p.1 as usize], paired[p.2 as usize]) = (true, true));
    let mut apart = vec![Vec::new(); count];
    for side in sorted_sides(triangles).chunk_by(|a, b| a.edge == b.edge).map(|g| g[0].edge) {
        if paired[side[0] as usize] && paired[side[1] as usize] {
            apart[side[0] as usize].push(side[1]);
            apart[side[1] as usize].push(side[0]);
        }
    }
    apart
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_that_touch_in_a_vertex_have_borders_of_their_own() {
        let p: Vec<DVec3> = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]]
            .map(|[x, y]| DVec3::new(x, y, 0.0))
            .to_vec();
        let found = Boundaries::new(&p, &[[0, 1, 2], [0, 3, 4], [1, 1, 2]]);
        assert_eq!((found.all.len(), found.edges(), found.positions.len(), found.degenerate), (2, 6, 6, 1));
        assert!(found.all.iter().all(|b| b.closed && b.vertices.len() == 3 && b.along.len() == 4));
    }

    #[test]
    fn a_square_has_one_border_whatever_way_its_triangles_run() {
        let p: Vec<DVec3> =
            [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| DVec3::new(x, y, 0.0)).to_vec();
        for second in [[0, 2, 3], [0, 3, 2]] {
            let found = Boundaries::new(&p, &[[0, 1, 2], second]);
            assert_eq!((found.all.len(), found.edges()), (1, 4));
            assert!((found.all[0].length() - 4.0).abs() < 1e-12);
        }
    }
}
