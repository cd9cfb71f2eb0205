//! How far a mesh, whoever made it, lies from a CAD model: measured at samples, and enclosed, in both
//! directions.
//!
//! The model is meshed finely; vertices of that mesh lie on the exact surfaces, and its triangles within its
//! proven error of them. Model → mesh: from these vertices to the nearest triangle of the mesh. Mesh → model:
//! from samples of the mesh to the exact surface near the closest fine triangle ([`reference`]), so that the
//! error of the fine mesh is not taken for one of the mesh. Both ways, the distance is also given without what
//! the edges of the file lie off its surfaces: no mesh can be nearer to both. Where every face is proven, branch and bound
//! between the two meshes also gives distances that no point can exceed; these contain the error of the fine
//! mesh and what the file is loose by.

mod reference;

use crate::error::Error;
use crate::meshed_part::{MeshedPart, mesh_parts};
use crate::model::Model;
use crate::options::MeshOptions;
use crate::resolve::{Resolved, resolve};
use chordal_audit::{TriangleTree, largest_distance};
use chordal_mesh::TriangleSoup;
use chordal_tessellate::Cancel;
use glam::DVec3;
use rayon::prelude::*;
use reference::{Farthest, PlacedFace, Reference};
use serde::Serialize;
use std::path::Path;

/// Samples of the mesh, about.
const SAMPLES: f64 = 200_000.0;
/// Faces that are listed.
const WORST: usize = 10;

/// What was measured, in millimetres.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct AgainstReport {
    /// The path of the CAD file.
    pub model: String,
    /// "branch and bound": the distances lie between those measured at samples and `…_at_most`; "measured":
    /// largest distances over samples, which are lower bounds.
    pub method: String,
    /// Largest distance of a sample of the mesh from the model's exact faces.
    pub mesh_to_model: f64,
    /// The same beyond the gap between edges and surfaces that the file has at each sample.
    pub mesh_to_model_beyond_gap: f64,
    /// Largest distance of a sample of the model's exact faces, or of their edges, from the mesh.
    pub model_to_mesh: f64,
    /// The same beyond that gap.
    pub model_to_mesh_beyond_gap: f64,
    /// No point of the mesh is farther from the model; `null` where a face of the model has no proof.
    pub mesh_to_model_at_most: Option<f64>,
    /// No point of the model's exact faces is farther from the mesh; `null` where one of them has no proof.
    pub model_to_mesh_at_most: Option<f64>,
    /// Proven error of the fine mesh that stands for the model; `null` where one of its faces has no proof.
    pub reference_error: Option<f64>,
    /// How many points of the mesh were measured.
    pub mesh_samples: usize,
    /// How many points of the model were measured.
    pub model_samples: usize,
    /// Faces of the model that could not be meshed finely, and so were not compared.
    pub faces_not_compared: usize,
    /// The faces that are farthest from the mesh, the farthest first.
    pub worst_faces: Vec<WorstFace>,
}

/// One placed face.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct WorstFace {
    /// The entity in the file, `#123`.
    pub id: String,
    /// The kind of its surface.
    pub kind: String,
    /// The name of its part.
    pub part: String,
    /// Its largest measured distance from the mesh, in millimetres.
    pub distance: f64,
    /// The same beyond the gap of the face.
    pub beyond_gap: f64,
}

/// Measures the distance between `soup`, in millimetres and Z up, and the model in the file `input`;
/// `options` are those of the fine mesh.
///
/// # Errors
/// Where the model cannot be read or meshed.
pub fn measure_against(
    soup: &TriangleSoup,
    input: &Path,
    options: &MeshOptions,
) -> Result<AgainstReport, Error> {
    let cancel = Cancel::default();
    let opened = Model::open(input)?;
    let model = opened.brep();
    let resolved =
        resolve(model, options, opened.byte_count(), &cancel).map_err(|error| error.named(opened.name()))?;
    let (parts, _) = mesh_parts(model, &resolved, &cancel, &|_| ());
    let mesh_triangles: Vec<[DVec3; 3]> =
        soup.triangles.iter().map(|t| t.map(|i| soup.positions[i as usize])).collect();
    let mesh = TriangleTree::new(mesh_triangles.clone());
    let reference = Reference::new(model, &resolved, &parts);

    let samples = mesh_samples(soup);
    let mesh_to_model = reference.farthest(&samples);
    let measured: Vec<(Farthest, usize)> =
        reference.faces.par_iter().map(|face| face.distance_from(&mesh)).collect();
    let model_samples = measured.iter().map(|of_face| of_face.1).sum();
    let model_to_mesh = measured.iter().fold(Farthest::default(), |all, of_face| all.larger(of_face.0));
    let mut faces: Vec<WorstFace> =
        reference.faces.iter().zip(&measured).map(|(face, of_face)| worst_face(face, of_face.0)).collect();
    faces.sort_by(|a, b| b.beyond_gap.total_cmp(&a.beyond_gap));
    let faces_not_compared = model.placed_faces() - faces.len();
    // How far the fine mesh may be from the model, with what the file is loose by.
    let apart = reference_distance(&resolved, &parts).filter(|_| faces_not_compared == 0);
    let at_most = |from: &[[DVec3; 3]], to: &TriangleTree, seen: f64, apart: f64| {
        largest_distance(from, to, (0.1 * apart).max(1e-3 * seen)).at_most + apart
    };
    Ok(AgainstReport {
        model: input.display().to_string(),
        method: if apart.is_some() { "branch and bound" } else { "measured" }.into(),
        mesh_to_model: mesh_to_model.distance,
        mesh_to_model_beyond_gap: mesh_to_model.beyond_gap,
        model_to_mesh: model_to_mesh.distance,
        model_to_mesh_beyond_gap: model_to_mesh.beyond_gap,
        mesh_to_model_at_most: apart
            .map(|apart| at_most(&mesh_triangles, &reference.tree, mesh_to_model.beyond_gap, apart)),
        model_to_mesh_at_most: apart
            .map(|apart| at_most(&reference.triangles, &mesh, model_to_mesh.beyond_gap, apart)),
        reference_error: reference_error(&resolved, &parts),
        mesh_samples: samples.len(),
        model_samples,
        faces_not_compared,
        worst_faces: faces.into_iter().take(WORST).collect(),
    })
}

/// Vertices, and points inside triangles as densely as the number of samples allows.
fn mesh_samples(soup: &TriangleSoup) -> Vec<DVec3> {
    let corners = |t: &[u32; 3]| t.map(|i| soup.positions[i as usize]);
    let area = |[a, b, c]: [DVec3; 3]| 0.5 * (b - a).cross(c - a).length();
    let total: f64 = soup.triangles.iter().map(|t| area(corners(t))).sum();
    let mut samples = soup.positions.clone();
    for triangle in &soup.triangles {
        let [a, b, c] = corners(triangle);
        // A lattice of n + 1 points a side has (n + 1)(n + 2) / 2 points.
        let wanted = SAMPLES * area([a, b, c]) / total.max(f64::MIN_POSITIVE);
        let n = ((2.0 * wanted).sqrt().ceil() as usize).clamp(2, 1000);
        for i in 0..=n {
            for j in 0..=n - i {
                samples.push(a + (b - a) * (i as f64 / n as f64) + (c - a) * (j as f64 / n as f64));
            }
        }
    }
    samples
}

fn worst_face(face: &PlacedFace<'_>, from_mesh: Farthest) -> WorstFace {
    let Farthest { distance, beyond_gap } = from_mesh;
    WorstFace { id: face.id(), kind: face.kind(), part: face.part.name.clone(), distance, beyond_gap }
}

/// The largest distance of the fine mesh from the exact faces, and the other way round: proven error and gap.
fn reference_distance(resolved: &Resolved, parts: &[MeshedPart]) -> Option<f64> {
    let faces = parts.iter().zip(&resolved.uses).flat_map(|(part, part_use)| {
        let meshed = part.report.faces.iter().filter(|f| f.triangles > 0);
        meshed.map(|f| (f.proven_error + f.gap) * part_use.scale)
    });
    faces.map(|e| e.is_finite().then_some(e)).try_fold(0.0, |largest, e| Some(f64::max(largest, e?)))
}

fn reference_error(resolved: &Resolved, parts: &[MeshedPart]) -> Option<f64> {
    let faces = parts.iter().zip(&resolved.uses).flat_map(|(part, part_use)| {
        let meshed = part.report.faces.iter().filter(|f| f.triangles > 0);
        meshed.map(|f| f.proven_error * part_use.scale)
    });
    faces.map(|e| e.is_finite().then_some(e)).try_fold(0.0, |largest, e| Some(f64::max(largest, e?)))
}
