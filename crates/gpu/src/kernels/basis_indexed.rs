//! Twin of `basis_indexed.wgsl`: one pass of the paper's recursion (Krishnamurthy et al. 2009, section 4, indexed knots).

use crate::Real;
use crate::layout::{Params, Row, Span};

/// One pass over all rows; `knots` gives, for row number and row, its parameter and its knots.
pub(crate) fn pass<'a, R: Real>(
    params: Params,
    rows: &[Row],
    spans: &[Span],
    knots: impl Fn(usize, Row) -> (R, &'a [R]),
    basis: &mut [R],
) {
    let (level, planes) = (params.level as usize, params.planes as usize);
    for (index, &row) in rows.iter().enumerate() {
        let degree = spans[row.span as usize].degree as usize;
        if level > degree {
            continue;
        }
        let (t, window) = knots(index, row);
        let lower = |basis: &[R], plane: usize, column: usize| match (column > degree, level) {
            (true, _) => R::zero(),
            (_, 1) => R::from_u32(u32::from(plane == 0 && column == degree)),
            _ => {
                let half = if level.is_multiple_of(2) { params.half as usize } else { 0 };
                basis[half + row.basis as usize + (plane * (degree + 1) + column) * row.step as usize]
            }
        };
        let to_half = if level % 2 == 1 { params.half as usize } else { 0 };
        for column in 0..=degree {
            let left = window[column + level] - window[column];
            let right = window[column + level + 1] - window[column + 1];
            let at = to_half + row.basis as usize + column * row.step as usize;
            let a = quotient(t - window[column], left);
            let b = quotient(window[column + level + 1] - t, right);
            basis[at] = a * lower(basis, 0, column) + b * lower(basis, 0, column + 1);
            for order in 1..planes {
                if order + level <= degree {
                    continue;
                }
                let plane = if order + level == degree + 1 { 0 } else { order };
                let slope_a = quotient(lower(basis, plane, column), left);
                let slope_b = quotient(lower(basis, plane, column + 1), right);
                let to = at + order * (degree + 1) * row.step as usize;
                basis[to] = R::from_u32(params.level) * (slope_a - slope_b);
            }
        }
    }
}

/// 0/0 of repeated knots is 0.
pub(crate) fn quotient<R: Real>(a: R, b: R) -> R {
    if b == R::zero() { R::zero() } else { a / b }
}

/// The knots stay with the spans, the parameters in a list.
pub(crate) fn basis_indexed<R: Real>(
    params: Params,
    rows: &[Row],
    spans: &[Span],
    windows: &[R],
    ts: &[R],
    basis: &mut [R],
) {
    let knots =
        |index: usize, row: Row| (ts[index], &windows[spans[row.span as usize].window as usize + 1..]);
    pass(params, rows, spans, knots, basis);
}
