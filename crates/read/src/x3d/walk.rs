//! The walk through groups and shapes.

use super::place::Place;
use super::{shapes, surfaces};
use crate::scene::graph::{Graph, Node, NodeIx};
use crate::scene::matrix;
use crate::scene::stage::{self, Stage};
use crate::scene::walk::{Language, State};
use chordal_brep::{Color, LooseKind, ReadIssue};
use chordal_nurbs::DAffine3;

/// Fills the stage with the shapes of a graph.
pub(super) fn walk(graph: &Graph, stage: &mut Stage) {
    Walk::run(graph, stage, None);
}

/// VRML97 and X3D: a node inherits its place and the colour of its shape.
pub(super) struct X3d;

type Walk<'a> = crate::scene::walk::Walk<'a, X3d>;

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

impl Language for X3d {
    type Shared = Option<Color>;

    fn may_be_part(kind: &str) -> bool {
        GROUPS.contains(&kind) || kind == "Shape" || surfaces::is_one(kind) || shapes::is_one(kind)
    }

    fn visit(walk: &mut Walk<'_>, ix: NodeIx, state: &mut State<Option<Color>>, name: &str) {
        let place = &Place { transform: state.transform, color: state.shared, name };
        let graph = walk.context.graph;
        let node = graph.node(ix);
        match node.kind.as_str() {
            "Shape" => shape(walk, ix, place),
            "Switch" => switch(walk, node, place),
            "LOD" => {
                let levels = children(node, &["level", "children"]);
                if levels.len() > 1 {
                    walk.context.note(node, ReadIssue::FirstLevelOnly);
                }
                levels.first().inspect(|&&level| walk.node(level, &mut place.state(), place.name));
            }
            "Inline" => {
                let name = node.word("url").to_owned();
                walk.context.stage.notes.lose(node.source(), ReadIssue::OtherFile { name });
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
                    walk.node(child, &mut place.state(), place.name);
                }
            }
            "CoordinateDeformer" => {
                walk.context
                    .stage
                    .notes
                    .lose(node.source(), ReadIssue::Unsupported { what: "CoordinateDeformer".into() });
            }
            "NurbsSet" => {}
            _ if geometry(walk, ix, place) => {}
            kind if graph.prototypes.get(kind).is_some_and(|p| p.external) => {
                let issue = ReadIssue::OtherFile { name: String::new() };
                walk.context.stage.notes.lose(node.source(), issue);
            }
            kind if !kind.is_empty() && !is_silent(kind) => walk.context.note(node, ReadIssue::NotRead),
            _ => {}
        }
    }
}

fn switch(walk: &mut Walk<'_>, node: &Node, place: &Place<'_>) {
    let choices = children(node, &["choice", "children"]);
    let which = node.number("whichChoice", -1.0);
    if which >= 0.0 {
        choices.get(which as usize).inspect(|&&choice| walk.node(choice, &mut place.state(), place.name));
    } else if !choices.is_empty() {
        walk.context.note(node, ReadIssue::NoChoice);
    }
}

fn shape(walk: &mut Walk<'_>, ix: NodeIx, place: &Place<'_>) {
    let graph = walk.context.graph;
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
        walk.node(geometry, &mut place.state(), place.name);
    }
}

/// Reads the geometry of a shape; false where it is none.
fn geometry(walk: &mut Walk<'_>, ix: NodeIx, place: &Place<'_>) -> bool {
    let graph = walk.context.graph;
    let node = graph.node(ix);
    match node.kind.as_str() {
        "NurbsCurve" | "LineSet" | "IndexedLineSet" | "NurbsCurve2D" | "Polyline2D" | "Arc2D"
        | "Circle2D" => {
            walk.context.stage.loose(LooseKind::Wire, place.name, node.source());
        }
        "PointSet" | "Polypoint2D" => walk.context.stage.loose(LooseKind::Point, place.name, node.source()),
        "Text" => walk.context.note(node, ReadIssue::Unsupported { what: "text".into() }),
        _ => {
            return surfaces::read(&mut walk.context, ix, place)
                || shapes::read(&mut walk.context, ix, place);
        }
    }
    true
}

/// The nodes of these fields, and those that belong to none.
fn children(node: &Node, fields: &[&str]) -> Vec<NodeIx> {
    let named = fields.iter().flat_map(|field| node.nodes(field));
    named.chain(&node.children).copied().collect()
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
