//! Facets of splines, by Bernstein coefficients over the facet.
//!
//! Within one span a spline surface is A/w, polynomials of degree d = p + q over the triangle of parameters.
//! Their coefficients there ([`super::blossom`]) enclose them: with the facet's plane as x y and its normal
//! as z, and lengths measured from a corner of it,
//!
//! ```text
//!   N = max |z| / min w          how far the surface is from the plane
//!   s = max outward / min w      how far its foot in the plane is beyond each side of the facet
//!   b = max |outward| / min w    the same on the side itself, both ways
//! ```
//!
//! 1. A foot beyond a side by s is within √(s² + t²) of that side, t what it is beyond its ends; and within s
//!    over the sine of half the smaller angle there.
//! 2. The other way round, the foot of the surface runs along each side within b of it: a point of the facet
//!    that is under no foot is between a side and that line, within b of it.
//!
//! So the two are within √(N² + max(s, b)²) of each other. The largest coefficient of z is a fifth more than
//! its largest value: where that is too much, the quadratic through the middles of the sides is taken out,
//! whose largest value is known. A facet over several spans is cut at the knots ([`super::parts`]); all parts
//! are compared with the whole facet.

use super::blossom::{MOST_DEGREE, Weights, indices, place, products, weights};
use super::parts::{Corner, for_parts};
use chordal_nurbs::{Curve, DVec2, DVec3, Facet, Surface, math};
use std::borrow::Cow;

/// z, x, y and weight of a coefficient.
type Lanes = [f64; 4];

/// The knots of the direction in which an extrusion is straight.
const STRAIGHT: [f64; 4] = [0.0, 0.0, 1.0, 1.0];

/// A spline prepared for bounds of its facets.
pub(super) struct SplineBound<'a> {
    degree: [usize; 2],
    knots: [&'a [f64]; 2],
    /// v runs fastest.
    points: Cow<'a, [DVec3]>,
    weights: Option<Cow<'a, [f64]>>,
    columns: usize,
    products: Vec<(usize, f64)>,
    indices: Vec<[usize; 3]>,
}

/// Memory that is used from facet to facet.
#[derive(Default)]
pub(crate) struct Scratch {
    weights: [Vec<Weights>; 2],
    rows: Vec<Lanes>,
    coefficients: Vec<Lanes>,
}

/// The facet's axes and lengths, measured from corner 2.
struct FacetFrame {
    origin: DVec3,
    /// z, x, y.
    axes: [DVec3; 3],
    corners: [DVec2; 3],
    /// Directions of the sides, and outwards across them.
    along: [DVec2; 3],
    outward: [DVec2; 3],
}

/// The findings from the coefficients over all parts.
#[derive(Default)]
struct Seen {
    along: f64,
    out: [f64; 3],
    bend: [f64; 3],
    over_ends: [f64; 3],
}

impl<'a> SplineBound<'a> {
    /// `None` for surfaces that are no splines, of high degree, or with weights that are not positive.
    pub fn new(surface: &'a Surface) -> Option<Self> {
        let (degree, knots, points, weights) = match surface {
            Surface::Nurbs(nurbs) => (
                nurbs.degree(),
                [nurbs.knots_u(), nurbs.knots_v()],
                Cow::Borrowed(nurbs.points()),
                nurbs.weights().map(Cow::Borrowed),
            ),
            Surface::Extrusion { profile, direction } => {
                let Curve::Nurbs(curve) = profile else { return None };
                let twice = |w: &[f64]| w.iter().flat_map(|&w| [w, w]).collect::<Vec<f64>>();
                let points = curve.points().iter().flat_map(|&p| [p, p + *direction]).collect();
                let knots = [curve.knots(), &STRAIGHT[..]];
                (
                    [curve.degree(), 1],
                    knots,
                    Cow::Owned(points),
                    curve.weights().map(|w| Cow::Owned(twice(w))),
                )
            }
            _ => return None,
        };
        let is_simple = degree.iter().all(|d| (1..=MOST_DEGREE).contains(d));
        let is_positive = weights.as_ref().is_none_or(|w| w.iter().all(|&w| w > 0.0));
        (is_simple && is_positive).then(|| Self {
            degree,
            knots,
            columns: knots[1].len() - degree[1] - 1,
            products: products(degree),
            indices: indices(degree[0] + degree[1]).collect(),
            points,
            weights,
        })
    }

    /// A bound of the facet over this triangle of parameters.
    pub fn of(&self, uv: [DVec2; 3], facet: &Facet, limit: f64, scratch: &mut Scratch) -> Option<f64> {
        let frame = FacetFrame::new(facet.xyz)?;
        let mut seen = Seen::default();
        let inner = [0, 1].map(|axis| &self.knots[axis][self.degree[axis] + 1..self.end(axis)]);
        for_parts(uv, inner, &mut |part| {
            self.coefficients(part, &frame, scratch);
            let is_whole = part.iter().zip(&uv).all(|(c, p)| c.uv == *p);
            self.look(part, &frame, is_whole, limit, &scratch.coefficients, &mut seen)
        })?;
        Some(math::hypot(seen.along, sideways(&frame, &seen)))
    }

    /// The index of the knot at which the domain ends.
    fn end(&self, axis: usize) -> usize {
        self.knots[axis].len() - self.degree[axis] - 1
    }

    fn span(&self, axis: usize, part: &[Corner; 3]) -> usize {
        let [a, b, c] = part.map(|c| c.uv[axis]);
        let middle = 0.5 * (a.min(b).min(c) + a.max(b).max(c));
        let first = self.degree[axis];
        first + self.knots[axis][first + 1..self.end(axis)].partition_point(|&k| k <= middle)
    }

    /// The coefficients of the surface over a part, in the facet's frame.
    fn coefficients(&self, part: &[Corner; 3], frame: &FacetFrame, scratch: &mut Scratch) {
        let Scratch { weights: of_axes, rows, coefficients } = scratch;
        let [p, q] = self.degree;
        let spans = [0, 1].map(|axis| self.span(axis, part));
        for axis in 0..2 {
            let t = part.map(|c| c.uv[axis]);
            weights(self.knots[axis], self.degree[axis], spans[axis], t, &mut of_axes[axis]);
        }
        let net = self.net([spans[0] - p, spans[1] - q], frame);
        rows.clear();
        for u in &of_axes[0] {
            rows.extend((0..=q).map(|j| combined((0..=p).map(|i| (u[i], &net[i * (q + 1) + j])))));
        }
        coefficients.clear();
        coefficients.resize(self.indices.len(), [0.0; 4]);
        let mut products = self.products.iter();
        for row in rows.chunks_exact(q + 1) {
            for (v, &(to, factor)) in of_axes[1].iter().zip(&mut products) {
                let value = combined(v.iter().copied().zip(row));
                add(&mut coefficients[to], factor, &value);
            }
        }
    }

    /// The control points of a span in the facet's frame.
    fn net(&self, first: [usize; 2], frame: &FacetFrame) -> [Lanes; (MOST_DEGREE + 1) * (MOST_DEGREE + 1)] {
        let [p, q] = self.degree;
        let mut net = [[0.0; 4]; (MOST_DEGREE + 1) * (MOST_DEGREE + 1)];
        for i in 0..=p {
            for j in 0..=q {
                let index = (first[0] + i) * self.columns + first[1] + j;
                let weight = self.weights.as_ref().map_or(1.0, |w| w[index]);
                let point = (self.points[index] - frame.origin) * weight;
                let [z, x, y] = frame.axes.map(|axis| axis.dot(point));
                net[i * (q + 1) + j] = [z, x, y, weight];
            }
        }
        net
    }

    /// Takes what the coefficients show; `None` where it is beyond the limit already.
    fn look(
        &self,
        part: &[Corner; 3],
        frame: &FacetFrame,
        is_whole: bool,
        limit: f64,
        coefficients: &[Lanes],
        seen: &mut Seen,
    ) -> Option<()> {
        let least = coefficients.iter().fold(f64::INFINITY, |m, c| m.min(c[3]));
        let share = if self.weights.is_some() { 1.0 / least } else { 1.0 };
        let mut along = coefficients.iter().fold(0.0f64, |m, c| m.max(c[0].abs())) * share;
        if along > limit && is_whole {
            along = self.without_quadratic(coefficients) * share;
        }
        seen.along = seen.along.max(along);
        if least <= 0.0 || along > limit || along.is_nan() {
            return None;
        }
        for i in 0..3 {
            let outward = frame.across(i);
            let out = coefficients.iter().fold(0.0f64, |m, c| m.max(outward.of(c)));
            seen.out[i] = seen.out[i].max(out * share);
            for k in 0..3 {
                let [a, b] = [(k + 1) % 3, (k + 2) % 3].map(|k| part[k].sides);
                if a & b & (1 << i) != 0 {
                    let on_side = self.indices.iter().zip(coefficients).filter(|(index, _)| index[k] == 0);
                    let bend = on_side.fold(0.0f64, |m, (_, c)| m.max(outward.of(c).abs()));
                    seen.bend[i] = seen.bend[i].max(bend * share);
                }
            }
            if seen.out[i] > 0.0 {
                let [start, end] = frame.beyond(i);
                let over = coefficients.iter().fold(0.0f64, |m, c| m.max(start.of(c)).max(end.of(c)));
                seen.over_ends[i] = seen.over_ends[i].max(over * share);
            }
        }
        Some(())
    }

    /// A bound of |z| over the whole facet, at whose corners it vanishes: the quadratic through the middles
    /// of the sides, and the largest coefficient of the rest.
    fn without_quadratic(&self, coefficients: &[Lanes]) -> f64 {
        let degree = self.degree[0] + self.degree[1];
        let mut binomial = 1.0;
        let mut middles = [0.0; 3];
        for k in 0..=degree {
            for (i, middle) in middles.iter_mut().enumerate() {
                let mut index = [0; 3];
                (index[(i + 1) % 3], index[(i + 2) % 3]) = (k, degree - k);
                *middle += binomial * coefficients[place(degree, index)][0];
            }
            binomial *= (degree - k) as f64 / (k + 1) as f64;
        }
        let q = middles.map(|m| 4.0 * m * math::powi(0.5, degree as i32));
        let scale = 1.0 / (degree * (degree - 1)) as f64;
        let rest = self.indices.iter().zip(coefficients).fold(0.0f64, |m, (&[a, b, c], lanes)| {
            let [a, b, c] = [a, b, c].map(|k| k as f64);
            m.max((lanes[0] - (q[0] * b * c + q[1] * c * a + q[2] * a * b) * scale).abs())
        });
        largest_quadratic(q) + rest
    }
}

/// The largest value over the triangle of |q₀ λ₁λ₂ + q₁ λ₂λ₀ + q₂ λ₀λ₁|: in the middle of a side, or where
/// its gradient vanishes along the triangle, which is at λ_i in the ratio of q_i (q_j + q_k − q_i).
fn largest_quadratic(q: [f64; 3]) -> f64 {
    let sides = q.iter().fold(0.0f64, |m, q| m.max(q.abs())) / 4.0;
    let total = q[0] + q[1] + q[2];
    let at = q.map(|q| q * (total - 2.0 * q));
    let is_inside = at.iter().all(|&x| x > 0.0) || at.iter().all(|&x| x < 0.0);
    let sum = at[0] + at[1] + at[2];
    if is_inside { sides.max((q[0] * q[1] * q[2] / sum).abs()) } else { sides }
}

fn combined<'l>(terms: impl Iterator<Item = (f64, &'l Lanes)>) -> Lanes {
    terms.fold([0.0; 4], |mut sum, (factor, lanes)| {
        add(&mut sum, factor, lanes);
        sum
    })
}

fn add(sum: &mut Lanes, factor: f64, lanes: &Lanes) {
    sum.iter_mut().zip(lanes).for_each(|(sum, value)| *sum += factor * value);
}

/// A length in the facet's plane: the distance from a line.
struct FromLine {
    direction: DVec2,
    offset: f64,
}

impl FromLine {
    fn of(&self, lanes: &Lanes) -> f64 {
        self.direction.x * lanes[1] + self.direction.y * lanes[2] - self.offset * lanes[3]
    }
}

impl FacetFrame {
    /// `None` for a facet without area.
    fn new(xyz: [DVec3; 3]) -> Option<Self> {
        let origin = xyz[2];
        let z = (xyz[1] - xyz[0]).cross(xyz[2] - xyz[0]).try_normalize()?;
        let x = (xyz[0] - origin).try_normalize()?;
        let y = z.cross(x);
        let corners = xyz.map(|p| DVec2::new(x.dot(p - origin), y.dot(p - origin)));
        let sides: [DVec2; 3] = std::array::from_fn(|i| corners[(i + 2) % 3] - corners[(i + 1) % 3]);
        let length = sides.map(DVec2::length);
        let along: [DVec2; 3] = std::array::from_fn(|i| sides[i] / length[i]);
        let outward = along.map(|d| DVec2::new(d.y, -d.x));
        (length.iter().all(|&l| l > 0.0)).then_some(Self { origin, axes: [z, x, y], corners, along, outward })
    }

    fn across(&self, i: usize) -> FromLine {
        let direction = self.outward[i];
        FromLine { direction, offset: direction.dot(self.corners[(i + 1) % 3]) }
    }

    /// Beyond the start and beyond the end of side `i`.
    fn beyond(&self, i: usize) -> [FromLine; 2] {
        let d = self.along[i];
        let from = |direction: DVec2, corner: usize| FromLine {
            direction,
            offset: direction.dot(self.corners[corner]),
        };
        [from(-d, (i + 1) % 3), from(d, (i + 2) % 3)]
    }

    /// The sine of half the smaller angle at the ends of side `i`.
    fn half_sine(&self, i: usize) -> f64 {
        let [d, e, f] = [i, (i + 1) % 3, (i + 2) % 3].map(|k| self.along[k]);
        // At an end, the angle lies between the side and the next one run backwards.
        let cosine = (-d.dot(e)).max(-d.dot(f));
        (0.5 * (1.0 - cosine)).max(0.0).sqrt()
    }
}

/// How far the foot of the surface is beyond the facet, or the facet beyond the foot, at most.
fn sideways(frame: &FacetFrame, seen: &Seen) -> f64 {
    let largest = seen.out.iter().fold(0.0f64, |m, &s| m.max(s));
    let mut sideways = seen.bend.iter().fold(0.0f64, |m, &b| m.max(b));
    for i in (0..3).filter(|&i| seen.out[i] > 0.0) {
        let beside = math::hypot(seen.out[i], seen.over_ends[i]);
        sideways = sideways.max(beside.min(largest / frame.half_sine(i)));
    }
    sideways
}
