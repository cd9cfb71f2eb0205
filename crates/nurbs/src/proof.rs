//! Proven distances: every bound that a mesh relies on, none of them a sample.
//!
//! | file | upper bound of |
//! |---|---|
//! | `spline_chord.rs` | the distance of a B-spline or Bézier curve from its chord, and its derivatives |
//! | `chord.rs` | the same for curves of all kinds, in closed form where there is one |
//! | `lifted.rs` | the same for a curve that is given in the parameters of a surface |
//! | `chord_cut.rs` | the distance of a Bézier curve from its chords, by which it is cut into few |
//! | `enclosure.rs` | the second derivatives of a surface over a box of parameters |
//! | `facet.rs` | the two-sided distance between a surface and a flat triangle or a chord |
//!
//! Reduction of degree has its own bound in `degree.rs`, because lifted curves are made with it.

mod chord;
mod chord_cut;
mod enclosure;
mod facet;
mod lifted;
mod spline_chord;

pub use chord_cut::{ChordCriterion, ChordCut};
pub use enclosure::{Component, Piece, SurfaceBounds, Wrap};
pub use facet::{Facet, FacetBound, chord_bound, facet_bound};
