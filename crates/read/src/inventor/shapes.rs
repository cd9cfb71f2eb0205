//! Polygons and solids.

use super::state::State;
use crate::polygons;
use crate::scene::context::Context;
use crate::scene::graph::{Node, NodeIx};
use crate::scene::primitives::{self, Faces};
use chordal_brep::ReadIssue;
use chordal_nurbs::DVec3;
use std::borrow::Cow;

pub(super) fn is_one(kind: &str) -> bool {
    is_polygons(kind) || is_solid(kind)
}

fn is_solid(kind: &str) -> bool {
    matches!(kind, "Cube" | "Sphere" | "Cylinder" | "Cone")
}

fn is_polygons(kind: &str) -> bool {
    matches!(
        kind,
        "FaceSet"
            | "IndexedFaceSet"
            | "QuadMesh"
            | "TriangleStripSet"
            | "IndexedTriangleStripSet"
            | "IndexedTriangleSet"
    )
}

/// Reads a node if it is a solid or polygons; true then.
pub(super) fn read(context: &mut Context<'_>, node: &Node, state: &State, name: &str) -> bool {
    if is_solid(&node.kind) {
        solid(context, node, state, name);
        return true;
    }
    if is_polygons(&node.kind) {
        polygons_of(context, node, state, name);
        return true;
    }
    false
}

fn solid(context: &mut Context<'_>, node: &Node, state: &State, name: &str) {
    let look = state.shared.look(node, name);
    let named = |field, default: f64| node.number(field, default);
    let parts = node.words("parts");
    let has = |part: &str| parts.is_empty() || parts.iter().any(|&p| p == part || p == "ALL");
    let faces = Faces { side: has("SIDES"), top: has("TOP"), bottom: has("BOTTOM") };
    let sizes = match node.kind.as_str() {
        "Cube" => [named("width", 2.0), named("height", 2.0), named("depth", 2.0)],
        "Sphere" => [named("radius", 1.0); 3],
        "Cylinder" => [named("radius", 1.0), named("height", 2.0), 1.0],
        _ => [named("bottomRadius", 1.0), named("height", 2.0), 1.0],
    };
    if !sizes.iter().all(|&s| s > 0.0) {
        return context.stage.notes.lose(
            node.source(),
            ReadIssue::InNode { node: node.kind.clone(), cause: ReadIssue::Empty.boxed() },
        );
    }
    let [a, b, _] = sizes;
    context.stage.solid(&state.transform, &look, |part, look| match node.kind.as_str() {
        "Cube" => primitives::cuboid(part, sizes.into(), look),
        "Sphere" => primitives::sphere(part, a, look),
        "Cylinder" => primitives::cylinder(part, a, b, faces, look),
        _ => primitives::cone(part, a, b, faces, look),
    });
}

/// The corners that a shape's own property node or the state gives.
fn corners(context: &Context<'_>, node: &Node, state: &State) -> Vec<DVec3> {
    let own = node.nodes("vertexProperty").first().copied();
    let own = own.filter(|&ix: &NodeIx| !context.graph.node(ix).numbers("vertex").is_empty());
    let Some(ix) = own.or(state.shared.coordinates) else { return Vec::new() };
    let source = context.graph.node(ix);
    match source.kind.as_str() {
        "Coordinate4" => {
            source.numbers("point").chunks_exact(4).map(|p| DVec3::from_slice(p) / p[3]).collect()
        }
        "VertexProperty" => source.numbers("vertex").chunks_exact(3).map(DVec3::from_slice).collect(),
        _ => source.numbers("point").chunks_exact(3).map(DVec3::from_slice).collect(),
    }
}

fn polygons_of(context: &mut Context<'_>, node: &Node, state: &State, name: &str) {
    let points = corners(context, node, state);
    let size = points.len() + node.fields.iter().map(|(_, v)| v.size()).sum::<usize>();
    if !context.stage.afford(size, node.source()) {
        return;
    }
    let (triangles, lost) = match node.kind.as_str() {
        "IndexedFaceSet" => polygons::indexed(&points, &node.numbers("coordIndex")),
        "IndexedTriangleSet" => triples(&points, &node.numbers("coordIndex")),
        "FaceSet" => polygons::indexed(&points, &runs(node, "numVertices", points.len())),
        "TriangleStripSet" => strips(&points, &runs(node, "numVertices", points.len())),
        "IndexedTriangleStripSet" => strips(&points, &node.numbers("coordIndex")),
        _ => mesh(node, points.len()),
    };
    if lost > 0 {
        let cause = ReadIssue::PolygonsLost { polygons: lost }.boxed();
        let message = ReadIssue::InNode { node: node.kind.clone(), cause };
        context.stage.notes.lose(node.source(), message);
    }
    let mut look = state.shared.look(node, name);
    look.flipped = state.shared.clockwise;
    context.stage.triangles(points, triangles, &state.transform, &look);
}

/// Runs of consecutive corners as an index with −1 behind each; none given: all of them.
fn runs(node: &Node, field: &str, points: usize) -> Vec<f64> {
    let start = node.count("startIndex", 0);
    let counts: Cow<'_, [f64]> = match node.numbers(field) {
        counts if counts.is_empty() => Cow::Owned(vec![-1.0]),
        counts => counts,
    };
    let mut index = Vec::new();
    let mut at = start;
    for &count in counts.iter() {
        // −1 stands for all remaining ones.
        let count = if count < 0.0 { points.saturating_sub(at) } else { count as usize };
        let end = at.saturating_add(count).min(points);
        index.extend((at..end).map(|i| i as f64));
        index.push(-1.0);
        at = end;
    }
    index
}

fn strips(points: &[DVec3], index: &[f64]) -> (Vec<[u32; 3]>, usize) {
    let mut triangles = Vec::new();
    let mut lost = 0;
    for run in index.split(|&i| i < 0.0).filter(|run| !run.is_empty()) {
        let corners: Option<Vec<u32>> =
            run.iter().map(|&i| (i < points.len() as f64).then_some(i as u32)).collect();
        match corners {
            Some(corners) => polygons::strip(&corners, &mut triangles),
            None => lost += 1,
        }
    }
    (triangles, lost)
}

fn triples(points: &[DVec3], index: &[f64]) -> (Vec<[u32; 3]>, usize) {
    let index: Vec<f64> = index.iter().copied().filter(|&i| i >= 0.0).collect();
    let separated: Vec<f64> = index.chunks_exact(3).flat_map(|t| [t[0], t[1], t[2], -1.0]).collect();
    polygons::indexed(points, &separated)
}

/// A grid of corners, row by row.
fn mesh(node: &Node, points: usize) -> (Vec<[u32; 3]>, usize) {
    let start = node.count("startIndex", 0);
    let (columns, rows) = (node.count("verticesPerRow", 1), node.count("verticesPerColumn", 1));
    let fits = columns.checked_mul(rows).and_then(|n| n.checked_add(start)).is_some_and(|n| n <= points);
    if !fits {
        return (Vec::new(), 1);
    }
    let mut triangles = Vec::new();
    for j in 1..rows {
        for i in 1..columns {
            let at = |i: usize, j: usize| (start + j * columns + i) as u32;
            let [a, b, c, d] = [at(i - 1, j - 1), at(i, j - 1), at(i, j), at(i - 1, j)];
            // Inventor runs down the columns: the first row is the upper one.
            triangles.extend([[a, d, c], [a, c, b]]);
        }
    }
    (triangles, 0)
}
