//! Loops that are polygons of points: where some side of one is open, all get straight edges, so that they
//! can be sewn.

use chordal_brep::{Coedge, Edge, EdgeId, Loop, Part, VertexId};
use chordal_nurbs::{Curve, Range};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Replaces the polygon loops of a part by loops of straight edges, unless all their sides are shared
/// already. Returns how many were replaced.
pub(crate) fn add_polygon_edges(part: &mut Part) -> usize {
    let mut sides: BTreeMap<[VertexId; 2], u32> = BTreeMap::new();
    for a_loop in part.faces.iter().flat_map(|f| &f.loops) {
        if let Loop::Polygon { vertices, .. } = a_loop {
            for_each_side(vertices, |a, b| *sides.entry([a.min(b), a.max(b)]).or_default() += 1);
        }
    }
    if sides.values().all(|&uses| uses > 1) {
        return 0;
    }
    let mut known: BTreeMap<[VertexId; 2], EdgeId> = BTreeMap::new();
    let mut replaced = 0;
    for face in &mut part.faces {
        for a_loop in &mut face.loops {
            let Loop::Polygon { vertices, outer } = a_loop else { continue };
            let mut coedges = Vec::new();
            for_each_side(vertices, |a, b| {
                let edge = *known.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                    let [start, end] = [a.min(b), a.max(b)];
                    let origin = part.vertices[start.index()].point;
                    let direction = part.vertices[end.index()].point - origin;
                    let curve = Some(Arc::new(Curve::Line { origin, direction }));
                    part.edges.push(Edge {
                        curve,
                        range: Range::new(0.0, 1.0),
                        start,
                        end,
                        source: face.source,
                    });
                    EdgeId::from(part.edges.len() - 1)
                });
                coedges.push(Coedge { edge, forward: a < b, pcurves: Vec::new() });
            });
            *a_loop = Loop::Edges { coedges, outer: *outer };
            replaced += 1;
        }
    }
    replaced
}

/// Sides between different vertices, in order.
fn for_each_side(vertices: &[VertexId], mut side: impl FnMut(VertexId, VertexId)) {
    for (i, &a) in vertices.iter().enumerate() {
        let b = vertices[(i + 1) % vertices.len()];
        if a != b {
            side(a, b);
        }
    }
}
