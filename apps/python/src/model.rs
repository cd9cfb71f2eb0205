//! Models: reading, the tree, and meshing.

use crate::arguments::{input_format, mesh_options, winding};
use crate::job::Caller;
use crate::mesh::Mesh;
use crate::numbers::matrix;
use crate::part::{Edge, Face, Part};
use crate::shared::Shared;
use chordal::{Cancel, Mesher, ReadOptions};
use numpy::PyArrayDyn;
use pyo3::prelude::*;
use pyo3::pybacked::PyBackedBytes;
use pyo3::types::{PyDict, PyTuple};
use std::iter;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::Arc;

/// A CAD model: what a file holds, exactly.
#[pyclass(frozen, module = "chordal")]
#[derive(Debug)]
pub struct Model(pub Arc<Shared>);

/// Reads a file or its bytes. `name` names the bytes in messages.
#[pyfunction]
#[pyo3(signature = (path, content, name, format, winding, progress))]
pub fn read(
    py: Python<'_>,
    path: Option<PathBuf>,
    content: Option<PyBackedBytes>,
    name: &str,
    format: Option<&str>,
    winding: Option<&str>,
    progress: Option<Bound<'_, PyAny>>,
) -> PyResult<Model> {
    let format = input_format(format)?;
    let options = ReadOptions::default().with_winding(self::winding(winding)?);
    let input = path.as_ref().map_or_else(|| name.to_owned(), |path| path.display().to_string());
    let options = if path.is_some() { options } else { options.with_name(name) };
    let caller = Caller { py, input, progress, threads: None };
    caller.tell("reading", 0.0)?;
    let model = caller.run(&Cancel::default(), move |_| match (path, content) {
        (Some(path), _) => chordal::Model::open_with(path, format, &options),
        (None, content) => {
            chordal::Model::from_bytes_with(content.as_deref().unwrap_or_default(), format, &options)
        }
    })?;
    caller.tell("reading", 1.0)?;
    Ok(Model(Arc::new(Shared::new(model))))
}

#[pymethods]
impl Model {
    /// The name that the file gives the model; may be empty.
    #[getter]
    fn name(&self) -> &str {
        &self.0.model.brep().name
    }

    /// The path of the file, or the name that the caller gave.
    #[getter]
    fn source(&self) -> &str {
        self.0.model.name()
    }

    /// Format and version as the file states them.
    #[getter]
    fn format(&self) -> &str {
        self.0.model.format()
    }

    /// The file's unit of length, such as `mm`.
    #[getter]
    fn unit(&self) -> &str {
        self.0.model.unit()
    }

    /// The parts, each once however often it is placed.
    #[getter]
    fn parts(&self) -> Vec<Part> {
        (0..self.0.model.brep().parts.len()).map(|index| Part { shared: self.0.clone(), index }).collect()
    }

    /// The faces of all parts, each once, in the order of the file. A face's number is its index here.
    #[getter]
    fn faces(&self) -> Vec<Face> {
        self.parts().iter().flat_map(Part::all_faces).collect()
    }

    /// The edges of all parts, each once.
    #[getter]
    fn edges(&self) -> Vec<Edge> {
        self.parts().iter().flat_map(Part::all_edges).collect()
    }

    /// Every placed part, depth first in the order of the tree.
    #[getter]
    fn instances(&self) -> Vec<Instance> {
        let placements = self.0.model.brep().placements();
        let all = placements.into_iter().enumerate();
        all.map(|(index, placed)| Instance { shared: self.0.clone(), index, placed }).collect()
    }

    /// The assembly, from its roots.
    #[getter]
    fn tree(&self) -> Vec<Node> {
        let roots = self.0.model.brep().roots.iter();
        roots.map(|id| Node { shared: self.0.clone(), index: id.index() }).collect()
    }

    /// Meshes the model: `chordal.Model.mesh` in `_native.pyi`.
    #[pyo3(signature = (*arguments, **options))]
    fn mesh<'py>(
        slf: &Bound<'py, Self>,
        arguments: &Bound<'py, PyTuple>,
        options: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let all: Vec<Bound<'py, PyAny>> = iter::once(slf.as_any().clone()).chain(arguments.iter()).collect();
        let mesh = slf.py().import("chordal._api")?.getattr("mesh_model")?;
        mesh.call(PyTuple::new(slf.py(), all)?, options)
    }

    /// What is in the file: tree, parts, faces by kind, gaps, problems; as `chordal info --json`.
    #[getter]
    fn info<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("chordal._api")?.call_method1("info_of", (slf,))
    }

    /// What the reader repaired, guessed or dropped, and the faces that it could not read.
    #[getter]
    fn problems<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("chordal._api")?.call_method1("problems_of", (slf,))
    }

    /// What `chordal info` shows, as JSON.
    fn info_json(&self, py: Python<'_>) -> PyResult<String> {
        let model = self.0.model.clone();
        Caller::quiet(py, self.source()).run(&Cancel::default(), move |_| {
            serde_json::to_string(&model.info())
                .map_err(|error| chordal::Error::Bug { message: error.to_string() })
        })
    }

    /// What the reader repaired, guessed or dropped, as JSON.
    fn problems_json(&self) -> PyResult<String> {
        let problems = serde_json::to_string(&self.0.model.problems());
        problems.map_err(|error| crate::errors::internal(&error.to_string()))
    }

    /// The whole exact model as Chordal's own JSON, without loss.
    fn to_json(&self, py: Python<'_>) -> PyResult<String> {
        let model = self.0.model.clone();
        Caller::quiet(py, "").run(&Cancel::default(), move |_| model.to_json())
    }

    /// Meshes the model; `options` as `chordal.Model.mesh` documents them.
    fn mesh_with(
        slf: &Bound<'_, Self>,
        options: Option<&Bound<'_, PyDict>>,
        threads: Option<usize>,
        progress: Option<Bound<'_, PyAny>>,
    ) -> PyResult<Mesh> {
        let (py, shared) = (slf.py(), &slf.get().0);
        let options = mesh_options(options)?;
        let model = shared.model.clone();
        let cancel = Cancel::default();
        let caller = Caller { py, input: model.name().to_owned(), progress, threads };
        let flag = cancel.clone();
        let (meshed, arrays) = caller.run(&cancel, move |listener| {
            let listener = Arc::new(listener);
            let told = listener.clone();
            let tell = move |phase, fraction| {
                told.tell(phase, fraction);
                ControlFlow::Continue(())
            };
            let meshed = Mesher::new(options).with_cancel(flag).with_progress(tell).mesh(&model)?;
            let arrays = meshed.arrays()?;
            Ok((Arc::new(meshed), arrays))
        })?;
        Mesh::new(slf.as_any(), shared.clone(), meshed, arrays)
    }

    fn __repr__(&self) -> String {
        let model = &self.0.model;
        format!(
            "<chordal.Model {:?}: {} parts, {} faces, {}>",
            model.name(),
            model.brep().parts.len(),
            self.0.first_faces.last().copied().unwrap_or(0),
            model.format()
        )
    }
}

/// One placed part.
#[pyclass(frozen, module = "chordal")]
#[derive(Debug)]
pub struct Instance {
    shared: Arc<Shared>,
    index: usize,
    placed: chordal::brep::Placement,
}

#[pymethods]
impl Instance {
    /// Its number: its index in `Model.instances`.
    #[getter]
    fn index(&self) -> usize {
        self.index
    }

    /// The name of its node in the tree; may be empty.
    #[getter]
    fn name(&self) -> &str {
        &self.shared.model.brep().nodes[self.placed.node.index()].name
    }

    /// The part.
    #[getter]
    fn part(&self) -> Part {
        Part { shared: self.shared.clone(), index: self.placed.part.index() }
    }

    /// From the part's coordinates to millimetres of the assembled model, as a matrix (4, 4).
    #[getter]
    fn transform<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        matrix(py, &self.placed.world)
    }

    fn __repr__(&self) -> String {
        format!("<chordal.Instance {} of part {}>", self.index, self.placed.part.0)
    }
}

/// One occurrence in the assembly tree.
#[pyclass(frozen, module = "chordal")]
#[derive(Debug)]
pub struct Node {
    shared: Arc<Shared>,
    index: usize,
}

impl Node {
    fn node(&self) -> &chordal::brep::Node {
        &self.shared.model.brep().nodes[self.index]
    }
}

#[pymethods]
impl Node {
    /// Its name; may be empty.
    #[getter]
    fn name(&self) -> &str {
        &self.node().name
    }

    /// The part that stands here.
    #[getter]
    fn part(&self) -> Option<Part> {
        self.node().part.map(|part| Part { shared: self.shared.clone(), index: part.index() })
    }

    /// What is below it.
    #[getter]
    fn children(&self) -> Vec<Node> {
        let children = self.node().children.iter();
        children.map(|id| Node { shared: self.shared.clone(), index: id.index() }).collect()
    }

    /// To the parent's coordinates, of a root to millimetres, as a matrix (4, 4).
    #[getter]
    fn transform<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        matrix(py, &self.node().transform)
    }

    /// Red, green, blue and opacity, linear, 0 to 1; it overrides the colours of everything below.
    #[getter]
    fn color(&self) -> Option<[f32; 4]> {
        self.node().color.map(|color| color.0)
    }

    fn __repr__(&self) -> String {
        format!("<chordal.Node {:?}>", self.name())
    }
}
