//! Step 1: vertices and edges.

use super::{Direction, TightBox};
use crate::placement::PartUse;
use chordal_brep::{Edge, Face, Loop, Part};
use chordal_nurbs::Curve;
use glam::{DAffine3, DVec3};

/// Samples of one edge in the part's coordinates.
struct Samples<'a> {
    curve: &'a Curve,
    parameters: Vec<f64>,
    points: Vec<DVec3>,
    /// How far the curve may lie beyond its samples.
    slack: f64,
}

pub(super) fn include(found: &mut TightBox, part: &Part, part_use: &PartUse) {
    let (vertices, edges) = used(part);
    let samples: Vec<Samples> = edges.into_iter().filter_map(sample).collect();
    for world in &part_use.worlds {
        vertices.iter().for_each(|&p| found.include(world.transform_point3(p)));
        samples.iter().flat_map(|s| &s.points).for_each(|&p| found.include(world.transform_point3(p)));
    }
    for world in &part_use.worlds {
        for edge in samples.iter().filter(|s| s.slack > 0.0) {
            Direction::ALL.iter().for_each(|&d| refine(found, edge, world, d));
        }
    }
}

/// The vertices and edges that faces use: loose ones do not belong to the model's faces.
fn used(part: &Part) -> (Vec<DVec3>, Vec<&Edge>) {
    let mut vertex_used = vec![false; part.vertices.len()];
    let mut edge_used = vec![false; part.edges.len()];
    for a_loop in part.faces.iter().flat_map(|f: &Face| &f.loops) {
        match a_loop {
            Loop::Edges { coedges, .. } => coedges.iter().for_each(|c| edge_used[c.edge.index()] = true),
            Loop::Vertex(v) => vertex_used[v.index()] = true,
            Loop::Polygon { vertices, .. } => vertices.iter().for_each(|v| vertex_used[v.index()] = true),
        }
    }
    let edges: Vec<&Edge> =
        part.edges.iter().zip(&edge_used).filter(|(_, used)| **used).map(|(e, _)| e).collect();
    for edge in &edges {
        vertex_used[edge.start.index()] = true;
        vertex_used[edge.end.index()] = true;
    }
    let vertices =
        part.vertices.iter().zip(vertex_used).filter(|(_, used)| *used).map(|(v, _)| v.point).collect();
    (vertices, edges)
}

fn sample(edge: &Edge) -> Option<Samples<'_>> {
    let curve = edge.curve.as_deref()?;
    if !edge.range.is_finite() || matches!(curve, Curve::Line { .. }) {
        return None;
    }
    let mut breaks = vec![edge.range.start];
    breaks.extend(curve.breaks(edge.range).into_iter().filter(|t| edge.range.contains(*t)));
    breaks.push(edge.range.end);
    breaks.dedup();
    let per_piece = if matches!(curve, Curve::Polyline(_)) { 1 } else { (24 / breaks.len().max(1)).max(4) };
    let mut parameters = vec![edge.range.start];
    for piece in breaks.windows(2) {
        let step = (piece[1] - piece[0]) / per_piece as f64;
        parameters.extend((1..=per_piece).map(|i| piece[0] + step * i as f64));
    }
    let points: Vec<DVec3> = parameters.iter().map(|&t| curve.point(t)).collect();
    // The largest second difference: eight times the sag between samples.
    let bend = points.windows(3).map(|p| (p[0] - p[1] * 2.0 + p[2]).length()).fold(0.0, f64::max);
    Some(Samples { curve, parameters, points, slack: if per_piece == 1 { 0.0 } else { bend * 0.5 } })
}

/// Golden section search between the neighbours of the best sample, where it can matter.
fn refine(found: &mut TightBox, edge: &Samples<'_>, world: &DAffine3, direction: Direction) {
    let (gradient, constant) = direction.in_part(world);
    let value = |p: DVec3| gradient.dot(p) + constant;
    let Some((best, highest)) =
        edge.points.iter().map(|&p| value(p)).enumerate().max_by(|a, b| a.1.total_cmp(&b.1))
    else {
        return;
    };
    if highest + edge.slack * gradient.length() <= found.extreme(direction) {
        return;
    }
    let mut a = edge.parameters[best.saturating_sub(1)];
    let mut b = edge.parameters[(best + 1).min(edge.parameters.len() - 1)];
    const GOLDEN: f64 = 0.618_033_988_749_894_8;
    for _ in 0..40 {
        let (left, right) = (b - (b - a) * GOLDEN, a + (b - a) * GOLDEN);
        if value(edge.curve.point(left)) > value(edge.curve.point(right)) {
            b = right;
        } else {
            a = left;
        }
    }
    found.include(world.transform_point3(edge.curve.point(0.5 * (a + b))));
}
