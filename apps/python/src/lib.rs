//! The native part of the Python package `chordal`: models, meshes, surfaces and curves as Python classes.

mod arguments;
mod curve;
mod errors;
mod grids;
mod job;
mod mesh;
mod model;
mod numbers;
mod part;
mod pool;
mod shared;
mod surface;

use pyo3::prelude::*;
use std::ffi::OsString;

/// Runs the command line; the first argument is the name of the program. Returns the exit code.
#[pyfunction]
fn run_command_line(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| chordal_cli::run(arguments))
}

/// The module `chordal._native`.
#[pymodule]
fn _native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    // Panics are caught and become exceptions or failed faces: nothing is printed.
    std::panic::set_hook(Box::new(chordal::tessellate::remember_panic));
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<model::Model>()?;
    module.add_class::<model::Node>()?;
    module.add_class::<model::Instance>()?;
    module.add_class::<part::Part>()?;
    module.add_class::<part::Face>()?;
    module.add_class::<part::Edge>()?;
    module.add_class::<mesh::Mesh>()?;
    module.add_class::<mesh::Polyline>()?;
    module.add_class::<mesh::Written>()?;
    module.add_class::<surface::Surface>()?;
    module.add_class::<surface::BezierPatch>()?;
    module.add_class::<curve::Curve>()?;
    module.add_function(wrap_pyfunction!(model::read, module)?)?;
    module.add_function(wrap_pyfunction!(run_command_line, module)?)?;
    Ok(())
}
