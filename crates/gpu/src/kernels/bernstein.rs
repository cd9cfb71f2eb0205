//! Twin of `bernstein.wgsl`: every span's Bézier net, cell by cell.

use super::bezier::{Cell, Horner, second_factor, tangents_at};
use super::samples::Sample;
use super::samples::{Inputs, Jet};
use super::vector::V4;
use crate::real::Real;

fn cell_of<R: Real>(inputs: &Inputs<R>, s: &Sample) -> Cell<R> {
    let (u, v) = (inputs.span(s.row_u), inputs.span(s.row_v));
    let at = s.head.bezier + (u.cell * s.head.cells_v + v.cell) * (u.degree + 1) * (v.degree + 1);
    Cell { at: at as usize, p: u.degree, q: v.degree, t: [inputs.ts[s.row_u], inputs.ts[s.row_v]] }
}

pub(crate) fn points<R: Real>(inputs: &Inputs<R>, out: &mut [R]) {
    for s in inputs.samples() {
        let cell = cell_of(inputs, &s);
        let mut sum = Horner::start();
        for i in 0..=cell.p {
            let [line, ..] = cell.line(inputs.net, i, 1);
            sum.add(line, i, cell.p, cell.t[0]);
        }
        inputs.write_point(s, sum.sum, out);
    }
}

pub(crate) fn normals<R: Real>(inputs: &Inputs<R>, out: &mut [R]) {
    for s in inputs.samples() {
        inputs.write_normal(s, &tangents_at(inputs.net, &cell_of(inputs, &s)), out);
    }
}

pub(crate) fn jets<R: Real>(inputs: &Inputs<R>, out: &mut [R]) {
    for s in inputs.samples() {
        let cell = cell_of(inputs, &s);
        if inputs.params.planes == 2 {
            inputs.write_first(s, &tangents_at(inputs.net, &cell), out);
        } else {
            inputs.write_jet(s, &jet_at(inputs.net, &cell), out);
        }
    }
}

/// All derivatives up to the second.
fn jet_at<R: Real>(net: &[[R; 4]], cell: &Cell<R>) -> Jet<R> {
    let Cell { p, t: [t, _], .. } = *cell;
    let mut sums = [[Horner::start(); 3]; 3];
    let (mut last, mut before) = ([V4::default(); 3], [V4::default(); 3]);
    for i in 0..=p {
        let line = cell.line(net, i, 3);
        for b in 0..3 {
            sums[0][b].add(line[b], i, p, t);
        }
        if i > 0 {
            for b in 0..2 {
                sums[1][b].add(line[b] - last[b], i - 1, p - 1, t);
            }
        }
        if i > 1 {
            let second = (line[0] - last[0]) - (last[0] - before[0]);
            sums[2][0].add(second, i - 2, p - 2, t);
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
    jet
}
