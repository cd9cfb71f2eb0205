//! Polygons and solids.

use super::place::Place;
use crate::polygons;
use crate::scene::context::Context;
use crate::scene::graph::{Node, NodeIx};
use crate::scene::primitives::{self, Faces};
use chordal_brep::ReadIssue;
use chordal_nurbs::DVec3;

pub(super) fn is_one(kind: &str) -> bool {
    is_solid(kind) || is_polygons(kind) || kind == "ElevationGrid"
}

fn is_solid(kind: &str) -> bool {
    matches!(kind, "Box" | "Sphere" | "Cylinder" | "Cone")
}

fn is_polygons(kind: &str) -> bool {
    matches!(
        kind,
        "IndexedFaceSet"
            | "IndexedTriangleSet"
            | "TriangleSet"
            | "IndexedTriangleStripSet"
            | "TriangleStripSet"
            | "IndexedTriangleFanSet"
            | "TriangleFanSet"
            | "IndexedQuadSet"
            | "QuadSet"
    )
}

/// Reads a node if it is a solid or polygons; true then.
pub(super) fn read(context: &mut Context<'_>, ix: NodeIx, place: &Place<'_>) -> bool {
    let node = context.graph.node(ix);
    match node.kind.as_str() {
        kind if is_solid(kind) => solid(context, node, place),
        kind if is_polygons(kind) => polygons_of(context, ix, place),
        "ElevationGrid" => elevation_grid(context, node, place),
        "Extrusion" => {
            context.stage.notes.lose(node.source(), ReadIssue::Unsupported { what: "Extrusion".into() })
        }
        _ => return false,
    }
    true
}

fn solid(context: &mut Context<'_>, node: &Node, place: &Place<'_>) {
    let look = crate::trimmed::Look { flipped: false, ..place.look(node) };
    let faces = Faces {
        side: node.flag("side", true),
        top: node.flag("top", true),
        bottom: node.flag("bottom", true),
    };
    let sizes = match node.kind.as_str() {
        "Box" => node.vector("size", [2.0; 3]),
        "Sphere" => [node.number("radius", 1.0); 3],
        "Cylinder" => [node.number("radius", 1.0), node.number("height", 2.0), 1.0],
        _ => [node.number("bottomRadius", 1.0), node.number("height", 2.0), 1.0],
    };
    if !sizes.iter().all(|&s| s > 0.0) {
        return context.stage.notes.lose(
            node.source(),
            ReadIssue::InNode { node: node.kind.clone(), cause: ReadIssue::Empty.boxed() },
        );
    }
    let [a, b, _] = sizes;
    context.stage.solid(&place.transform, &look, |part, look| match node.kind.as_str() {
        "Box" => primitives::cuboid(part, sizes.into(), look),
        "Sphere" => primitives::sphere(part, a, look),
        "Cylinder" => primitives::cylinder(part, a, b, faces, look),
        _ => primitives::cone(part, a, b, faces, look),
    });
}

fn polygons_of(context: &mut Context<'_>, ix: NodeIx, place: &Place<'_>) {
    let graph = context.graph;
    let node = graph.node(ix);
    let coordinates = graph.child(ix, "coord", &["Coordinate", "CoordinateDouble"]);
    let numbers = coordinates.map(|c| graph.node(c).numbers("point")).unwrap_or_default();
    let points: Vec<DVec3> = numbers.chunks_exact(3).map(DVec3::from_slice).collect();
    let size = points.len() + node.fields.iter().map(|(_, v)| v.size()).sum::<usize>();
    if !context.stage.afford(size, node.source()) {
        return;
    }
    let all = || (0..points.len()).map(|i| i as f64).collect::<Vec<f64>>();
    let index = || node.numbers("index").into_owned();
    let (triangles, lost) = match node.kind.as_str() {
        "IndexedFaceSet" => polygons::indexed(&points, &node.numbers("coordIndex")),
        "IndexedTriangleSet" => polygons::indexed(&points, &grouped(&index(), 3)),
        "TriangleSet" => polygons::indexed(&points, &grouped(&all(), 3)),
        "IndexedQuadSet" => polygons::indexed(&points, &grouped(&index(), 4)),
        "QuadSet" => polygons::indexed(&points, &grouped(&all(), 4)),
        "IndexedTriangleStripSet" => runs(&points, &index(), polygons::strip),
        "TriangleStripSet" => {
            runs(&points, &counted(&node.numbers("stripCount"), points.len()), polygons::strip)
        }
        "IndexedTriangleFanSet" => runs(&points, &index(), polygons::fan),
        _ => runs(&points, &counted(&node.numbers("fanCount"), points.len()), polygons::fan),
    };
    if lost > 0 {
        let cause = ReadIssue::PolygonsLost { polygons: lost }.boxed();
        let message = ReadIssue::InNode { node: node.kind.clone(), cause };
        context.stage.notes.lose(node.source(), message);
    }
    context.stage.triangles(points, triangles, &place.transform, &place.look(node));
}

/// Corners in groups of `each`, −1 behind each group.
fn grouped(index: &[f64], each: usize) -> Vec<f64> {
    index.chunks_exact(each).flat_map(|group| group.iter().copied().chain([-1.0])).collect()
}

/// Runs of consecutive corners, −1 behind each run.
fn counted(counts: &[f64], points: usize) -> Vec<f64> {
    let mut index = Vec::new();
    let mut at = 0usize;
    for &count in counts {
        let end = at.saturating_add(count.max(0.0) as usize).min(points);
        index.extend((at..end).map(|i| i as f64).chain([-1.0]));
        at = end;
    }
    index
}

/// Triangles of strips or fans that −1 ends.
fn runs(points: &[DVec3], index: &[f64], cut: fn(&[u32], &mut Vec<[u32; 3]>)) -> (Vec<[u32; 3]>, usize) {
    let mut triangles = Vec::new();
    let mut lost = 0;
    for run in index.split(|&i| i < 0.0).filter(|run| !run.is_empty()) {
        let corners: Option<Vec<u32>> =
            run.iter().map(|&i| (i < points.len() as f64).then_some(i as u32)).collect();
        match corners {
            Some(corners) if corners.len() > 2 => cut(&corners, &mut triangles),
            _ => lost += 1,
        }
    }
    (triangles, lost)
}

fn elevation_grid(context: &mut Context<'_>, node: &Node, place: &Place<'_>) {
    let heights = node.numbers("height");
    let (columns, rows) = (node.count("xDimension", 0), node.count("zDimension", 0));
    let fits = columns.checked_mul(rows).is_some_and(|n| n <= heights.len());
    if !fits || columns < 2 || rows < 2 {
        return context.stage.notes.lose(
            node.source(),
            ReadIssue::TooFew {
                what: "heights of the ElevationGrid",
                found: node.numbers("height").len(),
                least: columns.saturating_mul(rows),
            },
        );
    }
    if !context.stage.afford(columns * rows, node.source()) {
        return;
    }
    let (dx, dz) = (node.number("xSpacing", 1.0), node.number("zSpacing", 1.0));
    let point = |k: usize| DVec3::new((k % columns) as f64 * dx, heights[k], (k / columns) as f64 * dz);
    let points = (0..columns * rows).map(point).collect();
    let mut triangles = Vec::new();
    for j in 1..rows {
        for i in 1..columns {
            let at = |i: usize, j: usize| (j * columns + i) as u32;
            let [a, b, c, d] = [at(i - 1, j - 1), at(i, j - 1), at(i, j), at(i - 1, j)];
            triangles.extend([[a, d, c], [a, c, b]]);
        }
    }
    context.stage.triangles(points, triangles, &place.transform, &place.look(node));
}
