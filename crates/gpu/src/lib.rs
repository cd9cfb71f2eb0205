//! NURBS on the GPU: every surface of a model evaluated in one dispatch, trimmed per pixel, drawn.
//!
//! One program serves every degree from 1 to 100, rational or not, curves and surfaces. Each kernel is a WGSL
//! file with a CPU twin of the same name; the tests hold the two against each other and against double
//! precision, within the bounds stated at [`SurfaceEntry::point_bound`].

#![deny(missing_docs)]

mod device;
mod device_choice;
mod draw;
mod error;
mod evaluate;
mod faces;
mod kernels;
mod layout;
mod real;
mod samples;
mod shaders;
mod surfaces;

pub use device::Gpu;
pub use device_choice::{BACKENDS, DeviceChoice};
pub use draw::{
    Background, Camera, FaceRenderer, FaceScene, FrameCounts, Legend, Normals, PIXEL_ERROR, Picture, Placed,
    Projection, RenderOptions, Renderer, Scenery, SectionPlane, Shape, Style, Trim, Vertex, View,
    mesh_scenery, scene_outline,
};
pub use error::{Capability, GpuError, OptionError, Resource, Task, Unsuitable};
pub use evaluate::{Evaluated, Evaluation, KernelRunner, OnDevice, Search, Variant, Wanted, evaluate_twin};
pub use faces::{TrimmedFace, TrimmedModel, TrimmedPart, trimmed_model};
pub use real::Real;
pub use samples::{Request, Samples, sorted_by_span};
pub use shaders::{SHADERS, Shader};
pub use surfaces::{Edit, LocalFrame, SurfaceEntry, SurfaceSet};

/// The unit tests share the device and the models of the tests in `tests/`.
#[cfg(test)]
extern crate self as chordal_gpu;
#[cfg(test)]
#[path = "../tests/common/mod.rs"]
mod test_support;
