//! Curves in space, as CAD files define them.

use crate::{Curve2, Frame, NurbsCurve3, Surface};
use glam::DVec3;
use std::sync::Arc;

/// A point of a curve with its first two derivatives by the parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurveJet {
    pub p: DVec3,
    pub d1: DVec3,
    pub d2: DVec3,
}

/// One piece of a composite curve: `curve` over `start..end`, run backwards where `start > end`.
#[derive(Clone, Debug, PartialEq)]
pub struct CompositeSegment {
    pub curve: Curve,
    pub start: f64,
    pub end: f64,
}

/// A curve in space. Parameters are those of ISO 10303-42.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Curve {
    /// `origin + t·direction`; the direction need not be a unit vector.
    Line {
        origin: DVec3,
        direction: DVec3,
    },
    /// `origin + r(cos t x + sin t y)`.
    Circle {
        frame: Frame,
        radius: f64,
    },
    /// `origin + a cos t x + b sin t y`.
    Ellipse {
        frame: Frame,
        a: f64,
        b: f64,
    },
    /// `origin + f(t² x + 2t y)`.
    Parabola {
        frame: Frame,
        focal: f64,
    },
    /// `origin + a cosh t x + b sinh t y`.
    Hyperbola {
        frame: Frame,
        a: f64,
        b: f64,
    },
    /// Straight pieces; parameter `i` is point `i`.
    Polyline(Vec<DVec3>),
    Nurbs(NurbsCurve3),
    /// Pieces end to end; the parameter of piece `i` runs over `i..i+1`.
    Composite(Vec<CompositeSegment>),
    /// `basis(t) + distance · unit(basis'(t) × reference)`.
    Offset {
        basis: Box<Curve>,
        distance: f64,
        reference: DVec3,
    },
    /// A curve given only in the parameter space of a surface.
    OnSurface {
        surface: Arc<Surface>,
        curve: Box<Curve2>,
    },
}
