//! The papers' error formulas as restored, held against what they claim.
//!
//! Balázs, Guthe, Klein 2004, section 5.2, and Kahlesz, Balázs, Klein 2001, Lemmas 1 and 2, lost constants in
//! print, and what the former calls ε_approx is no bound at all. Here each constant is reached, or shown to
//! be too small.

use super::node::{Flatness, Measure};
use chordal_nurbs::{DVec2, DVec3, NurbsSurface, math};

fn clamped(degree: usize, inner: &[f64]) -> Vec<f64> {
    let mut knots = vec![0.0; degree + 1];
    knots.extend_from_slice(inner);
    knots.resize(knots.len() + degree + 1, 1.0);
    knots
}

/// Lagrange polynomials of the equal parameters 0, 1/n, …, 1 at `t`.
fn lagrange(n: usize, t: f64) -> Vec<f64> {
    let at = |i: usize| i as f64 / n as f64;
    (0..=n).map(|i| (0..=n).filter(|&j| j != i).map(|j| (t - at(j)) / (at(i) - at(j))).product()).collect()
}

/// Bernstein coefficients of the polynomial with these values at equal parameters.
fn interpolating(values: &[f64]) -> Vec<f64> {
    let n = values.len() - 1;
    let binomial = |i: usize| (0..i).fold(1.0, |b, k| b * (n - k) as f64 / (k + 1) as f64);
    let row = |k: usize| {
        let t = k as f64 / n as f64;
        (0..=n)
            .map(|i| binomial(i) * math::powi(t, i as i32) * math::powi(1.0 - t, (n - i) as i32))
            .collect::<Vec<f64>>()
    };
    let mut rows: Vec<(Vec<f64>, f64)> = (0..=n).map(|k| (row(k), values[k])).collect();
    for c in 0..=n {
        let pivot =
            (c..=n).max_by(|&a, &b| rows[a].0[c].abs().total_cmp(&rows[b].0[c].abs())).expect("a row");
        rows.swap(c, pivot);
        let (own, right) = rows[c].clone();
        for (r, other) in rows.iter_mut().enumerate() {
            let factor = if r == c { 0.0 } else { other.0[c] / own[c] };
            other.0.iter_mut().zip(&own).for_each(|(x, y)| *x -= factor * y);
            other.1 -= factor * right;
        }
    }
    (0..=n).map(|i| rows[i].1 / rows[i].0[i]).collect()
}

/// The surface over the unit square, heights zero at its corners, 1 or −1 at every other sample of ε_approx,
/// that rises highest between them; and where.
fn worst_for_samples(p: usize, q: usize) -> (NurbsSurface, DVec2) {
    let is_corner = |i: usize, j: usize| (i == 0 || i == p) && (j == 0 || j == q);
    let height = |at: DVec2| -> f64 {
        let (u, v) = (lagrange(p, at.x), lagrange(q, at.y));
        let cells = (0..=p).flat_map(|i| (0..=q).map(move |j| (i, j))).filter(|&(i, j)| !is_corner(i, j));
        cells.map(|(i, j)| (u[i] * v[j]).abs()).sum()
    };
    let grid = |k: usize| k as f64 / 400.0;
    let places = (0..=400).flat_map(|i| (0..=400).map(move |j| DVec2::new(grid(i), grid(j))));
    let top = places.max_by(|a, b| height(*a).total_cmp(&height(*b))).expect("a place");
    let (u, v) = (lagrange(p, top.x), lagrange(q, top.y));
    let value = |i: usize, j: usize| if is_corner(i, j) { 0.0 } else { (u[i] * v[j]).signum() };
    // Along v first, then along u.
    let rows: Vec<Vec<f64>> =
        (0..=p).map(|i| interpolating(&(0..=q).map(|j| value(i, j)).collect::<Vec<f64>>())).collect();
    let columns: Vec<Vec<f64>> =
        (0..=q).map(|j| interpolating(&rows.iter().map(|r| r[j]).collect::<Vec<f64>>())).collect();
    let points = (0..=p)
        .flat_map(|i| (0..=q).map(move |j| (i, j)))
        .map(|(i, j)| DVec3::new(i as f64 / p as f64, j as f64 / q as f64, columns[j][i]));
    let surface = NurbsSurface::new([p, q], clamped(p, &[]), clamped(q, &[]), points.collect(), None);
    (surface.expect("valid"), top)
}

#[test]
fn the_approximate_error_is_no_bound() {
    // Of the true height, how much the samples miss: a cubic curve, a bicubic patch, a curve of degree 9.
    for (p, q, missed) in [(3, 1, 0.23), (3, 3, 0.60), (9, 1, 0.94)] {
        let (surface, top) = worst_for_samples(p, q);
        let estimated = Flatness::new(&surface, Measure::Estimated).error;
        let conservative = Flatness::new(&surface, Measure::Conservative).error;
        let height = surface.point(top).z.abs();
        assert!((estimated - 1.0).abs() < 1e-6, "{estimated}");
        assert!(conservative >= height);
        let share = 1.0 - estimated / height;
        assert!((share - missed).abs() < 0.03, "degree {p} × {q}: {share}");
    }
}

/// Corners of a square, one of them lifted by 1: T is the lift.
fn twisted(weights: Option<Vec<f64>>) -> NurbsSurface {
    let wide = 1e4;
    let points = [(0., 0., 0.), (0., wide, 0.), (wide, 0., 0.), (wide, wide, 1.)].map(DVec3::from).to_vec();
    NurbsSurface::new([1, 1], clamped(1, &[]), clamped(1, &[]), points, weights).expect("valid")
}

/// Height of the surface's middle under the fold along the diagonal through the lifted corner.
fn below_the_fold(surface: &NurbsSurface) -> f64 {
    let p = surface.point(DVec2::splat(0.5));
    p.x.min(p.y) / 1e4 - p.z
}

#[test]
fn a_quarter_of_the_twist_is_reached_by_a_bilinear_patch() {
    let surface = twisted(None);
    let f = Flatness::new(&surface, Measure::Conservative);
    assert_eq!((f.bilinear, f.error), (0.0, 0.25));
    assert!((below_the_fold(&surface) - 0.25).abs() < 1e-9);
}

#[test]
fn weights_need_half_of_the_twist() {
    // Heavy corners beside the lifted one pull the middle down to them; E is 0 for any weights.
    for (weight, at_least) in [(7.5, 0.44), (1e3, 0.499)] {
        let surface = twisted(Some(vec![1.0, weight, weight, 1.0]));
        let f = Flatness::new(&surface, Measure::Conservative);
        assert_eq!((f.bilinear, f.error), (0.0, 0.5));
        let found = below_the_fold(&surface);
        assert!(found >= at_least && found <= 0.5, "{found}");
    }
}

#[test]
fn other_triangles_of_a_cell_need_e_twice() {
    // Linear pieces, so that E is what the surface does: up, down, up.
    let heights = [0.0, 1.0, -1.0, 1.0, 0.0];
    let points = heights
        .iter()
        .enumerate()
        .flat_map(|(i, &z)| [0.0, 1e4].map(|y| DVec3::new(2.5e3 * i as f64, y, z)))
        .collect();
    let surface = NurbsSurface::new([1, 1], clamped(1, &[0.25, 0.5, 0.75]), clamped(1, &[]), points, None)
        .expect("valid");
    let f = Flatness::new(&surface, Measure::Conservative);
    assert_eq!(f.error, 1.0);
    let corners = [(0.25, 0.0), (0.25, 1.0), (0.75, 0.5)].map(|c| surface.point(DVec2::from(c)));
    assert!(corners.iter().all(|c| c.z == 1.0), "the triangle is level");
    let valley = surface.point(DVec2::splat(0.5)).z;
    assert_eq!(corners[0].z - valley, 2.0 * f.error);
}
