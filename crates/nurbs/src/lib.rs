//! Curves and surfaces of CAD models: evaluation, inversion, Bézier form, and bounds that are proofs.
//!
//! Conventions, stated once:
//! - *degree*, never order; a knot vector has `points + degree + 1` knots.
//! - Angles are radians. Lengths are the model's own units.
//! - Elementary, extruded and revolved surfaces use the parameters of ISO 10303-42 (STEP): a cone's `v` runs
//!   along its **axis**, an extrusion is `c(u) + v·d`, a revolution turns `c(v)` by the angle `u`.
//! - `_uv` names a point of parameter space, `_xyz` one of model space.

#![deny(missing_docs)]

pub use glam::{DAffine3, DVec2, DVec3, DVec4};

mod basis;
mod bernstein;
mod bezier;
mod bezier_patch;
mod blossom;
mod bounds;
mod box3;
mod bulk;
mod coherent;
mod compose;
mod conic;
mod convert;
mod curve;
mod curve2;
mod curve_bounds;
mod degree;
mod error;
mod explicit;
mod facet;
mod frame;
mod homogeneous;
mod invert_curve;
mod invert_surface;
mod knots;
mod nurbs_curve;
mod nurbs_surface;
mod passes;
mod surface;
mod tensor;
mod trim;
mod uv_box;
mod vector;
#[cfg(test)]
mod zoo;

pub use bezier::{BezierCurve, BezierPatch};
pub use bounds::{Ball4, Piece, SurfaceBounds, Wrap};
pub use box3::Box3;
pub use bulk::BulkEvaluator;
pub use coherent::CoherentEvaluator;
pub use convert::{NurbsParameters, ParameterMap};
pub use curve::{CompositeSegment, Curve, CurveJet};
pub use curve2::{Curve2, Curve2Jet};
pub use error::NurbsError;
pub use explicit::LineCrossings;
pub use facet::{Component, Facet, FacetBound, chord_bound, facet_bound};
pub use frame::{Frame, Frame2};
pub use invert_curve::{CurveInversion, CurveInverter};
pub use invert_surface::{Inversion, SurfaceInverter};
pub use nurbs_curve::{NurbsCurve, NurbsCurve2, NurbsCurve3};
pub use nurbs_surface::NurbsSurface;
pub use passes::BasisTable;
pub use surface::{Pole, PositiveSurface, Surface, SurfaceJet, SurfaceKind, TransformedSurface};
pub use trim::{ChordCriterion, ChordCut, LiftOptions, LiftedPiece, PatchPiece};
pub use uv_box::{Range, UvBox};
pub use vector::Vector;
