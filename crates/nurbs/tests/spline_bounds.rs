//! Bounds over pieces of curves: never below what dense sampling finds, and not far above it.
#![allow(clippy::unwrap_used)]

mod common;
use chordal_nurbs::math;
use chordal_nurbs::*;
use common::*;
use proptest::prelude::*;

fn distance_to_segment(p: DVec3, a: DVec3, b: DVec3) -> f64 {
    let along = b - a;
    let t = if along == DVec3::ZERO {
        0.0
    } else {
        ((p - a).dot(along) / along.length_squared()).clamp(0.0, 1.0)
    };
    p.distance(a + along * t)
}

fn samples(range: Range) -> impl Iterator<Item = f64> {
    (0..=400).map(move |k| range.start + range.length() * f64::from(k) / 400.0)
}

fn sampled_sag(curve: &NurbsCurve3, range: Range) -> f64 {
    let (a, b) = (curve.point(range.start), curve.point(range.end));
    samples(range).map(|t| distance_to_segment(curve.point(t), a, b)).fold(0.0, f64::max)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn chord_bounds_hold(seed: u64, degree in prop_oneof![1usize..=9, 10usize..=60], rational: bool,
        far: bool, small: bool) {
        let mut random = Random(seed);
        let mut curve = random.curve(degree, rational, 1.5);
        if far {
            curve = curve.mapped(|p| p + DVec3::new(1e6, -2e6, 3e6));
        }
        let mut range = random.sub_range(curve.domain());
        if small {
            range.end = range.start + 1e-3 * range.length();
        }
        let (bound, found) = (curve.chord_bound(range), sampled_sag(&curve, range));
        prop_assert!(bound >= found, "{bound} < {found}");
        prop_assert_eq!(bound, curve.chord_bound(Range::new(range.end, range.start)));
    }

    #[test]
    fn bezier_chord_bounds_hold(seed: u64, n in 1usize..=20, rational: bool) {
        let mut random = Random(seed);
        let points = (0..=n).map(|_| random.point()).collect();
        let curve = BezierCurve { points, weights: random.weights(n + 1, rational, 2.0) };
        let (a, b) = (curve.points[0], curve.points[n]);
        let (line, equal) = (curve.chord_bound(), curve.chord_bound_at_equal_parameters());
        for t in samples(Range::new(0.0, 1.0)) {
            let p = curve.eval(t);
            prop_assert!(distance_to_segment(p, a, b) <= line);
            prop_assert!(p.distance(a + (b - a) * t) <= equal);
        }
    }

    #[test]
    fn derivative_bounds_hold(seed: u64, degree in prop_oneof![1usize..=9, 10usize..=40], rational: bool,
        small: bool) {
        let mut random = Random(seed);
        let curve = random.curve(degree, rational, 1.0).mapped(|p| p + DVec3::X * 1e3);
        let mut range = random.sub_range(curve.domain());
        if small {
            range.end = range.start + 1e-3 * range.length();
        }
        let bounds: [f64; 4] = std::array::from_fn(|order| curve.derivative_bound(order, range));
        for t in samples(range) {
            let jet = curve.jet3(t);
            for order in 0..4 {
                prop_assert!(jet[order].length() <= bounds[order] * (1.0 + 1e-12), "order {order}: {} > {}",
                    jet[order].length(), bounds[order]);
            }
        }
    }

    /// Over short ranges of gentle curves the bounds close in on what is there.
    #[test]
    fn bounds_are_tight_over_short_ranges(seed: u64, degree in 2usize..=7, rational: bool) {
        let mut random = Random(seed);
        let curve = random.curve(degree, rational, 0.3);
        let breaks = curve.breaks();
        let k = random.below(breaks.len() - 1);
        let width = breaks[k + 1] - breaks[k];
        let start = breaks[k] + random.within(0.0, 0.99) * width;
        let range = Range::new(start, start + 0.004 * width);
        let second = samples(range).map(|t| curve.jet(t)[2].length()).fold(0.0, f64::max);
        let third = samples(range).map(|t| curve.jet3(t)[3].length()).fold(0.0, f64::max);
        let scale = math::square(degree as f64 / width);
        prop_assert!(curve.derivative_bound(2, range) <= 1.1 * second + 0.1 * scale);
        prop_assert!(curve.derivative_bound(3, range) <= 1.2 * third + 0.5 * scale * degree as f64 / width);
        let sag = sampled_sag(&curve, range);
        prop_assert!(curve.chord_bound(range) <= 1.2 * sag + 1e-6, "{} {sag}", curve.chord_bound(range));
    }
}

/// An arc of a circle as a rational quadratic: the bound is the sagitta itself.
#[test]
fn sagitta_of_an_arc_is_exact() {
    for angle in [0.01f64, 0.3, 1.0, 2.0] {
        let w = math::cos(0.5 * angle);
        let middle = DVec3::new(math::cos(0.5 * angle), math::sin(0.5 * angle), 0.0) / w;
        let points = vec![DVec3::X, middle, DVec3::new(math::cos(angle), math::sin(angle), 0.0)];
        let arc = NurbsCurve3::new(2, vec![0., 0., 0., 1., 1., 1.], points, Some(vec![1.0, w, 1.0])).unwrap();
        let bound = arc.chord_bound(Range::new(0.0, 1.0));
        assert!((bound - (1.0 - w)).abs() < 1e-14, "{bound} {}", 1.0 - w);
    }
}

#[test]
fn weights_of_both_signs_have_no_bound() {
    let points = vec![DVec3::ZERO, DVec3::X, DVec3::Y];
    let curve =
        NurbsCurve3::new(2, vec![0., 0., 0., 1., 1., 1.], points, Some(vec![1.0, -0.1, 1.0])).unwrap();
    let all = curve.domain();
    assert_eq!(curve.chord_bound(all), f64::INFINITY);
    assert_eq!(curve.derivative_bound(2, all), f64::INFINITY);
}

#[test]
fn negative_weights_throughout_are_as_good_as_positive() {
    let mut random = Random(4);
    let curve = random.curve(3, true, 0.5);
    let flipped = curve.weights().unwrap().iter().map(|w| -w).collect();
    let twin = NurbsCurve3::new(3, curve.knots().to_vec(), curve.points().to_vec(), Some(flipped)).unwrap();
    let all = curve.domain();
    assert_eq!(curve.derivative_bound(2, all), twin.derivative_bound(2, all));
    assert_eq!(curve.chord_bound(all), twin.chord_bound(all));
}

#[test]
fn a_range_of_no_length_still_bounds_derivatives() {
    let curve = Random(9).curve(3, true, 0.5);
    for t in curve.breaks() {
        let range = Range::new(t, t);
        assert!(curve.chord_bound(range) < 1e-13);
        assert!(curve.derivative_bound(2, range) >= curve.jet(t)[2].length());
    }
}
