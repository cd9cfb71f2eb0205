//! Grids over faces, for learning: points, normals and whether they are inside the loops, as UV-Net takes them.
//!
//! The grid spans the box of the face's triangles in its parameters. A grid point is inside where it lies in one
//! of these triangles: beside a curved loop the chords of the mesh decide, so that a finer tolerance makes a
//! finer mask. Points and normals are those of the exact surface.

use chordal::math::{DVec2, DVec3};
use chordal::nurbs::UvBox;
use chordal::{Meshed, MeshedFace};

/// Numbers per grid point: the point, the outward normal, 1 inside and 0 outside.
pub const CHANNELS: usize = 7;

/// How far outside a triangle a point may lie, as a share of the box: rounding of points on loops.
const ROUNDING: f64 = 1e-9;

/// The grids of all faces, one behind the other; zeros for faces without triangles.
pub fn all(meshed: &Meshed, first_faces: &[usize], counts: [usize; 2]) -> Vec<f64> {
    let size = counts[0] * counts[1] * CHANNELS;
    let faces = first_faces.last().copied().unwrap_or(0);
    let mut values = vec![0.0; faces * size];
    for face in meshed.faces() {
        let number = first_faces[face.part().index()] + face.id().index();
        fill(&face, counts, &mut values[number * size..(number + 1) * size]);
    }
    values
}

fn fill(face: &MeshedFace<'_>, counts: [usize; 2], values: &mut [f64]) {
    let (Some(mesh), Some(surface)) = (face.mesh(), face.surface()) else { return };
    let corners = |triangle: &[u32; 3]| triangle.map(|corner| mesh.corners[corner as usize].uv);
    let uv = UvBox::from_points(mesh.triangles.iter().flat_map(corners));
    if mesh.triangles.is_empty() || !uv.is_finite() {
        return;
    }
    let sign = if face.exact().normal_reversed() { -1.0 } else { 1.0 };
    for (index, row) in values.chunks_exact_mut(CHANNELS).enumerate() {
        let at = grid_point(uv, counts, [index / counts[1], index % counts[1]]);
        let normal = surface.normal(at).unwrap_or(DVec3::ZERO) * sign;
        row[..3].copy_from_slice(&surface.point(at).to_array());
        row[3..6].copy_from_slice(&normal.to_array());
    }
    for triangle in &mesh.triangles {
        mark(corners(triangle), uv, counts, values);
    }
}

fn grid_point(uv: UvBox, counts: [usize; 2], [i, j]: [usize; 2]) -> DVec2 {
    let share = |i: usize, count: usize| if count > 1 { i as f64 / (count - 1) as f64 } else { 0.5 };
    uv.min + uv.size() * DVec2::new(share(i, counts[0]), share(j, counts[1]))
}

/// Marks the grid points in a triangle as inside.
fn mark(triangle: [DVec2; 3], uv: UvBox, counts: [usize; 2], values: &mut [f64]) {
    // In the unit square, where both directions weigh the same.
    let size = uv.size().max(DVec2::splat(f64::MIN_POSITIVE));
    let [a, b, c] = triangle.map(|corner| (corner - uv.min) / size);
    let turn = (b - a).perp_dot(c - a).signum();
    let window = |min: f64, max: f64, count: usize| {
        let last = count.saturating_sub(1);
        let (low, high) = (min * last as f64 - 1.0, max * last as f64 + 1.0);
        (low.floor().max(0.0) as usize)..=(high.ceil().min(last as f64) as usize)
    };
    let (low, high) = (a.min(b).min(c), a.max(b).max(c));
    for i in window(low.x, high.x, counts[0]) {
        for j in window(low.y, high.y, counts[1]) {
            let p = (grid_point(uv, counts, [i, j]) - uv.min) / size;
            let beside = |from: DVec2, to: DVec2| {
                let side = to - from;
                side.perp_dot(p - from) * turn >= -ROUNDING * side.length()
            };
            if beside(a, b) && beside(b, c) && beside(c, a) {
                values[(i * counts[1] + j) * CHANNELS + CHANNELS - 1] = 1.0;
            }
        }
    }
}
