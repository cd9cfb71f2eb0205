//! The same model by several strategies, side by side.

mod measure;
mod plot;

use crate::error::Error;
use crate::meshed_part::{MeshedPart, mesh_parts};
use crate::model::Model;
use crate::options::MeshOptions;
use crate::report::StageEntry;
use crate::resolve::{Resolved, resolve};
use chordal_methods::StrategyEntry;
use chordal_tessellate::{Bound, Cancel, Stopwatch};
use serde::Serialize;

pub use plot::plot;

/// The name and version of the schema of [`Comparison`].
pub const COMPARE_SCHEMA: &str = "chordal-compare/1";

/// All strategies on one model; lengths in millimetres.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Comparison {
    /// [`COMPARE_SCHEMA`].
    pub schema: String,
    /// The name of the model.
    pub model: String,
    /// The tolerance.
    pub tolerance: f64,
    /// In degrees; `null`: no limit.
    pub angle: Option<f64>,
    /// Faces, as placed.
    pub faces: usize,
    /// How edges became polylines.
    pub edge_method: String,
    /// One row per strategy and bound.
    pub rows: Vec<ComparedRow>,
}

/// One strategy with one kind of bound.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ComparedRow {
    /// The name of the strategy.
    pub strategy: String,
    /// "proven" or "estimated".
    pub bound: String,
    /// As placed.
    pub triangles: usize,
    /// Chords of the model's edges, as placed.
    pub edges: usize,
    /// CPU time of all threads, from the exact model to the mesh; wall time where the system does not tell.
    pub seconds: f64,
    /// Largest proven error; `null` where a face has no proof.
    pub proven_error: Option<f64>,
    /// Largest distance of the surfaces from the mesh over samples of all triangles, looseness of the file included.
    pub measured_error: f64,
    /// Triangles over the fewest that the tolerance allows (docs/report.md).
    pub ratio: f64,
    /// Faces that failed, as placed.
    pub failed_faces: usize,
    /// Rounds in which faces asked for finer edges, the most of any part.
    pub rounds: usize,
    /// Which parts of the tessellator ran.
    pub stages: Vec<StageEntry>,
    /// Time of the phases, for strategies by cells.
    pub phases: PhaseSeconds,
}

/// Seconds of the phases of a strategy by cells, in the last attempt at each face, summed over faces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct PhaseSeconds {
    /// Splines to the pieces that the strategy begins with.
    pub conversion: f64,
    /// Subdividing.
    pub subdivision: f64,
    /// Following trimming curves over cells.
    pub traversal: f64,
    /// Trimming and triangulation.
    pub triangulation: f64,
}

/// Meshes the model once for every strategy and bound. The lower bound is that of the first row: it is a
/// property of the model, but for rounding.
///
/// # Errors
/// Where the model cannot be read or the options make no sense for it.
pub fn compare(
    model: &Model,
    options: &MeshOptions,
    strategies: &[&StrategyEntry],
    bounds: &[Bound],
    cancel: &Cancel,
    tell: &mut dyn FnMut(&ComparedRow),
) -> Result<Comparison, Error> {
    let mut comparison = Comparison {
        schema: COMPARE_SCHEMA.into(),
        model: model.name().to_owned(),
        angle: options.mesher().angle.map(f64::to_degrees),
        faces: model.face_count(),
        edge_method: options.edge_splitter_name().into(),
        ..Comparison::default()
    };
    let mut lower_bound = None;
    for strategy in strategies {
        for &bound in bounds {
            let options = options.clone().with_fill_method(strategy.fill_method()).with_bound(bound);
            let resolved =
                resolve(model.brep(), &options, cancel).map_err(|error| error.named(model.name()))?;
            comparison.tolerance = resolved.tolerance;
            let clock = Stopwatch::of_process();
            let parts = mesh_parts(model.brep(), &resolved, cancel, &|_| ());
            let seconds = clock.seconds();
            if cancel.is_cancelled() {
                return Err(Error::Cancelled);
            }
            let fewest = *lower_bound.get_or_insert_with(|| fewest(&resolved, &parts));
            let row = ComparedRow {
                strategy: strategy.name.into(),
                bound: crate::names::bound_name(bound).into(),
                seconds,
                ..row(model.brep(), &resolved, &parts, fewest)
            };
            tell(&row);
            comparison.rows.push(row);
        }
    }
    Ok(comparison)
}

/// Parts that are placed, with how often.
pub(crate) fn placed<'a>(
    resolved: &'a Resolved,
    parts: &'a [MeshedPart],
) -> impl Iterator<Item = (usize, &'a MeshedPart, usize, f64)> {
    let uses = resolved.uses.iter().zip(parts).enumerate();
    uses.filter(|(_, (u, _))| u.instances > 0).map(|(i, (u, part))| (i, part, u.instances, u.scale))
}

fn fewest(resolved: &Resolved, parts: &[MeshedPart]) -> f64 {
    placed(resolved, parts)
        .map(|(_, part, n, _)| n as f64 * part.report.faces.iter().map(|f| f.lower_bound).sum::<f64>())
        .sum()
}

fn row(model: &chordal_brep::Model, resolved: &Resolved, parts: &[MeshedPart], fewest: f64) -> ComparedRow {
    let mut row = ComparedRow { proven_error: Some(0.0), ..ComparedRow::default() };
    for (i, part, instances, scale) in placed(resolved, parts) {
        row.triangles += instances * part.mesh.triangle_count();
        row.edges += instances * part.mesh.edges.iter().map(|e| e.len().saturating_sub(1)).sum::<usize>();
        row.rounds = row.rounds.max(part.report.rounds);
        for face in &part.report.faces {
            row.phases.conversion += face.phases.conversion;
            row.phases.subdivision += face.phases.subdivision;
            row.phases.traversal += face.phases.traversal;
            row.phases.triangulation += face.phases.triangulation;
            row.failed_faces += instances * usize::from(face.failed.is_some());
            let proven = Some(face.proven_error * scale).filter(|e| e.is_finite());
            if face.triangles > 0 {
                row.proven_error = row.proven_error.zip(proven).map(|(a, b)| f64::max(a, b));
            }
        }
        row.measured_error =
            row.measured_error.max(scale * measure::largest_deviation(&model.parts[i], &part.mesh));
        part.add_stages(&mut row.stages);
    }
    row.ratio = row.triangles as f64 / fewest.max(1.0);
    row
}

impl Comparison {
    /// As JSON, with a line break at the end.
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).expect("a comparison has string keys only") + "\n"
    }
}
