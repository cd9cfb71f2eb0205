//! The walk through the graph, in the order in which Inventor renders it.

use super::state::{Shared, State};
use super::{shapes, surfaces};
use crate::scene::graph::{Graph, Node, NodeIx};
use crate::scene::matrix;
use crate::scene::stage::{self, Stage};
use crate::scene::walk::Language;
use chordal_brep::{LooseKind, ReadIssue};
use chordal_nurbs::{DAffine3, DVec3, math};

/// Fills the stage with the shapes of a graph.
pub(super) fn walk(graph: &Graph, stage: &mut Stage) {
    Walk::run(graph, stage, Shared::default());
}

/// Open Inventor and VRML 1: nodes change the state for the nodes after them.
pub(super) struct Inventor;

type Walk<'a> = crate::scene::walk::Walk<'a, Inventor>;

impl Language for Inventor {
    type Shared = Shared;

    fn may_be_part(kind: &str) -> bool {
        is_separator(kind) || is_shape(kind)
    }

    /// The part before what writers append to tell instances apart.
    fn readable(name: &str) -> &str {
        name.split('+').next().unwrap_or_default()
    }

    fn visit(walk: &mut Walk<'_>, ix: NodeIx, state: &mut State, name: &str) {
        let graph = walk.context.graph;
        let node = graph.node(ix);
        if shapes::read(&mut walk.context, node, state, name)
            || surfaces::read(&mut walk.context, ix, state, name)
        {
            return;
        }
        if let Some(by) = transform(node) {
            state.transform *= by;
            return;
        }
        match node.kind.as_str() {
            "Coordinate3" | "Coordinate4" | "Coordinate" => state.shared.coordinates = Some(ix),
            "VertexProperty" => state.shared.coordinates = Some(ix),
            "ProfileCoordinate2" | "ProfileCoordinate3" => state.shared.profile_coordinates = Some(ix),
            "NurbsProfile" | "LinearProfile" => surfaces::profile(node, ix, state),
            "Material" | "VrmlMaterial" | "BaseColor" | "PackedColor" => {
                state.shared.color = color(node).or(state.shared.color);
            }
            "ShapeHints" => match node.word("vertexOrdering") {
                "CLOCKWISE" => state.shared.clockwise = true,
                "COUNTERCLOCKWISE" | "UNKNOWN_ORDERING" => state.shared.clockwise = false,
                _ => {}
            },
            "Units" => {
                let metres = metres(node.word("units"));
                state.transform *= DAffine3::from_scale(DVec3::splat(metres / state.shared.metres));
                state.shared.metres = metres;
            }
            "ResetTransform" => state.transform = DAffine3::IDENTITY,
            "Switch" => switch(walk, node, state, name),
            "LOD" | "LevelOfDetail" => {
                if node.children.len() > 1 {
                    walk.context.note(node, ReadIssue::FirstLevelOnly);
                }
                let mut inner = state.clone();
                node.children.first().inspect(|&&child| walk.node(child, &mut inner, name));
            }
            "Array" | "MultipleCopy" => copies(walk, node, state, name),
            "TransformSeparator" => {
                let before = state.transform;
                children(walk, node, state, name);
                state.transform = before;
            }
            "WWWInline" | "File" => {
                let name = node.word("name").to_owned();
                walk.context.stage.notes.lose(node.source(), ReadIssue::OtherFile { name });
            }
            kind if is_separator(kind) => {
                let mut inner = state.clone();
                children(walk, node, &mut inner, name);
            }
            kind if is_loose_curve(kind) => walk.context.stage.loose(LooseKind::Wire, name, node.source()),
            "PointSet" | "IndexedPointSet" | "MarkerSet" | "IndexedMarkerSet" => {
                walk.context.stage.loose(LooseKind::Point, name, node.source());
            }
            "Text2" | "Text3" | "AsciiText" => {
                walk.context.note(node, ReadIssue::Unsupported { what: "text".into() })
            }
            _ => children(walk, node, state, name),
        }
    }
}

/// Visits the unnamed children in order.
fn children(walk: &mut Walk<'_>, node: &Node, state: &mut State, name: &str) {
    for &child in &node.children {
        walk.node(child, state, name);
    }
}

fn switch(walk: &mut Walk<'_>, node: &Node, state: &mut State, name: &str) {
    match node.number("whichChild", -1.0) {
        which if which >= 0.0 => {
            if let Some(&child) = node.children.get(which as usize) {
                walk.node(child, state, name);
            }
        }
        -3.0 => children(walk, node, state, name),
        _ if node.children.is_empty() => {}
        _ => walk.context.note(node, ReadIssue::NoChoice),
    }
}

/// Children drawn several times: at the points of a grid, or by a list of matrices.
fn copies(walk: &mut Walk<'_>, node: &Node, state: &State, name: &str) {
    let places = if node.kind == "MultipleCopy" {
        node.numbers("matrix").chunks_exact(16).map(matrix::of_rows).collect()
    } else {
        match grid(node) {
            Some(places) => places,
            None => {
                return walk
                    .context
                    .stage
                    .notes
                    .lose(node.source(), ReadIssue::TooMany { what: "copies in an array", limit: 100_000 });
            }
        }
    };
    for place in places {
        let mut inner = State { transform: state.transform * place, shared: state.shared.clone() };
        children(walk, node, &mut inner, name);
    }
}

/// The most copies that an array makes.
const MOST_COPIES: f64 = 1e5;

/// The places of an Array node.
fn grid(node: &Node) -> Option<Vec<DAffine3>> {
    let count = |i: usize| node.number(&format!("numElements{i}"), 1.0).max(1.0).floor();
    let [a, b, c] = [1, 2, 3].map(count);
    if !(a * b * c <= MOST_COPIES) {
        return None;
    }
    let step = |i: usize| DVec3::from(node.vector(&format!("separation{i}"), [1.0, 0.0, 0.0]));
    let back = match node.word("origin") {
        "CENTER" => 0.5,
        "LAST" => 1.0,
        _ => 0.0,
    };
    let mut places = Vec::new();
    for k in 0..c as u32 {
        for j in 0..b as u32 {
            for i in 0..a as u32 {
                let at = |i: u32, count: f64| f64::from(i) - back * (count - 1.0);
                let by = step(1) * at(i, a) + step(2) * at(j, b) + step(3) * at(k, c);
                places.push(DAffine3::from_translation(by));
            }
        }
    }
    Some(places)
}

/// What a transformation node does; `None` for other nodes.
fn transform(node: &Node) -> Option<DAffine3> {
    let vector = |name, default| DVec3::from(node.vector(name, [default; 3]));
    Some(match node.kind.as_str() {
        "Transform" | "TransformManip" | "CenterballManip" | "HandleBoxManip" | "JackManip"
        | "TabBoxManip" | "TrackballManip" | "TransformBoxManip" | "TransformerManip" => {
            matrix::of_transform(node, 1.0)
        }
        "MatrixTransform" => matrix::of_rows(&node.numbers("matrix")),
        "Translation" => DAffine3::from_translation(vector("translation", 0.0)),
        "Scale" => DAffine3::from_scale(vector("scaleFactor", 1.0)),
        "Rotation" | "Rotor" | "Pendulum" => DAffine3::from_quat(matrix::rotation(node, "rotation", 1.0)),
        "RotationXYZ" => {
            let angle = node.number("angle", 0.0);
            let axis = match node.word("axis") {
                "Y" => DVec3::Y,
                "Z" => DVec3::Z,
                _ => DVec3::X,
            };
            DAffine3::from_quat(math::rotation(axis, angle))
        }
        _ => return None,
    })
}

/// Nodes that keep what their children change to themselves.
fn is_separator(kind: &str) -> bool {
    matches!(
        kind,
        "Separator"
            | "Annotation"
            | "Selection"
            | "WWWAnchor"
            | "TransformerManip"
            | "LocateHighlight"
            | "Root"
    )
}

fn is_shape(kind: &str) -> bool {
    shapes::is_one(kind) || matches!(kind, "NurbsSurface" | "IndexedNurbsSurface")
}

fn is_loose_curve(kind: &str) -> bool {
    matches!(kind, "NurbsCurve" | "IndexedNurbsCurve" | "LineSet" | "IndexedLineSet")
}

/// The first colour of a material.
fn color(node: &Node) -> Option<chordal_brep::Color> {
    if node.kind == "PackedColor" {
        let packed = *node.numbers("orderedRGBA").first()? as i64 as u32;
        let [r, g, b, a] = packed.to_be_bytes().map(|byte| f64::from(byte) / 255.0);
        return Some(stage::color([r, g, b], 1.0 - a));
    }
    let field = if node.kind == "BaseColor" { "rgb" } else { "diffuseColor" };
    match *node.numbers(field) {
        [r, g, b, ..] => Some(stage::color([r, g, b], node.number("transparency", 0.0))),
        _ => None,
    }
}

/// Metres of a unit of the Units node.
fn metres(unit: &str) -> f64 {
    match unit {
        "CENTIMETERS" => 0.01,
        "MILLIMETERS" => 0.001,
        "MICROMETERS" | "MICRONS" => 1e-6,
        "NANOMETERS" => 1e-9,
        "ANGSTROMS" => 1e-10,
        "KILOMETERS" => 1000.0,
        "FEET" => 0.3048,
        "INCHES" => 0.0254,
        "POINTS" => 0.0254 / 72.0,
        "YARDS" => 0.9144,
        "MILES" => 1609.344,
        "NAUTICAL_MILES" => 1852.0,
        _ => 1.0,
    }
}
