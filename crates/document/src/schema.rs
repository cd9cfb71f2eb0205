//! Model, parts and tree as the file states them; `docs/model-json.md` describes every field.

use crate::geometry::{Curve, Curve2, P3, Surface};
use crate::real::Real;
use serde::{Deserialize, Serialize};

/// `[entity, line]` in the file that the model was read from; absent where it is unknown.
pub(crate) type Source = (u64, u32);

/// Linear RGB with opacity.
pub(crate) type Color = [f32; 4];

fn nowhere(source: &Source) -> bool {
    *source == (0, 0)
}
fn no(flag: &bool) -> bool {
    !flag
}
fn yes() -> bool {
    true
}
fn is_yes(flag: &bool) -> bool {
    *flag
}

#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Document {
    pub schema: String,
    #[serde(default)]
    pub name: String,
    #[serde(default)]
    pub format: String,
    #[serde(default)]
    pub unit: String,
    pub parts: Vec<Part>,
    pub nodes: Vec<Node>,
    pub roots: Vec<u32>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<Warning>,
}

#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Node {
    #[serde(default)]
    pub name: String,
    /// The images of the x, y and z axes, then of the origin.
    pub transform: [P3; 4],
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub part: Option<u32>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub children: Vec<u32>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub color: Option<Color>,
    #[serde(default, skip_serializing_if = "nowhere")]
    pub source: Source,
}

#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Warning {
    /// The code of the issue; older documents have none.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub code: String,
    pub message: String,
    #[serde(default, skip_serializing_if = "no")]
    pub lost: bool,
    #[serde(default, skip_serializing_if = "nowhere")]
    pub source: Source,
}

/// Why a face has no surface.
#[derive(Debug, Serialize, Deserialize)]
#[serde(untagged)]
pub(crate) enum Failure {
    Issue(Warning),
    /// A sentence, in older documents.
    Sentence(String),
}

#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Part {
    #[serde(default)]
    pub name: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub color: Option<Color>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub uncertainty: Option<Real>,
    #[serde(default, skip_serializing_if = "nowhere")]
    pub source: Source,
    #[serde(default)]
    pub surfaces: Vec<Surface>,
    #[serde(default)]
    pub vertices: Vec<Vertex>,
    #[serde(default)]
    pub edges: Vec<Edge>,
    #[serde(default)]
    pub faces: Vec<Face>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub shells: Vec<Shell>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bodies: Vec<Body>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub loose: Vec<LooseItem>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub tessellated: Vec<TessellatedItem>,
}

#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Vertex {
    pub point: P3,
    #[serde(default, skip_serializing_if = "nowhere")]
    pub source: Source,
}

#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Edge {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub curve: Option<Curve>,
    pub range: [Real; 2],
    pub start: u32,
    pub end: u32,
    #[serde(default, skip_serializing_if = "nowhere")]
    pub source: Source,
}

#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Pcurve {
    pub curve: Curve2,
    pub range: [Real; 2],
}

#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Coedge {
    pub edge: u32,
    pub forward: bool,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub pcurves: Vec<Pcurve>,
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Loop {
    Edges {
        coedges: Vec<Coedge>,
        #[serde(default)]
        outer: bool,
    },
    Vertex(u32),
    Polygon {
        vertices: Vec<u32>,
        #[serde(default)]
        outer: bool,
    },
}

#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Face {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub surface: Option<usize>,
    /// Why there is no surface.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub failed: Option<Failure>,
    #[serde(default = "yes", skip_serializing_if = "is_yes")]
    pub same_sense: bool,
    #[serde(default, skip_serializing_if = "no")]
    pub flipped: bool,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub loops: Vec<Loop>,
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub color: Option<Color>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub layer: Option<String>,
    #[serde(default, skip_serializing_if = "nowhere")]
    pub source: Source,
}

#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Shell {
    pub faces: Vec<u32>,
    #[serde(default)]
    pub closed: bool,
    #[serde(default, skip_serializing_if = "nowhere")]
    pub source: Source,
}

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum BodyKind {
    Solid,
    Sheet,
    FaceSet,
}

#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Body {
    pub kind: BodyKind,
    pub shells: Vec<u32>,
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub color: Option<Color>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub layer: Option<String>,
    #[serde(default, skip_serializing_if = "nowhere")]
    pub source: Source,
}

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum LooseKind {
    Wire,
    Point,
}

#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct LooseItem {
    pub kind: LooseKind,
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    #[serde(default, skip_serializing_if = "nowhere")]
    pub source: Source,
}

#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct TessellatedItem {
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    pub points: Vec<P3>,
    pub triangles: Vec<[u32; 3]>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub normals: Vec<P3>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub color: Option<Color>,
    #[serde(default, skip_serializing_if = "nowhere")]
    pub source: Source,
}
