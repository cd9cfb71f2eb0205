//! Extruded and revolved surfaces: the closest point of the profile, measured across the sweep.

use crate::conic::wrapped;
use crate::invert_curve::{ON_AXIS, Seeds, reach};
use crate::math;
use crate::{Curve, Range, work};
use glam::{DVec2, DVec3};
use std::sync::OnceLock;

/// The profile and its samples, which are taken when first needed.
#[derive(Clone, Debug)]
struct Profile<'a> {
    curve: &'a Curve,
    range: Range,
    period: Option<f64>,
    seeds: OnceLock<Seeds>,
}

impl<'a> Profile<'a> {
    fn new(curve: &'a Curve, at_work: Range) -> Self {
        let domain = curve.domain();
        let period = curve.period();
        // Endless profiles are sampled where the caller is at work; others everywhere.
        let range = if domain.is_finite() { domain } else { at_work };
        Self { curve, range, period, seeds: OnceLock::new() }
    }

    fn closest(
        &self,
        p: DVec3,
        of: impl Fn(DVec3) -> DVec3,
        residual: impl Fn(f64) -> [DVec3; 3],
        near: Option<f64>,
    ) -> f64 {
        let near = near
            .map(|n| if self.period.is_some() { wrapped(n, self.range.start, self.range.end) } else { n });
        if self.range.is_finite() && self.curve.domain().is_finite() {
            return self
                .seeds
                .get_or_init(|| work::uncounted(|| Seeds::new(self.curve, self.range)))
                .closest(of, residual, near)
                .t;
        }
        // Not bound to where the caller is at work, but well sampled there.
        let far = reach(self.curve, p, Range::ALL);
        let work = if self.range.is_finite() { self.range } else { far };
        let whole = Range::new(far.start.min(work.start), far.end.max(work.end));
        Seeds::new(self.curve, whole).closest(of, residual, near).t
    }
}

/// For `c(u) + v d`.
#[derive(Clone, Debug)]
pub(super) struct ExtrusionInverter<'a> {
    profile: Profile<'a>,
    direction: DVec3,
}

impl<'a> ExtrusionInverter<'a> {
    pub fn new(profile: &'a Curve, direction: DVec3, at_work: Range) -> Self {
        Self { profile: Profile::new(profile, at_work), direction }
    }

    pub fn invert(&self, p: DVec3, near: Option<DVec2>) -> DVec2 {
        let d = self.direction;
        let unit = d.normalize_or_zero();
        let across = |w: DVec3| w - unit * w.dot(unit);
        let u = if let Curve::Line { origin, direction } = self.profile.curve {
            let flat = across(*direction);
            let u = (p - *origin).dot(flat) / flat.length_squared();
            if u.is_finite() { u } else { near.map_or(0.0, |n| n.x) }
        } else {
            let residual = |t: f64| {
                let jet = self.profile.curve.jet(t);
                [across(jet.p - p), across(jet.d1), across(jet.d2)]
            };
            // The position along the sweep is independent of the profile's parameter.
            let base = self.profile.curve.point(self.profile.range.clamp(0.0));
            let flat = base + across(p - base);
            self.profile.closest(flat, |c| across(c - p), residual, near.map(|n| n.x))
        };
        let v = (p - self.profile.curve.point(u)).dot(d) / d.length_squared();
        DVec2::new(u, if v.is_finite() { v } else { 0.0 })
    }
}

/// For `c(v)` turned by `u`.
#[derive(Clone, Debug)]
pub(super) struct RevolutionInverter<'a> {
    profile: Profile<'a>,
    origin: DVec3,
    axis: DVec3,
}

impl<'a> RevolutionInverter<'a> {
    pub fn new(profile: &'a Curve, origin: DVec3, axis: DVec3, at_work: Range) -> Self {
        Self { profile: Profile::new(profile, at_work), origin, axis: axis.normalize_or(DVec3::Z) }
    }

    fn flat(&self, d: DVec3) -> DVec3 {
        d - self.axis * d.dot(self.axis)
    }

    /// The radius as a function of the parameter with two derivatives, and the height's, as vectors.
    fn half_plane(&self, t: f64) -> [DVec3; 3] {
        let jet = self.profile.curve.jet(t);
        let d = jet.p - self.origin;
        let [f, f1, f2] = [d, jet.d1, jet.d2].map(|w| self.flat(w));
        let [h, h1, h2] = [d, jet.d1, jet.d2].map(|w| w.dot(self.axis));
        let rho = f.length();
        let at = |rho, h| DVec3::new(rho, h, 0.0);
        if rho <= ON_AXIS * d.length() {
            // The radius has a corner here; one side of it serves.
            return [at(rho, h), at(f1.length(), h1), at(0.0, h2)];
        }
        let rho1 = f.dot(f1) / rho;
        let rho2 = (f1.length_squared() + f.dot(f2) - rho1 * rho1) / rho;
        [at(rho, h), at(rho1, h1), at(rho2, h2)]
    }

    pub fn invert(&self, p: DVec3, near: Option<DVec2>) -> DVec2 {
        let d = p - self.origin;
        let target = DVec3::new(self.flat(d).length(), d.dot(self.axis), 0.0);
        let of = |c: DVec3| {
            let d = c - self.origin;
            DVec3::new(self.flat(d).length(), d.dot(self.axis), 0.0) - target
        };
        let residual = |t: f64| {
            let [r, r1, r2] = self.half_plane(t);
            [r - target, r1, r2]
        };
        let v = self.profile.closest(p, of, residual, near.map(|n| n.y));
        DVec2::new(self.angle(d, v, near), v)
    }

    /// The angle from the profile's point at `v` to the point at `d` from the axis' origin.
    fn angle(&self, d: DVec3, v: f64, near: Option<DVec2>) -> f64 {
        let c = self.profile.curve.point(v) - self.origin;
        let (from, to) = (self.flat(c), self.flat(d));
        let size = ON_AXIS * (c.length() + d.length());
        if from.length() <= size || to.length() <= size {
            return near.map_or(0.0, |n| n.x);
        }
        math::atan2(from.cross(to).dot(self.axis), from.dot(to))
    }
}
