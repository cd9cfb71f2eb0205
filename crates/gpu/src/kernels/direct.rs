//! Twin of `direct.wgsl`: basis functions and sum in one kernel.

use super::normal::tangents_of;
use super::samples::Sample;
use super::samples::{Inputs, Jet};
use super::tensor::control;
use super::vector::V4;
use crate::layout::Span;
use crate::real::Real;

const PLANE: usize = 101;

/// The functions of a span at `t` and their first two derivatives.
type Basis<R> = [[R; PLANE]; 3];

fn fill<R: Real>(windows: &[R], span: Span, t: R, planes: usize) -> Basis<R> {
    let p = span.degree as usize;
    let window = &windows[span.window as usize + 2..];
    let mut basis = [[R::zero(); PLANE]; 3];
    basis[0][0] = R::one();
    for level in 1..=p {
        for order in 1..planes {
            if order + level == p + 1 {
                let (functions, rest) = basis.split_at_mut(1);
                rest[order - 1][..level].copy_from_slice(&functions[0][..level]);
            }
        }
        let mut saved = [R::zero(); 3];
        for j in 0..level {
            let low = window[p - level + j];
            let width = window[p + j] - low;
            let a = (t - low) / width;
            let n = basis[0][j];
            basis[0][j] = saved[0] + (R::one() - a) * n;
            saved[0] = a * n;
            let slope = R::from_u32(level as u32) / width;
            for order in 1..planes {
                if order + level > p {
                    let step = slope * basis[order][j];
                    basis[order][j] = saved[order] - step;
                    saved[order] = step;
                }
            }
        }
        for order in 0..3 {
            basis[order][level] = saved[order];
        }
    }
    basis
}

pub(crate) fn points<R: Real>(inputs: &Inputs<R>, out: &mut [R]) {
    for s in inputs.samples() {
        let (u, v) = (inputs.span(s.row_u), inputs.span(s.row_v));
        let bu = fill(inputs.windows, u, inputs.ts[s.row_u], 1);
        let bv = fill(inputs.windows, v, inputs.ts[s.row_v], 1);
        let mut sum = V4::default();
        for i in 0..=u.degree {
            let mut line = V4::default();
            for j in 0..=v.degree {
                line = line + control(inputs, &s, i, j) * bv[0][j as usize];
            }
            sum = sum + line * bu[0][i as usize];
        }
        inputs.write_point(s, sum, out);
    }
}

pub(crate) fn normals<R: Real>(inputs: &Inputs<R>, out: &mut [R]) {
    for s in inputs.samples() {
        let jet = jet_of(inputs, &s);
        inputs.write_normal(s, &tangents_of(jet[0][0], jet[1][0], jet[0][1]), out);
    }
}

pub(crate) fn jets<R: Real>(inputs: &Inputs<R>, out: &mut [R]) {
    for s in inputs.samples() {
        inputs.write_jet(s, &jet_of(inputs, &s), out);
    }
}

/// The derivatives that `planes` selects.
fn jet_of<R: Real>(inputs: &Inputs<R>, s: &Sample) -> Jet<R> {
    let planes = inputs.params.planes as usize;
    let (u, v) = (inputs.span(s.row_u), inputs.span(s.row_v));
    let bu = fill(inputs.windows, u, inputs.ts[s.row_u], planes);
    let bv = fill(inputs.windows, v, inputs.ts[s.row_v], planes);
    let mut jet = Jet::<R>::default();
    for i in 0..=u.degree {
        let mut line = [V4::default(); 3];
        for j in 0..=v.degree {
            let h = control(inputs, s, i, j);
            for b in 0..3 {
                line[b] = line[b] + h * bv[b][j as usize];
            }
        }
        for a in 0..3 {
            for b in 0..3 - a {
                jet[a][b] = jet[a][b] + line[b] * bu[a][i as usize];
            }
        }
    }
    jet
}
