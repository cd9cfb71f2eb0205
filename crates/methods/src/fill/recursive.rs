//! Recursive subdivision of Bézier patches with a bound from their derivative patches.
//!
//! Source: the survey of the Blender wiki, "Recursive Subdivision / Piecewise Bézier". The surface is split
//! into Bézier patches; a patch whose derivatives allow too large an error is halved across the direction in
//! which they are larger, and so on. The survey uses the first derivative, which bounds the length of a step;
//! the error of a triangle is bounded by the second derivative, which is a patch as well
//! ([`super::derivatives`]).

use super::cells::{Rule, Split};
use super::derivatives::SecondNorms;
use super::node::Measure;
use super::quadtree::at_knots;
use chordal_nurbs::{DVec2, NurbsSurface};

/// Recursive subdivision.
#[derive(Clone, Copy, Debug)]
pub struct Recursive;

impl Rule for Recursive {
    fn name(&self) -> &'static str {
        "recursively halved Bézier patches"
    }

    fn first_cuts(&self, root: &NurbsSurface, _: f64) -> Vec<Split> {
        at_knots(root)
    }

    fn cuts(&self, piece: &NurbsSurface, tolerance: f64, measure: Measure) -> Vec<Split> {
        let norms = match measure {
            // A knot that lies too near to a border to be cut at leaves more than one patch.
            Measure::Conservative => SecondNorms::of_surface(piece),
            Measure::Estimated => sampled(piece),
        };
        let norms = norms.over(piece.domain().size());
        // Halving does not help where the bound is not a number.
        if norms.error(1.0, 1.0) <= tolerance || norms.error(1.0, 1.0).is_nan() {
            return Vec::new();
        }
        let axis = usize::from(norms.vv > norms.uu);
        vec![Split { axis, at: piece.domain().center()[axis] }]
    }
}

/// Norms at the corners and in the middle: no bound.
fn sampled(piece: &NurbsSurface) -> SecondNorms {
    let domain = piece.domain();
    [(0., 0.), (1., 0.), (0., 1.), (1., 1.), (0.5, 0.5)].iter().fold(SecondNorms::default(), |m, &(u, v)| {
        let jet = piece.jet(domain.min + domain.size() * DVec2::new(u, v));
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
