//! CAD geometry in, watertight triangle meshes with a proven error out.
//!
//! Read a model, mesh it, use the triangles:
//!
//! ```
//! use chordal::{Closedness, MeshOptions, Mesher, Model, Tolerance};
//!
//! let model = Model::open("../../corpus/bracket.step")?;
//! let options = MeshOptions::default().with_tolerance(Tolerance::Millimetres(0.05));
//! let meshed = Mesher::new(options).mesh(&model)?;
//!
//! for triangle in meshed.triangles() {
//!     let _ = (triangle.face, triangle.positions, triangle.uv, triangle.normals);
//! }
//! let report = meshed.report();
//! assert!(report.clean && report.closedness == Some(Closedness::Closed));
//! assert!(report.proven_error.is_some_and(|error| error <= 0.05));
//! # Ok::<(), chordal::Error>(())
//! ```
//!
//! [`Model::from_bytes`] and [`Meshed::to_bytes`] do the same without a file. Nothing here needs a thread, a
//! clock or a file system, so the crate also runs on `wasm32-unknown-unknown`. Work is shared among the
//! threads of the current rayon pool; the result is the same bytes for any number of threads.
//!
//! # Features
//!
//! | feature | default | what it adds |
//! |---|---|---|
//! | `step` | yes | reads STEP |
//! | `iges` | yes | reads IGES |
//! | `brep` | yes | reads BREP, the text format of OpenCASCADE |
//! | `rhino` | yes | reads 3DM, the format of Rhino |
//! | `scene` | yes | reads Open Inventor, VRML and X3D |
//! | `obj` | yes | reads free-form OBJ |
//! | `gpu` | no | pictures of models, and faces evaluated on a device (wgpu) |
//! | `methods` | no | published methods that fill faces and cut edges, by name, and their comparison |
//! | `levels` | no | coarser levels of sewn meshes (needs a C++ compiler) |
//!
//! Chordal's own JSON and that of geomdl are always read.
//!
//! The crates of the pipeline can be used alone: [`nurbs`], [`brep`], [`read`], [`sew`], [`chart`],
//! [`mod@tessellate`], [`audit`], [`mesh`], [`write`](mod@write), [`document`].
#![deny(missing_docs)]

/// The README's example, compiled as a test of the documentation.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;

mod account;
mod analytic;
mod area;
mod arrays;
mod auditing;
mod bug;
#[cfg(feature = "methods")]
pub mod compare;
mod edge_count;
mod error;
mod gaps;
#[cfg(feature = "gpu")]
mod gpu_evaluator;
mod info;
mod levels;
pub mod math;
pub mod mesh_file;
mod meshed;
mod meshed_part;
mod mesher;
mod model;
mod names;
mod options;
#[cfg(feature = "methods")]
pub mod papers;
mod placement;
mod progress;
mod quantity;
#[cfg(feature = "gpu")]
mod render;
pub mod report;
pub mod repro;
mod resolve;
mod scene;
mod sewing;
pub mod stages;
mod tight_box;
mod work_limits;

pub use arrays::{Arrays, NO_FACE};
pub use error::{Error, FileError, RequestError};
#[cfg(feature = "gpu")]
pub use gpu_evaluator::GpuEvaluator;
pub use info::{GapInfo, INFO_SCHEMA, Info, NodeInfo, PartInfo};
pub use meshed::{Meshed, MeshedFace, Polyline, Triangle};
pub use mesher::Mesher;
pub use model::Model;
pub use options::MeshOptions;
pub use progress::Phase;
pub use quantity::{QuantityError, Tolerance, parse_angle, parse_length};
#[cfg(feature = "gpu")]
pub use render::{Evaluated, Image, ImageRenderer, RenderMode};
pub use report::{Closedness, Problem, REPORT_SCHEMA, Report};
pub use sewing::Sewing;
pub use work_limits::WorkLimits;

pub use chordal_audit as audit;
pub use chordal_brep as brep;
pub use chordal_brep::Severity;
pub use chordal_chart as chart;
pub use chordal_document as document;
#[cfg(feature = "gpu")]
pub use chordal_gpu as gpu;
pub use chordal_mesh as mesh;
#[cfg(feature = "methods")]
pub use chordal_methods as methods;
pub use chordal_nurbs as nurbs;
pub use chordal_read as read;
pub use chordal_read::{Format as InputFormat, ReadOptions, Winding};
pub use chordal_sew as sew;
pub use chordal_tessellate as tessellate;
pub use chordal_tessellate::{Bound, Cancel};
pub use chordal_write as write;
pub use chordal_write::{Format as OutputFormat, Unit, UpAxis, WriteOptions};
