//! Chordal as a WebAssembly module, without any binding generator.
//!
//! The host copies the bytes of a CAD file into memory that [`chordal_allocate`] gives, calls
//! [`chordal_mesh`], and reads the result where [`chordal_result`] and [`chordal_result_length`] say.
//! `mesh.mjs` does it in JavaScript.
//!
//! One module serves one call at a time: a WebAssembly module without threads has no others.
#![expect(unsafe_code, reason = "exported symbols and a buffer that the host writes to")]

use chordal::{Error, MeshOptions, Mesher, Model, OutputFormat, Tolerance};
use std::cell::RefCell;

thread_local! {
    /// The buffers that the host writes and reads.
    static INPUT: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
    static RESULT: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
}

/// Gives `length` bytes of memory for the input. They stay valid until the next call.
// SAFETY of the symbol: no other library of this module exports the name.
#[unsafe(no_mangle)]
pub extern "C" fn chordal_allocate(length: usize) -> *mut u8 {
    INPUT.with_borrow_mut(|input| {
        input.clear();
        input.resize(length, 0);
        input.as_mut_ptr()
    })
}

/// Meshes the input and makes a PLY file (`format` 0) or a GLB file (`format` 1) of it, with a tolerance in
/// millimetres.
///
/// Returns 0 where the mesh has no problem, 1 where its report has errors (the file is the result all the
/// same), 2 where there is no mesh: then the result is one sentence.
#[unsafe(no_mangle)]
pub extern "C" fn chordal_mesh(tolerance_mm: f64, format: u32) -> u32 {
    let format = if format == 1 { OutputFormat::Glb } else { OutputFormat::Ply };
    let (code, bytes) = match INPUT.with_borrow(|input| mesh(input, tolerance_mm, format)) {
        Ok((clean, bytes)) => (u32::from(!clean), bytes),
        Err(error) => (2, error.to_string().into_bytes()),
    };
    RESULT.set(bytes);
    code
}

/// Where the result is.
#[unsafe(no_mangle)]
pub extern "C" fn chordal_result() -> *const u8 {
    RESULT.with_borrow(|result| result.as_ptr())
}

/// How many bytes the result has.
#[unsafe(no_mangle)]
pub extern "C" fn chordal_result_length() -> usize {
    RESULT.with_borrow(Vec::len)
}

fn mesh(input: &[u8], tolerance_mm: f64, format: OutputFormat) -> Result<(bool, Vec<u8>), Error> {
    let options = MeshOptions::default()
        .with_tolerance(Tolerance::Millimetres(tolerance_mm))
        .with_output_format(Some(format));
    let meshed = Mesher::new(options).mesh(&Model::from_bytes(input, None)?)?;
    Ok((meshed.report().clean, meshed.to_bytes(format)?))
}
