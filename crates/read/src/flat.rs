//! Models of formats that know neither parts nor a tree: one part, placed once.

use chordal_brep::{Issue, Model, Node, NodeId, Part, PartId, Source};
use chordal_nurbs::{DAffine3, DVec3};

/// The unit that a file's coordinates are in.
#[derive(Clone, Debug)]
pub(crate) struct LengthUnit {
    pub name: String,
    pub millimetres: f64,
}

impl LengthUnit {
    /// What formats that state no unit are taken to mean.
    pub(crate) fn unstated() -> Self {
        Self { name: "mm".into(), millimetres: 1.0 }
    }
}

/// The model of one part.
pub(crate) fn model(
    name: &str,
    schema: String,
    unit: LengthUnit,
    mut part: Part,
    issues: Vec<Issue>,
) -> Model {
    if part.name.is_empty() {
        name.clone_into(&mut part.name);
    }
    let root = Node {
        name: part.name.clone(),
        transform: DAffine3::from_scale(DVec3::splat(unit.millimetres)),
        part: Some(PartId(0)),
        children: Vec::new(),
        color: None,
        source: Source::default(),
    };
    Model {
        name: name.to_owned(),
        schema,
        unit: unit.name,
        parts: vec![part],
        nodes: vec![root],
        roots: vec![NodeId(0)],
        issues,
    }
}
