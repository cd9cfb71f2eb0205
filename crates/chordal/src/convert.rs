//! Exact models from one file into another, without meshing.

use crate::{JobError, read_model, write_whole};
use std::path::Path;

/// How a model is converted.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct ConvertOptions {
    /// Every face becomes an island with edges and vertices of its own.
    pub unsewn: bool,
}

impl ConvertOptions {
    pub fn with_unsewn(mut self, unsewn: bool) -> Self {
        self.unsewn = unsewn;
        self
    }
}

/// What was written.
#[derive(Clone, Debug, PartialEq)]
pub struct Converted {
    pub parts: usize,
    /// Of all parts, instances not counted.
    pub faces: usize,
    pub bytes: usize,
    /// What the reader repaired, guessed or left out.
    pub issues: Vec<chordal_brep::Issue>,
}

/// Reads an exact model and writes the whole of it as Chordal's own JSON.
///
/// # Errors
/// Where the input cannot be read or the output, whose name must end in `.json`, cannot be written; nothing is
/// written then.
pub fn convert(input: &Path, output: &Path, options: &ConvertOptions) -> Result<Converted, JobError> {
    let failed = |reason: String| JobError::Output { path: output.to_owned(), reason };
    let extension = output.extension().and_then(|e| e.to_str()).unwrap_or_default();
    if !extension.eq_ignore_ascii_case("json") {
        return Err(failed("models are converted to .json only".into()));
    }
    let mut model = read_model(input)?;
    if options.unsewn {
        model = model.unsewn();
    }
    let text = chordal_document::to_json(&model).map_err(|e| failed(e.to_string()))?;
    write_whole(output, &text).map_err(|e| failed(format!("cannot write the file: {e}")))?;
    Ok(Converted {
        parts: model.parts.len(),
        faces: model.parts.iter().map(|part| part.faces.len()).sum(),
        bytes: text.len(),
        issues: model.issues,
    })
}
