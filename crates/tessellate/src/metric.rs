//! The sizing metric: lengths in it are counted in allowed chords, so an edge of length 1 is as long as it may be.

use chordal_nurbs::DVec2;

/// A symmetric positive semi-definite form on parameter space.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Metric {
    pub uu: f64,
    pub uv: f64,
    pub vv: f64,
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

    pub fn mean<const N: usize>(metrics: [Metric; N]) -> Metric {
        let sum = metrics.iter().fold(Metric::default(), |sum, &m| sum.plus(m, 1.0));
        Metric::default().plus(sum, 1.0 / N as f64)
    }
}
