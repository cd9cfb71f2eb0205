use crate::fixtures::{self, Random};
use crate::math;
use crate::*;
use std::f64::consts::TAU;

fn near_break(breaks: &[f64], t: f64, h: f64) -> bool {
    breaks.iter().any(|b| (b - t).abs() <= 2.0 * h)
}

#[test]
fn jets_are_the_derivatives_of_points() {
    let mut random = Random(1);
    for (name, curve, range) in fixtures::curves() {
        let h = 1e-5 * range.length();
        let breaks = curve.all_breaks(range);
        for _ in 0..50 {
            let t = random.within(Range::new(range.start + 3.0 * h, range.end - 3.0 * h));
            if near_break(&breaks, t, h) {
                continue;
            }
            let [p, d1, d2, d3] = curve.jet3(t);
            let jet = curve.jet(t);
            assert_eq!((jet.p, jet.d1, jet.d2), (p, d1, d2), "{name}");
            assert!(p.distance(curve.point(t)) < 1e-14 * (1.0 + p.length()), "{name}");
            let slope = (curve.point(t + h) - curve.point(t - h)) / (2.0 * h);
            let bend = (curve.jet(t + h).d1 - curve.jet(t - h).d1) / (2.0 * h);
            let third = (curve.jet(t + h).d2 - curve.jet(t - h).d2) / (2.0 * h);
            let size =
                d1.length() + d2.length() * range.length() + d3.length() * math::square(range.length()) + 1.0;
            assert!(slope.distance(d1) < 1e-7 * size, "{name} {t}: {slope} {d1}");
            assert!(bend.distance(d2) < 1e-7 * size / range.length().min(1.0), "{name} {t}: {bend} {d2}");
            assert!(
                third.distance(d3) < 1e-4 * size / math::square(range.length().min(1.0)),
                "{name} {t}: {third} {d3}"
            );
        }
    }
}

#[test]
fn planar_jets_are_the_derivatives_of_points() {
    let mut random = Random(2);
    for (name, curve, range) in fixtures::curves2() {
        let h = 1e-5 * range.length();
        let breaks = curve.all_breaks(range);
        for _ in 0..50 {
            let t = random.within(Range::new(range.start + 3.0 * h, range.end - 3.0 * h));
            if near_break(&breaks, t, h) {
                continue;
            }
            let jet = curve.jet(t);
            let slope = (curve.point(t + h) - curve.point(t - h)) / (2.0 * h);
            let bend = (curve.jet(t + h).d1 - curve.jet(t - h).d1) / (2.0 * h);
            assert!(slope.distance(jet.d1) < 1e-6 * (1.0 + slope.length()), "{name} {t}");
            assert!(bend.distance(jet.d2) < 1e-5 * (1.0 + bend.length()), "{name} {t}: {bend} {}", jet.d2);
        }
    }
}

#[test]
fn breaks_are_corners_joints_and_knots() {
    let polyline = Curve::Polyline(vec![DVec3::ZERO, DVec3::X, DVec3::ONE, DVec3::Z]);
    assert_eq!(polyline.breaks(Range::new(0.5, 3.0)), vec![1.0, 2.0]);
    let nurbs = Curve::Nurbs(fixtures::nurbs_curve());
    assert_eq!(nurbs.breaks(Range::new(0.0, 1.0)), Vec::<f64>::new());
    assert_eq!(nurbs.all_breaks(Range::new(0.0, 1.0)), vec![0.3, 0.7]);
    let (_, composite, range) = fixtures::curves().into_iter().find(|c| c.0 == "composite").unwrap();
    let breaks = composite.all_breaks(range);
    assert_eq!(breaks.len(), 4, "{breaks:?}");
    assert_eq!(breaks[..2], [1.0, 2.0]);
    assert!((breaks[2] - 2.25).abs() < 1e-12 && (breaks[3] - 2.75).abs() < 1e-12);
    // A curve on a surface breaks where it crosses the surface's knot lines.
    let (_, curve, range) = fixtures::curves().into_iter().find(|c| c.0 == "on nurbs").unwrap();
    let Curve::OnSurface { curve: pcurve, .. } = &curve else { panic!() };
    let crossing = curve.all_breaks(range).into_iter().map(|t| pcurve.point(t)).collect::<Vec<_>>();
    assert!(crossing.iter().any(|p| (p.x - 0.4).abs() < 1e-12), "{crossing:?}");
    assert!(crossing.iter().any(|p| (p.y - 0.6).abs() < 1e-12), "{crossing:?}");
}

#[test]
fn closed_curves_go_round() {
    let square = [DVec3::ZERO, DVec3::X, DVec3::new(1., 1., 0.), DVec3::Y, DVec3::ZERO];
    let polyline = Curve::Polyline(square.to_vec());
    let nurbs =
        Curve::Nurbs(NurbsCurve3::new(1, vec![0., 0., 1., 2., 3., 4., 4.], square.to_vec(), None).unwrap());
    let sides = square.windows(2).map(|s| fixtures::segment(s[0], s[1])).collect();
    for curve in [polyline, nurbs, Curve::Composite(sides)] {
        assert_eq!(curve.period(), Some(4.0));
        assert!(curve.point(4.5).distance(DVec3::new(0.5, 0., 0.)) < 1e-15);
        assert!(curve.point(-0.25).distance(DVec3::new(0., 0.25, 0.)) < 1e-15);
        assert_eq!(curve.breaks(Range::new(3.5, 5.5)), vec![4.0, 5.0]);
    }
    assert_eq!(Curve::Circle { frame: Frame::WORLD, radius: 1.0 }.period(), Some(TAU));
    assert_eq!(Curve::Nurbs(fixtures::nurbs_curve()).period(), None);
}

#[test]
fn curvature_of_known_curves() {
    assert!((Curve::Circle { frame: fixtures::frame(), radius: 4.0 }.curvature(1.0) - 0.25).abs() < 1e-14);
    assert!(
        (Curve::Ellipse { frame: fixtures::frame(), a: 3.0, b: 2.0 }.curvature(0.0) - 0.75).abs() < 1e-14
    );
    assert!((Curve::Parabola { frame: fixtures::frame(), focal: 2.0 }.curvature(0.0) - 0.25).abs() < 1e-14);
    assert_eq!(Curve::Line { origin: DVec3::ZERO, direction: DVec3::X }.curvature(0.0), 0.0);
}

#[test]
fn moved_curves_keep_their_parameters() {
    let turn = DAffine3::from_quat(math::rotation(DVec3::new(1., 2., 3.).normalize(), 0.7));
    let similar =
        DAffine3::from_translation(DVec3::new(5., -7., 2.)) * turn * DAffine3::from_scale(DVec3::splat(2.5));
    let mirror = similar * DAffine3::from_scale(DVec3::new(-1., 1., 1.));
    for by in [similar, mirror] {
        for (name, curve, range) in fixtures::curves() {
            let moved = curve.transformed(&by).expect(name);
            for i in 0..=20 {
                let t = range.start + range.length() * f64::from(i) / 20.0;
                let gap = moved.point(t).distance(by.transform_point3(curve.point(t)));
                assert!(gap < 1e-11, "{name} at {t}: {gap}");
            }
        }
    }
    let stretch = DAffine3::from_scale(DVec3::new(1., 3., 1.));
    let circle = Curve::Circle { frame: Frame::WORLD, radius: 2.0 };
    assert_eq!(circle.transformed(&stretch), Some(Curve::Ellipse { frame: Frame::WORLD, a: 2.0, b: 6.0 }));
    assert_eq!(Curve::Circle { frame: fixtures::frame(), radius: 2.0 }.transformed(&stretch), None);
}

#[test]
fn scaled_planar_curves_keep_their_parameters() {
    let by = DVec2::new(0.017, 25.4);
    for (name, curve, range) in fixtures::curves2() {
        let Some(scaled) = curve.scaled(by) else {
            assert!(["circle", "ellipse", "parabola", "hyperbola", "composite", "offset"].contains(&name));
            let even = curve.scaled(DVec2::splat(-3.0)).expect(name);
            let t = range.start;
            assert!(even.point(t).distance(curve.point(t) * -3.0) < 1e-12, "{name}");
            continue;
        };
        for i in 0..=20 {
            let t = range.start + range.length() * f64::from(i) / 20.0;
            assert!(scaled.point(t).distance(curve.point(t) * by) < 1e-12, "{name}");
        }
    }
    let circle = Curve2::Circle { frame: Frame2::new(DVec2::ONE, DVec2::Y), radius: 2.0 };
    assert!(matches!(circle.scaled(by), Some(Curve2::Ellipse { .. })));
}

#[test]
fn boxes_contain_and_fit() {
    for (name, curve, range) in fixtures::curves() {
        let found = curve.bbox(range);
        let samples = (0..=5000).map(|i| curve.point(range.start + range.length() * f64::from(i) / 5000.0));
        let tight = Box3::from_points(samples);
        let grown = found.inflated(1e-12 * (1.0 + found.diagonal()));
        assert!(grown.contains(tight.min) && grown.contains(tight.max), "{name}: {found:?} {tight:?}");
        let slack = 0.05 * tight.diagonal();
        assert!((found.min - tight.min).abs().max_element() < slack, "{name}: {found:?} {tight:?}");
        assert!((found.max - tight.max).abs().max_element() < slack, "{name}: {found:?} {tight:?}");
    }
}
