//! Reading meshes back: STL, OBJ, PLY, GLB, glTF and 3MF as a soup of welded triangles.
//!
//! Points are welded where all bits of their coordinates agree, within one *domain* only: a solid of ASCII STL, an
//! object of OBJ, a part of a PLY file of ours, a placed mesh of GLB, a build item of 3MF, else the whole file. Parts
//! that touch stay apart so. Nothing is allocated by a count in a header before the file's length confirms it.

mod bytes;
mod gltf;
mod obj;
mod ply;
mod stl;
mod threemf;
mod weld;
mod xml;

use glam::{DAffine3, DMat3, DVec3};
use std::io;
use std::ops::Range;
use std::path::{Path, PathBuf};
use weld::Builder;

/// Why a mesh could not be read.
#[derive(Debug, thiserror::Error)]
pub enum ImportError {
    #[error("cannot read {}: {source}", path.display())]
    File { path: PathBuf, source: io::Error },
    #[error("`{0}` is no mesh format that is read; stl, obj, ply, glb, gltf and 3mf are")]
    UnknownFormat(String),
    /// What is wrong with the file, and where.
    #[error("this is no valid {format} file: {what}")]
    Invalid { format: &'static str, what: String },
}

/// Named triangles of a soup.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SoupGroup {
    pub name: String,
    pub triangles: Range<usize>,
}

/// Triangles as a file holds them, in the file's own unit and axes.
#[derive(Clone, Debug, PartialEq)]
pub struct TriangleSoup {
    pub positions: Vec<DVec3>,
    pub triangles: Vec<[u32; 3]>,
    /// Solids, objects or placed meshes; together they cover all triangles, in order.
    pub groups: Vec<SoupGroup>,
    /// Per triangle the index of its exact face, −1 where it has none; empty where the file says nothing of faces.
    pub face_ids: Vec<i64>,
    /// The length of the file's unit in millimetres, where the file or its format states it.
    pub unit_mm: Option<f64>,
    /// Whether Y points up, not Z.
    pub y_up: bool,
}

impl TriangleSoup {
    /// The same triangles in millimetres (where the unit is known) and with Z up.
    pub fn into_millimetres_z_up(mut self) -> Self {
        let scale = self.unit_mm.unwrap_or(1.0);
        let turn = |p: DVec3| if self.y_up { DVec3::new(p.x, -p.z, p.y) } else { p };
        self.positions.iter_mut().for_each(|p| *p = turn(*p) * scale);
        self.unit_mm = self.unit_mm.map(|_| 1.0);
        self.y_up = false;
        self
    }
}

/// Reads a mesh file; its extension names the format.
///
/// # Errors
/// Where the file cannot be read, its extension is unknown, or its contents are not what they should be.
pub fn import_mesh(path: &Path) -> Result<TriangleSoup, ImportError> {
    let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
    if !is_known(&extension) {
        return Err(ImportError::UnknownFormat(extension));
    }
    let bytes = std::fs::read(path).map_err(|source| ImportError::File { path: path.to_owned(), source })?;
    import_bytes(&bytes, &extension)
}

fn is_known(extension: &str) -> bool {
    ["stl", "obj", "ply", "glb", "gltf", "3mf"].contains(&extension)
}

/// Reads a mesh from memory; `extension` names its format in lower case without a dot.
///
/// # Errors
/// As [`import_mesh`].
pub fn import_bytes(bytes: &[u8], extension: &str) -> Result<TriangleSoup, ImportError> {
    let mut builder = Builder::default();
    let (format, result) = match extension {
        "stl" => ("STL", stl::read(bytes, &mut builder)),
        "obj" => ("OBJ", obj::read(bytes, &mut builder)),
        "ply" => ("PLY", ply::read(bytes, &mut builder)),
        "glb" => ("GLB", gltf::read_binary(bytes, &mut builder)),
        "gltf" => ("glTF", gltf::read_text(bytes, &mut builder)),
        "3mf" => ("3MF", threemf::read(bytes, &mut builder)),
        _ => return Err(ImportError::UnknownFormat(extension.to_owned())),
    };
    result.and_then(|()| builder.finish()).map_err(|what| ImportError::Invalid { format, what })
}

/// Whether a transform reverses orientation, so that triangles must be reversed with it.
fn reverses(t: &DAffine3) -> bool {
    let m: DMat3 = t.matrix3;
    m.determinant() < 0.0
}
