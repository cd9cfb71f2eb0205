//! Points of curves and surfaces with their derivatives.

use glam::{DVec2, DVec3};

/// A point of a curve with its first two derivatives by the parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurveJet {
    /// The point.
    pub p: DVec3,
    /// The first derivative.
    pub d1: DVec3,
    /// The second derivative.
    pub d2: DVec3,
}

/// A point of a planar curve with its first two derivatives by the parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curve2Jet {
    /// The point.
    pub p: DVec2,
    /// The first derivative.
    pub d1: DVec2,
    /// The second derivative.
    pub d2: DVec2,
}

/// A point of a surface with its derivatives up to the second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceJet {
    /// The point.
    pub p: DVec3,
    /// The first derivative by u.
    pub du: DVec3,
    /// The first derivative by v.
    pub dv: DVec3,
    /// The second derivative by u.
    pub duu: DVec3,
    /// The mixed derivative.
    pub duv: DVec3,
    /// The second derivative by v.
    pub dvv: DVec3,
}
