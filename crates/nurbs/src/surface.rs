//! Surfaces, as CAD files define them.

use crate::{Curve, Frame, NurbsSurface};
use glam::DVec3;

/// A point of a surface with its derivatives up to the second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceJet {
    pub p: DVec3,
    pub du: DVec3,
    pub dv: DVec3,
    pub duu: DVec3,
    pub duv: DVec3,
    pub dvv: DVec3,
}

/// The kind of a surface without its data, as reports name it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum SurfaceKind {
    Plane,
    Cylinder,
    Cone,
    Sphere,
    Torus,
    Extrusion,
    Revolution,
    Nurbs,
    Offset,
}

/// A surface. Parameters are those of ISO 10303-42; see each variant.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Surface {
    /// `origin + u x + v y`.
    Plane {
        frame: Frame,
    },
    /// `origin + r(cos u x + sin u y) + v z`.
    Cylinder {
        frame: Frame,
        radius: f64,
    },
    /// `origin + (r + v tan α)(cos u x + sin u y) + v z`; `radius` is the one at v = 0, α the half angle.
    Cone {
        frame: Frame,
        radius: f64,
        half_angle: f64,
    },
    /// `origin + r cos v (cos u x + sin u y) + r sin v z`.
    Sphere {
        frame: Frame,
        radius: f64,
    },
    /// `origin + (R + r cos v)(cos u x + sin u y) + r sin v z`; `major` may be less than `minor` (lemon, apple).
    Torus {
        frame: Frame,
        major: f64,
        minor: f64,
    },
    /// `profile(u) + v direction`; the direction need not be a unit vector.
    Extrusion {
        profile: Curve,
        direction: DVec3,
    },
    /// `profile(v)` turned by the angle `u` about the axis.
    Revolution {
        profile: Curve,
        axis_origin: DVec3,
        axis: DVec3,
    },
    Nurbs(NurbsSurface),
    /// `basis(u,v) + distance · unit(Su × Sv)`.
    Offset {
        basis: Box<Surface>,
        distance: f64,
    },
}
