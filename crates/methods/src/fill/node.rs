//! A node of a subdivision: a piece of the surface in NURBS form, and its distance from the bilinear surface
//! through its corners.
//!
//! Source: Balázs, Guthe, Klein 2004, section 5.2, in the form of Kahlesz, Balázs, Klein 2001, Lemmas 1 and
//! 2, with two changes.
//!
//! ```text
//! E = max ‖P_ij − B(ξ_i, η_j)‖      B the bilinear surface through the corners, ξ_i and η_j the Greville
//!                                   abscissae
//! T = P_00 − P_m0 − P_0n + P_mn     (i/m and j/n where the piece is Bézier; splines reproduce bilinear maps
//!                                   at these)
//! error ≤ E + ¼‖T‖                  polynomial, for the two halves of the node
//! error ≤ E + ½‖T‖                  rational with positive weights: the weights move points along the
//!                                   bilinear surface
//! ```
//!
//! The *estimated* error puts S(ξ_i, η_j) in place of P_ij: a sample, no bound.
//!
//! These bound shapes: the points of a rational piece slide along the bilinear surface. Where points are
//! compared at equal parameters ([`off_bilinear`]), w (S − B) in Bernstein form of degree (m + 1, n + 1)
//! takes the place of Lemma 2:
//!
//! ```text
//! Q_{i+a, j+b} += c_ia c_jb w_ij (P_ij − B_ab)      W_{i+a, j+b} += c_ia c_jb w_ij
//! a, b ∈ {0, 1}, B_ab the corners
//! c_i0 = (m + 1 − i)/(m + 1)    c_i1 = (i + 1)/(m + 1)      ‖S − B‖ ≤ max ‖Q‖/W
//! ```

use chordal_nurbs::{DVec2, DVec3, NurbsSurface};
use chordal_tessellate::Bound;

/// How the error of a node is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// From the control points: a bound.
    Conservative,
    /// From the surface at their abscissae.
    Estimated,
}

impl Measure {
    /// How a node is measured where facets are judged in this way.
    pub fn of(bound: Bound) -> Self {
        match bound {
            Bound::Proven => Measure::Conservative,
            Bound::Estimated => Measure::Estimated,
        }
    }
}

/// The flatness of a node by its control net.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Flatness {
    /// E.
    pub bilinear: f64,
    /// E and the share of ‖T‖.
    pub error: f64,
    /// Where E is reached, in the node's parameters.
    pub worst: DVec2,
    /// The largest distance of a control point from the chord of its line along u, and along v, and where it
    /// lies.
    pub bend: [(f64, f64); 2],
}

/// Greville abscissae: the means of `degree` successive knots.
pub fn greville(degree: usize, knots: &[f64], count: usize) -> Vec<f64> {
    (0..count).map(|i| knots[i + 1..=i + degree].iter().sum::<f64>() / degree as f64).collect()
}

/// The bilinear surface through the corners of a piece.
pub struct Bilinear {
    corners: [DVec3; 4],
    min: DVec2,
    size: DVec2,
}

impl Bilinear {
    pub fn new(piece: &NurbsSurface) -> Self {
        let [m, n] = piece.counts();
        let p = piece.points();
        let domain = piece.domain();
        Self { corners: [p[0], p[(m - 1) * n], p[n - 1], p[m * n - 1]], min: domain.min, size: domain.size() }
    }

    pub fn at(&self, p_uv: DVec2) -> DVec3 {
        let t = (p_uv - self.min) / self.size;
        let [a, b, c, d] = self.corners;
        a.lerp(b, t.x).lerp(c.lerp(d, t.x), t.y)
    }

    /// T.
    pub fn twist(&self) -> DVec3 {
        let [a, b, c, d] = self.corners;
        a - b - c + d
    }
}

impl Flatness {
    pub fn new(piece: &NurbsSurface, measure: Measure) -> Self {
        let [m, n] = piece.counts();
        let [p, q] = piece.degree();
        let (us, vs) = (greville(p, piece.knots_u(), m), greville(q, piece.knots_v(), n));
        let weights = piece.weights();
        let positive = weights.is_none_or(|w| w.iter().all(|&w| w > 0.0));
        // Without positive weights, the control points bound nothing; the proof that all methods share
        // decides.
        let sampled = measure == Measure::Estimated || !positive;
        let net: Vec<DVec3> = if sampled {
            us.iter().flat_map(|&u| vs.iter().map(move |&v| piece.point(DVec2::new(u, v)))).collect()
        } else {
            piece.points().to_vec()
        };
        let bilinear = Bilinear::new(piece);
        let mut found = Self { worst: DVec2::new(us[0], vs[0]), ..Self::default() };
        for (i, &u) in us.iter().enumerate() {
            for (j, &v) in vs.iter().enumerate() {
                let at = DVec2::new(u, v);
                let distance = net[i * n + j].distance(bilinear.at(at));
                if distance > found.bilinear {
                    (found.bilinear, found.worst) = (distance, at);
                }
            }
        }
        found.bend = [bend(&us, n, |i, j| net[i * n + j]), bend(&vs, m, |j, i| net[i * n + j])];
        let share = if weights.is_some() && measure == Measure::Conservative { 0.5 } else { 0.25 };
        found.error = found.bilinear + share * bilinear.twist().length();
        found
    }
}

/// How far a Bézier piece lies from the bilinear surface through its corners, at equal parameters, at most;
/// infinite where weights are not positive.
pub fn off_bilinear(piece: &NurbsSurface) -> f64 {
    let Some(weights) = piece.weights() else { return Flatness::new(piece, Measure::Conservative).bilinear };
    if !weights.iter().all(|&w| w > 0.0) {
        return f64::INFINITY;
    }
    let [rows, columns] = piece.counts();
    let corners = Bilinear::new(piece).corners;
    let share = |i: usize, a: usize, rows: usize| {
        let numerator = if a == 0 { rows - i } else { i + 1 };
        numerator as f64 / rows as f64
    };
    let mut sums = vec![(DVec3::ZERO, 0.0); (rows + 1) * (columns + 1)];
    for (k, (&p, &w)) in piece.points().iter().zip(weights).enumerate() {
        let (i, j) = (k / columns, k % columns);
        for (a, b) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            let w = w * share(i, a, rows) * share(j, b, columns);
            let sum = &mut sums[(i + a) * (columns + 1) + j + b];
            sum.0 += w * (p - corners[a + 2 * b]);
            sum.1 += w;
        }
    }
    sums.into_iter().fold(0.0, |worst: f64, (q, w)| worst.max(q.length() / w))
}

/// How far lines of the net lie from their chords: the largest distance, and its abscissa.
fn bend(abscissae: &[f64], lines: usize, point: impl Fn(usize, usize) -> DVec3) -> (f64, f64) {
    let last = abscissae.len() - 1;
    let (start, length) = (abscissae[0], abscissae[last] - abscissae[0]);
    let mut found = (0.0, start + 0.5 * length);
    for line in 0..lines {
        let (a, b) = (point(0, line), point(last, line));
        for (i, &t) in abscissae.iter().enumerate() {
            let distance = point(i, line).distance(a.lerp(b, (t - start) / length));
            if distance > found.0 {
                found = (distance, t);
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use chordal_nurbs::math;
    use proptest::prelude::*;

    fn clamped(degree: usize, inner: &[f64]) -> Vec<f64> {
        let mut knots = vec![0.0; degree + 1];
        knots.extend_from_slice(inner);
        knots.extend(vec![1.0; degree + 1]);
        knots
    }

    /// The distance of a point from a triangle.
    fn distance(p: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
        let n = (b - a).cross(c - a);
        let inside = [(a, b), (b, c), (c, a)].iter().all(|&(a, b)| (b - a).cross(p - a).dot(n) >= 0.0);
        if inside && n.length() > 0.0 {
            return (p - a).dot(n.normalize()).abs();
        }
        [(a, b), (b, c), (c, a)].iter().fold(f64::INFINITY, |m, &(a, b)| {
            let t = ((p - a).dot(b - a) / (b - a).length_squared().max(1e-300)).clamp(0.0, 1.0);
            m.min(p.distance(a.lerp(b, t)))
        })
    }

    #[test]
    fn a_bilinear_spline_has_no_error_but_its_twist() {
        // z = uv over the unit square as a bicubic spline with two spans in u.
        let knots_u = clamped(3, &[0.3]);
        let (us, vs) = (greville(3, &knots_u, 5), greville(2, &clamped(2, &[]), 3));
        let points = us.iter().flat_map(|&u| vs.iter().map(move |&v| DVec3::new(u, v, u * v))).collect();
        let s = NurbsSurface::new([3, 2], knots_u, clamped(2, &[]), points, None).expect("valid");
        let f = Flatness::new(&s, Measure::Conservative);
        assert!(f.bilinear < 1e-15, "{f:?}");
        assert!((f.error - 0.25).abs() < 1e-15, "{f:?}");
    }

    #[test]
    fn a_parabolic_sheet_bends_one_way_only() {
        // z = u² of degree (2, 1): the middle control row lies ½ below its chord at u = ½.
        let rows = [(0.0, 0.0), (0.5, 0.0), (1.0, 1.0)];
        let points = rows.iter().flat_map(|&(u, z)| [0.0, 1.0].map(|v| DVec3::new(u, v, z))).collect();
        let s = NurbsSurface::new([2, 1], clamped(2, &[]), clamped(1, &[]), points, None).expect("valid");
        let f = Flatness::new(&s, Measure::Conservative);
        assert_eq!((f.error, f.worst.x), (0.5, 0.5));
        assert_eq!(f.bend, [(0.5, 0.5), (0.0, 0.5)]);
        assert_eq!(Flatness::new(&s, Measure::Estimated).error, 0.25);
    }

    proptest! {
        /// The bound holds for the two triangles of a node, rational or not.
        #[test]
        fn the_conservative_error_bounds_the_distance_to_the_two_halves(
            net in prop::collection::vec((-1.0f64..1.0, -1.0f64..1.0, -1.0f64..1.0, -3.0f64..3.0), 20),
            rational in any::<bool>(),
        ) {
            let points: Vec<DVec3> = net.iter().map(|&(x, y, z, _)| DVec3::new(x, y, z)).collect();
            let weights = rational.then(|| net.iter().map(|p| math::pow(10.0, p.3)).collect());
            let s = NurbsSurface::new([3, 2], clamped(3, &[0.4]), clamped(2, &[0.7]), points, weights)
                .expect("valid");
            let f = Flatness::new(&s, Measure::Conservative);
            let corner = |u: f64, v: f64| s.point(DVec2::new(u, v));
            let (a, b, c, d) = (corner(0., 0.), corner(1., 0.), corner(1., 1.), corner(0., 1.));
            for halves in [[[a, b, c], [a, c, d]], [[a, b, d], [b, c, d]]] {
                for i in 0..=12 {
                    for j in 0..=12 {
                        let p = corner(f64::from(i) / 12.0, f64::from(j) / 12.0);
                        let far = distance(p, halves[0]).min(distance(p, halves[1]));
                        prop_assert!(far <= f.error * (1.0 + 1e-12), "{far} > {}", f.error);
                    }
                }
            }
        }
    }
}
