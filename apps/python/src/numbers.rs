//! Lists of Rust as arrays of numpy, which own them, and the other way round.

use chordal::math::{DVec2, DVec3};
use numpy::ndarray::{Array, ArrayD, IxDyn};
use numpy::{Element, PyArrayDyn, PyReadonlyArrayDyn, ToPyArray};
use pyo3::prelude::*;

/// A list as a read-only array of this shape, whose first length is that of the list. Nothing is copied.
///
/// # Errors
/// Where the shape does not fit the list.
pub fn array<'py, T: Element>(
    py: Python<'py>,
    values: Vec<T>,
    shape: &[usize],
) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
    let array = Array::from_shape_vec(IxDyn(shape), values);
    let array = array.map_err(|e| crate::errors::internal(&format!("an array has another shape: {e}")))?;
    let array = PyArrayDyn::from_owned_array(py, array);
    read_only(&array)?;
    Ok(array)
}

/// Forbids to write to an array.
fn read_only<T: Element>(array: &Bound<'_, PyArrayDyn<T>>) -> PyResult<()> {
    array.call_method1("setflags", (false,)).map(|_| ())
}

/// Points as an array (n, 3).
///
/// # Errors
/// None that a caller could cause.
pub fn points<'py>(py: Python<'py>, points: Vec<[f64; 3]>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let count = points.len();
    array(py, points.into_flattened(), &[count, 3])
}

/// Whatever numpy makes an array of doubles of.
///
/// # Errors
/// Where numpy makes none, or where its last length is not `columns`.
pub fn doubles(value: &Bound<'_, PyAny>, name: &str, columns: Option<usize>) -> PyResult<ArrayD<f64>> {
    let numpy = value.py().import("numpy")?;
    let array = numpy.call_method1("asarray", (value, "float64"));
    let array = array.map_err(|e| crate::errors::argument(name, e.value(value.py())))?;
    let array: PyReadonlyArrayDyn<'_, f64> = array.extract()?;
    let array = array.as_array().to_owned();
    match columns {
        Some(columns) if array.shape().last() != Some(&columns) => Err(crate::errors::argument(
            name,
            format!("an array of shape {:?} does not end in {columns} columns", array.shape()),
        )),
        _ => Ok(array),
    }
}

/// The rows of an array whose last length is 3, and its other lengths.
pub fn rows3(array: &ArrayD<f64>) -> (Vec<DVec3>, Vec<usize>) {
    let flat: Vec<f64> = array.iter().copied().collect();
    let rows = flat.chunks_exact(3).map(|row| DVec3::new(row[0], row[1], row[2])).collect();
    (rows, outer_shape(array))
}

/// The rows of an array whose last length is 2, and its other lengths.
pub fn rows2(array: &ArrayD<f64>) -> (Vec<DVec2>, Vec<usize>) {
    let flat: Vec<f64> = array.iter().copied().collect();
    (flat.chunks_exact(2).map(|row| DVec2::new(row[0], row[1])).collect(), outer_shape(array))
}

fn outer_shape(array: &ArrayD<f64>) -> Vec<usize> {
    array.shape()[..array.ndim().saturating_sub(1)].to_vec()
}

/// A shape with one more length at its end.
pub fn with_last(shape: &[usize], last: usize) -> Vec<usize> {
    shape.iter().copied().chain([last]).collect()
}

/// A copy of a list as a writable array.
pub fn copied<'py>(py: Python<'py>, values: &[f64]) -> Bound<'py, numpy::PyArray1<f64>> {
    values.to_pyarray(py)
}

/// A matrix (4, 4) of an affine map; points are columns.
///
/// # Errors
/// None that a caller could cause.
pub fn matrix<'py>(py: Python<'py>, map: &chordal::math::DAffine3) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let m = &map.matrix3;
    let rows = [0, 1, 2].map(|i| [m.x_axis[i], m.y_axis[i], m.z_axis[i], map.translation[i]]);
    let values = rows.iter().flatten().copied().chain([0.0, 0.0, 0.0, 1.0]).collect();
    array(py, values, &[4, 4])
}
