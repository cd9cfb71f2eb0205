//! The walk through groups and shapes.

use super::place::Place;
use super::{shapes, surfaces};
use crate::scene::context::Context;
use crate::scene::graph::{Graph, Node, NodeIx};
use crate::scene::matrix;
use crate::scene::stage::{self, Placed, Stage};
use chordal_brep::{Color, LooseKind, ReadIssue};
use chordal_nurbs::DAffine3;
use rustc_hash::FxHashMap;

/// Uses within uses deeper than this refer in a circle.
const MAX_DEPTH: u32 = 600;

/// Fills the stage with the shapes of a graph.
pub(super) fn walk(graph: &Graph, stage: &mut Stage) {
    let mut walk = Walk {
        context: Context::new(graph, stage),
        uses: stage::uses(graph),
        parts: FxHashMap::default(),
        active: vec![false; graph.nodes.len()],
        depth: 0,
    };
    let place = Place { transform: DAffine3::IDENTITY, color: None, name: "" };
    for &root in &graph.roots {
        walk.node(root, &place);
    }
}

/// A colour, and what a node consists of when it is used in it.
type Coloured = (Option<Color>, Vec<Placed>);

struct Walk<'a> {
    context: Context<'a>,
    uses: Vec<u32>,
    /// What nodes used more than once consist of, by the colour they were used in.
    parts: FxHashMap<NodeIx, Vec<Coloured>>,
    /// Nodes being visited: one that is used inside itself would never end.
    active: Vec<bool>,
    depth: u32,
}

/// Groups whose children are all shown.
const GROUPS: &[&str] = &[
    "Group",
    "Transform",
    "StaticGroup",
    "Anchor",
    "Billboard",
    "Collision",
    "CADAssembly",
    "CADPart",
    "CADFace",
    "CADLayer",
    "LayerSet",
    "Layer",
    "LayoutLayer",
    "LayoutGroup",
    "ScreenGroup",
    "PickableGroup",
    "EspduTransform",
    "NurbsGroup",
    "Viewport",
];

impl<'a> Walk<'a> {
    fn node(&mut self, ix: NodeIx, place: &Place<'_>) {
        let graph = self.context.graph;
        let node = graph.node(ix);
        if self.depth >= MAX_DEPTH || !self.context.stage.afford(0, node.source()) {
            return;
        }
        if std::mem::replace(&mut self.active[ix as usize], true) {
            return self
                .context
                .stage
                .notes
                .lose(node.source(), ReadIssue::UsedInItself { node: node.kind.clone() });
        }
        self.depth += 1;
        let name = if node.name.is_empty() { place.name } else { &node.name };
        let place = Place { name, ..*place };
        if self.uses[ix as usize] > 1 && is_shared(&node.kind) {
            self.used_often(ix, &place);
        } else {
            self.visit(ix, &place);
        }
        self.depth -= 1;
        self.active[ix as usize] = false;
    }

    /// A node that is used more than once becomes a part.
    fn used_often(&mut self, ix: NodeIx, place: &Place<'_>) {
        let source = self.context.graph.node(ix).source();
        let known = self.parts.get(&ix).and_then(|all| all.iter().find(|(color, _)| *color == place.color));
        let placed = match known {
            Some((_, placed)) => placed.clone(),
            None => {
                self.context.stage.open_part(place.name, source);
                self.visit(ix, &Place { transform: DAffine3::IDENTITY, ..*place });
                let placed = self.context.stage.close_part();
                self.parts.entry(ix).or_default().push((place.color, placed.clone()));
                placed
            }
        };
        self.context.stage.place(&placed, &place.transform, source);
    }

    fn visit(&mut self, ix: NodeIx, place: &Place<'_>) {
        let graph = self.context.graph;
        let node = graph.node(ix);
        match node.kind.as_str() {
            "Shape" => self.shape(ix, place),
            "Switch" => self.switch(node, place),
            "LOD" => {
                let levels = children(node, &["level", "children"]);
                if levels.len() > 1 {
                    self.context.note(node, ReadIssue::FirstLevelOnly);
                }
                levels.first().inspect(|&&level| self.node(level, place));
            }
            "Inline" => {
                let name = node.word("url").to_owned();
                self.context.stage.notes.lose(node.source(), ReadIssue::OtherFile { name });
            }
            kind if GROUPS.contains(&kind) => {
                let moves = matches!(kind, "Transform" | "CADPart" | "EspduTransform");
                let by = if moves {
                    matrix::of_transform(node, graph.radians.unwrap_or(1.0))
                } else {
                    DAffine3::IDENTITY
                };
                let place = Place { transform: place.transform * by, ..*place };
                for child in children(node, &["children", "layers", "shape"]) {
                    self.node(child, &place);
                }
            }
            "CoordinateDeformer" => {
                self.context
                    .stage
                    .notes
                    .lose(node.source(), ReadIssue::Unsupported { what: "CoordinateDeformer".into() });
            }
            "NurbsSet" => {}
            _ if self.geometry(ix, place) => {}
            kind if graph.prototypes.get(kind).is_some_and(|p| p.external) => {
                let issue = ReadIssue::OtherFile { name: String::new() };
                self.context.stage.notes.lose(node.source(), issue);
            }
            kind if !kind.is_empty() && !is_silent(kind) => self.context.note(node, ReadIssue::NotRead),
            _ => {}
        }
    }

    fn switch(&mut self, node: &Node, place: &Place<'_>) {
        let choices = children(node, &["choice", "children"]);
        let which = node.number("whichChoice", -1.0);
        if which >= 0.0 {
            choices.get(which as usize).inspect(|&&choice| self.node(choice, place));
        } else if !choices.is_empty() {
            self.context.note(node, ReadIssue::NoChoice);
        }
    }

    fn shape(&mut self, ix: NodeIx, place: &Place<'_>) {
        let graph = self.context.graph;
        let color = graph.child(ix, "appearance", &["Appearance"]).and_then(|look| appearance(graph, look));
        let place = Place { color: color.or(place.color), ..*place };
        let node = graph.node(ix);
        let geometry = node.nodes("geometry").first().copied().or_else(|| {
            let others = ["Appearance", "UnlitMaterial", "Material"];
            let mut all = node.children.iter().copied();
            all.find(|&child| {
                let kind = graph.node(child).kind.as_str();
                !others.contains(&kind) && !kind.starts_with("Metadata")
            })
        });
        if let Some(geometry) = geometry {
            self.node(geometry, &place);
        }
    }

    /// Reads the geometry of a shape; false where it is none.
    fn geometry(&mut self, ix: NodeIx, place: &Place<'_>) -> bool {
        let graph: &'a Graph = self.context.graph;
        let node = graph.node(ix);
        match node.kind.as_str() {
            "NurbsCurve" | "LineSet" | "IndexedLineSet" | "NurbsCurve2D" | "Polyline2D" | "Arc2D"
            | "Circle2D" => {
                self.context.stage.loose(LooseKind::Wire, place.name, node.source());
            }
            "PointSet" | "Polypoint2D" => {
                self.context.stage.loose(LooseKind::Point, place.name, node.source())
            }
            "Text" => self.context.note(node, ReadIssue::Unsupported { what: "text".into() }),
            _ => {
                return surfaces::read(&mut self.context, ix, place)
                    || shapes::read(&mut self.context, ix, place);
            }
        }
        true
    }
}

/// The nodes of these fields, and those that belong to none.
fn children(node: &Node, fields: &[&str]) -> Vec<NodeIx> {
    let named = fields.iter().flat_map(|field| node.nodes(field));
    named.chain(&node.children).copied().collect()
}

/// Nodes that may be placed several times as one part.
fn is_shared(kind: &str) -> bool {
    GROUPS.contains(&kind) || kind == "Shape" || surfaces::is_one(kind) || shapes::is_one(kind)
}

/// Nodes without a shape, which need no mention.
fn is_silent(kind: &str) -> bool {
    const KINDS: &[&str] = &[
        "Background",
        "Fog",
        "NavigationInfo",
        "Viewpoint",
        "OrthoViewpoint",
        "ViewpointGroup",
        "WorldInfo",
        "Script",
        "Sound",
        "AudioClip",
        "TextureBackground",
        "Coordinate",
        "CoordinateDouble",
        "Appearance",
        "Material",
        "Normal",
        "Color",
        "LocalFog",
        "ClipPlane",
        "TransformSensor",
        "GeoViewpoint",
    ];
    const ENDINGS: &[&str] = &[
        "Sensor",
        "Interpolator",
        "Light",
        "Follower",
        "Damper",
        "Chaser",
        "Trigger",
        "Filter",
        "Sequencer",
        "Toggle",
    ];
    KINDS.contains(&kind) || kind.starts_with("Metadata") || ENDINGS.iter().any(|end| kind.ends_with(end))
}

/// The colour of an appearance.
fn appearance(graph: &Graph, ix: NodeIx) -> Option<Color> {
    let kinds = ["Material", "PhysicalMaterial", "UnlitMaterial", "TwoSidedMaterial"];
    let material = graph.node(graph.child(ix, "material", &kinds)?);
    let field = match material.kind.as_str() {
        "PhysicalMaterial" => "baseColor",
        "UnlitMaterial" => "emissiveColor",
        _ => "diffuseColor",
    };
    match *material.numbers(field) {
        [r, g, b, ..] => Some(stage::color([r, g, b], material.number("transparency", 0.0))),
        _ => None,
    }
}
