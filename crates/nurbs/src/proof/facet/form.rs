//! Second derivatives of one coordinate over a triangle, as a linear function and a remainder, and what they
//! make of the error of linear interpolation.
//!
//! Notation: T the triangle with corners p_i and centroid c, d_i the edge opposite corner i, λ barycentric
//! coordinates, H(x) = M + K·(x − c) the modelled second derivatives, r how far the true ones stray from
//! them.
//!
//! The interpolation error of a function with second derivatives H is the cubic −½ Σ λ_j λ_k M\[d_i, d_i\] +
//! C(λ), C in Bernstein form (Farin, *Curves and Surfaces for CAGD*, chapter 17): its coefficients follow
//! from the second derivatives at the corners, because those of the error are the function's and the error
//! vanishes at the corners.

use crate::{Component, Piece};
use glam::{DVec2, DVec3};

/// Second derivatives over a triangle: uu, uv, vv at the centroid, their rates uuu, uuv, uvv, vvv, and how
/// far they stray.
#[derive(Clone, Copy, Debug)]
pub(super) struct Form {
    pub middle: [f64; 3],
    pub third: [f64; 4],
    pub reach: [f64; 3],
}

impl Form {
    /// Of w·(S − anchor), times the weight, over the pieces; `at` is the centroid.
    pub fn new(pieces: &[Piece], at: DVec2, w: DVec3, anchor: DVec3) -> Self {
        Self::enclosing(pieces, at, |piece| piece.along(w, anchor))
    }

    /// Of the weight.
    pub fn weight(pieces: &[Piece], at: DVec2) -> Self {
        Self::enclosing(pieces, at, Piece::weight)
    }

    fn enclosing(pieces: &[Piece], at: DVec2, along: impl Fn(&Piece) -> Component) -> Self {
        let third = match pieces {
            [piece] if piece.center.is_finite() => along(piece).third,
            _ => mean_third(pieces, &along),
        };
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for piece in pieces {
            let own = along(piece);
            let step = if piece.center.is_finite() { piece.center - at } else { DVec2::ZERO };
            let off: [f64; 4] = std::array::from_fn(|i| (own.third[i] - third[i]).abs());
            let (h, far) = (piece.half, piece.half + piece.offset);
            for i in 0..3 {
                let value = own.second[i] - third[i] * step.x - third[i + 1] * step.y;
                let reach = off[i] * h.x + off[i + 1] * h.y + own.stray[i] * far.x + own.stray[i + 1] * far.y;
                low[i] = low[i].min(value - reach);
                high[i] = high[i].max(value + reach);
            }
        }
        Self {
            middle: std::array::from_fn(|i| 0.5 * (low[i] + high[i])),
            third,
            reach: std::array::from_fn(|i| 0.5 * (high[i] - low[i])),
        }
    }

    pub fn divided(mut self, by: f64) -> Self {
        self.middle.iter_mut().chain(&mut self.third).chain(&mut self.reach).for_each(|x| *x /= by);
        self
    }

    /// M[d, d].
    fn middle_along(&self, d: DVec2) -> f64 {
        let [uu, uv, vv] = self.middle;
        uu * d.x * d.x + 2.0 * uv * d.x * d.y + vv * d.y * d.y
    }

    /// K[a, b, x].
    fn third_along(&self, a: DVec2, b: DVec2, x: DVec2) -> f64 {
        let [uuu, uuv, uvv, vvv] = self.third;
        let (uu, uv, vv) = (uuu * x.x + uuv * x.y, uuv * x.x + uvv * x.y, uvv * x.x + vvv * x.y);
        uu * a.x * b.x + uv * (a.x * b.y + a.y * b.x) + vv * a.y * b.y
    }

    /// How far second derivatives along `d` stray.
    pub fn reach_along(&self, d: DVec2) -> f64 {
        let [uu, uv, vv] = self.reach;
        uu * d.x * d.x + 2.0 * uv * (d.x * d.y).abs() + vv * d.y * d.y
    }

    /// The largest second derivative along the segment `d` through the middle of which it was taken.
    pub fn largest_along(&self, d: DVec2) -> f64 {
        self.middle_along(d).abs() + 0.5 * self.third_along(d, d, d).abs() + self.reach_along(d)
    }

    /// The modelled interpolation error over the triangle with these edges.
    pub fn error(&self, d: &[DVec2; 3]) -> Cubic {
        let h = d.map(|d| self.middle_along(d));
        if self.third == [0.0; 4] {
            return Cubic { h, ..Cubic::default() };
        }
        // Corner i as seen from the centroid.
        let corner: [DVec2; 3] = std::array::from_fn(|i| (d[(i + 1) % 3] - d[(i + 2) % 3]) / 3.0);
        let ends: [[f64; 2]; 3] =
            std::array::from_fn(|i| [1, 2].map(|k| self.third_along(d[i], d[i], corner[(i + k) % 3])));
        let sides = ends.map(|[a, b]| [-(2.0 * a + b) / 18.0, -(a + 2.0 * b) / 18.0]);
        // D²f[p1 − p0, p2 − p0] at corner 0, where p1 − p0 = d2 and p2 − p0 = −d1.
        let mixed = -self.third_along(d[2], d[1], corner[0]);
        let inner = mixed / 6.0 + sides[2][0] + sides[1][1];
        Cubic { h, ends, sides, inner }
    }
}

/// The mean third derivatives, by area; zero where one does not know where its pieces lie.
fn mean_third(pieces: &[Piece], along: impl Fn(&Piece) -> Component) -> [f64; 4] {
    if pieces.iter().any(|piece| !piece.center.is_finite()) {
        return [0.0; 4];
    }
    let (mut sum, mut area) = ([0.0; 4], 0.0);
    for piece in pieces {
        let weight = piece.half.x * piece.half.y;
        let third = along(piece).third;
        area += weight;
        for i in 0..4 {
            sum[i] += weight * third[i];
        }
    }
    if area > 0.0 { sum.map(|s| s / area) } else { [0.0; 4] }
}

/// The interpolation error of a cubic over a triangle.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Cubic {
    /// Second derivatives along the edges, at the centroid.
    pub h: [f64; 3],
    /// How they differ at the two ends of each edge.
    ends: [[f64; 2]; 3],
    /// Bernstein coefficients of C on edge i, nearer to corner i + 1 and nearer to corner i + 2; the others
    /// are zero.
    sides: [[f64; 2]; 3],
    inner: f64,
}

impl Cubic {
    /// The largest coefficient of the cubic part, which bounds it.
    pub fn cubic_part(&self) -> f64 {
        self.sides.as_flattened().iter().fold(self.inner.abs(), |m, b| m.max(b.abs()))
    }

    /// A bound of the error over the triangle.
    pub fn largest(&self) -> f64 {
        let edges = (0..3).fold(0.0f64, |m, i| m.max(self.on_edge(i)));
        edges.max(largest_quadratic(self.h) + self.cubic_part())
    }

    /// The largest error on edge i, exactly: the maximum of t (1 − t) (|h|/2 + |s| (1 − 2t)/12), s the change
    /// of h.
    pub fn on_edge(&self, i: usize) -> f64 {
        let [start, end] = self.ends[i];
        let (a, b) = (0.5 * (self.h[i] + 0.5 * (start + end)).abs(), (end - start).abs() / 12.0);
        let root = (a * a + 3.0 * b * b).sqrt();
        let x = if a + root > 0.0 { b / (a + root) } else { 0.0 };
        0.25 * (1.0 - x * x) * (a + b * x)
    }

    /// A bound of the error between the points of a lattice, times the square of its parts: the second
    /// derivatives are those somewhere in the triangle.
    pub fn largest_between(&self, parts: usize) -> f64 {
        let change = (0..3).fold(0.0f64, |m, i| m.max(self.change(i)));
        largest_quadratic(self.h) + change / 6.0 + self.cubic_part() / parts as f64
    }

    /// The error in the middle of edge i.
    pub fn mid_edge(&self, i: usize) -> f64 {
        (self.h[i] + 0.5 * (self.ends[i][0] + self.ends[i][1])).abs() / 8.0
    }

    /// The largest second derivative along edge i anywhere in the triangle.
    pub fn steepest(&self, i: usize) -> f64 {
        self.h[i].abs() + self.change(i)
    }

    /// How far the second derivative along edge i is from that at the centroid, at most.
    fn change(&self, i: usize) -> f64 {
        // Linear, with mean zero over the corners: the third corner has minus the sum of the other two.
        let [start, end] = self.ends[i];
        start.abs().max(end.abs()).max((start + end).abs())
    }

    /// The error at barycentric coordinates `w`.
    pub fn at(&self, w: [f64; 3]) -> f64 {
        let side = |i: usize| {
            let (j, k) = (w[(i + 1) % 3], w[(i + 2) % 3]);
            j * k * (3.0 * (j * self.sides[i][0] + k * self.sides[i][1]) - 0.5 * self.h[i])
        };
        side(0) + side(1) + side(2) + 6.0 * w[0] * w[1] * w[2] * self.inner
    }
}

/// The largest |½ Σ_{i<j} λ_i λ_j h_ij| over the triangle: on an edge, or at the critical point inside.
fn largest_quadratic(h: [f64; 3]) -> f64 {
    // h[i] belongs to the edge opposite corner i.
    let [c, b, a] = h;
    let on_edges = a.abs().max(b.abs()).max(c.abs()) / 8.0;
    let weights = [c * (a + b - c), b * (a + c - b), a * (b + c - a)];
    let inside = weights.iter().all(|&w| w > 0.0) || weights.iter().all(|&w| w < 0.0);
    let sum = weights[0] + weights[1] + weights[2];
    if inside && sum != 0.0 { on_edges.max((a * b * c / (2.0 * sum)).abs()) } else { on_edges }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cubic's error by its own values.
    #[test]
    fn the_modelled_error_of_a_cubic_is_its_error() {
        let f = |p: DVec2| {
            let DVec2 { x, y } = p;
            0.3 + x - 2.0 * y + 1.5 * x * x - 0.7 * x * y + 0.4 * y * y + 0.9 * x * x * x - 1.1 * x * x * y
                + 0.8 * x * y * y
                + 0.35 * y * y * y
        };
        let p = [DVec2::new(0.1, -0.2), DVec2::new(1.2, 0.3), DVec2::new(0.4, 1.1)];
        let c = (p[0] + p[1] + p[2]) / 3.0;
        let third = [5.4, -2.2, 1.6, 2.1];
        let form = Form {
            middle: [
                3.0 + third[0] * c.x + third[1] * c.y,
                -0.7 + third[1] * c.x + third[2] * c.y,
                0.8 + third[2] * c.x + third[3] * c.y,
            ],
            third,
            reach: [0.0; 3],
        };
        let cubic = form.error(&[p[2] - p[1], p[0] - p[2], p[1] - p[0]]);
        let (mut worst, mut on_edge) = (0.0f64, [0.0f64; 3]);
        for w in super::super::lattice(60) {
            let at = p[0] * w[0] + p[1] * w[1] + p[2] * w[2];
            let error = f(at) - (f(p[0]) * w[0] + f(p[1]) * w[1] + f(p[2]) * w[2]);
            assert!((cubic.at(w) - error).abs() < 1e-13, "{w:?}: {} {error}", cubic.at(w));
            worst = worst.max(error.abs());
            for i in 0..3 {
                if w[i] == 0.0 {
                    on_edge[i] = on_edge[i].max(error.abs());
                }
            }
        }
        assert!(worst <= cubic.largest() && cubic.largest() < 1.5 * worst, "{worst} {}", cubic.largest());
        for i in 0..3 {
            let bound = cubic.on_edge(i);
            assert!(on_edge[i] <= bound * (1.0 + 1e-12) && bound < 1.002 * on_edge[i], "{on_edge:?} {bound}");
            assert!(cubic.mid_edge(i) <= bound);
        }
    }
}
