//! How exactly numbers can be recomputed, and how much work one task gets.

use chordal_nurbs::{Curve, Surface};

/// Rounding of a recomputed position, relative to the largest number that it is computed from: a few hundred
/// operations, each right to half a unit in the last place. Smaller, and correct vertices far from the origin
/// are called misplaced.
pub(crate) const ROUNDING: f64 = 256.0 * f64::EPSILON;

/// A vertex may lie this share of the tolerance off its curve or surface; it is charged to the gap. Farther
/// off, it is misplaced.
pub(crate) const CHARGED: f64 = 1e-3;

/// Bounds are computed tightly for errors of this share of the tolerance and above. At 1, a bound that is
/// right at the tolerance would fall on either side of it by rounding.
pub(crate) const AIM: f64 = 0.995;

/// Triangles or corners handled by one parallel task: large against the cost of starting a task.
pub(crate) const CHUNK: usize = 4096;

/// The size of the numbers that a surface is evaluated from, beyond the size of the mesh on it.
pub(crate) fn surface_magnitude(surface: &Surface) -> f64 {
    match surface {
        Surface::Plane { frame } => frame.origin.length(),
        Surface::Cylinder { frame, radius }
        | Surface::Cone { frame, radius, .. }
        | Surface::Sphere { frame, radius } => frame.origin.length() + radius.abs(),
        Surface::Torus { frame, major, minor } => frame.origin.length() + major.abs() + minor.abs(),
        Surface::Offset { basis, distance } => surface_magnitude(basis) + distance.abs(),
        Surface::Revolution { axis_origin, .. } => axis_origin.length(),
        _ => 0.0,
    }
}

/// The size of the numbers that a curve is evaluated from, beyond the size of the mesh on it.
pub(crate) fn curve_magnitude(curve: &Curve) -> f64 {
    match curve {
        Curve::Circle { frame, radius } => frame.origin.length() + radius.abs(),
        Curve::Ellipse { frame, a, b } | Curve::Hyperbola { frame, a, b } => {
            frame.origin.length() + a.abs().max(b.abs())
        }
        Curve::Parabola { frame, focal } => frame.origin.length() + focal.abs(),
        Curve::Line { origin, .. } => origin.length(),
        Curve::Composite(segments) => segments.iter().map(|s| curve_magnitude(&s.curve)).fold(0.0, f64::max),
        Curve::Offset { basis, distance, .. } => curve_magnitude(basis) + distance.abs(),
        Curve::OnSurface { surface, .. } => surface_magnitude(surface),
        _ => 0.0,
    }
}
