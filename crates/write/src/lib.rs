//! Writers of mesh files: STL, GLB, glTF, OBJ, PLY and 3MF from one [`Scene`].
//!
//! [`to_bytes`] makes a file in memory, [`write_to`] writes to any [`Write`], [`write_scene`] replaces a
//! file.
//!
//! A vertex's coordinates in the file are its part's, times the placement (millimetres), times the change of
//! unit and axes, all in 64 bits; a 32-bit format rounds only the result. The same scene and options give the
//! same bytes.
//!
//! ```
//! use chordal_mesh::{PassThrough, Scene, SceneNode, ScenePart};
//! use chordal_write::{Format, WriteOptions, to_bytes};
//! use glam::{DAffine3, DVec3};
//!
//! let triangle = PassThrough {
//!     points: vec![DVec3::ZERO, DVec3::X, DVec3::Y],
//!     triangles: vec![[0, 1, 2]],
//!     ..PassThrough::default()
//! };
//! let part = ScenePart { pass_through: vec![triangle], ..ScenePart::default() };
//! let node = SceneNode {
//!     name: String::new(),
//!     transform: DAffine3::IDENTITY,
//!     part: Some(0),
//!     children: Vec::new(),
//!     color: None,
//! };
//! let scene = Scene { parts: vec![part], nodes: vec![node], roots: vec![0], ..Scene::default() };
//!
//! let file = to_bytes(&scene, &WriteOptions::new(Format::StlBinary))?;
//! assert_eq!(file.bytes.len(), 84 + 50);
//! assert_eq!(file.summary.triangles, 1);
//! # Ok::<(), chordal_write::WriteError>(())
//! ```

#![deny(missing_docs)]

mod check;
mod color;
mod error;
mod flat;
mod format;
mod frame;
mod gltf;
mod names;
mod number;
mod obj;
mod options;
mod ply;
mod sink;
mod stl;
mod summary;
mod threemf;
mod warning;

pub use check::{MeshFault, SceneFault};
pub use error::{Countable, WriteError};
pub use format::{Format, SolidPer, Unit, UnknownUnit, UpAxis};
pub use options::WriteOptions;
pub use summary::WriteSummary;
pub use warning::WriteWarning;

use chordal_mesh::Scene;
use sink::{Counter, NewFile};
use std::ffi::OsStr;
use std::io::{BufWriter, Cursor, Write};
use std::path::Path;
use summary::Tally;

/// The name by which an OBJ file made in memory refers to its material library.
const LIBRARY_NAME: &str = "model.mtl";

/// A mesh file in memory.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Encoded {
    /// The file's contents.
    pub bytes: Vec<u8>,
    /// The material library of an OBJ file with colours, to which the file refers by the library's name.
    /// Absent for other formats and without colours.
    pub library: Option<Library>,
    /// What the file holds, and how far rounding moved it.
    pub summary: WriteSummary,
}

/// A second file beside an OBJ file: its materials.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Library {
    /// The file name that the OBJ file refers to: `model.mtl`.
    pub name: String,
    /// The library's contents.
    pub bytes: Vec<u8>,
}

/// Makes a mesh file in memory.
///
/// # Errors
/// If a coordinate is not finite, the format cannot hold as many triangles, or the scene contradicts itself.
pub fn to_bytes(scene: &Scene, options: &WriteOptions) -> Result<Encoded, WriteError> {
    check::check_scene(scene)?;
    let mut library = None;
    if options.format == Format::Obj && obj::has_colors(scene, options) {
        let mut bytes = Vec::new();
        obj::write_library(scene, &mut bytes, options)?;
        library = Some(Library { name: LIBRARY_NAME.to_owned(), bytes });
    }
    let mut bytes = Vec::new();
    let name = library.as_ref().map(|l| l.name.as_str());
    let summary = write_stream(scene, &mut bytes, name, options)?;
    Ok(Encoded { bytes, library, summary })
}

/// Writes a scene to a file. A file at `path` is replaced only once the new one is complete. An OBJ file with
/// colours gets a material library of the same name beside it.
///
/// # Errors
/// As [`to_bytes`], and if a file cannot be created, written or renamed. A file at `path` is untouched then.
pub fn write_scene(scene: &Scene, path: &Path, options: &WriteOptions) -> Result<WriteSummary, WriteError> {
    check::check_scene(scene)?;
    let in_file = |error: WriteError| match error {
        WriteError::Io(source) => WriteError::File { path: path.to_owned(), source },
        other => other,
    };
    let mut file = NewFile::create(path)?;
    let library = match options.format {
        Format::Obj => new_library(scene, path, options)?,
        _ => None,
    };
    let name = library.as_ref().map(|(name, _)| name.as_str());
    let summary = write_stream(scene, file.writer(), name, options).map_err(in_file)?;
    // The library first, so that the mesh never names a library that does not exist yet.
    if let Some((_, library)) = library {
        library.commit()?;
    }
    file.commit()?;
    Ok(summary)
}

/// Writes a scene to any writer. An OBJ file gets no colours this way, as they need a second file: see
/// [`to_bytes`].
///
/// # Errors
/// As [`to_bytes`], and if `out` fails. Bytes written before an error are incomplete.
pub fn write_to(
    scene: &Scene,
    out: &mut impl Write,
    options: &WriteOptions,
) -> Result<WriteSummary, WriteError> {
    check::check_scene(scene)?;
    write_stream(scene, out, None, options)
}

fn write_stream(
    scene: &Scene,
    out: &mut impl Write,
    library: Option<&str>,
    options: &WriteOptions,
) -> Result<WriteSummary, WriteError> {
    let mut tally = Tally::default();
    let mut counter = Counter::new(BufWriter::with_capacity(1 << 16, out));
    match options.format {
        Format::StlBinary => stl::write_binary(scene, &mut counter, options, &mut tally)?,
        Format::StlAscii => stl::write_ascii(scene, &mut counter, options, &mut tally)?,
        Format::Glb => gltf::write_binary(scene, &mut counter, options, &mut tally)?,
        Format::Gltf => gltf::write_text(scene, &mut counter, options, &mut tally)?,
        Format::Obj => obj::write(scene, &mut counter, library, options, &mut tally)?,
        Format::Ply => ply::write(scene, &mut counter, options, &mut tally)?,
        Format::ThreeMf => {
            // The headers of an archive are completed after its contents, so the archive is made in memory.
            let mut archive = Cursor::new(Vec::new());
            threemf::write(scene, &mut archive, options, &mut tally)?;
            counter.write_all(archive.get_ref())?;
        }
    }
    counter.flush()?;
    Ok(tally.finish(counter.bytes, options))
}

/// The material library of an OBJ file, complete but not yet under its name, with that name; none without
/// colours.
fn new_library(
    scene: &Scene,
    path: &Path,
    options: &WriteOptions,
) -> Result<Option<(String, NewFile)>, WriteError> {
    if !obj::has_colors(scene, options) {
        return Ok(None);
    }
    let path = path.with_extension("mtl");
    let mut library = NewFile::create(&path)?;
    obj::write_library(scene, library.writer(), options)?;
    let name = path.file_name().map(OsStr::to_string_lossy).unwrap_or_default();
    Ok(Some((name.into_owned(), library)))
}
