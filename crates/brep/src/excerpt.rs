//! A few faces of a part, with what they need, and nothing that names them.

use crate::unsewn::Island;
use crate::{Body, BodyKind, EdgeId, Face, FaceId, Loop, Model, Node, NodeId, Part, PartId, Shell, ShellId};
use chordal_nurbs::DAffine3;
use std::collections::BTreeSet;

impl Part {
    /// These faces, in this order, with their edges and vertices, which they share as before.
    ///
    /// The excerpt has no names, colours, layers, loose items or triangles of the file. Entity numbers and
    /// lines are kept. All faces are in one sheet, or in the shells and bodies of the part where no face is
    /// left out.
    pub fn excerpt(&self, faces: &[FaceId]) -> Part {
        let mut part = Part { uncertainty: self.uncertainty, source: self.source, ..Part::default() };
        let mut copies = Island::default();
        for &face in faces {
            let face = &self.faces[face.index()];
            let loops = face.loops.iter().map(|l| copies.boundary(l, self, &mut part)).collect();
            let geometry = face.geometry.clone();
            part.faces.push(Face { geometry, loops, name: String::new(), color: None, layer: None, ..*face });
        }
        let is_whole = faces.iter().map(|face| face.index()).eq(0..self.faces.len());
        if is_whole {
            part.shells = self.shells.clone();
            let unnamed =
                |body: &Body| Body { name: String::new(), color: None, layer: None, ..body.clone() };
            part.bodies = self.bodies.iter().map(unnamed).collect();
        } else {
            let faces = (0..faces.len()).map(FaceId::from).collect();
            part.shells.push(Shell { faces, closed: false, source: self.source });
            part.bodies.push(Body {
                kind: BodyKind::Sheet,
                shells: vec![ShellId::from(0)],
                name: String::new(),
                color: None,
                layer: None,
                source: self.source,
            });
        }
        part
    }

    /// These faces and all that share an edge with one of them, in the order of the part.
    pub fn with_neighbours(&self, faces: &[FaceId]) -> Vec<FaceId> {
        let edges: BTreeSet<EdgeId> =
            faces.iter().flat_map(|face| edges_of(&self.faces[face.index()])).collect();
        let is_near = |id: &FaceId| {
            faces.contains(id) || edges_of(&self.faces[id.index()]).any(|edge| edges.contains(&edge))
        };
        (0..self.faces.len()).map(FaceId::from).filter(is_near).collect()
    }
}

fn edges_of(face: &Face) -> impl Iterator<Item = EdgeId> + '_ {
    face.loops.iter().flat_map(|boundary| match boundary {
        Loop::Edges { coedges, .. } => coedges.iter().map(|coedge| coedge.edge).collect(),
        Loop::Vertex(_) | Loop::Polygon { .. } => Vec::new(),
    })
}

impl Model {
    /// A model of these faces of one part alone, placed by `world`; see [`Part::excerpt`]. Of the header, the
    /// first word of the format and the unit stay.
    pub fn excerpt(&self, part: PartId, faces: &[FaceId], world: DAffine3) -> Model {
        let part = self.parts[part.index()].excerpt(faces);
        let source = part.source;
        let node = Node {
            name: String::new(),
            transform: world,
            part: Some(PartId::from(0)),
            children: Vec::new(),
            color: None,
            source,
        };
        Model {
            name: String::new(),
            schema: self.schema.split_whitespace().next().unwrap_or_default().to_owned(),
            unit: self.unit.clone(),
            parts: vec![part],
            nodes: vec![node],
            roots: vec![NodeId::from(0)],
            issues: Vec::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Coedge, Color, Edge, FaceGeometry, Source, Vertex, VertexId};
    use chordal_nurbs::{DVec3, Frame, Range, Surface};
    use std::sync::Arc;

    /// Three faces in a row; each has one edge in common with the next.
    fn row() -> Part {
        let surface = Arc::new(Surface::Plane { frame: Frame::new(DVec3::ZERO, DVec3::Z, DVec3::X) });
        let coedge = |edge: usize| Coedge { edge: EdgeId::from(edge), forward: true, pcurves: Vec::new() };
        let face = |first: usize| Face {
            geometry: FaceGeometry::Surface(surface.clone()),
            same_sense: true,
            flipped: false,
            loops: vec![Loop::Edges { coedges: vec![coedge(first), coedge(first + 1)], outer: true }],
            name: "secret".into(),
            color: Some(Color([1.0; 4])),
            layer: Some("secret".into()),
            source: Source { entity: first as u64, line: 1 },
        };
        let edge = |i: usize| Edge {
            curve: None,
            range: Range::new(0.0, 1.0),
            start: VertexId::from(i),
            end: VertexId::from(i),
            source: Source::default(),
        };
        Part {
            name: "secret".into(),
            vertices: (0..4)
                .map(|i| Vertex { point: DVec3::splat(i as f64), source: Source::default() })
                .collect(),
            edges: (0..4).map(edge).collect(),
            faces: (0..3).map(face).collect(),
            ..Part::default()
        }
    }

    #[test]
    fn an_excerpt_shares_edges_and_has_no_names() {
        let part = row().excerpt(&[FaceId::from(1), FaceId::from(2)]);
        assert_eq!((part.faces.len(), part.edges.len(), part.vertices.len()), (2, 3, 3));
        assert_eq!(part.faces[0].source.entity, 1);
        assert!(!format!("{part:?}").contains("secret"));
        assert!(part.faces.iter().all(|face| face.color.is_none()));
    }

    #[test]
    fn neighbours_share_an_edge() {
        let row = row();
        let near = |faces: &[usize]| -> Vec<usize> {
            let faces: Vec<FaceId> = faces.iter().copied().map(FaceId::from).collect();
            row.with_neighbours(&faces).into_iter().map(FaceId::index).collect()
        };
        assert_eq!((near(&[0]), near(&[1])), (vec![0, 1], vec![0, 1, 2]));
    }
}
