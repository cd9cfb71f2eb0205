//! The report: what was asked, what was done, what is proven, what was left undone. `docs/report.md` documents it.
//!
//! Lengths are millimetres, angles degrees, times seconds. A number that is not known is `null`.

pub use crate::compare::StageEntry;
use crate::sewing::SewingEntry;
use serde::{Deserialize, Serialize};

/// The name and version of the report's schema. The number rises when a field changes its meaning or goes.
pub const REPORT_SCHEMA: &str = "chordal-report/1";

/// Everything that is to be said about one job.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Report {
    pub schema: String,
    /// The version of the program.
    pub version: String,
    pub input: InputReport,
    pub options: OptionsReport,
    /// Nothing was left undone: exit code 0.
    pub clean: bool,
    /// One sentence for everything that was left undone; empty where `clean`.
    pub undone: Vec<String>,
    /// Largest proven two-sided distance between the exact faces and the mesh **as written**, without the gap; `null`
    /// where a face has no proof.
    pub proven_error: Option<f64>,
    /// Largest proven distance between an edge and its chords: what `options.boundary_tolerance` bounds;
    /// `null` where one is not known.
    pub boundary_error: Option<f64>,
    /// Largest distance of a mesh vertex from the exact surface of a face that uses it: what the file is loose by.
    pub max_gap: f64,
    /// Every shell that the file calls closed has no open and no inconsistent edge.
    pub watertight: bool,
    /// Edges with one triangle in shells that the file calls closed, instances counted.
    pub open_edges: usize,
    /// Edges whose two triangles run the same way, or with more than two, in shells that the file calls closed.
    pub inconsistent_edges: usize,
    pub shells: ShellTotals,
    /// As placed: a part placed twice counts twice.
    pub triangles: usize,
    /// As placed, shared by identity.
    pub vertices: usize,
    pub faces: FaceTotals,
    /// The area of the triangles in mm², as placed, those that were in the file not counted.
    pub area: f64,
    /// The fewest triangles that the tolerance allows (docs/report.md), as placed.
    pub lower_bound: f64,
    /// Rounds in which faces asked for finer edges, the most of any part.
    pub rounds: usize,
    pub parts: Vec<PartEntry>,
    /// What sewing did, of every part that was sewn.
    pub sewing: Vec<SewingEntry>,
    /// Curves and points of the file that belong to no face.
    pub loose: Vec<LooseEntry>,
    /// Triangles that were in the file already and were passed through: nothing is proven about them.
    pub passed_through: Vec<PassedThroughEntry>,
    pub warnings: Vec<WarningEntry>,
    pub output: Option<OutputReport>,
    pub seconds: Seconds,
    /// Which parts of the tessellator ran, in the order of the faces.
    pub stages: Vec<StageEntry>,
    /// Largest resident memory of the process so far, in bytes.
    pub peak_memory: Option<u64>,
    pub threads: usize,
    pub face_list: Vec<FaceEntry>,
}

/// The input file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct InputReport {
    pub path: String,
    pub bytes: u64,
    /// Format and version as the file states them.
    pub schema: String,
    /// The file's unit of length.
    pub unit: String,
    /// Diagonal of the tight axis-aligned box of the whole placed model; `null` where nobody asked for it.
    pub diagonal: Option<f64>,
}

/// The options with every default resolved.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct OptionsReport {
    pub tolerance: f64,
    /// As it was asked for ("0.1 %").
    pub tolerance_asked: String,
    /// Of the edges; the same as `tolerance` unless another was asked for.
    pub boundary_tolerance: f64,
    /// `null`: no limit.
    pub angle: Option<f64>,
    pub max_edge: Option<f64>,
    pub strategy: String,
    /// How edges became polylines.
    #[serde(default)]
    pub edge_method: String,
    /// Merge tolerance of sewing as asked for ("auto where loose", "auto", "off", "0.01 mm").
    pub sew: String,
    pub bound: String,
    pub face_timeout: Option<f64>,
    pub strict: bool,
}

/// Shells, instances counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct ShellTotals {
    pub total: usize,
    /// Those that the file calls closed.
    pub closed_in_file: usize,
    /// Those of the closed ones that are watertight in the mesh.
    pub watertight: usize,
}

/// Faces; `total = meshed + zero_area.instances + failed.instances`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FaceTotals {
    /// Every instance counted.
    pub total: usize,
    /// Every instance counted.
    pub meshed: usize,
    /// Faces of the file, each counted once.
    pub distinct: usize,
    pub failed: Vec<FailedFace>,
    /// Faces without an area at the model's own accuracy: they have no triangles and need none.
    pub zero_area: Vec<FailedFace>,
}

/// A face without triangles, or without good enough ones.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FailedFace {
    /// The entity in the file, `#123`.
    pub id: String,
    pub line: u32,
    pub kind: String,
    pub name: String,
    pub part: String,
    pub instances: usize,
    pub reason: String,
}

/// One part of the file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PartEntry {
    pub name: String,
    pub id: String,
    /// How often it is placed; a part that is never placed is not meshed.
    pub instances: usize,
    /// The tolerance in the part's own units: the asked one over the largest scale among its placements.
    pub tolerance: f64,
    pub faces: usize,
    pub triangles: usize,
    pub vertices: usize,
    pub rounds: usize,
    pub open_edges: usize,
    pub inconsistent_edges: usize,
    pub degenerate_triangles: usize,
    pub duplicate_triangles: usize,
    /// What the audit found wrong, one sentence each.
    pub problems: Vec<String>,
}

/// A curve or point that belongs to no face.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct LooseEntry {
    pub id: String,
    /// "wire" or "point".
    pub kind: String,
    pub name: String,
    pub part: String,
}

/// Triangles of the file.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct PassedThroughEntry {
    pub id: String,
    pub name: String,
    pub part: String,
    pub triangles: usize,
    pub instances: usize,
}

/// Something in the file that was repaired, guessed or left out.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct WarningEntry {
    pub id: String,
    pub line: u32,
    pub message: String,
    /// Part of the file's shape may be missing because of this: the job is not clean.
    pub lost: bool,
}

/// The written file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct OutputReport {
    pub path: String,
    pub format: String,
    pub bytes: u64,
    /// Largest distance that the format's numbers move a vertex by; contained in `proven_error`.
    pub rounding: f64,
}

/// Seconds per stage. Those of heal, edges, faces and stitch are summed over threads, the others are wall time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Seconds {
    pub read: f64,
    /// Sewing of loose faces.
    pub sew: f64,
    /// Resolving the tolerance: the box of the model.
    pub resolve: f64,
    pub heal: f64,
    pub edges: f64,
    pub faces: f64,
    pub stitch: f64,
    pub audit: f64,
    pub write: f64,
    /// Wall time of the whole job.
    pub total: f64,
}

/// One face, once however often it is placed.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FaceEntry {
    pub id: String,
    pub line: u32,
    pub kind: String,
    pub part: String,
    pub instances: usize,
    pub triangles: usize,
    /// In the placement with the largest scale; `null` where nothing is proven.
    pub proven_error: Option<f64>,
    pub gap: Option<f64>,
    /// Which bound proved it.
    pub bound: String,
    pub lower_bound: f64,
}

impl Report {
    /// As JSON, with a line break at the end.
    pub fn to_json(&self) -> String {
        let mut text = serde_json::to_string_pretty(self).expect("a report has string keys only");
        text.push('\n');
        text
    }
}

/// The name and version of the schema of a report about several inputs.
pub const BATCH_SCHEMA: &str = "chordal-report-batch/1";

/// The reports of several inputs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Batch {
    pub schema: String,
    /// Those that were written, in the order of the inputs.
    pub reports: Vec<Report>,
    /// Those of which nothing was written.
    pub failed: Vec<BatchFailure>,
}

/// An input of which nothing was written.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct BatchFailure {
    pub input: String,
    /// One sentence.
    pub error: String,
}

impl Default for Batch {
    fn default() -> Self {
        Self { schema: BATCH_SCHEMA.into(), reports: Vec::new(), failed: Vec::new() }
    }
}

impl Batch {
    /// As JSON, with a line break at the end.
    pub fn to_json(&self) -> String {
        let mut text = serde_json::to_string_pretty(self).expect("a batch has string keys only");
        text.push('\n');
        text
    }
}
