//! Twin of `basis_packed.wgsl`: four parameter values at a time, lane by lane.

use super::basis_pass::{PassRow, pass};
use super::vector::V4;
use crate::layout::{Params, Row};
use crate::real::Real;

pub(crate) fn basis_packed<R: Real>(params: Params, packs: &[Row], windows: &[R], basis: &mut [R]) {
    let windows: &[V4<R>] = bytemuck::cast_slice(windows);
    let rows = packs.iter().map(|pack| PassRow {
        degree: pack.span as usize,
        t: windows[pack.window as usize],
        window: &windows[pack.window as usize + 1..],
        basis: pack.basis as usize,
        step: pack.step as usize,
    });
    pass(params, rows, bytemuck::cast_slice_mut(basis));
}
