//! Makes a part from a document. A face with an invalid reference or invalid data fails, with the reason. All
//! other invalid items are ignored, with an issue.

use crate::load_geometry::{Sound, Surfaces, curve2, finite, p3, range};
use crate::load_issue::{issue, source};
use crate::schema::{
    Body, BodyKind, Coedge, Edge, Face, Failure, Loop, LooseItem, LooseKind, Part, Pcurve, Shell,
    TessellatedItem, Vertex,
};
use brep::{EdgeId, FaceId, Issue, ReadIssue, ShellId, VertexId};
use chordal_brep as brep;
use std::sync::Arc;

/// A part while it is loaded: for every index in the file the index in the part.
struct Loader<'w> {
    surfaces: Surfaces,
    vertices: Vec<Sound<VertexId>>,
    edges: Vec<Sound<EdgeId>>,
    part: brep::Part,
    issues: &'w mut Vec<Issue>,
}

pub(crate) fn part(part: Part, issues: &mut Vec<Issue>) -> brep::Part {
    let mut loader = Loader {
        surfaces: Surfaces::default(),
        vertices: Vec::with_capacity(part.vertices.len()),
        edges: Vec::with_capacity(part.edges.len()),
        part: brep::Part {
            name: part.name,
            color: part.color.map(brep::Color),
            uncertainty: part.uncertainty.and_then(|u| finite(u, "uncertainty").ok()),
            source: source(part.source),
            loose: part.loose.into_iter().map(loose).collect(),
            ..brep::Part::default()
        },
        issues,
    };
    part.surfaces.into_iter().for_each(|s| loader.surfaces.add(s));
    part.vertices.into_iter().for_each(|v| loader.vertex(v));
    part.edges.into_iter().for_each(|e| loader.edge(e));
    part.faces.into_iter().for_each(|f| loader.face(f));
    part.shells.into_iter().for_each(|s| loader.shell(s));
    part.bodies.into_iter().for_each(|b| loader.body(b));
    part.tessellated.into_iter().enumerate().for_each(|(i, t)| loader.tessellated(i, t));
    loader.part
}

fn known<T: Copy>(list: &[Sound<T>], place: u32, what: &'static str) -> Sound<T> {
    match list.get(place as usize) {
        Some(Ok(id)) => Ok(*id),
        Some(Err(why)) => Err(why.clone().within(what, place as usize)),
        None => Err(ReadIssue::NotFound { what, number: place.into() }),
    }
}

impl Loader<'_> {
    fn vertex(&mut self, vertex: Vertex) {
        let loaded = p3(vertex.point, "point").map(|point| {
            self.part.vertices.push(brep::Vertex { point, source: source(vertex.source) });
            VertexId::from(self.part.vertices.len() - 1)
        });
        self.vertices.push(loaded);
    }

    fn edge(&mut self, edge: Edge) {
        let loaded = self.sound_edge(edge).map(|edge| {
            self.part.edges.push(edge);
            EdgeId::from(self.part.edges.len() - 1)
        });
        self.edges.push(loaded);
    }

    fn sound_edge(&self, edge: Edge) -> Sound<brep::Edge> {
        let vertex = |place| known(&self.vertices, place, "vertex");
        let (start, end) = (vertex(edge.start)?, vertex(edge.end)?);
        if edge.curve.is_none() && start != end {
            return Err(ReadIssue::Missing { what: "curve between the two vertices" });
        }
        Ok(brep::Edge {
            curve: edge.curve.map(|c| self.surfaces.curve(c)).transpose()?.map(Arc::new),
            range: range(edge.range)?,
            start,
            end,
            source: source(edge.source),
        })
    }

    fn face(&mut self, face: Face) {
        let at = source(face.source);
        let error = |why: ReadIssue| Issue::error(at, why);
        let geometry = match (face.surface, face.failed) {
            (_, Some(Failure::Issue(failure))) => Err(issue(failure)),
            (_, Some(Failure::Sentence(sentence))) => {
                Err(error(ReadIssue::Recorded { code: "recorded", sentence }))
            }
            (Some(place), None) => self.surfaces.get(place).map_err(error),
            (None, None) => Err(error(ReadIssue::NoSurface)),
        };
        let failed = brep::FaceGeometry::Failed;
        let loops = face.loops.into_iter().map(|l| self.boundary(l)).collect::<Sound<Vec<_>>>();
        let (geometry, loops) = match (geometry, loops) {
            (Ok(surface), Ok(loops)) => (brep::FaceGeometry::Surface(surface), loops),
            (Err(why), loops) => (failed(why), loops.unwrap_or_default()),
            (_, Err(why)) => (failed(error(why)), Vec::new()),
        };
        self.part.faces.push(brep::Face {
            geometry,
            same_sense: face.same_sense,
            flipped: face.flipped,
            loops,
            name: face.name,
            color: face.color.map(brep::Color),
            layer: face.layer,
            source: at,
        });
    }

    fn boundary(&self, boundary: Loop) -> Sound<brep::Loop> {
        match boundary {
            Loop::Edges { coedges, outer } => {
                let coedges = coedges.into_iter().map(|c| self.coedge(c)).collect::<Sound<Vec<_>>>()?;
                self.check_chain(&coedges)?;
                Ok(brep::Loop::Edges { coedges, outer })
            }
            Loop::Vertex(place) => Ok(brep::Loop::Vertex(known(&self.vertices, place, "vertex")?)),
            Loop::Polygon { vertices, outer } => {
                if vertices.len() < 3 {
                    return Err(ReadIssue::TooFew { what: "corners", found: vertices.len(), least: 3 });
                }
                let vertex = |place| known(&self.vertices, place, "vertex");
                Ok(brep::Loop::Polygon {
                    vertices: vertices.into_iter().map(vertex).collect::<Sound<_>>()?,
                    outer,
                })
            }
        }
    }

    fn coedge(&self, coedge: Coedge) -> Sound<brep::Coedge> {
        let pcurve =
            |p: Pcurve| Ok(brep::Pcurve { curve: Arc::new(curve2(p.curve)?), range: range(p.range)? });
        let edge = known(&self.edges, coedge.edge, "edge")?;
        let pcurves = coedge.pcurves.into_iter().map(pcurve).collect::<Sound<_>>();
        let pcurves = pcurves.map_err(|why| why.within("parameter curve of edge", coedge.edge as usize))?;
        Ok(brep::Coedge { edge, forward: coedge.forward, pcurves })
    }

    /// Checks that every coedge begins at the vertex at which the one before it ends.
    fn check_chain(&self, coedges: &[brep::Coedge]) -> Sound<()> {
        let ends = |i: usize| {
            let coedge = &coedges[i % coedges.len()];
            let edge = &self.part.edges[coedge.edge.index()];
            if coedge.forward { (edge.start, edge.end) } else { (edge.end, edge.start) }
        };
        match (0..coedges.len()).find(|&i| ends(i).1 != ends(i + 1).0) {
            Some(i) => Err(ReadIssue::LoopBroken { coedge: i }),
            None if coedges.is_empty() => Err(ReadIssue::NoEdges),
            None => Ok(()),
        }
    }

    fn shell(&mut self, shell: Shell) {
        let faces = self.present(shell.faces, self.part.faces.len(), "face", shell.source);
        self.part.shells.push(brep::Shell {
            faces: faces.into_iter().map(FaceId).collect(),
            closed: shell.closed,
            source: source(shell.source),
        });
    }

    fn body(&mut self, body: Body) {
        let shells = self.present(body.shells, self.part.shells.len(), "shell", body.source);
        self.part.bodies.push(brep::Body {
            kind: match body.kind {
                BodyKind::Solid => brep::BodyKind::Solid,
                BodyKind::Sheet => brep::BodyKind::Sheet,
                BodyKind::FaceSet => brep::BodyKind::FaceSet,
            },
            shells: shells.into_iter().map(ShellId).collect(),
            name: body.name,
            color: body.color.map(brep::Color),
            layer: body.layer,
            source: source(body.source),
        });
    }

    /// The valid indices of a list; adds a warning for the others.
    fn present(&mut self, list: Vec<u32>, count: usize, what: &'static str, at: (u64, u32)) -> Vec<u32> {
        let (there, missing): (Vec<u32>, Vec<u32>) =
            list.into_iter().partition(|&place| (place as usize) < count);
        if let Some(first) = missing.first() {
            let missing = ReadIssue::NotFound { what, number: i64::from(*first) };
            self.issues.push(Issue::error(source(at), missing));
        }
        there
    }

    fn tessellated(&mut self, place: usize, item: TessellatedItem) {
        let at = source(item.source);
        match tessellated(item) {
            Ok(item) => self.part.tessellated.push(item),
            Err(why) => {
                let what = format!("tessellated item {place} of part {:?}", self.part.name).into();
                self.issues.push(Issue::error(at, ReadIssue::Ignored { what, cause: why.boxed() }));
            }
        }
    }
}

fn tessellated(item: TessellatedItem) -> Sound<brep::TessellatedItem> {
    let count = item.points.len();
    if let Some(corner) = item.triangles.iter().flatten().find(|&&c| c as usize >= count) {
        return Err(ReadIssue::NotFound { what: "corner", number: i64::from(*corner) });
    }
    if !item.normals.is_empty() && item.normals.len() != count {
        return Err(ReadIssue::Count { what: "normals", found: item.normals.len(), expected: count });
    }
    let list = |points: Vec<_>, what| points.into_iter().map(|p| p3(p, what)).collect::<Sound<Vec<_>>>();
    Ok(brep::TessellatedItem {
        name: item.name,
        points: list(item.points, "point")?,
        triangles: item.triangles,
        normals: list(item.normals, "normal")?,
        color: item.color.map(brep::Color),
        source: source(item.source),
    })
}

fn loose(item: LooseItem) -> brep::LooseItem {
    brep::LooseItem {
        kind: match item.kind {
            LooseKind::Wire => brep::LooseKind::Wire,
            LooseKind::Point => brep::LooseKind::Point,
        },
        name: item.name,
        source: source(item.source),
    }
}
