//! Vertices within the tolerance of each other are merged, transitively as long as no vertex moves by more
//! than the tolerance.
//!
//! Pairs are joined in the order of their distances. A join that would move a vertex too far, or that would
//! make the two ends of an edge that must stay the same, is rejected.

use chordal_nurbs::{Box3, BoxTree};
use glam::DVec3;

/// The most neighbours of one vertex that are considered. Further ones are copies of these.
const NEIGHBOURS: usize = 32;

/// A vertex that may be merged.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Corner {
    /// The vertex of the part.
    pub vertex: u32,
    pub point: DVec3,
    /// Edges that must not change end at this vertex: the other vertices move first.
    pub anchored: bool,
}

/// The merged vertices.
#[derive(Clone, Debug, Default)]
pub(crate) struct Clusters {
    /// For each corner, its cluster.
    pub of: Vec<u32>,
    pub all: Vec<Cluster>,
}

/// One merged vertex.
#[derive(Clone, Debug)]
pub(crate) struct Cluster {
    pub target: DVec3,
    /// Corners, in increasing order.
    pub members: Vec<u32>,
}

/// Merges corners. `apart` lists, for each corner, the corners that it must not be merged with.
pub(crate) fn cluster(corners: &[Corner], apart: &[Vec<u32>], tolerance: f64) -> Clusters {
    cluster_pairs(corners, apart, tolerance, &close_pairs(corners, tolerance))
}

/// Merges the corners of given pairs (distance and both corners) in their order.
pub(crate) fn cluster_pairs(
    corners: &[Corner],
    apart: &[Vec<u32>],
    tolerance: f64,
    pairs: &[(f64, u32, u32)],
) -> Clusters {
    let mut state = State {
        corners,
        apart,
        tolerance,
        parent: (0..corners.len() as u32).collect(),
        members: (0..corners.len() as u32).map(|i| vec![i]).collect(),
    };
    for &(_, a, b) in pairs {
        state.join(a, b);
    }
    state.finish()
}

/// Pairs within the tolerance, the closest first.
fn close_pairs(corners: &[Corner], tolerance: f64) -> Vec<(f64, u32, u32)> {
    let tree = BoxTree::new(corners.iter().map(|c| Box3 { min: c.point, max: c.point }));
    let mut pairs = Vec::new();
    let mut near: Vec<(f64, u32)> = Vec::new();
    for (i, corner) in corners.iter().enumerate() {
        near.clear();
        let query = Box3 { min: corner.point, max: corner.point }.inflated(tolerance);
        tree.meeting(query, |j| {
            let d = corners[j as usize].point.distance(corner.point);
            if j as usize != i && d <= tolerance {
                near.push((d, j));
            }
        });
        // Where many copies are at one place, each is joined to the next.
        near.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(before(i, a.1).cmp(&before(i, b.1))));
        let kept = near.iter().take(NEIGHBOURS);
        pairs.extend(kept.map(|&(d, j)| (d, (i as u32).min(j), (i as u32).max(j))));
    }
    pairs.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    pairs.dedup();
    pairs
}

fn before(i: usize, j: u32) -> u32 {
    j.abs_diff(i as u32)
}

struct State<'a> {
    corners: &'a [Corner],
    apart: &'a [Vec<u32>],
    tolerance: f64,
    parent: Vec<u32>,
    /// The members of each root.
    members: Vec<Vec<u32>>,
}

impl State<'_> {
    fn root(&mut self, mut i: u32) -> u32 {
        while self.parent[i as usize] != i {
            let up = self.parent[self.parent[i as usize] as usize];
            self.parent[i as usize] = up;
            i = up;
        }
        i
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        if a == b || self.must_stay_apart(a, b) {
            return;
        }
        let mut all = self.members[a as usize].clone();
        all.extend(&self.members[b as usize]);
        all.sort_unstable();
        let target = self.target(&all);
        if all.iter().any(|&m| self.corners[m as usize].point.distance(target) > self.tolerance) {
            return;
        }
        let (low, high) = (a.min(b), a.max(b));
        self.parent[high as usize] = low;
        self.members[high as usize] = Vec::new();
        self.members[low as usize] = all;
    }

    fn must_stay_apart(&mut self, a: u32, b: u32) -> bool {
        let (few, root) = if self.members[a as usize].len() < self.members[b as usize].len() {
            (self.members[a as usize].clone(), b)
        } else {
            (self.members[b as usize].clone(), a)
        };
        few.iter().any(|&m| {
            (0..self.apart[m as usize].len()).any(|k| {
                let other = self.apart[m as usize][k];
                self.root(other) == root
            })
        })
    }

    /// The mean of the anchored members, or of all where none is anchored.
    fn target(&self, members: &[u32]) -> DVec3 {
        let anchored: Vec<u32> =
            members.iter().copied().filter(|&m| self.corners[m as usize].anchored).collect();
        let of = if anchored.is_empty() { members } else { &anchored };
        let first = self.corners[of[0] as usize].point;
        // Relative to the first, so that copies at one place keep their exact coordinates.
        let sum: DVec3 = of.iter().map(|&m| self.corners[m as usize].point - first).sum();
        first + sum / of.len() as f64
    }

    fn finish(mut self) -> Clusters {
        let mut found = Clusters { of: vec![0; self.corners.len()], all: Vec::new() };
        for root in 0..self.corners.len() {
            let members = std::mem::take(&mut self.members[root]);
            if members.is_empty() {
                continue;
            }
            members.iter().for_each(|&m| found.of[m as usize] = found.all.len() as u32);
            found.all.push(Cluster { target: self.target(&members), members });
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn corners(points: &[[f64; 3]]) -> Vec<Corner> {
        let corner =
            |(i, &p): (usize, &[f64; 3])| Corner { vertex: i as u32, point: p.into(), anchored: false };
        points.iter().enumerate().map(corner).collect()
    }

    #[test]
    fn a_row_of_points_does_not_collapse_into_one() {
        let row: Vec<[f64; 3]> = (0..30).map(|i| [0.9 * f64::from(i), 0.0, 0.0]).collect();
        let found = cluster(&corners(&row), &vec![Vec::new(); 30], 1.0);
        assert!(found.all.len() > 8, "{}", found.all.len());
        let moved = |c: &Cluster| {
            c.members.iter().map(|&m| DVec3::from(row[m as usize]).distance(c.target)).fold(0.0, f64::max)
        };
        assert!(found.all.iter().all(|c| moved(c) <= 1.0));
    }

    #[test]
    fn the_tolerance_is_the_limit_and_ends_of_an_edge_stay_apart() {
        let pair = corners(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]);
        assert_eq!(cluster(&pair, &[vec![], vec![]], 1.0).all.len(), 1);
        assert_eq!(cluster(&pair, &[vec![], vec![]], 0.999).all.len(), 2);
        assert_eq!(cluster(&pair, &[vec![1], vec![0]], 1.0).all.len(), 2);
    }

    #[test]
    fn anchored_vertices_do_not_move() {
        let mut three = corners(&[[0.0, 0.0, 0.0], [0.5, 0.0, 0.0], [0.6, 0.0, 0.0]]);
        three[1].anchored = true;
        let found = cluster(&three, &vec![Vec::new(); 3], 1.0);
        assert_eq!((found.all.len(), found.all[0].target), (1, DVec3::new(0.5, 0.0, 0.0)));
    }

    proptest! {
        #[test]
        fn nobody_moves_too_far(points in prop::collection::vec(prop::array::uniform3(0.0..3.0), 1..80)) {
            let found = cluster(&corners(&points), &vec![Vec::new(); points.len()], 0.7);
            for c in &found.all {
                for &m in &c.members {
                    prop_assert!(DVec3::from(points[m as usize]).distance(c.target) <= 0.7);
                }
            }
            prop_assert_eq!(found.all.iter().map(|c| c.members.len()).sum::<usize>(), points.len());
        }
    }
}
