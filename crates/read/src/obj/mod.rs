//! Wavefront OBJ: free-form surfaces with trims, and polygons, which pass through as triangles.
//!
//! Text → [`lines`] (statements, continued lines joined) → [`reader`] (vertices, attributes, elements in the
//! order of the file) → [`element`] (a curve or surface with its body) with [`basis`] (every basis as
//! B-splines, exactly) and [`polygons`]. `call` and `csh` statements are never followed: a model is one file,
//! and no file runs commands.

mod basis;
mod element;
mod lines;
mod polygons;
mod reader;
#[cfg(test)]
mod tests;

use crate::flat::{self, LengthUnit};
use crate::{Format, ReadError};
use chordal_brep::Model;

/// So many statements at the head of a file must all be known ones.
const HEAD: usize = 64;

/// Every statement of version 3, those of version 2 that it superseded, and common extensions.
const KEYWORDS: &[&str] = &[
    "v",
    "vt",
    "vn",
    "vp",
    "cstype",
    "deg",
    "bmat",
    "step",
    "p",
    "l",
    "f",
    "fo",
    "curv",
    "curv2",
    "surf",
    "parm",
    "trim",
    "hole",
    "scrv",
    "sp",
    "end",
    "con",
    "g",
    "s",
    "mg",
    "o",
    "bevel",
    "c_interp",
    "d_interp",
    "lod",
    "usemtl",
    "mtllib",
    "usemap",
    "maplib",
    "shadow_obj",
    "trace_obj",
    "ctech",
    "stech",
    "call",
    "csh",
    "bsp",
    "bzp",
    "cdc",
    "cdp",
    "res",
    "vw",
    "vc",
];

/// True where the content is an OBJ file: it begins with statements that only OBJ has.
pub(crate) fn looks_like_obj(bytes: &[u8]) -> bool {
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let mut tells = false;
    for statement in lines::Statements::new(text).take(HEAD) {
        let Some(word) = statement.words().next() else { continue };
        if !KEYWORDS.iter().any(|known| known.as_bytes() == word) {
            return false;
        }
        tells |= matches!(word, b"v" | b"vp" | b"cstype" | b"mtllib" | b"usemtl" | b"call" | b"csh");
    }
    tells
}

/// Reads an OBJ file.
pub(crate) fn read(bytes: &[u8], name: &str) -> Result<Model, ReadError> {
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let read = reader::read(text);
    let part = read.part;
    if part.faces.is_empty() && part.tessellated.is_empty() && part.loose.is_empty() {
        return Err(ReadError::nothing(Format::Obj, read.statements, read.issues.first().cloned()));
    }
    Ok(flat::model(name, "Wavefront OBJ".to_owned(), LengthUnit::unstated(), part, read.issues))
}
