//! Curves and surfaces as the file states them; `docs/model-json.md` describes every field.

use crate::real::Real;
use serde::{Deserialize, Serialize};

pub(crate) type P2 = [Real; 2];
pub(crate) type P3 = [Real; 3];

/// A right-handed orthonormal placement; `y` may be left out.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Frame {
    pub origin: P3,
    pub x: P3,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub y: Option<P3>,
    pub z: P3,
}

/// A placement in the plane; `y` is `x` turned by a right angle either way.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Frame2 {
    pub origin: P2,
    pub x: P2,
    pub y: P2,
}

/// A B-spline curve with points `P`.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Spline<P> {
    pub degree: usize,
    pub knots: Vec<Real>,
    pub points: Vec<P>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub weights: Option<Vec<Real>>,
}

#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Segment {
    pub curve: Curve,
    pub start: Real,
    pub end: Real,
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Curve {
    Line { origin: P3, direction: P3 },
    Circle { frame: Frame, radius: Real },
    Ellipse { frame: Frame, a: Real, b: Real },
    Parabola { frame: Frame, focal: Real },
    Hyperbola { frame: Frame, a: Real, b: Real },
    Polyline { points: Vec<P3> },
    Nurbs(Spline<P3>),
    Composite { segments: Vec<Segment> },
    Offset { basis: Box<Curve>, distance: Real, reference: P3 },
    OnSurface { surface: usize, curve: Curve2 },
}

#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Segment2 {
    pub curve: Curve2,
    pub start: Real,
    pub end: Real,
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Curve2 {
    Line { origin: P2, direction: P2 },
    Circle { frame: Frame2, radius: Real },
    Ellipse { frame: Frame2, a: Real, b: Real },
    Parabola { frame: Frame2, focal: Real },
    Hyperbola { frame: Frame2, a: Real, b: Real },
    Polyline { points: Vec<P2> },
    Nurbs(Spline<P2>),
    Composite { segments: Vec<Segment2> },
    Offset { basis: Box<Curve2>, distance: Real },
}

#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct SplineSurface {
    pub degree: [usize; 2],
    pub knots_u: Vec<Real>,
    pub knots_v: Vec<Real>,
    pub points: Vec<P3>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub weights: Option<Vec<Real>>,
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Surface {
    Plane { frame: Frame },
    Cylinder { frame: Frame, radius: Real },
    Cone { frame: Frame, radius: Real, half_angle: Real },
    Sphere { frame: Frame, radius: Real },
    Torus { frame: Frame, major: Real, minor: Real },
    Extrusion { profile: Curve, direction: P3 },
    Revolution { profile: Curve, axis_origin: P3, axis: P3 },
    Nurbs(SplineSurface),
    Offset { basis: Box<Surface>, distance: Real },
}
