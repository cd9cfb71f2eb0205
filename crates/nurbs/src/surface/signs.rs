//! Negative sizes: the same point set with positive ones.
//!
//! Files give negative radii. The formulas of [`Surface`] hold for them, so that the file's parameters and
//! its normal Su × Sv are those of the formula. Everything else in this program expects the forms below.
//!
//! Notation: e(u) = cos u x + sin u y. Turning the frame about z by π changes the sign of e and nothing else,
//! turning it about y changes the signs of x and z.
//!
//! | surface | form | parameters |
//! |---|---|---|
//! | cylinder, r < 0 | frame turned about z, −r | the same |
//! | cone, r < 0 | frame turned about z, −r, −α | the same |
//! | cone, α = 0 | cylinder | the same |
//! | sphere, r < 0 | frame turned about y, −r | (−u, v): the normal Su × Sv turns round |
//! | torus, r < 0 | −r | (u, v + π) |
//! | torus, R ≤ −r | frame turned about z, −R | (u, π − v): the normal turns round |
//!
//! A torus with −r < R < 0 keeps its negative major radius: it is the *lemon*, the inner part of a spindle
//! torus, as R with 0 < R < r is the *apple*, its outer part. Both are the points with R + r cos v ≥ 0.
//! Where R and r differ by rounding alone, the torus is the *horn* with R = r.

use crate::math;
use crate::{Frame, Surface};
use glam::DVec2;
use std::f64::consts::PI;

/// Radii of a torus that differ by less than this part of them are one number that was rounded: the torus
/// touches its axis, and does not pass it by a spindle of no size. A larger value would move faces.
const ROUNDED_RADII: f64 = 1e-12;

/// A surface with positive sizes, and what became of the parameters and of the normal.
#[derive(Clone, Debug, PartialEq)]
pub struct PositiveSurface {
    /// The surface with positive sizes.
    pub surface: Surface,
    /// The old parameters are multiplied by this, then moved by `shift`.
    pub factors: DVec2,
    /// What is then added to them.
    pub shift: DVec2,
    /// The new normal Su × Sv points against the old one.
    pub reversed: bool,
}

impl PositiveSurface {
    fn same_parameters(surface: Surface) -> Self {
        Self { surface, factors: DVec2::ONE, shift: DVec2::ZERO, reversed: false }
    }

    /// The new parameters of what had the parameters `p_uv`.
    pub fn parameters(&self, p_uv: DVec2) -> DVec2 {
        p_uv * self.factors + self.shift
    }
}

/// Turned about z by π.
fn about_z(f: &Frame) -> Frame {
    Frame { x: -f.x, y: -f.y, ..*f }
}

/// Turned about y by π.
fn about_y(f: &Frame) -> Frame {
    Frame { x: -f.x, z: -f.z, ..*f }
}

impl Surface {
    /// The surface in a form with positive sizes; `None` where it is in that form already.
    pub fn with_positive_sizes(&self) -> Option<PositiveSurface> {
        match self {
            Surface::Cylinder { frame, radius } if *radius < 0.0 => {
                let surface = Surface::Cylinder { frame: about_z(frame), radius: -radius };
                Some(PositiveSurface::same_parameters(surface))
            }
            Surface::Cone { frame, radius, half_angle } => positive_cone(frame, *radius, *half_angle),
            Surface::Sphere { frame, radius } if *radius < 0.0 => Some(PositiveSurface {
                surface: Surface::Sphere { frame: about_y(frame), radius: -radius },
                factors: DVec2::new(-1.0, 1.0),
                shift: DVec2::ZERO,
                reversed: true,
            }),
            Surface::Torus { frame, major, minor } => positive_torus(frame, *major, *minor),
            Surface::Offset { basis, distance } => {
                let form = basis.with_positive_sizes()?;
                let distance = if form.reversed { -distance } else { *distance };
                let surface = Surface::Offset { basis: Box::new(form.surface), distance };
                Some(PositiveSurface { surface, ..form })
            }
            _ => None,
        }
    }

    /// The other part of a spindle torus, the lemon for the points of an apple with R + r cos v < 0: the same
    /// points in a form in which that sum is positive. `None` for surfaces of one part.
    pub fn inner_part(&self) -> Option<PositiveSurface> {
        let &Surface::Torus { frame, major, minor } = self else { return None };
        (major > 0.0 && major < minor).then(|| turned_torus(&frame, major, minor))
    }

    /// The latitude at which a torus meets its axis: it reaches from minus to plus this one. `None` for a
    /// torus that keeps away from its axis, and for other surfaces.
    pub(crate) fn spindle_latitude(&self) -> Option<f64> {
        match self {
            Surface::Torus { major, minor, .. } if major.abs() < *minor => Some(math::acos(-major / minor)),
            _ => None,
        }
    }
}

fn positive_cone(frame: &Frame, radius: f64, half_angle: f64) -> Option<PositiveSurface> {
    let slope = math::tan(half_angle);
    if slope == 0.0 {
        let cylinder = Surface::Cylinder { frame: *frame, radius };
        return Some(
            cylinder
                .with_positive_sizes()
                .unwrap_or_else(|| PositiveSurface::same_parameters(cylinder.clone())),
        );
    }
    // Angles beyond a right one open the other way.
    let acute = if math::cos(half_angle) < 0.0 { math::atan(slope) } else { half_angle };
    if radius >= 0.0 {
        let surface = Surface::Cone { frame: *frame, radius, half_angle: acute };
        return (acute != half_angle).then(|| PositiveSurface::same_parameters(surface));
    }
    let surface = Surface::Cone { frame: about_z(frame), radius: -radius, half_angle: -acute };
    Some(PositiveSurface::same_parameters(surface))
}

fn positive_torus(frame: &Frame, major: f64, minor: f64) -> Option<PositiveSurface> {
    if minor < 0.0 {
        let surface = Surface::Torus { frame: *frame, major, minor: -minor };
        let moved =
            PositiveSurface { surface, factors: DVec2::ONE, shift: DVec2::new(0.0, PI), reversed: false };
        let Some(form) = positive_torus(frame, major, -minor) else { return Some(moved) };
        return Some(PositiveSurface { shift: form.parameters(moved.shift), ..form });
    }
    if major < 0.0 && -major >= minor {
        return Some(turned_torus(frame, major, minor));
    }
    let horn = Surface::Torus { frame: *frame, major: minor, minor };
    let is_rounded = major < minor && minor - major <= ROUNDED_RADII * minor;
    is_rounded.then(|| PositiveSurface::same_parameters(horn))
}

/// R e + r (cos v e + sin v z) = −R e' + r (cos (π − v) e' + sin (π − v) z), e' = −e.
fn turned_torus(frame: &Frame, major: f64, minor: f64) -> PositiveSurface {
    PositiveSurface {
        surface: Surface::Torus { frame: about_z(frame), major: -major, minor },
        factors: DVec2::new(1.0, -1.0),
        shift: DVec2::new(0.0, PI),
        reversed: true,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn same_points(old: &Surface, form: &PositiveSurface, at: DVec2) {
        let new = form.parameters(at);
        let (p, q) = (old.point(at), form.surface.point(new));
        assert!(p.distance(q) < 1e-12, "{old:?} at {at}: {p} {q}");
        let turned = if form.reversed { -1.0 } else { 1.0 };
        let (_, du, dv) = old.jet1(at);
        let normal = form.surface.normal(new).expect("a normal");
        assert!(normal.dot(du.cross(dv)) * turned > 0.0, "{old:?} at {at}");
        let old_normal = old.normal(at).expect("a normal");
        assert!(old_normal.dot(du.cross(dv)) > 0.0, "the old form of {old:?} at {at}");
    }

    #[test]
    fn negative_sizes_are_the_same_points() {
        let frame = Frame::new(DVec3::new(1.0, 2.0, 3.0), DVec3::new(1.0, 1.0, 2.0), DVec3::X);
        let surfaces = [
            Surface::Cylinder { frame, radius: -2.0 },
            Surface::Cone { frame, radius: -2.0, half_angle: 0.4 },
            Surface::Cone { frame, radius: -2.0, half_angle: -0.4 },
            Surface::Cone { frame, radius: 2.0, half_angle: 2.5 },
            Surface::Cone { frame, radius: 2.0, half_angle: 0.0 },
            Surface::Sphere { frame, radius: -2.0 },
            Surface::Torus { frame, major: 5.0, minor: -2.0 },
            Surface::Torus { frame, major: -5.0, minor: 2.0 },
            Surface::Torus { frame, major: -5.0, minor: -2.0 },
            Surface::Torus { frame, major: -1.0, minor: -2.0 },
            Surface::Torus { frame, major: 2.0, minor: 2.000_000_000_000_000_4 },
        ];
        for surface in surfaces {
            let form = surface.with_positive_sizes().expect("another form");
            assert!(form.surface.with_positive_sizes().is_none(), "{surface:?}");
            for k in 0..40 {
                let at = DVec2::new(0.3 + 0.77 * f64::from(k), -1.4 + 0.07 * f64::from(k));
                same_points(&surface, &form, at);
            }
        }
    }

    #[test]
    fn the_inner_part_of_a_spindle_torus() {
        let frame = Frame::new(DVec3::new(1.0, 2.0, 3.0), DVec3::new(1.0, 1.0, 2.0), DVec3::X);
        let apple = Surface::Torus { frame, major: 2.0, minor: 3.0 };
        let form = apple.inner_part().expect("it has two parts");
        same_points(&apple, &form, DVec2::new(0.4, PI - 0.2));
        let lemon = form.surface.spindle_latitude().expect("it meets its axis");
        assert!(
            form.surface.point(DVec2::new(0.7, lemon)).distance(frame.origin + frame.z * 5f64.sqrt()) < 1e-12
        );
    }
}
