//! Twin of `basis_unpacked.wgsl`: every row carries a copy of its parameter and its knots.

use super::basis_pass::{PassRow, pass};
use super::vector::V1;
use crate::layout::{Params, Row, Span};
use crate::real::Real;

pub(crate) fn basis_unpacked<R: Real>(
    params: Params,
    rows: &[Row],
    spans: &[Span],
    windows: &[R],
    basis: &mut [R],
) {
    let windows: &[V1<R>] = bytemuck::cast_slice(windows);
    let rows = rows.iter().map(|row| PassRow {
        degree: spans[row.span as usize].degree as usize,
        t: windows[row.window as usize],
        window: &windows[row.window as usize + 1..],
        basis: row.basis as usize,
        step: row.step as usize,
    });
    pass(params, rows, bytemuck::cast_slice_mut(basis));
}
