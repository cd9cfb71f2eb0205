//! Control points, weights and curves of nodes.

use crate::scene::graph::{Graph, Node, NodeIx};
use crate::scene::nurbs;
use chordal_brep::ReadIssue;
use chordal_nurbs::{Curve2, DVec2, DVec3, DVec4};

const COORDINATES: &[&str] = &["Coordinate", "CoordinateDouble"];

/// The control points of a surface or curve in space: a node, or (VRML97) numbers.
pub(super) fn points(graph: &Graph, ix: NodeIx) -> Vec<DVec3> {
    let node = graph.node(ix);
    let own = node.numbers("controlPoint");
    let numbers = if own.is_empty() {
        match graph.child(ix, "controlPoint", COORDINATES) {
            Some(coordinates) => graph.node(coordinates).numbers("point"),
            None => own,
        }
    } else {
        own
    };
    numbers.chunks_exact(3).map(DVec3::from_slice).collect()
}

/// The weights of a node, if there is one for each point.
pub(super) fn weights(node: &Node, points: usize, notes: &mut Vec<ReadIssue>) -> Vec<f64> {
    let weights = node.numbers("weight").into_owned();
    if !weights.is_empty() && weights.len() != points {
        notes.push(ReadIssue::WeightsIgnored { found: weights.len(), expected: points });
        return Vec::new();
    }
    weights
}

/// A curve of parameter space; `None` for other nodes.
pub(super) fn curve2(node: &Node, notes: &mut Vec<ReadIssue>) -> Option<Result<Curve2, ReadIssue>> {
    match node.kind.as_str() {
        "NurbsCurve2D" => {
            let points = node.numbers("controlPoint");
            let points: Vec<DVec2> = points.chunks_exact(2).map(DVec2::from_slice).collect();
            let weights = weights(node, points.len(), notes);
            let weight = |i: usize| weights.get(i).copied().unwrap_or(1.0);
            let points: Vec<DVec3> = points.iter().enumerate().map(|(i, p)| p.extend(weight(i))).collect();
            let (order, knots) = (node.count("order", 3), node.numbers("knot"));
            Some(nurbs::curve2(&points, order, &knots, node.flag("closed", false), notes))
        }
        "ContourPolyline2D" | "Polyline2D" => {
            let fields = ["controlPoint", "point", "lineSegments"];
            let numbers = fields.iter().map(|field| node.numbers(field)).find(|numbers| !numbers.is_empty());
            let numbers = numbers.unwrap_or_default();
            let points: Vec<DVec2> = numbers.chunks_exact(2).map(DVec2::from_slice).collect();
            let sound = points.len() > 1 && points.iter().all(|p| p.is_finite());
            Some(if sound {
                Ok(Curve2::Polyline(points))
            } else {
                Err(ReadIssue::TooFew { what: "points", found: 0, least: 2 })
            })
        }
        _ => None,
    }
}

/// The control points of a NurbsCurve as (wx, wy, wz, w).
pub(super) fn curve3(graph: &Graph, ix: NodeIx, notes: &mut Vec<ReadIssue>) -> Vec<DVec4> {
    let points = points(graph, ix);
    let weights = weights(graph.node(ix), points.len(), notes);
    nurbs::weighted(&points, &weights)
}
