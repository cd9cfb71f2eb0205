//! Every face an island: what a file without topology would hold of the same shape.

use crate::{BodyKind, EdgeId, Face, Loop, Model, Part, VertexId};
use std::collections::BTreeMap;

impl Model {
    /// The model with every face an island; see [`Part::unsewn`].
    pub fn unsewn(&self) -> Model {
        Model { parts: self.parts.iter().map(Part::unsewn).collect(), ..self.clone() }
    }
}

impl Part {
    /// The part with every face an island: it has edges and vertices of its own and shares none with another
    /// face.
    ///
    /// An edge that one face uses twice (a seam) stays one edge. Faces keep their order, shells and bodies;
    /// bodies become face sets, and no shell claims to be closed. Edges and vertices that no face uses are
    /// gone.
    pub fn unsewn(&self) -> Part {
        let mut part = Part { vertices: Vec::new(), edges: Vec::new(), faces: Vec::new(), ..self.clone() };
        for face in &self.faces {
            let mut island = Island::default();
            let loops = face.loops.iter().map(|l| island.boundary(l, self, &mut part)).collect();
            part.faces.push(Face { loops, ..face.clone() });
        }
        part.shells.iter_mut().for_each(|shell| shell.closed = false);
        part.bodies.iter_mut().for_each(|body| body.kind = BodyKind::FaceSet);
        part
    }
}

/// The copies that faces have: old id to new.
#[derive(Debug, Default)]
pub(crate) struct Island {
    vertices: BTreeMap<VertexId, VertexId>,
    edges: BTreeMap<EdgeId, EdgeId>,
}

impl Island {
    /// A loop over copies of its edges and vertices.
    pub(crate) fn boundary(&mut self, boundary: &Loop, from: &Part, to: &mut Part) -> Loop {
        let mut copy = boundary.clone();
        match &mut copy {
            Loop::Edges { coedges, .. } => {
                coedges.iter_mut().for_each(|coedge| coedge.edge = self.edge(coedge.edge, from, to));
            }
            Loop::Vertex(vertex) => *vertex = self.vertex(*vertex, from, to),
            Loop::Polygon { vertices, .. } => {
                vertices.iter_mut().for_each(|vertex| *vertex = self.vertex(*vertex, from, to));
            }
        }
        copy
    }

    fn edge(&mut self, old: EdgeId, from: &Part, to: &mut Part) -> EdgeId {
        if let Some(&copied) = self.edges.get(&old) {
            return copied;
        }
        let mut edge = from.edges[old.index()].clone();
        edge.start = self.vertex(edge.start, from, to);
        edge.end = self.vertex(edge.end, from, to);
        let copied = EdgeId::from(to.edges.len());
        to.edges.push(edge);
        self.edges.insert(old, copied);
        copied
    }

    fn vertex(&mut self, old: VertexId, from: &Part, to: &mut Part) -> VertexId {
        *self.vertices.entry(old).or_insert_with(|| {
            to.vertices.push(from.vertices[old.index()].clone());
            VertexId::from(to.vertices.len() - 1)
        })
    }
}
