//! IGES 5.x, fixed ASCII form (and what of older versions reads the same).
//!
//! Source: *Initial Graphics Exchange Specification 5.3*, US PRO, 1996; types are its entity type numbers.
//!
//! Bytes → [`lines`] (which section each line belongs to) → [`document`]: the [`global`] section and the
//! directory as a table, [`parameters`] read on demand. [`tree`] finds what no other entity uses and builds
//! each part: [`faces`] with [`boundaries`] and [`loops`] (143, 144), [`topology`] (186, 514, 510), and below
//! them [`surfaces`] and [`curves`].

mod boundaries;
mod builder;
mod conics;
mod curves;
mod document;
mod faces;
mod global;
mod lines;
mod looks;
mod loops;
mod matrix;
mod own_border;
mod parameters;
mod resynchronise;
mod ruled;
mod simpler;
mod splines;
mod surfaces;
mod topology;
mod tree;

use crate::{Format, ReadError};
use chordal_brep::{Model, ReadIssue, Source};
use document::Doc;
use lines::Sections;

/// Lines in which the format must show itself.
const HEAD: usize = 200;

/// True where the content is an IGES file of any form.
pub(crate) fn looks_like_iges(bytes: &[u8]) -> bool {
    if is_binary(bytes) {
        return true;
    }
    let mut before = 0;
    for (_, line) in lines::split(&bytes[..bytes.len().min(HEAD * 96)]).take(HEAD) {
        match lines::parsed(line) {
            // A start section may be missing, may be long, and may hold anything.
            Some((b'S' | b'C' | b'B', text, 1)) if before == 0 => before = 1 + usize::from(text.len() == 72),
            Some((b'G', text, 1)) if before > 0 || text.contains(&b',') => return true,
            Some((b'S', ..)) if before > 0 => {}
            _ if line.trim_ascii().is_empty() => {}
            _ => return false,
        }
    }
    false
}

/// The binary form begins with a letter and the length of the section that it opens, as a number of four
/// bytes.
fn is_binary(bytes: &[u8]) -> bool {
    matches!(bytes, [b'B', 0, 0, 0, 1..=255, ..] | [b'B', 1..=255, 0, 0, 0, ..])
}

/// Reads an IGES file.
pub(crate) fn read(bytes: &[u8], name: &str) -> Result<Model, ReadError> {
    let sections = Sections::of(bytes);
    let special = if is_binary(bytes) { Some(b'B') } else { sections.special };
    if let Some(flag) = special {
        let form = if flag == b'B' { "binary" } else { "compressed ASCII" };
        let issue = ReadIssue::OtherForm { form, instead: "the fixed ASCII form" };
        return Err(ReadError::refused(Format::Iges, Source::default(), issue));
    }
    let doc = Doc::new(sections, bytes.len());
    let found = tree::build(&doc, name);
    if found.parts.is_empty() {
        return Err(ReadError::nothing(Format::Iges, doc.entries.len(), doc.notes.first()));
    }
    Ok(Model {
        name: name.to_owned(),
        schema: format!("IGES {}", doc.global.version_name()),
        unit: doc.global.unit.clone(),
        parts: found.parts,
        nodes: found.nodes,
        roots: found.roots,
        issues: doc.notes.take(),
    })
}
