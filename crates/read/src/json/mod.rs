//! JSON: Chordal's own lossless document of a model, and what geomdl (NURBS-Python) exports.

mod geomdl;
mod trims;

use crate::{Format, ReadError};
use chordal_brep::{Model, ReadIssue, Source};
use chordal_document::DocumentError;
use serde::Deserialize;
use serde::de::IgnoredAny;

/// The keys by which the kinds of JSON are recognised.
#[derive(Deserialize)]
struct Head {
    schema: Option<String>,
    shape: Option<IgnoredAny>,
}

/// True where the content is a JSON object, if perhaps a broken one.
pub(crate) fn looks_like_json(bytes: &[u8]) -> bool {
    let text = without_mark(bytes);
    let mut words = text.iter().filter(|b| !b.is_ascii_whitespace());
    words.next() == Some(&b'{') && matches!(words.next(), None | Some(b'"' | b'}'))
}

/// Reads a JSON file.
pub(crate) fn read(bytes: &[u8], name: &str) -> Result<Model, ReadError> {
    let text = without_mark(bytes);
    let refused = |line: usize, issue: ReadIssue| {
        let source = Source { entity: 0, line: u32::try_from(line).unwrap_or(0) };
        ReadError::refused(Format::Json, source, issue)
    };
    let broken = |e: serde_json::Error| refused(e.line(), ReadIssue::TextBroken { reason: e.to_string() });
    let head: Head = serde_json::from_slice(text).map_err(broken)?;
    match head {
        Head { schema: Some(_), .. } => chordal_document::from_json(text).map_err(|error| match error {
            DocumentError::Syntax(error) => broken(error),
            error => refused(0, ReadIssue::TextBroken { reason: error.to_string() }),
        }),
        Head { shape: Some(_), .. } => geomdl::read(text, name).map_err(broken),
        _ => Err(refused(0, ReadIssue::UnknownJson)),
    }
}

/// The text without the byte order mark that some editors put before it.
fn without_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)
}
