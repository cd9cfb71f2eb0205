//! The assembly tree: placements, units, instances.

use chordal_brep::{
    Coedge, Edge, EdgeId, Face, FaceGeometry, Issue, Loop, Model, Node, NodeId, Part, PartId, ReadIssue,
    Source, Vertex, VertexId,
};
use chordal_nurbs::{DAffine3, DVec3, Frame, Range, Surface};
use std::sync::Arc;

fn node(transform: DAffine3, part: Option<PartId>, children: Vec<NodeId>) -> Node {
    Node { name: String::new(), transform, part, children, color: None, source: Source::default() }
}

#[test]
fn a_walk_down_the_tree_ends_in_millimetres() {
    let inches = DAffine3::from_scale(DVec3::splat(25.4));
    let moved = |x: f64| DAffine3::from_translation(DVec3::new(x, 0.0, 0.0));
    let model = Model {
        parts: vec![Part::default()],
        nodes: vec![
            node(inches, None, vec![NodeId(1), NodeId(2)]),
            node(moved(1.0), Some(PartId(0)), Vec::new()),
            node(moved(2.0), Some(PartId(0)), Vec::new()),
        ],
        roots: vec![NodeId(0)],
        ..Model::default()
    };
    let at: Vec<(NodeId, f64)> =
        model.placements().iter().map(|p| (p.node, p.world.transform_point3(DVec3::ZERO).x)).collect();
    assert_eq!(at, [(NodeId(1), 25.4), (NodeId(2), 50.8)]);
}

fn face(loops: Vec<Loop>) -> Face {
    let frame = Frame::new(DVec3::ZERO, DVec3::Z, DVec3::X);
    Face {
        geometry: FaceGeometry::Surface(Arc::new(Surface::Plane { frame })),
        same_sense: true,
        flipped: false,
        loops,
        name: String::new(),
        color: None,
        layer: None,
        source: Source::default(),
    }
}

#[test]
fn unsewn_faces_share_no_edge() {
    let source = Source::default();
    let uses = |forward| {
        let coedge = Coedge { edge: EdgeId(0), forward, pcurves: Vec::new() };
        vec![Loop::Edges { coedges: vec![coedge], outer: true }]
    };
    let part = Part {
        vertices: vec![Vertex { point: DVec3::X, source }],
        edges: vec![Edge {
            curve: None,
            range: Range::new(0.0, 1.0),
            start: VertexId(0),
            end: VertexId(0),
            source,
        }],
        faces: vec![face(uses(true)), face(uses(false))],
        ..Part::default()
    };
    let apart = part.unsewn();
    assert_eq!((apart.edges.len(), apart.vertices.len(), apart.faces.len()), (2, 2, 2));
    let edge = |face: usize| match &apart.faces[face].loops[0] {
        Loop::Edges { coedges, .. } => coedges[0].edge,
        _ => panic!("edges"),
    };
    assert_ne!(edge(0), edge(1));
}

#[test]
fn a_face_has_a_surface_or_a_reason() {
    let mut face = face(Vec::new());
    assert!(face.surface().is_some() && face.failure().is_none());
    face.geometry = FaceGeometry::Failed(Issue::error(Source::default(), ReadIssue::NoSurface));
    assert!(face.surface().is_none());
    assert_eq!(face.failure().map(|issue| issue.kind.code()), Some("no-surface"));
    face.flipped = true;
    assert!(face.normal_reversed());
}
