//! Curves and surfaces of CAD models: evaluation, inversion, Bézier form, and bounds that are proofs.
//!
//! Conventions, stated once:
//! - *degree*, never order; a knot vector has `points + degree + 1` knots.
//! - Angles are radians. Lengths are the model's own units.
//! - Elementary, extruded and revolved surfaces use the parameters of ISO 10303-42 (STEP): a cone's `v` runs
//!   along its **axis**, an extrusion is `c(u) + v·d`, a revolution turns `c(v)` by the angle `u`.
//! - `_uv` names a point of parameter space, `_xyz` one of model space.

//!
//! ```
//! use chordal_nurbs::{DVec2, Facet, Frame, Surface, SurfaceBounds, UvBox, facet_bound};
//!
//! // A facet over a tenth of a radian of a cylinder with a radius of 10.
//! let cylinder = Surface::Cylinder { frame: Frame::WORLD, radius: 10.0 };
//! let uv = [DVec2::ZERO, DVec2::new(0.1, 0.0), DVec2::new(0.0, 5.0)];
//! let facet = Facet { uv, xyz: uv.map(|p| cylinder.point(p)), sag: [None; 3] };
//! let bounds = SurfaceBounds::new(&cylinder, UvBox::from_points(uv), 0.01);
//! let proven = facet_bound(&bounds, &facet, 0.01, &mut Vec::new()).error;
//! // The arc's height over its chord is 10 (1 − cos 0.05).
//! let height = 10.0 * (1.0 - 0.05_f64.cos());
//! assert!(proven >= height && proven < 1.01 * height);
//! ```

#![deny(missing_docs)]

pub use glam::{DAffine3, DVec2, DVec3, DVec4};

mod basis;
mod bernstein;
mod bezier;
mod bezier_patch;
mod bisect;
mod blossom;
mod box3;
mod box_tree;
mod bulk;
mod coherent;
mod compose;
mod conic;
mod convert;
mod curve;
mod curve2;
mod degree;
mod error;
mod explicit;
#[cfg(test)]
mod fixtures;
mod frame;
mod geometry;
mod homogeneous;
mod invert_curve;
mod invert_surface;
mod jet;
mod knots;
pub mod math;
mod natural_border;
mod nurbs_curve;
mod nurbs_surface;
mod orient;
mod passes;
mod proof;
mod segment;
mod surface;
mod tensor;
mod trim;
mod uv_box;
mod vector;
pub mod work;

pub use bezier::BezierCurve;
pub use bezier_patch::BezierPatch;
pub use bisect::bisect;
pub use box_tree::BoxTree;
pub use box3::Box3;
pub use bulk::BulkEvaluator;
pub use coherent::CoherentEvaluator;
pub use convert::{NurbsParameters, ParameterMap};
pub use error::NurbsError;
pub use explicit::LineCrossings;
pub use frame::{Frame, Frame2};
pub use geometry::{CompositeSegment, Curve, Curve2, Surface, SurfaceKind};
pub use invert_curve::{CurveInversion, CurveInverter};
pub use invert_surface::{Inversion, SurfaceInverter};
pub use jet::{Curve2Jet, CurveJet, SurfaceJet};
pub use natural_border::NaturalBorder;
pub use nurbs_curve::{NurbsCurve, NurbsCurve2, NurbsCurve3};
pub use nurbs_surface::NurbsSurface;
pub use orient::orient;
pub use passes::BasisTable;
pub use proof::{
    ChordCriterion, ChordCut, Component, Facet, FacetBound, Piece, SurfaceBounds, Wrap, chord_bound,
    facet_bound,
};
pub use segment::{segment_distance, segment_foot};
pub use surface::{Pole, PositiveSurface, TransformedSurface};
pub use trim::{LiftOptions, LiftedPiece, PatchPiece};
pub use uv_box::{BoxSide, Range, UvBox};
pub use vector::Vector;
