//! Twin of `bernstein.wgsl`: every span's Bézier net, summed by Horner's rule for Bernstein polynomials.

use super::samples::{Inputs, Jet};
use super::{Sample, V4};
use crate::Real;

/// The terms of one difference of order k: its running sum and C(n-k, i) tⁱ.
#[derive(Clone, Copy)]
struct Horner<R> {
    sum: V4<R>,
    term: R,
}

impl<R: Real> Horner<R> {
    fn start() -> Self {
        Self { sum: V4::default(), term: R::one() }
    }
    fn add(&mut self, value: V4<R>, i: u32, n: u32, t: R) {
        self.sum = self.sum * (R::one() - t) + value * self.term;
        self.term = self.term * t * R::from_u32(n - i) / R::from_u32(i + 1);
    }
}

/// n (n - 1), or 0.
fn second_factor<R: Real>(n: u32) -> R {
    if n > 1 { R::from_u32(n) * R::from_u32(n - 1) } else { R::zero() }
}

/// One line of a net along v: value and first two derivatives.
fn line_of<R: Real>(inputs: &Inputs<R>, start: usize, q: u32, t: R, planes: u32) -> [V4<R>; 3] {
    let mut sums = [Horner::start(); 3];
    let (mut last, mut before) = (V4::default(), V4::default());
    for j in 0..=q {
        let b = inputs.point(start + j as usize);
        sums[0].add(b, j, q, t);
        if planes > 1 && j > 0 {
            sums[1].add(b - last, j - 1, q - 1, t);
        }
        if planes > 2 && j > 1 {
            sums[2].add((b - last) - (last - before), j - 2, q - 2, t);
        }
        (before, last) = (last, b);
    }
    [sums[0].sum, sums[1].sum * R::from_u32(q), sums[2].sum * second_factor(q)]
}

/// The first control point of the sample's cell.
fn cell<R: Real>(inputs: &Inputs<R>, s: &Sample) -> usize {
    let (u, v) = (inputs.span(s.row_u), inputs.span(s.row_v));
    (s.head.bezier + (u.cell * s.head.cells_v + v.cell) * (u.degree + 1) * (v.degree + 1)) as usize
}

pub(crate) fn points<R: Real>(inputs: &Inputs<R>, out: &mut [R]) {
    for s in inputs.samples() {
        let (p, q) = (inputs.span(s.row_u).degree, inputs.span(s.row_v).degree);
        let (t_u, t_v) = (inputs.ts[s.row_u], inputs.ts[s.row_v]);
        let mut sum = Horner::start();
        for i in 0..=p {
            let [line, ..] = line_of(inputs, cell(inputs, &s) + (i * (q + 1)) as usize, q, t_v, 1);
            sum.add(line, i, p, t_u);
        }
        inputs.write_point(s, sum.sum, out);
    }
}

pub(crate) fn jets<R: Real>(inputs: &Inputs<R>, out: &mut [R]) {
    let planes = inputs.params.planes;
    for s in inputs.samples() {
        let (p, q) = (inputs.span(s.row_u).degree, inputs.span(s.row_v).degree);
        let (t_u, t_v) = (inputs.ts[s.row_u], inputs.ts[s.row_v]);
        let mut sums = [[Horner::start(); 3]; 3];
        let (mut last, mut before) = ([V4::default(); 3], [V4::default(); 3]);
        for i in 0..=p {
            let line = line_of(inputs, cell(inputs, &s) + (i * (q + 1)) as usize, q, t_v, planes);
            for b in 0..3 {
                sums[0][b].add(line[b], i, p, t_u);
            }
            if i > 0 {
                for b in 0..2 {
                    sums[1][b].add(line[b] - last[b], i - 1, p - 1, t_u);
                }
            }
            if i > 1 {
                let second = (line[0] - last[0]) - (last[0] - before[0]);
                sums[2][0].add(second, i - 2, p - 2, t_u);
            }
            (before, last) = (last, line);
        }
        let factors = [R::one(), R::from_u32(p), second_factor(p)];
        let mut jet = Jet::<R>::default();
        for a in 0..3 {
            for b in 0..3 - a {
                jet[a][b] = if a == 0 { sums[a][b].sum } else { sums[a][b].sum * factors[a] };
            }
        }
        inputs.write_jet(s, &jet, out);
    }
}
