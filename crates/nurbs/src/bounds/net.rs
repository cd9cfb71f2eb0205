//! Enclosures of third derivatives from the control nets of Bézier patches.
//!
//! Polynomial: the derivative's own control net encloses it. Rational, S = A/w with A measured from a point near the
//! patch: differentiating A = S w gives S^(ij) = (A^(ij) − Σ binom binom S^(ab) w^(i−a, j−b)) / w, bounded term by term.

use super::Ball;
use crate::{BezierPatch, UvBox};
use glam::{DVec2, DVec3, DVec4};

/// A control net with its degrees; homogeneous points (x w, y w, z w, w).
struct Net {
    degree: [usize; 2],
    points: Vec<DVec4>,
}

impl Net {
    fn new(patch: &BezierPatch, origin: DVec3) -> Self {
        let points = (0..patch.points.len())
            .map(|k| {
                let w = patch.weights.as_ref().map_or(1.0, |w| w[k]);
                ((patch.points[k] - origin) * w).extend(w)
            })
            .collect();
        Self { degree: patch.degree, points }
    }

    fn columns(&self) -> usize {
        self.degree[1] + 1
    }

    /// The net over the part from `a` to `b` of the unit interval in direction `axis`.
    fn restrict(&mut self, axis: usize, a: f64, b: f64) {
        let (rows, columns) = (self.degree[0] + 1, self.columns());
        let (lines, count, stride, step) =
            if axis == 0 { (columns, rows, columns, 1) } else { (rows, columns, 1, columns) };
        for line in 0..lines {
            let at = |i: usize| line * step + i * stride;
            // Keep the part right of a, then of that the part left of b.
            for level in 1..count {
                for i in 0..count - level {
                    self.points[at(i)] = self.points[at(i)].lerp(self.points[at(i + 1)], a);
                }
            }
            let t = if a < 1.0 { (b - a) / (1.0 - a) } else { 0.0 };
            for level in 1..count {
                for i in (level..count).rev() {
                    self.points[at(i)] = self.points[at(i - 1)].lerp(self.points[at(i)], t);
                }
            }
        }
    }

    /// The net of the derivative, `times[axis]` times by each parameter, over a box of this size.
    fn derivative(&self, times: [usize; 2], size: DVec2) -> Net {
        let mut net = Net { degree: self.degree, points: self.points.clone() };
        for axis in 0..2 {
            for _ in 0..times[axis] {
                net = net.difference(axis, if axis == 0 { size.x } else { size.y });
            }
        }
        net
    }

    fn difference(&self, axis: usize, length: f64) -> Net {
        if self.degree[axis] == 0 {
            return Net { degree: [0, 0], points: vec![DVec4::ZERO] };
        }
        let mut degree = self.degree;
        degree[axis] -= 1;
        let factor = self.degree[axis] as f64 / length;
        let columns = self.columns();
        let step = if axis == 0 { columns } else { 1 };
        let mut points = Vec::with_capacity((degree[0] + 1) * (degree[1] + 1));
        for i in 0..=degree[0] {
            for j in 0..=degree[1] {
                let k = i * columns + j;
                points.push((self.points[k + step] - self.points[k]) * factor);
            }
        }
        Net { degree, points }
    }

    fn ball(&self) -> Ball {
        let center = self.points.iter().map(|p| p.truncate()).sum::<DVec3>() / self.points.len() as f64;
        let radius = self.points.iter().fold(0.0f64, |m, p| m.max((p.truncate() - center).length()));
        Ball { center, radius }
    }

    fn norm(&self) -> f64 {
        self.points.iter().fold(0.0f64, |m, p| m.max(p.truncate().length()))
    }

    fn weight_norm(&self) -> f64 {
        self.points.iter().fold(0.0f64, |m, p| m.max(p.w.abs()))
    }
}

/// Suuu, Suuv, Suvv, Svvv over cell (a, b) of `parts` × `parts` of the patch over `span`.
pub(super) fn third_derivatives(
    patch: &BezierPatch,
    span: UvBox,
    (a, b): (usize, usize),
    parts: usize,
) -> [Ball; 4] {
    const THIRD: [[usize; 2]; 4] = [[3, 0], [2, 1], [1, 2], [0, 3]];
    let size = span.size() / parts as f64;
    let middle = patch.points.iter().copied().sum::<DVec3>() / patch.points.len() as f64;
    let mut net = Net::new(patch, middle);
    if parts > 1 {
        let part = |k: usize| (k as f64 / parts as f64, (k + 1) as f64 / parts as f64);
        net.restrict(0, part(a).0, part(a).1);
        net.restrict(1, part(b).0, part(b).1);
    }
    if patch.weights.is_none() {
        return THIRD.map(|times| net.derivative(times, size).ball());
    }
    // Measure from the middle of the cell: what multiplies the weights' derivatives is then as small as can be.
    let center = net.points.iter().map(|p| p.truncate() / p.w).sum::<DVec3>() / net.points.len() as f64;
    for p in &mut net.points {
        *p -= (center * p.w).extend(0.0);
    }
    THIRD.map(|[i, j]| Ball::around_zero(rational(&net, size, i, j)))
}

/// A bound of |S^(i,j)| over the net.
fn rational(net: &Net, size: DVec2, i: usize, j: usize) -> f64 {
    const BINOMIAL: [[f64; 4]; 4] = [[1., 0., 0., 0.], [1., 1., 0., 0.], [1., 2., 1., 0.], [1., 3., 3., 1.]];
    let lowest = net.points.iter().fold(f64::INFINITY, |m, p| m.min(p.w));
    let mut s = [[0.0; 4]; 4];
    let mut w = [[0.0; 4]; 4];
    for a in 0..=i {
        for b in 0..=j {
            if (a, b) == (0, 0) {
                s[0][0] = net.points.iter().fold(0.0f64, |m, p| m.max((p.truncate() / p.w).length()));
                continue;
            }
            let derivative = net.derivative([a, b], size);
            w[a][b] = derivative.weight_norm();
            let mut sum = derivative.norm();
            for k in 0..=a {
                for l in 0..=b {
                    if (k, l) != (a, b) {
                        sum += BINOMIAL[a][k] * BINOMIAL[b][l] * s[k][l] * w[a - k][b - l];
                    }
                }
            }
            s[a][b] = sum / lowest;
        }
    }
    s[i][j]
}

/// The largest jump of Su between two patches that follow each other in u; 0 where it is only rounding.
pub(super) fn jump_u(left: &(UvBox, BezierPatch), right: &(UvBox, BezierPatch)) -> f64 {
    let rate = |(span, patch): &(UvBox, BezierPatch), last: bool| {
        let [m, n] = patch.degree;
        let row = |i: usize, j: usize| i * (n + 1) + j;
        let factor = m as f64 / span.size().x;
        end_rates(
            (0..=n).map(|j| if last { (row(m - 1, j), row(m, j)) } else { (row(0, j), row(1, j)) }),
            patch,
            factor,
            last,
        )
    };
    largest_jump(&rate(left, true), &rate(right, false))
}

/// As [`jump_u`], in v.
pub(super) fn jump_v(left: &(UvBox, BezierPatch), right: &(UvBox, BezierPatch)) -> f64 {
    let rate = |(span, patch): &(UvBox, BezierPatch), last: bool| {
        let [m, n] = patch.degree;
        let row = |i: usize, j: usize| i * (n + 1) + j;
        let factor = n as f64 / span.size().y;
        end_rates(
            (0..=m).map(|i| if last { (row(i, n - 1), row(i, n)) } else { (row(i, 0), row(i, 1)) }),
            patch,
            factor,
            last,
        )
    };
    largest_jump(&rate(left, true), &rate(right, false))
}

/// The derivative across an end of a patch at its control points; of a rational one in projected form.
fn end_rates(
    pairs: impl Iterator<Item = (usize, usize)>,
    patch: &BezierPatch,
    factor: f64,
    last: bool,
) -> Vec<DVec3> {
    pairs
        .map(|(a, b)| {
            let d = (patch.points[b] - patch.points[a]) * factor;
            match &patch.weights {
                None => d,
                Some(w) => d * if last { w[a] / w[b] } else { w[b] / w[a] },
            }
        })
        .collect()
}

fn largest_jump(left: &[DVec3], right: &[DVec3]) -> f64 {
    let size = left.iter().chain(right).fold(0.0f64, |m, d| m.max(d.length()));
    let jump = left.iter().zip(right).fold(0.0f64, |m, (a, b)| m.max((*a - *b).length()));
    if jump > 1e-6 * size { jump } else { 0.0 }
}
