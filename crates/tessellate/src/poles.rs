//! Triangles at poles: edges are flipped until every triangle has an area.
//!
//! A pole is a side of the chart that is one point of space, and one corner for every triangle that touches
//! it. A triangle between the pole and two vertices one above the other lies in a meridian and covers
//! nothing:
//!
//! ```text
//!   ══════════p══      p is the whole line; p–a–b is flat in space. The edge to b, the farther one,
//!   a╌╌╌╌╌╱╱  │        is flipped to a–r, and p–a–r spans what the line does.
//!   │   ╱ ╱   │
//!   b╌╌╌╌╱╌╌╌╌r
//! ```

use crate::face_mesh::FaceMesh;
use crate::triangulate::NONE;
use chordal_nurbs::orient;

/// Flips edges at poles until every triangle there spans a part of the pole's line in the right direction, as
/// far as possible. Borders of cells that end in the pole are flipped as well, since all places of its line
/// are one vertex. Returns the number of flips.
pub fn open_out(face: &mut FaceMesh<'_, '_>) -> usize {
    if !face.touches_pole() {
        return 0;
    }
    let mut flips = 0;
    let mut queue: Vec<u32> = (0..face.mesh().triangles.len() as u32).collect();
    let most = 8 * queue.len();
    while let Some(t) = queue.pop() {
        if flips < most
            && let Some(i) = flat_at_pole(face, t)
            && let Some(other) = flippable(face, t, i)
        {
            face.mesh_mut().flip_edge(t, i);
            flips += 1;
            // An edge that could not be flipped before may have a better neighbour now.
            for t in [t, other] {
                queue.push(t);
                queue.extend(face.mesh().neighbors[t as usize].iter().filter(|&&n| n != NONE));
            }
        }
    }
    face.mesh_mut().changed.clear();
    flips
}

/// The corner opposite the edge to flip, in a triangle with one corner on a pole that spans nothing, or spans
/// it in the wrong direction.
fn flat_at_pole(face: &FaceMesh<'_, '_>, t: u32) -> Option<usize> {
    let c = face.mesh().triangles[t as usize];
    let at_pole = c.map(|v| face.is_at_pole(v));
    if at_pole.iter().filter(|&&p| p).count() != 1 {
        return None;
    }
    let i = at_pole.iter().position(|&p| p)?;
    let corner = c[i];
    let pole = face.surface().pole_at(face.xyz(corner), face.context().trimmed.resolution)?;
    let along = 1 - pole.axis;
    let [a, b] = [1, 2].map(|k| face.mesh().points[c[(i + k) % 3] as usize]);
    let mut apex = face.mesh().points[corner as usize];
    apex[along] = 0.5 * (a[along] + b[along]);
    let longest = (a - b).abs().max_element().max((apex - a).abs().max_element());
    let spans = (b - a)[along].abs() > 1e-9 * longest;
    if spans && orient(apex, a, b) > 0.0 {
        return None;
    }
    let height = |p: chordal_nurbs::DVec2| (p[pole.axis] - apex[pole.axis]).abs();
    // The edge from the pole to the farther of the two lies opposite the nearer one.
    Some(if height(a) < height(b) { (i + 1) % 3 } else { (i + 2) % 3 })
}

fn flippable(face: &FaceMesh<'_, '_>, t: u32, i: usize) -> Option<u32> {
    let mesh = face.mesh();
    let c = mesh.triangles[t as usize];
    let (apex, a, b) = (c[i], c[(i + 1) % 3], c[(i + 2) % 3]);
    let other = mesh.neighbors[t as usize][i];
    if other == NONE {
        return None;
    }
    let j = (0..3).find(|&j| mesh.neighbors[other as usize][j] == t)?;
    mesh.can_flip(apex, a, b, mesh.triangles[other as usize][j]).then_some(other)
}
