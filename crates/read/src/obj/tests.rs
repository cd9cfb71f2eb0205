//! Bases as B-splines against their definitions.

use super::basis::{Basis, Direction};
use chordal_nurbs::{DVec2, DVec4, NurbsCurve, math};
use proptest::prelude::*;

/// The value of a segment by the definition of its basis: Σ c_i N_i(t), local t in 0..=1.
fn by_definition(d: &Direction, points: &[f64], t: f64) -> f64 {
    let n = d.degree;
    let binomial = |i: usize| (0..i).fold(1.0, |b, k| b * (n - k) as f64 / (k + 1) as f64);
    let weight = |i: usize| match d.basis {
        Basis::Bezier => binomial(i) * math::powi(t, i as i32) * math::powi(1.0 - t, (n - i) as i32),
        Basis::Taylor => math::powi(t, i as i32),
        Basis::Matrix => (0..=n).map(|k| d.matrix[i * (n + 1) + k] * math::powi(t, k as i32)).sum(),
        // Cubic through the middle two points, with half the differences of their neighbours as tangents.
        Basis::Cardinal => [
            -0.5 * t + t * t - 0.5 * math::powi(t, 3),
            1.0 - 2.5 * t * t + 1.5 * math::powi(t, 3),
            0.5 * t + 2.0 * t * t - 1.5 * math::powi(t, 3),
            -0.5 * t * t + 0.5 * math::powi(t, 3),
        ][i],
        Basis::Bspline => unreachable!("not made of segments"),
    };
    (0..=n).map(|i| weight(i) * points[i]).sum()
}

fn agrees(d: &Direction, stride: usize, points: &[f64]) {
    let rows: Vec<Vec<DVec4>> = points.iter().map(|&x| vec![DVec4::new(x, 2.0 * x, 0.0, 1.0)]).collect();
    let spline = d.spline(rows).expect("fits");
    let net = spline.rows.iter().map(|row| DVec2::new(row[0].x, row[0].y)).collect();
    let curve = NurbsCurve::new(d.degree, spline.knots, net, None).expect("a curve");
    for s in 0..d.parameters.len() - 1 {
        let (a, b) = (d.parameters[s], d.parameters[s + 1]);
        for k in 0..=10 {
            // Strictly inside: segments need not meet.
            let t = (f64::from(k) + 0.5) / 11.0;
            let expected = by_definition(d, &points[s * stride..], t);
            let found = curve.point(a + t * (b - a));
            let size = points.iter().fold(1.0f64, |m, p| m.max(p.abs()));
            assert!((found.x - expected).abs() < 1e-12 * size, "segment {s}, t {t}: {found} {expected}");
            assert!((found.y - 2.0 * expected).abs() < 2e-12 * size);
        }
    }
}

const MATRIX: [f64; 16] = [1., -3., 3., -1., 4., 0., -6., 3., 1., 3., 3., -3., 0., 0., 0., 1.];

proptest! {
    #[test]
    fn every_basis_is_what_it_says(points in prop::collection::vec(-10.0..10.0f64, 16), degree in 1..5usize) {
        let breaks = [-1.0, 0.5, 3.0, 3.25];
        let scaled = MATRIX.map(|x| x / 6.0);
        let of = |basis, degree, step, matrix| Direction { basis, degree, parameters: &breaks, step, matrix };
        for (basis, degree, stride) in [
            (Basis::Bezier, degree, degree),
            (Basis::Taylor, degree, degree + 1),
            (Basis::Cardinal, 3, 1),
        ] {
            let d = of(basis, degree, 0, &[]);
            agrees(&d, stride, &points[..d.control_points().expect("fits")]);
        }
        for step in 1..4 {
            let d = of(Basis::Matrix, 3, step, &scaled);
            agrees(&d, step, &points[..d.control_points().expect("fits")]);
        }
    }
}

#[test]
fn what_does_not_fit_is_said() {
    let of = |basis, degree, parameters: &'static [f64]| Direction {
        basis,
        degree,
        parameters,
        step: 0,
        matrix: &[],
    };
    for (d, phrase) in [
        (of(Basis::Bezier, 0, &[0., 1.]), "degree 0 is"),
        (of(Basis::Bezier, usize::MAX, &[0., 1.]), "between 1 and 100"),
        (of(Basis::Bezier, 3, &[0.]), "at least 5 needed"),
        (of(Basis::Bspline, 3, &[0., 1., 2.]), "at least 5 needed"),
        (of(Basis::Cardinal, 2, &[0., 1.]), "Cardinal spline degree"),
        (of(Basis::Matrix, 2, &[0., 1.]), "basis matrix step"),
        (of(Basis::Bezier, 1, &[1., 0.]), "parameter range 1..0 is empty"),
    ] {
        let rows = vec![vec![DVec4::ONE]; 2];
        let said = d.spline(rows).expect_err("nonsense");
        assert!(said.to_string().contains(phrase), "{said}");
    }
}
