//! The sizing metric. Lengths in it are counted in allowed chords: an edge of length 1 is as long as it may
//! be.

use crate::limits::Limits;
use chordal_chart::{SeamMetric, Seams};
use chordal_nurbs::{DVec2, DVec3, SurfaceJet, math};

/// A symmetric positive semi-definite form on parameter space.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Metric {
    pub uu: f64,
    pub uv: f64,
    pub vv: f64,
}

/// Bits of a metric's numbers that are kept, and the number of steps that they make. The dropped bits hold
/// rounding; with more bits, rounding would decide between two flips, with fewer, real differences would be
/// lost.
const SETTLED_BITS: u32 = 26;
const SETTLED: f64 = (1u64 << SETTLED_BITS) as f64;

/// A number rounded to [`SETTLED_BITS`] bits.
fn settled(x: f64) -> f64 {
    let dropped = f64::MANTISSA_DIGITS - 1 - SETTLED_BITS;
    let rounded = f64::from_bits((x.to_bits() + (1 << (dropped - 1))) >> dropped << dropped);
    if x.is_finite() && rounded.is_finite() { rounded } else { x }
}

impl Metric {
    pub fn dot(&self, a: DVec2, b: DVec2) -> f64 {
        self.uu * a.x * b.x + self.uv * (a.x * b.y + a.y * b.x) + self.vv * a.y * b.y
    }

    pub fn length(&self, d: DVec2) -> f64 {
        self.dot(d, d).max(0.0).sqrt()
    }

    pub fn determinant(&self) -> f64 {
        self.uu * self.vv - self.uv * self.uv
    }

    pub fn plus(self, other: Metric, factor: f64) -> Metric {
        Metric {
            uu: self.uu + other.uu * factor,
            uv: self.uv + other.uv * factor,
            vv: self.vv + other.vv * factor,
        }
    }

    /// The metric without its last bits, which hold rounding and must not decide which of two flips is
    /// better.
    pub fn settled(self) -> Metric {
        let shared = settled(self.uu * self.vv).sqrt();
        let uv =
            if shared > 0.0 { ((self.uv / shared) * SETTLED).trunc() / SETTLED * shared } else { self.uv };
        Metric { uu: settled(self.uu), uv, vv: settled(self.vv) }
    }

    /// How far the lines of each parameter bend sideways within the surface, per square of the parameter.
    ///
    /// A long step along such a line cuts across the surface beside it. The normal curvature does not show
    /// this.
    pub fn sideways(jet: &SurfaceJet) -> Metric {
        let n = jet.du.cross(jet.dv).normalize_or_zero();
        let bend = |d: DVec3, second: DVec3| second.dot(n.cross(d.normalize_or_zero())).abs();
        Metric { uu: bend(jet.du, jet.duu), uv: 0.0, vv: bend(jet.dv, jet.dvv) }
    }

    pub fn mean<const N: usize>(metrics: [Metric; N]) -> Metric {
        let sum = metrics.iter().fold(Metric::default(), |sum, &m| sum.plus(m, 1.0));
        Metric::default().plus(sum, 1.0 / N as f64)
    }
}

/// The curvature of a surface at a point, in allowed chords.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Sizing {
    /// |II|/8ε, III/α² and I/L², the largest in each principal direction: an edge of length 1 is as long as
    /// allowed.
    pub metric: Metric,
    /// II/8ε with its signs.
    pub signed: Metric,
    /// Gaussian curvature.
    pub gauss: f64,
    /// |Su × Sv|.
    pub area: f64,
}

impl Sizing {
    /// `None` where the surface has no tangent plane (a pole, an apex).
    pub fn new(jet: &SurfaceJet, limits: &Limits) -> Option<Self> {
        Self::known_within(jet, limits, 0.0)
    }

    /// The sizing at a place that is known only within `distance`: the normals are taken to turn no faster
    /// than on a ball of that radius, because in a tighter fold it is unknown which side the place is on.
    pub fn known_within(jet: &SurfaceJet, limits: &Limits, distance: f64) -> Option<Self> {
        let cross = jet.du.cross(jet.dv);
        let area = cross.length();
        let speed = jet.du.length();
        if !(area > 1e-12 * jet.du.length_squared().max(jet.dv.length_squared())) || !area.is_finite() {
            return None;
        }
        let n = cross / area;
        // Orthonormal tangents e1 along Su and e2: Su = a e1, Sv = b e1 + h e2.
        let (a, b, h) = (speed, jet.du.dot(jet.dv) / speed, area / speed);
        let (l, m, k) = (n.dot(jet.duu), n.dot(jet.duv), n.dot(jet.dvv));
        let s11 = l / (a * a);
        let s12 = (m - s11 * a * b) / (a * h);
        let s22 = (k - 2.0 * (b / a) * m + math::square(b / a) * l) / (h * h);
        // Principal curvatures and their directions.
        let mean = 0.5 * (s11 + s22);
        let half = 0.5 * (s11 - s22);
        let radius = math::hypot(half, s12);
        let (k1, k2) = (mean + radius, mean - radius);
        let (cosine, sine) = if radius > 0.0 { (half / radius, s12 / radius) } else { (1.0, 0.0) };
        let size = |k: f64| {
            let by_sag = k.abs() / (8.0 * limits.tolerance);
            let by_angle = math::square(k.abs().min(1.0 / distance) / limits.angle);
            by_sag.max(by_angle).max(1.0 / (limits.length * limits.length))
        };
        let (m1, m2) = (size(k1), size(k2));
        let (c2, s2, cs) = (0.5 * (1.0 + cosine), 0.5 * (1.0 - cosine), 0.5 * sine);
        let (m11, m12, m22) = (m1 * c2 + m2 * s2, (m1 - m2) * cs, m1 * s2 + m2 * c2);
        let metric = Metric {
            uu: m11 * a * a,
            uv: m11 * a * b + m12 * a * h,
            vv: m11 * b * b + 2.0 * m12 * b * h + m22 * h * h,
        };
        let per = 1.0 / (8.0 * limits.tolerance);
        let signed = Metric { uu: l * per, uv: m * per, vv: k * per };
        Some(Self { metric, signed, gauss: k1 * k2, area })
    }
}

impl SeamMetric for Limits {
    fn length(&self, jet: &SurfaceJet, step_uv: DVec2) -> f64 {
        Sizing::new(jet, self).map_or(0.0, |sizing| sizing.metric.length(step_uv))
    }
}

impl Limits {
    /// Cuts through faces, in chords of this length in the metric.
    pub(crate) fn seams(&self, chord: f64) -> Seams<'_> {
        Seams { metric: self, chord, tolerance: self.tolerance }
    }
}
