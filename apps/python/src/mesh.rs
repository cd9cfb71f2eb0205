//! Meshes: arrays, files, the report.

use crate::arguments::{output_format, write_options};
use crate::errors::of_input;
use crate::grids;
use crate::job::Caller;
use crate::numbers::{array, points};
use crate::shared::Shared;
use chordal::write::WriteSummary;
use chordal::{Arrays, Cancel, Error, Meshed, OutputFormat, RequestError};
use numpy::{Element, PyArrayDyn};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyBytes;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The most points of a grid: a hundred times a usual one, squared.
const LARGEST_GRID: usize = 1_000_000;

type Doubles = Py<PyArrayDyn<f64>>;

/// The mesh of a model, audited, with its report.
#[pyclass(frozen, module = "chordal", weakref)]
pub struct Mesh {
    model: Py<PyAny>,
    shared: Arc<Shared>,
    pub meshed: Arc<Meshed>,
    vertices: Doubles,
    triangles: Py<PyArrayDyn<u32>>,
    faces: Py<PyArrayDyn<i32>>,
    parts: Py<PyArrayDyn<u32>>,
    instances: Py<PyArrayDyn<u32>>,
    placed_faces: PyOnceLock<Py<PyArrayDyn<i32>>>,
    normals: PyOnceLock<Doubles>,
    uv: PyOnceLock<Doubles>,
    report: PyOnceLock<Py<PyAny>>,
}

impl Mesh {
    pub fn new(
        model: &Bound<'_, PyAny>,
        shared: Arc<Shared>,
        meshed: Arc<Meshed>,
        arrays: Arrays,
    ) -> PyResult<Self> {
        let py = model.py();
        let count = arrays.triangles.len();
        // Faces that are none, the largest number, are -1.
        let faces = arrays.faces.into_iter().map(|face| face as i32).collect();
        Ok(Self {
            model: model.clone().unbind(),
            shared,
            meshed,
            vertices: points(py, arrays.positions)?.unbind(),
            triangles: array(py, arrays.triangles.into_flattened(), &[count, 3])?.unbind(),
            faces: array(py, faces, &[count])?.unbind(),
            parts: array(py, arrays.parts, &[count])?.unbind(),
            instances: array(py, arrays.placements, &[count])?.unbind(),
            placed_faces: PyOnceLock::new(),
            normals: PyOnceLock::new(),
            uv: PyOnceLock::new(),
            report: PyOnceLock::new(),
        })
    }

    /// The face of every triangle, counted over all instances.
    fn placed_faces(&self) -> Vec<i32> {
        let parts = self.shared.model.brep().placements();
        let firsts: Vec<i32> = parts
            .iter()
            .scan(0, |sum, placed| {
                let first = *sum;
                *sum += self.shared.model.brep().parts[placed.part.index()].faces.len() as i32;
                Some(first)
            })
            .collect();
        let number = |triangle: chordal::Triangle| {
            triangle.face.map_or(-1, |face| firsts[triangle.placement] + face.0 as i32)
        };
        self.meshed.triangles().map(number).collect()
    }

    /// One row per corner of every triangle.
    fn corners<const N: usize>(
        &self,
        py: Python<'_>,
        of: impl Fn(&chordal::Triangle) -> [[f64; N]; 3] + Sync,
    ) -> PyResult<Doubles> {
        let corners: Vec<[f64; N]> =
            py.detach(|| self.meshed.triangles().flat_map(|triangle| of(&triangle)).collect());
        let count = corners.len() / 3;
        Ok(array(py, corners.into_flattened(), &[count, 3, N])?.unbind())
    }
}

fn shown<'py, T: Element>(py: Python<'py>, array: &Py<PyArrayDyn<T>>) -> Bound<'py, PyArrayDyn<T>> {
    array.bind(py).clone()
}

#[pymethods]
impl Mesh {
    /// The model that was meshed.
    #[getter]
    fn model(&self, py: Python<'_>) -> Py<PyAny> {
        self.model.clone_ref(py)
    }

    /// The vertices in millimetres of the assembled model: float64 (n, 3), read-only.
    #[getter]
    fn vertices<'py>(&self, py: Python<'py>) -> Bound<'py, PyArrayDyn<f64>> {
        shown(py, &self.vertices)
    }

    /// Indices into `vertices`: uint32 (m, 3), counter-clockwise seen from outside, read-only. Neighbouring
    /// triangles share their vertices.
    #[getter]
    fn triangles<'py>(&self, py: Python<'py>) -> Bound<'py, PyArrayDyn<u32>> {
        shown(py, &self.triangles)
    }

    /// The exact unit normals of the face at every corner: float64 (m, 3, 3), read-only.
    #[getter]
    fn normals<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let made = self.normals.get_or_try_init(py, || self.corners(py, |t| t.normals.map(|n| n.to_array())));
        made.map(|normals| shown(py, normals))
    }

    /// Where every corner lies in the parameters of its face: float64 (m, 3, 2), read-only.
    #[getter]
    fn uv<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let made = self.uv.get_or_try_init(py, || self.corners(py, |t| t.uv.map(|uv| uv.to_array())));
        made.map(|uv| shown(py, uv))
    }

    /// The face of every triangle, a number of `Model.faces`: int32 (m,), read-only; -1 for triangles that
    /// were in the file already.
    #[getter]
    fn face_of_triangle<'py>(&self, py: Python<'py>) -> Bound<'py, PyArrayDyn<i32>> {
        shown(py, &self.faces)
    }

    /// The face of every triangle, where the faces of every instance count: int32 (m,), read-only. The faces of
    /// all instances are counted one behind the other; -1 for triangles that were in the file already.
    #[getter]
    fn placed_face_of_triangle<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<i32>>> {
        let made = self.placed_faces.get_or_try_init(py, || -> PyResult<Py<PyArrayDyn<i32>>> {
            let faces: Vec<i32> = py.detach(|| self.placed_faces());
            let count = faces.len();
            Ok(array(py, faces, &[count])?.unbind())
        });
        made.map(|faces| shown(py, faces))
    }

    /// The part of every triangle, a number of `Model.parts`: uint32 (m,), read-only.
    #[getter]
    fn part_of_triangle<'py>(&self, py: Python<'py>) -> Bound<'py, PyArrayDyn<u32>> {
        shown(py, &self.parts)
    }

    /// The instance of every triangle, a number of `Model.instances`: uint32 (m,), read-only.
    #[getter]
    fn instance_of_triangle<'py>(&self, py: Python<'py>) -> Bound<'py, PyArrayDyn<u32>> {
        shown(py, &self.instances)
    }

    /// The edges of the model as polylines, as placed.
    #[getter]
    fn edges(&self, py: Python<'_>) -> PyResult<Vec<Polyline>> {
        let found: Vec<chordal::Polyline> = py.detach(|| self.meshed.edges().collect());
        found.into_iter().map(|line| Polyline::new(py, &self.shared, line)).collect()
    }

    /// A grid over every face: float64 (faces, nu, nv, 7): the point, the outward normal, and 1 inside the loops
    /// or 0 outside; in the coordinates of the part.
    #[pyo3(signature = (nu = 10, nv = 10))]
    fn uv_grids<'py>(&self, py: Python<'py>, nu: usize, nv: usize) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        if nu == 0 || nv == 0 || nu.saturating_mul(nv) > LARGEST_GRID {
            let why = format!("{nu} by {nv} is not between 1 and {LARGEST_GRID} points");
            return Err(crate::errors::argument("nu, nv", why));
        }
        let values = py.detach(|| grids::all(&self.meshed, &self.shared.first_faces, [nu, nv]));
        let faces = self.shared.first_faces.last().copied().unwrap_or(0);
        array(py, values, &[faces, nu, nv, grids::CHANNELS])
    }

    /// The report, as `docs/report.md` documents it.
    #[getter]
    fn report(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        let made = self.report.get_or_try_init(py, || -> PyResult<Py<PyAny>> {
            let text = py.detach(|| self.meshed.report().to_json());
            Ok(py.import("json")?.call_method1("loads", (text,))?.unbind())
        });
        made.map(|report| report.clone_ref(py))
    }

    /// The largest proven distance between the exact faces and their triangles in millimetres; `None` where no
    /// face has a proof.
    #[getter]
    fn proven_error(&self) -> Option<f64> {
        self.meshed.report().proven_error
    }

    /// The largest distance between a vertex and the exact surface of a face that uses it: the inaccuracy of
    /// the file, in millimetres.
    #[getter]
    fn gap(&self) -> f64 {
        self.meshed.report().max_edge_gap
    }

    /// Whether no problem is an error: exit code 0 of the command line.
    #[getter]
    fn clean(&self) -> bool {
        self.meshed.report().clean
    }

    /// Whether every shell is closed.
    #[getter]
    fn watertight(&self) -> bool {
        self.meshed.report().closedness == Some(chordal::Closedness::Closed)
    }

    /// A `trimesh.Scene`: one geometry for each placed part, with its name and the faces of its triangles.
    fn to_trimesh<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        converted(slf, "to_trimesh")
    }

    /// A `pyvista.PolyData` with the cell arrays `face`, `part` and `instance`.
    fn to_pyvista<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        converted(slf, "to_pyvista")
    }

    /// An `open3d.geometry.TriangleMesh`.
    fn to_open3d<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        converted(slf, "to_open3d")
    }

    /// A `meshio.Mesh` with the cell data `face`, `part` and `instance`.
    fn to_meshio<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        converted(slf, "to_meshio")
    }

    /// One line per problem: its severity, its sentence.
    fn problem_sentences(&self) -> Vec<(&'static str, String)> {
        let problems = &self.meshed.report().problems;
        problems.iter().map(|problem| (problem.severity.name(), problem.sentence())).collect()
    }

    /// Writes a file; the format is that of the extension unless one is given.
    #[pyo3(signature = (path, format = None, *, unit = None, up = None, edges = false))]
    fn save(
        &self,
        py: Python<'_>,
        path: PathBuf,
        format: Option<&str>,
        unit: Option<&str>,
        up: Option<&str>,
        edges: bool,
    ) -> PyResult<Written> {
        let format = match format {
            Some(name) => output_format(name)?,
            None => format_of(&path)?,
        };
        let options = write_options(format, unit, up, edges)?;
        let (meshed, target) = (self.meshed.clone(), path.clone());
        let job = move |_| meshed.write_with(target, &options);
        let summary = Caller::quiet(py, "").run(&Cancel::default(), job)?;
        Ok(Written::new(path, &summary))
    }

    /// The bytes of a mesh file.
    #[pyo3(signature = (format = "glb", *, unit = None, up = None, edges = false))]
    fn to_bytes<'py>(
        &self,
        py: Python<'py>,
        format: &str,
        unit: Option<&str>,
        up: Option<&str>,
        edges: bool,
    ) -> PyResult<Bound<'py, PyBytes>> {
        let options = write_options(output_format(format)?, unit, up, edges)?;
        let meshed = self.meshed.clone();
        let job = move |_| meshed.to_bytes_with(&options);
        let encoded = Caller::quiet(py, "").run(&Cancel::default(), job)?;
        Ok(PyBytes::new(py, &encoded.bytes))
    }

    fn __repr__(&self) -> String {
        let report = self.meshed.report();
        format!(
            "<chordal.Mesh {:?}: {} triangles, {}, {}>",
            report.input.path,
            report.triangles,
            report.proof_sentence(),
            report.closedness_sentence()
        )
    }
}

/// The mesh in the class of another package.
fn converted<'py>(mesh: &Bound<'py, Mesh>, function: &str) -> PyResult<Bound<'py, PyAny>> {
    mesh.py().import("chordal._convert")?.call_method1(function, (mesh,))
}

/// The format that the extension of a path names.
fn format_of(path: &Path) -> PyResult<OutputFormat> {
    let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default();
    OutputFormat::from_extension(extension).ok_or_else(|| {
        let supported = "stl, ply, obj, glb, gltf, 3mf";
        let error = Error::Request(RequestError::OutputExtension { path: path.to_owned(), supported });
        of_input("", &error)
    })
}

/// An edge of the model as a polyline, as placed.
#[pyclass(frozen, get_all, module = "chordal")]
#[derive(Debug)]
pub struct Polyline {
    /// The points in millimetres: float64 (n, 3), vertices of the triangles beside it.
    points: Doubles,
    /// The edge, a number of `Model.edges`.
    edge: usize,
    /// The part, a number of `Model.parts`.
    part: usize,
    /// The instance, a number of `Model.instances`.
    instance: usize,
}

impl Polyline {
    fn new(py: Python<'_>, shared: &Shared, line: chordal::Polyline) -> PyResult<Self> {
        let part = line.part.index();
        Ok(Self {
            points: points(py, line.points.iter().map(|p| p.to_array()).collect())?.unbind(),
            edge: shared.first_edges[part] + line.edge.index(),
            part,
            instance: line.placement,
        })
    }
}

/// What was written.
#[pyclass(frozen, get_all, module = "chordal")]
#[derive(Debug)]
pub struct Written {
    /// The file.
    path: PathBuf,
    /// Its triangles, with every instance counted.
    triangles: u64,
    /// Its size in bytes.
    bytes: u64,
    /// The largest distance in millimetres by which rounding to 32 bits moved a vertex.
    rounding: f64,
    /// What the file's user should know.
    warnings: Vec<String>,
}

impl Written {
    fn new(path: PathBuf, summary: &WriteSummary) -> Self {
        Self {
            path,
            triangles: summary.triangles,
            bytes: summary.bytes,
            rounding: summary.rounding_mm,
            warnings: summary.warnings.iter().map(ToString::to_string).collect(),
        }
    }
}
