//! A model meshed by several methods, side by side: what a row of the comparison says, and its drawing.
//!
//! The caller meshes the model, once for each method, and passes the parts as [`MeshedUse`]s.

mod measure;
mod plot;

pub use plot::plot;

use chordal_brep::Part;
use chordal_mesh::PartMesh;
use chordal_tessellate::{Bound, PartReport};
use serde::Serialize;

/// The name and version of the schema of [`Comparison`].
pub const COMPARE_SCHEMA: &str = "chordal-compare/1";

/// A part of a model as a method meshed it, with how it is placed.
#[derive(Clone, Copy, Debug)]
pub struct MeshedUse<'a> {
    /// The part.
    pub part: &'a Part,
    /// Its mesh.
    pub mesh: &'a PartMesh,
    /// The report on its faces.
    pub report: &'a PartReport,
    /// How often the part is placed.
    pub instances: usize,
    /// Millimetres per unit of the part, by its largest placement.
    pub scale: f64,
}

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
    /// The edge method.
    pub edge_method: String,
    /// One row per strategy and bound.
    pub rows: Vec<ComparedRow>,
}

impl Comparison {
    /// As JSON, with a line break at the end.
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).expect("a comparison has string keys only") + "\n"
    }
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
    /// Largest distance of the surfaces from the mesh over samples of all triangles, the gap of the file
    /// included.
    pub measured_error: f64,
    /// Triangles over the lower bound (docs/report.md).
    pub ratio: f64,
    /// Faces that failed, as placed.
    pub failed_faces: usize,
    /// Faces that the strategy gave up, so that the default made them, as placed: the other figures of the
    /// row are theirs, too.
    pub given_up_faces: usize,
    /// The number of rounds in which faces requested finer edges, the largest of all parts.
    pub rounds: usize,
    /// Which parts of the mesher ran.
    pub stages: Vec<StageCount>,
    /// Time of the phases, for strategies by cells.
    pub phases: PhaseSeconds,
}

/// How often one part of the mesher ran.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct StageCount {
    /// Its name.
    pub name: String,
    /// Faces for which it ran; a face that is placed several times counts once. None for parts that work on
    /// edges.
    pub faces: usize,
    /// The number of things that it made in all of them.
    pub count: usize,
}

/// Seconds of the phases of a strategy by cells, in the last attempt at each face, summed over faces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct PhaseSeconds {
    /// From splines to the pieces that the strategy begins with.
    pub conversion: f64,
    /// Subdivision.
    pub subdivision: f64,
    /// Following trimming curves over cells.
    pub traversal: f64,
    /// Trimming and triangulation.
    pub triangulation: f64,
}

/// The name of a bound in reports.
pub fn bound_name(bound: Bound) -> &'static str {
    match bound {
        Bound::Proven => "proven",
        Bound::Estimated => "estimated",
    }
}

/// The lower bound of the triangles of a model, as placed. It is a property of the model, up to rounding.
pub fn fewest_triangles(uses: &[MeshedUse<'_>]) -> f64 {
    let of_part = |part: &PartReport| part.faces.iter().map(|f| f.lower_bound).sum::<f64>();
    uses.iter().map(|one| one.instances as f64 * of_part(one.report)).sum()
}

impl ComparedRow {
    /// The row of a meshed model; the caller fills in the names and the time.
    pub fn of(uses: &[MeshedUse<'_>], fewest: f64) -> Self {
        let mut row = ComparedRow { proven_error: Some(0.0), ..ComparedRow::default() };
        uses.iter().for_each(|one| row.add(one));
        row.ratio = row.triangles as f64 / fewest.max(1.0);
        row
    }

    fn add(&mut self, one: &MeshedUse<'_>) {
        let MeshedUse { part, mesh, report, instances, scale } = *one;
        self.triangles += instances * mesh.triangle_count();
        self.edges += instances * edge_chords(mesh);
        self.rounds = self.rounds.max(report.rounds);
        for face in &report.faces {
            self.phases.conversion += face.phases.conversion;
            self.phases.subdivision += face.phases.subdivision;
            self.phases.traversal += face.phases.traversal;
            self.phases.triangulation += face.phases.triangulation;
            self.failed_faces += instances * usize::from(face.failed.is_some());
            self.given_up_faces += instances * usize::from(face.given_up.is_some());
            let proven = Some(face.proven_error * scale).filter(|e| e.is_finite());
            if face.triangles > 0 {
                self.proven_error = self.proven_error.zip(proven).map(|(a, b)| f64::max(a, b));
            }
        }
        self.measured_error = self.measured_error.max(scale * measure::largest_deviation(part, mesh));
        for (name, faces, count) in report.stages() {
            match self.stages.iter_mut().find(|s| s.name == name) {
                Some(stage) => {
                    stage.faces += faces;
                    stage.count += count;
                }
                None => self.stages.push(StageCount { name: name.into(), faces, count }),
            }
        }
    }
}

/// Chords of all edges of a part.
pub(crate) fn edge_chords(mesh: &PartMesh) -> usize {
    mesh.edges.iter().map(|e| e.len().saturating_sub(1)).sum()
}
