//! Spline surfaces and the contours that trim them.
//!
//! Control points are already multiplied by their weights, as the standard and its viewers have it: (wx, wy, wz).

use super::swept;
use super::walk::{Place, Walk};
use crate::scene::graph::{Graph, Node, NodeIx};
use crate::scene::nurbs::{self, Net};
use crate::trimmed::{Piece, Role, TrimLoop};
use chordal_brep::ReadIssue;
use chordal_nurbs::{Curve2, DVec2, DVec3, DVec4, NurbsSurface};

const COORDINATES: &[&str] = &["Coordinate", "CoordinateDouble"];

pub(super) fn is_one(kind: &str) -> bool {
    is_patch(kind) || matches!(kind, "TrimmedSurface" | "NurbsSweptSurface" | "NurbsSwungSurface")
}

fn is_patch(kind: &str) -> bool {
    matches!(kind, "NurbsSurface" | "NurbsPatchSurface" | "NurbsTrimmedSurface")
}

/// Reads a node if it is a surface; true then.
pub(super) fn read(walk: &mut Walk<'_>, ix: NodeIx, place: &Place<'_>) -> bool {
    let graph = walk.graph;
    let node = graph.node(ix);
    if !is_one(&node.kind) {
        return false;
    }
    // VRML97 puts the surface into the node that trims it.
    let basis =
        if node.kind == "TrimmedSurface" { graph.child(ix, "surface", &["NurbsSurface"]) } else { Some(ix) };
    let look = place.look(basis.map_or(node, |basis| graph.node(basis)));
    let mut notes = Vec::new();
    let size = basis.map_or(0, |basis| points(graph, basis).len());
    if !walk.stage.afford(size, node.source()) {
        return true;
    }
    let made = match (node.kind.as_str(), basis) {
        ("NurbsSweptSurface", _) => swept::swept(graph, ix, &mut notes),
        ("NurbsSwungSurface", _) => swept::swung(graph, ix, &mut notes),
        (_, Some(basis)) => patch(graph, basis, &mut notes),
        (_, None) => Err(ReadIssue::NoSurface),
    };
    let trims = trims(graph, ix, &mut notes);
    for note in notes {
        walk.stage
            .notes
            .warn(node.source(), ReadIssue::InNode { node: node.kind.clone(), cause: note.boxed() });
    }
    match (made, trims) {
        (Ok(surface), Ok(trims)) => walk.stage.surface(&surface, &trims, &place.transform, &look),
        (Err(reason), _) | (_, Err(reason)) => {
            walk.stage.failed(ReadIssue::InNode { node: node.kind.clone(), cause: reason.boxed() }, &look);
        }
    }
    true
}

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

fn patch(graph: &Graph, ix: NodeIx, notes: &mut Vec<ReadIssue>) -> Result<NurbsSurface, ReadIssue> {
    let node = graph.node(ix);
    let points = points(graph, ix);
    let weights = weights(node, points.len(), notes);
    let (u, v) = (node.numbers("uKnot"), node.numbers("vKnot"));
    let net = Net {
        points: nurbs::weighted(&points, &weights),
        counts: [node.count("uDimension", 0), node.count("vDimension", 0)],
        orders: [node.count("uOrder", 3), node.count("vOrder", 3)],
        knots: [&u, &v],
        closed: [node.flag("uClosed", false), node.flag("vClosed", false)],
    };
    let (surface, found) = nurbs::surface(&net)?;
    notes.extend(found);
    Ok(surface)
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

fn trims(graph: &Graph, ix: NodeIx, notes: &mut Vec<ReadIssue>) -> Result<Vec<TrimLoop>, ReadIssue> {
    let node = graph.node(ix);
    let contours = node.nodes("trimmingContour").iter().chain(&node.children);
    let contours = contours.filter(|&&child| graph.node(child).kind == "Contour2D");
    let mut loops = Vec::new();
    for &contour in contours {
        let contour = graph.node(contour);
        let mut pieces = Vec::new();
        for &child in contour.nodes("children").iter().chain(&contour.children) {
            let curve = graph.node(child);
            if let Some(made) = curve2(curve, notes) {
                let made = made.map_err(|e| ReadIssue::Trim {
                    node: curve.kind.clone(),
                    line: curve.source().line,
                    cause: e.boxed(),
                })?;
                pieces.push(Piece::whole(made));
            }
        }
        loops.push(TrimLoop { pieces, role: Role::ByNesting(graph.winding), source: contour.source() });
    }
    Ok(loops)
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
