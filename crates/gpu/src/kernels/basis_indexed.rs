//! Twin of `basis_indexed.wgsl`: the knots stay with the spans, the parameters in a list.

use super::basis_pass::{PassRow, pass};
use super::vector::V1;
use crate::layout::{Params, Row, Span};
use crate::real::Real;

pub(crate) fn basis_indexed<R: Real>(
    params: Params,
    rows: &[Row],
    spans: &[Span],
    windows: &[R],
    ts: &[R],
    basis: &mut [R],
) {
    let windows: &[V1<R>] = bytemuck::cast_slice(windows);
    let rows = rows.iter().zip(ts).map(|(row, &t)| {
        let span = spans[row.span as usize];
        PassRow {
            degree: span.degree as usize,
            t: V1([t]),
            window: &windows[span.window as usize + 1..],
            basis: row.basis as usize,
            step: row.step as usize,
        }
    });
    pass(params, rows, bytemuck::cast_slice_mut(basis));
}
