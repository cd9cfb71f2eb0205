//! Arguments as Python users write them, as options of the library.

use crate::errors::argument;
use chordal::methods::{edge_method_named, strategy_named};
use chordal::{
    Bound as ErrorBound, InputFormat, MeshOptions, OutputFormat, Sewing, Tolerance, Unit, UpAxis, Winding,
    WriteOptions,
};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::time::Duration;

/// A number, or a text with a unit.
#[derive(FromPyObject)]
enum Quantity {
    Number(f64),
    Text(String),
}

impl Quantity {
    fn text(&self) -> String {
        match self {
            Quantity::Number(number) => number.to_string(),
            Quantity::Text(text) => text.clone(),
        }
    }
}

/// The names of the formats that are read: those of `--input-format`, and the extensions of files.
pub fn input_format(name: Option<&str>) -> PyResult<Option<InputFormat>> {
    let Some(name) = name else { return Ok(None) };
    let lower = name.trim_start_matches('.').to_ascii_lowercase();
    let found = match lower.as_str() {
        "inventor" => Some(InputFormat::Inventor),
        other => InputFormat::of_extension(other),
    };
    let names = "step, iges, brep, 3dm, inventor, x3d, obj, json";
    found.map(Some).ok_or_else(|| argument("format", format!("unknown format `{name}` (supported: {names})")))
}

/// Which points trimming loops keep.
pub fn winding(name: Option<&str>) -> PyResult<Option<Winding>> {
    match name {
        None => Ok(None),
        Some("odd") => Ok(Some(Winding::Odd)),
        Some("even") => Ok(Some(Winding::Even)),
        Some(other) => Err(argument("winding", format!("`{other}` is neither odd nor even"))),
    }
}

/// The name of a format that is written: its extension, or `stl-ascii`.
pub fn output_format(name: &str) -> PyResult<OutputFormat> {
    match name.to_ascii_lowercase().as_str() {
        "stl-ascii" => Ok(OutputFormat::StlAscii),
        other => OutputFormat::from_extension(other).ok_or_else(|| {
            let names = "stl, stl-ascii, ply, obj, glb, gltf, 3mf";
            argument("format", format!("unknown format `{name}` (supported: {names})"))
        }),
    }
}

/// How a mesh is written.
pub fn write_options(
    format: OutputFormat,
    unit: Option<&str>,
    up: Option<&str>,
    edges: bool,
) -> PyResult<WriteOptions> {
    let mut options = WriteOptions::new(format).with_edge_lines(edges);
    if edges && !format.is_gltf() {
        return Err(argument("edges", format!("needs GLB or glTF as output: {format} has no lines")));
    }
    if let Some(unit) = unit {
        options = options.with_unit(unit.parse::<Unit>().map_err(|e| argument("unit", e))?);
    }
    options.up = match up.map(str::to_ascii_lowercase).as_deref() {
        None => None,
        Some("y") => Some(UpAxis::Y),
        Some("z") => Some(UpAxis::Z),
        Some(other) => return Err(argument("up", format!("`{other}` is neither y nor z"))),
    };
    Ok(options)
}

/// The options of a mesh from keyword arguments; one that is unknown is refused by the caller's signature.
pub fn mesh_options(given: Option<&Bound<'_, PyDict>>) -> PyResult<MeshOptions> {
    let mut options = MeshOptions::default();
    for (name, value) in given.into_iter().flatten() {
        let name: String = name.extract()?;
        options = with_option(options, &name, &value)?;
    }
    Ok(options)
}

/// One option; `None` leaves the default, except for the angle.
fn with_option(options: MeshOptions, name: &str, value: &Bound<'_, PyAny>) -> PyResult<MeshOptions> {
    if name == "angle" {
        return Ok(options.with_angle(angle(value)?));
    }
    if value.is_none() {
        return Ok(options);
    }
    Ok(match name {
        "tolerance" => options.with_tolerance(tolerance(name, value)?),
        "boundary_tolerance" => options.with_boundary_tolerance(Some(tolerance(name, value)?)),
        "max_edge" => {
            let text = value.extract::<Quantity>()?.text();
            options.with_max_edge(Some(chordal::parse_length(&text).map_err(|e| argument(name, e))?))
        }
        "sew" => {
            let text = value.extract::<Quantity>()?.text();
            options.with_sewing(text.parse::<Sewing>().map_err(|e| argument(name, e))?)
        }
        "bound" => options.with_bound(bound(&value.extract::<String>()?)?),
        "strategy" => {
            let given: String = value.extract()?;
            let entry = strategy_named(&given);
            let entry = entry.ok_or_else(|| argument(name, format!("unknown strategy `{given}`")))?;
            options.with_fill_method(entry.fill_method())
        }
        "edge_method" => {
            let given: String = value.extract()?;
            let entry = edge_method_named(&given);
            let entry = entry.ok_or_else(|| argument(name, format!("unknown edge method `{given}`")))?;
            options.with_edge_splitter(entry.edge_splitter())
        }
        "output_format" => options.with_output_format(Some(output_format(&value.extract::<String>()?)?)),
        "self_intersections" => options.with_self_intersections(value.extract()?),
        "face_timeout" => options.with_face_timeout(seconds(name, value)?),
        "file_timeout" => options.with_file_timeout(seconds(name, value)?),
        "memory" => {
            let megabytes: u64 = value.extract()?;
            options.with_memory((megabytes > 0).then(|| megabytes.saturating_mul(1_000_000)))
        }
        _ => return Err(argument(name, "unknown option")),
    })
}

fn tolerance(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Tolerance> {
    let text = value.extract::<Quantity>()?.text();
    text.parse().map_err(|e| argument(name, e))
}

/// Degrees, or a text with a unit; `None` is no limit.
fn angle(value: &Bound<'_, PyAny>) -> PyResult<Option<f64>> {
    if value.is_none() {
        return Ok(None);
    }
    let text = value.extract::<Quantity>()?.text();
    chordal::parse_angle(&text).map_err(|e| argument("angle", e))
}

fn bound(name: &str) -> PyResult<ErrorBound> {
    match name {
        "proven" => Ok(ErrorBound::Proven),
        "estimated" => Ok(ErrorBound::Estimated),
        other => Err(argument("bound", format!("`{other}` is neither proven nor estimated"))),
    }
}

/// Seconds; 0 is no limit.
fn seconds(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Option<Duration>> {
    let seconds: f64 = value.extract()?;
    let time = Duration::try_from_secs_f64(seconds).map_err(|_| argument(name, "not a number of seconds"))?;
    Ok((!time.is_zero()).then_some(time))
}
