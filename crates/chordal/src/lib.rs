//! CAD geometry in, proven watertight meshes out: the one crate that a user adds.
//!
//! ```
//! use chordal::{Job, JobOptions, Tolerance};
//!
//! let options = JobOptions::default().with_tolerance(Tolerance::Millimetres(0.05));
//! let report = chordal::run(&Job::new("../../corpus/bracket.step").with_options(options))?.report;
//! assert!(report.clean && report.closedness == Some(chordal::Closedness::Closed));
//! assert!(report.proven_error.is_some_and(|error| error <= 0.05));
//! println!("{} triangles for {} faces", report.triangles, report.faces.total);
//! # Ok::<(), chordal::JobError>(())
//! ```
//!
//! `Job::with_output` writes the mesh; `Outcome::scene` holds it in memory. The parts of the pipeline are re-exported
//! and can be used alone: [`nurbs`], [`brep`], [`read`], [`mod@tessellate`], [`audit`], [`mesh`], [`write`](mod@write).

mod account;
mod against;
mod analytic;
mod area;
mod auditing;
mod check;
mod clock;
#[cfg(feature = "methods")]
mod compare;
mod convert;
mod drawing;
mod edge_count;
mod error;
mod gaps;
#[cfg(feature = "gpu")]
mod gpu_evaluator;
mod info;
mod job;
mod levels;
mod mesh_sewing;
mod meshed_part;
mod names;
mod options;
#[cfg(feature = "methods")]
mod papers;
mod placement;
mod process;
mod progress;
mod quantity;
#[cfg(feature = "gpu")]
mod render;
pub mod report;
mod resolve;
mod scene;
mod sewing;
mod tight_box;
mod whole_file;

pub use against::{AgainstReport, WorstFace};
pub use area::area;
pub use check::{CHECK_SCHEMA, CheckReport, check_mesh};
#[cfg(feature = "methods")]
pub use compare::{COMPARE_SCHEMA, ComparedRow, Comparison, PhaseSeconds, compare, plot};
pub use convert::{ConvertOptions, Converted, convert};
pub use error::JobError;
#[cfg(feature = "gpu")]
pub use gpu_evaluator::GpuEvaluator;
pub use info::{GapInfo, INFO_SCHEMA, Info, NodeInfo, PartInfo, info};
pub use job::{Job, Outcome, read_model, read_model_with, run, thread_pool};
pub use mesh_sewing::{LevelEntry, MeshSewing, MeshSewingReport, OpenBorderEntry, SEW_SCHEMA, sew_mesh_file};
pub use meshed_part::{MeshedPart, mesh_parts};
pub use options::JobOptions;
#[cfg(feature = "methods")]
pub use papers::{LoopEntry, PaperTables, SurfaceEntry, paper_tables};
pub use placement::{PartUse, part_uses};
pub use process::peak_memory;
pub use progress::{OnProgress, Progress};
pub use quantity::{QuantityError, Tolerance, parse_angle, parse_length};
#[cfg(feature = "gpu")]
pub use render::{Evaluated, RenderError, RenderJob, RenderMode, Rendered, render};
pub use report::{Closedness, GapSurvey, OpenEntry, Problem, REPORT_SCHEMA, Report, SewingEntry, StageEntry};
pub use resolve::{Resolved, resolve};
pub use sewing::{Sew, sew_model};
pub use tight_box::{TightBox, edge_box, tight_box};
pub use whole_file::write_whole;

pub use chordal_audit as audit;
pub use chordal_brep as brep;
pub use chordal_document as document;
#[cfg(feature = "gpu")]
pub use chordal_gpu as gpu;
pub use chordal_mesh as mesh;
#[cfg(feature = "methods")]
pub use chordal_methods as methods;
pub use chordal_nurbs as nurbs;
pub use chordal_read as read;
pub use chordal_read::{ReadOptions, Winding};
pub use chordal_sew as sew;
pub use chordal_tessellate as tessellate;
pub use chordal_tessellate::{Bound, Bulk, Cancel};
pub use chordal_write as write;
pub use chordal_write::{Format, Unit, UpAxis};
