//! Boxes, spheres, cylinders and cones as exact solids around the origin, their axis along y.

use crate::trimmed::{self, Look};
use chordal_brep::{
    BodyKind, Coedge, Edge, EdgeId, Face, FaceGeometry, FaceId, Loop, Part, Source, Vertex, VertexId,
};
use chordal_nurbs::{Curve, DVec3, Frame, Range, Surface, math};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Which faces of a cylinder or cone are there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Faces {
    pub side: bool,
    pub top: bool,
    pub bottom: bool,
}

struct Maker<'a> {
    part: &'a mut Part,
    look: &'a Look,
    faces: Vec<FaceId>,
}

/// A box with these edge lengths.
pub(crate) fn cuboid(part: &mut Part, size: DVec3, look: &Look) {
    let h = size * 0.5;
    let mut maker = Maker { part, look, faces: Vec::new() };
    let corner = |i: usize| {
        let side = |axis: usize, h: f64| if i >> axis & 1 == 1 { h } else { -h };
        DVec3::new(side(0, h.x), side(1, h.y), side(2, h.z))
    };
    let vertices: Vec<VertexId> = (0..8).map(|i| maker.vertex(corner(i))).collect();
    let mut edges: Vec<(usize, usize, EdgeId)> = Vec::new();
    for a in 0..8usize {
        for axis in 0..3 {
            let b = a | 1 << axis;
            if b != a {
                let line = Curve::Line { origin: corner(a), direction: corner(b) - corner(a) };
                let edge = maker.edge(line, Range::new(0.0, 1.0), [vertices[a], vertices[b]]);
                edges.push((a, b, edge));
            }
        }
    }
    // Counter-clockwise seen from outside.
    let rings = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    for ring in rings {
        let coedge = |k: usize| {
            let (a, b): (usize, usize) = (ring[k], ring[(k + 1) % 4]);
            let edge =
                edges.iter().find(|e| (e.0, e.1) == (a.min(b), a.max(b))).expect("neighbouring corners");
            Coedge { edge: edge.2, forward: a < b, pcurves: Vec::new() }
        };
        let [a, b, c] = [ring[0], ring[1], ring[2]].map(corner);
        let frame = Frame::new(a, (b - a).cross(c - b), b - a);
        let coedges = (0..4).map(coedge).collect();
        maker.face(Surface::Plane { frame }, true, vec![Loop::Edges { coedges, outer: true }]);
    }
    maker.finish(true);
}

/// A sphere.
pub(crate) fn sphere(part: &mut Part, radius: f64, look: &Look) {
    let mut maker = Maker { part, look, faces: Vec::new() };
    maker.face(Surface::Sphere { frame: axis_frame(0.0), radius }, true, Vec::new());
    maker.finish(true);
}

/// A cylinder.
pub(crate) fn cylinder(part: &mut Part, radius: f64, height: f64, which: Faces, look: &Look) {
    let mut maker = Maker { part, look, faces: Vec::new() };
    let h = 0.5 * height;
    let [low, high] = [-h, h].map(|y| maker.circle(y, radius));
    if which.side {
        let loops = vec![ring(low, true), ring(high, false)];
        maker.face(Surface::Cylinder { frame: axis_frame(0.0), radius }, true, loops);
    }
    maker.caps(which, [(low, -h), (high, h)]);
    maker.finish(which.side && which.top && which.bottom);
}

/// A cone with its apex on top.
pub(crate) fn cone(part: &mut Part, radius: f64, height: f64, which: Faces, look: &Look) {
    let mut maker = Maker { part, look, faces: Vec::new() };
    let low = maker.circle(-0.5 * height, radius);
    if which.side {
        let half_angle = -math::atan(radius / height);
        let surface = Surface::Cone { frame: axis_frame(-0.5 * height), radius, half_angle };
        maker.face(surface, true, vec![ring(low, true)]);
    }
    maker.caps(Faces { top: false, ..which }, [(low, -0.5 * height), (low, 0.0)]);
    maker.finish(which.side && which.bottom);
}

/// The frame at height `y` with its z axis along the world's y.
fn axis_frame(y: f64) -> Frame {
    Frame::new(DVec3::new(0.0, y, 0.0), DVec3::Y, DVec3::Z)
}

fn ring(edge: EdgeId, forward: bool) -> Loop {
    Loop::Edges { coedges: vec![Coedge { edge, forward, pcurves: Vec::new() }], outer: true }
}

impl Maker<'_> {
    fn vertex(&mut self, point: DVec3) -> VertexId {
        let id = VertexId::from(self.part.vertices.len());
        self.part.vertices.push(Vertex { point, source: self.look.source });
        id
    }

    fn edge(&mut self, curve: Curve, range: Range, [start, end]: [VertexId; 2]) -> EdgeId {
        let id = EdgeId::from(self.part.edges.len());
        let source: Source = self.look.source;
        self.part.edges.push(Edge { curve: Some(Arc::new(curve)), range, start, end, source });
        id
    }

    /// A circle about the axis, counter-clockwise seen from above.
    fn circle(&mut self, y: f64, radius: f64) -> EdgeId {
        let frame = axis_frame(y);
        let vertex = self.vertex(frame.origin + frame.x * radius);
        self.edge(Curve::Circle { frame, radius }, Range::new(0.0, TAU), [vertex, vertex])
    }

    fn face(&mut self, surface: Surface, same_sense: bool, loops: Vec<Loop>) {
        self.faces.push(FaceId::from(self.part.faces.len()));
        self.part.faces.push(Face {
            geometry: FaceGeometry::Surface(Arc::new(surface)),
            same_sense,
            flipped: false,
            loops,
            name: self.look.name.clone(),
            color: self.look.color,
            layer: None,
            source: self.look.source,
        });
    }

    /// Flat faces at the lower and upper circle.
    fn caps(&mut self, which: Faces, [(low, low_y), (high, high_y)]: [(EdgeId, f64); 2]) {
        if which.bottom {
            self.face(Surface::Plane { frame: axis_frame(low_y) }, false, vec![ring(low, false)]);
        }
        if which.top {
            self.face(Surface::Plane { frame: axis_frame(high_y) }, true, vec![ring(high, true)]);
        }
    }

    fn finish(self, closed: bool) {
        let kind = if closed { BodyKind::Solid } else { BodyKind::Sheet };
        if !self.faces.is_empty() {
            trimmed::add_body(self.part, self.faces, kind, self.look);
        }
    }
}
