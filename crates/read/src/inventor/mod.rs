//! Open Inventor files (1.0, 2.0 and 2.1; ASCII and binary) and VRML 1.0, which is a part of Inventor.
//!
//! Bytes → [`crate::scene::text`] or [`binary`] (nodes) → [`walk`], which carries the [`state`] that nodes
//! change for those after them: [`surfaces`] makes spline surfaces of it, [`shapes`] polygons and solids.

mod binary;
mod fields;
mod shapes;
mod state;
mod surfaces;
#[cfg(test)]
mod tests;
mod walk;

use crate::scene::stage::Stage;
use crate::scene::text;
use crate::{Format, ReadError, ReadOptions};
use chordal_brep::Model;

/// Inventor has no unit of its own; its `Units` nodes take lengths for metres where no other one is above.
const MILLIMETRES: f64 = 1000.0;

/// True where the content is an Inventor or VRML 1.0 file.
pub(crate) fn looks_like_inventor(bytes: &[u8]) -> bool {
    let line = header(bytes);
    line.starts_with("#Inventor V") || line.starts_with("#VRML V1")
}

/// Reads an Inventor file.
pub(crate) fn read(bytes: &[u8], name: &str, options: &ReadOptions) -> Result<Model, ReadError> {
    let line = header(bytes);
    let mut graph = if line.contains("binary") { binary::parse(bytes, &line) } else { text::parse(bytes) };
    graph.winding = options.winding.unwrap_or_default();
    let mut stage = Stage::new(bytes.len());
    walk::walk(&graph, &mut stage);
    let schema = line.trim_start_matches('#').trim().to_owned();
    stage.finish(Format::Inventor, &mut graph, name, schema, "m", MILLIMETRES)
}

/// The first line, which is ASCII.
fn header(bytes: &[u8]) -> String {
    let bytes = bytes.strip_prefix(&[0xef, 0xbb, 0xbf]).unwrap_or(bytes);
    let head = &bytes[..bytes.len().min(80)];
    let end = head.iter().position(|&b| b == b'\n' || b == b'\r').unwrap_or(head.len());
    String::from_utf8_lossy(&head[..end]).into_owned()
}
