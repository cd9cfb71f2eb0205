//! Surfaces, as CAD files define them.

mod creases;
mod offset;
mod poles;
mod signs;
mod swept;
mod transform;

pub use poles::Pole;
pub use signs::PositiveSurface;
pub use transform::TransformedSurface;

use crate::conic::wrapped;
use crate::curve::CLOSED;
use crate::math;
use crate::{Frame, NurbsSurface, Range, Surface, SurfaceJet, SurfaceKind, UvBox, work};
use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Distances to the axis below this part of a torus' minor radius are rounding.
const ROUNDED: f64 = 1e-14;

/// The work of an evaluation beside that of splines, which count their own.
const EVALUATION: u64 = 20;

impl Surface {
    /// The point at `p_uv`. Closed free-form surfaces go round; others are evaluated at the domain's border
    /// beyond it.
    pub fn point(&self, p_uv: DVec2) -> DVec3 {
        work::count(EVALUATION);
        let (u, v) = (p_uv.x, p_uv.y);
        match self {
            Surface::Plane { frame: f } => f.origin + f.x * u + f.y * v,
            Surface::Cylinder { frame: f, radius } => f.origin + f.radial(u) * *radius + f.z * v,
            Surface::Cone { frame: f, radius, half_angle } => {
                f.origin + f.radial(u) * (radius + v * math::tan(*half_angle)) + f.z * v
            }
            Surface::Sphere { frame: f, radius } => {
                let (s, c) = math::sin_cos(v);
                f.origin + (f.radial(u) * c + f.z * s) * *radius
            }
            Surface::Torus { frame: f, major, minor } => {
                let (s, c) = math::sin_cos(v);
                f.origin + f.radial(u) * (major + minor * c) + f.z * (minor * s)
            }
            Surface::Extrusion { profile, direction } => profile.point(u) + *direction * v,
            Surface::Revolution { profile, axis_origin, axis } => {
                swept::turned(profile.point(v), *axis_origin, *axis, u)
            }
            Surface::Nurbs(nurbs) => nurbs.point(self.inside(nurbs, p_uv)),
            Surface::Offset { basis, distance } => offset::point(basis, *distance, p_uv),
        }
    }

    /// The point at `p_uv` with the first derivatives by u and by v.
    pub fn jet1(&self, p_uv: DVec2) -> (DVec3, DVec3, DVec3) {
        match self {
            Surface::Nurbs(nurbs) => nurbs.jet1(self.inside(nurbs, p_uv)),
            Surface::Offset { basis, distance } => offset::jet1(basis, *distance, p_uv),
            _ => {
                let jet = self.jet(p_uv);
                (jet.p, jet.du, jet.dv)
            }
        }
    }

    /// The point at `p_uv` with all derivatives to the second order. Second derivatives of offset surfaces
    /// whose basis is not elementary are central differences.
    pub fn jet(&self, p_uv: DVec2) -> SurfaceJet {
        work::count(EVALUATION);
        let (u, v) = (p_uv.x, p_uv.y);
        match self {
            Surface::Plane { frame: f } => SurfaceJet {
                p: f.origin + f.x * u + f.y * v,
                du: f.x,
                dv: f.y,
                duu: DVec3::ZERO,
                duv: DVec3::ZERO,
                dvv: DVec3::ZERO,
            },
            Surface::Cylinder { frame, radius } => ring_jet(frame, u, [*radius, 0.0, 0.0], [v, 1.0, 0.0]),
            Surface::Cone { frame, radius, half_angle } => {
                let slope = math::tan(*half_angle);
                ring_jet(frame, u, [radius + v * slope, slope, 0.0], [v, 1.0, 0.0])
            }
            Surface::Sphere { frame, radius: r } => {
                let (s, c) = math::sin_cos(v);
                ring_jet(frame, u, [r * c, -r * s, -r * c], [r * s, r * c, -r * s])
            }
            Surface::Torus { frame, major, minor: r } => {
                let (s, c) = math::sin_cos(v);
                ring_jet(frame, u, [major + r * c, -r * s, -r * c], [r * s, r * c, -r * s])
            }
            Surface::Extrusion { profile, direction } => swept::extrusion_jet(profile, *direction, p_uv),
            Surface::Revolution { profile, axis_origin, axis } => {
                swept::revolution_jet(profile, *axis_origin, *axis, p_uv)
            }
            Surface::Nurbs(nurbs) => nurbs.jet(self.inside(nurbs, p_uv)),
            Surface::Offset { basis, distance } => offset::jet(basis, *distance, self.domain(), p_uv),
        }
    }

    /// The unit normal along Su × Sv at `p_uv`. Where that vanishes (pole, apex, collapsed row) it is the
    /// limit from inside the domain; on a cone's apex that of the nappe with v = 0 on it. `None` where there
    /// is none.
    pub fn normal(&self, p_uv: DVec2) -> Option<DVec3> {
        let (u, v) = (p_uv.x, p_uv.y);
        match self {
            Surface::Plane { frame } => Some(frame.z),
            Surface::Cylinder { frame, radius } => Some(frame.radial(u) * sign(*radius, 1.0)),
            Surface::Cone { frame, radius, half_angle } => {
                let slope = math::tan(*half_angle);
                let n = frame.radial(u) - frame.z * slope;
                let side = sign(*radius, slope.signum());
                Some(n.normalize() * sign(radius + v * slope, side))
            }
            Surface::Sphere { frame, .. } => {
                // Beyond the poles, where cos v < 0, the parametrisation is turned over. A negative radius
                // turns both derivatives round, so that it has no effect on the normal.
                let turned = if v.abs() > FRAC_PI_2 { math::cos(v).signum() } else { 1.0 };
                Some((frame.radial(u) * math::cos(v) + frame.z * math::sin(v)) * turned)
            }
            Surface::Torus { frame, major, minor } => {
                let outward = frame.radial(u) * math::cos(v) + frame.z * math::sin(v);
                // On the axis the sum is nothing but rounding.
                let rho = major + minor * math::cos(v);
                let rho = if rho.abs() <= ROUNDED * minor.abs() { 0.0 } else { rho };
                Some(outward * sign(*minor, 1.0) * sign(rho, 1.0))
            }
            Surface::Offset { basis, .. } => basis.normal(p_uv),
            Surface::Extrusion { .. } | Surface::Revolution { .. } | Surface::Nurbs(_) => {
                poles::limit_normal(self, p_uv)
            }
        }
    }

    /// As [`Surface::normal`], where the derivatives there are known already.
    pub fn normal_of(&self, p_uv: DVec2, jet: &SurfaceJet) -> Option<DVec3> {
        match self {
            Surface::Extrusion { .. } | Surface::Revolution { .. } | Surface::Nurbs(_) => {
                poles::regular_normal(self.domain(), jet.du, jet.dv)
                    .or_else(|| poles::limit_normal(self, p_uv))
            }
            _ => self.normal(p_uv),
        }
    }

    /// The parameters the surface is defined for: infinite where unbounded, `0..=2π` for angles, `±π/2` for a
    /// sphere's latitude, from pole to pole for that of a torus that meets its axis. A cone reaches over both
    /// nappes.
    pub fn domain(&self) -> UvBox {
        let angle = Range::new(0.0, TAU);
        match self {
            Surface::Plane { .. } => UvBox::from_ranges(Range::ALL, Range::ALL),
            Surface::Cylinder { .. } | Surface::Cone { .. } => UvBox::from_ranges(angle, Range::ALL),
            Surface::Sphere { .. } => UvBox::from_ranges(angle, Range::new(-FRAC_PI_2, FRAC_PI_2)),
            Surface::Torus { .. } => {
                let v = self.spindle_latitude().map_or(angle, |pole| Range::new(-pole, pole));
                UvBox::from_ranges(angle, v)
            }
            Surface::Extrusion { profile, .. } => UvBox::from_ranges(profile.domain(), Range::ALL),
            Surface::Revolution { profile, .. } => UvBox::from_ranges(angle, profile.domain()),
            Surface::Nurbs(nurbs) => nurbs.domain(),
            Surface::Offset { basis, .. } => basis.domain(),
        }
    }

    /// The periods in u and v of directions that close: 2π for angles, the domain's length for free-form
    /// directions whose two ends meet.
    pub fn periods(&self) -> [Option<f64>; 2] {
        match self {
            Surface::Plane { .. } => [None, None],
            Surface::Cylinder { .. } | Surface::Cone { .. } | Surface::Sphere { .. } => [Some(TAU), None],
            Surface::Torus { .. } if self.spindle_latitude().is_some() => [Some(TAU), None],
            Surface::Torus { .. } => [Some(TAU), Some(TAU)],
            Surface::Extrusion { profile, .. } => [profile.period(), None],
            Surface::Revolution { profile, .. } => [Some(TAU), profile.period()],
            Surface::Nurbs(nurbs) => nurbs_periods(nurbs),
            Surface::Offset { basis, .. } => basis.periods(),
        }
    }

    /// False for elementary surfaces with a radius of zero: a line, a circle or a point.
    pub fn has_area(&self) -> bool {
        match self {
            Surface::Cylinder { radius, .. } | Surface::Sphere { radius, .. } => *radius != 0.0,
            Surface::Torus { minor, .. } => *minor != 0.0,
            _ => true,
        }
    }

    /// The kind without the data.
    pub fn kind(&self) -> SurfaceKind {
        match self {
            Surface::Plane { .. } => SurfaceKind::Plane,
            Surface::Cylinder { .. } => SurfaceKind::Cylinder,
            Surface::Cone { .. } => SurfaceKind::Cone,
            Surface::Sphere { .. } => SurfaceKind::Sphere,
            Surface::Torus { .. } => SurfaceKind::Torus,
            Surface::Extrusion { .. } => SurfaceKind::Extrusion,
            Surface::Revolution { .. } => SurfaceKind::Revolution,
            Surface::Nurbs(_) => SurfaceKind::Nurbs,
            Surface::Offset { .. } => SurfaceKind::Offset,
        }
    }

    /// Lines of parameter space strictly inside `uv` across which the surface may not be twice continuously
    /// differentiable: values of u, values of v, each in increasing order.
    pub fn breaks(&self, uv: UvBox) -> [Vec<f64>; 2] {
        crate::curve::surface_lines(self, uv, 2)
    }

    /// All knot lines strictly inside `uv`: between them the surface is analytic.
    pub fn all_breaks(&self, uv: UvBox) -> [Vec<f64>; 2] {
        crate::curve::surface_lines(self, uv, crate::curve::ANY)
    }

    /// `p_uv`, or for a closed free-form direction the same place within the domain.
    fn inside(&self, nurbs: &NurbsSurface, p_uv: DVec2) -> DVec2 {
        let domain = nurbs.domain();
        if domain.contains(p_uv) {
            return p_uv;
        }
        let mut inside = p_uv;
        for axis in 0..2 {
            let beyond = !(p_uv[axis] >= domain.min[axis] && p_uv[axis] <= domain.max[axis]);
            if beyond && nurbs_periods(nurbs)[axis].is_some() {
                inside[axis] = wrapped(p_uv[axis], domain.min[axis], domain.max[axis]);
            }
        }
        inside
    }
}

fn sign(value: f64, at_zero: f64) -> f64 {
    if value == 0.0 { at_zero } else { value.signum() }
}

/// The jet of `origin + ρ(v)(cos u x + sin u y) + h(v) z` from ρ and h with two derivatives each.
fn ring_jet(f: &Frame, u: f64, rho: [f64; 3], h: [f64; 3]) -> SurfaceJet {
    let (s, c) = math::sin_cos(u);
    let e = f.x * c + f.y * s;
    let t = f.y * c - f.x * s;
    SurfaceJet {
        p: f.origin + e * rho[0] + f.z * h[0],
        du: t * rho[0],
        dv: e * rho[1] + f.z * h[1],
        duu: e * -rho[0],
        duv: t * rho[1],
        dvv: e * rho[2] + f.z * h[2],
    }
}

/// The periods along u and v, found once.
fn nurbs_periods(nurbs: &NurbsSurface) -> [Option<f64>; 2] {
    nurbs.periods.get(|| [0, 1].map(|axis| nurbs_period(nurbs, axis)))
}

/// The domain's length along `axis` where the surface's two sides there meet point by point.
fn nurbs_period(nurbs: &NurbsSurface, axis: usize) -> Option<f64> {
    let domain = nurbs.domain();
    let points = nurbs.points();
    let extent = points.iter().fold(0.0, |d: f64, p| d.max(p.distance(points[0])));
    let other = 1 - axis;
    let breaks = if axis == 0 { nurbs.breaks_v() } else { nurbs.breaks_u() };
    let steps = 2 * nurbs.degree()[other];
    let meets = |w: f64| {
        let (mut a, mut b) = (DVec2::splat(w), DVec2::splat(w));
        a[axis] = domain.min[axis];
        b[axis] = domain.max[axis];
        nurbs.point(a).distance(nurbs.point(b)) <= CLOSED * extent
    };
    let closed = extent > 0.0
        && breaks
            .windows(2)
            .all(|span| (0..=steps).all(|k| meets(span[0] + (span[1] - span[0]) * k as f64 / steps as f64)));
    closed.then(|| domain.size()[axis])
}

#[cfg(test)]
mod tests;
