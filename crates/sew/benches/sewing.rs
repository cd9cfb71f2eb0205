//! Sewing of n loose patches of a wavy sheet, each with four edges of its own: what n log n looks like.

use chordal_brep::{Face, FaceGeometry, Part, Source};
use chordal_nurbs::{DVec3, NurbsSurface, Surface, math};
use chordal_sew::{SewTolerance, sew_part};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;
use std::sync::Arc;

/// `side` × `side` biquadratic patches without loops.
fn patches(side: usize) -> Part {
    let knots = vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0];
    let wave = |x: f64, y: f64| DVec3::new(x, y, 0.3 * math::sin(0.7 * x) * math::cos(0.9 * y));
    let face = |i: usize, j: usize| {
        let points = (0..9).map(|k| wave(i as f64 + (k / 3) as f64 / 2.0, j as f64 + (k % 3) as f64 / 2.0));
        let surface = NurbsSurface::new([2, 2], knots.clone(), knots.clone(), points.collect(), None);
        Face {
            geometry: FaceGeometry::Surface(Arc::new(Surface::Nurbs(surface.expect("nine points")))),
            same_sense: true,
            flipped: false,
            loops: Vec::new(),
            name: String::new(),
            color: None,
            layer: None,
            source: Source::default(),
        }
    };
    let faces = (0..side).flat_map(|i| (0..side).map(move |j| (i, j))).map(|(i, j)| face(i, j)).collect();
    Part { faces, ..Part::default() }
}

fn sewing(c: &mut Criterion) {
    let mut group = c.benchmark_group("sew");
    group.sample_size(10);
    for side in [32_usize, 100, 316] {
        let part = patches(side);
        let inner = 2 * side * (side - 1);
        assert_eq!(sew_part(&part, SewTolerance::Length(1e-4)).1.sewn, inner);
        group.throughput(Throughput::Elements((side * side) as u64));
        group.bench_function(BenchmarkId::new("patches", side * side), |b| {
            b.iter(|| sew_part(black_box(&part), SewTolerance::Auto));
        });
    }
    group.finish();
}

criterion_group!(benches, sewing);
criterion_main!(benches);
