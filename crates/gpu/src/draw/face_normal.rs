//! Twin of `face_normal.wgsl`, for the tests: drawing shaders have no double precision of their own.

use super::face_batch::FaceData;
use crate::kernels::bezier::{Cell, tangents_at};
use crate::kernels::normal::unit_normal;
use glam::Vec3;

/// Below this square of the sine and of the ratio of the tangents' lengths a normal is rounding to a
/// hundredth.
const POLE: f32 = 1e-8;

/// The span among `count` from record `first`, and the place in it.
fn place_of(places: &[[f32; 2]], first: u32, count: u32, at: f32) -> (u32, f32) {
    let spans = &places[first as usize..(first + count) as usize];
    let low = spans[1..].partition_point(|span| span[0] <= at);
    let [start, inverse] = spans[low];
    (low as u32, ((at - start) * inverse).clamp(0.0, 1.0))
}

/// At a place of the face's square by its NURBS parameters; zero where there is none.
pub(crate) fn face_normal(face: &FaceData, places: &[[f32; 2]], net: &[[f32; 4]], spot: [f32; 2]) -> Vec3 {
    let [p, q] = [face.degrees & 0xff, face.degrees >> 8];
    let [(u, t_u), (v, t_v)] =
        [0, 1].map(|axis| place_of(places, face.spans[axis], face.counts[axis], spot[axis]));
    let at = face.net + (u * face.cells_v + v) * (p + 1) * (q + 1);
    let tangents = tangents_at(net, &Cell { at: at as usize, p, q, t: [t_u, t_v] });
    Vec3::from(unit_normal(&tangents, POLE).0) * face.turn
}
