//! Bounds by second derivatives: the largest error of a triangle, from the derivative patches of Bézier
//! pieces.
//!
//! Source: Filip, Magedson, Markot 1986, *Surface algorithms using bounds on derivatives*, which the survey
//! of the Blender wiki builds on ("the derivative is itself a Bézier patch"): over a right-angled triangle
//! with legs a and b along u and v,
//!
//! ```text
//! ‖S − L‖ ≤ ⅛ (a² M_uu + 2ab M_uv + b² M_vv)        M the largest norms of the second derivatives
//! ```
//!
//! Norms come from control points. Rational patches: with A = Σ w(P − c)B measured from a point c of the
//! patch, S − c = A/w, R = max‖P − c‖ and least weight w₀,
//!
//! ```text
//! ‖S_u‖  ≤ (‖A_u‖ + R|w_u|)/w₀
//! ‖S_uv‖ ≤ (‖A_uv‖ + R|w_uv| + ‖S_u‖|w_v| + ‖S_v‖|w_u|)/w₀        S_uu alike
//! ```

use chordal_nurbs::{BezierPatch, DVec2, DVec3, DVec4, NurbsSurface};

/// Largest norms of S_uu, S_uv and S_vv.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SecondNorms {
    pub uu: f64,
    pub uv: f64,
    pub vv: f64,
}

impl SecondNorms {
    /// Of a patch over the unit square; infinite where weights have both signs.
    pub fn of_patch(patch: &BezierPatch) -> Self {
        if !patch.has_positive_weights() {
            return Self { uu: f64::INFINITY, uv: f64::INFINITY, vv: f64::INFINITY };
        }
        let net = Net::new(patch);
        let [a_u, w_u] = net.differences(1, 0);
        let [a_v, w_v] = net.differences(0, 1);
        let [a_uu, w_uu] = net.differences(2, 0);
        let [a_uv, w_uv] = net.differences(1, 1);
        let [a_vv, w_vv] = net.differences(0, 2);
        let (r, w) = (net.reach, net.least_weight);
        let s_u = (a_u + r * w_u) / w;
        let s_v = (a_v + r * w_v) / w;
        Self {
            uu: (a_uu + r * w_uu + 2.0 * s_u * w_u) / w,
            uv: (a_uv + r * w_uv + s_u * w_v + s_v * w_u) / w,
            vv: (a_vv + r * w_vv + 2.0 * s_v * w_v) / w,
        }
    }

    /// Of a whole surface, by its own parameters.
    pub fn of_surface(surface: &NurbsSurface) -> Self {
        surface.bezier_patches(surface.domain()).iter().fold(Self::default(), |m, (b, patch)| {
            let n = Self::of_patch(patch);
            m.max(n.over(b.size().recip()))
        })
    }

    /// The same by parameters that run from 0 to 1 over a box of this size.
    pub fn over(self, size: DVec2) -> Self {
        Self { uu: self.uu * size.x * size.x, uv: self.uv * size.x * size.y, vv: self.vv * size.y * size.y }
    }

    pub fn max(self, other: Self) -> Self {
        Self { uu: self.uu.max(other.uu), uv: self.uv.max(other.uv), vv: self.vv.max(other.vv) }
    }

    /// The error of a cell with these sides.
    pub fn error(&self, a: f64, b: f64) -> f64 {
        0.125 * (a * a * self.uu + 2.0 * a * b * self.uv + b * b * self.vv)
    }
}

/// Homogeneous control points, measured from the middle of the net; weight one where there are none.
struct Net {
    degree: [usize; 2],
    points: Vec<DVec4>,
    reach: f64,
    least_weight: f64,
}

impl Net {
    fn new(patch: &BezierPatch) -> Self {
        let low = patch.points.iter().fold(DVec3::INFINITY, |m, &p| m.min(p));
        let high = patch.points.iter().fold(DVec3::NEG_INFINITY, |m, &p| m.max(p));
        let center = low.midpoint(high);
        let weight = |i: usize| patch.weights.as_ref().map_or(1.0, |w| w[i].abs());
        let indexed = || patch.points.iter().enumerate();
        Self {
            degree: patch.degree,
            points: indexed().map(|(i, &p)| ((p - center) * weight(i)).extend(weight(i))).collect(),
            reach: indexed().fold(0.0, |m, (_, p)| m.max(p.distance(center))),
            least_weight: indexed().fold(f64::INFINITY, |m, (i, _)| m.min(weight(i))),
        }
    }

    /// Bounds of the (i, j)-th derivative: of its spatial part, and of its weight.
    fn differences(&self, i: usize, j: usize) -> [f64; 2] {
        let [m, n] = self.degree;
        if i > m || j > n {
            return [0.0; 2];
        }
        let mut rows: Vec<Vec<DVec4>> = self.points.chunks_exact(n + 1).map(<[DVec4]>::to_vec).collect();
        for _ in 0..i {
            rows = rows.windows(2).map(|w| w[1].iter().zip(&w[0]).map(|(b, a)| *b - *a).collect()).collect();
        }
        for _ in 0..j {
            rows = rows.iter().map(|row| row.windows(2).map(|w| w[1] - w[0]).collect()).collect();
        }
        let falling = |d: usize, k: usize| (0..k).map(|l| (d - l) as f64).product::<f64>();
        let factor = falling(m, i) * falling(n, j);
        let [space, weight] = rows
            .iter()
            .flatten()
            .fold([0.0f64; 2], |[a, w], p| [a.max(p.truncate().length()), w.max(p.w.abs())]);
        [factor * space, factor * weight]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use chordal_nurbs::math;
    use proptest::prelude::*;

    #[test]
    fn a_paraboloid_has_constant_second_derivatives() {
        // z = u² + 3uv over the unit square, degree (2, 1).
        let z = |u: f64, v: f64| [0.0, 0.0, 1.0][(2.0 * u) as usize] + 3.0 * u * v;
        let points =
            [0.0, 0.5, 1.0].iter().flat_map(|&u| [0.0, 1.0].map(|v| DVec3::new(u, v, z(u, v)))).collect();
        let n = SecondNorms::of_patch(&BezierPatch { degree: [2, 1], points, weights: None });
        assert_eq!((n.uu, n.uv, n.vv), (2.0, 3.0, 0.0));
        assert_eq!(n.error(0.5, 1.0), 0.125 * (0.5 + 3.0));
    }

    proptest! {
        #[test]
        fn norms_bound_the_derivatives_of_random_patches(
            net in prop::collection::vec((-1.0f64..1.0, -1.0f64..1.0, -1.0f64..1.0, -3.0f64..3.0), 20),
            rational in any::<bool>(),
            (u, v) in (0.0f64..1.0, 0.0f64..1.0),
        ) {
            let points: Vec<DVec3> = net.iter().map(|&(x, y, z, _)| DVec3::new(x, y, z)).collect();
            let weights = rational.then(|| net.iter().map(|p| math::pow(10.0, p.3)).collect());
            let patch = BezierPatch { degree: [4, 3], points, weights };
            let n = SecondNorms::of_patch(&patch);
            let jet = patch.jet(DVec2::new(u, v));
            for (bound, d) in [(n.uu, jet.duu), (n.uv, jet.duv), (n.vv, jet.dvv)] {
                prop_assert!(d.length() <= bound * (1.0 + 1e-9), "{} > {bound}", d.length());
            }
        }

        #[test]
        fn the_error_bounds_both_halves_of_a_cell(
            net in prop::collection::vec((-1.0f64..1.0, -1.0f64..1.0, -1.0f64..1.0, -1.0f64..1.0), 12),
            rational in any::<bool>(),
            (s, t) in (0.0f64..1.0, 0.0f64..1.0),
        ) {
            let points: Vec<DVec3> = net.iter().map(|&(x, y, z, _)| DVec3::new(x, y, z)).collect();
            let weights = rational.then(|| net.iter().map(|p| math::pow(10.0, p.3)).collect());
            let patch = BezierPatch { degree: [3, 2], points, weights };
            let error = SecondNorms::of_patch(&patch).error(1.0, 1.0);
            let (s, t) = if s + t > 1.0 { (1.0 - s, 1.0 - t) } else { (s, t) };
            let [o, a, b] = [(0., 0.), (1., 0.), (0., 1.)].map(|c| patch.eval(DVec2::from(c)));
            let linear = o + (a - o) * s + (b - o) * t;
            prop_assert!(patch.eval(DVec2::new(s, t)).distance(linear) <= error * (1.0 + 1e-9));
        }
    }
}
