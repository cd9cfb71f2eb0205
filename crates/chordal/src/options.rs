//! What the caller requests of a mesh.

use crate::quantity::Tolerance;
use crate::sewing::Sewing;
use crate::work_limits::{RequestedLimits, WorkLimits};
use chordal_tessellate::method::{EdgeSplitter, FillMethod};
use chordal_tessellate::{Bound, Bulk, Options};
use chordal_write::Format;
use std::sync::Arc;
use std::time::Duration;

/// Angle between neighbouring normals that most users expect of a mesh.
const ANGLE_DEGREES: f64 = 20.0;

/// What the caller requests of a mesh.
///
/// Lengths are millimetres, angles radians. The options of the mesher itself are declared in
/// [`tessellate::Options`](chordal_tessellate::Options); this type adds what concerns a whole model.
///
/// ```
/// use chordal::{MeshOptions, Tolerance};
/// let options = MeshOptions::default().with_tolerance(Tolerance::Millimetres(0.05)).with_angle(None);
/// assert_eq!(options.tolerance(), Tolerance::Millimetres(0.05));
/// ```
#[derive(Clone, Debug)]
pub struct MeshOptions {
    tolerance: Tolerance,
    boundary_tolerance: Option<Tolerance>,
    sewing: Sewing,
    output_format: Option<Format>,
    self_intersections: bool,
    limits: RequestedLimits,
    /// Lengths are millimetres; its own tolerances are set for each part.
    mesher: Options,
}

impl Default for MeshOptions {
    /// 0.1 % of the diagonal of the model, 20 degrees, the limits of [`WorkLimits`].
    fn default() -> Self {
        let mesher = Options::new(0.0).with_angle(Some(ANGLE_DEGREES.to_radians()));
        Self {
            tolerance: Tolerance::default(),
            boundary_tolerance: None,
            sewing: Sewing::default(),
            output_format: None,
            self_intersections: true,
            limits: RequestedLimits::default(),
            mesher,
        }
    }
}

/// Setters of options that the mesher declares.
macro_rules! mesher_options {
    ($($(#[doc = $text:literal])* $name:ident($value:ident: $type:ty);)*) => {
        impl MeshOptions {
            $($(#[doc = $text])*
            pub fn $name(mut self, $value: $type) -> Self {
                self.mesher = self.mesher.$name($value);
                self
            })*
        }
    };
}

mesher_options! {
    /// Largest angle between the exact normals at the two ends of a mesh edge on one face, in radians; `None`
    /// is no limit. Default: 20 degrees.
    with_angle(radians: Option<f64>);
    /// Longest mesh edge in millimetres; `None`, the default, is no limit.
    with_max_edge(millimetres: Option<f64>);
    /// Whether errors are proven by upper bounds, the default, or estimated from samples.
    with_bound(bound: Bound);
    /// A method that fills faces, in place of the default one; the feature `methods` has some.
    with_fill_method(method: Option<Arc<dyn FillMethod>>);
    /// A method that cuts edges into chords, in place of the default one; the feature `methods` has some.
    with_edge_splitter(splitter: Option<Arc<dyn EdgeSplitter>>);
    /// Keep the quadrilaterals that the fill method makes; OBJ and PLY write them as such.
    with_quads(quads: bool);
    /// A device that evaluates many points of one surface at once.
    with_bulk(bulk: Bulk);
    /// Record the cells of subdivisions, so that they can be drawn.
    with_cells_recorded(record: bool);
}

impl MeshOptions {
    /// Largest distance between the mesh and the exact surfaces. Default: 0.1 %.
    pub fn with_tolerance(mut self, tolerance: Tolerance) -> Self {
        self.tolerance = tolerance;
        self
    }

    /// Largest distance between edges and their chords; `None`, the default, is the tolerance. Facets that
    /// touch an edge may be as far off as the larger of the two.
    pub fn with_boundary_tolerance(mut self, tolerance: Option<Tolerance>) -> Self {
        self.boundary_tolerance = tolerance;
        self
    }

    /// Whether faces that share no edges are joined before they are meshed.
    pub fn with_sewing(mut self, sewing: Sewing) -> Self {
        self.sewing = sewing;
        self
    }

    /// Whether triangles of closed shells that cut each other are looked for. Where the faces do not cut each
    /// other in the file, both are refined there until their triangles part; what cuts even so is reported.
    /// Default: yes.
    pub fn with_self_intersections(mut self, look: bool) -> Self {
        self.self_intersections = look;
        self
    }

    /// The format that the mesh will be written in. The rounding of a format with 32-bit coordinates (binary
    /// STL, GLB) is kept back from the tolerance, so that the mesh **as written** keeps it. `None`, the
    /// default: nothing is kept back.
    pub fn with_output_format(mut self, format: Option<Format>) -> Self {
        self.output_format = format;
        self
    }

    /// Processor time after which a face or an edge is reported as failed; `None` is no limit.
    /// Default: 4 seconds, with a fill method or an edge splitter 60. The time is that of an ordinary core
    /// ([`WorkLimits`]).
    pub fn with_face_timeout(mut self, timeout: Option<Duration>) -> Self {
        self.limits.face_timeout = Some(timeout);
        self
    }

    /// Processor time that all faces of a file may take together, per megabyte of the file and at 0.1 %;
    /// `None` is no limit. Default: the time of one face.
    pub fn with_file_timeout(mut self, timeout: Option<Duration>) -> Self {
        self.limits.file_timeout = Some(timeout);
        self
    }

    /// Memory in bytes that the triangles of a file may take, per megabyte of the file and at 0.1 %; `None`
    /// is no limit. Default: a gigabyte.
    pub fn with_memory(mut self, bytes: Option<u64>) -> Self {
        self.limits.memory = Some(bytes);
        self
    }

    /// What the faces of a file may take, with the defaults for these options filled in.
    pub fn limits(&self) -> WorkLimits {
        self.limits.resolved(self.mesher.fill_method.is_some() || self.mesher.edge_splitter.is_some())
    }

    /// Largest distance between the mesh and the exact surfaces.
    pub fn tolerance(&self) -> Tolerance {
        self.tolerance
    }

    /// Largest distance between edges and their chords, where it is not the tolerance.
    pub fn boundary_tolerance(&self) -> Option<Tolerance> {
        self.boundary_tolerance
    }

    /// Whether faces that share no edges are joined before they are meshed.
    pub fn sewing(&self) -> Sewing {
        self.sewing
    }

    /// The format that the mesh will be written in.
    pub fn output_format(&self) -> Option<Format> {
        self.output_format
    }

    /// Whether triangles that cut each other are looked for.
    pub fn self_intersections(&self) -> bool {
        self.self_intersections
    }

    /// The name of the fill method, `default` where there is none.
    pub fn fill_method_name(&self) -> &str {
        self.mesher.fill_method.as_ref().map_or("default", |method| method.name())
    }

    /// The name of the edge splitter, `default` where there is none.
    pub fn edge_splitter_name(&self) -> &str {
        self.mesher.edge_splitter.as_ref().map_or("default", |method| method.name())
    }

    /// The options of the mesher; lengths are millimetres, and its tolerances have no meaning yet.
    pub fn mesher(&self) -> &Options {
        &self.mesher
    }

    /// The options for one part. Tolerances are in the part's units, `scale` leads from these to millimetres.
    pub(crate) fn of_part(&self, tolerance: f64, boundary_tolerance: Option<f64>, scale: f64) -> Options {
        let options = self.mesher.clone().with_boundary_tolerance(boundary_tolerance);
        let mut options = options.with_face_timeout(self.limits().face_timeout);
        options.tolerance = tolerance;
        let max_edge = options.max_edge.map(|length| length / scale);
        options.with_max_edge(max_edge)
    }
}
