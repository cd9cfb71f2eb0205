use crate::fixtures::{self, Random};
use crate::math;
use crate::*;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

fn inner(uv: UvBox, h: DVec2) -> UvBox {
    uv.inflated(h * -3.0)
}

#[test]
fn jets_are_the_derivatives_of_points() {
    let mut random = Random(3);
    for (name, surface, uv) in fixtures::surfaces() {
        let h = uv.size() * 1e-5;
        let [us, vs] = surface.all_breaks(uv);
        for _ in 0..60 {
            let at = random.within_box(inner(uv, h));
            let near = |lines: &[f64], w: f64, h: f64| lines.iter().any(|l| (l - w).abs() < 2.0 * h);
            if near(&us, at.x, h.x) || near(&vs, at.y, h.y) {
                continue;
            }
            let jet = surface.jet(at);
            let (p, du, dv) = surface.jet1(at);
            assert!(p.distance(jet.p) < 1e-13 && p.distance(surface.point(at)) < 1e-13, "{name}");
            assert!(du.distance(jet.du) < 1e-12 && dv.distance(jet.dv) < 1e-12, "{name}");
            let (hu, hv) = (DVec2::new(h.x, 0.0), DVec2::new(0.0, h.y));
            let by = |f: &dyn Fn(DVec2) -> DVec3, h: DVec2| (f(at + h) - f(at - h)) / (2.0 * h.length());
            let scale =
                1.0 + jet.duu.length() + jet.duv.length() + jet.dvv.length() + du.length() + dv.length();
            let check = |what, found: DVec3, expected: DVec3| {
                assert!(found.distance(expected) < 3e-6 * scale, "{name} {what} at {at}: {found} {expected}");
            };
            check("du", du, by(&|q| surface.point(q), hu));
            check("dv", dv, by(&|q| surface.point(q), hv));
            check("duu", jet.duu, by(&|q| surface.jet1(q).1, hu));
            check("duv", jet.duv, by(&|q| surface.jet1(q).1, hv));
            check("duv", jet.duv, by(&|q| surface.jet1(q).2, hu));
            check("dvv", jet.dvv, by(&|q| surface.jet1(q).2, hv));
            let n = surface.normal(at).unwrap();
            assert!(n.distance(du.cross(dv).normalize()) < 1e-9, "{name} normal at {at}");
        }
    }
}

#[test]
fn poles_are_points_with_normals() {
    let f = fixtures::frame();
    let sphere = Surface::Sphere { frame: f, radius: 3.0 };
    let cone = Surface::Cone { frame: f, radius: 2.0, half_angle: 0.4 };
    let apple = Surface::Torus { frame: f, major: 1.0, minor: 2.0 };
    let lemon = Surface::Torus { frame: f, major: -1.0, minor: 2.0 };
    let horn = Surface::Torus { frame: f, major: 2.0, minor: 2.0 };
    let half = Curve::Circle { frame: Frame { origin: f.origin, x: f.x, y: f.z, z: -f.y }, radius: 3.0 };
    let ball = Surface::Revolution { profile: half, axis_origin: f.origin, axis: f.z };
    let slope = Curve::Line { origin: f.origin + f.x * 2.0, direction: f.z + f.x * 0.5 };
    let funnel = Surface::Revolution { profile: slope, axis_origin: f.origin, axis: f.z };
    let bowl = Surface::Revolution {
        profile: Curve::Parabola { frame: Frame { origin: f.origin, x: f.z, y: f.x, z: f.y }, focal: 1.0 },
        axis_origin: f.origin,
        axis: f.z,
    };
    for (surface, values) in [
        (&sphere, vec![-FRAC_PI_2, FRAC_PI_2]),
        (&cone, vec![-2.0 / math::tan(0.4)]),
        (&apple, vec![-PI + PI / 3.0, PI - PI / 3.0]),
        (&lemon, vec![-PI / 3.0, PI / 3.0]),
        (&horn, vec![PI]),
        (&ball, vec![FRAC_PI_2, 1.5 * PI]),
        (&funnel, vec![-4.0]),
        (&bowl, vec![0.0]),
    ] {
        let poles = surface.poles();
        assert_eq!(poles.len(), values.len(), "{:?}: {poles:?}", surface.kind());
        for (pole, value) in poles.iter().zip(values) {
            assert_eq!(pole.axis, 1);
            assert!((pole.value - value).abs() < 1e-7, "{:?} {} {value}", surface.kind(), pole.value);
            for u in [0.0, 1.0, 4.0] {
                let at = DVec2::new(u, pole.value);
                assert!(surface.point(at).distance(pole.point) < 1e-6);
                let n = surface.normal(at).expect("a limit");
                // The limit agrees with the normal a little to the side.
                let beside = [-1e-3, 1e-3].map(|d| surface.normal(DVec2::new(u, pole.value + d)).unwrap());
                assert!(beside.iter().any(|b| b.distance(n) < 5e-3), "{:?} {n} {beside:?}", surface.kind());
            }
        }
    }
    assert!(Surface::Torus { frame: f, major: 3.0, minor: 1.0 }.poles().is_empty());
}

#[test]
fn collapsed_rows_are_poles() {
    let mut points = fixtures::nurbs_surface().points().to_vec();
    for i in 0..5 {
        points[i * 4] = DVec3::new(1., 1., 1.);
    }
    let s = fixtures::nurbs_surface();
    let s = NurbsSurface::new(s.degree(), s.knots_u().to_vec(), s.knots_v().to_vec(), points, None).unwrap();
    let surface = Surface::Nurbs(s);
    let poles = surface.poles();
    assert_eq!(poles.len(), 1);
    assert_eq!((poles[0].axis, poles[0].value, poles[0].point), (1, 0.0, DVec3::ONE));
    for u in [0.0, 0.3, 1.0] {
        let n = surface.normal(DVec2::new(u, 0.0)).unwrap();
        assert!(n.distance(surface.normal(DVec2::new(u, 1e-3)).unwrap()) < 1e-2);
    }
}

#[test]
fn closed_surfaces_have_periods() {
    let closed = |p: &dyn Fn(f64) -> DVec3| {
        let points: Vec<DVec3> = (0..=8).map(|i| p(f64::from(i % 8) * TAU / 8.0)).collect();
        let mut knots = vec![0.0];
        knots.extend((0..=8).map(f64::from));
        knots.push(8.0);
        (knots, points)
    };
    let (knots, ring) = closed(&|a| DVec3::new(math::cos(a), math::sin(a), 0.0));
    let points: Vec<DVec3> = ring.iter().flat_map(|&p| [p, p + DVec3::Z]).collect();
    let tube = Surface::Nurbs(NurbsSurface::new([1, 1], knots, vec![0., 0., 1., 1.], points, None).unwrap());
    assert_eq!(tube.periods(), [Some(8.0), None]);
    assert!(tube.point(DVec2::new(8.5, 0.5)).distance(tube.point(DVec2::new(0.5, 0.5))) < 1e-15);
    let circle = Curve::Circle { frame: fixtures::frame(), radius: 1.0 };
    let swept = Surface::Extrusion { profile: circle, direction: DVec3::X };
    assert_eq!(swept.periods(), [Some(TAU), None]);
    assert_eq!(Surface::Nurbs(fixtures::nurbs_surface()).periods(), [None, None]);
}

#[test]
fn moved_surfaces_keep_their_kind() {
    let turn = DAffine3::from_quat(math::rotation(DVec3::new(1., 2., 3.).normalize(), 0.7));
    let similar =
        DAffine3::from_translation(DVec3::new(5., -7., 2.)) * turn * DAffine3::from_scale(DVec3::splat(2.5));
    let mirror = similar * DAffine3::from_scale(DVec3::new(-1., 1., 1.));
    let mut random = Random(4);
    for by in [similar, mirror] {
        for (name, surface, uv) in fixtures::surfaces() {
            let moved = surface.transformed(&by).expect(name);
            assert_eq!(moved.surface.kind(), surface.kind());
            for _ in 0..20 {
                let at = random.within_box(uv);
                let gap = moved
                    .surface
                    .point(moved.parameters(at))
                    .distance(by.transform_point3(surface.point(at)));
                assert!(gap < 1e-10, "{name} at {at}: {gap}");
            }
        }
    }
}

#[test]
fn offsets_of_elementary_and_extruded_surfaces_are_exact() {
    let mut random = Random(5);
    for (name, surface, uv) in fixtures::surfaces() {
        let exact_form = [
            "plane",
            "cylinder",
            "cone",
            "narrowing cone",
            "sphere",
            "torus",
            "extrusion",
            "tube",
            "slanted tube",
        ];
        let elementary = exact_form.contains(&name);
        for distance in [0.3, -0.4] {
            let inner = Surface::Offset { basis: Box::new(surface.clone()), distance: 0.1 };
            let offset = Surface::Offset { basis: Box::new(inner), distance };
            let exact = offset.clone().simplified();
            assert_eq!(exact.kind() == SurfaceKind::Offset, !elementary, "{name}");
            for _ in 0..20 {
                let at = random.within_box(uv);
                assert!(offset.point(at).distance(exact.point(at)) < 1e-12, "{name} at {at}");
            }
        }
    }
}

#[test]
fn offsets_of_surfaces_of_revolution_are_surfaces_of_revolution() {
    let across = Frame::new(DVec3::new(3.0, 0.0, 1.0), DVec3::Y, DVec3::X);
    let points = vec![DVec3::new(1.0, 0.0, 0.0), DVec3::new(2.0, 0.0, 1.0), DVec3::new(4.0, 0.0, 1.0)];
    let spline = NurbsCurve::new(2, vec![0., 0., 0., 1., 1., 1.], points, None).expect("a spline");
    let profiles = [
        Curve::Circle { frame: across, radius: 2.0 },
        // Passes the axis.
        Curve::Circle { frame: across, radius: 5.0 },
        Curve::Line { origin: DVec3::new(2.0, 0.0, 0.0), direction: DVec3::new(1.0, 0.0, 2.0) },
        Curve::Nurbs(spline),
    ];
    for profile in profiles {
        let basis = Surface::Revolution { profile, axis_origin: DVec3::ZERO, axis: DVec3::Z };
        for distance in [0.3, -0.4] {
            let offset = Surface::Offset { basis: Box::new(basis.clone()), distance };
            let forms = offset.offset_revolutions().expect("profiles in the plane of the axis");
            for at in [DVec2::new(0.3, 0.2), DVec2::new(1.3, 0.9), DVec2::new(2.0, 0.5)] {
                let p = offset.point(at);
                let nearest = forms.iter().map(|form| form.point(at).distance(p)).fold(f64::MAX, f64::min);
                assert!(nearest < 1e-12, "{basis:?} by {distance} at {at}: {nearest}");
            }
        }
    }
    let skew = Curve::Line { origin: DVec3::X, direction: DVec3::new(0.0, 1.0, 1.0) };
    let basis = Surface::Revolution { profile: skew, axis_origin: DVec3::ZERO, axis: DVec3::Z };
    assert_eq!(Surface::Offset { basis: Box::new(basis), distance: 0.3 }.offset_revolutions(), None);
}
