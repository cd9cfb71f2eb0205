//! Points of a spline surface one after the other, with what the last one left behind.
//!
//! Source: Balázs, Guthe, Klein 2004, section 8. Notation: `S = Σ_i B_i(u) Σ_j B_j(v) P_ij`; the inner sums
//! are the *row sums*.
//!
//! | since the last point | computed anew | cost, degrees p and q |
//! |---|---|---|
//! | same v, same u-span | basis in u | p² |
//! | same v | basis in u, row sums | p² + pq |
//! | same u | basis in v, row sums | q² + pq |
//! | neither | both | p² + q² + pq |
//!
//! Points are evaluated in the order of v, then u; as p² is what remains, u and v are swapped where p is the
//! larger degree ([`CoherentEvaluator::order`] sorts accordingly). Results are those of
//! [`NurbsSurface::point`] to rounding: sums are taken in another order.

use crate::NurbsSurface;
use crate::basis::Basis;
use crate::homogeneous::Homogeneous;
use glam::{DVec2, DVec3, Vec2Swizzles as _};
use std::borrow::Cow;

/// Evaluates a surface at points that have coordinates in common with their predecessors.
#[derive(Debug)]
pub struct CoherentEvaluator<'a> {
    surface: Cow<'a, NurbsSurface>,
    is_swapped: bool,
    last: DVec2,
    along_u: Option<Sums>,
    along_v: Option<Sums>,
    /// Σ_j B_j(v) P_ij for the rows of the last u-span, relative to `origin`.
    rows: Vec<Homogeneous<DVec3>>,
    /// First row of `rows`.
    first_row: usize,
    origin: DVec3,
    /// Row sums and basis functions that were taken over from the point before.
    reused: [usize; 2],
}

/// Basis functions at one parameter.
#[derive(Clone, Debug)]
struct Sums {
    first: usize,
    values: Vec<f64>,
}

impl Sums {
    fn fill(slot: &mut Option<Self>, degree: usize, knots: &[f64], t: f64) {
        let basis = Basis::<1>::new(degree, knots, t);
        let sums = slot.get_or_insert_with(|| Self { first: 0, values: Vec::with_capacity(degree + 1) });
        sums.first = basis.first;
        sums.values.clear();
        sums.values.extend_from_slice(basis.row(0));
    }
}

impl<'a> CoherentEvaluator<'a> {
    /// An evaluator that knows no point yet; swaps u and v where that is cheaper.
    pub fn new(surface: &'a NurbsSurface) -> Self {
        let [p, q] = surface.degree();
        let is_swapped = p > q;
        Self::as_is(
            if is_swapped { Cow::Owned(surface.swapped()) } else { Cow::Borrowed(surface) },
            is_swapped,
        )
    }

    /// The same without the swap.
    pub fn unswapped(surface: &'a NurbsSurface) -> Self {
        Self::as_is(Cow::Borrowed(surface), false)
    }

    fn as_is(surface: Cow<'a, NurbsSurface>, is_swapped: bool) -> Self {
        Self {
            surface,
            is_swapped,
            last: DVec2::NAN,
            along_u: None,
            along_v: None,
            rows: Vec::new(),
            first_row: usize::MAX,
            origin: DVec3::ZERO,
            reused: [0, 0],
        }
    }

    /// True where u and v have changed places.
    pub fn is_swapped(&self) -> bool {
        self.is_swapped
    }

    /// How often a basis (of either direction) and how often the row sums served again.
    pub fn reused(&self) -> [usize; 2] {
        self.reused
    }

    /// The order in which these points are cheapest: indices.
    pub fn order(&self, points: &[DVec2]) -> Vec<u32> {
        let key = |i: u32| {
            let p = points[i as usize];
            if self.is_swapped { (p.x, p.y) } else { (p.y, p.x) }
        };
        let mut order: Vec<u32> = (0..points.len() as u32).collect();
        order.sort_unstable_by(|&i, &j| {
            let (a, b) = (key(i), key(j));
            a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)).then(i.cmp(&j))
        });
        order
    }

    /// The point at `uv`, clamped to the domain.
    pub fn point(&mut self, p_uv: DVec2) -> DVec3 {
        let at = if self.is_swapped { p_uv.yx() } else { p_uv };
        let [p, q] = self.surface.degree();
        let same_v = at.y == self.last.y;
        if same_v {
            self.reused[0] += 1;
        } else {
            Sums::fill(&mut self.along_v, q, self.surface.knots_v(), at.y);
        }
        if at.x == self.last.x {
            self.reused[0] += 1;
        } else {
            Sums::fill(&mut self.along_u, p, self.surface.knots_u(), at.x);
        }
        self.last = at;
        let first = self.along_u.as_ref().map_or(0, |b| b.first);
        if same_v && first == self.first_row {
            self.reused[1] += 1;
        } else {
            self.sum_rows(first);
        }
        let Some(basis) = &self.along_u else { return DVec3::ZERO };
        let sum =
            basis.values.iter().zip(&self.rows).fold(Homogeneous::default(), |sum, (b, row)| sum + *row * *b);
        self.origin + if self.surface.weights().is_some() { sum.project() } else { sum.v }
    }

    /// Points all in a row, in the cheapest order, each at its own place of the result.
    pub fn points(&mut self, uv: &[DVec2]) -> Vec<DVec3> {
        let mut found = vec![DVec3::ZERO; uv.len()];
        for i in self.order(uv) {
            found[i as usize] = self.point(uv[i as usize]);
        }
        found
    }

    fn sum_rows(&mut self, first: usize) {
        let Some(basis) = &self.along_v else { return };
        let [p, _] = self.surface.degree();
        let [_, count_v] = self.surface.counts();
        let points = self.surface.points();
        let origin = points[first * count_v + basis.first];
        self.rows.clear();
        for i in first..=first + p {
            let at = i * count_v + basis.first;
            let net = &points[at..at + basis.values.len()];
            self.rows.push(match self.surface.weights() {
                None => {
                    let terms = net.iter().zip(&basis.values);
                    Homogeneous { v: terms.fold(DVec3::ZERO, |sum, (p, b)| sum + (*p - origin) * *b), w: 1.0 }
                }
                Some(weights) => {
                    let weights = &weights[at..at + basis.values.len()];
                    let terms = net.iter().zip(&basis.values).zip(weights);
                    terms.fold(Homogeneous::default(), |sum, ((p, b), w)| {
                        sum + Homogeneous { v: (*p - origin) * (b * w), w: b * w }
                    })
                }
            });
        }
        self.first_row = first;
        self.origin = origin;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math;

    fn knots(degree: usize) -> Vec<f64> {
        let mut knots = vec![0.0; degree + 1];
        knots.extend([0.3, 0.6]);
        knots.resize(2 * degree + 4, 1.0);
        knots
    }

    fn surface(p: usize, q: usize, rational: bool) -> NurbsSurface {
        let count = (p + 3) * (q + 3);
        let point =
            |k: usize| DVec3::new(math::cos(k as f64), math::sin(1.3 * k as f64), 1e3 + 0.1 * k as f64);
        let weights = rational.then(|| (0..count).map(|k| 1.0 + 0.3 * (k % 5) as f64).collect());
        NurbsSurface::new([p, q], knots(p), knots(q), (0..count).map(point).collect(), weights)
            .expect("valid")
    }

    fn grid(n: usize) -> Vec<DVec2> {
        let at = |k: usize| k as f64 / (n - 1) as f64;
        (0..n * n).map(|k| DVec2::new(at(k % n), at(k / n))).collect()
    }

    #[test]
    fn points_are_the_surface_s_in_any_order() {
        for (p, q) in [(1, 1), (2, 3), (5, 2), (3, 3), (12, 4)] {
            for rational in [false, true] {
                let s = surface(p, q, rational);
                let mut uv = grid(9);
                uv.extend([DVec2::new(0.31, 0.77), DVec2::new(0.31, 0.78), DVec2::new(-1.0, 2.0)]);
                let mut sorted = CoherentEvaluator::new(&s);
                let mut as_given = CoherentEvaluator::unswapped(&s);
                assert_eq!(sorted.is_swapped(), p > q);
                for (found, &at) in sorted.points(&uv).iter().zip(&uv) {
                    assert!(found.distance(s.point(at)) < 1e-12, "{p} {q} {at}");
                    assert!(as_given.point(at).distance(s.point(at)) < 1e-12);
                }
            }
        }
    }

    #[test]
    fn a_grid_needs_one_basis_a_point_and_row_sums_once_a_span() {
        let s = surface(3, 3, false);
        let mut e = CoherentEvaluator::new(&s);
        e.points(&grid(10));
        // Ten rows in v over three spans in u each.
        assert_eq!(e.reused(), [90, 100 - 30]);
    }
}
