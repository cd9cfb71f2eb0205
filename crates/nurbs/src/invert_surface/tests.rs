use crate::fixtures::{self, Random};
use crate::math;
use crate::*;
use std::f64::consts::TAU;

#[test]
fn points_of_a_surface_come_back() {
    let mut random = Random(21);
    for (name, surface, uv) in fixtures::surfaces() {
        let inverter = SurfaceInverter::new(&surface, surface.domain());
        for _ in 0..200 {
            let at = random.within_box(uv);
            let p = surface.point(at);
            let found = inverter.invert(p, None);
            assert!(found.distance < 1e-11 * (1.0 + p.length()), "{name} at {at}: {found:?}");
            let again = surface.point(found.uv);
            assert!(again.distance(p) < 1e-11 * (1.0 + p.length()));
            if !["cone", "narrowing cone", "hyperboloid"].contains(&name) {
                let mut gap = (found.uv - at).abs();
                for axis in 0..2 {
                    if let Some(period) = surface.periods()[axis] {
                        gap[axis] = gap[axis].min((gap[axis] - period).abs());
                    }
                }
                assert!(gap.max_element() < 1e-7, "{name} at {at}: {found:?}");
            }
            let hint = at + DVec2::new(random.next() - 0.5, random.next() - 0.5) * uv.size() * 0.05;
            let near = inverter.invert(p, Some(hint));
            assert!(
                (near.uv - at).length() < 1e-7 * uv.size().length(),
                "{name} at {at} with a hint {hint}: {near:?}"
            );
        }
    }
}

#[test]
fn closest_points_are_square_and_no_sample_is_closer() {
    let mut random = Random(22);
    for (name, surface, uv) in fixtures::surfaces() {
        let inverter = SurfaceInverter::new(&surface, surface.domain());
        let samples: Vec<DVec3> = (0..=120)
            .flat_map(|i| (0..=120).map(move |j| DVec2::new(f64::from(i), f64::from(j)) / 120.0))
            .map(|s| surface.point(uv.min + uv.size() * s))
            .collect();
        let closed = surface.periods();
        for _ in 0..100 {
            let p = surface.point(random.within_box(uv)) + random.vector() * 0.8;
            let found = inverter.invert(p, None);
            let best = samples.iter().map(|s| s.distance(p)).fold(f64::INFINITY, f64::min);
            assert!(found.distance <= best + 1e-10, "{name}: {found:?} but {best}");
            let domain = surface.domain();
            let (q, du, dv) = surface.jet1(found.uv);
            for (axis, d) in [(0, du), (1, dv)] {
                let border = closed[axis].is_none()
                    && (found.uv[axis] <= domain.min[axis] || found.uv[axis] >= domain.max[axis]);
                let slant = (p - q).dot(d) / (1e-9 + d.length() * found.distance);
                let limit = if name == "offset" { 1e-6 } else { 1e-8 };
                assert!(border || slant.abs() < limit, "{name} {axis}: {slant} at {found:?}");
            }
        }
    }
}

#[test]
fn angles_follow_the_hint() {
    let cylinder = Surface::Cylinder { frame: fixtures::frame(), radius: 2.0 };
    let p = cylinder.point(DVec2::new(0.1, 3.0));
    for turn in [-2.0, 1.0, 3.0] {
        let found = cylinder.invert(p, Some(DVec2::new(0.3 + turn * TAU, 0.0)));
        assert!(found.distance(DVec2::new(0.1 + turn * TAU, 3.0)) < 1e-12);
    }
    let axis = fixtures::frame().origin + fixtures::frame().z;
    assert_eq!(cylinder.invert(axis, Some(DVec2::new(4.5, 0.0))).x, 4.5);
    let sphere = Surface::Sphere { frame: fixtures::frame(), radius: 2.0 };
    let pole = sphere.poles()[1].point;
    assert_eq!(sphere.invert(pole, Some(DVec2::new(5.5, 1.0))).x, 5.5);
    let inverter = SurfaceInverter::new(&cylinder, UvBox::new(DVec2::new(3.0, 0.0), DVec2::new(8.0, 1.0)));
    assert!((inverter.invert(p, None).uv.x - 0.1 - TAU).abs() < 1e-12);
}

#[test]
fn both_nappes_of_a_cone() {
    let cone = Surface::Cone { frame: fixtures::frame(), radius: 1.0, half_angle: 0.6 };
    for at in [DVec2::new(1.0, 3.0), DVec2::new(1.0, -5.0)] {
        let p = cone.point(at);
        assert!(cone.point(cone.invert(p, None)).distance(p) < 1e-13);
        assert!(cone.invert(p, Some(at + DVec2::splat(0.1))).distance(at) < 1e-12);
    }
}

/// Random nets, closed tubes, collapsed rows, creases: all but one in two hundred closest points are found.
#[test]
fn wild_surfaces_are_mostly_searched_well() {
    let mut r = Random(77);
    let (mut missed, mut tried) = (0, 0);
    for case in 0..60 {
        let du = 1 + (r.next() * 4.0) as usize;
        let dv = 1 + (r.next() * 4.0) as usize;
        let nu = du + 1 + (r.next() * 8.0) as usize;
        let nv = dv + 1 + (r.next() * 8.0) as usize;
        let knots = |d: usize, n: usize| {
            let mut k = vec![0.0; d + 1];
            k.extend((1..n - d).map(|i| i as f64));
            k.extend(vec![(n - d) as f64; d + 1]);
            k
        };
        let rough = r.next() * 2.0;
        let mut points = Vec::new();
        for i in 0..nu {
            for j in 0..nv {
                let a = TAU * i as f64 / (nu - 1) as f64;
                let base = match case % 3 {
                    0 => DVec3::new(i as f64, j as f64, 0.0),
                    1 => DVec3::new(3.0 * math::cos(a), 3.0 * math::sin(a), j as f64),
                    _ => DVec3::new(j as f64 * math::cos(a), j as f64 * math::sin(a), j as f64),
                };
                let noise = if case % 3 > 0 && (i == 0 || i == nu - 1 || j == 0) {
                    DVec3::ZERO
                } else {
                    r.vector() * rough
                };
                points.push(base + noise);
            }
        }
        let weights = (case % 2 == 0).then(|| (0..points.len()).map(|_| 0.5 + r.next()).collect());
        let Ok(s) = NurbsSurface::new([du, dv], knots(du, nu), knots(dv, nv), points, weights) else {
            continue;
        };
        let s = Surface::Nurbs(s);
        let uv = s.domain();
        let inv = SurfaceInverter::new(&s, uv);
        let samples: Vec<DVec3> = (0..=150)
            .flat_map(|i| (0..=150).map(move |j| DVec2::new(i as f64, j as f64) / 150.0))
            .map(|q| s.point(uv.min + uv.size() * q))
            .collect();
        for k in 0..60 {
            let q = r.within_box(uv);
            let p = s.point(q) + if k % 2 == 0 { DVec3::ZERO } else { r.vector() };
            let f = inv.invert(p, None);
            let best = samples.iter().map(|x| x.distance(p)).fold(f64::INFINITY, f64::min);
            tried += 1;
            let limit = if k % 2 == 0 { 1e-9 } else { best + 1e-9 };
            missed += usize::from(f.distance > limit);
        }
    }
    assert!(missed * 200 <= tried, "{missed} of {tried}");
}
