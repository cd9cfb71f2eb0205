//! From the exact model of a part to a watertight mesh whose distance to it is proven.
//!
//! heal parameters ([`chart`], [`unroll`]) → discretise edges ([`edges`]) → size ([`metric`]) → place points ([`place`])
//! → trim + triangulate ([`triangulate`]) → prove ([`prove`]) → stitch ([`stitch`]).
//! A face that finds an edge too coarse asks for it; requests are merged per round and only the faces touched run again.

mod bulk;
mod chart;
mod clock;
mod crease;
mod crossings;
mod doubled;
mod edge_method;
mod edges;
mod face;
mod grid;
mod looseness;
mod lower_bound;
mod metric;
mod options;
mod orient;
mod place;
mod prove;
mod report;
mod rounds;
mod stitch;
mod strategy;
mod surface;
mod triangulate;
mod unroll;

pub use bulk::{Bulk, Evaluator};
pub use clock::Stopwatch;
pub use edge_method::{Criterion, EdgeMethod, EdgeMethodEntry, LoopRow, loop_rows};
pub use options::{Bound, Cancel, Options};
pub use report::{FaceReport, PartReport, Phases, StageSeconds};
pub use rounds::tessellate_part;
pub use strategy::trace::Trace;
pub use strategy::{Cut, Fill, Strategy, StrategyEntry, Stretch};
