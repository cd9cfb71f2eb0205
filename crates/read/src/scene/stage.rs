//! The model under construction: shapes become bodies of one common part, solids and what is used more than
//! once become parts of their own.

use super::graph::{Graph, NodeIx};
use crate::assemble::Notes;
use crate::trimmed::{self, Look, TrimLoop};
use crate::{Format, ReadError};
use chordal_brep::{
    BodyKind, Color, FaceGeometry, Issue, LooseItem, LooseKind, Model, Node, NodeId, Part, PartId, ReadIssue,
    Source, TessellatedItem,
};
use chordal_nurbs::{DAffine3, DVec3, NurbsSurface, Surface};
use std::sync::Arc;

/// A placed part of its own.
#[derive(Clone, Debug)]
pub(crate) struct Placed {
    part: PartId,
    transform: DAffine3,
    name: String,
    source: Source,
}

/// A part under construction with what is placed in its coordinates.
#[derive(Debug, Default)]
struct Frame {
    part: Part,
    placed: Vec<Placed>,
}

/// Collects what a walk through a graph finds.
#[derive(Debug)]
pub(crate) struct Stage {
    /// The first one is the common part's place.
    parts: Vec<Part>,
    /// The common part, and what is used more than once and being walked through.
    frames: Vec<Frame>,
    /// What may still be visited and copied: it bounds the work on files whose uses of uses fan out for ever.
    budget: u64,
    exhausted: bool,
    pub notes: Notes,
}

/// Work that any file may cause, and work for each byte of it.
const BUDGET: u64 = 4_000_000;
const BUDGET_PER_BYTE: u64 = 16;

/// The work of one placement.
const PLACEMENT: usize = 100;

impl Stage {
    pub(crate) fn new(bytes: usize) -> Self {
        Self {
            parts: vec![Part::default()],
            frames: vec![Frame::default()],
            budget: BUDGET + BUDGET_PER_BYTE * bytes as u64,
            exhausted: false,
            notes: Notes::default(),
        }
    }

    fn frame(&mut self) -> &mut Frame {
        self.frames.last_mut().expect("the common part is never taken")
    }

    fn part(&mut self) -> &mut Part {
        &mut self.frame().part
    }

    /// True while the budget lasts for work of this size.
    pub(crate) fn afford(&mut self, size: usize, source: Source) -> bool {
        let cost = 1 + size as u64;
        if self.budget < cost {
            if !self.exhausted {
                self.notes.lose(source, ReadIssue::TooManyReferences);
            }
            self.exhausted = true;
            self.budget = 0;
            return false;
        }
        self.budget -= cost;
        true
    }

    /// Shapes that come now belong to a part of their own.
    pub(crate) fn open_part(&mut self, name: &str, source: Source) {
        let part = Part { name: name.to_owned(), source, ..Part::default() };
        self.frames.push(Frame { part, placed: Vec::new() });
    }

    /// Ends the part opened last: what it consists of, in its own coordinates.
    pub(crate) fn close_part(&mut self) -> Vec<Placed> {
        if self.frames.len() < 2 {
            return Vec::new();
        }
        let Frame { part, mut placed } = self.frames.pop().expect("there are two");
        if !is_empty(&part) {
            let (name, source) = (part.name.clone(), part.source);
            let id = PartId::from(self.parts.len());
            self.parts.push(part);
            placed.insert(0, Placed { part: id, transform: DAffine3::IDENTITY, name, source });
        }
        placed
    }

    /// Places what a closed part consists of.
    pub(crate) fn place(&mut self, what: &[Placed], transform: &DAffine3, source: Source) {
        if !transform.is_finite() {
            self.notes.lose(source, ReadIssue::NotFinite { what: "placement of the shape" });
        } else if self.afford(PLACEMENT * what.len(), source) {
            let moved = |p: &Placed| Placed { transform: *transform * p.transform, ..p.clone() };
            self.frame().placed.extend(what.iter().map(moved));
        }
    }

    /// Adds a spline surface with its trims as a body.
    pub(crate) fn surface(
        &mut self,
        nurbs: &NurbsSurface,
        trims: &[TrimLoop],
        world: &DAffine3,
        look: &Look,
    ) {
        let moved = nurbs.transformed(world);
        if !moved.points().iter().all(|p| p.is_finite()) {
            return self.failed(ReadIssue::NotFinite { what: "placement of the shape" }, look);
        }
        let surface = Arc::new(Surface::Nurbs(moved));
        let look = Look { flipped: look.flipped ^ mirrors(world), ..look.clone() };
        let frame = self.frames.last_mut().expect("the common part is never taken");
        let faces = trimmed::add_faces(&mut frame.part, &surface, trims, &look, &self.notes);
        trimmed::add_body(&mut frame.part, faces, BodyKind::FaceSet, &look);
    }

    /// Adds a shape that could not be understood as a failed face.
    pub(crate) fn failed(&mut self, reason: ReadIssue, look: &Look) {
        let part = self.part();
        let face = trimmed::add_failed(part, reason, look);
        trimmed::add_body(part, vec![face], BodyKind::FaceSet, look);
    }

    /// Adds triangles, corners counter-clockwise unless the look is flipped.
    pub(crate) fn triangles(
        &mut self,
        points: Vec<DVec3>,
        triangles: Vec<[u32; 3]>,
        world: &DAffine3,
        look: &Look,
    ) {
        if triangles.is_empty() {
            return;
        }
        let turned = look.flipped ^ mirrors(world);
        let item = TessellatedItem {
            name: look.name.clone(),
            points: points.into_iter().map(|p| world.transform_point3(p)).collect(),
            triangles: triangles.into_iter().map(|t| if turned { [t[0], t[2], t[1]] } else { t }).collect(),
            normals: Vec::new(),
            color: look.color,
            source: look.source,
        };
        if item.points.iter().all(|p| p.is_finite()) {
            self.part().tessellated.push(item);
        } else {
            self.notes.lose(look.source, ReadIssue::NotFinite { what: "corner of a polygon" });
        }
    }

    /// Places a solid that `build` puts into an empty part.
    pub(crate) fn solid(&mut self, world: &DAffine3, look: &Look, build: impl FnOnce(&mut Part, &Look)) {
        self.open_part(&look.name, look.source);
        build(self.part(), look);
        let solid = self.close_part();
        self.place(&solid, world, look.source);
    }

    /// Notes a curve or point that belongs to no surface.
    pub(crate) fn loose(&mut self, kind: LooseKind, name: &str, source: Source) {
        self.part().loose.push(LooseItem { kind, name: name.to_owned(), source });
    }

    /// The model of everything found; lengths in units of `millimetres`.
    ///
    /// # Errors
    /// [`ReadError::NothingInIt`] where there is no shape.
    pub(crate) fn finish(
        mut self,
        format: Format,
        graph: &mut Graph,
        name: &str,
        schema: String,
        unit: &str,
        millimetres: f64,
    ) -> Result<Model, ReadError> {
        let mut issues = graph.notes.take();
        issues.append(&mut self.notes.take());
        let Frame { part: mut common, mut placed } = self.frames.swap_remove(0);
        let has_common = !is_empty(&common);
        let all = || std::iter::once(&common).chain(&self.parts);
        let nothing = !all().any(has_shape);
        if nothing {
            let worst = issues.iter().find(|issue| issue.is_error()).or(issues.first());
            let cause = all().find_map(first_failure).or(worst.cloned());
            return Err(ReadError::nothing(format, graph.nodes.len(), cause));
        }
        common.name = name.to_owned();
        if has_common {
            self.parts[0] = common;
        } else {
            self.parts.remove(0);
            placed.iter_mut().for_each(|p| p.part.0 -= 1);
        }
        let mut nodes = vec![plain_node(name, DAffine3::from_scale(DVec3::splat(millimetres)))];
        if placed.is_empty() {
            nodes[0].part = Some(PartId(0));
        } else {
            if has_common {
                nodes.push(Node { part: Some(PartId(0)), ..plain_node(name, DAffine3::IDENTITY) });
            }
            nodes.extend(placed.iter().map(|placed| Node {
                part: Some(placed.part),
                source: placed.source,
                ..plain_node(&placed.name, placed.transform)
            }));
            nodes[0].children = (1..nodes.len()).map(NodeId::from).collect();
        }
        Ok(Model {
            name: name.to_owned(),
            schema,
            unit: unit.to_owned(),
            parts: self.parts,
            nodes,
            roots: vec![NodeId(0)],
            issues,
        })
    }
}

fn plain_node(name: &str, transform: DAffine3) -> Node {
    Node {
        name: name.to_owned(),
        transform,
        part: None,
        children: Vec::new(),
        color: None,
        source: Source::default(),
    }
}

fn is_empty(part: &Part) -> bool {
    part.faces.is_empty() && part.tessellated.is_empty() && part.loose.is_empty()
}

/// True for parts with something to look at, if only a curve.
fn has_shape(part: &Part) -> bool {
    let faces = part.faces.iter().any(|face| matches!(face.geometry, FaceGeometry::Surface(_)));
    faces || !part.tessellated.is_empty() || !part.loose.is_empty() && part.faces.is_empty()
}

fn first_failure(part: &Part) -> Option<Issue> {
    part.faces.iter().find_map(|face| face.failure().cloned())
}

/// True where a transform turns shapes inside out.
pub(crate) fn mirrors(by: &DAffine3) -> bool {
    by.matrix3.determinant() < 0.0
}

/// The colour of sRGB components with a transparency.
pub(crate) fn color(rgb: [f64; 3], transparency: f64) -> Color {
    let [r, g, b] = rgb.map(crate::srgb::linear);
    Color([r, g, b, (1.0 - transparency).clamp(0.0, 1.0) as f32])
}

/// How often each node is used: by its parent, and by every USE.
pub(crate) fn uses(graph: &Graph) -> Vec<u32> {
    let mut uses = vec![0u32; graph.nodes.len()];
    let mut count = |ix: &NodeIx| uses[*ix as usize] += 1;
    graph.roots.iter().for_each(&mut count);
    for node in &graph.nodes {
        node.children.iter().for_each(&mut count);
        for (_, value) in &node.fields {
            if let super::graph::Value::Nodes(nodes) = value {
                nodes.iter().for_each(&mut count);
            }
        }
    }
    uses
}
