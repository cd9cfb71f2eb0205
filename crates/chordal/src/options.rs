//! What a job is asked for, in millimetres and radians.

use crate::{Sew, Tolerance};
use chordal_read::ReadOptions;
use chordal_tessellate::method::{EdgeSplitter, FillMethod};
use chordal_tessellate::{Bound, Bulk};
use chordal_write::{Format, Unit, UpAxis};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

/// What is asked of a whole job.
///
/// ```
/// use chordal::{JobOptions, Tolerance};
/// let options = JobOptions::default().with_tolerance(Tolerance::Millimetres(0.05)).with_angle(None);
/// assert!(!options.strict);
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct JobOptions {
    pub tolerance: Tolerance,
    /// Largest distance between edges and their chords; `None`: as `tolerance`. Facets that touch an edge may be as far off
    /// as the larger of the two.
    pub boundary_tolerance: Option<Tolerance>,
    /// Largest angle between the exact normals at the two ends of a mesh edge on one face, in radians.
    pub angle: Option<f64>,
    /// Longest mesh edge, in millimetres.
    pub max_edge: Option<f64>,
    /// A method that fills faces, in place of the default one (feature `methods` has some).
    pub fill_method: Option<Arc<dyn FillMethod>>,
    /// Write the quadrilaterals of the fill method as such, where it makes some and the format has them (OBJ, PLY).
    pub quads: bool,
    /// A method that cuts edges into chords, in place of the default one.
    pub edge_splitter: Option<Arc<dyn EdgeSplitter>>,
    /// What to make of what the file leaves open.
    pub read: ReadOptions,
    /// Whether loose faces are sewn before they are meshed.
    pub sew: Sew,
    pub bound: Bound,
    /// Who evaluates many points of one surface at once; a GPU by `GpuEvaluator` (feature `gpu`).
    pub bulk: Bulk,
    /// Threads; `None`: one per core. The result is the same bytes for any number.
    pub jobs: Option<usize>,
    /// Write nothing unless everything was done.
    pub strict: bool,
    /// Time after which a face is given up. A face that is given up depends on the machine: the only thing that does.
    pub face_timeout: Option<Duration>,
    /// The format of the output; `None`: by its extension.
    pub format: Option<Format>,
    /// The unit of the output; `None`: the format's own (metres in GLB, millimetres in the others).
    pub unit: Option<Unit>,
    /// The axis of the output that points up; `None`: the format's own (Y in GLB, as in the model in the others).
    pub up: Option<UpAxis>,
    /// Write the edges as lines too, where the format can.
    pub edges: bool,
    /// Draw every face in its plane of parameters into this folder.
    pub debug_svg: Option<PathBuf>,
}

impl Default for JobOptions {
    fn default() -> Self {
        Self {
            tolerance: Tolerance::default(),
            boundary_tolerance: None,
            angle: Some(20_f64.to_radians()),
            max_edge: None,
            fill_method: None,
            quads: false,
            edge_splitter: None,
            read: ReadOptions::default(),
            sew: Sew::default(),
            bound: Bound::Proven,
            bulk: Bulk::default(),
            jobs: None,
            strict: false,
            face_timeout: Some(Duration::from_secs(60)),
            format: None,
            unit: None,
            up: None,
            edges: false,
            debug_svg: None,
        }
    }
}

impl JobOptions {
    /// The name of the fill method, `default` where there is none.
    pub fn fill_method_name(&self) -> &str {
        self.fill_method.as_ref().map_or("default", |method| method.name())
    }
    /// The name of the edge method, `default` where there is none.
    pub fn edge_splitter_name(&self) -> &str {
        self.edge_splitter.as_ref().map_or("default", |method| method.name())
    }
    pub fn with_tolerance(mut self, tolerance: Tolerance) -> Self {
        self.tolerance = tolerance;
        self
    }
    pub fn with_boundary_tolerance(mut self, tolerance: Option<Tolerance>) -> Self {
        self.boundary_tolerance = tolerance;
        self
    }
    pub fn with_angle(mut self, radians: Option<f64>) -> Self {
        self.angle = radians;
        self
    }
    pub fn with_max_edge(mut self, mm: Option<f64>) -> Self {
        self.max_edge = mm;
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
    pub fn with_read(mut self, read: ReadOptions) -> Self {
        self.read = read;
        self
    }
    pub fn with_sew(mut self, sew: Sew) -> Self {
        self.sew = sew;
        self
    }
    pub fn with_bound(mut self, bound: Bound) -> Self {
        self.bound = bound;
        self
    }
    pub fn with_bulk(mut self, bulk: Bulk) -> Self {
        self.bulk = bulk;
        self
    }
    pub fn with_jobs(mut self, jobs: Option<usize>) -> Self {
        self.jobs = jobs;
        self
    }
    pub fn with_strict(mut self, strict: bool) -> Self {
        self.strict = strict;
        self
    }
    pub fn with_face_timeout(mut self, timeout: Option<Duration>) -> Self {
        self.face_timeout = timeout;
        self
    }
    pub fn with_format(mut self, format: Option<Format>) -> Self {
        self.format = format;
        self
    }
    pub fn with_unit(mut self, unit: Option<Unit>) -> Self {
        self.unit = unit;
        self
    }
    pub fn with_up(mut self, up: Option<UpAxis>) -> Self {
        self.up = up;
        self
    }
    pub fn with_edges(mut self, edges: bool) -> Self {
        self.edges = edges;
        self
    }
    pub fn with_debug_svg(mut self, folder: Option<PathBuf>) -> Self {
        self.debug_svg = folder;
        self
    }
}
