use crate::fixtures::{self, Random};
use crate::*;

#[test]
fn points_of_a_curve_come_back() {
    let mut random = Random(11);
    for (name, curve, range) in fixtures::curves() {
        let inverter = CurveInverter::new(&curve, range);
        for _ in 0..100 {
            let t = random.within(range);
            let p = curve.point(t);
            let found = inverter.invert(p, None);
            assert!(found.distance < 1e-12 * (1.0 + p.length()), "{name} at {t}: {found:?}");
            assert!((found.t - t).abs() < 1e-8 * range.length(), "{name} at {t}: {found:?}");
            let near = curve.invert(p, Some(t + 0.02 * range.length()));
            assert!((near - t).abs() < 1e-8 * range.length(), "{name} at {t} with a hint: {near}");
        }
    }
}

#[test]
fn no_sample_is_closer() {
    let mut random = Random(12);
    for (name, curve, range) in fixtures::curves() {
        let inverter = CurveInverter::new(&curve, range);
        let samples: Vec<DVec3> =
            (0..=3000).map(|i| curve.point(range.start + range.length() * f64::from(i) / 3000.0)).collect();
        for _ in 0..100 {
            let p = curve.point(random.within(range)) + random.vector() * 4.0;
            let found = inverter.invert(p, None);
            let best = samples.iter().map(|s| s.distance(p)).fold(f64::INFINITY, f64::min);
            assert!(found.distance <= best + 1e-12, "{name}: {found:?} but {best}");
            assert!((curve.point(found.t).distance(p) - found.distance).abs() < 1e-12);
        }
    }
}

#[test]
fn endless_conics_are_searched_far_out() {
    let parabola = Curve::Parabola { frame: fixtures::frame(), focal: 0.01 };
    let hyperbola = Curve::Hyperbola { frame: fixtures::frame(), a: 1.0, b: 0.01 };
    for (curve, t) in [(parabola, 300.0), (hyperbola, -9.0)] {
        assert!((curve.invert(curve.point(t), None) - t).abs() < 1e-6, "{curve:?}");
    }
}

#[test]
fn hints_choose_the_turn() {
    let circle = Curve::Circle { frame: fixtures::frame(), radius: 2.0 };
    let p = circle.point(0.1);
    assert!((circle.invert(p, Some(6.2)) - (0.1 + std::f64::consts::TAU)).abs() < 1e-12);
    assert!((circle.invert(p, Some(-6.2)) - (0.1 - std::f64::consts::TAU)).abs() < 1e-12);
    assert_eq!(circle.invert(fixtures::frame().origin, Some(1.5)), 1.5);
    let arc = CurveInverter::new(&circle, Range::new(1.0, 2.0));
    assert_eq!(arc.invert(p, None).t, 1.0);
    assert_eq!(arc.invert(circle.point(2.5), None).t, 2.0);
}
