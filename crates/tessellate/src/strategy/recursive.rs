//! Recursive subdivision of Bézier patches with a bound from their derivative patches.
//!
//! Source: the survey of the Blender wiki, "Recursive Subdivision / Piecewise Bézier". The surface becomes a quilt of Bézier
//! patches; one whose derivatives allow too large an error is halved across the direction in which they are larger,
//! and so on. The survey speaks of the first derivative, which bounds how long a step is; how far a triangle strays is
//! bounded by the second, a patch as well ([`super::derivatives`]).

use super::cells::{Rule, Split};
use super::derivatives::SecondNorms;
use super::node::Measure;
use super::quadtree::at_knots;
use chordal_nurbs::{BezierPatch, NurbsSurface};

/// Recursive subdivision.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Recursive;

impl Rule for Recursive {
    fn name(&self) -> &'static str {
        "recursively halved Bézier patches"
    }

    fn first_cuts(&self, root: &NurbsSurface, _: f64) -> Vec<Split> {
        at_knots(root)
    }

    fn cuts(&self, piece: &NurbsSurface, tolerance: f64, measure: Measure) -> Vec<Split> {
        // What is left after the knots is one Bézier patch, its points as they are.
        let patch = BezierPatch {
            degree: piece.degree(),
            points: piece.points().to_vec(),
            weights: piece.weights().map(<[f64]>::to_vec),
        };
        let norms = match measure {
            Measure::Conservative => SecondNorms::of_patch(&patch),
            Measure::Estimated => sampled(&patch),
        };
        if norms.error(1.0, 1.0) <= tolerance {
            return Vec::new();
        }
        let axis = usize::from(norms.vv > norms.uu);
        vec![Split { axis, at: piece.domain().center()[axis] }]
    }
}

/// Norms at the corners and in the middle: no bound.
fn sampled(patch: &BezierPatch) -> SecondNorms {
    [(0., 0.), (1., 0.), (0., 1.), (1., 1.), (0.5, 0.5)].iter().fold(SecondNorms::default(), |m, &(u, v)| {
        let jet = patch.jet((u, v).into());
        m.max(SecondNorms { uu: jet.duu.length(), uv: jet.duv.length(), vv: jet.dvv.length() })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use chordal_nurbs::DVec3;

    #[test]
    fn patches_are_halved_across_the_larger_second_derivative() {
        // z = v² (degree 1 × 2): M_vv = 2, error ¼ of the whole patch, 1/16 of a half.
        let cols = [(0.0, 0.0), (0.5, 0.0), (1.0, 1.0)];
        let points = [0.0, 1.0].iter().flat_map(|&u| cols.map(|(v, z)| DVec3::new(u, v, z))).collect();
        let knots = vec![0., 0., 0., 1., 1., 1.];
        let s = NurbsSurface::new([1, 2], vec![0., 0., 1., 1.], knots, points, None).expect("valid");
        assert_eq!(Recursive.cuts(&s, 0.2, Measure::Conservative), [Split { axis: 1, at: 0.5 }]);
        assert_eq!(Recursive.cuts(&s, 0.2, Measure::Estimated), [Split { axis: 1, at: 0.5 }]);
        assert!(Recursive.cuts(&s, 0.25, Measure::Conservative).is_empty());
        let half = s.split_v(0.5).expect("inside").0;
        assert!(Recursive.cuts(&half, 0.0625, Measure::Conservative).is_empty());
    }
}
