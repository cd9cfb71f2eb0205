//! The reports of several inputs in one JSON object.

use chordal::Report;
use serde::Serialize;

/// The name and version of the schema.
const BATCH_SCHEMA: &str = "chordal-report-batch/2";

/// The reports of several inputs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Batch {
    schema: &'static str,
    /// The inputs whose mesh was written, in their order.
    pub reports: Vec<Report>,
    /// The inputs without a mesh.
    pub failed: Vec<BatchFailure>,
}

/// An input without a mesh.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct BatchFailure {
    /// Its path.
    pub input: String,
    /// One sentence.
    pub error: String,
}

impl Default for Batch {
    fn default() -> Self {
        Self { schema: BATCH_SCHEMA, reports: Vec::new(), failed: Vec::new() }
    }
}

impl Batch {
    /// As JSON, with a line break at the end.
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).expect("a batch has string keys only") + "\n"
    }
}
