//! Twin of `basis_pass.wgsl`: one pass of the paper's recursion (Krishnamurthy et al. 2009, section 4).

use crate::layout::Params;
use crate::real::Real;
use bytemuck::Pod;
use std::ops::{Add, Mul, Sub};

/// What one row holds in one column: a number, or four rows lane by lane.
pub(crate) trait Value<R>:
    Pod + Add<Output = Self> + Sub<Output = Self> + Mul<R, Output = Self>
{
    fn splat(value: R) -> Self;
    /// The product, in each lane by itself.
    fn times(self, other: Self) -> Self;
    /// 0/0 of repeated knots is 0, in each lane by itself.
    fn quotient(self, by: Self) -> Self;
}

/// A row as a pass sees it: its knots begin with the first of the window.
pub(crate) struct PassRow<'a, V> {
    pub degree: usize,
    pub t: V,
    pub window: &'a [V],
    /// Where its functions begin, and how far apart they lie.
    pub basis: usize,
    pub step: usize,
}

/// One pass over all rows.
pub(crate) fn pass<'a, R: Real, V: Value<R> + 'a>(
    params: Params,
    rows: impl Iterator<Item = PassRow<'a, V>>,
    basis: &mut [V],
) {
    let (level, planes) = (params.level as usize, params.planes as usize);
    for PassRow { degree, t, window, basis: first, step } in rows {
        if level > degree {
            continue;
        }
        let lower = |basis: &[V], plane: usize, column: usize| match (column > degree, level) {
            (true, _) => V::splat(R::zero()),
            (_, 1) => V::splat(R::from_u32(u32::from(plane == 0 && column == degree))),
            _ => {
                let half = if level.is_multiple_of(2) { params.half as usize } else { 0 };
                basis[half + first + (plane * (degree + 1) + column) * step]
            }
        };
        let to_half = if level % 2 == 1 { params.half as usize } else { 0 };
        for column in 0..=degree {
            let left = window[column + level] - window[column];
            let right = window[column + level + 1] - window[column + 1];
            let at = to_half + first + column * step;
            let a = (t - window[column]).quotient(left);
            let b = (window[column + level + 1] - t).quotient(right);
            basis[at] = a.times(lower(basis, 0, column)) + b.times(lower(basis, 0, column + 1));
            for order in 1..planes {
                if order + level <= degree {
                    continue;
                }
                let plane = if order + level == degree + 1 { 0 } else { order };
                let slope_a = lower(basis, plane, column).quotient(left);
                let slope_b = lower(basis, plane, column + 1).quotient(right);
                basis[at + order * (degree + 1) * step] = (slope_a - slope_b) * R::from_u32(params.level);
            }
        }
    }
}
