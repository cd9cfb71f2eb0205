//! What evaluation costs: the inner loop of every stage.

use chordal_nurbs::{BezierCurve, DVec2, DVec3, NurbsCurve3, NurbsSurface, Range, math};
use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;

fn knots(degree: usize) -> Vec<f64> {
    let mut knots = vec![0.0; degree + 1];
    knots.extend([0.2, 0.5, 0.7]);
    knots.extend(vec![1.0; degree + 1]);
    knots
}

fn wave(k: usize) -> DVec3 {
    let t = k as f64;
    DVec3::new(math::cos(t), math::sin(1.3 * t), 0.1 * t)
}

fn weights(count: usize, rational: bool) -> Option<Vec<f64>> {
    rational.then(|| (0..count).map(|k| 1.0 + 0.1 * (k % 5) as f64).collect())
}

fn surface(degree: usize, rational: bool) -> NurbsSurface {
    let knots = knots(degree);
    let count = (degree + 4).pow(2);
    let points = (0..count).map(wave).collect();
    NurbsSurface::new([degree; 2], knots.clone(), knots, points, weights(count, rational)).expect("legal")
}

fn curve(degree: usize, rational: bool) -> NurbsCurve3 {
    let count = degree + 4;
    let points = (0..count).map(wave).collect();
    NurbsCurve3::new(degree, knots(degree), points, weights(count, rational)).expect("legal")
}

fn evaluate(c: &mut Criterion) {
    for (name, rational) in [("polynomial", false), ("rational", true)] {
        for degree in [2, 3, 5, 20] {
            let (surface, curve) = (surface(degree, rational), curve(degree, rational));
            let uv = DVec2::new(0.43, 0.61);
            c.bench_function(&format!("surface point {name} {degree}"), |b| {
                b.iter(|| surface.point(black_box(uv)))
            });
            c.bench_function(&format!("surface jet {name} {degree}"), |b| {
                b.iter(|| surface.jet(black_box(uv)))
            });
            c.bench_function(&format!("curve jet {name} {degree}"), |b| {
                b.iter(|| curve.jet(black_box(0.43)))
            });
        }
        let (surface, curve) = (surface(3, rational), curve(3, rational));
        let range = Range::new(0.21, 0.24);
        c.bench_function(&format!("chord bound {name}"), |b| b.iter(|| curve.chord_bound(black_box(range))));
        c.bench_function(&format!("second derivative bound {name}"), |b| {
            b.iter(|| curve.derivative_bound(2, black_box(range)));
        });
        c.bench_function(&format!("patches {name}"), |b| b.iter(|| surface.bezier_patches(surface.domain())));
        let patch = &surface.bezier_patches(surface.domain())[5].1;
        let points =
            vec![DVec2::new(0.1, 0.2), DVec2::new(0.3, 0.9), DVec2::new(0.6, 0.1), DVec2::new(0.8, 0.7)];
        let line = BezierCurve { points, weights: None };
        c.bench_function(&format!("compose {name}"), |b| b.iter(|| patch.compose(black_box(&line))));
    }
}

criterion_group!(benches, evaluate);
criterion_main!(benches);
