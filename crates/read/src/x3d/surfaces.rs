//! Spline surfaces and the contours that trim them.
//!
//! Control points are already multiplied by their weights, as the standard and its viewers have it: (wx, wy,
//! wz).

use super::curves::{curve2, points, weights};
use super::place::Place;
use super::swept;
use crate::scene::context::Context;
use crate::scene::graph::{Graph, NodeIx};
use crate::scene::nurbs::{self, Net};
use crate::trimmed::{Piece, Role, TrimLoop};
use chordal_brep::ReadIssue;
use chordal_nurbs::NurbsSurface;

pub(super) fn is_one(kind: &str) -> bool {
    is_patch(kind) || matches!(kind, "TrimmedSurface" | "NurbsSweptSurface" | "NurbsSwungSurface")
}

fn is_patch(kind: &str) -> bool {
    matches!(kind, "NurbsSurface" | "NurbsPatchSurface" | "NurbsTrimmedSurface")
}

/// Reads a node if it is a surface; true then.
pub(super) fn read(context: &mut Context<'_>, ix: NodeIx, place: &Place<'_>) -> bool {
    let graph = context.graph;
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
    if !context.stage.afford(size, node.source()) {
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
        context
            .stage
            .notes
            .warn(node.source(), ReadIssue::InNode { node: node.kind.clone(), cause: note.boxed() });
    }
    match (made, trims) {
        (Ok(surface), Ok(trims)) => context.stage.surface(&surface, &trims, &place.transform, &look),
        (Err(reason), _) | (_, Err(reason)) => {
            context.stage.failed(ReadIssue::InNode { node: node.kind.clone(), cause: reason.boxed() }, &look);
        }
    }
    true
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
