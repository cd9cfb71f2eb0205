//! Twin of `normal.wgsl`: from homogeneous derivatives to the point, its tangents and the normal between
//! them.

use super::vector::{V3, V4};
use crate::real::Real;

/// A point and its first derivatives by the parameters of the span.
#[derive(Clone, Copy)]
pub(crate) struct Tangents<R> {
    pub p: V3<R>,
    pub du: V3<R>,
    pub dv: V3<R>,
}

pub(crate) fn tangents_of<R: Real>(h00: V4<R>, h10: V4<R>, h01: V4<R>) -> Tangents<R> {
    let by_w = R::one() / h00.w();
    let p = h00.xyz() * by_w;
    Tangents { p, du: (h10.xyz() - p * h10.w()) * by_w, dv: (h01.xyz() - p * h01.w()) * by_w }
}

/// The unit vector along du × dv; zero where its square is less than `least` of the longer one's fourth
/// power.
pub(crate) fn unit_normal<R: Real>(t: &Tangents<R>, least: R) -> V3<R> {
    let (V3([ux, uy, uz]), V3([vx, vy, vz])) = (t.du, t.dv);
    let n = V3([uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx]);
    let squared = n.0[0] * n.0[0] + n.0[1] * n.0[1] + n.0[2] * n.0[2];
    let du = ux * ux + uy * uy + uz * uz;
    let dv = vx * vx + vy * vy + vz * vz;
    let longest = if du > dv { du } else { dv };
    if squared > least * longest * longest { n * (R::one() / squared.square_root()) } else { V3::default() }
}
