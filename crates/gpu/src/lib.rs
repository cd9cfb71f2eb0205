//! NURBS on the GPU: every surface of a model evaluated in one dispatch, trimmed per pixel, drawn.
//!
//! One program serves every degree from 1 to 100, rational or not, curves and surfaces. Each kernel is a WGSL file with
//! a CPU twin of the same name; the tests hold the two against each other and against double precision, within the
//! bounds stated at [`SurfaceEntry::point_bound`].

mod device;
mod draw;
mod error;
mod evaluate;
mod exact;
mod host;
mod kernels;
mod layout;
mod real;
mod samples;
mod shaders;
mod surfaces;

pub use device::{DeviceChoice, Gpu};
pub use draw::{
    Background, Camera, ExactRenderer, ExactScene, FrameCounts, Legend, Normals, PIXEL_ERROR, Picture,
    Placed, Projection, RenderOptions, Renderer, Scenery, SectionPlane, Shape, Style, Trim, Vertex, View,
    mesh_scenery, scene_outline,
};
pub use error::GpuError;
pub use evaluate::{Evaluated, Evaluation, Evaluator, OnDevice, Search, Variant, Wanted, evaluate_twin};
pub use exact::{ExactFace, ExactModel, ExactPart, exact_model};
pub use host::{HIGHEST_DEGREE, HostPeaks, HostSurface, host_peaks};
pub use real::Real;
pub use samples::{Request, Samples, sorted_by_span};
pub use shaders::{SHADERS, Shader};
pub use surfaces::{Edit, LocalFrame, SurfaceEntry, SurfaceSet};
