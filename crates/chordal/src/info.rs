//! What is in a CAD file, before anything is meshed.

use crate::account::{loose, model_problems};
use crate::gaps::{Gap, gaps};
use crate::names::face_kind;
use crate::options::MeshOptions;
use crate::placement::{PartUse, part_uses};
use crate::report::{GapSurvey, LooseEntry, Problem, entity_name};
use crate::tight_box::{edge_box, tight_box_within};
use crate::work_limits::FileLimits;
use chordal_brep::{BodyKind, Model, NodeId, Part};
use chordal_sew::{gap_survey, has_topology, open_edges};
use chordal_tessellate::Cancel;
use rayon::prelude::*;
use serde::Serialize;
use std::collections::BTreeMap;

/// The name and version of the schema of [`Info`].
pub const INFO_SCHEMA: &str = "chordal-info/2";

/// What is in a file. Lengths are millimetres; counts of the whole are as placed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Info {
    /// [`INFO_SCHEMA`].
    pub schema: &'static str,
    /// Its name.
    pub name: String,
    /// Format and version as the file states them.
    pub format: String,
    /// The file's unit of length.
    pub unit: String,
    /// The tight axis-aligned box: its lowest and its highest corner; `null` where nothing is placed.
    pub r#box: Option<[[f64; 3]; 2]>,
    /// The diagonal of the box.
    pub diagonal: f64,
    /// As placed.
    pub faces: usize,
    /// As placed.
    pub faces_by_kind: BTreeMap<&'static str, usize>,
    /// Faces that could not be read, as placed; `problems` says why.
    pub failed_faces: usize,
    /// The largest gaps of all parts.
    pub max_gap: GapInfo,
    /// Every part of the file.
    pub parts: Vec<PartInfo>,
    /// The assembly, from its roots.
    pub tree: Vec<NodeInfo>,
    /// Curves and points that belong to no face.
    pub loose: Vec<LooseEntry>,
    /// What the reader repaired, guessed or dropped, and the faces that it could not read.
    pub problems: Vec<Problem>,
}

/// The largest gaps, each with the entity it was found at; measured at samples.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct GapInfo {
    /// Between a vertex and the end of an edge's curve.
    pub vertex_to_curve: f64,
    /// The edge.
    pub vertex_to_curve_at: Option<String>,
    /// Between an edge's curve and the surface of a face that it bounds.
    pub curve_to_surface: f64,
    /// The edge.
    pub curve_to_surface_at: Option<String>,
}

/// One part.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PartInfo {
    /// Its name.
    pub name: String,
    /// The entity in the file, `#123`.
    pub entity: Option<String>,
    /// How often it is placed.
    pub instances: usize,
    /// Solid bodies.
    pub solids: usize,
    /// Sheet bodies.
    pub sheets: usize,
    /// Groups of faces without a shell.
    pub face_sets: usize,
    /// All shells.
    pub shells: usize,
    /// Those that the file declares closed.
    pub closed_shells: usize,
    /// Its faces.
    pub faces: usize,
    /// Its edges.
    pub edges: usize,
    /// Its vertices.
    pub vertices: usize,
    /// Triangles that are in the file already.
    pub tessellated_triangles: usize,
    /// The file's own statement of accuracy, in millimetres.
    pub uncertainty: Option<f64>,
    /// Its largest gaps.
    pub gaps: GapInfo,
    /// Edges that one face alone uses.
    pub open_edges: usize,
    /// Some edge is shared by two faces: the file has topology, and is sewn only on request.
    pub topology: bool,
    /// How far the open edges are from each other, and the tolerance that `--sew auto` takes; millimetres.
    pub sewing: Option<GapSurvey>,
}

/// One occurrence in the assembly tree.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NodeInfo {
    /// Its name.
    pub name: String,
    /// Index into `parts`.
    pub part: Option<usize>,
    /// What is below it.
    pub children: Vec<NodeInfo>,
}

/// Looks at everything in a model.
pub(crate) fn info(model: &Model) -> Info {
    let uses = part_uses(model);
    let limits = FileLimits::new(MeshOptions::default().limits(), model, &uses, 0, 1.0);
    let whole = tight_box_within(model, &uses, edge_box(model, &uses), &limits, &Cancel::default());
    let parts: Vec<PartInfo> =
        model.parts.par_iter().zip(&uses).map(|(part, part_use)| part_info(part, part_use)).collect();
    let mut faces_by_kind = BTreeMap::new();
    for (part, part_use) in model.parts.iter().zip(&uses) {
        for face in &part.faces {
            *faces_by_kind.entry(face_kind(face)).or_insert(0) += part_use.instances;
        }
    }
    Info {
        schema: INFO_SCHEMA,
        name: model.name.clone(),
        format: model.schema.clone(),
        unit: model.unit.clone(),
        r#box: (!whole.is_empty()).then(|| [whole.min.to_array(), whole.max.to_array()]),
        diagonal: whole.diagonal(),
        faces: model.placed_faces(),
        failed_faces: faces_by_kind.get("unknown").copied().unwrap_or(0),
        faces_by_kind,
        max_gap: largest(&parts),
        parts,
        tree: model.roots.iter().map(|&root| node_info(model, root)).collect(),
        loose: loose(model),
        problems: model_problems(model),
    }
}

fn part_info(part: &Part, part_use: &PartUse) -> PartInfo {
    let bodies = |kind: BodyKind| part.bodies.iter().filter(|b| b.kind == kind).count();
    let gaps = gaps(part);
    let length = |gap: Gap| gap.distance * part_use.scale;
    PartInfo {
        name: part.name.clone(),
        entity: entity_name(part.source),
        instances: part_use.instances,
        solids: bodies(BodyKind::Solid),
        sheets: bodies(BodyKind::Sheet),
        face_sets: bodies(BodyKind::FaceSet),
        shells: part.shells.len(),
        closed_shells: part.shells.iter().filter(|s| s.closed).count(),
        faces: part.faces.len(),
        edges: part.edges.len(),
        vertices: part.vertices.len(),
        tessellated_triangles: part.tessellated.iter().map(|t| t.triangles.len()).sum(),
        uncertainty: part.uncertainty.map(|length| length * part_use.scale),
        gaps: GapInfo {
            vertex_to_curve: length(gaps.vertex_to_curve),
            vertex_to_curve_at: entity_name(gaps.vertex_to_curve.source),
            curve_to_surface: length(gaps.curve_to_surface),
            curve_to_surface_at: entity_name(gaps.curve_to_surface.source),
        },
        open_edges: open_edges(part),
        topology: has_topology(part),
        sewing: gap_survey(part).map(|survey| GapSurvey::new(&survey, part_use.scale)),
    }
}

fn largest(parts: &[PartInfo]) -> GapInfo {
    let mut found = GapInfo::default();
    for gaps in parts.iter().filter(|p| p.instances > 0).map(|p| &p.gaps) {
        if gaps.vertex_to_curve > found.vertex_to_curve {
            found.vertex_to_curve = gaps.vertex_to_curve;
            found.vertex_to_curve_at.clone_from(&gaps.vertex_to_curve_at);
        }
        if gaps.curve_to_surface > found.curve_to_surface {
            found.curve_to_surface = gaps.curve_to_surface;
            found.curve_to_surface_at.clone_from(&gaps.curve_to_surface_at);
        }
    }
    found
}

/// A tree of ordinary depth; readers refuse cycles.
fn node_info(model: &Model, id: NodeId) -> NodeInfo {
    let node = &model.nodes[id.index()];
    NodeInfo {
        name: node.name.clone(),
        part: node.part.map(|p| p.index()),
        children: node.children.iter().map(|&child| node_info(model, child)).collect(),
    }
}
