//! The loops of a trimmed face, as closed polygons in one chart of its surface's parameter plane.
//!
//! 1. Give each loop parameters, continued over seams and poles ([`TrimmedFace`]).
//! 2. Close the loops to polygons in one chart: cut closed surfaces open, through holes where needed, nest
//!    the polygons, and cut them along sharp creases of the surface ([`Chart`]).
//! 3. Where polygons cross, find the chords that are too coarse ([`coarse_chords`], [`shut_corners`]), or
//!    that the loops cross in truth ([`loops_cross`]); then give the part vertices there and loops that do
//!    not cross ([`uncrossed`]).
//!
//! The caller samples the edges ([`EdgeSamples`]) and chooses how finely cuts through a face are sampled
//! ([`Seams`]).

#![deny(missing_docs)]

mod crossings;
mod edge_samples;
mod keys;
mod seams;
mod snap;
mod surface;
mod trimmed_face;
mod uncross;
mod unroll;

pub use crossings::{coarse_chords, cutting_chords, shut_corners};
pub use edge_samples::EdgeSamples;
pub use keys::{ChartPoint, Key, Segment};
pub use seams::{SeamMetric, Seams};
pub use snap::{Grid, settled};
pub use surface::{FaceSurface, Near};
pub use trimmed_face::TrimmedFace;
pub use uncross::{Crossed, Uncrossed, loops_cross, uncrossed};
pub use unroll::Chart;
