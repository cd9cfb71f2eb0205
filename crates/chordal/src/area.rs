//! The area of a mesh: Ma and Hewitt 2002 name it as one of the things that a tessellation is made for.

use chordal_mesh::{FaceMesh, Scene};
use glam::DVec3;

/// The area of all triangles that were made of exact faces, as placed, in square millimetres.
///
/// Facets are chords: the area of a curved surface is a little larger than that of facets with their corners
/// on it.
pub fn area(scene: &Scene) -> f64 {
    scene
        .placements()
        .iter()
        .flat_map(|placed| {
            let mesh = &scene.parts[placed.part].mesh;
            let points: Vec<_> = mesh.positions.iter().map(|&p| placed.world.transform_point3(p)).collect();
            mesh.faces.iter().map(move |face| face_area(face, &points))
        })
        .sum()
}

/// The area of a face's triangles, in the square of the unit of `points`.
pub(crate) fn face_area(face: &FaceMesh, points: &[DVec3]) -> f64 {
    let corner = |c: u32| points[face.corners[c as usize].position as usize];
    let doubled = |t: &[u32; 3]| {
        let [a, b, c] = t.map(corner);
        (b - a).cross(c - a).length()
    };
    0.5 * face.triangles.iter().map(doubled).sum::<f64>()
}
