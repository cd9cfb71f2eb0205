//! One curve and one surface of each kind, for tests.

use crate::math;
use crate::*;
use std::sync::Arc;

pub fn frame() -> Frame {
    Frame::new(DVec3::new(1.0, -2.0, 3.0), DVec3::new(0.3, 0.5, 0.9), DVec3::new(1.0, 0.2, -0.1))
}

fn frame2() -> Frame2 {
    Frame2::new(DVec2::new(0.4, -0.3), DVec2::new(0.6, 0.8))
}

pub fn nurbs_curve() -> NurbsCurve3 {
    let points = [[0., 0., 0.], [1., 2., 0.], [3., 1., 1.], [4., 4., -1.], [6., 3., 0.], [7., 0., 2.]];
    NurbsCurve3::new(
        3,
        vec![0., 0., 0., 0., 0.3, 0.7, 1., 1., 1., 1.],
        points.map(DVec3::from).to_vec(),
        Some(vec![1.0, 0.8, 1.5, 1.0, 0.7, 1.0]),
    )
    .unwrap()
}

pub fn polynomial_curve() -> NurbsCurve3 {
    let curve = nurbs_curve();
    NurbsCurve3::new(curve.degree(), curve.knots().to_vec(), curve.points().to_vec(), None).unwrap()
}

fn nurbs_curve2() -> NurbsCurve2 {
    nurbs_curve().mapped(|p| DVec2::new(0.1 + p.x * 0.1, 0.1 + p.y * 0.18))
}

pub fn segment(a: DVec3, b: DVec3) -> CompositeSegment {
    CompositeSegment { curve: Curve::Line { origin: a, direction: b - a }, start: 0.0, end: 1.0 }
}

/// Each kind of curve with a range to look at.
pub fn curves() -> Vec<(&'static str, Curve, Range)> {
    let f = frame();
    let arc = Curve::Circle { frame: f, radius: 2.0 };
    let shift = arc.point(0.5) - nurbs_curve().point(0.1);
    let joined = nurbs_curve().mapped(|p| p + shift);
    let composite = vec![
        segment(DVec3::ZERO, arc.point(2.0)),
        CompositeSegment { curve: arc.clone(), start: 2.0, end: 0.5 },
        CompositeSegment { curve: Curve::Nurbs(joined), start: 0.1, end: 0.9 },
    ];
    let line = Curve::Line { origin: DVec3::new(1., 2., 3.), direction: DVec3::new(2., -1., 0.5) };
    let surface = Arc::new(Surface::Cylinder { frame: f, radius: 3.0 });
    let bumpy = Arc::new(Surface::Nurbs(nurbs_surface()));
    vec![
        ("line", line, Range::new(-3.0, 4.0)),
        ("circle", arc, Range::new(0.3, 5.9)),
        ("ellipse", Curve::Ellipse { frame: f, a: 5.0, b: 1.5 }, Range::new(-0.4, 4.4)),
        ("parabola", Curve::Parabola { frame: f, focal: 0.7 }, Range::new(-2.0, 3.0)),
        ("hyperbola", Curve::Hyperbola { frame: f, a: 2.0, b: 1.2 }, Range::new(-1.5, 2.0)),
        ("polyline", Curve::Polyline(nurbs_curve().points().to_vec()), Range::new(0.25, 4.5)),
        ("rational", Curve::Nurbs(nurbs_curve()), Range::new(0.0, 1.0)),
        ("polynomial", Curve::Nurbs(polynomial_curve()), Range::new(0.05, 0.95)),
        ("composite", Curve::Composite(composite), Range::new(0.2, 2.9)),
        (
            "offset",
            Curve::Offset {
                basis: Box::new(Curve::Nurbs(nurbs_curve())),
                distance: 0.2,
                reference: DVec3::new(0.1, 0.0, 1.0),
            },
            Range::new(0.0, 1.0),
        ),
        (
            "on cylinder",
            Curve::OnSurface {
                surface,
                curve: Box::new(Curve2::Line {
                    origin: DVec2::new(0.2, 1.0),
                    direction: DVec2::new(0.5, 0.8),
                }),
            },
            Range::new(-1.0, 3.0),
        ),
        (
            "on nurbs",
            Curve::OnSurface { surface: bumpy, curve: Box::new(Curve2::Nurbs(nurbs_curve2())) },
            Range::new(0.0, 1.0),
        ),
    ]
}

/// Each kind of planar curve with a range to look at.
pub fn curves2() -> Vec<(&'static str, Curve2, Range)> {
    let f = frame2();
    let arc = Curve2::Circle { frame: f, radius: 2.0 };
    let line = Curve2::Line { origin: DVec2::new(1., 2.), direction: DVec2::new(2., -1.) };
    vec![
        ("line", line.clone(), Range::new(-3.0, 4.0)),
        ("circle", arc.clone(), Range::new(0.3, 5.9)),
        ("ellipse", Curve2::Ellipse { frame: f, a: 5.0, b: 1.5 }, Range::new(-0.4, 4.4)),
        ("parabola", Curve2::Parabola { frame: f, focal: 0.7 }, Range::new(-2.0, 3.0)),
        ("hyperbola", Curve2::Hyperbola { frame: f, a: 2.0, b: 1.2 }, Range::new(-1.5, 2.0)),
        ("polyline", Curve2::Polyline(nurbs_curve2().points().to_vec()), Range::new(0.25, 4.5)),
        ("nurbs", Curve2::Nurbs(nurbs_curve2()), Range::new(0.0, 1.0)),
        (
            "composite",
            Curve2::Composite(vec![(line.clone(), 0.0, 2.0), (arc, 2.0, 0.5), (line, 3.0, 1.0)]),
            Range::new(0.1, 2.8),
        ),
        (
            "offset",
            Curve2::Offset { basis: Box::new(Curve2::Nurbs(nurbs_curve2())), distance: 0.02 },
            Range::new(0.0, 1.0),
        ),
    ]
}

pub fn nurbs_surface() -> NurbsSurface {
    let mut points = Vec::new();
    let mut weights = Vec::new();
    for i in 0..5 {
        for j in 0..4 {
            let (x, y) = (f64::from(i), f64::from(j));
            points.push(DVec3::new(
                x * 2.0,
                y * 3.0 + 0.2 * x,
                math::sin(x * 1.3) + math::cos(y * 0.9) * 1.5,
            ));
            weights.push(1.0 + 0.3 * f64::from((i * 7 + j * 5) % 3));
        }
    }
    let knots_u = vec![0., 0., 0., 0., 0.4, 1., 1., 1., 1.];
    let knots_v = vec![0., 0., 0., 0.6, 1., 1., 1.];
    NurbsSurface::new([3, 2], knots_u, knots_v, points, Some(weights)).unwrap()
}

/// Each kind of surface with a box to look at.
pub fn surfaces() -> Vec<(&'static str, Surface, UvBox)> {
    let f = frame();
    let on = |u0: f64, u1: f64, v0: f64, v1: f64| UvBox::new(DVec2::new(u0, v0), DVec2::new(u1, v1));
    let profile = Curve::Nurbs(nurbs_curve());
    // Well away from the axis of the revolution.
    let axis_origin = DVec3::new(3.0, 12.0, 0.0);
    let nurbs = Surface::Nurbs(nurbs_surface());
    let tilted = Curve::Line { origin: DVec3::new(4., 0., 0.), direction: DVec3::new(0.5, 0.7, 1.0) };
    let arc = Curve::Circle { frame: f, radius: 2.0 };
    vec![
        ("plane", Surface::Plane { frame: f }, on(-3., 4., -2., 5.)),
        ("cylinder", Surface::Cylinder { frame: f, radius: 2.5 }, on(0.1, 6.2, -2., 5.)),
        ("cone", Surface::Cone { frame: f, radius: 2.0, half_angle: 0.4 }, on(0.1, 6.2, -3., 5.)),
        ("narrowing cone", Surface::Cone { frame: f, radius: 2.0, half_angle: -0.7 }, on(0.1, 6.2, -3., 1.5)),
        ("sphere", Surface::Sphere { frame: f, radius: 3.0 }, on(0.1, 6.2, -1.4, 1.4)),
        ("torus", Surface::Torus { frame: f, major: 5.0, minor: 1.5 }, on(0.1, 6.2, 0.1, 6.1)),
        ("apple", Surface::Torus { frame: f, major: 1.0, minor: 1.5 }, on(0.1, 6.2, -2.1, 2.1)),
        (
            "extrusion",
            Surface::Extrusion { profile: profile.clone(), direction: DVec3::new(0.3, -0.2, 2.0) },
            on(0.0, 1.0, -2., 3.),
        ),
        (
            "slanted tube",
            Surface::Extrusion { profile: arc, direction: f.z * 2.0 + f.x },
            on(0.1, 6.2, -2., 3.),
        ),
        (
            "hyperboloid",
            Surface::Revolution { profile: tilted, axis_origin: DVec3::ZERO, axis: DVec3::Z },
            on(0.1, 6.2, -2., 3.),
        ),
        (
            "revolution",
            Surface::Revolution { profile, axis_origin, axis: DVec3::new(1.0, 0.1, 0.2) },
            on(0.1, 6.2, 0.0, 1.0),
        ),
        ("nurbs", nurbs.clone(), on(0., 1., 0., 1.)),
        ("offset", Surface::Offset { basis: Box::new(nurbs), distance: 0.2 }, on(0., 1., 0., 1.)),
    ]
}

/// Numbers in 0..1 that repeat from run to run.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((self.0 >> 11) as f64) / (1u64 << 53) as f64
    }
    pub fn within(&mut self, range: Range) -> f64 {
        range.start + range.length() * self.next()
    }
    pub fn within_box(&mut self, uv: UvBox) -> DVec2 {
        DVec2::new(self.within(uv.u()), self.within(uv.v()))
    }
    pub fn vector(&mut self) -> DVec3 {
        DVec3::new(self.next() - 0.5, self.next() - 0.5, self.next() - 0.5) * 2.0
    }
}
