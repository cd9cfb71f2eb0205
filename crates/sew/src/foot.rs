//! The foot of a point on a piece of a curve, from a start parameter near it.

use chordal_nurbs::{Curve, Range, segment_foot};
use glam::DVec3;

/// The most Newton steps. Each halves the number of wrong digits once the start is near the local minimum.
const STEPS: usize = 30;

/// The parameter in `range` of the local minimum of the distance that `start` leads to, and its distance from
/// `p`.
pub(crate) fn foot(curve: &Curve, range: Range, p: DVec3, start: f64) -> (f64, f64) {
    if let Curve::Line { origin, direction } = curve {
        let t = range.clamp((p - *origin).dot(*direction) / direction.length_squared());
        let t = if t.is_finite() { t } else { start };
        return (t, curve.point(t).distance(p));
    }
    let mut t = range.clamp(start);
    let mut jet = curve.jet(t);
    for _ in 0..STEPS {
        let r = jet.p - p;
        let (gauss, slope) = (jet.d1.length_squared(), r.dot(jet.d1));
        let newton = gauss + r.dot(jet.d2);
        let step = -slope / if newton > 0.05 * gauss { newton } else { gauss };
        let Some(next) = shorter_until_nearer(curve, range, p, t, step, r.length()) else { break };
        let moved = (next - t).abs();
        t = next;
        jet = curve.jet(t);
        if moved <= 1e-14 * range.length() {
            break;
        }
    }
    (t, jet.p.distance(p))
}

fn shorter_until_nearer(
    curve: &Curve,
    range: Range,
    p: DVec3,
    t: f64,
    mut step: f64,
    distance: f64,
) -> Option<f64> {
    for _ in 0..6 {
        let next = range.clamp(t + step);
        if !next.is_finite() || next == t {
            return None;
        }
        if curve.point(next).distance(p) < distance {
            return Some(next);
        }
        step *= 0.25;
    }
    None
}

/// The distance of `p` from the segment `a`–`b`, and the place of its foot between them (0 to 1).
pub(crate) fn segment_distance(p: DVec3, a: DVec3, b: DVec3) -> (f64, f64) {
    let s = segment_foot(p, a, b);
    ((a + (b - a) * s).distance(p), s)
}

#[cfg(test)]
mod tests {
    use super::*;
    use chordal_nurbs::Frame;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn feet_on_an_ellipse_are_perpendicular(u in 0.3..2.8, off in -0.2..0.2, guess in -0.2..0.2) {
            let curve = Curve::Ellipse { frame: Frame::WORLD, a: 3.0, b: 2.0 };
            let jet = curve.jet(u);
            let n = DVec3::new(-jet.d1.y, jet.d1.x, 0.0).normalize();
            let (t, d) = foot(&curve, Range::new(0.0, 3.1), jet.p + n * off, u + guess);
            prop_assert!((t - u).abs() < 1e-6, "{} {}", t, u);
            let expected: f64 = f64::abs(off);
            prop_assert!((d - expected).abs() < 1e-9);
        }
    }

    #[test]
    fn feet_stay_in_the_range() {
        let line = Curve::Line { origin: DVec3::ZERO, direction: DVec3::X };
        assert_eq!(foot(&line, Range::new(0.0, 1.0), DVec3::new(3.0, 0.0, 0.0), 0.5), (1.0, 2.0));
        assert_eq!(segment_distance(DVec3::Y, DVec3::ZERO, DVec3::ZERO), (1.0, 0.0));
    }
}
