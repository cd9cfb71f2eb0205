//! Grids on one core of the host, in double precision, row by row.
//!
//! For a row v = const the Bézier net of each span is summed along v once; what is left is one rational polynomial in u a
//! span, taken by Horner's rule for as many points at a time as two vectors hold. A bicubic point then costs 12 fused
//! multiply-adds, 3 products and one division. Rows are handed out one after the other, so that they need never leave the cache.

use crate::{GpuError, SurfaceSet};
use pulp::{Arch, Simd, WithSimd};

/// Above this degree the power form loses too many digits; 2^p units in the worst case.
pub const HIGHEST_DEGREE: usize = 12;

/// Evaluates the grid `us` × `vs` on a surface of a set made by [`SurfaceSet::with_bezier`] and calls `row` with the
/// number of v and the x, y and z of all u, in the surface's local coordinates.
///
/// # Errors
/// [`GpuError::NoSuchSurface`]; [`GpuError::Device`] above [`HIGHEST_DEGREE`] along u or without Bézier nets.
pub fn host_grid(
    set: &SurfaceSet<f64>,
    surface: usize,
    us: &[f64],
    vs: &[f64],
    mut row: impl FnMut(usize, [&[f64]; 3]),
) -> Result<(), GpuError> {
    let entry = set.entries.get(surface).ok_or(GpuError::NoSuchSurface(surface))?;
    let [p, q] = entry.degree;
    if p > HIGHEST_DEGREE || !set.has_bezier() {
        let reason =
            format!("rows need Bézier nets and a degree of at most {HIGHEST_DEGREE} along u, not {p}");
        return Err(GpuError::Device { doing: "evaluating rows on the host".into(), reason });
    }
    let [along_u, along_v] = &entry.directions;
    let places: Vec<(u32, f64)> = us.iter().map(|&u| along_u.locate(u)).collect();
    let runs: Vec<(u32, usize)> =
        places.chunk_by(|a, b| a.0 == b.0).map(|run| (run[0].0, run.len())).collect();
    let ts: Vec<f64> = places.iter().map(|place| place.1).collect();
    let cells_v = along_v.breaks.len() - 1;
    let arch = Arch::new();
    let mut xyz = [vec![0.0; us.len()], vec![0.0; us.len()], vec![0.0; us.len()]];
    let mut coefficients = vec![[0.0; 4]; p + 1];
    for (j, &v) in vs.iter().enumerate() {
        let (span_v, t_v) = along_v.locate(v);
        let first = entry.bezier as usize + (span_v - along_v.span) as usize * (p + 1) * (q + 1);
        arch.dispatch(Row {
            nets: &set.bezier[first..],
            net_stride: cells_v * (p + 1) * (q + 1),
            first_span: along_u.span,
            runs: &runs,
            weights: &bernstein(q, t_v),
            coefficients: &mut coefficients,
            ts: &ts,
            xyz: &mut xyz,
        });
        row(j, [&xyz[0], &xyz[1], &xyz[2]]);
    }
    Ok(())
}

/// The Bernstein polynomials of a degree at `t`.
fn bernstein(degree: usize, t: f64) -> Vec<f64> {
    let mut row = vec![0.0; degree + 1];
    row[0] = 1.0;
    for level in 1..=degree {
        let mut saved = 0.0;
        for value in row.iter_mut().take(level) {
            let next = saved + (1.0 - t) * *value;
            saved = t * *value;
            *value = next;
        }
        row[level] = saved;
    }
    row
}

/// The coefficients of the powers of u of one row, lowest first: differences of the row's Bézier points.
#[inline(always)]
fn polynomial(net: &[[f64; 4]], weights: &[f64], coefficients: &mut [[f64; 4]]) {
    for (c, line) in coefficients.iter_mut().zip(net.chunks_exact(weights.len())) {
        *c = [0.0; 4];
        for (point, w) in line.iter().zip(weights) {
            (0..4).for_each(|k| c[k] += point[k] * w);
        }
    }
    let p = coefficients.len() - 1;
    for order in 1..=p {
        for i in (order..=p).rev() {
            (0..4).for_each(|k| coefficients[i][k] -= coefficients[i - 1][k]);
        }
    }
    let mut binomial = 1.0;
    for (k, c) in coefficients.iter_mut().enumerate() {
        c.iter_mut().for_each(|x| *x *= binomial);
        binomial *= (p - k) as f64 / (k + 1) as f64;
    }
}

/// One row: everything of it runs with the widest instructions there are.
struct Row<'a> {
    /// From the net of the first cell in this row of cells on.
    nets: &'a [[f64; 4]],
    /// From one cell to the next along u.
    net_stride: usize,
    first_span: u32,
    /// Spans, and how many of the points lie in each.
    runs: &'a [(u32, usize)],
    weights: &'a [f64],
    coefficients: &'a mut [[f64; 4]],
    ts: &'a [f64],
    xyz: &'a mut [Vec<f64>; 3],
}

impl WithSimd for Row<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let mut start = 0;
        for &(span, count) in self.runs {
            let at = (span - self.first_span) as usize * self.net_stride;
            let net = &self.nets[at..at + self.coefficients.len() * self.weights.len()];
            let run = start..start + count;
            let out = self.xyz.each_mut().map(|c| &mut c[run.clone()]);
            polynomial(net, self.weights, self.coefficients);
            // A length known to the compiler keeps the loop over degrees out of the loop over points.
            match <&[[f64; 4]; 4]>::try_from(&*self.coefficients) {
                Ok(cubic) => points(simd, cubic.as_slice(), &self.ts[run], out),
                Err(_) => points(simd, self.coefficients, &self.ts[run], out),
            }
            start += count;
        }
    }
}

#[inline(always)]
fn points<S: Simd>(simd: S, coefficients: &[[f64; 4]], ts: &[f64], [x, y, z]: [&mut [f64]; 3]) {
    let (ts, rest) = S::as_simd_f64s(ts);
    let (xs, rest_x) = S::as_mut_simd_f64s(x);
    let (ys, rest_y) = S::as_mut_simd_f64s(y);
    let (zs, rest_z) = S::as_mut_simd_f64s(z);
    let one = simd.splat_f64s(1.0);
    let mut pairs = ts.chunks_exact(2);
    let mut k = 0;
    for pair in &mut pairs {
        let (a, b) = (horner(simd, coefficients, pair[0]), horner(simd, coefficients, pair[1]));
        for (h, k) in [(a, k), (b, k + 1)] {
            let by_w = simd.div_f64s(one, h[3]);
            xs[k] = simd.mul_f64s(h[0], by_w);
            ys[k] = simd.mul_f64s(h[1], by_w);
            zs[k] = simd.mul_f64s(h[2], by_w);
        }
        k += 2;
    }
    for &t in pairs.remainder() {
        let h = horner(simd, coefficients, t);
        let by_w = simd.div_f64s(one, h[3]);
        (xs[k], ys[k], zs[k]) =
            (simd.mul_f64s(h[0], by_w), simd.mul_f64s(h[1], by_w), simd.mul_f64s(h[2], by_w));
        k += 1;
    }
    for (k, &t) in rest.iter().enumerate() {
        let mut h = [0.0; 4];
        for c in coefficients.iter().rev() {
            (0..4).for_each(|i| h[i] = h[i] * t + c[i]);
        }
        let by_w = 1.0 / h[3];
        (rest_x[k], rest_y[k], rest_z[k]) = (h[0] * by_w, h[1] * by_w, h[2] * by_w);
    }
}

#[inline(always)]
fn horner<S: Simd>(simd: S, coefficients: &[[f64; 4]], t: S::f64s) -> [S::f64s; 4] {
    let last = coefficients[coefficients.len() - 1];
    let mut h = [
        simd.splat_f64s(last[0]),
        simd.splat_f64s(last[1]),
        simd.splat_f64s(last[2]),
        simd.splat_f64s(last[3]),
    ];
    for c in coefficients[..coefficients.len() - 1].iter().rev() {
        h[0] = simd.mul_add_f64s(h[0], t, simd.splat_f64s(c[0]));
        h[1] = simd.mul_add_f64s(h[1], t, simd.splat_f64s(c[1]));
        h[2] = simd.mul_add_f64s(h[2], t, simd.splat_f64s(c[2]));
        h[3] = simd.mul_add_f64s(h[3], t, simd.splat_f64s(c[3]));
    }
    h
}

/// What one core can do, found by running it: (fused multiply-adds, divisions) a second.
pub fn host_peaks() -> (f64, f64) {
    let arch = Arch::new();
    let best = |run: &dyn Fn() -> f64| (0..7).map(|_| run()).fold(0.0, f64::max);
    (best(&|| arch.dispatch(Peak { divide: false })), best(&|| arch.dispatch(Peak { divide: true })))
}

struct Peak {
    divide: bool,
}

impl WithSimd for Peak {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        const CHAINS: usize = 10;
        const STEPS: usize = 200_000;
        let factor = simd.splat_f64s(std::hint::black_box(0.999_999));
        let mut chains = [simd.splat_f64s(std::hint::black_box(1.0)); CHAINS];
        let started = std::time::Instant::now();
        for _ in 0..STEPS {
            for chain in &mut chains {
                *chain = match self.divide {
                    true => simd.div_f64s(factor, *chain),
                    false => simd.mul_add_f64s(*chain, factor, factor),
                };
            }
        }
        let seconds = started.elapsed().as_secs_f64();
        let total = chains.into_iter().map(|c| simd.reduce_sum_f64s(c)).sum::<f64>();
        std::hint::black_box(total);
        (STEPS * CHAINS * S::F64_LANES) as f64 / seconds
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use chordal_nurbs::{DVec2, DVec3, NurbsSurface};

    #[test]
    fn rows_are_the_points_of_the_surface() {
        for degree in [[1, 1], [2, 3], [3, 3], [5, 2], [9, 9]] {
            let knots = |p: usize| {
                let inner = (0..=p).map(|_| 2.0).chain([2.5, 3.0, 3.0]).chain((0..=p).map(|_| 4.0));
                inner.collect::<Vec<f64>>()
            };
            let [u, v] = degree.map(|p| if p > 1 { knots(p) } else { vec![2.0, 2.0, 3.0, 4.0, 4.0] });
            let counts = [u.len() - degree[0] - 1, v.len() - degree[1] - 1];
            let point =
                |k: usize| DVec3::new((k / counts[1]) as f64, (k % counts[1]) as f64, (k * k % 7) as f64);
            let points = (0..counts[0] * counts[1]).map(point).collect();
            let weights = (0..counts[0] * counts[1]).map(|k| 1.0 + (k % 3) as f64).collect();
            let surface = NurbsSurface::new(degree, u, v, points, Some(weights)).unwrap();
            let mut set = SurfaceSet::<f64>::with_bezier();
            set.push_surface(&surface);
            let spread = |n: usize| (0..n).map(|k| 2.0 + 2.0 * k as f64 / (n - 1) as f64).collect::<Vec<_>>();
            let (us, vs) = (spread(53), spread(9));
            let frame = set.entries()[0].frame;
            let mut rows = 0;
            host_grid(&set, 0, &us, &vs, |j, [x, y, z]| {
                rows += 1;
                for (k, &u) in us.iter().enumerate() {
                    let p = frame.middle + frame.size * DVec3::new(x[k], y[k], z[k]);
                    let exact = surface.point(DVec2::new(u, vs[j]));
                    assert!(p.distance(exact) < 1e-11 * frame.size, "{degree:?} {k} {j}: {p} {exact}");
                }
            })
            .unwrap();
            assert_eq!(rows, vs.len());
        }
    }
}
