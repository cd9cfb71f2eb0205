//! Vertices that turned out to be one.

use chordal_brep::{Loop, Part, VertexId};

/// Replaces each vertex by the first of those it is one with.
pub(crate) fn merge_vertices(part: &mut Part, same: &[(VertexId, VertexId)]) {
    if same.is_empty() {
        return;
    }
    let mut parent: Vec<u32> = (0..part.vertices.len() as u32).collect();
    let root = |parent: &mut Vec<u32>, mut v: u32| {
        while parent[v as usize] != v {
            parent[v as usize] = parent[parent[v as usize] as usize];
            v = parent[v as usize];
        }
        v
    };
    for &(a, b) in same {
        let (a, b) = (root(&mut parent, a.0), root(&mut parent, b.0));
        parent[a.max(b) as usize] = a.min(b);
    }
    let mut renamed = |v: &mut VertexId| v.0 = root(&mut parent, v.0);
    for edge in &mut part.edges {
        renamed(&mut edge.start);
        renamed(&mut edge.end);
    }
    for boundary in part.faces.iter_mut().flat_map(|face| &mut face.loops) {
        match boundary {
            Loop::Vertex(v) => renamed(v),
            Loop::Polygon { vertices, .. } => vertices.iter_mut().for_each(&mut renamed),
            Loop::Edges { .. } => {}
        }
    }
}
