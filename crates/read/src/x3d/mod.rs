//! VRML97 with its NURBS amendment, and X3D in the classic and the XML encoding.
//!
//! Bytes → [`crate::scene::text`] or [`xml`] (nodes) → [`crate::scene::prototypes`] → [`walk`] (groups,
//! shapes, appearances), which hands geometry to [`surfaces`] (splines) and [`shapes`] (polygons and solids).

mod curves;
mod place;
mod shapes;
mod surfaces;
mod swept;
#[cfg(test)]
mod tests;
mod walk;
mod xml;

use crate::scene::stage::Stage;
use crate::scene::{prototypes, text};
use crate::{Format, ReadError, ReadOptions};
use chordal_brep::Model;
use memchr::memmem;

/// The head of a file in which its format must show itself.
const HEAD: usize = 16 * 1024;

/// True where the content is a VRML97 or X3D file.
pub(crate) fn looks_like_x3d(bytes: &[u8]) -> bool {
    let head = without_mark(&bytes[..bytes.len().min(HEAD)]);
    head.starts_with(b"#VRML V2") || head.starts_with(b"#X3D V") || is_xml(head)
}

fn is_xml(head: &[u8]) -> bool {
    let head = head.trim_ascii_start();
    head.starts_with(b"<") && memmem::find(head, b"<X3D").is_some()
}

/// Without the mark of UTF-8.
fn without_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(&[0xef, 0xbb, 0xbf]).unwrap_or(bytes)
}

/// Reads a VRML97 or X3D file.
pub(crate) fn read(bytes: &[u8], name: &str, options: &ReadOptions) -> Result<Model, ReadError> {
    let bytes = without_mark(bytes);
    let (mut graph, schema) = if bytes.starts_with(b"#") {
        let end = memchr::memchr2(b'\n', b'\r', bytes).unwrap_or(bytes.len());
        let line = String::from_utf8_lossy(&bytes[1..end.min(100)]).trim().to_owned();
        (text::parse(bytes), line)
    } else {
        xml::parse(bytes)
    };
    prototypes::expand(&mut graph);
    graph.winding = options.winding.unwrap_or_default();
    let mut stage = Stage::new(bytes.len());
    walk::walk(&graph, &mut stage);
    let millimetres = graph.millimetres.unwrap_or(1000.0);
    stage.finish(Format::X3d, &mut graph, name, schema, &unit_name(millimetres), millimetres)
}

fn unit_name(millimetres: f64) -> String {
    const KNOWN: [(f64, &str); 6] =
        [(1000.0, "m"), (1.0, "mm"), (10.0, "cm"), (25.4, "inch"), (304.8, "foot"), (1e6, "km")];
    let near = |of: f64| (millimetres / of - 1.0).abs() < 1e-9;
    let known = KNOWN.iter().find(|(of, _)| near(*of));
    known.map_or_else(|| format!("{millimetres} mm"), |(_, name)| (*name).to_owned())
}
