//! Every form of knot vector that the survey of the Blender wiki names, and what it says about each.

mod common;

use chordal_nurbs::math;
use chordal_nurbs::*;
use common::{Random, de_boor, lift, project};
use proptest::prelude::*;

fn points(random: &mut Random, count: usize) -> Vec<DVec3> {
    (0..count).map(|_| random.point()).collect()
}

/// 0, 1, 2, … r.
fn uniform(degree: usize, count: usize) -> Vec<f64> {
    (0..=count + degree).map(|i| i as f64).collect()
}

/// Both ends repeated degree + 1 times, 1, 2, … between.
fn endpoint(degree: usize, count: usize) -> Vec<f64> {
    let spans = count - degree;
    (0..=count + degree).map(|i| i.saturating_sub(degree).min(spans) as f64).collect()
}

/// Inner knots repeated degree times: every piece ends in a control point. `pieces·degree + 1` points.
fn bezier(degree: usize, pieces: usize) -> Vec<f64> {
    let mut knots = vec![0.0; degree + 1];
    (1..pieces).for_each(|k| knots.extend(vec![k as f64; degree]));
    knots.extend(vec![pieces as f64; degree + 1]);
    knots
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn each_form_is_what_de_boor_says(seed in any::<u64>(), degree in 1usize..=8, more in 0usize..6,
        rational in any::<bool>()) {
        let mut random = Random(seed);
        let forms = [
            uniform(degree, degree + 1 + more),
            endpoint(degree, degree + 1 + more),
            bezier(degree, 1 + more),
        ];
        for knots in forms {
            let count = knots.len() - degree - 1;
            let weights = random.weights(count, rational, 2.0);
            let net = points(&mut random, count);
            let curve = NurbsCurve3::new(degree, knots.clone(), net.clone(), weights.clone()).expect("legal");
            // C(u) is defined on [u_p, u_{r−p}].
            prop_assert_eq!(curve.domain(), Range::new(knots[degree], knots[count]));
            for _ in 0..5 {
                let t = random.sample(curve.domain());
                let expected = project(de_boor(degree, &knots, &lift(&net, weights.as_deref()), t));
                prop_assert!(curve.point(t).distance(expected) < 1e-12);
            }
        }
    }

    /// Rhino leaves the first and the last knot out: nothing depends on them.
    #[test]
    fn the_two_end_knots_mean_nothing(seed in any::<u64>(), degree in 1usize..=8, before in 0.0f64..9.0,
        after in 0.0f64..9.0) {
        let mut random = Random(seed);
        let knots = random.knots(degree);
        let net = points(&mut random, knots.len() - degree - 1);
        let short = &knots[1..knots.len() - 1];
        let (Some(&first), Some(&last)) = (short.first(), short.last()) else { return Ok(()) };
        let full = |low: f64, high: f64| {
            let mut all = vec![low];
            all.extend_from_slice(short);
            all.push(high);
            NurbsCurve3::new(degree, all, net.clone(), None).expect("legal")
        };
        let (one, other) = (full(first, last), full(first - before, last + after));
        prop_assert_eq!(one.domain(), other.domain());
        for _ in 0..5 {
            let t = random.sample(one.domain());
            prop_assert!(one.point(t).distance(other.point(t)) < 1e-13);
            prop_assert!(one.jet(t)[1].distance(other.jet(t)[1]) <= 1e-12 * one.jet(t)[1].length().max(1.0));
        }
    }
}

#[test]
fn endpoint_knots_reach_the_outer_control_points_and_uniform_ones_do_not() {
    let mut random = Random(3);
    let net = points(&mut random, 7);
    let curve = |knots: Vec<f64>| NurbsCurve3::new(3, knots, net.clone(), None).expect("legal");
    let pinned = curve(endpoint(3, 7));
    assert_eq!((pinned.point(0.0), pinned.point(4.0)), (net[0], net[6]));
    let loose = curve(uniform(3, 7));
    // (P0 + 4 P1 + P2)/6, the cubic basis at a knot.
    assert!(loose.point(3.0).distance((net[0] + net[1] * 4.0 + net[2]) / 6.0) < 1e-15);
}

#[test]
fn a_quilt_passes_through_every_degree_th_control_point() {
    for degree in 1..=6 {
        let mut random = Random(degree as u64);
        let net = points(&mut random, 3 * degree + 1);
        let curve = NurbsCurve3::new(degree, bezier(degree, 3), net.clone(), None).expect("legal");
        for k in 0..=3 {
            assert!(curve.point(k as f64).distance(net[k * degree]) < 1e-14);
        }
        // Its pieces' control points are its own.
        for (k, (_, piece)) in curve.bezier_pieces().iter().enumerate() {
            for (p, q) in piece.points.iter().zip(&net[k * degree..]) {
                assert!(p.distance(*q) < 1e-14);
            }
        }
    }
}

#[test]
fn a_cyclic_surface_is_a_tube() {
    // Uniform in u with the first three rows repeated, pinned in v.
    let (n, m, radius) = (10usize, 3usize, 2.0);
    let row = |i: usize| {
        let angle = std::f64::consts::TAU * i as f64 / n as f64;
        (0..m).map(move |j| DVec3::new(radius * math::cos(angle), radius * math::sin(angle), j as f64))
    };
    let net: Vec<DVec3> = (0..n + 3).flat_map(|i| row(i % n)).collect();
    let tube = NurbsSurface::new([3, 2], uniform(3, n + 3), endpoint(2, m), net, None).expect("legal");
    assert!(tube.is_closed_u() && !tube.is_closed_v());
    let domain = tube.domain();
    for v in [0.0, 0.3, 1.0] {
        let [start, end] = [domain.min.x, domain.max.x].map(|u| tube.jet(DVec2::new(u, v)));
        assert!(start.p.distance(end.p) < 1e-14 && start.du.distance(end.du) < 1e-14);
        assert!(start.duu.distance(end.duu) < 1e-13);
    }
}

#[test]
fn stacked_points_are_passed_through_and_coplanar_blocks_are_flat() {
    let mut random = Random(11);
    let (p, n) = (3usize, 9usize);
    // (order − 1)² points in one place.
    let mut net = points(&mut random, n * n);
    let stack = DVec3::new(0.1, 0.2, 7.0);
    (3..6).for_each(|i| (3..6).for_each(|j| net[i * n + j] = stack));
    let s = NurbsSurface::new([p, p], endpoint(p, n), endpoint(p, n), net, None).expect("legal");
    assert!(s.point(DVec2::splat(3.0)).distance(stack) < 1e-14);
    // order² points in a plane make one flat patch.
    let mut net = points(&mut random, n * n);
    (2..6).for_each(|i| (2..6).for_each(|j| net[i * n + j].z = 5.0));
    let s = NurbsSurface::new([p, p], endpoint(p, n), endpoint(p, n), net, None).expect("legal");
    for k in 0..100 {
        let uv = DVec2::new(f64::from(k / 10), f64::from(k % 10)) / 9.0;
        assert!((s.point(uv + 2.0).z - 5.0).abs() < 1e-14);
    }
}
