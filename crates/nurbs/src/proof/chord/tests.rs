use crate::fixtures::{self, Random};
use crate::math;
use crate::*;
use proptest::prelude::*;

/// The largest sampled distance of the curve from its chord.
fn sampled(curve: &Curve, t0: f64, t1: f64) -> f64 {
    let (a, b) = (curve.point(t0), curve.point(t1));
    (0..=400)
        .map(|i| segment_distance(curve.point(t0 + (t1 - t0) * f64::from(i) / 400.0), a, b))
        .fold(0.0, f64::max)
}

#[test]
fn chord_errors_hold_and_are_near_the_truth() {
    let mut random = Random(31);
    for (name, curve, range) in fixtures::curves() {
        let (mut worst, mut proven): (f64, usize) = (1.0, 0);
        for _ in 0..300 {
            let t0 = random.within(range);
            let t1 = t0 + (random.within(range) - t0) * random.next();
            let bound = curve.chord_error(t0, t1);
            let truth = sampled(&curve, t0, t1);
            assert!(bound >= truth - 1e-14, "{name} {t0}..{t1}: {bound} < {truth}");
            if bound.is_finite() {
                proven += 1;
                if truth > 1e-6 {
                    worst = worst.max(bound / truth);
                }
            }
        }
        let limit = match name {
            // Corners lie between samples.
            "line" | "circle" | "polyline" => 1.1,
            "parabola" | "hyperbola" => 2.0,
            "offset" | "on cylinder" | "ellipse" => 20.0,
            _ => 10.0,
        };
        assert!(worst < limit, "{name}: {worst}");
        assert!(proven == 300 || name == "offset", "{name}: {proven}");
    }
}

#[test]
fn short_chords_are_bounded_tightly() {
    for (name, curve, range) in fixtures::curves() {
        if ["line", "polyline", "composite"].contains(&name) {
            continue;
        }
        let limit = if ["offset", "on cylinder"].contains(&name) { 4.0 } else { 1.3 };
        let t0 = range.start + 0.41 * range.length();
        let t1 = t0 + 0.01 * range.length();
        let ratio = curve.chord_error(t0, t1) / sampled(&curve, t0, t1);
        assert!((0.9999..limit).contains(&ratio), "{name}: {ratio}");
    }
}

#[test]
fn circles_are_exact() {
    let circle = Curve::Circle { frame: fixtures::frame(), radius: 3.0 };
    for turn in [0.1f64, 1.0, 2.5, 3.5, 5.0, 6.2] {
        let expected = 3.0 * (1.0 - math::cos(turn / 2.0));
        assert!((circle.chord_error(0.4, 0.4 + turn) - expected).abs() < 1e-13);
        assert!((circle.chord_error(0.4, 0.4 + turn) - sampled(&circle, 0.4, 0.4 + turn)).abs() < 1e-4);
    }
}

#[test]
fn derivative_bounds_hold() {
    let mut random = Random(32);
    for (name, curve, range) in fixtures::curves() {
        for _ in 0..50 {
            let a = random.within(range);
            let b = random.within(range);
            let piece = Range::new(a.min(b), a.max(b));
            for order in 1..=3 {
                let bound = curve.derivative_bound(order, piece);
                let breaks = curve.all_breaks(range);
                for _ in 0..20 {
                    let t = random.within(piece);
                    if breaks.iter().any(|b| (b - t).abs() < 2e-4) {
                        continue;
                    }
                    let truth = curve.jet3(t)[order].length();
                    assert!(
                        bound * (1.0 + 1e-6) >= truth - 1e-12,
                        "{name} {order} at {t}: {bound} < {truth}"
                    );
                }
            }
        }
    }
}

#[test]
fn closed_splines_are_bounded_across_their_seam() {
    let ring: Vec<DVec3> =
        [[0., 0., 0.], [2., 0., 1.], [2., 2., 0.], [0., 2., 1.], [0., 0., 0.]].map(DVec3::from).to_vec();
    let nurbs = NurbsCurve3::new(2, vec![0., 0., 0., 1., 2., 3., 3., 3.], ring, None).unwrap();
    let curve = Curve::Nurbs(nurbs);
    assert_eq!(curve.period(), Some(3.0));
    let bound = curve.chord_error(2.6, 3.3);
    assert!(bound.is_finite() && bound >= sampled(&curve, 2.6, 3.3));
    assert!(bound < 2.0 * sampled(&curve, 2.6, 3.3));
}

proptest! {
    #[test]
    fn random_conics_keep_to_their_bound(a in 0.01f64..10.0, b in 0.01f64..10.0, t0 in -7.0f64..7.0,
        turn in 0.0f64..6.25) {
        let ellipse = Curve::Ellipse { frame: fixtures::frame(), a, b };
        prop_assert!(ellipse.chord_error(t0, t0 + turn) >= sampled(&ellipse, t0, t0 + turn) - 1e-14);
        let (s0, s1) = (t0 * 0.4, t0 * 0.4 + turn * 0.5);
        let hyperbola = Curve::Hyperbola { frame: fixtures::frame(), a, b };
        let truth = sampled(&hyperbola, s0, s1);
        prop_assert!(hyperbola.chord_error(s0, s1) >= truth * (1.0 - 1e-12) - 1e-14);
        let parabola = Curve::Parabola { frame: fixtures::frame(), focal: a };
        prop_assert!(parabola.chord_error(t0, t0 + turn) >= sampled(&parabola, t0, t0 + turn) - 1e-13);
    }
}
