//! Reading meshes back: STL, OBJ, PLY, GLB, glTF and 3MF as a soup of welded triangles.
//!
//! Points are welded where all bits of their coordinates agree, within one *domain* only: a solid of ASCII
//! STL, an object of OBJ, a part of a PLY file that Chordal wrote, a placed mesh of glTF, a build item of
//! 3MF, else the whole file. Parts that touch therefore stay separate. Memory is allocated by a header's
//! count only if the length of the file confirms it.

mod bytes;
mod error;
mod gltf;
mod obj;
mod ply;
mod soup;
mod stl;
mod threemf;
mod weld;
mod xml;

pub use error::{AccessorFault, ImportError, ImportFault, ImportFormat, ImportPlace};
pub use soup::{SoupGroup, TriangleSoup};

use std::path::Path;
use weld::Builder;

/// Reads a mesh file; its extension names the format.
///
/// # Errors
/// If the file cannot be read, its extension is unknown, or its contents are not valid.
pub fn import_mesh(path: &Path) -> Result<TriangleSoup, ImportError> {
    let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
    let format = format_of(&extension)?;
    let bytes = std::fs::read(path).map_err(|source| ImportError::File { path: path.to_owned(), source })?;
    import(&bytes, format)
}

/// Reads a mesh from memory; `extension` names its format in lower case without a dot.
///
/// ```
/// let text = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
/// let soup = chordal_mesh::import_bytes(text, "obj")?;
/// assert_eq!(soup.triangles, [[0, 1, 2]]);
/// # Ok::<(), chordal_mesh::ImportError>(())
/// ```
///
/// # Errors
/// If the extension is unknown or the contents are not valid.
pub fn import_bytes(bytes: &[u8], extension: &str) -> Result<TriangleSoup, ImportError> {
    import(bytes, format_of(extension)?)
}

fn format_of(extension: &str) -> Result<ImportFormat, ImportError> {
    ImportFormat::from_extension(extension).ok_or_else(|| ImportError::UnknownFormat(extension.to_owned()))
}

fn import(bytes: &[u8], format: ImportFormat) -> Result<TriangleSoup, ImportError> {
    let mut builder = Builder::default();
    let read = match format {
        ImportFormat::Stl => stl::read(bytes, &mut builder),
        ImportFormat::Obj => obj::read(bytes, &mut builder),
        ImportFormat::Ply => ply::read(bytes, &mut builder),
        ImportFormat::Glb => gltf::read_binary(bytes, &mut builder),
        ImportFormat::Gltf => gltf::read_text(bytes, &mut builder),
        ImportFormat::ThreeMf => threemf::read(bytes, &mut builder),
    };
    read.and_then(|()| Ok(builder.finish()?)).map_err(|fault| ImportError::Invalid {
        format,
        place: fault.place,
        fault: fault.kind,
    })
}
