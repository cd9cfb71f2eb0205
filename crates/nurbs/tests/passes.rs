//! Evaluation by passes (Krishnamurthy, Khardekar, McMains 2009) against the exact evaluator and closed
//! forms.

mod common;

use chordal_nurbs::math;
use chordal_nurbs::*;
use common::Random;
use proptest::prelude::*;

/// The paper's example: a cubic over [0 0 0 0 0.1 0.1 0.5 1 1 1 1].
fn example() -> NurbsCurve3 {
    let knots = vec![0.0, 0.0, 0.0, 0.0, 0.1, 0.1, 0.5, 1.0, 1.0, 1.0, 1.0];
    let points = (0..7).map(|i| DVec3::new(f64::from(i), f64::from(i * i), 1.0)).collect();
    NurbsCurve3::new(3, knots, points, None).expect("legal")
}

#[test]
fn the_papers_example_sums_to_one_in_three_passes() {
    let curve = example();
    let ts: Vec<f64> = (0..100).map(|i| f64::from(i) / 99.0).collect();
    let table = curve.basis_by_passes(&ts);
    assert_eq!(table.passes(), 3);
    for (i, &t) in ts.iter().enumerate() {
        let values: Vec<f64> = table.values(i).collect();
        assert_eq!(values.len(), 4);
        assert!(values.iter().all(|&v| v >= 0.0), "{t}: {values:?}");
        assert!((values.iter().sum::<f64>() - 1.0).abs() < 1e-15, "{t}: {values:?}");
        let expected = [0.0, 0.1, 0.5].iter().rposition(|&k| t >= k).map(|s| [0, 2, 3][s]).expect("inside");
        assert_eq!(table.first(i), expected, "{t}");
    }
}

#[test]
fn a_single_span_has_the_bernstein_polynomials() {
    for degree in [1, 2, 5, 30, 100] {
        let mut knots = vec![0.0; degree + 1];
        knots.extend(vec![1.0; degree + 1]);
        let points = vec![DVec3::ZERO; degree + 1];
        let curve = NurbsCurve3::new(degree, knots, points, None).expect("legal");
        let ts = [0.0, 0.125, 0.3, 0.5, 1.0];
        let table = curve.basis_by_passes(&ts);
        for (i, &t) in ts.iter().enumerate() {
            for (k, value) in table.values(i).enumerate() {
                let binomial = (0..k).fold(1.0, |b, j| b * (degree - j) as f64 / (j + 1) as f64);
                let exact = binomial * math::powi(t, k as i32) * math::powi(1.0 - t, (degree - k) as i32);
                assert!((value - exact).abs() <= 1e-13, "degree {degree}, {k} at {t}: {value} {exact}");
            }
        }
    }
}

#[test]
fn nothing_is_made_of_nothing() {
    assert!(example().points_by_passes(&[]).is_empty());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn curves_of_every_degree_agree_with_the_exact_evaluator(
        seed in any::<u64>(), degree in 1usize..=100, rational in any::<bool>(),
    ) {
        let mut random = Random(seed);
        let curve = random.curve(degree, rational, 3.0);
        let ts: Vec<f64> = (0..9).map(|_| random.sample(curve.domain())).collect();
        let points = curve.points_by_passes(&ts);
        let scale = curve.points().iter().fold(0.0f64, |m, p| m.max(p.length()));
        for (&t, p) in ts.iter().zip(points) {
            // Both evaluators round once per level of the recursion.
            let allowed = 4.0 * (degree + 4) as f64 * f64::EPSILON * scale;
            prop_assert!(p.distance(curve.point(t)) <= allowed, "{} at {t}", p.distance(curve.point(t)));
        }
    }

    #[test]
    fn surfaces_of_every_degree_agree_with_the_exact_evaluator(
        seed in any::<u64>(), p in 1usize..=100, q in 1usize..=20, rational in any::<bool>(),
    ) {
        let mut random = Random(seed);
        let surface = random.surface([p, q], rational, 3.0);
        let domain = surface.domain();
        let us: Vec<f64> = (0..5).map(|_| random.sample(domain.u())).collect();
        let vs: Vec<f64> = (0..3).map(|_| random.sample(domain.v())).collect();
        let points = surface.points_by_passes(&us, &vs);
        let scale = surface.points().iter().fold(0.0f64, |m, p| m.max(p.length()));
        let allowed = 4.0 * (p + q + 8) as f64 * f64::EPSILON * scale;
        for (i, &u) in us.iter().enumerate() {
            for (j, &v) in vs.iter().enumerate() {
                let exact = surface.point(DVec2::new(u, v));
                prop_assert!(points[i * vs.len() + j].distance(exact) <= allowed);
            }
        }
    }
}
