//! Third derivatives of surfaces that are swept along a line or around an axis, and how far they stray.
//!
//! Notation: a rotation by u about the axis a: S_uu is minus the part of S across the axis, so S_uuu = −S_u,
//! S_uuv = a × (a × S_v), S_uvv = a × S_vv; S_vvv is the profile's, turned. Fourth derivatives follow
//! likewise, and are bounded by the distance from the axis and the profile's derivatives; times half the
//! extent they bound how third derivatives stray.

use super::{Piece, SurfaceBounds, overlapped};
use crate::math;
use crate::{Curve, Range, Surface, SurfaceJet, UvBox};
use glam::{DVec2, DVec3};

/// uuu, uuv, uvv, vvv in the middle of a box and how far they stray over it.
pub(super) struct Thirds {
    pub center: [DVec3; 4],
    pub stray: [f64; 4],
}

impl Thirds {
    /// Around an axis; `profile` is S_vvv with its stray along v, `fourth` bounds uuuu, uuuv, uuvv, uvvv.
    fn around(axis: DVec3, jet: &SurfaceJet, half: DVec2, profile: (DVec3, f64), fourth: [f64; 4]) -> Self {
        let (vvv, stray) = profile;
        Self {
            center: [-jet.du, axis.cross(axis.cross(jet.dv)), axis.cross(jet.dvv), vvv],
            stray: std::array::from_fn(|i| {
                fourth[i] * half.x + if i < 3 { fourth[i + 1] * half.y } else { stray }
            }),
        }
    }
}

/// Of surfaces that are trigonometric in u (and v).
pub(super) fn elementary_thirds(surface: &Surface, b: UvBox, jet: &SurfaceJet, half: DVec2) -> Thirds {
    match surface {
        Surface::Cylinder { frame, radius } => {
            Thirds::around(frame.z, jet, half, (DVec3::ZERO, 0.0), [radius.abs(), 0.0, 0.0, 0.0])
        }
        Surface::Cone { frame, radius, half_angle } => {
            let t = math::tan(*half_angle);
            let r = (radius + b.min.y * t).abs().max((radius + b.max.y * t).abs());
            Thirds::around(frame.z, jet, half, (DVec3::ZERO, 0.0), [r, t.abs(), 0.0, 0.0])
        }
        Surface::Sphere { frame, radius } => {
            let r = radius.abs();
            Thirds::around(frame.z, jet, half, (-jet.dv, r * half.y), [r; 4])
        }
        Surface::Torus { frame, major, minor } => {
            let r = minor.abs();
            Thirds::around(frame.z, jet, half, (-jet.dv, r * half.y), [major.abs() + r, r, r, r])
        }
        _ => Thirds { center: [DVec3::ZERO; 4], stray: [0.0; 4] },
    }
}

/// The derivatives of a profile curve over intervals of its parameter.
#[derive(Clone, Debug)]
pub(super) struct ProfileTable {
    /// Interval i runs from `breaks[i]` to `breaks[i + 1]`; the curve is smooth in it.
    pub breaks: Vec<f64>,
    intervals: Vec<Interval>,
    /// At `breaks[i]`, the jump of the first derivative.
    pub jumps: Vec<f64>,
}

#[derive(Clone, Copy, Debug)]
struct Interval {
    /// Bounds of the norms of the first, second and third derivative.
    norms: [f64; 3],
    /// A mean of the third derivative, and how far it strays from that.
    third: DVec3,
    stray: f64,
}

impl Interval {
    fn new(profile: &Curve, from: f64, to: f64) -> Self {
        let norms = [1, 2, 3].map(|order| profile.derivative_bound(order, Range::new(from, to)));
        let fourth = profile.derivative_bound(4, Range::new(from, to));
        let length = to - from;
        // The mean over the middle half lies at most half a length from anywhere.
        let [a, b] = [0.25, 0.75].map(|share| profile.jet(from + share * length).d2);
        let stray = 0.5 * length * fourth;
        // Rounding of the difference: second derivatives are good to some units in the last place.
        let rounding = 1e-12 * (norms[1] / length + norms[2]);
        if stray < norms[2] {
            Self { norms, third: (b - a) / (0.5 * length), stray: stray + rounding }
        } else {
            Self { norms, third: DVec3::ZERO, stray: norms[2] }
        }
    }
}

impl ProfileTable {
    /// Bounds over quarters of every smooth piece keep the enclosures tight without a search per facet.
    const PARTS: usize = 4;

    pub fn new(profile: &Curve, range: Range) -> Self {
        let mut coarse = vec![range.start];
        coarse.extend(profile.all_breaks(range));
        coarse.push(range.end);
        let breaks = subdivided(&coarse, Self::PARTS);
        let intervals = breaks.windows(2).map(|p| Interval::new(profile, p[0], p[1])).collect();
        let jumps = breaks.iter().enumerate().map(|(i, &t)| {
            if i == 0 || i + 1 == breaks.len() || i % Self::PARTS != 0 {
                return 0.0;
            }
            let step = 1e-9 * (breaks[i + 1] - breaks[i - 1]);
            let (before, after) = (profile.jet(t - step), profile.jet(t + step));
            let jump = (after.d1 - before.d1).length();
            let smooth = 4.0 * step * (after.d2.length() + before.d2.length()) + 1e-9 * after.d1.length();
            if jump > smooth { jump } else { 0.0 }
        });
        let jumps = jumps.collect();
        Self { breaks, intervals, jumps }
    }

    /// Appends the pieces that cover a box of an extrusion or a revolution; returns the jumps inside it.
    pub fn pieces(&self, bounds: &SurfaceBounds<'_>, b: UvBox, out: &mut Vec<Piece>) -> DVec2 {
        let axis = match bounds.surface {
            Surface::Revolution { axis_origin, axis, .. } => {
                Some((*axis_origin, axis.normalize_or(DVec3::Z)))
            }
            _ => None,
        };
        let along = if axis.is_some() { b.v() } else { b.u() };
        let (from, to) = overlapped(&self.breaks, along);
        let mut jump = 0.0f64;
        for i in from..to {
            let range = Range::new(along.start.max(self.breaks[i]), along.end.min(self.breaks[i + 1]));
            let interval = self.intervals[i];
            if i > from {
                jump = jump.max(self.jumps[i]);
            }
            let Some((origin, axis)) = axis else {
                bounds.push(UvBox::from_ranges(range, b.v()), out, |_, _| Thirds {
                    center: [interval.third, DVec3::ZERO, DVec3::ZERO, DVec3::ZERO],
                    stray: [interval.stray, 0.0, 0.0, 0.0],
                });
                continue;
            };
            let piece = UvBox::from_ranges(b.u(), range);
            bounds.push(piece, out, |jet, half| {
                let [first, second, third] = interval.norms;
                let out = jet.p - origin;
                // The largest distance from the axis, from the middle and the profile's speed.
                let radius = (out - axis * out.dot(axis)).length() + first * half.y;
                let vvv = rotated(interval.third, axis, piece.center().x);
                Thirds::around(axis, jet, half, (vvv, interval.stray), [radius, first, second, third])
            });
        }
        if axis.is_some() { DVec2::new(0.0, jump) } else { DVec2::new(jump, 0.0) }
    }
}

/// A vector turned about a unit axis.
fn rotated(d: DVec3, axis: DVec3, angle: f64) -> DVec3 {
    let (sine, cosine) = math::sin_cos(angle);
    d * cosine + axis.cross(d) * sine + axis * (axis.dot(d) * (1.0 - cosine))
}

/// Splits each interval into `parts`.
fn subdivided(breaks: &[f64], parts: usize) -> Vec<f64> {
    let mut fine = Vec::with_capacity((breaks.len() - 1) * parts + 1);
    for pair in breaks.windows(2) {
        fine.extend((0..parts).map(|k| pair[0] + (pair[1] - pair[0]) * k as f64 / parts as f64));
    }
    fine.extend(breaks.last());
    fine
}
