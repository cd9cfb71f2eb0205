//! Makes a document from a model.

use crate::save_geometry::{Surfaces, curve2, p3};
use crate::schema::{
    Body, BodyKind, Coedge, Document, Edge, Face, Failure, Loop, LooseItem, LooseKind, Node, Part, Pcurve,
    Shell, Source, TessellatedItem, Vertex, Warning,
};
use crate::{DocumentError, SCHEMA, real::Real};
use chordal_brep as brep;
use chordal_nurbs::Range;

type Res<T> = Result<T, DocumentError>;

pub(crate) fn document(model: &brep::Model) -> Res<Document> {
    Ok(Document {
        schema: SCHEMA.to_owned(),
        name: model.name.clone(),
        format: model.schema.clone(),
        unit: model.unit.clone(),
        parts: model.parts.iter().map(part).collect::<Res<_>>()?,
        nodes: model.nodes.iter().map(node).collect(),
        roots: model.roots.iter().map(|id| id.0).collect(),
        warnings: model.issues.iter().map(warning).collect(),
    })
}

fn source(source: brep::Source) -> Source {
    (source.entity, source.line)
}

fn range(range: Range) -> [Real; 2] {
    [Real(range.start), Real(range.end)]
}

fn node(node: &brep::Node) -> Node {
    let m = &node.transform;
    Node {
        name: node.name.clone(),
        transform: [m.matrix3.x_axis, m.matrix3.y_axis, m.matrix3.z_axis, m.translation].map(p3),
        part: node.part.map(|id| id.0),
        children: node.children.iter().map(|id| id.0).collect(),
        color: node.color.map(|c| c.0),
        source: source(node.source),
    }
}

fn warning(issue: &brep::Issue) -> Warning {
    let code = issue.kind.code().to_owned();
    Warning { code, message: issue.kind.to_string(), lost: issue.is_error(), source: source(issue.source) }
}

fn part(part: &brep::Part) -> Res<Part> {
    let mut surfaces = Surfaces::default();
    // Faces first: their surfaces get the low indices.
    let faces = part.faces.iter().map(|f| face(f, &mut surfaces)).collect::<Res<_>>()?;
    let edges = part.edges.iter().map(|e| edge(e, &mut surfaces)).collect::<Res<_>>()?;
    Ok(Part {
        name: part.name.clone(),
        color: part.color.map(|c| c.0),
        uncertainty: part.uncertainty.map(Real),
        source: source(part.source),
        surfaces: surfaces.written,
        vertices: part
            .vertices
            .iter()
            .map(|v| Vertex { point: p3(v.point), source: source(v.source) })
            .collect(),
        edges,
        faces,
        shells: part.shells.iter().map(shell).collect(),
        bodies: part.bodies.iter().map(body).collect(),
        loose: part.loose.iter().map(loose).collect(),
        tessellated: part.tessellated.iter().map(tessellated).collect(),
    })
}

fn edge(edge: &brep::Edge, surfaces: &mut Surfaces) -> Res<Edge> {
    Ok(Edge {
        curve: edge.curve.as_ref().map(|curve| surfaces.curve(curve)).transpose()?,
        range: range(edge.range),
        start: edge.start.0,
        end: edge.end.0,
        source: source(edge.source),
    })
}

fn face(face: &brep::Face, surfaces: &mut Surfaces) -> Res<Face> {
    let (surface, failed) = match &face.geometry {
        brep::FaceGeometry::Surface(surface) => (Some(surfaces.place(surface)?), None),
        brep::FaceGeometry::Failed(reason) => (None, Some(Failure::Issue(warning(reason)))),
    };
    Ok(Face {
        surface,
        failed,
        same_sense: face.same_sense,
        flipped: face.flipped,
        loops: face.loops.iter().map(boundary).collect::<Res<_>>()?,
        name: face.name.clone(),
        color: face.color.map(|c| c.0),
        layer: face.layer.clone(),
        source: source(face.source),
    })
}

fn boundary(boundary: &brep::Loop) -> Res<Loop> {
    Ok(match boundary {
        brep::Loop::Edges { coedges, outer } => {
            Loop::Edges { coedges: coedges.iter().map(coedge).collect::<Res<_>>()?, outer: *outer }
        }
        brep::Loop::Vertex(vertex) => Loop::Vertex(vertex.0),
        brep::Loop::Polygon { vertices, outer } => {
            Loop::Polygon { vertices: vertices.iter().map(|v| v.0).collect(), outer: *outer }
        }
    })
}

fn coedge(coedge: &brep::Coedge) -> Res<Coedge> {
    let pcurve = |p: &brep::Pcurve| Ok(Pcurve { curve: curve2(&p.curve)?, range: range(p.range) });
    Ok(Coedge {
        edge: coedge.edge.0,
        forward: coedge.forward,
        pcurves: coedge.pcurves.iter().map(pcurve).collect::<Res<_>>()?,
    })
}

fn shell(shell: &brep::Shell) -> Shell {
    Shell {
        faces: shell.faces.iter().map(|f| f.0).collect(),
        closed: shell.closed,
        source: source(shell.source),
    }
}

fn body(body: &brep::Body) -> Body {
    Body {
        kind: match body.kind {
            brep::BodyKind::Solid => BodyKind::Solid,
            brep::BodyKind::Sheet => BodyKind::Sheet,
            brep::BodyKind::FaceSet => BodyKind::FaceSet,
        },
        shells: body.shells.iter().map(|s| s.0).collect(),
        name: body.name.clone(),
        color: body.color.map(|c| c.0),
        layer: body.layer.clone(),
        source: source(body.source),
    }
}

fn loose(item: &brep::LooseItem) -> LooseItem {
    LooseItem {
        kind: match item.kind {
            brep::LooseKind::Wire => LooseKind::Wire,
            brep::LooseKind::Point => LooseKind::Point,
        },
        name: item.name.clone(),
        source: source(item.source),
    }
}

fn tessellated(item: &brep::TessellatedItem) -> TessellatedItem {
    TessellatedItem {
        name: item.name.clone(),
        points: item.points.iter().copied().map(p3).collect(),
        triangles: item.triangles.clone(),
        normals: item.normals.iter().copied().map(p3).collect(),
        color: item.color.map(|c| c.0),
        source: source(item.source),
    }
}
