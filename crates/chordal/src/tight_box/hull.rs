//! Step 2: how far a whole surface can reach, whatever its trims.

use chordal_nurbs::{DVec3, Surface, math};

/// True where the trimmed surface may reach beyond its own border.
pub(super) fn bulges(surface: &Surface) -> bool {
    !matches!(
        surface,
        Surface::Plane { .. } | Surface::Cylinder { .. } | Surface::Cone { .. } | Surface::Extrusion { .. }
    )
}

/// The largest value of `gradient · p` over the whole surface; infinite where no simple bound is known.
pub(super) fn support(surface: &Surface, gradient: DVec3) -> f64 {
    let across = |axis: DVec3| (gradient.length_squared() - math::square(gradient.dot(axis))).max(0.0).sqrt();
    match surface {
        Surface::Sphere { frame, radius } => gradient.dot(frame.origin) + radius.abs() * gradient.length(),
        Surface::Torus { frame, major, minor } => {
            gradient.dot(frame.origin) + major.abs() * across(frame.z) + minor.abs() * gradient.length()
        }
        Surface::Nurbs(nurbs) if nurbs.weights().is_none_or(|w| w.iter().all(|&w| w > 0.0)) => {
            nurbs.points().iter().map(|&p| gradient.dot(p)).fold(f64::NEG_INFINITY, f64::max)
        }
        Surface::Offset { basis, distance } => support(basis, gradient) + distance.abs() * gradient.length(),
        _ => f64::INFINITY,
    }
}
