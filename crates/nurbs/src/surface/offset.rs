//! Surfaces at a constant distance from others.

use crate::curve::unit_jet;
use crate::math;
use crate::{Surface, SurfaceJet, UvBox};
use glam::{DVec2, DVec3};

impl Surface {
    /// The surface with offsets of elementary surfaces, and offsets of offsets, replaced by the exact surface
    /// of the same parameters; everything else as it is.
    pub fn simplified(self) -> Surface {
        let Surface::Offset { basis, distance } = self else { return self };
        let basis = basis.simplified();
        if distance == 0.0 {
            return basis;
        }
        match moved(&basis, distance) {
            Some(exact) => exact,
            None => match basis {
                // Normals of an offset are those of its basis.
                Surface::Offset { basis, distance: inner } => {
                    Surface::Offset { basis, distance: inner + distance }
                }
                basis => Surface::Offset { basis: Box::new(basis), distance },
            },
        }
    }
}

/// The elementary surface at `distance` along Su × Sv, with the same parameters; `None` where there is none.
fn moved(basis: &Surface, distance: f64) -> Option<Surface> {
    match basis {
        Surface::Plane { frame } => {
            let mut frame = *frame;
            frame.origin += frame.z * distance;
            Some(Surface::Plane { frame })
        }
        Surface::Cylinder { frame, radius } if *radius > 0.0 && radius + distance > 0.0 => {
            Some(Surface::Cylinder { frame: *frame, radius: radius + distance })
        }
        // Normals point away from the axis on the nappe of v = 0; the other nappe turns inside out, as it
        // would.
        Surface::Cone { frame, radius, half_angle } if *radius >= 0.0 => {
            let (s, c) = math::sin_cos(*half_angle);
            let side = if *radius == 0.0 { half_angle.signum() } else { 1.0 };
            let mut frame = *frame;
            frame.origin -= frame.z * (distance * s * side);
            let radius = radius + distance * c * side;
            (radius >= 0.0).then_some(Surface::Cone { frame, radius, half_angle: *half_angle })
        }
        Surface::Sphere { frame, radius } if *radius > 0.0 && radius + distance > 0.0 => {
            Some(Surface::Sphere { frame: *frame, radius: radius + distance })
        }
        // The normal turns over where the tube crosses the axis, so lemons and apples stay offsets.
        Surface::Torus { frame, major, minor }
            if *minor > 0.0 && major >= minor && minor + distance > 0.0 =>
        {
            Some(Surface::Torus { frame: *frame, major: *major, minor: minor + distance })
        }
        _ => None,
    }
}

/// The unit normal with its first derivatives by u and by v.
fn normal_jet1(basis: &Surface, p_uv: DVec2) -> Option<[DVec3; 3]> {
    let j = basis.jet(p_uv);
    let w = j.du.cross(j.dv);
    let wu = j.duu.cross(j.dv) + j.du.cross(j.duv);
    let wv = j.duv.cross(j.dv) + j.du.cross(j.dvv);
    // A product that is only rounding has no direction.
    if w.length() <= 1e-12 * j.du.length() * j.dv.length() {
        return None;
    }
    let [n, nu, _] = unit_jet(w, wu, DVec3::ZERO)?;
    let [_, nv, _] = unit_jet(w, wv, DVec3::ZERO)?;
    Some([n, nu, nv])
}

pub(super) fn point(basis: &Surface, distance: f64, p_uv: DVec2) -> DVec3 {
    basis.point(p_uv) + basis.normal(p_uv).unwrap_or(DVec3::ZERO) * distance
}

pub(super) fn jet1(basis: &Surface, distance: f64, p_uv: DVec2) -> (DVec3, DVec3, DVec3) {
    let (_, du, dv) = basis.jet1(p_uv);
    let [nu, nv] = normal_jet1(basis, p_uv).map_or([DVec3::ZERO; 2], |[_, nu, nv]| [nu, nv]);
    (point(basis, distance, p_uv), du + nu * distance, dv + nv * distance)
}

/// Second derivatives of the normal are central differences of its first ones, on the domain's inner side at
/// its border.
pub(super) fn jet(basis: &Surface, distance: f64, domain: UvBox, p_uv: DVec2) -> SurfaceJet {
    let base = basis.jet(p_uv);
    let (p, du, dv) = jet1(basis, distance, p_uv);
    let slope = |at: DVec2| normal_jet1(basis, at).map_or([DVec3::ZERO; 2], |[_, nu, nv]| [nu, nv]);
    let difference = |axis: usize| {
        let size = domain.size()[axis];
        let scale = if size.is_finite() { size } else { 1.0 + p_uv[axis].abs() };
        let (mut low, mut high) = (p_uv, p_uv);
        low[axis] = (p_uv[axis] - 1e-5 * scale).max(domain.min[axis].min(p_uv[axis]));
        high[axis] = (p_uv[axis] + 1e-5 * scale).min(domain.max[axis].max(p_uv[axis]));
        let (a, b) = (slope(low), slope(high));
        [0, 1].map(|k| (b[k] - a[k]) / (high[axis] - low[axis]))
    };
    let [nuu, nuv] = difference(0);
    let [nvu, nvv] = difference(1);
    SurfaceJet {
        p,
        du,
        dv,
        duu: base.duu + nuu * distance,
        duv: base.duv + (nuv + nvu) * (0.5 * distance),
        dvv: base.dvv + nvv * distance,
    }
}
