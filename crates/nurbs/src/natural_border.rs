//! The border of a surface: the sides of its domain at which it ends.
//!
//! ```text
//!   neither closed: a loop     u closed: two rings      one of them a pole     u and v closed,
//!                                                                              or two poles: none
//!   ┌─────◄────┐               ┌─────◄────┐             ┌═══pole═══┐           ┌──────────┐
//!   ▼          ▲               ┆ seam     ┆             ┆ seam     ┆           ┆          ┆
//!   └─────►────┘               └─────►────┘             └─────►────┘           └──────────┘
//! ```

use crate::{BoxSide, Pole, Surface, UvBox};

/// A side this share of the domain away from a pole is the pole: rounding.
const AT_POLE: f64 = 1e-9;

/// Where a surface ends, with the surface on the left of each side.
#[derive(Clone, Debug, PartialEq)]
pub enum NaturalBorder {
    /// The surface has no border: it is closed or unbounded.
    None,
    /// All four sides of the domain, one loop. Some may be poles.
    Loop([BoxSide; 4]),
    /// One parameter is closed, and each of these sides is a closed curve.
    Rings(Vec<BoxSide>),
}

impl Surface {
    /// The sides of its domain at which the surface ends.
    pub fn natural_border(&self) -> NaturalBorder {
        let domain = self.domain();
        if !domain.is_finite() {
            return NaturalBorder::None;
        }
        let poles = self.poles();
        let rings = |sides: [usize; 2]| {
            let sides = sides.map(|k| domain.sides()[k]);
            let rings: Vec<BoxSide> = sides.into_iter().filter(|s| !s.is_pole(&domain, &poles)).collect();
            if rings.is_empty() { NaturalBorder::None } else { NaturalBorder::Rings(rings) }
        };
        match self.periods() {
            [None, None] => NaturalBorder::Loop(domain.sides()),
            [Some(_), None] => rings([0, 2]),
            [None, Some(_)] => rings([1, 3]),
            [Some(_), Some(_)] => NaturalBorder::None,
        }
    }
}

impl BoxSide {
    /// Whether the side of this box is one of these poles.
    pub fn is_pole(&self, of: &UvBox, poles: &[Pole]) -> bool {
        let axis = self.axis();
        let rounding = AT_POLE * of.size()[axis];
        poles.iter().any(|pole| pole.axis == axis && (pole.value - self.value()).abs() <= rounding)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Curve, DVec2, DVec3, Frame, NurbsSurface};

    #[test]
    fn a_patch_ends_at_its_four_sides_counter_clockwise() {
        let points = (0..4).map(|i| DVec3::new(f64::from(i / 2), f64::from(i % 2), 0.0)).collect();
        let knots = vec![0.0, 0.0, 1.0, 1.0];
        let patch = NurbsSurface::new([1, 1], knots.clone(), knots, points, None).unwrap();
        let NaturalBorder::Loop(sides) = Surface::Nurbs(patch).natural_border() else { panic!("four sides") };
        let area: f64 = sides.iter().map(|s| 0.5 * s.from.perp_dot(s.to)).sum();
        assert_eq!(area, 1.0);
        for side in sides {
            let along = side.to - side.from;
            assert_eq!(along[side.axis()], 0.0);
            assert_eq!(along[1 - side.axis()] > 0.0, side.is_forward());
            assert_eq!(side.value() == 1.0, side.is_upper());
        }
    }

    #[test]
    fn poles_and_closed_directions_are_no_border() {
        let frame = Frame::WORLD;
        assert_eq!(Surface::Sphere { frame, radius: 1.0 }.natural_border(), NaturalBorder::None);
        assert_eq!(Surface::Torus { frame, major: 3.0, minor: 1.0 }.natural_border(), NaturalBorder::None);
        assert_eq!(Surface::Plane { frame }.natural_border(), NaturalBorder::None);
        let turned = |start: f64| {
            let profile = Curve::Polyline(vec![DVec3::new(start, 0.0, 0.0), DVec3::new(2.0, 0.0, 3.0)]);
            Surface::Revolution { profile, axis_origin: DVec3::ZERO, axis: DVec3::Z }.natural_border()
        };
        let NaturalBorder::Rings(rings) = turned(1.0) else { panic!("a tube has two rings") };
        assert_eq!(rings.len(), 2);
        assert!(rings[0].is_forward() && !rings[1].is_forward());
        let NaturalBorder::Rings(rings) = turned(0.0) else { panic!("a cone has one ring") };
        assert_eq!(rings.iter().map(|ring| ring.from.y).collect::<Vec<_>>(), [1.0]);
        assert_eq!(rings[0].to, DVec2::new(0.0, 1.0));
    }
}
