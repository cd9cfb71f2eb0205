//! Points and derivatives of B-splines against independent ways to get them.
#![allow(clippy::unwrap_used)]

mod common;
use chordal_nurbs::math;
use chordal_nurbs::*;
use common::*;
use proptest::prelude::*;

fn naive_surface(s: &NurbsSurface, uv: DVec2) -> DVec3 {
    let [p, q] = s.degree();
    let net = lift(s.points(), s.weights());
    let rows: Vec<DVec4> = net.chunks(s.counts()[1]).map(|row| de_boor(q, s.knots_v(), row, uv.y)).collect();
    project(de_boor(p, s.knots_u(), &rows, uv.x))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn curve_points_agree_with_de_boor(seed: u64, degree in prop_oneof![1usize..=12, 13usize..=100],
        rational: bool) {
        let mut random = Random(seed);
        let curve = random.curve(degree, rational, 3.0);
        let net = lift(curve.points(), curve.weights());
        for _ in 0..10 {
            let t = random.sample(curve.domain());
            let expected = project(de_boor(degree, curve.knots(), &net, t));
            prop_assert!(curve.point(t).distance(expected) < 1e-12, "{} {}", curve.point(t), expected);
            prop_assert_eq!(curve.point(t), curve.jet3(t)[0]);
        }
    }

    #[test]
    fn surface_points_agree_with_de_boor(seed: u64, p in 1usize..=14, q in 1usize..=14, rational: bool) {
        let mut random = Random(seed);
        let surface = random.surface([p, q], rational, 3.0);
        for _ in 0..5 {
            let uv = DVec2::new(random.sample(surface.domain().u()), random.sample(surface.domain().v()));
            let found = surface.point(uv);
            prop_assert!(found.distance(naive_surface(&surface, uv)) < 1e-12);
            let jet = surface.jet(uv);
            let (p1, du, dv) = surface.jet1(uv);
            prop_assert!((jet.p, jet.du, jet.dv) == (p1, du, dv) && found == p1);
        }
    }

    /// Central differences of each derivative give the next, well inside a span.
    #[test]
    fn curve_derivatives_agree_with_differences(seed: u64, degree in 1usize..=9, rational: bool) {
        let mut random = Random(seed);
        let curve = random.curve(degree, rational, 0.5);
        let breaks = curve.breaks();
        let k = random.below(breaks.len() - 1);
        let t = random.within(0.9 * breaks[k] + 0.1 * breaks[k + 1], 0.1 * breaks[k] + 0.9 * breaks[k + 1]);
        let h = 1e-5 * (breaks[k + 1] - breaks[k]);
        let (below, at, above) = (curve.jet3(t - h), curve.jet3(t), curve.jet3(t + h));
        for order in 1..4 {
            let difference = (above[order - 1] - below[order - 1]) / (2.0 * h);
            let scale = math::powi(degree as f64 / (breaks[k + 1] - breaks[k]), order as i32);
            prop_assert!(difference.distance(at[order]) < 1e-5 * (scale + at[order].length()),
                "order {order}: {difference} {}", at[order]);
        }
    }

    #[test]
    fn surface_derivatives_agree_with_differences(seed: u64, p in 1usize..=6, q in 1usize..=6,
        rational: bool) {
        let mut random = Random(seed);
        let surface = random.surface([p, q], rational, 0.5);
        let inside = |random: &mut Random, breaks: Vec<f64>| {
            let k = random.below(breaks.len() - 1);
            let width = breaks[k + 1] - breaks[k];
            (breaks[k] + width * random.within(0.1, 0.9), width)
        };
        let (u, width_u) = inside(&mut random, surface.breaks_u());
        let (v, width_v) = inside(&mut random, surface.breaks_v());
        let step = DVec2::new(1e-5 * width_u, 1e-5 * width_v);
        let at = |i: f64, j: f64| surface.jet(DVec2::new(u, v) + step * DVec2::new(i, j));
        let jet = at(0.0, 0.0);
        let by_u = |f: fn(&SurfaceJet) -> DVec3| (f(&at(1.0, 0.0)) - f(&at(-1.0, 0.0))) / (2.0 * step.x);
        let by_v = |f: fn(&SurfaceJet) -> DVec3| (f(&at(0.0, 1.0)) - f(&at(0.0, -1.0))) / (2.0 * step.y);
        let scale = math::square(1.0 + p as f64 / width_u + q as f64 / width_v);
        for (expected, found) in [
            (by_u(|j| j.p), jet.du),
            (by_v(|j| j.p), jet.dv),
            (by_u(|j| j.du), jet.duu),
            (by_v(|j| j.du), jet.duv),
            (by_u(|j| j.dv), jet.duv),
            (by_v(|j| j.dv), jet.dvv),
        ] {
            prop_assert!(expected.distance(found) < 1e-5 * (scale + found.length()), "{expected} {found}");
        }
    }

    /// Any degree: the derivative is the spline of the differenced control points.
    #[test]
    fn curve_derivative_is_the_hodograph(seed: u64, degree in 2usize..=100) {
        let mut random = Random(seed);
        let curve = random.curve(degree, false, 0.0);
        let knots = curve.knots();
        let net: Vec<DVec4> = (0..curve.points().len() - 1)
            .map(|i| {
                let width = knots[i + degree + 1] - knots[i + 1];
                let d = curve.points()[i + 1] - curve.points()[i];
                if width > 0.0 { (d * degree as f64 / width).extend(0.0) } else { DVec4::ZERO }
            })
            .collect();
        for _ in 0..5 {
            let t = random.sample(curve.domain());
            let expected = de_boor(degree - 1, &knots[1..knots.len() - 1], &net, t).truncate();
            let scale = net.iter().map(|d| d.length()).fold(0.0, f64::max);
            prop_assert!(curve.jet(t)[1].distance(expected) < 1e-12 * scale);
        }
    }
}

#[test]
fn rational_quadratics_make_an_exact_circle() {
    let h = 0.5f64.sqrt();
    let points =
        [(1., 0.), (1., 1.), (0., 1.), (-1., 1.), (-1., 0.), (-1., -1.), (0., -1.), (1., -1.), (1., 0.)];
    let points: Vec<DVec2> = points.into_iter().map(DVec2::from).collect();
    let weights = vec![1.0, h, 1.0, h, 1.0, h, 1.0, h, 1.0];
    let knots = vec![0., 0., 0., 0.25, 0.25, 0.5, 0.5, 0.75, 0.75, 1., 1., 1.];
    let circle = NurbsCurve2::new(2, knots, points, Some(weights)).unwrap();
    for k in 0..=1000 {
        let [p, d1, d2] = circle.jet(f64::from(k) / 1000.0);
        assert!((p.length() - 1.0).abs() < 1e-14);
        assert!(p.dot(d1).abs() < 1e-13);
        let curvature = d1.perp_dot(d2) / math::powi(d1.length(), 3);
        assert!((curvature - 1.0).abs() < 1e-12, "{curvature}");
    }
    assert!(circle.is_closed());
}

/// A cyclic cubic: uniform knots, the first three points repeated. Smooth across its seam, which lies
/// anywhere.
#[test]
fn cyclic_knots_close_smoothly() {
    let mut random = Random(7);
    let mut points: Vec<DVec3> = (0..8).map(|_| random.point()).collect();
    points.extend_from_within(..3);
    let knots: Vec<f64> = (0..15).map(f64::from).collect();
    let curve = NurbsCurve3::new(3, knots, points, None).unwrap();
    assert_eq!(curve.domain(), Range::new(3.0, 11.0));
    assert!(curve.is_closed());
    let (start, end) = (curve.jet(3.0), curve.jet(11.0));
    for order in 0..3 {
        assert!(start[order].distance(end[order]) < 1e-14);
    }
    assert!(curve.clamped().unwrap().is_closed());
}

#[test]
fn parameters_outside_are_clamped() {
    let curve = Random(1).curve(3, true, 1.0);
    let domain = curve.domain();
    assert_eq!(curve.point(domain.start - 5.0), curve.point(domain.start));
    assert_eq!(curve.point(domain.end + 5.0), curve.point(domain.end));
    assert_eq!(curve.point(f64::INFINITY), curve.point(domain.end));
    assert_eq!(curve.point(f64::NAN), curve.point(domain.start));
}

#[test]
fn far_from_the_origin_derivatives_keep_their_digits() {
    let curve = Random(5).curve(3, true, 1.0);
    let far = curve.mapped(|p| (p * 1024.0).round() / 1024.0);
    let moved = far.mapped(|p| p + DVec3::splat(1e9));
    for k in 0..100 {
        let domain = curve.domain();
        let t = domain.start + domain.length() * f64::from(k) / 100.0;
        let (a, b) = (far.jet(t), moved.jet(t));
        assert!(a[1].distance(b[1]) <= 1e-11 * a[1].length());
        assert!(a[2].distance(b[2]) <= 1e-11 * a[2].length());
    }
}
