//! What reuse of basis functions and row sums saves on the vertices of a grid and of a kd-tree's leaves.

use chordal_nurbs::{CoherentEvaluator, DVec2, DVec3, NurbsSurface, math};
use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;

fn knots(degree: usize) -> Vec<f64> {
    let mut knots = vec![0.0; degree + 1];
    knots.extend([0.2, 0.5, 0.7]);
    knots.resize(2 * degree + 5, 1.0);
    knots
}

fn surface(p: usize, q: usize, rational: bool) -> NurbsSurface {
    let count = (p + 4) * (q + 4);
    let point = |k: usize| DVec3::new(math::cos(k as f64), math::sin(1.3 * k as f64), 0.1 * k as f64);
    let weights = rational.then(|| (0..count).map(|k| 1.0 + 0.1 * (k % 5) as f64).collect());
    NurbsSurface::new([p, q], knots(p), knots(q), (0..count).map(point).collect(), weights).expect("legal")
}

/// Corners of a binary subdivision, coordinates shared as in a tessellation: the finer the nearer to a
/// corner.
fn tree_corners(depth: u32) -> Vec<DVec2> {
    let mut corners = Vec::new();
    let mut stack = vec![(DVec2::ZERO, DVec2::ONE, 0)];
    while let Some((low, high, level)) = stack.pop() {
        let near = low.length() < 0.5;
        if level < depth && (near || level < depth / 2) {
            let axis = (level % 2) as usize;
            let (mut below, mut above) = (high, low);
            below[axis] = 0.5 * (low[axis] + high[axis]);
            above[axis] = below[axis];
            stack.extend([(low, below, level + 1), (above, high, level + 1)]);
        } else {
            corners.push(low);
        }
    }
    corners
}

fn coherence(c: &mut Criterion) {
    let grid: Vec<DVec2> =
        (0..64 * 64).map(|k| DVec2::new(f64::from(k % 64), f64::from(k / 64)) / 63.0).collect();
    let sets = [("grid", grid), ("tree", tree_corners(14))];
    for (p, q, rational) in [(3, 3, false), (3, 3, true), (5, 2, true), (9, 9, false)] {
        let s = surface(p, q, rational);
        let kind = if rational { "rational" } else { "polynomial" };
        for (name, uv) in &sets {
            let title = format!("{name} of {} points, {p}x{q} {kind}", uv.len());
            c.bench_function(&format!("{title}, each by itself"), |b| {
                b.iter(|| uv.iter().map(|&p| s.point(black_box(p))).sum::<DVec3>());
            });
            c.bench_function(&format!("{title}, coherent"), |b| {
                let mut e = CoherentEvaluator::new(&s);
                let order = e.order(uv);
                b.iter(|| order.iter().map(|&i| e.point(black_box(uv[i as usize]))).sum::<DVec3>());
            });
        }
    }
}

criterion_group!(benches, coherence);
criterion_main!(benches);
