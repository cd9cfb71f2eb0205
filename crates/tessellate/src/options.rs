//! The options of a mesh, in the units of the part.

use crate::budget::FileBudget;
use crate::bulk::Bulk;
use crate::edge_use::EdgeSplitter;
use crate::fill_method::FillMethod;
use crate::limits::Bound;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// The options of a mesh.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Options {
    /// Largest distance between mesh and surface, in the part's units.
    pub tolerance: f64,
    /// Largest distance between an edge and its chords where it is to be another one than `tolerance`. Facets
    /// that touch an edge may then be as far off as the larger of the two, others keep to `tolerance`.
    pub boundary_tolerance: Option<f64>,
    /// Largest angle between the exact normals at the two ends of a mesh edge on one face, in radians. Edges
    /// shorter than a tenth of the tolerance are exempt: beside a singular point no edge is short enough.
    pub angle: Option<f64>,
    /// Longest mesh edge, in the part's units.
    pub max_edge: Option<f64>,
    pub bound: Bound,
    /// A method that fills faces, in place of the default one.
    pub fill_method: Option<Arc<dyn FillMethod>>,
    /// Keep the quadrilaterals of the fill method, where it makes some, as pairs of triangles.
    pub quads: bool,
    /// A method that cuts edges into chords, in place of the default one.
    pub edge_splitter: Option<Arc<dyn EdgeSplitter>>,
    /// Who evaluates many points of one surface at once.
    pub bulk: Bulk,
    /// Report the cells of subdivisions, to be drawn.
    pub record_cells: bool,
    /// Time after which a face or an edge is given up.
    pub face_timeout: Option<Duration>,
    /// The work that all faces and edges of all parts with this budget may take together.
    pub file_budget: Option<FileBudget>,
    /// Triangles after which a face is given up.
    pub face_triangles: usize,
}

impl Options {
    pub fn new(tolerance: f64) -> Self {
        Self {
            tolerance,
            boundary_tolerance: None,
            angle: None,
            max_edge: None,
            bound: Bound::Proven,
            fill_method: None,
            quads: false,
            edge_splitter: None,
            bulk: Bulk::default(),
            record_cells: false,
            face_timeout: None,
            file_budget: None,
            face_triangles: 20_000_000,
        }
    }
    pub fn with_boundary_tolerance(mut self, length: Option<f64>) -> Self {
        self.boundary_tolerance = length;
        self
    }
    /// What bounds the distance between the whole mesh and the surfaces.
    pub fn largest_tolerance(&self) -> f64 {
        self.boundary_tolerance.map_or(self.tolerance, |boundary| boundary.max(self.tolerance))
    }
    pub fn with_angle(mut self, radians: Option<f64>) -> Self {
        self.angle = radians;
        self
    }
    pub fn with_max_edge(mut self, length: Option<f64>) -> Self {
        self.max_edge = length;
        self
    }
    pub fn with_bound(mut self, bound: Bound) -> Self {
        self.bound = bound;
        self
    }
    pub fn with_fill_method(mut self, method: Option<Arc<dyn FillMethod>>) -> Self {
        self.fill_method = method;
        self
    }
    pub fn with_quads(mut self, quads: bool) -> Self {
        self.quads = quads;
        self
    }
    pub fn with_edge_splitter(mut self, splitter: Option<Arc<dyn EdgeSplitter>>) -> Self {
        self.edge_splitter = splitter;
        self
    }
    pub fn with_bulk(mut self, bulk: Bulk) -> Self {
        self.bulk = bulk;
        self
    }
    pub fn with_cells_recorded(mut self, record: bool) -> Self {
        self.record_cells = record;
        self
    }
    pub fn with_face_timeout(mut self, timeout: Option<Duration>) -> Self {
        self.face_timeout = timeout;
        self
    }
    pub fn with_file_budget(mut self, budget: Option<FileBudget>) -> Self {
        self.file_budget = budget;
        self
    }
    pub fn with_face_triangles(mut self, triangles: usize) -> Self {
        self.face_triangles = triangles;
        self
    }
}

/// A flag that stops the work from another thread.
#[derive(Clone, Debug, Default)]
pub struct Cancel {
    own: Arc<AtomicBool>,
    outer: Option<Arc<AtomicBool>>,
}

impl Cancel {
    /// Stops the work of everybody who looks at this flag or at a child of it.
    pub fn cancel(&self) {
        self.own.store(true, Ordering::Relaxed);
    }

    /// Whether the work is to stop.
    pub fn is_cancelled(&self) -> bool {
        let is_set = |flag: &Arc<AtomicBool>| flag.load(Ordering::Relaxed);
        is_set(&self.own) || self.outer.as_ref().is_some_and(is_set)
    }

    /// A flag that this one sets as well. Setting the child leaves this one as it is. A child of a child
    /// looks at its parent only.
    pub fn child(&self) -> Self {
        Self { own: Arc::default(), outer: Some(self.own.clone()) }
    }
}
