//! Trimming curves as exact Bézier curves in space, and polylines of them within a proven distance.
//!
//! Source: Balázs, Guthe, Klein 2004, sections 4 and 5.1. A trimming curve in the plane of parameters becomes
//! Bézier pieces, loses the degrees that it does not need, is cut where it crosses the knot lines of the
//! surface, and each piece is composed with its patch ([`lift`]); what comes out is approximated by chords
//! ([`chords`]).

mod lift;
mod roots;

pub use lift::{LiftOptions, LiftedPiece, PatchPiece};
