//! Sewing: loose trimmed surfaces become bodies whose faces share edges.
//!
//! Many formats have no topology: faces share no edges. Before meshing, shared edges are inferred from the
//! geometry of the edges that exactly one face uses, so that later stages share vertices by identity, as in
//! solids:
//!
//! ```text
//!   borders ([`border`])       edges with one use, as polylines in a tree; natural borders of bare faces
//!   tolerance ([`gaps`])       `auto`: from the file's resolution and the histogram of nearest gaps
//!   vertices ([`cluster`])     merged within the tolerance; none moves further than the tolerance
//!   T-junctions ([`cut`])      an edge is cut where a vertex of another edge lies on it: overlaps, chains
//!   pieces ([`pair`])          pieces between the same vertices that run along each other become one edge
//!   rebuild ([`rebuild`])      coedges of several faces refer to one edge
//!   shells ([`shells`])        faces get a common orientation; closed shells become solids
//! ```
//!
//! Meshes that come without surfaces are sewn along their polygon borders: [`sew_mesh`].
//!
//! Edges with two uses are never changed. In place of the grid of the 2001 paper (Kahlesz, Balázs and Klein,
//! section 8) there is a tree of boxes, because the sizes of edges in one file differ by orders of magnitude.

#![deny(missing_docs)]

mod border;
mod cluster;
mod cut;
mod flux;
mod foot;
mod gaps;
mod mesh;
mod natural;
mod orient;
mod pair;
mod polygon;
mod rebuild;
mod report;
mod run;
mod shells;
mod uv_loops;

pub use gaps::{AutoTolerance, GapBin, gap_survey};
pub use mesh::{MeshSewReport, OpenBorder, SewnMesh, sew_mesh};
pub use report::{OpenEdge, SewReport};
pub use run::{SewTolerance, has_topology, open_edges, sew_part};
