//! Where a planar Bézier curve meets a straight line, by the explicit form.
//!
//! Source: Kahlesz, Balázs, Klein 2001, section 5. The signed distances of the control points from the line,
//! times their weights, are the coefficients of a polynomial over the curve's own parameter that is zero
//! exactly where the curve meets the line. It is halved until its coefficients are all on one side, or the
//! piece is as small as rounding: there is a hit. As the curve lies in the convex hull of its coefficients,
//! no root is missed, those of even order (where curve and line only touch) included.

use crate::math;
use crate::{BezierCurve, blossom};
use glam::DVec2;

/// How a curve and a line meet.
#[derive(Clone, Debug, PartialEq)]
pub enum LineCrossings {
    /// The whole curve runs along the line.
    Along,
    /// At these parameters, increasing; none where they do not meet.
    At(Vec<f64>),
}

/// Pieces are halved at most this often.
const DEEPEST: u32 = 44;

impl BezierCurve<DVec2> {
    /// Every parameter from 0 to 1 at which the curve meets the line through `origin` along `direction`.
    /// Points nearer to the line than `zero` are on it.
    pub fn line_crossings(&self, origin: DVec2, direction: DVec2, zero: f64) -> LineCrossings {
        let normal = direction.normalize_or_zero().perp();
        let weight = |i: usize| self.weights.as_ref().map_or(1.0, |w| w[i]);
        let distances: Vec<f64> = self.points.iter().map(|p| normal.dot(*p - origin)).collect();
        if distances.iter().all(|d| d.abs() <= zero) {
            return LineCrossings::Along;
        }
        let explicit: Vec<f64> = distances.iter().enumerate().map(|(i, d)| d * weight(i)).collect();
        // Weights of one sign scale the distance; the smallest bounds what is certainly on the line.
        let least = (0..explicit.len()).fold(f64::INFINITY, |m, i| m.min(weight(i).abs()));
        LineCrossings::At(zeros(&explicit, zero * least))
    }
}

/// The middles of all intervals in which the polynomial with these Bernstein coefficients cannot be told from
/// zero.
fn zeros(coefficients: &[f64], zero: f64) -> Vec<f64> {
    let mut hits: Vec<(f64, f64)> = Vec::new();
    let mut stack = vec![(coefficients.to_vec(), 0.0f64, 0u32)];
    while let Some((row, a, depth)) = stack.pop() {
        let width = math::powi(0.5, depth as i32);
        if row.iter().all(|c| *c > zero) || row.iter().all(|c| *c < -zero) {
            continue;
        }
        if depth == DEEPEST || row.iter().all(|c| c.abs() <= zero) {
            match hits.last_mut() {
                // Its neighbour: one hit.
                Some(last) if last.1 >= a => last.1 = a + width,
                _ => hits.push((a, a + width)),
            }
            continue;
        }
        let mut above = row;
        let below = blossom::split(&mut above, 0.5);
        stack.push((above, a + 0.5 * width, depth + 1));
        stack.push((below, a, depth + 1));
    }
    let ends = |(a, b): (f64, f64)| match (a == 0.0, b == 1.0) {
        (true, false) => 0.0,
        (false, true) => 1.0,
        _ => 0.5 * (a + b),
    };
    hits.into_iter().map(ends).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn curve(points: &[(f64, f64)], weights: Option<Vec<f64>>) -> BezierCurve<DVec2> {
        BezierCurve { points: points.iter().map(|&p| p.into()).collect(), weights }
    }

    fn at(crossings: LineCrossings) -> Vec<f64> {
        match crossings {
            LineCrossings::At(found) => found,
            LineCrossings::Along => panic!("along"),
        }
    }

    #[test]
    fn closed_forms() {
        // y = 4t(1 − t)·2 − 1: zero at ½ ± ½/√2.
        let arch = curve(&[(0., -1.), (0.5, 3.), (1., -1.)], None);
        let found = at(arch.line_crossings(DVec2::ZERO, DVec2::X, 1e-15));
        let exact = [0.5 - 0.5f64.sqrt() / 2.0, 0.5 + 0.5f64.sqrt() / 2.0];
        assert!(found.len() == 2 && found.iter().zip(exact).all(|(f, e)| (f - e).abs() < 1e-12), "{found:?}");
        // Touching from below: the top, once.
        let found = at(arch.line_crossings(DVec2::Y, DVec2::X, 1e-15));
        assert!(found.len() == 1 && (found[0] - 0.5).abs() < 1e-7, "{found:?}");
        assert_eq!(at(arch.line_crossings(DVec2::new(0.0, 1.001), DVec2::X, 1e-15)), []);
        // A quarter of a circle at 45°: half way, whatever the direction of the line.
        let h = 0.5f64.sqrt();
        let quarter = curve(&[(1., 0.), (1., 1.), (0., 1.)], Some(vec![1.0, h, 1.0]));
        let found = at(quarter.line_crossings(DVec2::ZERO, DVec2::ONE, 1e-15));
        assert!(found.len() == 1 && (found[0] - 0.5).abs() < 1e-12, "{found:?}");
        // Ends count.
        assert_eq!(at(quarter.line_crossings(DVec2::ZERO, DVec2::X, 1e-15)), [0.0]);
        assert_eq!(
            curve(&[(0., 2.), (3., 2.)], None).line_crossings(DVec2::Y * 2.0, DVec2::X, 1e-15),
            LineCrossings::Along
        );
    }

    #[test]
    fn an_oscillating_curve_has_as_many_roots_as_its_degree() {
        // Tₙ(2t − 1) in Bernstein form: b_i = (−1)^(n−i)·C(2n, 2i)/C(n, i); its zeros are (1 +
        // cos((2k+1)π/2n))/2.
        let n = 8usize;
        let binomial = |n: usize, k: usize| (0..k).fold(1.0, |b, j| b * (n - j) as f64 / (j + 1) as f64);
        let value = |i: usize| if (n - i)
            .is_multiple_of(2) { 1.0 } else { -1.0 } * binomial(2 * n, 2 * i) / binomial(n, i);
        let points: Vec<(f64, f64)> = (0..=n).map(|i| (i as f64, value(i))).collect();
        let found = at(curve(&points, None).line_crossings(DVec2::ZERO, DVec2::X, 1e-13));
        assert_eq!(found.len(), n);
        for (k, f) in found.iter().rev().enumerate() {
            let exact = 0.5 * (1.0 + math::cos((2 * k + 1) as f64 * std::f64::consts::PI / (2 * n) as f64));
            assert!((f - exact).abs() < 1e-10, "{f} {exact}");
        }
    }

    proptest! {
        /// Brute force: wherever samples change sides, a root lies between; and every root lies on the line.
        #[test]
        fn no_crossing_is_missed(
            net in prop::collection::vec((-1.0f64..1.0, -1.0f64..1.0, -3.0f64..3.0), 2..=21),
            rational in any::<bool>(), angle in 0.0f64..3.2, offset in -0.3f64..0.3,
        ) {
            let weights = rational.then(|| net.iter().map(|n| math::pow(10.0, n.2)).collect());
            let c = curve(&net.iter().map(|n| (n.0, n.1)).collect::<Vec<_>>(), weights);
            let direction = math::direction(angle);
            let origin = direction.perp() * offset;
            let found = at(c.line_crossings(origin, direction, 1e-14));
            let side = |t: f64| direction.perp_dot(c.eval(t) - origin);
            for &t in &found {
                prop_assert!(side(t).abs() < 1e-6, "{t}: {}", side(t));
            }
            for k in 0..500 {
                let (a, b) = (f64::from(k) / 500.0, f64::from(k + 1) / 500.0);
                let crossed = side(a) * side(b) < 0.0 && side(a).abs().min(side(b).abs()) > 1e-9;
                prop_assert!(!crossed || found.iter().any(|&t| t > a && t < b), "between {a} and {b}");
            }
        }
    }
}
