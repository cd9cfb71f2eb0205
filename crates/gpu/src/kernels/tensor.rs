//! Twin of `tensor.wgsl`: sums control points times basis functions that passes have left in a buffer.

use super::normal::tangents_of;
use super::samples::Sample;
use super::samples::{Inputs, Jet};
use super::vector::V4;
use crate::real::Real;

fn function_of<R: Real>(inputs: &Inputs<R>, row: usize, degree: u32, plane: u32, column: u32) -> R {
    if degree == 0 {
        return R::from_u32(u32::from(plane == 0));
    }
    let (row, half) = (inputs.rows[row], if degree % 2 == 1 { inputs.params.half } else { 0 });
    inputs.basis[(half + row.basis + (plane * (degree + 1) + column) * row.step) as usize]
}

pub(crate) fn points<R: Real>(inputs: &Inputs<R>, out: &mut [R]) {
    for s in inputs.samples() {
        let (p, q) = (inputs.span(s.row_u).degree, inputs.span(s.row_v).degree);
        let mut sum = V4::default();
        for i in 0..=p {
            let mut line = V4::default();
            for j in 0..=q {
                line = line + control(inputs, &s, i, j) * function_of(inputs, s.row_v, q, 0, j);
            }
            sum = sum + line * function_of(inputs, s.row_u, p, 0, i);
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
    let (p, q) = (inputs.span(s.row_u).degree, inputs.span(s.row_v).degree);
    let mut jet = Jet::<R>::default();
    for i in 0..=p {
        let mut line = [V4::default(); 3];
        for j in 0..=q {
            let h = control(inputs, s, i, j);
            for b in 0..planes {
                line[b] = line[b] + h * function_of(inputs, s.row_v, q, b as u32, j);
            }
        }
        for a in 0..planes {
            for b in 0..planes - a {
                jet[a][b] = jet[a][b] + line[b] * function_of(inputs, s.row_u, p, a as u32, i);
            }
        }
    }
    jet
}

/// Control point (i, j) of the spans of a sample.
pub(crate) fn control<R: Real>(inputs: &Inputs<R>, s: &Sample, i: u32, j: u32) -> V4<R> {
    let (u, v) = (inputs.span(s.row_u).first + i, inputs.span(s.row_v).first + j);
    inputs.point((s.head.net + u * s.head.stride + v) as usize)
}
