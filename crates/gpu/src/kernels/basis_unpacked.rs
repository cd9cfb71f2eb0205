//! Twin of `basis_unpacked.wgsl`: every row carries a copy of its parameter and its knots.

use super::basis_indexed::pass;
use crate::Real;
use crate::layout::{Params, Row, Span};

pub(crate) fn basis_unpacked<R: Real>(
    params: Params,
    rows: &[Row],
    spans: &[Span],
    windows: &[R],
    basis: &mut [R],
) {
    let knots = |_: usize, row: Row| (windows[row.window as usize], &windows[row.window as usize + 1..]);
    pass(params, rows, spans, knots, basis);
}
