//! Twin of `basis_packed.wgsl`: four parameter values at a time, lane by lane.

use super::basis_indexed::quotient;
use super::vector::lanes;
use crate::Real;
use crate::layout::{Params, Row};

pub(crate) fn basis_packed<R: Real>(params: Params, packs: &[Row], windows: &[[R; 4]], basis: &mut [[R; 4]]) {
    let (level, planes) = (params.level as usize, params.planes as usize);
    let half = params.half as usize;
    for pack in packs {
        let degree = pack.span as usize;
        if level > degree {
            continue;
        }
        let lower = |basis: &[[R; 4]], plane: usize, column: usize| match (column > degree, level) {
            (true, _) => [R::zero(); 4],
            (_, 1) => [R::from_u32(u32::from(plane == 0 && column == degree)); 4],
            _ => {
                let from = if level.is_multiple_of(2) { half } else { 0 };
                basis[from + pack.basis as usize + plane * (degree + 1) + column]
            }
        };
        let t = windows[pack.window as usize];
        let to_half = if level % 2 == 1 { half } else { 0 };
        for column in 0..=degree {
            let knot = |c: usize| windows[pack.window as usize + 1 + column + c];
            let minus = |a: [R; 4], b: [R; 4]| lanes(a, b, |a, b| a - b);
            let times = |a: [R; 4], b: [R; 4]| lanes(a, b, |a, b| a * b);
            let (left, right) = (minus(knot(level), knot(0)), minus(knot(level + 1), knot(1)));
            let a = lanes(minus(t, knot(0)), left, quotient);
            let b = lanes(minus(knot(level + 1), t), right, quotient);
            let at = to_half + pack.basis as usize + column;
            let (low, high) = (lower(basis, 0, column), lower(basis, 0, column + 1));
            basis[at] = lanes(times(a, low), times(b, high), |a, b| a + b);
            for order in 1..planes {
                if order + level <= degree {
                    continue;
                }
                let plane = if order + level == degree + 1 { 0 } else { order };
                let slope_a = lanes(lower(basis, plane, column), left, quotient);
                let slope_b = lanes(lower(basis, plane, column + 1), right, quotient);
                let by = R::from_u32(params.level);
                basis[at + order * (degree + 1)] = minus(slope_a, slope_b).map(|x| x * by);
            }
        }
    }
}
