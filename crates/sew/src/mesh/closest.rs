//! Of every border vertex the closest point of every border within the tolerance (the paper's
//! `find_or_insert_closest_vertex`).

use super::boundary::Boundaries;
use crate::foot::segment_distance;
use chordal_nurbs::{Box3, BoxTree};
use glam::DVec3;
use rayon::prelude::*;

/// Two places of one border may be sewn where it runs this many times their distance, and tolerances, between
/// them.
const APART: f64 = 4.0;
/// Lengths along a border are good for this part of the whole.
const ROUNDING: f64 = 1e-9;
/// A foot this near (in tolerances) to a vertex of the border is that vertex.
const SNAP: f64 = 0.25;

/// A place on a border: an edge and how far along it (0 to 1), or a vertex (0).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Place {
    pub border: u32,
    pub edge: u32,
    pub share: f64,
    /// The length of the border up to it.
    pub along: f64,
}

/// A border vertex and the closest point of a border.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Approach {
    /// A vertex.
    pub from: Place,
    pub onto: Place,
    pub distance: f64,
}

/// All approaches, in the order of the vertices.
#[derive(Clone, Debug, Default)]
pub(crate) struct Approaches {
    pub all: Vec<Approach>,
}

/// All border edges with a tree over them.
pub(crate) struct Edges {
    /// Border and edge in it.
    of: Vec<(u32, u32)>,
    tree: BoxTree,
}

impl Edges {
    pub fn new(boundaries: &Boundaries) -> Self {
        let mut of = Vec::new();
        let mut boxes = Vec::new();
        for (b, boundary) in boundaries.all.iter().enumerate() {
            for k in 0..boundary.sides.len() {
                of.push((b as u32, k as u32));
                boxes.push(Box3::from_points(boundary.edge(k).map(|v| boundaries.point(v))));
            }
        }
        Self { of, tree: BoxTree::new(boxes) }
    }
}

impl Approaches {
    pub fn new(boundaries: &Boundaries, tolerance: f64) -> Self {
        let edges = Edges::new(boundaries);
        let vertices: Vec<(u32, u32)> = (0..boundaries.all.len())
            .flat_map(|b| (0..boundaries.all[b].vertices.len()).map(move |i| (b as u32, i as u32)))
            .collect();
        let all = vertices
            .par_iter()
            .with_min_len(256)
            .flat_map_iter(|&(b, i)| of_vertex(boundaries, &edges, b, i as usize, tolerance))
            .collect();
        Self { all }
    }
}

/// The closest point of every approach of every border to one vertex.
fn of_vertex(boundaries: &Boundaries, edges: &Edges, b: u32, i: usize, tolerance: f64) -> Vec<Approach> {
    let boundary = &boundaries.all[b as usize];
    let p = boundaries.point(boundary.vertices[i]);
    let own = boundary.along[i];
    let mut near: Vec<(u32, u32, f64, f64)> = Vec::new();
    edges.tree.meeting(Box3 { min: p, max: p }.inflated(tolerance), |e| {
        let (other, k) = edges.of[e as usize];
        let ends = boundaries.all[other as usize].edge(k as usize).map(|v| boundaries.point(v));
        let (d, share) = segment_distance(p, ends[0], ends[1]);
        if d <= tolerance {
            let along = along(boundaries, other, k, share);
            if other != b || between(boundaries, b, own, along) > APART * tolerance.max(d) {
                near.push((other, k, d, share));
            }
        }
    });
    near.sort_unstable_by_key(|n| (n.0, n.1));
    let from = Place { border: b, edge: i as u32, share: 0.0, along: own };
    near.chunk_by(|x, y| x.0 == y.0 && x.1 + 1 == y.1)
        .filter_map(|run| run.iter().min_by(|x, y| x.2.total_cmp(&y.2)))
        .map(|&(other, k, distance, share)| {
            let (onto, distance) = snapped(boundaries, other, k, share, p, distance, tolerance);
            Approach { from, onto, distance }
        })
        .collect()
}

/// The places of all borders that are nearest to a point, within the tolerance, each with its distance; of a
/// border that comes near several times, several.
pub(crate) fn near_places(
    boundaries: &Boundaries,
    edges: &Edges,
    p: DVec3,
    tolerance: f64,
) -> Vec<(Place, f64)> {
    let mut near: Vec<(u32, u32, f64, f64)> = Vec::new();
    edges.tree.meeting(Box3 { min: p, max: p }.inflated(tolerance), |e| {
        let (border, edge) = edges.of[e as usize];
        let [a, b] = boundaries.all[border as usize].edge(edge as usize).map(|v| boundaries.point(v));
        let (distance, share) = segment_distance(p, a, b);
        if distance <= tolerance {
            near.push((border, edge, distance, share));
        }
    });
    near.sort_unstable_by_key(|n| (n.0, n.1));
    let runs = near.chunk_by(|x, y| x.0 == y.0 && x.1 + 1 == y.1);
    let closest = runs.filter_map(|run| run.iter().min_by(|x, y| x.2.total_cmp(&y.2)));
    let place = |&(border, edge, distance, share): &(u32, u32, f64, f64)| {
        (Place { border, edge, share, along: along(boundaries, border, edge, share) }, distance)
    };
    closest.map(place).collect()
}

/// The length of a border up to a place.
pub(crate) fn along(boundaries: &Boundaries, border: u32, edge: u32, share: f64) -> f64 {
    let along = &boundaries.all[border as usize].along;
    along[edge as usize] + share * (along[edge as usize + 1] - along[edge as usize])
}

/// The length of the border between two of its places, the short way.
pub(crate) fn between(boundaries: &Boundaries, border: u32, a: f64, b: f64) -> f64 {
    let boundary = &boundaries.all[border as usize];
    let d = (a - b).abs();
    if boundary.closed { d.min(boundary.length() - d) } else { d }
}

/// The vertex at an end of the edge where the foot is all but there, and the vertex within the tolerance.
fn snapped(
    boundaries: &Boundaries,
    border: u32,
    edge: u32,
    share: f64,
    p: DVec3,
    distance: f64,
    tolerance: f64,
) -> (Place, f64) {
    let boundary = &boundaries.all[border as usize];
    let ends = boundary.edge(edge as usize).map(|v| boundaries.point(v));
    let foot = ends[0].lerp(ends[1], share);
    let end = usize::from(share > 0.5);
    let d = ends[end].distance(p);
    if ends[end].distance(foot) <= SNAP * tolerance && d <= tolerance {
        return (vertex_place(boundaries, border, edge as usize + end), d);
    }
    (Place { border, edge, share, along: along(boundaries, border, edge, share) }, distance)
}

/// The place of vertex `i` of a border; counted on beyond the end of a closed one.
pub(crate) fn vertex_place(boundaries: &Boundaries, border: u32, i: usize) -> Place {
    let boundary = &boundaries.all[border as usize];
    let i = if boundary.closed { i % boundary.vertices.len() } else { i };
    let last = boundary.sides.len() - 1;
    if i > last {
        return Place { border, edge: last as u32, share: 1.0, along: boundary.length() };
    }
    Place { border, edge: i as u32, share: 0.0, along: boundary.along[i] }
}

/// The distances of border vertices and of the middles of border edges from the nearest other border.
pub(crate) fn nearest_gaps(boundaries: &Boundaries) -> Vec<f64> {
    let edges = Edges::new(boundaries);
    nearest_of_edges(boundaries, &edges).into_iter().flatten().flat_map(|g| g.into_iter().flatten()).collect()
}

/// Per border and edge the distance from the nearest other border of its first vertex and of its middle.
pub(crate) fn nearest_by_border(boundaries: &Boundaries) -> Vec<Vec<[Option<f64>; 2]>> {
    nearest_of_edges(boundaries, &Edges::new(boundaries))
}

fn nearest_of_edges(boundaries: &Boundaries, edges: &Edges) -> Vec<Vec<[Option<f64>; 2]>> {
    (0..boundaries.all.len())
        .into_par_iter()
        .map(|b| {
            let boundary = &boundaries.all[b];
            (0..boundary.sides.len())
                .map(|k| {
                    let [p, q] = boundary.edge(k).map(|v| boundaries.point(v));
                    let half = 0.5 * (boundary.along[k] + boundary.along[k + 1]);
                    [
                        nearest(boundaries, edges, b as u32, p, boundary.along[k]),
                        nearest(boundaries, edges, b as u32, p.midpoint(q), half),
                    ]
                })
                .collect()
        })
        .collect()
}

/// The distance of a border's point from the nearest other place that the border does not lead to on a short
/// way.
fn nearest(boundaries: &Boundaries, edges: &Edges, border: u32, p: DVec3, own: f64) -> Option<f64> {
    let found = edges.tree.nearest(p, f64::INFINITY, |e| {
        let (other, k) = edges.of[e as usize];
        let ends = boundaries.all[other as usize].edge(k as usize).map(|v| boundaries.point(v));
        let (d, share) = segment_distance(p, ends[0], ends[1]);
        let run = || between(boundaries, border, own, along(boundaries, other, k, share));
        let short =
            other == border && run() <= APART * d + ROUNDING * boundaries.all[border as usize].length();
        (!short).then_some(d)
    });
    found.map(|f| f.1)
}
