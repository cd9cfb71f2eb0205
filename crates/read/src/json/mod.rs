//! JSON: Chordal's own lossless document of a model, and what geomdl (NURBS-Python) exports.

mod geomdl;
mod trims;

use crate::ReadError;
use chordal_brep::Model;
use serde::Deserialize;
use serde::de::IgnoredAny;

/// What tells the kinds of JSON apart.
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
    let bad = |problem: String| ReadError::Unreadable { name: name.to_owned(), format: "JSON", problem };
    let head: Head = serde_json::from_slice(text).map_err(|e| bad(e.to_string()))?;
    match head {
        Head { schema: Some(_), .. } => chordal_document::from_json(text).map_err(|e| bad(e.to_string())),
        Head { shape: Some(_), .. } => geomdl::read(text, name).map_err(|e| bad(e.to_string())),
        _ => {
            Err(bad("it has neither the \"schema\" of a Chordal model nor the \"shape\" of a geomdl export"
                .into()))
        }
    }
}

/// The text without the byte order mark that some editors put before it.
fn without_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)
}
