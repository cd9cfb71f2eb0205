//! Twin of `find_spans.wgsl`: the knot span of every parameter value by bisection, and the place within it.

use crate::layout::{Direction, Row};
use crate::real::Real;

pub(crate) fn find_spans<R: Real>(
    directions: &[Direction],
    breaks: &[R],
    parameters: &[R],
    rows: &mut [Row],
    ts: &mut [R],
) {
    for ((row, &t), place) in rows.iter_mut().zip(parameters).zip(ts) {
        let direction = directions[row.window as usize];
        let at = |i: u32| breaks[(direction.breaks + i) as usize];
        let (mut low, mut high) = (0, direction.count);
        while high - low > 1 {
            let middle = (low + high) / 2;
            if at(middle) <= t {
                low = middle;
            } else {
                high = middle;
            }
        }
        let (start, end) = (at(low), at(low + 1));
        row.span = direction.span + low;
        let inside = (t - start) / (end - start);
        *place = if inside < R::zero() { R::zero() } else { inside };
        *place = if *place > R::one() { R::one() } else { *place };
    }
}
