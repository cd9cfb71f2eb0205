//! Enclosures of second and third derivatives from the control nets of Bézier patches, in homogeneous
//! coordinates.
//!
//! A derivative's own control net encloses it. Rational patches are not divided: what a proof needs of S =
//! A/w is n·(S − a) = n·(A − a w)/w, so it is enough to know the derivatives of the polynomial (A, w).

use super::{Ball4, Cell};
use crate::basis::Basis;
use crate::math;
use crate::{BezierPatch, UvBox, work};
use glam::{DVec2, DVec3, DVec4};

/// A control net with its degrees; homogeneous points (x w, y w, z w, w).
#[derive(Clone, Debug)]
pub(super) struct Net {
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
}

/// The degree from which on values are computed in memory of the heap instead of arrays of this length.
///
/// Splines of CAD files have degrees up to 9 with few exceptions. Larger arrays would cost every evaluation
/// time to clear them.
const STACK_WIDTH: usize = 10;

/// The work of a value beside that of its control points.
const POINT: u64 = 16;

/// The work of all derivatives for one control point.
const DERIVATIVES: u64 = 40;

impl Net {
    /// The value at a point of the unit square.
    pub fn point(&self, p: DVec2) -> DVec4 {
        let [m, n] = self.degree;
        work::count(self.points.len() as u64 + POINT);
        if m.max(n) >= STACK_WIDTH {
            let (bu, bv) = (Basis::<1>::bernstein(m, p.x), Basis::<1>::bernstein(n, p.y));
            return self.blend(bu.row(0), bv.row(0));
        }
        let (bu, bv) = (bernstein(m, p.x), bernstein(n, p.y));
        self.blend(&bu[..=m], &bv[..=n])
    }

    fn blend(&self, bu: &[f64], bv: &[f64]) -> DVec4 {
        let rows = self.points.chunks_exact(bv.len()).zip(bu);
        rows.fold(DVec4::ZERO, |sum, (row, &b)| {
            sum + row.iter().zip(bv).fold(DVec4::ZERO, |sum, (&p, &b)| sum + p * b) * b
        })
    }
}

/// The Bernstein polynomials of this degree at `t`.
fn bernstein(degree: usize, t: f64) -> [f64; STACK_WIDTH] {
    let mut values = [0.0; STACK_WIDTH];
    values[0] = 1.0;
    for level in 1..=degree {
        let mut saved = 0.0;
        for value in &mut values[..level] {
            let old = *value;
            *value = saved + (1.0 - t) * old;
            saved = t * old;
        }
        values[level] = saved;
    }
    values
}

/// A Bézier patch over its span, measured from the middle of its net.
#[derive(Clone, Debug)]
pub(super) struct Patch {
    pub span: UvBox,
    pub origin: DVec3,
    pub net: Net,
}

impl Patch {
    pub fn new(span: UvBox, patch: &BezierPatch) -> Self {
        let origin = middle(patch);
        Self { span, origin, net: Net::new(patch, origin) }
    }

    /// Cell `at` of the patch cut into `parts` in u and v.
    pub fn cell(&self, at: [usize; 2], parts: [usize; 2]) -> Cell {
        let size = self.span.size() / DVec2::new(parts[0] as f64, parts[1] as f64);
        let corner = self.span.min + DVec2::new(at[0] as f64, at[1] as f64) * size;
        let over = UvBox::new(corner, corner + size);
        if parts == [1, 1] {
            return cell(&self.net, self.origin, over);
        }
        let mut net = self.net.clone();
        for axis in 0..2 {
            if parts[axis] > 1 {
                let part = |k: usize| k as f64 / parts[axis] as f64;
                net.restrict(axis, part(at[axis]), part(at[axis] + 1));
            }
        }
        cell(&net, self.origin, over)
    }
}

impl Patch {
    /// What the uncertainty of the third derivatives over the whole patch adds to the bound of a facet as
    /// large as the patch.
    pub fn slack(&self) -> f64 {
        let cell = cell(&self.net, self.origin, self.span);
        // A facet is measured from one of its corners, which lies within the patch.
        let extent = self.net.points.iter().fold(0.0f64, |m, p| m.max(p.truncate().length() / p.w));
        let [uuu, uuv, uvv, vvv] = cell.third.map(|ball| ball.radius + extent * ball.weight_radius);
        let DVec2 { x, y } = self.span.size();
        (uuu * x * x * x + 3.0 * uuv * x * x * y + 3.0 * uvv * x * y * y + vvv * y * y * y)
            / (16.0 * cell.least_weight)
    }
}

fn middle(patch: &BezierPatch) -> DVec3 {
    patch.points.iter().copied().sum::<DVec3>() / patch.points.len() as f64
}

fn cell(net: &Net, origin: DVec3, over: UvBox) -> Cell {
    work::count(DERIVATIVES * net.points.len() as u64);
    let size = over.size();
    let mut nets = Nets::new(net);
    let (u, v) = ((0, size.x), (1, size.y));
    let (du, dv) = (nets.derivative(Nets::WHOLE, net.degree, u), nets.derivative(Nets::WHOLE, net.degree, v));
    let (duu, duv, dvv) = (nets.of(du, u), nets.of(du, v), nets.of(dv, v));
    let third = [nets.of(duu, u), nets.of(duu, v), nets.of(duv, v), nets.of(dvv, v)];
    let least_weight = net.points.iter().fold(f64::INFINITY, |m, p| m.min(p.w));
    let extent = net.points.iter().fold(0.0f64, |m, p| m.max(p.truncate().length() / p.w.abs()));
    let rate = |d| (nets.norm(d) + extent * nets.weight_norm(d)) / least_weight;
    let (s_u, s_v) = (rate(du), rate(dv));
    let (w_u, w_v) = (nets.weight_norm(du), nets.weight_norm(dv));
    // A_uu = S_uu w + 2 S_u w_u + S w_uu, and so on.
    let norm = |d, mixed: f64| (nets.norm(d) + mixed + extent * nets.weight_norm(d)) / least_weight;
    Cell {
        origin,
        center: over.center(),
        second: [nets.middle(duu), nets.middle(duv), nets.middle(dvv)],
        third: third.map(|d| nets.ball(d)),
        least_weight,
        weight_rate: DVec2::new(w_u, w_v),
        norms: [norm(duu, 2.0 * s_u * w_u), norm(duv, s_u * w_v + s_v * w_u), norm(dvv, 2.0 * s_v * w_v)],
    }
}

/// The derivatives of a net, one after the other in one list.
struct Nets<'a> {
    whole: &'a [DVec4],
    points: Vec<DVec4>,
}

/// A derivative: where its net begins in the list, and its degrees.
#[derive(Clone, Copy)]
struct Derivative {
    start: usize,
    degree: [usize; 2],
}

impl<'a> Nets<'a> {
    /// Stands for the net itself.
    const WHOLE: usize = usize::MAX;

    fn new(net: &'a Net) -> Self {
        // Two first, three second and four third derivatives, none larger than the net.
        Self { whole: &net.points, points: Vec::with_capacity(9 * net.points.len()) }
    }

    fn of(&mut self, from: Derivative, along: (usize, f64)) -> Derivative {
        self.derivative(from.start, from.degree, along)
    }

    /// The net of the derivative along an axis, over a box of this length in that direction.
    fn derivative(
        &mut self,
        from: usize,
        from_degree: [usize; 2],
        (axis, length): (usize, f64),
    ) -> Derivative {
        let start = self.points.len();
        if from_degree[axis] == 0 {
            self.points.push(DVec4::ZERO);
            return Derivative { start, degree: [0, 0] };
        }
        let mut degree = from_degree;
        degree[axis] -= 1;
        let factor = from_degree[axis] as f64 / length;
        let columns = from_degree[1] + 1;
        let step = if axis == 0 { columns } else { 1 };
        for i in 0..=degree[0] {
            for j in 0..=degree[1] {
                let k = i * columns + j;
                let (a, b) = if from == Self::WHOLE {
                    (self.whole[k], self.whole[k + step])
                } else {
                    (self.points[from + k], self.points[from + k + step])
                };
                self.points.push((b - a) * factor);
            }
        }
        Derivative { start, degree }
    }

    fn points(&self, d: Derivative) -> &[DVec4] {
        &self.points[d.start..d.start + (d.degree[0] + 1) * (d.degree[1] + 1)]
    }

    /// The value in the middle of the box.
    fn middle(&self, d: Derivative) -> DVec4 {
        let [m, n] = d.degree;
        let points = self.points(d);
        let mut sum = DVec4::ZERO;
        let mut scale_u = math::powi(0.5, m as i32 + n as i32);
        for i in 0..=m {
            let mut scale = scale_u;
            for j in 0..=n {
                sum += points[i * (n + 1) + j] * scale;
                scale *= (n - j) as f64 / (j + 1) as f64;
            }
            scale_u *= (m - i) as f64 / (i + 1) as f64;
        }
        sum
    }

    fn ball(&self, d: Derivative) -> Ball4 {
        let center = self.middle(d);
        let (mut radius, mut weight_radius) = (0.0f64, 0.0f64);
        for p in self.points(d) {
            let off = *p - center;
            radius = radius.max(off.truncate().length_squared());
            weight_radius = weight_radius.max(off.w.abs());
        }
        Ball4 { center, radius: radius.sqrt(), weight_radius }
    }

    fn norm(&self, d: Derivative) -> f64 {
        self.points(d).iter().fold(0.0f64, |m, p| m.max(p.truncate().length_squared())).sqrt()
    }

    fn weight_norm(&self, d: Derivative) -> f64 {
        self.points(d).iter().fold(0.0f64, |m, p| m.max(p.w.abs()))
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
