//! Surfaces at a constant distance from others.

use crate::curve::unit_jet;
use crate::math;
use crate::{Curve, Surface, SurfaceJet, UvBox};
use glam::{DVec2, DVec3};

impl Surface {
    /// The surface with offsets of elementary and extruded surfaces, and offsets of offsets, replaced by the
    /// exact surface of the same parameters; everything else as it is.
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

/// Sines of angles, and distances as parts of the size, that are rounding of the numbers in a file.
const IN_PLANE: f64 = 1e-12;

impl Surface {
    /// The two surfaces of revolution that an offset of one may be, with the same parameters: the profile
    /// moved to either side in its plane, which holds the axis. On a face that keeps to one side of the axis,
    /// the offset is one of them, since its normal turns over where the profile passes the axis. `None` for
    /// other surfaces.
    pub fn offset_revolutions(&self) -> Option<[Surface; 2]> {
        let Surface::Offset { basis, distance } = self else { return None };
        let Surface::Revolution { profile, axis_origin, axis } = basis.as_ref() else { return None };
        let across = across_meridian(profile, *axis_origin, *axis)?;
        Some([across, -across].map(|across| Surface::Revolution {
            profile: parallel(profile, *distance, across),
            axis_origin: *axis_origin,
            axis: *axis,
        }))
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
        // The normal is c' × d.
        Surface::Extrusion { profile, direction } => Some(Surface::Extrusion {
            profile: parallel(profile, distance, *direction),
            direction: *direction,
        }),
        _ => None,
    }
}

/// The curve at `distance` from another one along tangent × `reference`, with the same parameters.
fn parallel(curve: &Curve, distance: f64, reference: DVec3) -> Curve {
    let general = || Curve::Offset { basis: Box::new(curve.clone()), distance, reference };
    match curve {
        Curve::Line { origin, direction } => match direction.cross(reference).try_normalize() {
            Some(side) => Curve::Line { origin: origin + side * distance, direction: *direction },
            None => general(),
        },
        Curve::Circle { frame, radius } if is_along(reference, frame.z) => {
            let radius = radius + distance * reference.dot(frame.z).signum();
            if radius > 0.0 { Curve::Circle { frame: *frame, radius } } else { general() }
        }
        _ => general(),
    }
}

/// The direction across the plane of a curve and an axis; `None` where they lie in no common plane.
fn across_meridian(curve: &Curve, axis_origin: DVec3, axis: DVec3) -> Option<DVec3> {
    let off_axis = |p: DVec3| axis.cross(p - axis_origin);
    let is_in_plane = |across: DVec3, points: &[DVec3]| {
        let size = points.iter().fold(0.0f64, |size, &p| size.max(p.distance(axis_origin)));
        points.iter().all(|&p| (p - axis_origin).dot(across).abs() <= IN_PLANE * size)
    };
    let (across, points) = match curve {
        Curve::Circle { frame, .. } => (frame.z, vec![frame.origin]),
        Curve::Line { origin, direction } => {
            let points = vec![*origin, origin + *direction];
            (points.iter().copied().map(off_axis).max_by(longer)?, points)
        }
        Curve::Nurbs(curve) => {
            let points: Vec<DVec3> = curve.points().to_vec();
            (points.iter().copied().map(off_axis).max_by(longer)?, points)
        }
        _ => return None,
    };
    let across = across.try_normalize()?;
    (across.dot(axis).abs() <= IN_PLANE * axis.length() && is_in_plane(across, &points)).then_some(across)
}

fn longer(a: &DVec3, b: &DVec3) -> std::cmp::Ordering {
    a.length_squared().total_cmp(&b.length_squared())
}

fn is_along(a: DVec3, b: DVec3) -> bool {
    a.cross(b).length() <= IN_PLANE * a.length() * b.length()
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
