//! A cone of directions that holds every normal of a surface, proven from its control net.
//!
//! With positive weights that are products of one factor per row and one per column, the tangents along u lie
//! in the convex cone of the net's legs along u: P_u is a sum of them with positive factors. If they keep
//! within an angle α of an axis a and those along v within β of b, a normal n, being at right angles to one
//! of each, has |n · a| ≤ sin α and |n · b| ≤ sin β. What of n lies in the plane of a and b is then at most
//! √(sin²α + sin²β + 2 sin α sin β |cos θ|) / sin θ, θ the angle between a and b: the sine of its angle to a
//! × b. (Sederberg and Meyers 1988 bound normals in the same way.)

use chordal_nurbs::{DVec3, NurbsSurface, math};

/// Directions within `angle` (radians) of a unit vector.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    pub axis: DVec3,
    pub angle: f64,
}

/// Added to every cone for what rounding turns a direction by, radians.
const ROUNDING: f64 = 1e-6;

impl Cone {
    /// The narrowest about the sum of the directions; `None` where it is no narrower than a half space. Legs
    /// of no length have no direction.
    fn of(legs: impl Iterator<Item = DVec3> + Clone) -> Option<Self> {
        let directions = legs.filter_map(DVec3::try_normalize);
        let axis = directions.clone().sum::<DVec3>().try_normalize()?;
        let angle = directions.map(|d| math::angle_between(d, axis)).fold(0.0, f64::max) + ROUNDING;
        (angle < std::f64::consts::FRAC_PI_2).then_some(Self { axis, angle })
    }

    /// The cone or its opposite, whichever is on the side of `direction`.
    pub fn towards(self, direction: DVec3) -> Self {
        if self.axis.dot(direction) < 0.0 { Self { axis: -self.axis, ..self } } else { self }
    }

    /// True where every direction of the cone is at more than a right angle to all directions within `spread`
    /// of `to_eye`.
    pub fn turns_away(&self, to_eye: DVec3, spread: f64) -> bool {
        math::angle_between(to_eye, self.axis) > std::f64::consts::FRAC_PI_2 + self.angle + spread
    }
}

/// The cone of the normals S_u × S_v; `None` where none narrower than a half space is proven.
pub fn normal_cone(surface: &NurbsSurface) -> Option<Cone> {
    if !surface.weights().is_none_or(|w| separable(w, surface.counts())) {
        return None;
    }
    let [rows, columns] = surface.counts();
    let points = surface.points();
    let at = move |i: usize, j: usize| points[i * columns + j];
    let along_u = (0..rows - 1).flat_map(move |i| (0..columns).map(move |j| at(i + 1, j) - at(i, j)));
    let along_v = (0..rows).flat_map(move |i| (0..columns - 1).map(move |j| at(i, j + 1) - at(i, j)));
    let (u, v) = (Cone::of(along_u)?, Cone::of(along_v)?);
    let theta = math::angle_between(u.axis, v.axis);
    let (a, b) = (math::sin(u.angle), math::sin(v.angle));
    let sine = (a * a + b * b + 2.0 * a * b * math::cos(theta).abs()).sqrt() / math::sin(theta);
    let axis = u.axis.cross(v.axis).try_normalize()?;
    (sine < 1.0).then(|| Cone { axis, angle: math::asin(sine) + ROUNDING })
}

/// True where the weights are positive and w_ij = r_i c_j but for rounding.
fn separable(weights: &[f64], [rows, columns]: [usize; 2]) -> bool {
    let at = |i: usize, j: usize| weights[i * columns + j];
    weights.iter().all(|w| *w > 0.0)
        && (0..rows).all(|i| {
            (0..columns).all(|j| {
                let (product, other) = (at(i, j) * at(0, 0), at(i, 0) * at(0, j));
                (product - other).abs() <= 1e-12 * product
            })
        })
}

#[cfg(test)]
mod tests {
    use super::*;
    use chordal_nurbs::DVec2;

    fn bumpy(seed: u64, height: f64, rational: bool) -> NurbsSurface {
        let mut state = seed;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        let factors: Vec<f64> = (0..10).map(|_| 0.2 + next()).collect();
        let (mut points, mut weights) = (Vec::new(), Vec::new());
        for i in 0..5 {
            for j in 0..5 {
                points.push(DVec3::new(i as f64 + 0.2 * next(), j as f64 + 0.2 * next(), height * next()));
                weights.push(factors[i] * factors[5 + j]);
            }
        }
        let knots = vec![0.0, 0.0, 0.0, 0.0, 0.4, 1.0, 1.0, 1.0, 1.0];
        NurbsSurface::new([3, 3], knots.clone(), knots, points, rational.then_some(weights)).unwrap()
    }

    /// Every normal of random sheets lies in the cone, and flat enough sheets have one.
    #[test]
    fn cones_hold_every_normal() {
        let mut found = 0;
        for seed in 0..60 {
            let surface = bumpy(seed, 0.02 * seed as f64, seed % 2 == 1);
            let Some(cone) = normal_cone(&surface) else { continue };
            found += 1;
            for k in 0..400 {
                let uv = DVec2::new((k % 20) as f64 / 19.0, (k / 20) as f64 / 19.0);
                let (_, du, dv) = surface.jet1(uv);
                assert!(math::angle_between(du.cross(dv), cone.axis) <= cone.angle, "{seed} {uv}");
            }
        }
        assert!(found > 30, "{found}");
    }

    #[test]
    fn weights_that_are_no_products_have_no_cone() {
        let points: Vec<DVec3> =
            [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]].map(DVec3::from).into();
        let knots = vec![0.0, 0.0, 1.0, 1.0];
        let of = |w: [f64; 4]| {
            NurbsSurface::new([1, 1], knots.clone(), knots.clone(), points.clone(), Some(w.into())).unwrap()
        };
        assert!(normal_cone(&of([1.0, 2.0, 3.0, 6.0])).is_some_and(|c| c.axis.z > 0.999 && c.angle < 1e-5));
        assert!(normal_cone(&of([1.0, 2.0, 3.0, 7.0])).is_none());
    }

    #[test]
    fn a_cone_turns_away_beyond_its_angle() {
        let cone = Cone { axis: DVec3::Z, angle: 0.2 };
        let to = |below: f64| DVec3::new(math::cos(below), 0.0, -math::sin(below));
        assert!(!cone.turns_away(to(0.19), 0.0) && cone.turns_away(to(0.21), 0.0));
        assert!(!cone.turns_away(to(0.21), 0.05) && cone.towards(DVec3::NEG_Z).axis.z == -1.0);
    }
}
