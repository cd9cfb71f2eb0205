//! The exact model as JSON without loss: a model that is written and read again is the same, bit for bit.
//!
//! `docs/model-json.md` describes the schema. Its types are separate from those in memory, so that the types
//! in memory can change and old files stay readable. Numbers are 64-bit reals written with the fewest digits
//! that read back as the same bits.

mod error;
mod geometry;
mod layout;
mod load;
mod load_geometry;
mod load_issue;
mod load_part;
mod real;
mod save;
mod save_geometry;
mod schema;

pub use error::DocumentError;

use chordal_brep::Model;
use serde::{Deserialize, Serialize};

/// The name and version that a document carries.
pub const SCHEMA: &str = "chordal-model/1";

/// The model as text.
///
/// # Errors
/// [`DocumentError::Kind`] for a kind of curve or surface that the schema does not have.
pub fn to_json(model: &Model) -> Result<String, DocumentError> {
    let document = save::document(model)?;
    let mut text = Vec::new();
    let mut serializer = serde_json::Serializer::with_formatter(&mut text, layout::ObjectsOnLines::default());
    document.serialize(&mut serializer)?;
    text.push(b'\n');
    Ok(String::from_utf8(text).expect("JSON is UTF-8"))
}

/// The model of a document.
///
/// A face with invalid data becomes a failed face of the model, with the reason. All other invalid data are
/// ignored with a warning.
///
/// # Errors
/// [`DocumentError`] where the text is no document of this schema, or its tree is none.
pub fn from_json(bytes: &[u8]) -> Result<Model, DocumentError> {
    /// Read before everything else, which may differ in another version.
    #[derive(Deserialize)]
    struct Head {
        schema: String,
    }
    let head: Head = serde_json::from_slice(bytes)?;
    if head.schema != SCHEMA {
        return Err(DocumentError::Schema { found: head.schema });
    }
    load::model(serde_json::from_slice(bytes)?)
}
