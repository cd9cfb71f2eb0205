//! NurbsSurface and IndexedNurbsSurface, trimmed by the profiles before them.

use super::state::State;
use crate::scene::context::Context;
use crate::scene::graph::{Graph, Node, NodeIx};
use crate::scene::nurbs::{self, Net};
use crate::trimmed::{Piece, Role, TrimLoop};
use chordal_brep::ReadIssue;
use chordal_nurbs::{Curve2, DVec2, DVec3, DVec4};

/// Reads a node if it is a surface; true then.
pub(super) fn read(context: &mut Context<'_>, ix: NodeIx, state: &State, name: &str) -> bool {
    let graph = context.graph;
    let node = graph.node(ix);
    if !matches!(node.kind.as_str(), "NurbsSurface" | "IndexedNurbsSurface") {
        return false;
    }
    let look = state.shared.look(node, name);
    let counts = [node.count("numUControlPoints", 0), node.count("numVControlPoints", 0)];
    let needed = counts[0].saturating_mul(counts[1]);
    if !context.stage.afford(needed.min(node_size(graph, state)), node.source()) {
        return true;
    }
    let mut notes = Vec::new();
    let made = net(graph, node, state, counts, &mut notes);
    let trims = trims(graph, state, &mut notes);
    for note in notes {
        context
            .stage
            .notes
            .warn(node.source(), ReadIssue::InNode { node: node.kind.clone(), cause: note.boxed() });
    }
    match (made, trims) {
        (Ok(surface), Ok(trims)) => context.stage.surface(&surface, &trims, &state.transform, &look),
        (Err(reason), _) | (_, Err(reason)) => {
            context.stage.failed(ReadIssue::InNode { node: node.kind.clone(), cause: reason.boxed() }, &look);
        }
    }
    true
}

/// How many coordinates there are.
fn node_size(graph: &Graph, state: &State) -> usize {
    state.shared.coordinates.map_or(0, |ix| graph.node(ix).fields.iter().map(|(_, v)| v.size()).sum())
}

fn net(
    graph: &Graph,
    node: &Node,
    state: &State,
    counts: [usize; 2],
    notes: &mut Vec<ReadIssue>,
) -> Result<chordal_nurbs::NurbsSurface, ReadIssue> {
    let coordinates = state.shared.coordinates.ok_or(ReadIssue::Missing { what: "coordinates before it" })?;
    let points = homogeneous(graph.node(coordinates));
    let needed = counts[0].saturating_mul(counts[1]);
    let points = if node.kind == "IndexedNurbsSurface" {
        let index = node.numbers("coordIndex");
        let picked: Option<Vec<DVec4>> = index.iter().take(needed).map(|&i| at(&points, i)).collect();
        picked.ok_or(ReadIssue::Missing { what: "coordinate for an index" })?
    } else {
        points.into_iter().take(needed).collect()
    };
    let (u, v) = (node.numbers("uKnotVector"), node.numbers("vKnotVector"));
    let orders = [u.len().saturating_sub(counts[0]), v.len().saturating_sub(counts[1])];
    let net = Net { points, counts, orders, knots: [&u, &v], closed: [false; 2] };
    let (surface, found) = nurbs::surface(&net)?;
    notes.extend(found);
    Ok(surface)
}

fn at(points: &[DVec4], index: f64) -> Option<DVec4> {
    if index >= 0.0 { points.get(index as usize).copied() } else { None }
}

/// Coordinates as (wx, wy, wz, w).
fn homogeneous(node: &Node) -> Vec<DVec4> {
    let name = if node.kind == "VertexProperty" { "vertex" } else { "point" };
    let numbers = node.numbers(name);
    if node.kind == "Coordinate4" {
        numbers.chunks_exact(4).map(DVec4::from_slice).collect()
    } else {
        numbers.chunks_exact(3).map(|p| DVec3::from_slice(p).extend(1.0)).collect()
    }
}

/// Adds a profile to those that trim the surfaces after it.
pub(super) fn profile(node: &Node, ix: NodeIx, state: &mut State) {
    let profiles = &mut state.shared.profiles;
    match node.word("linkage") {
        "ADD_TO_CURRENT" if !profiles.is_empty() => {}
        "START_NEW" => profiles.push(Vec::new()),
        // START_FIRST begins a new set.
        _ => *profiles = vec![Vec::new()],
    }
    if let Some(last) = profiles.last_mut() {
        last.push((ix, state.shared.profile_coordinates));
    }
}

fn trims(graph: &Graph, state: &State, notes: &mut Vec<ReadIssue>) -> Result<Vec<TrimLoop>, ReadIssue> {
    let mut loops = Vec::with_capacity(state.shared.profiles.len());
    for chain in &state.shared.profiles {
        let mut pieces = Vec::with_capacity(chain.len());
        for &(ix, coordinates) in chain {
            let node = graph.node(ix);
            let piece = piece(graph, node, coordinates, notes).map_err(|reason: ReadIssue| {
                ReadIssue::Trim { node: node.kind.clone(), line: node.source().line, cause: reason.boxed() }
            })?;
            pieces.push(piece);
        }
        let source = chain.first().map(|(ix, _)| graph.node(*ix).source()).unwrap_or_default();
        loops.push(TrimLoop { pieces, role: Role::ByNesting(graph.winding), source });
    }
    Ok(loops)
}

fn piece(
    graph: &Graph,
    node: &Node,
    coordinates: Option<NodeIx>,
    notes: &mut Vec<ReadIssue>,
) -> Result<Piece, ReadIssue> {
    let coordinates =
        graph.node(coordinates.ok_or(ReadIssue::Missing { what: "profile coordinates before it" })?);
    let numbers = coordinates.numbers("point");
    let points: Vec<DVec3> = if coordinates.kind == "ProfileCoordinate3" {
        numbers.chunks_exact(3).map(DVec3::from_slice).collect()
    } else {
        numbers.chunks_exact(2).map(|p| DVec3::new(p[0], p[1], 1.0)).collect()
    };
    let index = node.numbers("index");
    let picked: Option<Vec<DVec3>> =
        index.iter().map(|&i| if i >= 0.0 { points.get(i as usize).copied() } else { None }).collect();
    let picked = picked.ok_or(ReadIssue::Missing { what: "coordinate for an index" })?;
    if node.kind == "LinearProfile" {
        let line: Vec<DVec2> = picked.iter().map(|p| DVec2::new(p.x, p.y) / p.z).collect();
        if line.len() < 2 || !line.iter().all(|p| p.is_finite()) {
            return Err(ReadIssue::TooFew { what: "points", found: 0, least: 2 });
        }
        return Ok(Piece::whole(Curve2::Polyline(line)));
    }
    let knots = node.numbers("knotVector");
    let order = knots.len().saturating_sub(picked.len());
    nurbs::curve2(&picked, order, &knots, false, notes).map(Piece::whole)
}
