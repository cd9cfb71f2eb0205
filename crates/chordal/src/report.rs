//! The report: what was requested, what was done, what is proven, what went wrong. `docs/report.md` documents
//! it.
//!
//! Lengths are millimetres, angles degrees, times seconds. A value that is not known is `null`.

mod closedness;
mod problem;
mod sewing;
mod summary;

pub use closedness::Closedness;
pub use problem::Problem;
pub use sewing::{GapSurvey, OpenEntry, SewingEntry};

use chordal_brep::{Severity, Source};
use serde::{Deserialize, Serialize};

/// The name and version of the report's schema. The number rises when a field changes its meaning or is
/// removed.
pub const REPORT_SCHEMA: &str = "chordal-report/2";

/// The report of one model.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Report {
    /// [`REPORT_SCHEMA`].
    pub schema: String,
    /// The version of Chordal.
    pub version: String,
    /// The input file.
    pub input: InputReport,
    /// The options with every default resolved.
    pub options: OptionsReport,
    /// No problem is an error: exit code 0.
    pub clean: bool,
    /// Every problem of every stage, in the order of the stages.
    pub problems: Vec<Problem>,
    /// Largest proven two-sided distance between an exact face and its triangles **as written**, over the
    /// faces that have a proof; without the gap. `null` where no face has a proof.
    pub proven_error: Option<f64>,
    /// Faces with triangles but without a proof; `proven_error` does not cover them.
    pub unproven_faces: Vec<FaceName>,
    /// Largest proven distance between an edge and its chords, which `options.boundary_tolerance` bounds;
    /// `null` where it is not known of an edge.
    pub boundary_error: Option<f64>,
    /// Largest distance between a mesh vertex and the exact surface of a face that uses it: the inaccuracy of
    /// the file.
    pub max_edge_gap: f64,
    /// Whether the surface is closed; `null` where no face was meshed, so that nothing was examined.
    pub closedness: Option<Closedness>,
    /// Mesh edges with one triangle in shells that the file declares closed, as placed.
    pub open_edges: usize,
    /// Mesh edges whose triangles do not pair up in opposite directions in shells that the file declares
    /// closed, as placed.
    pub inconsistent_edges: usize,
    /// Faces without triangles in shells that the file declares closed, as placed.
    pub missing_faces: usize,
    /// The shells, as placed.
    pub shells: ShellTotals,
    /// As placed: a part placed twice counts twice.
    pub triangles: usize,
    /// As placed; a vertex shared by several triangles counts once.
    pub vertices: usize,
    /// The faces, as placed.
    pub faces: FaceTotals,
    /// The area of the triangles in mm², as placed, without those that were in the file already.
    pub area: f64,
    /// The fewest triangles that the tolerance allows (docs/report.md), as placed.
    pub lower_bound: f64,
    /// Edges that the requested edge method gave up, so that the default cut them into chords; as placed.
    pub edges_given_up: usize,
    /// How often faces requested finer edges, the most of any part.
    pub edge_rounds: usize,
    /// Every part of the file.
    pub parts: Vec<PartEntry>,
    /// What sewing did, for every part that was sewn.
    pub sewing: Vec<SewingEntry>,
    /// Curves and points of the file that belong to no face.
    pub loose: Vec<LooseEntry>,
    /// Triangles that were in the file already and were copied: nothing is proven about them.
    pub tessellated_input: Vec<TessellatedInput>,
    /// The written file.
    pub output: Option<OutputReport>,
    /// Time per stage.
    pub seconds: Seconds,
    /// Which methods of the mesher ran, in the order of the faces.
    pub stages: Vec<StageEntry>,
    /// Seconds of an ordinary core that the faces and edges took, by counted work: the same on every machine.
    #[serde(default)]
    pub work: f64,
    /// Largest resident memory of the process so far, in bytes; `null` if the system does not provide it.
    pub peak_memory: Option<u64>,
    /// Threads that meshed.
    pub threads: usize,
    /// Every face once, in the order of the parts.
    pub faces_detail: Vec<FaceEntry>,
}

/// The input file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct InputReport {
    /// The path, or the name that the caller gave.
    pub path: String,
    /// The size of the file.
    pub bytes: u64,
    /// Format and version as the file states them.
    pub format: String,
    /// The file's unit of length.
    pub unit: String,
    /// Diagonal of the tight axis-aligned box of the whole placed model; `null` unless the tolerance is a
    /// percentage.
    pub diagonal: Option<f64>,
}

/// The options with every default resolved.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct OptionsReport {
    /// Largest distance between mesh and surface.
    pub tolerance: f64,
    /// As the caller wrote it ("0.1 %").
    pub tolerance_requested: String,
    /// Largest distance between edges and their chords; equals `tolerance` unless the caller gave another
    /// one.
    pub boundary_tolerance: f64,
    /// `null`: no limit.
    pub angle: Option<f64>,
    /// `null`: no limit.
    pub max_edge: Option<f64>,
    /// How points were placed and connected.
    pub strategy: String,
    /// How edges became polylines.
    pub edge_method: String,
    /// "auto-if-unshared", "auto", "off" or a length.
    pub sewing: String,
    /// "proven" or "estimated".
    pub bound: String,
    /// Seconds of one face or edge; `null`: no limit.
    pub face_timeout: Option<f64>,
    /// Seconds of all faces and edges, per megabyte of the file and at 0.1 %; `null`: no limit.
    pub file_timeout: Option<f64>,
    /// Bytes of all triangles, per megabyte of the file and at 0.1 %; `null`: no limit.
    pub memory: Option<u64>,
}

/// The shells of the model that have a surface, as placed; `total = closed + open_by_design + leaking`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ShellTotals {
    /// All shells.
    pub total: usize,
    /// Those that the file declares closed.
    pub closed_in_file: usize,
    /// Those that are closed in the mesh.
    pub closed: usize,
    /// Those that the file declares closed and that are not closed in the mesh.
    pub leaking: usize,
    /// Those with a border that the file does not declare closed.
    pub open_by_design: usize,
    /// Faces with triangles that belong to no shell.
    pub free_faces: usize,
}

/// The faces of the model, as placed; `total = meshed + failed + zero_area`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct FaceTotals {
    /// All faces.
    pub total: usize,
    /// Faces with triangles.
    pub meshed: usize,
    /// Faces with triangles whose error is proven.
    pub proven: usize,
    /// Faces without triangles, or without good enough ones.
    pub failed: usize,
    /// Faces without an area at the accuracy of the file: they need no triangles.
    pub zero_area: usize,
    /// Faces that the requested strategy gave up, so that the default made them.
    pub given_up: usize,
    /// Faces of the file, each counted once.
    pub distinct: usize,
}

/// A face of the file.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct FaceName {
    /// The entity in the file, `#123`.
    pub entity: Option<String>,
    /// The line in the file, from 1.
    pub line: Option<u32>,
    /// The name of its part.
    pub part: String,
    /// How often its part is placed.
    pub instances: usize,
}

/// One part of the file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct PartEntry {
    /// Its name.
    pub name: String,
    /// The entity in the file, `#123`.
    pub entity: Option<String>,
    /// How often it is placed; a part that is never placed is not meshed.
    pub instances: usize,
    /// The tolerance in the part's own units: the one of the model over the largest scale among its
    /// placements.
    pub tolerance: f64,
    /// Its faces.
    pub faces: usize,
    /// Its triangles.
    pub triangles: usize,
    /// Its vertices.
    pub vertices: usize,
    /// How often its faces requested finer edges.
    pub edge_rounds: usize,
    /// Mesh edges with one triangle, in all of its shells.
    pub open_edges: usize,
    /// Mesh edges whose triangles do not pair up in opposite directions, in all of its shells.
    pub inconsistent_edges: usize,
    /// Triangles without area.
    pub degenerate_triangles: usize,
    /// Triangles over the same three vertices as another one.
    pub duplicate_triangles: usize,
    /// Faces of closed shells whose triangles cut each other.
    #[serde(default)]
    pub self_intersections: Vec<SelfIntersection>,
}

/// Two faces of a closed shell whose triangles cut each other; twice the same where a face cuts itself.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct SelfIntersection {
    /// The entities of the faces in the file, `#123`.
    pub faces: [Option<String>; 2],
    /// Pairs of triangles that cut each other.
    pub triangle_pairs: usize,
    /// The exact faces cross or touch in the file, or their edges are looser than the faces are apart.
    #[serde(default)]
    pub in_file: bool,
    /// The exact faces cross or touch in the file.
    #[serde(default)]
    pub faces_meet: bool,
}

/// A curve or point that belongs to no face.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct LooseEntry {
    /// The entity in the file, `#123`.
    pub entity: Option<String>,
    /// "wire" or "point".
    pub kind: String,
    /// Its name.
    pub name: String,
    /// The name of its part.
    pub part: String,
}

/// Triangles that were in the file already.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct TessellatedInput {
    /// The entity in the file, `#123`.
    pub entity: Option<String>,
    /// Its name.
    pub name: String,
    /// The name of its part.
    pub part: String,
    /// How many triangles.
    pub triangles: usize,
    /// How often they are placed.
    pub instances: usize,
}

/// The written file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct OutputReport {
    /// Its path, or `-` for standard output.
    pub path: String,
    /// Its format.
    pub format: String,
    /// Its size.
    pub bytes: u64,
    /// Largest distance by which the numbers of the format moved a vertex; contained in `proven_error`.
    pub rounding: f64,
}

/// Seconds per stage. Those of `trim`, `edges`, `faces` and `stitch` are summed over threads, the others are
/// wall time. All are zero where the platform has no clock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Seconds {
    /// Reading the file.
    pub read: f64,
    /// Sewing faces that share no edges.
    pub sew: f64,
    /// Measuring the model, so that a percentage becomes a length.
    pub resolve: f64,
    /// Repairing the trimming loops of faces in the plane of parameters.
    pub trim: f64,
    /// Sampling edges.
    pub edges: f64,
    /// Placing points, triangulating and proving.
    pub faces: f64,
    /// Joining the faces of a part.
    pub stitch: f64,
    /// Checking the mesh.
    pub audit: f64,
    /// Writing the file.
    pub write: f64,
    /// The whole.
    pub total: f64,
}

/// What became of a face.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum FaceStatus {
    /// It has triangles.
    #[default]
    Meshed,
    /// It has no triangles, or none that are good enough; a problem says why.
    Failed,
    /// It has no area at the accuracy of the file, so it needs no triangles.
    ZeroArea,
}

/// One face, once however often it is placed.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct FaceEntry {
    /// The entity in the file, `#123`.
    pub entity: Option<String>,
    /// The line in the file, from 1.
    pub line: Option<u32>,
    /// The kind of its surface.
    pub kind: String,
    /// Its name.
    pub name: String,
    /// The name of its part.
    pub part: String,
    /// How often its part is placed.
    pub instances: usize,
    /// What became of it.
    pub status: FaceStatus,
    /// The requested strategy, `options.strategy`.
    pub strategy_requested: String,
    /// The strategy that made its triangles: the requested one, or `default` where that gave up; `null` where
    /// it has none.
    pub strategy: Option<String>,
    /// How many triangles it has.
    pub triangles: usize,
    /// In the placement with the largest scale; `null` where nothing is proven.
    pub proven_error: Option<f64>,
    /// In the placement with the largest scale; `null` where it is not known.
    pub gap: Option<f64>,
    /// Which bound proved the error.
    pub bound: String,
    /// The fewest triangles that the tolerance allows.
    pub lower_bound: f64,
    /// The area of its triangles in mm², in the placement with the largest scale.
    #[serde(default)]
    pub area: f64,
}

/// One method of the mesher.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct StageEntry {
    /// Its name.
    pub name: String,
    /// Faces for which it ran, each counted once however often it is placed; 0 for methods that work on
    /// edges.
    pub faces: usize,
    /// What it made in all of them.
    pub count: usize,
}

impl Report {
    /// As JSON, with a line break at the end.
    pub fn to_json(&self) -> String {
        let mut text = serde_json::to_string_pretty(self).expect("a report has string keys only");
        text.push('\n');
        text
    }

    /// The problems that are errors.
    pub fn errors(&self) -> impl Iterator<Item = &Problem> {
        self.problems.iter().filter(|p| p.severity == Severity::Error)
    }

    /// The problems that are no errors.
    pub fn warnings(&self) -> impl Iterator<Item = &Problem> {
        self.problems.iter().filter(|p| p.severity != Severity::Error)
    }
}

/// `#123`; `None` where the format has no numbers.
pub(crate) fn entity_name(source: Source) -> Option<String> {
    (source.entity > 0).then(|| format!("#{}", source.entity))
}

/// From 1; `None` where the format has no lines.
pub(crate) fn line_number(source: Source) -> Option<u32> {
    (source.line > 0).then_some(source.line)
}
