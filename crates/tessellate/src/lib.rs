//! From the exact model of a part to a watertight mesh whose distance to it is proven.
//!
//! The stages, with their modules:
//!
//! 1. Prepare the surfaces of the part (`part_job`).
//! 2. Sample the edges, each once for all of its faces (`edges`).
//! 3. Mesh the faces, in rounds (`rounds`). For one face (`attempts`): unroll its loops into one chart
//!    ([`chordal_chart`]), triangulate them (`triangulate`), fill the inside (`fill_loop`, `rows`), and prove
//!    every triangle (`prove`). A face that finds an edge too coarse requests finer chords; the requests of a
//!    round are merged, and only the faces at those edges run again.
//! 4. Where loops cross in truth, give the model vertices there and loops that do not, and mesh it again
//!    ([`chordal_chart::uncrossed`]).
//! 5. Where facets cut each other and their faces do not, refine both (`parting`), if the caller requests
//!    it.
//! 6. Join the faces (`orient`, `stitch`).
//!
//! How hard a face is tried, and in which order remedies are taken, is written down in `effort`. Other crates
//! may fill faces and cut edges in their own ways ([`method`]).

mod attempts;
mod budget;
mod bulk;
mod clock;
mod closer;
mod default_fill;
mod edge_use;
mod edges;
mod effort;
mod face_context;
mod face_mesh;
mod face_result;
mod fallback;
mod fill_loop;
mod fill_method;
mod known_faces;
mod limits;
mod lower_bound;
mod memo;
pub mod method;
mod metric;
mod options;
mod orient;
mod panics;
mod part;
mod part_job;
mod parting;
mod pcurve_gap;
mod poles;
mod prove;
mod quads;
mod report;
mod rounds;
mod rows;
mod shared_edge;
mod shared_inner_edges;
mod stitch;
mod trace;
mod triangulate;

pub use budget::FileBudget;
pub use bulk::Bulk;
pub use clock::Stopwatch;
pub use limits::Bound;
pub use options::{Cancel, Options};
pub use panics::remember_panic;
pub use part::{Remembered, tessellate_part, tessellate_part_apart, tessellate_part_remembered};
pub use parting::{FacetCut, FindCuts};
pub use report::{FaceReport, PartReport, Phases, StageSeconds};
pub use trace::Trace;
