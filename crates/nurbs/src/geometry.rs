//! The kinds of curves and surfaces, as data. What they can do is in `curve.rs`, `curve2.rs` and
//! `surface.rs`, and in the files of each task (conversion, inversion, proof).
//!
//! They are defined together because they hold each other: a swept surface has a profile curve, a curve may
//! be given in the parameters of a surface.

use crate::{Frame, Frame2, NurbsCurve2, NurbsCurve3, NurbsSurface};
use glam::{DVec2, DVec3};
use std::sync::Arc;

/// A curve in space. Parameters are those of ISO 10303-42.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Curve {
    /// `origin + t·direction`; the direction need not be a unit vector.
    Line {
        /// The point at `t = 0`.
        origin: DVec3,
        /// The derivative by `t`.
        direction: DVec3,
    },
    /// `origin + r(cos t x + sin t y)`.
    Circle {
        /// Centre, plane and the direction of `t = 0`.
        frame: Frame,
        /// The radius.
        radius: f64,
    },
    /// `origin + a cos t x + b sin t y`.
    Ellipse {
        /// Centre and axes.
        frame: Frame,
        /// The half axis along x.
        a: f64,
        /// The half axis along y.
        b: f64,
    },
    /// `origin + f(t² x + 2t y)`.
    Parabola {
        /// Vertex and axes.
        frame: Frame,
        /// The focal distance `f`.
        focal: f64,
    },
    /// `origin + a cosh t x + b sinh t y`.
    Hyperbola {
        /// Centre and axes.
        frame: Frame,
        /// The half axis along x.
        a: f64,
        /// The half axis along y.
        b: f64,
    },
    /// Straight pieces; parameter `i` is point `i`.
    Polyline(Vec<DVec3>),
    /// A B-spline, rational or not.
    Nurbs(NurbsCurve3),
    /// Pieces end to end; the parameter of piece `i` runs over `i..i+1`.
    Composite(Vec<CompositeSegment>),
    /// `basis(t) + distance · unit(basis'(t) × reference)`.
    Offset {
        /// The curve that is offset.
        basis: Box<Curve>,
        /// The distance, in model units; negative to the other side.
        distance: f64,
        /// The direction that, with the tangent, gives the side.
        reference: DVec3,
    },
    /// A curve given only in the parameter space of a surface.
    OnSurface {
        /// The surface.
        surface: Arc<Surface>,
        /// The curve in the surface's parameters.
        curve: Box<Curve2>,
    },
}

/// One piece of a composite curve: `curve` over `start..end`, run backwards where `start > end`.
#[derive(Clone, Debug, PartialEq)]
pub struct CompositeSegment {
    /// The whole curve of which this is a piece.
    pub curve: Curve,
    /// The curve's own parameter at the start of the piece.
    pub start: f64,
    /// The curve's own parameter at the end of the piece.
    pub end: f64,
}

/// A curve in the plane; the same parameters as [`crate::Curve`].
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Curve2 {
    /// `origin + t·direction`; the direction need not be a unit vector.
    Line {
        /// The point at `t = 0`.
        origin: DVec2,
        /// The derivative by `t`.
        direction: DVec2,
    },
    /// `origin + r(cos t x + sin t y)`.
    Circle {
        /// Centre and the direction of `t = 0`.
        frame: Frame2,
        /// The radius.
        radius: f64,
    },
    /// `origin + a cos t x + b sin t y`.
    Ellipse {
        /// Centre and axes.
        frame: Frame2,
        /// The half axis along x.
        a: f64,
        /// The half axis along y.
        b: f64,
    },
    /// `origin + f(t² x + 2t y)`.
    Parabola {
        /// Vertex and axes.
        frame: Frame2,
        /// The focal distance `f`.
        focal: f64,
    },
    /// `origin + a cosh t x + b sinh t y`.
    Hyperbola {
        /// Centre and axes.
        frame: Frame2,
        /// The half axis along x.
        a: f64,
        /// The half axis along y.
        b: f64,
    },
    /// Straight pieces; parameter `i` is point `i`.
    Polyline(Vec<DVec2>),
    /// A B-spline, rational or not.
    Nurbs(NurbsCurve2),
    /// `(curve, start, end)` pieces end to end; the parameter of piece `i` runs over `i..i+1`.
    Composite(Vec<(Curve2, f64, f64)>),
    /// `basis(t) + distance · right-hand unit normal`.
    Offset {
        /// The curve that is offset.
        basis: Box<Curve2>,
        /// The distance in the plane; negative to the left.
        distance: f64,
    },
}

/// A surface. Parameters are those of ISO 10303-42; see each variant.
///
/// ```
/// use chordal_nurbs::{DVec2, DVec3, Frame, Surface, UvBox};
/// use std::f64::consts::FRAC_PI_2;
///
/// let ball = Surface::Sphere { frame: Frame::WORLD, radius: 2.0 };
/// let equator = DVec2::new(FRAC_PI_2, 0.0);
/// assert!(ball.point(equator).distance(DVec3::new(0.0, 2.0, 0.0)) < 1e-15);
/// assert_eq!(ball.normal(DVec2::ZERO), Some(DVec3::X));
/// // Its exact NURBS form over a quarter of it.
/// let quarter = ball.to_nurbs(UvBox::new(DVec2::ZERO, DVec2::splat(FRAC_PI_2)))?;
/// assert_eq!(quarter.degree(), [2, 2]);
/// # Ok::<(), chordal_nurbs::NurbsError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Surface {
    /// `origin + u x + v y`.
    Plane {
        /// Origin and axes; z is the normal.
        frame: Frame,
    },
    /// `origin + r(cos u x + sin u y) + v z`.
    Cylinder {
        /// z is the axis; u is measured from x.
        frame: Frame,
        /// The radius.
        radius: f64,
    },
    /// `origin + (r + v tan α)(cos u x + sin u y) + v z`; `radius` is the one at v = 0, α the half angle.
    Cone {
        /// z is the axis; u is measured from x.
        frame: Frame,
        /// The radius at v = 0.
        radius: f64,
        /// The angle between the axis and a ruling, in radians; the radius grows with v where it is positive.
        half_angle: f64,
    },
    /// `origin + r cos v (cos u x + sin u y) + r sin v z`.
    Sphere {
        /// The centre; z points to the pole v = π/2, u is measured from x.
        frame: Frame,
        /// The radius.
        radius: f64,
    },
    /// `origin + (R + r cos v)(cos u x + sin u y) + r sin v z`. Where |R| < r the torus meets its axis, and
    /// the surface is the part with R + r cos v ≥ 0: an apple for R > 0, a lemon for R < 0.
    Torus {
        /// The centre; z is the axis; u is measured from x.
        frame: Frame,
        /// The distance of the tube's centre from the axis.
        major: f64,
        /// The radius of the tube.
        minor: f64,
    },
    /// `profile(u) + v direction`; the direction need not be a unit vector.
    Extrusion {
        /// The curve that is extruded.
        profile: Curve,
        /// The derivative by v.
        direction: DVec3,
    },
    /// `profile(v)` turned by the angle `u` about the axis.
    Revolution {
        /// The curve that is turned.
        profile: Curve,
        /// A point on the axis.
        axis_origin: DVec3,
        /// The axis, a unit vector.
        axis: DVec3,
    },
    /// A B-spline surface, rational or not.
    Nurbs(NurbsSurface),
    /// `basis(u,v) + distance · unit(Su × Sv)`.
    Offset {
        /// The surface that is offset.
        basis: Box<Surface>,
        /// The distance along the normal, in model units.
        distance: f64,
    },
}

/// The kind of a surface without its data, as reports name it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum SurfaceKind {
    /// [`Surface::Plane`].
    Plane,
    /// [`Surface::Cylinder`].
    Cylinder,
    /// [`Surface::Cone`].
    Cone,
    /// [`Surface::Sphere`].
    Sphere,
    /// [`Surface::Torus`].
    Torus,
    /// [`Surface::Extrusion`].
    Extrusion,
    /// [`Surface::Revolution`].
    Revolution,
    /// [`Surface::Nurbs`].
    Nurbs,
    /// [`Surface::Offset`].
    Offset,
}
