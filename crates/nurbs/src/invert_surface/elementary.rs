//! Closed forms for planes, cylinders, cones, spheres and tori.

use crate::invert_curve::ON_AXIS;
use crate::math;
use crate::{Frame, Surface};
use glam::{DVec2, DVec3};

/// Two candidates whose distances differ by less than this part of the size are distinguished by the hint.
const TIE: f64 = 1e-9;

/// A point in the half plane of the axis.
struct Polar {
    angle: f64,
    radius: f64,
    height: f64,
}

/// Cylindrical coordinates; on the axis the angle is the hint's.
fn polar(frame: &Frame, p: DVec3, size: f64, near: Option<DVec2>) -> Polar {
    let local = frame.local(p);
    let radius = math::hypot(local.x, local.y);
    let on_axis = radius <= ON_AXIS * (size.abs() + local.z.abs());
    let angle = if on_axis { near.map_or(0.0, |n| n.x) } else { math::atan2(local.y, local.x) };
    Polar { angle, radius, height: local.z }
}

pub(super) fn invert(surface: &Surface, p: DVec3, near: Option<DVec2>) -> DVec2 {
    match surface {
        Surface::Plane { frame } => frame.local(p).truncate(),
        Surface::Cylinder { frame, radius } => {
            let at = polar(frame, p, *radius, near);
            DVec2::new(at.angle, at.height)
        }
        Surface::Cone { frame, radius, half_angle } => cone(frame, *radius, math::tan(*half_angle), p, near),
        Surface::Sphere { frame, radius } => {
            let at = polar(frame, p, *radius, near);
            DVec2::new(at.angle, math::atan2(at.height, at.radius))
        }
        Surface::Torus { frame, major, minor } => torus(frame, *major, *minor, p, near),
        _ => near.unwrap_or_default(),
    }
}

/// In the half plane a cone is the line ρ = r + v tan α; where that is negative it is the other nappe, half a
/// turn on.
fn cone(frame: &Frame, r: f64, slope: f64, p: DVec3, near: Option<DVec2>) -> DVec2 {
    let at = polar(frame, p, r, near);
    let on_line = |rho: f64| (at.height + (rho - r) * slope) / (1.0 + slope * slope);
    let off_line = |rho: f64| (rho - r - at.height * slope).abs();
    let (here, there) = (off_line(at.radius), off_line(-at.radius));
    let size = r.abs() + at.radius + at.height.abs();
    let opposite = if (here - there).abs() <= TIE * size {
        near.is_some_and(|n| r + n.y * slope < 0.0)
    } else {
        there < here
    };
    if opposite {
        DVec2::new(at.angle + std::f64::consts::PI, on_line(-at.radius))
    } else {
        DVec2::new(at.angle, on_line(at.radius))
    }
}

/// The tube's circle in the half plane of the point; where the tube crosses the axis, held between its poles.
fn torus(frame: &Frame, major: f64, minor: f64, p: DVec3, near: Option<DVec2>) -> DVec2 {
    let at = polar(frame, p, major.abs() + minor.abs(), near);
    let (x, z) = (at.radius - major, at.height);
    let on_circle = math::hypot(x, z) <= ON_AXIS * (major.abs() + minor.abs());
    let v = if on_circle { near.map_or(0.0, |n| n.y) } else { math::atan2(z, x) };
    let surface = Surface::Torus { frame: *frame, major, minor };
    DVec2::new(at.angle, surface.spindle_latitude().map_or(v, |pole| v.clamp(-pole, pole)))
}
