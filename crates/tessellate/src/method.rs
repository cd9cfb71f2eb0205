//! What a method of another crate needs: the traits that it implements, and what it works on.
//!
//! A [`FillMethod`] fills the inside of faces; it works on a [`FaceMesh`]. An [`EdgeSplitter`] cuts edges
//! into chords; it works on an [`EdgePiece`] and the faces beside it. Both are set in [`crate::Options`].

pub use crate::edge_use::{EdgePiece, EdgeSplitter, EdgeUse};
pub use crate::face_mesh::FaceMesh;
pub use crate::fill_method::{Check, FaceFiller, FillMethod, FillTask};
pub use crate::limits::{Limits, TURN_LENGTH, resolution};
pub use crate::metric::Metric;
pub use crate::poles::open_out;
pub use crate::quads::pairs;
pub use crate::triangulate::{Location, NONE, SweepError, Triangulation, sweep};
pub use chordal_chart::{Chart, ChartPoint, EdgeSamples, FaceSurface, Grid, Key, Near, Segment};
pub use chordal_nurbs::orient;
