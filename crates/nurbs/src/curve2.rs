//! Curves in the parameter space of a surface (pcurves).

use crate::{Frame2, NurbsCurve2};
use glam::DVec2;

/// A point of a planar curve with its first two derivatives by the parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curve2Jet {
    pub p: DVec2,
    pub d1: DVec2,
    pub d2: DVec2,
}

/// A curve in the plane; the same parameters as [`crate::Curve`].
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Curve2 {
    Line {
        origin: DVec2,
        direction: DVec2,
    },
    Circle {
        frame: Frame2,
        radius: f64,
    },
    Ellipse {
        frame: Frame2,
        a: f64,
        b: f64,
    },
    Parabola {
        frame: Frame2,
        focal: f64,
    },
    Hyperbola {
        frame: Frame2,
        a: f64,
        b: f64,
    },
    Polyline(Vec<DVec2>),
    Nurbs(NurbsCurve2),
    /// `(curve, start, end)` pieces end to end; the parameter of piece `i` runs over `i..i+1`.
    Composite(Vec<(Curve2, f64, f64)>),
    /// `basis(t) + distance · right-hand unit normal`.
    Offset {
        basis: Box<Curve2>,
        distance: f64,
    },
}
