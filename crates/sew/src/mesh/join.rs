//! New vertices split their triangles; vertices of one site move to their middle and become one.

use super::boundary::{Boundaries, neighbours};
use super::closest::Place;
use super::sites::{Refused, Sites};
use super::{MeshSewReport, SewnMesh};
use crate::cluster::{Corner, cluster_pairs};
use glam::DVec3;
use std::collections::BTreeMap;

/// New vertices on one edge nearer than this share of the tolerance are one, and so are those as near to its
/// ends.
const SAME: f64 = 0.02;

/// A mesh with borders joined.
#[derive(Debug, Default)]
pub(crate) struct Joined {
    pub mesh: SewnMesh,
    pub refused: Refused,
}

/// Vertices on the edges of borders: those of the mesh, and new ones.
struct Nodes<'a> {
    boundaries: &'a Boundaries,
    positions: Vec<DVec3>,
    /// Per border and edge, the new vertices on it as (share, vertex), in order.
    inserted: BTreeMap<(u32, u32), Vec<(f64, u32)>>,
}

/// Splits and merges.
pub(crate) fn join(
    boundaries: &Boundaries,
    sites: &Sites,
    tolerance: f64,
    report: &mut MeshSewReport,
) -> Joined {
    let nodes = Nodes::new(boundaries, sites, tolerance);
    report.inserted = nodes.positions.len() - boundaries.positions.len();
    let mut pairs = sites.merges.clone();
    pairs.extend(sites.insertions.iter().map(|one| {
        let (a, b) = (one.vertex, nodes.node(one.place, tolerance));
        let distance = nodes.positions[a as usize].distance(nodes.positions[b as usize]);
        (distance, a.min(b), a.max(b))
    }));
    pairs.retain(|p| p.1 != p.2);
    pairs.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    pairs.dedup();
    let (triangles, sources) = nodes.split();
    let corners: Vec<Corner> = nodes
        .positions
        .iter()
        .enumerate()
        .map(|(i, &point)| Corner { vertex: i as u32, point, anchored: false })
        .collect();
    let apart = neighbours(&triangles, &pairs, corners.len());
    let clusters = cluster_pairs(&corners, &apart, tolerance, &pairs);
    let is_refused = |a: u32, b: u32| clusters.of[a as usize] != clusters.of[b as usize];
    let insertions = sites.insertions.iter();
    let refused = Refused {
        merges: sites.merges.iter().map(|m| [m.1, m.2]).filter(|m| is_refused(m[0], m[1])).collect(),
        insertions: insertions
            .filter(|one| is_refused(one.vertex, nodes.node(one.place, tolerance)))
            .map(|one| [one.vertex, one.place.border])
            .collect(),
    };
    report.refused = pairs.iter().filter(|p| clusters.of[p.1 as usize] != clusters.of[p.2 as usize]).count();
    report.merged = corners.len() - clusters.all.len();
    report.largest_move = corners
        .iter()
        .zip(&clusters.of)
        .map(|(c, &k)| c.point.distance(clusters.all[k as usize].target))
        .fold(0.0, f64::max);
    let positions: Vec<DVec3> = clusters.all.iter().map(|c| c.target).collect();
    let merged: Vec<[u32; 3]> = triangles.iter().map(|t| t.map(|v| clusters.of[v as usize])).collect();
    let normal = |p: &[DVec3], t: &[u32; 3]| {
        let [a, b, c] = t.map(|v| p[v as usize]);
        (b - a).cross(c - a)
    };
    report.folded = triangles
        .iter()
        .zip(&merged)
        .filter(|(old, new)| normal(&nodes.positions, old).dot(normal(&positions, new)) < 0.0)
        .count();
    let shells = vec![0; merged.len()];
    Joined { mesh: SewnMesh { positions, triangles: merged, sources, shells }, refused }
}

impl<'a> Nodes<'a> {
    fn new(boundaries: &'a Boundaries, sites: &Sites, tolerance: f64) -> Self {
        let mut wanted: BTreeMap<(u32, u32), Vec<f64>> = BTreeMap::new();
        for place in sites.insertions.iter().map(|one| one.place) {
            wanted.entry((place.border, place.edge)).or_default().push(place.share);
        }
        let mut nodes =
            Self { boundaries, positions: boundaries.positions.clone(), inserted: BTreeMap::new() };
        for ((border, edge), mut shares) in wanted {
            shares.sort_unstable_by(f64::total_cmp);
            let [a, b] = nodes.ends(border, edge).map(|v| boundaries.point(v));
            let same = SAME * tolerance / a.distance(b);
            let mut list: Vec<(f64, u32)> = Vec::new();
            for share in shares {
                let far = list.last().is_none_or(|last| share - last.0 > same);
                if far && share > same && share < 1.0 - same {
                    list.push((share, nodes.positions.len() as u32));
                    nodes.positions.push(a.lerp(b, share));
                }
            }
            if !list.is_empty() {
                nodes.inserted.insert((border, edge), list);
            }
        }
        nodes
    }

    fn ends(&self, border: u32, edge: u32) -> [u32; 2] {
        self.boundaries.all[border as usize].edge(edge as usize)
    }

    /// The vertex at a place, or the nearest one on its edge.
    fn node(&self, place: Place, tolerance: f64) -> u32 {
        let ends = self.ends(place.border, place.edge);
        let [a, b] = ends.map(|v| self.boundaries.point(v));
        let same = SAME * tolerance / a.distance(b);
        if place.share <= same {
            return ends[0];
        }
        if place.share >= 1.0 - same {
            return ends[1];
        }
        let list = self.inserted.get(&(place.border, place.edge)).map_or(&[][..], |l| l);
        let nearest =
            list.iter().min_by(|x, y| (x.0 - place.share).abs().total_cmp(&(y.0 - place.share).abs()));
        nearest.map_or(ends[usize::from(place.share > 0.5)], |n| n.1)
    }

    /// The triangles with the new vertices of their sides, and per triangle the given one.
    fn split(&self) -> (Vec<[u32; 3]>, Vec<u32>) {
        let mut on_side: BTreeMap<u32, [Vec<u32>; 3]> = BTreeMap::new();
        for (&(border, edge), list) in &self.inserted {
            let (triangle, side, runs_along) = self.boundaries.all[border as usize].sides[edge as usize];
            let mut vertices: Vec<u32> = list.iter().map(|n| n.1).collect();
            if !runs_along {
                vertices.reverse();
            }
            on_side.entry(triangle).or_default()[side as usize] = vertices;
        }
        let mut triangles = Vec::with_capacity(self.boundaries.triangles.len());
        let mut sources = Vec::with_capacity(triangles.capacity());
        for (t, &corners) in self.boundaries.triangles.iter().enumerate() {
            let first = triangles.len();
            match on_side.get(&(t as u32)) {
                None => triangles.push(corners),
                Some(sides) => split(corners, sides.clone(), &mut triangles),
            }
            sources.resize(triangles.len(), self.boundaries.sources[t]);
            debug_assert!(triangles.len() > first);
        }
        (triangles, sources)
    }
}

/// Cuts a triangle from a corner to the new vertices of the side opposite, then the outer pieces further.
fn split([a, b, c]: [u32; 3], [ab, bc, ca]: [Vec<u32>; 3], out: &mut Vec<[u32; 3]>) {
    if ab.is_empty() && bc.is_empty() && ca.is_empty() {
        out.push([a, b, c]);
    } else if ab.is_empty() {
        split([b, c, a], [bc, ca, ab], out);
    } else {
        // The fan from c: its first piece keeps side ca, its last one side bc.
        let mut along = vec![a];
        along.extend(&ab);
        along.push(b);
        let last = along.len() - 2;
        for k in 0..=last {
            let of_bc = if k == last { bc.clone() } else { Vec::new() };
            let of_ca = if k == 0 { ca.clone() } else { Vec::new() };
            split([along[k], along[k + 1], c], [Vec::new(), of_bc, of_ca], out);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// The pieces cover the triangle once, and use every new vertex.
        #[test]
        fn pieces_cover_the_triangle(counts in prop::array::uniform3(0_usize..5)) {
            let corners = [DVec3::ZERO, DVec3::X * 3.0, DVec3::Y * 2.0];
            let mut p = corners.to_vec();
            let sides: [Vec<u32>; 3] = std::array::from_fn(|s| {
                (0..counts[s]).map(|k| {
                    p.push(corners[s].lerp(corners[(s + 1) % 3], (k + 1) as f64 / (counts[s] + 1) as f64));
                    p.len() as u32 - 1
                }).collect()
            });
            let mut out = Vec::new();
            split([0, 1, 2], sides, &mut out);
            let area = |t: &[u32; 3]| {
                let [a, b, c] = t.map(|v| p[v as usize]);
                0.5 * (b - a).cross(c - a).z
            };
            prop_assert!(out.iter().all(|t| area(t) > 1e-9));
            prop_assert!((out.iter().map(area).sum::<f64>() - 3.0).abs() < 1e-12);
            prop_assert_eq!(out.len(), 1 + counts.iter().sum::<usize>());
        }
    }
}
