//! Flatness of a Bézier patch by projecting its control net.
//!
//! Source: Ma and Hewitt 2002, section 4: a patch is flat enough when its control net is; how to tell is
//! taken from their projection of points onto surfaces, where a net is replaced by the plane quadrilateral
//! below it. In that form:
//!
//! ```text
//! n    the normal across both diagonals of the corners; the corners lie h above and below the plane with it,
//!      alternately
//! Q    the corners projected onto that plane
//! d    the largest distance of a control point from Q: its height, and how far beside Q it falls
//! error ≤ d + h
//! ```
//!
//! The distance from a convex set is a convex function, and the patch lies within the convex hull of its net
//! (rational ones too, with positive weights), so no point of the patch is farther from Q than d; the two
//! triangles over Q are within h of it. Unlike Lemma 2 this sees the shape only: a flat patch passes however
//! unevenly its parameters run. It counts the twist of the corners twice; where Lemmas 1 and 2 give less, or
//! Q is not convex, they decide.
//!
//! The paper does not say in which directions a patch is halved. Here it is those in which lines of the
//! net bend, both where they bend about alike: halving a cylinder along its axis would double its patches for
//! nothing.

use super::cells::{Rule, Split};
use super::grid::halves;
use super::node::{Bilinear, Flatness, Measure, greville};
use super::quadtree::at_knots;
use chordal_nurbs::{DVec2, DVec3, NurbsSurface, math};

/// Bézier patches halved until their nets are flat.
#[derive(Clone, Copy, Debug)]
pub struct ProjectedNet;

impl Rule for ProjectedNet {
    fn name(&self) -> &'static str {
        "Bézier patches by projected nets"
    }

    fn first_cuts(&self, root: &NurbsSurface, _: f64) -> Vec<Split> {
        at_knots(root)
    }

    fn cuts(&self, piece: &NurbsSurface, tolerance: f64, measure: Measure) -> Vec<Split> {
        if projected_error(piece, measure) <= tolerance { Vec::new() } else { self.forced(piece, measure) }
    }

    fn forced(&self, piece: &NurbsSurface, measure: Measure) -> Vec<Split> {
        let bend = Flatness::new(piece, measure).bend.map(|(bend, _)| bend);
        let enough = ALIKE * bend[0].max(bend[1]);
        halves(piece).into_iter().filter(|half| bend[half.axis] >= enough).collect()
    }
}

/// A direction in which lines bend by less than this share of the other's is not halved.
const ALIKE: f64 = 0.5;

/// How far a patch may lie from the two halves of the quadrilateral of its corners.
pub fn projected_error(piece: &NurbsSurface, measure: Measure) -> f64 {
    let by_lemmas = Flatness::new(piece, measure).error;
    let positive = piece.weights().is_none_or(|w| w.iter().all(|&w| w > 0.0));
    let Some(plane) =
        (positive || measure == Measure::Estimated).then(|| Quadrilateral::under(piece)).flatten()
    else {
        return by_lemmas;
    };
    let farthest = match measure {
        Measure::Conservative => piece.points().iter().fold(0.0, |d: f64, &p| d.max(plane.distance(p))),
        Measure::Estimated => {
            let [p, q] = piece.degree();
            let [m, n] = piece.counts();
            let (us, vs) = (greville(p, piece.knots_u(), m), greville(q, piece.knots_v(), n));
            us.iter()
                .flat_map(|&u| vs.iter().map(move |&v| DVec2::new(u, v)))
                .fold(0.0, |d: f64, uv| d.max(plane.distance(piece.point(uv))))
        }
    };
    (farthest + plane.height).min(by_lemmas)
}

/// A convex quadrilateral in a plane.
struct Quadrilateral {
    feet: [DVec3; 4],
    normal: DVec3,
    /// How far the corners themselves lie above or below.
    height: f64,
}

impl Quadrilateral {
    /// Below the corners of a piece; none where it would not be convex.
    fn under(piece: &NurbsSurface) -> Option<Self> {
        let domain = piece.domain();
        let bilinear = Bilinear::new(piece);
        let corners = [(0., 0.), (1., 0.), (1., 1.), (0., 1.)]
            .map(|c| bilinear.at(domain.min + domain.size() * DVec2::from(c)));
        let [a, b, c, d] = corners;
        let normal = (c - a).cross(d - b).try_normalize()?;
        let center = (a + b + c + d) / 4.0;
        let feet = corners.map(|p| p - normal * normal.dot(p - center));
        let height = corners.iter().fold(0.0f64, |h, p| h.max(normal.dot(*p - center).abs()));
        let turns = |i: usize| {
            let [p, q, r] = [feet[i], feet[(i + 1) % 4], feet[(i + 2) % 4]];
            (q - p).cross(r - q).dot(normal)
        };
        (0..4).all(|i| turns(i) >= 0.0).then_some(Self { feet, normal, height })
    }

    fn distance(&self, p: DVec3) -> f64 {
        let height = self.normal.dot(p - self.feet[0]);
        let foot = p - self.normal * height;
        let mut beside = f64::INFINITY;
        let mut inside = true;
        for i in 0..4 {
            let (a, b) = (self.feet[i], self.feet[(i + 1) % 4]);
            let d = b - a;
            inside &= d.cross(foot - a).dot(self.normal) >= 0.0;
            let t = ((foot - a).dot(d) / d.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
            beside = beside.min(foot.distance(a + d * t));
        }
        if inside { height.abs() } else { math::hypot(height, beside) }
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{distance_to_halves, patch, patches};
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_plane_patch_is_flat_however_its_parameters_run() {
        // x = u³: Lemma 2 sees an error along the plane, the projected net none.
        let points = [0.0, 0.0, 0.0, 1.0].iter().flat_map(|&x| [0.0, 1.0].map(|y| DVec3::new(x, y, 0.0)));
        let s = patch([3, 1], points.collect(), None);
        assert_eq!(projected_error(&s, Measure::Conservative), 0.0);
        assert!(Flatness::new(&s, Measure::Conservative).error > 0.3);
    }

    #[test]
    fn closed_forms() {
        // z = u² over the unit square: the middle row lies ½/√2 off the plane x = z through the corners.
        let rows = [(0.0, 0.0), (0.5, 0.0), (1.0, 1.0)];
        let points = rows.iter().flat_map(|&(u, z)| [0.0, 1.0].map(|v| DVec3::new(u, v, z))).collect();
        let sheet = patch([2, 1], points, None);
        assert!((projected_error(&sheet, Measure::Conservative) - 0.5f64.sqrt() / 2.0).abs() < 1e-15);
        // Half as much on the surface itself, which the estimate samples.
        assert!((projected_error(&sheet, Measure::Estimated) - 0.5f64.sqrt() / 4.0).abs() < 1e-15);
        // z = uv: the corners lie ¼/√1½ above and below the plane z = (u + v)/2 − ¼, which counts twice;
        // Lemma 1 has ¼.
        let points = [(0., 0.), (0., 1.), (1., 0.), (1., 1.)].map(|(u, v)| DVec3::new(u, v, u * v)).to_vec();
        let twisted = patch([1, 1], points, None);
        let plane = Quadrilateral::under(&twisted).expect("convex");
        assert!((plane.height - 0.25 / 1.5f64.sqrt()).abs() < 1e-15);
        assert_eq!(projected_error(&twisted, Measure::Conservative), 0.25);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(128))]
        #[test]
        fn no_point_is_farther_from_the_halves_than_the_error(s in patches()) {
            let error = projected_error(&s, Measure::Conservative);
            let found = distance_to_halves(&s, 12);
            prop_assert!(found <= error * (1.0 + 1e-9) + 1e-12, "{found} > {error}");
        }
    }
}
