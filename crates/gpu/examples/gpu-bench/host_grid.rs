//! Grids on one core of the host, in double precision, row by row.
//!
//! Purpose: what the GPU is compared with, at the speed that one core has. Notation: a cell is a pair of
//! spans, p and q the degrees along u and v, (x, y, z, w) homogeneous local coordinates, t the place in a
//! span along u.
//!
//! 1. Once a surface ([`HostSurface::new`]): the Bézier net of each cell in powers of t along u, left in
//!    Bernstein form along v.
//! 2. Once a row v = const and span: the sum along v, p + 1 coefficients each of x, y, z, w.
//! 3. In the same place the quotient X = x₀ / w₀ at t = 0 is taken out of the numerators, x(t) = X w(t) + t
//!    r(t), so that x / w = X + r(t) · (t / w(t)): one degree less, and no products after the division. A
//!    rational bicubic point costs 12 fused multiply-adds and one division, a polynomial one 9 multiply-adds.
//! 4. As many points at a time as a vector holds, by Horner's rule; what is left at the end of a span is the
//!    vector that ends there, so that some points are found twice, to the same bits.
//!
//! Rows are handed out one after the other, so that they need never leave the cache. Not guaranteed: the
//! digits of high degrees, which the power form loses (2^p units in the worst case, hence
//! [`HIGHEST_DEGREE`]).

use chordal_gpu::{GpuError, SurfaceSet, Unsuitable};
use pulp::{Arch, Simd, WithSimd};

/// The highest degree along u that rows are evaluated at.
pub const HIGHEST_DEGREE: usize = 12;

/// How points follow from the coefficients of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    /// All weights are equal.
    Polynomial,
    /// All weights have one sign, so that w₀ is no smaller than the smallest of them.
    Rational,
    /// w may vanish anywhere: step 3 is left out.
    AnyWeights,
}

/// A surface made ready for rows.
#[derive(Clone, Debug)]
pub struct HostSurface<'a> {
    /// The ends of the spans along u and along v.
    breaks: [&'a [f64]; 2],
    degree: [usize; 2],
    form: Form,
    /// Per cell, u slowest, and number j along v: p + 1 coefficients of x, of y, of z and of w.
    nets: Vec<f64>,
}

impl<'a> HostSurface<'a> {
    /// Prepares a surface of a set made by [`SurfaceSet::with_bezier`].
    ///
    /// # Errors
    /// [`GpuError::NoSuchSurface`]; [`GpuError::Unsuitable`] above [`HIGHEST_DEGREE`] along u or without
    /// Bézier nets.
    pub fn new(set: &'a SurfaceSet<f64>, surface: usize) -> Result<Self, GpuError> {
        let entry = set.entries().get(surface).ok_or(GpuError::NoSuchSurface(surface))?;
        let [p, q] = entry.degree;
        if p > HIGHEST_DEGREE {
            return Err(GpuError::Unsuitable(Unsuitable::Degree { degree: p, most: HIGHEST_DEGREE }));
        }
        if !set.has_bezier() {
            return Err(GpuError::Unsuitable(Unsuitable::NoBezierNets));
        }
        let beziers = set.bezier_points(surface);
        let form = match (entry.weight_ratio == 1.0, beziers.iter().all(|b| b[3] > 0.0)) {
            (true, true) => Form::Polynomial,
            (false, true) => Form::Rational,
            (_, false) => Form::AnyWeights,
        };
        let mut nets = Vec::with_capacity(4 * beziers.len());
        for cell in beziers.chunks_exact((p + 1) * (q + 1)) {
            for (j, k) in (0..=q).flat_map(|j| (0..4).map(move |k| (j, k))) {
                let first = nets.len();
                nets.extend((0..=p).map(|i| cell[i * (q + 1) + j][k]));
                powers(&mut nets[first..]);
            }
        }
        Ok(Self { breaks: entry.breaks(), degree: [p, q], form, nets })
    }

    /// Evaluates the grid `us` × `vs` and calls `row` with the number of v and the x, y and z of all u, in
    /// the surface's local coordinates. Parameters outside the domain are clamped to it; `us` that ascend are
    /// fastest.
    pub fn grid(&self, us: &[f64], vs: &[f64], mut row: impl FnMut(usize, [&[f64]; 3])) {
        let [p, q] = self.degree;
        let [along_u, along_v] = self.breaks;
        let places: Vec<(usize, f64)> = us.iter().map(|&u| locate(along_u, u)).collect();
        let runs: Vec<(usize, usize)> =
            places.chunk_by(|a, b| a.0 == b.0).map(|run| (run[0].0, run.len())).collect();
        let mut room = vec![0.0; 4 * stagger(us.len()) + LINE];
        let mut arrays = staggered(&mut room, us.len());
        let [ts, ..] = &mut arrays;
        ts.iter_mut().zip(&places).for_each(|(t, place)| *t = place.1);
        let cell = 4 * (p + 1) * (q + 1);
        let arch = Arch::new();
        let [ts, x, y, z] = arrays;
        let mut coefficients = [vec![0.0; 4 * (p + 1) * runs.len()], vec![0.0; 4 * (p + 1) * runs.len()]];
        let mut weights = vec![0.0; q + 1];
        // The coefficients of a row are found while the points of the row before it are: neither waits for
        // the other.
        for j in 0..=vs.len() {
            let [ready, next] = &mut coefficients;
            let line = vs.get(j).map(|&v| {
                let (span_v, t_v) = locate(along_v, v);
                bernstein(t_v, &mut weights);
                Line {
                    nets: &self.nets[span_v * cell..],
                    net_stride: (along_v.len() - 1) * cell,
                    weights: &weights,
                    coefficients: next,
                }
            });
            let points = (j > 0).then_some(Points { coefficients: ready, ts, xyz: [x, y, z] });
            arch.dispatch(Rows { form: self.form, runs: &runs, line, points });
            if j > 0 {
                row(j - 1, [x, y, z]);
            }
            coefficients.swap(0, 1);
        }
    }
}

/// The span of `t` (clamped to the domain) and the place in it, 0..=1.
fn locate(breaks: &[f64], t: f64) -> (usize, f64) {
    let count = breaks.len() - 1;
    let t = t.max(breaks[0]).min(breaks[count]);
    let span = breaks[1..count].partition_point(|&b| b <= t);
    (span, ((t - breaks[span]) / (breaks[span + 1] - breaks[span])).clamp(0.0, 1.0))
}

/// Numbers in a line of the cache, and in a page.
const LINE: usize = 8;
const PAGE: usize = 512;

/// From one of four arrays to the next: a quarter of a page beyond whole pages. Were all at the same place of
/// their pages, the core would take loads of one for loads of what has just been stored into another.
fn stagger(count: usize) -> usize {
    count.next_multiple_of(PAGE) + PAGE / 4
}

/// Four arrays of `count` numbers that begin with a line of the cache.
fn staggered(room: &mut [f64], count: usize) -> [&mut [f64]; 4] {
    let skipped = room.as_ptr().align_offset(LINE * size_of::<f64>()).min(LINE);
    let (a, rest) = room[skipped..].split_at_mut(stagger(count));
    let (b, rest) = rest.split_at_mut(stagger(count));
    let (c, d) = rest.split_at_mut(stagger(count));
    [&mut a[..count], &mut b[..count], &mut c[..count], &mut d[..count]]
}

/// The Bernstein polynomials at `t`, of the degree that the length of `row` says.
fn bernstein(t: f64, row: &mut [f64]) {
    row.fill(0.0);
    row[0] = 1.0;
    for level in 1..row.len() {
        let mut saved = 0.0;
        for value in row.iter_mut().take(level) {
            let next = saved + (1.0 - t) * *value;
            saved = t * *value;
            *value = next;
        }
        row[level] = saved;
    }
}

/// Bézier ordinates to coefficients of powers, lowest first: differences times binomials.
fn powers(ordinates: &mut [f64]) {
    let p = ordinates.len() - 1;
    for order in 1..=p {
        for i in (order..=p).rev() {
            ordinates[i] -= ordinates[i - 1];
        }
    }
    let mut binomial = 1.0;
    for (k, c) in ordinates.iter_mut().enumerate() {
        *c *= binomial;
        binomial *= (p - k) as f64 / (k + 1) as f64;
    }
}

/// The points of one row and the coefficients of the next. Everything of it must be inlined into one function
/// with the widest instructions there are: closures given to library functions (`map`, `from_fn`) would be
/// compiled without them, so plain loops stand here.
struct Rows<'a> {
    form: Form,
    /// Spans, and how many of the points lie in each.
    runs: &'a [(usize, usize)],
    line: Option<Line<'a>>,
    points: Option<Points<'a>>,
}

/// What the coefficients of a row are made of.
struct Line<'a> {
    /// From the net of the first cell in this row of cells on.
    nets: &'a [f64],
    /// From one cell to the next along u.
    net_stride: usize,
    weights: &'a [f64],
    /// 4 (p + 1) a run.
    coefficients: &'a mut [f64],
}

/// What the points of a row are made of.
struct Points<'a> {
    coefficients: &'a [f64],
    ts: &'a [f64],
    xyz: [&'a mut [f64]; 3],
}

impl WithSimd for Rows<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        if let Some(line) = self.line {
            line_of(simd, line, self.runs, self.form == Form::Rational);
        }
        let Some(Points { coefficients, ts, xyz: [x, y, z] }) = self.points else { return };
        let size = (coefficients.len() / self.runs.len().max(1)).max(1);
        let mut start = 0;
        for (line, &(_, count)) in coefficients.chunks_exact(size).zip(self.runs) {
            let run = start..start + count;
            let ts = &ts[run.clone()];
            let out = [&mut x[run.clone()], &mut y[run.clone()], &mut z[run]];
            match self.form {
                Form::Polynomial => points::<S, POLYNOMIAL>(simd, line, ts, out),
                Form::Rational => points::<S, RATIONAL>(simd, line, ts, out),
                Form::AnyWeights => points::<S, ANY_WEIGHTS>(simd, line, ts, out),
            }
            start += count;
        }
    }
}

/// Steps 2 and 3 for all spans of a row.
#[inline(always)]
fn line_of<S: Simd>(simd: S, line: Line<'_>, runs: &[(usize, usize)], rational: bool) {
    let Line { nets, net_stride, weights, coefficients } = line;
    let size = (coefficients.len() / runs.len().max(1)).max(1);
    for (line, &(span, _)) in coefficients.chunks_exact_mut(size).zip(runs) {
        let at = span * net_stride;
        let net = &nets[at..at + size * weights.len()];
        // The same code twice: with lengths that the compiler knows it becomes a row of multiply-adds.
        match (<&mut [_; 16]>::try_from(&mut *line), <&[_; 4]>::try_from(weights)) {
            (Ok(line), Ok(weights)) => row_of(simd, net, weights, line, rational),
            _ => row_of(simd, net, weights, line, rational),
        }
    }
}

/// Steps 2 and 3: all coefficients of one span in one row.
#[inline(always)]
fn row_of<S: Simd>(simd: S, net: &[f64], weights: &[f64], line: &mut [f64], rational: bool) {
    let size = line.len();
    let (sums, rest) = S::as_mut_simd_f64s(line);
    for (m, sum) in sums.iter_mut().enumerate() {
        let mut total = simd.mul_f64s(S::as_simd_f64s(&net[..size]).0[m], simd.splat_f64s(weights[0]));
        for (terms, &weight) in net.chunks_exact(size).zip(weights).skip(1) {
            total = simd.mul_add_f64s(S::as_simd_f64s(terms).0[m], simd.splat_f64s(weight), total);
        }
        *sum = total;
    }
    // Vectors of eight leave four numbers where p + 1 is odd.
    let done = size - rest.len();
    for (m, sum) in rest.iter_mut().enumerate() {
        *sum = 0.0;
        for (terms, &weight) in net.chunks_exact(size).zip(weights) {
            *sum += terms[done + m] * weight;
        }
    }
    if rational {
        take_out_start(line);
    }
}

/// Step 3.
#[inline(always)]
fn take_out_start(line: &mut [f64]) {
    let columns = line.len() / 4;
    let (xyz, w) = line.split_at_mut(3 * columns);
    let by_w = 1.0 / w[0];
    for k in 0..3 {
        let numerator = &mut xyz[k * columns..(k + 1) * columns];
        let start = numerator[0] * by_w;
        for i in 0..columns {
            numerator[i] -= start * w[i];
        }
        numerator[0] = start;
    }
}

const POLYNOMIAL: u8 = 0;
const RATIONAL: u8 = 1;
const ANY_WEIGHTS: u8 = 2;

/// Numbers in the widest vectors there are.
const MOST_LANES: usize = 8;

/// Step 4: all points of one span in one row.
#[inline(always)]
fn points<S: Simd, const FORM: u8>(simd: S, line: &[f64], ts: &[f64], out: [&mut [f64]; 3]) {
    // Arrays of a length known to the compiler stay in registers, and their loop over degrees leaves the loop
    // over points.
    match line.len() / 4 {
        2 => vectors::<S, FORM>(simd, &splat::<S, 2>(simd, line), ts, out),
        3 => vectors::<S, FORM>(simd, &splat::<S, 3>(simd, line), ts, out),
        4 => vectors::<S, FORM>(simd, &splat::<S, 4>(simd, line), ts, out),
        n => {
            let all = splat::<S, { HIGHEST_DEGREE + 1 }>(simd, line);
            vectors::<S, FORM>(simd, &all[..n], ts, out);
        }
    }
}

/// Each coefficient in every lane of a vector, by power and by component; zeros above the row's degree.
#[inline(always)]
fn splat<S: Simd, const N: usize>(simd: S, line: &[f64]) -> [[S::f64s; 4]; N] {
    let columns = line.len() / 4;
    let mut all = [[simd.splat_f64s(0.0); 4]; N];
    for (i, to) in all.iter_mut().take(columns).enumerate() {
        to[0] = simd.splat_f64s(line[i]);
        to[1] = simd.splat_f64s(line[columns + i]);
        to[2] = simd.splat_f64s(line[2 * columns + i]);
        to[3] = simd.splat_f64s(line[3 * columns + i]);
    }
    all
}

#[inline(always)]
fn vectors<S: Simd, const FORM: u8>(simd: S, c: &[[S::f64s; 4]], ts: &[f64], [x, y, z]: [&mut [f64]; 3]) {
    let count = ts.len();
    if count < S::F64_LANES {
        // A vector of its own, filled up with the start of the span.
        let mut padded = [0.0; MOST_LANES];
        padded[..count].copy_from_slice(ts);
        let p = point::<S, FORM>(simd, c, S::as_simd_f64s(&padded).0[0]);
        for (k, out) in [x, y, z].into_iter().enumerate() {
            S::as_mut_simd_f64s(&mut padded).0[0] = p[k];
            out.copy_from_slice(&padded[..count]);
        }
        return;
    }
    let places = S::as_simd_f64s(ts).0;
    let xs = S::as_mut_simd_f64s(x).0;
    let ys = S::as_mut_simd_f64s(y).0;
    let zs = S::as_mut_simd_f64s(z).0;
    for (((&t, x), y), z) in places.iter().zip(xs).zip(ys).zip(zs) {
        let p = point::<S, FORM>(simd, c, t);
        (*x, *y, *z) = (p[0], p[1], p[2]);
    }
    if !count.is_multiple_of(S::F64_LANES) {
        let last = count - S::F64_LANES;
        let p = point::<S, FORM>(simd, c, S::as_simd_f64s(&ts[last..]).0[0]);
        S::as_mut_simd_f64s(&mut x[last..]).0[0] = p[0];
        S::as_mut_simd_f64s(&mut y[last..]).0[0] = p[1];
        S::as_mut_simd_f64s(&mut z[last..]).0[0] = p[2];
    }
}

/// As many points as a vector holds.
#[inline(always)]
fn point<S: Simd, const FORM: u8>(simd: S, c: &[[S::f64s; 4]], t: S::f64s) -> [S::f64s; 3] {
    let p = c.len() - 1;
    let mut w = c[p][3];
    if FORM != POLYNOMIAL {
        for line in c[..p].iter().rev() {
            w = simd.mul_add_f64s(w, t, line[3]);
        }
    }
    // What the numerator's last step multiplies with, and the whole point afterwards.
    let (step, by_w) = match FORM {
        POLYNOMIAL => (t, None),
        RATIONAL => (simd.div_f64s(t, w), None),
        _ => (t, Some(simd.div_f64s(simd.splat_f64s(1.0), w))),
    };
    let mut out = [step; 3];
    for k in 0..3 {
        let mut sum = c[p][k];
        for line in c[1..p].iter().rev() {
            sum = simd.mul_add_f64s(sum, t, line[k]);
        }
        sum = simd.mul_add_f64s(sum, step, c[0][k]);
        out[k] = match by_w {
            Some(by_w) => simd.mul_f64s(sum, by_w),
            None => sum,
        };
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use chordal_nurbs::{DVec2, DVec3, NurbsSurface};

    fn sheet(degree: [usize; 2], weight: impl Fn(usize) -> f64) -> NurbsSurface {
        let knots = |p: usize| {
            let inner = (0..=p).map(|_| 2.0).chain([2.5, 3.0, 3.0]).chain((0..=p).map(|_| 4.0));
            inner.collect::<Vec<f64>>()
        };
        let [u, v] = degree.map(|p| if p > 1 { knots(p) } else { vec![2.0, 2.0, 3.0, 4.0, 4.0] });
        let counts = [u.len() - degree[0] - 1, v.len() - degree[1] - 1];
        let point = |k: usize| DVec3::new((k / counts[1]) as f64, (k % counts[1]) as f64, (k * k % 7) as f64);
        let points = (0..counts[0] * counts[1]).map(point).collect();
        let weights = (0..counts[0] * counts[1]).map(weight).collect();
        NurbsSurface::new(degree, u, v, points, Some(weights)).unwrap()
    }

    /// Every point of a grid on a surface, against the crate `nurbs`.
    fn check(surface: &NurbsSurface, us: &[f64], vs: &[f64]) {
        let mut set = SurfaceSet::<f64>::with_bezier();
        set.push_surface(surface);
        let frame = set.entries()[0].frame;
        let mut rows = 0;
        HostSurface::new(&set, 0).unwrap().grid(us, vs, |j, [x, y, z]| {
            rows += 1;
            for (k, &u) in us.iter().enumerate() {
                let p = frame.middle + frame.size * DVec3::new(x[k], y[k], z[k]);
                let exact = surface.point(DVec2::new(u, vs[j]));
                let error = p.distance(exact) / frame.size.max(exact.length());
                assert!(error < 1e-11, "{:?} {k} of {} {j}: {p} {exact}", surface.degree(), us.len());
            }
        });
        assert_eq!(rows, vs.len());
    }

    fn spread(n: usize) -> Vec<f64> {
        (0..n).map(|k| 2.0 + 2.0 * k as f64 / (n - 1) as f64).collect()
    }

    #[test]
    fn rows_are_the_points_of_the_surface() {
        for degree in [[1, 1], [2, 3], [3, 3], [5, 2], [9, 9]] {
            let rational = sheet(degree, |k| 1.0 + (k % 3) as f64);
            // Spans with fewer points than a vector holds, with as many, and with some over.
            for count in [2, 3, 5, 9, 14, 17, 53] {
                check(&rational, &spread(count), &spread(9));
            }
            check(&sheet(degree, |_| 3.0), &spread(53), &spread(9));
            // Not in order, and the same parameter twice.
            check(&rational, &[3.9, 2.1, 2.2, 3.0, 3.0, 2.0, 4.0], &[3.5, 2.0]);
            check(&rational, &[], &[3.5]);
        }
    }

    #[test]
    fn weights_of_both_signs_may_start_a_span_at_infinity() {
        // w = 0 along one side of every span row, where the points are not looked at.
        let surface = sheet([3, 3], |k| if k % 6 < 1 { 1e-3 } else { -1.0 });
        check(&surface, &[2.3, 2.4, 2.7, 3.2, 3.6, 3.8], &[2.9, 3.3, 3.7]);
        let zero = sheet([2, 2], |k| if k < 5 { 1e-12 } else { 1.0 });
        check(&zero, &[2.1, 2.2, 2.3, 2.4, 2.45, 2.6], &[2.9, 3.3]);
    }

    #[test]
    fn what_rows_cannot_do_is_an_error() {
        let mut set = SurfaceSet::<f64>::with_bezier();
        set.push_surface(&sheet([HIGHEST_DEGREE + 1, 2], |_| 1.0));
        assert!(matches!(HostSurface::new(&set, 0), Err(GpuError::Unsuitable(Unsuitable::Degree { .. }))));
        assert_eq!(HostSurface::new(&set, 1).err(), Some(GpuError::NoSuchSurface(1)));
        let mut plain = SurfaceSet::<f64>::new();
        plain.push_surface(&sheet([2, 2], |_| 1.0));
        assert!(matches!(HostSurface::new(&plain, 0), Err(GpuError::Unsuitable(Unsuitable::NoBezierNets))));
    }
}
