//! Sums over a tensor-product net and the quotient rule, shared by B-spline surfaces and Bézier patches.

use crate::basis::Basis;
use crate::homogeneous::Homogeneous;
use crate::{Vector, work};
use glam::DVec3;

/// Derivatives `[by u][by v]` of total order below `R` (at most 3); the others are left zero.
///
/// `points` and `weights` are the whole net, `stride` the number of points along v. Sums are taken relative
/// to the first control point concerned: derivatives then keep their digits far from the origin.
#[inline]
pub(crate) fn derivatives<const R: usize>(
    bu: &Basis<R>,
    bv: &Basis<R>,
    stride: usize,
    points: &[DVec3],
    weights: Option<&[f64]>,
) -> [[DVec3; R]; R] {
    work::count(work::products(bu.row(0).len() * bv.row(0).len()));
    let origin = points[bu.first * stride + bv.first];
    let mut jet = match weights {
        None => sum(bu, bv, stride, |k| points[k] - origin),
        Some(weights) => project(sum(bu, bv, stride, |k| Homogeneous::new(points[k] - origin, weights[k]))),
    };
    jet[0][0] += origin;
    jet
}

/// Sums `point(index)` times the products of the two bases.
#[inline(always)]
fn sum<T: Vector, const R: usize>(
    bu: &Basis<R>,
    bv: &Basis<R>,
    stride: usize,
    point: impl Fn(usize) -> T,
) -> [[T; R]; R] {
    let rows_u: [&[f64]; R] = std::array::from_fn(|k| bu.row(k));
    let rows_v: [&[f64]; R] = std::array::from_fn(|k| bv.row(k));
    let mut jet = [[T::default(); R]; R];
    for i in 0..rows_u[0].len() {
        let start = (bu.first + i) * stride + bv.first;
        let mut row = [T::default(); R];
        for j in 0..rows_v[0].len() {
            let p = point(start + j);
            for k in 0..R {
                row[k] += p * rows_v[k][j];
            }
        }
        for a in 0..R {
            for b in 0..R - a {
                jet[a][b] += row[b] * rows_u[a][i];
            }
        }
    }
    jet
}

/// Turns derivatives of a homogeneous surface into those of its projection.
#[inline]
fn project<const R: usize>(h: [[Homogeneous<DVec3>; R]; R]) -> [[DVec3; R]; R] {
    const BINOMIAL: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 2.0, 1.0]];
    let inverse = 1.0 / h[0][0].w;
    let mut jet = [[DVec3::ZERO; R]; R];
    for a in 0..R {
        for b in 0..R - a {
            let mut sum = h[a][b].v;
            for i in 0..=a {
                for j in 0..=b {
                    if i + j > 0 {
                        sum -= jet[a - i][b - j] * (BINOMIAL[a][i] * BINOMIAL[b][j] * h[i][j].w);
                    }
                }
            }
            jet[a][b] = sum * inverse;
        }
    }
    jet
}
