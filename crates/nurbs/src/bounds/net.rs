//! Enclosures of second and third derivatives from the control nets of Bézier patches, in homogeneous coordinates.
//!
//! A derivative's own control net encloses it. Rational patches are not divided: what a proof needs of S = A/w is
//! n·(S − a) = n·(A − a w)/w, so it is enough to know the derivatives of the polynomial (A, w).

use super::{Ball4, Cell};
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

    /// Index distances: (lines across `axis`, points along it, step along, step to the next line).
    fn strides(&self, axis: usize) -> (usize, usize, usize, usize) {
        let (rows, columns) = (self.degree[0] + 1, self.degree[1] + 1);
        if axis == 0 { (columns, rows, columns, 1) } else { (rows, columns, 1, columns) }
    }

    /// The net over the part from `a` to `b` of the unit interval in direction `axis`.
    fn restrict(&mut self, axis: usize, a: f64, b: f64) {
        let (lines, count, stride, step) = self.strides(axis);
        let t = if a < 1.0 { (b - a) / (1.0 - a) } else { 0.0 };
        for line in 0..lines {
            let at = |i: usize| line * step + i * stride;
            // Keep the part right of a, then of that the part left of b.
            for level in 1..count {
                for i in 0..count - level {
                    self.points[at(i)] = self.points[at(i)].lerp(self.points[at(i + 1)], a);
                }
            }
            for level in 1..count {
                for i in (level..count).rev() {
                    self.points[at(i)] = self.points[at(i - 1)].lerp(self.points[at(i)], t);
                }
            }
        }
    }

    /// The net of the derivative along `axis`, over a box of this length in that direction.
    fn derivative(&self, axis: usize, length: f64) -> Net {
        if self.degree[axis] == 0 {
            return Net { degree: [0, 0], points: vec![DVec4::ZERO] };
        }
        let mut degree = self.degree;
        degree[axis] -= 1;
        let factor = self.degree[axis] as f64 / length;
        let columns = self.degree[1] + 1;
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

    /// The value in the middle of the box.
    fn middle(&self) -> DVec4 {
        let [m, n] = self.degree;
        let mut sum = DVec4::ZERO;
        let mut scale_u = 0.5f64.powi(m as i32 + n as i32);
        for i in 0..=m {
            let mut scale = scale_u;
            for j in 0..=n {
                sum += self.points[i * (n + 1) + j] * scale;
                scale *= (n - j) as f64 / (j + 1) as f64;
            }
            scale_u *= (m - i) as f64 / (i + 1) as f64;
        }
        sum
    }

    fn ball(&self) -> Ball4 {
        let center = self.middle();
        let (mut radius, mut weight_radius) = (0.0f64, 0.0f64);
        for p in &self.points {
            let d = *p - center;
            radius = radius.max(d.truncate().length_squared());
            weight_radius = weight_radius.max(d.w.abs());
        }
        Ball4 { center, radius: radius.sqrt(), weight_radius }
    }

    fn norm(&self) -> f64 {
        self.points.iter().fold(0.0f64, |m, p| m.max(p.truncate().length_squared())).sqrt()
    }

    fn weight_norm(&self) -> f64 {
        self.points.iter().fold(0.0f64, |m, p| m.max(p.w.abs()))
    }
}

/// Cell `at` of the patch over `span` cut into `parts` in u and v.
pub(super) fn cell_of(patch: &BezierPatch, span: UvBox, at: [usize; 2], parts: [usize; 2]) -> Cell {
    let size = span.size() / DVec2::new(parts[0] as f64, parts[1] as f64);
    let middle = patch.points.iter().copied().sum::<DVec3>() / patch.points.len() as f64;
    let mut net = Net::new(patch, middle);
    for axis in 0..2 {
        if parts[axis] > 1 {
            let part = |k: usize| k as f64 / parts[axis] as f64;
            net.restrict(axis, part(at[axis]), part(at[axis] + 1));
        }
    }
    let corner = span.min + DVec2::new(at[0] as f64, at[1] as f64) * size;
    cell(&net, middle, UvBox::new(corner, corner + size))
}

/// What the uncertainty of the third derivatives over a whole patch adds to the bound of a facet as large as the patch.
pub(super) fn slack(patch: &BezierPatch, span: UvBox) -> f64 {
    let middle = patch.points.iter().copied().sum::<DVec3>() / patch.points.len() as f64;
    let size = span.size();
    let cell = cell(&Net::new(patch, middle), middle, span);
    // A facet is measured from one of its corners, which lies within the patch.
    let extent = patch.points.iter().fold(0.0f64, |m, p| m.max(p.distance(middle)));
    let [uuu, uuv, uvv, vvv] = cell.third.map(|ball| ball.radius + extent * ball.weight_radius);
    let DVec2 { x, y } = size;
    (uuu * x * x * x + 3.0 * uuv * x * x * y + 3.0 * uvv * x * y * y + vvv * y * y * y)
        / (16.0 * cell.least_weight)
}

fn cell(net: &Net, origin: DVec3, over: UvBox) -> Cell {
    let size = over.size();
    let (du, dv) = (net.derivative(0, size.x), net.derivative(1, size.y));
    let (duu, duv, dvv) = (du.derivative(0, size.x), du.derivative(1, size.y), dv.derivative(1, size.y));
    let third = [
        duu.derivative(0, size.x),
        duu.derivative(1, size.y),
        duv.derivative(1, size.y),
        dvv.derivative(1, size.y),
    ];
    let least_weight = net.points.iter().fold(f64::INFINITY, |m, p| m.min(p.w));
    let extent = net.points.iter().fold(0.0f64, |m, p| m.max(p.truncate().length() / p.w.abs()));
    let rate = |d: &Net| (d.norm() + extent * d.weight_norm()) / least_weight;
    let (s_u, s_v) = (rate(&du), rate(&dv));
    let (w_u, w_v) = (du.weight_norm(), dv.weight_norm());
    // A_uu = S_uu w + 2 S_u w_u + S w_uu, and so on.
    let norm = |d: &Net, mixed: f64| (d.norm() + mixed + extent * d.weight_norm()) / least_weight;
    Cell {
        origin,
        center: over.center(),
        second: [duu.middle(), duv.middle(), dvv.middle()],
        third: third.map(|net| net.ball()),
        least_weight,
        weight_rate: DVec2::new(w_u, w_v),
        norms: [norm(&duu, 2.0 * s_u * w_u), norm(&duv, s_u * w_v + s_v * w_u), norm(&dvv, 2.0 * s_v * w_v)],
    }
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
