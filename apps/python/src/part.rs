//! Parts, faces and edges of a model.

use crate::curve::Curve;
use crate::numbers::points;
use crate::shared::Shared;
use crate::surface::Surface;
use chordal::brep::{BodyKind, FaceGeometry, Loop, Source};
use numpy::PyArrayDyn;
use pyo3::prelude::*;
use std::sync::Arc;

/// One part, in its own coordinates and units.
#[pyclass(frozen, module = "chordal")]
#[derive(Clone, Debug)]
pub struct Part {
    pub shared: Arc<Shared>,
    pub index: usize,
}

impl Part {
    pub fn exact(&self) -> &chordal::brep::Part {
        &self.shared.model.brep().parts[self.index]
    }

    pub fn all_faces(&self) -> Vec<Face> {
        (0..self.exact().faces.len()).map(|index| Face { part: self.clone(), index }).collect()
    }

    pub fn all_edges(&self) -> Vec<Edge> {
        (0..self.exact().edges.len()).map(|index| Edge { part: self.clone(), index }).collect()
    }

    fn bodies(&self, kind: BodyKind) -> usize {
        self.exact().bodies.iter().filter(|body| body.kind == kind).count()
    }
}

/// `#123`; `None` where the format has no numbers.
fn entity(source: Source) -> Option<String> {
    (source.entity > 0).then(|| format!("#{}", source.entity))
}

#[pymethods]
impl Part {
    /// Its number: its index in `Model.parts`.
    #[getter]
    fn index(&self) -> usize {
        self.index
    }

    /// Its name; may be empty.
    #[getter]
    fn name(&self) -> &str {
        &self.exact().name
    }

    /// The entity in the file, `#123`.
    #[getter]
    fn entity(&self) -> Option<String> {
        entity(self.exact().source)
    }

    /// Red, green, blue and opacity, linear, 0 to 1.
    #[getter]
    fn color(&self) -> Option<[f32; 4]> {
        self.exact().color.map(|color| color.0)
    }

    /// Its faces, in the order of the file.
    #[getter]
    fn faces(&self) -> Vec<Face> {
        self.all_faces()
    }

    /// Its edges.
    #[getter]
    fn edges(&self) -> Vec<Edge> {
        self.all_edges()
    }

    /// Its vertices (n, 3).
    #[getter]
    fn vertices<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        points(py, self.exact().vertices.iter().map(|vertex| vertex.point.to_array()).collect())
    }

    /// The number of solid bodies.
    #[getter]
    fn solid_count(&self) -> usize {
        self.bodies(BodyKind::Solid)
    }

    /// The number of sheet bodies.
    #[getter]
    fn sheet_count(&self) -> usize {
        self.bodies(BodyKind::Sheet)
    }

    /// Pairs of faces that share an edge, with the edge: an array (n, 3) of numbers of `Model.faces` and
    /// `Model.edges`, in the order of the edges.
    fn adjacency<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<u32>>> {
        let part = self.exact();
        let mut users: Vec<Vec<usize>> = vec![Vec::new(); part.edges.len()];
        for (index, face) in part.faces.iter().enumerate() {
            for edge in edges_of(face) {
                if users[edge].last() != Some(&index) {
                    users[edge].push(index);
                }
            }
        }
        let (first_face, first_edge) =
            (self.shared.first_faces[self.index], self.shared.first_edges[self.index]);
        let mut rows: Vec<[u32; 3]> = Vec::new();
        for (edge, faces) in users.iter().enumerate() {
            for (i, a) in faces.iter().enumerate() {
                let pair = |b: &usize| [first_face + a, first_face + b, first_edge + edge].map(|n| n as u32);
                rows.extend(faces[i + 1..].iter().map(pair));
            }
        }
        let count = rows.len();
        crate::numbers::array(py, rows.into_flattened(), &[count, 3])
    }

    fn __repr__(&self) -> String {
        let part = self.exact();
        format!("<chordal.Part {} {:?}: {} faces>", self.index, part.name, part.faces.len())
    }
}

/// The edges that a face uses, by their indices in the part; twice where it uses one twice.
fn edges_of(face: &chordal::brep::Face) -> Vec<usize> {
    let of_loop = |a_loop: &Loop| match a_loop {
        Loop::Edges { coedges, .. } => coedges.iter().map(|coedge| coedge.edge.index()).collect(),
        _ => Vec::new(),
    };
    face.loops.iter().flat_map(of_loop).collect()
}

/// One face of a part, as the file has it.
#[pyclass(frozen, module = "chordal")]
#[derive(Clone, Debug)]
pub struct Face {
    pub part: Part,
    pub index: usize,
}

impl Face {
    pub fn exact(&self) -> &chordal::brep::Face {
        &self.part.exact().faces[self.index]
    }
}

#[pymethods]
impl Face {
    /// Its number: its index in `Model.faces`, which `Mesh.face_of_triangle` has.
    #[getter]
    fn index(&self) -> usize {
        self.part.shared.first_faces[self.part.index] + self.index
    }

    /// Its index among the faces of its part.
    #[getter]
    fn index_in_part(&self) -> usize {
        self.index
    }

    /// The part that it belongs to.
    #[getter]
    fn part(&self) -> Part {
        self.part.clone()
    }

    /// Its name; may be empty.
    #[getter]
    fn name(&self) -> &str {
        &self.exact().name
    }

    /// Red, green, blue and opacity, linear, 0 to 1: its own colour, not that of its body or part.
    #[getter]
    fn color(&self) -> Option<[f32; 4]> {
        self.exact().color.map(|color| color.0)
    }

    /// The layer.
    #[getter]
    fn layer(&self) -> Option<&str> {
        self.exact().layer.as_deref()
    }

    /// The entity in the file, `#123`.
    #[getter]
    fn entity(&self) -> Option<String> {
        entity(self.exact().source)
    }

    /// The line in the file, from 1.
    #[getter]
    fn line(&self) -> Option<u32> {
        let line = self.exact().source.line;
        (line > 0).then_some(line)
    }

    /// The exact surface under it, in the part's coordinates; `None` where the reader did not understand the
    /// face.
    #[getter]
    fn surface(&self) -> Option<Surface> {
        match &self.exact().geometry {
            FaceGeometry::Surface(surface) => Some(Surface::whole(surface.clone())),
            FaceGeometry::Failed(_) => None,
        }
    }

    /// Why the reader did not understand the face.
    #[getter]
    fn failure(&self) -> Option<String> {
        self.exact().failure().map(ToString::to_string)
    }

    /// Whether the outward normal of the face is against that of its surface.
    #[getter]
    fn reversed(&self) -> bool {
        self.exact().normal_reversed()
    }

    /// The number of its loops.
    #[getter]
    fn loop_count(&self) -> usize {
        self.exact().loops.len()
    }

    /// The edges around it, by their numbers in `Model.edges`, in the order of its loops.
    #[getter]
    fn edges(&self) -> Vec<usize> {
        let first = self.part.shared.first_edges[self.part.index];
        edges_of(self.exact()).into_iter().map(|edge| first + edge).collect()
    }

    fn __repr__(&self) -> String {
        let kind = self.surface().map_or("failed", |surface| surface.kind_name());
        let entity = self.entity().map_or_else(String::new, |entity| format!(" {entity}"));
        format!("<chordal.Face {}{entity}: {kind}>", self.index())
    }
}

/// One edge of a part: a curve that faces share.
#[pyclass(frozen, module = "chordal")]
#[derive(Clone, Debug)]
pub struct Edge {
    pub part: Part,
    pub index: usize,
}

impl Edge {
    fn exact(&self) -> &chordal::brep::Edge {
        &self.part.exact().edges[self.index]
    }
}

#[pymethods]
impl Edge {
    /// Its number: its index in `Model.edges`.
    #[getter]
    fn index(&self) -> usize {
        self.part.shared.first_edges[self.part.index] + self.index
    }

    /// The part that it belongs to.
    #[getter]
    fn part(&self) -> Part {
        self.part.clone()
    }

    /// The entity in the file, `#123`.
    #[getter]
    fn entity(&self) -> Option<String> {
        entity(self.exact().source)
    }

    /// Its curve over its range, in the part's coordinates; `None` where the file gives none.
    #[getter]
    fn curve(&self) -> Option<Curve> {
        let edge = self.exact();
        edge.curve.as_ref().map(|curve| Curve { curve: curve.clone(), range: edge.range })
    }

    /// The vertices at its two ends: indices into `Part.vertices`.
    #[getter]
    fn vertices(&self) -> (usize, usize) {
        (self.exact().start.index(), self.exact().end.index())
    }

    /// The faces that use it, by their numbers in `Model.faces`.
    #[getter]
    fn faces(&self) -> Vec<usize> {
        let first = self.part.shared.first_faces[self.part.index];
        let faces = self.part.exact().faces.iter().enumerate();
        faces
            .filter(|(_, face)| edges_of(face).contains(&self.index))
            .map(|(index, _)| first + index)
            .collect()
    }

    fn __repr__(&self) -> String {
        format!("<chordal.Edge {}>", self.index())
    }
}
