//! Extruded and revolved surfaces.

use crate::math;
use crate::{Curve, SurfaceJet};
use glam::{DVec2, DVec3};

/// `p` turned by the angle `u` about the axis.
pub(crate) fn turned(p: DVec3, axis_origin: DVec3, axis: DVec3, u: f64) -> DVec3 {
    axis_origin + turned_vector(p - axis_origin, axis.normalize_or(DVec3::Z), u)
}

/// A vector turned by the angle `u` about the unit vector `axis`.
pub(crate) fn turned_vector(d: DVec3, axis: DVec3, u: f64) -> DVec3 {
    if u == 0.0 {
        return d;
    }
    let (s, c) = math::sin_cos(u);
    let along = axis * d.dot(axis);
    along + (d - along) * c + axis.cross(d) * s
}

pub(super) fn extrusion_jet(profile: &Curve, direction: DVec3, p_uv: DVec2) -> SurfaceJet {
    let c = profile.jet(p_uv.x);
    SurfaceJet {
        p: c.p + direction * p_uv.y,
        du: c.d1,
        dv: direction,
        duu: c.d2,
        duv: DVec3::ZERO,
        dvv: DVec3::ZERO,
    }
}

pub(super) fn revolution_jet(profile: &Curve, axis_origin: DVec3, axis: DVec3, p_uv: DVec2) -> SurfaceJet {
    let axis = axis.normalize_or(DVec3::Z);
    let c = profile.jet(p_uv.y);
    let [d, dv, dvv] = [c.p - axis_origin, c.d1, c.d2].map(|d| turned_vector(d, axis, p_uv.x));
    // A turn's derivative is the cross product with the axis.
    let du = axis.cross(d);
    SurfaceJet { p: axis_origin + d, du, dv, duu: axis.cross(du), duv: axis.cross(dv), dvv }
}
