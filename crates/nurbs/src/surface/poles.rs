//! Where a surface's parametrisation is singular: lines of parameter space that are one point in space, and
//! the normals there.

use crate::curve::CLOSED;
use crate::math;
use crate::{Curve, NurbsSurface, Range, Surface, UvBox};
use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, PI};

/// A line of parameter space that is one point in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pole {
    /// 0: the line u = `value`; 1: the line v = `value`.
    pub axis: usize,
    /// The value of the fixed parameter.
    pub value: f64,
    /// The point in space.
    pub point: DVec3,
}

/// Samples of a profile to each smooth piece between which it comes near the axis at most once.
const PROFILE_SAMPLES: u32 = 16;

/// How far profiles without ends (parabola, hyperbola) are searched for poles, in their parameter.
///
/// At 16 a hyperbola is four million times its half axis away, farther than any face reaches.
const ENDLESS: f64 = 16.0;

/// Steps into the domain, as parts of it, at which the limit of a normal is taken; short ones first.
const STEPS: [f64; 4] = [1e-7, 1e-6, 1e-5, 1e-4];

/// The sine of the angle between Su and Sv below which they are taken for parallel.
///
/// The cross product of such vectors has no digits that are right. A larger value would find poles on slanted
/// parametrisations; a smaller one would return normals made of rounding.
const FLAT: f64 = 1e-9;

impl Surface {
    /// The lines of parameter space that collapse to a point, within 1e-7 of the surface's size.
    pub fn poles(&self) -> Vec<Pole> {
        self.poles_within(0.0)
    }

    /// The lines of parameter space whose points all lie within `tolerance` (model units; at least 1e-7 of
    /// the surface's size) of one another.
    pub fn poles_within(&self, tolerance: f64) -> Vec<Pole> {
        let on_v = |value: f64| Pole { axis: 1, value, point: self.point(DVec2::new(0.0, value)) };
        match self {
            Surface::Plane { .. } | Surface::Cylinder { .. } | Surface::Extrusion { .. } => Vec::new(),
            Surface::Cone { frame, radius, half_angle } => {
                let v = -radius / math::tan(*half_angle);
                let apex = Pole { axis: 1, value: v, point: frame.origin + frame.z * v };
                if v.is_finite() { vec![apex] } else { Vec::new() }
            }
            Surface::Sphere { frame, radius } => {
                let pole = |side: f64| Pole {
                    axis: 1,
                    value: side * FRAC_PI_2,
                    point: frame.origin + frame.z * (side * radius),
                };
                vec![pole(-1.0), pole(1.0)]
            }
            Surface::Torus { frame, major, minor } => match self.spindle_latitude() {
                Some(v) => {
                    // On the axis, whatever the rounding of the latitude.
                    let height = (minor * minor - major * major).max(0.0).sqrt();
                    let pole = |side: f64| Pole {
                        axis: 1,
                        value: side * v,
                        point: frame.origin + frame.z * (side * height),
                    };
                    vec![pole(-1.0), pole(1.0)]
                }
                None if major == minor => vec![on_v(PI)],
                None => Vec::new(),
            },
            Surface::Revolution { profile, axis_origin, axis } => {
                let axis = axis.normalize_or(DVec3::Z);
                axis_touches(profile, *axis_origin, axis, tolerance)
                    .into_iter()
                    .map(|t| {
                        let along = (profile.point(t) - *axis_origin).dot(axis);
                        Pole { axis: 1, value: t, point: *axis_origin + axis * along }
                    })
                    .collect()
            }
            Surface::Nurbs(nurbs) => nurbs_poles(nurbs, tolerance),
            Surface::Offset { basis, distance } => {
                let kept = |pole: &Pole| {
                    self.line_collapses(pole.axis, pole.value, tolerance.max(CLOSED * distance.abs()))
                };
                basis
                    .poles_within(tolerance)
                    .into_iter()
                    .filter_map(|p| kept(&p).map(|point| Pole { point, ..p }))
                    .collect()
            }
        }
    }

    /// The common point of a line of parameter space, if sampled points of it lie that close together.
    fn line_collapses(&self, axis: usize, value: f64, tolerance: f64) -> Option<DVec3> {
        let domain = self.domain();
        let along = if axis == 0 { domain.v() } else { domain.u() };
        if !along.is_finite() {
            return None;
        }
        let at = |i: u32| {
            let w = along.start + along.length() * f64::from(i) / 32.0;
            self.point(if axis == 0 { DVec2::new(value, w) } else { DVec2::new(w, value) })
        };
        (1..=32).all(|i| at(i).distance(at(0)) <= tolerance).then(|| at(0))
    }
}

fn nurbs_poles(nurbs: &NurbsSurface, tolerance: f64) -> Vec<Pole> {
    let points = nurbs.points();
    let extent = points.iter().fold(0.0, |d: f64, p| d.max(p.distance(points[0])));
    let tolerance = tolerance.max(CLOSED * extent);
    let domain = nurbs.domain();
    let mut found = Vec::new();
    for axis in 0..2 {
        let breaks = if axis == 0 { nurbs.breaks_v() } else { nurbs.breaks_u() };
        let steps = 2 * nurbs.degree()[1 - axis];
        for value in [domain.min[axis], domain.max[axis]] {
            let at = |w: f64| {
                let mut uv = DVec2::splat(w);
                uv[axis] = value;
                nurbs.point(uv)
            };
            let point = at(breaks[0]);
            let collapsed = breaks.windows(2).all(|span| {
                (0..=steps).all(|k| {
                    at(span[0] + (span[1] - span[0]) * k as f64 / steps as f64).distance(point) <= tolerance
                })
            });
            if collapsed {
                found.push(Pole { axis, value, point });
            }
        }
    }
    found
}

/// Parameters of a profile at which it meets the axis it is turned about.
fn axis_touches(profile: &Curve, origin: DVec3, axis: DVec3, tolerance: f64) -> Vec<f64> {
    let radius = |t: f64| {
        let d = profile.point(t) - origin;
        (d - axis * d.dot(axis)).length()
    };
    if let Curve::Line { origin: o, direction } = profile {
        let flat = |d: DVec3| d - axis * d.dot(axis);
        let (p, d) = (flat(*o - origin), flat(*direction));
        let t = -p.dot(d) / d.length_squared();
        let size = p.length() + direction.length();
        let hit = t.is_finite()
            && d.length() > FLAT * direction.length()
            && radius(t) <= tolerance.max(CLOSED * size);
        return if hit { vec![t] } else { Vec::new() };
    }
    let domain = profile.domain();
    let range = if domain.is_finite() { domain } else { Range::new(-ENDLESS, ENDLESS) };
    let mut stops = vec![range.start];
    stops.extend(profile.all_breaks(range));
    stops.push(range.end);
    let mut samples = vec![range.start];
    for pair in stops.windows(2) {
        let step = (pair[1] - pair[0]) / f64::from(PROFILE_SAMPLES);
        samples.extend((1..PROFILE_SAMPLES).map(|i| pair[0] + step * f64::from(i)));
        samples.push(pair[1]);
    }
    let radii: Vec<f64> = samples.iter().map(|&t| radius(t)).collect();
    let size = radii.iter().filter(|r| r.is_finite()).fold(0.0, |m: f64, r| m.max(*r));
    let tolerance = tolerance.max(CLOSED * if domain.is_finite() { size } else { 1.0 });
    let mut found: Vec<f64> = Vec::new();
    for i in 0..samples.len() {
        let (before, after) = (i.saturating_sub(1), (i + 1).min(samples.len() - 1));
        if radii[i] > radii[before] || radii[i] > radii[after] {
            continue;
        }
        let t =
            if radii[i] <= tolerance { samples[i] } else { lowest(radius, samples[before], samples[after]) };
        let known = |f: &f64| (f - t).abs() <= 1e-6 * range.length();
        if radius(t) <= tolerance && !found.iter().any(known) {
            found.push(t);
        }
    }
    found
}

/// The lowest point of a function with one valley between `a` and `b`, by golden section.
pub(crate) fn lowest(f: impl Fn(f64) -> f64, mut a: f64, mut b: f64) -> f64 {
    const RATIO: f64 = 0.618_033_988_749_894_8;
    let (mut c, mut d) = (b - RATIO * (b - a), a + RATIO * (b - a));
    let (mut fc, mut fd) = (f(c), f(d));
    for _ in 0..80 {
        if fc < fd {
            (b, d, fd) = (d, c, fc);
            c = b - RATIO * (b - a);
            fc = f(c);
        } else {
            (a, c, fc) = (c, d, fd);
            d = a + RATIO * (b - a);
            fd = f(d);
        }
    }
    0.5 * (a + b)
}

/// The normal at `p_uv`, or where Su × Sv is lost in rounding its limit from inside the domain.
pub(super) fn limit_normal(surface: &Surface, p_uv: DVec2) -> Option<DVec3> {
    let domain = surface.domain();
    let size = finite_size(domain);
    let (_, du, dv) = surface.jet1(p_uv);
    if let Some(n) = regular_normal(domain, du, dv) {
        return Some(n);
    }
    let (a, b) = (du.length() * size.x, dv.length() * size.y);
    let inward = |axis: usize| {
        let middle = if domain.is_finite() { domain.center()[axis] } else { p_uv[axis] + 0.5 };
        if p_uv[axis] <= middle { size[axis] } else { -size[axis] }
    };
    // Across a line that collapses only the other parameter has to move.
    let directions = if a < b {
        [DVec2::new(0.0, inward(1)), DVec2::new(inward(0), inward(1))]
    } else {
        [DVec2::new(inward(0), 0.0), DVec2::new(inward(0), inward(1))]
    };
    for direction in directions {
        for step in STEPS {
            let (_, du, dv) = surface.jet1(p_uv + direction * step);
            if let Some(n) = unit_cross(du, dv) {
                return Some(n);
            }
        }
    }
    None
}

/// The normal by the derivatives, unless one is tiny beside the other: the point is on, or all but on, a
/// collapsed line.
pub(super) fn regular_normal(domain: UvBox, du: DVec3, dv: DVec3) -> Option<DVec3> {
    let size = finite_size(domain);
    let (a, b) = (du.length() * size.x, dv.length() * size.y);
    if a.min(b) > FLAT * a.max(b) { unit_cross(du, dv) } else { None }
}

/// The size of a domain, 1 in directions without ends.
fn finite_size(domain: UvBox) -> DVec2 {
    let size = domain.size();
    DVec2::new(if size.x.is_finite() { size.x } else { 1.0 }, if size.y.is_finite() { size.y } else { 1.0 })
}

fn unit_cross(du: DVec3, dv: DVec3) -> Option<DVec3> {
    let (a, b) = (du.try_normalize()?, dv.try_normalize()?);
    let cross = a.cross(b);
    (cross.length() > FLAT).then(|| cross.normalize())
}
