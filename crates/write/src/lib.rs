//! Writers of mesh files: STL, GLB, OBJ, PLY and 3MF from one [`Scene`].
//!
//! A vertex's file coordinates are its part's, times the placement (millimetres), times the change of unit and axes, all
//! in 64 bits; only then a 32-bit format rounds. The same scene and options give the same bytes.
//! `docs/formats.md` says what each format carries.

mod check;
mod color;
mod error;
mod flat;
mod format;
mod frame;
mod glb;
mod names;
mod number;
mod obj;
mod options;
mod ply;
mod sink;
mod stl;
mod summary;
mod threemf;

pub use error::WriteError;
pub use format::{Format, SolidPer, Unit, UnknownUnit, UpAxis};
pub use options::WriteOptions;
pub use summary::WriteSummary;

use chordal_mesh::Scene;
use sink::{Counter, NewFile};
use std::ffi::OsStr;
use std::io::{BufWriter, Cursor, Write};
use std::path::Path;
use summary::Tally;

/// Writes a scene to a file, which is replaced only once the new one is complete. OBJ puts its colours, if there are
/// any, into a material library of the same name beside it.
///
/// # Errors
/// Where the file cannot be written, a coordinate is not finite, the format cannot hold as many triangles, or the scene
/// contradicts itself. The file at `path`, if any, is untouched then.
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
    // The library first: a mesh never names colours that are not there yet.
    if let Some((_, library)) = library {
        library.commit()?;
    }
    file.commit()?;
    Ok(summary)
}

/// Writes a scene to any writer. OBJ gets no colours this way: they live in a second file.
///
/// # Errors
/// As [`write_scene`]; what was written before an error is incomplete.
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
        Format::Glb => glb::write(scene, &mut counter, options, &mut tally)?,
        Format::Obj => obj::write(scene, &mut counter, library, options, &mut tally)?,
        Format::Ply => ply::write(scene, &mut counter, options, &mut tally)?,
        Format::ThreeMf => {
            // An archive's headers are completed after its contents, so it is made in memory, compressed.
            let mut archive = Cursor::new(Vec::new());
            threemf::write(scene, &mut archive, options, &mut tally)?;
            counter.write_all(archive.get_ref())?;
        }
    }
    counter.flush()?;
    Ok(tally.finish(counter.bytes, options))
}

/// The complete but not yet visible material library of an OBJ file, with its name; none without colours.
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
