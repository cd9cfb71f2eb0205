//! The area of a mesh: Ma and Hewitt 2002 name it as one of the things that a tessellation is made for.

use chordal_mesh::Scene;

/// The area of all triangles that were made of exact faces, as placed, in square millimetres.
///
/// Facets are chords: the area of a curved surface is a little larger than that of facets with their corners on it.
pub fn area(scene: &Scene) -> f64 {
    scene
        .placements()
        .iter()
        .flat_map(|placed| {
            let mesh = &scene.parts[placed.part].mesh;
            let points: Vec<_> = mesh.positions.iter().map(|&p| placed.world.transform_point3(p)).collect();
            mesh.faces.iter().map(move |face| {
                let corner = |c: u32| points[face.corners[c as usize].position as usize];
                face.triangles
                    .iter()
                    .map(|t| {
                        let [a, b, c] = t.map(corner);
                        0.5 * (b - a).cross(c - a).length()
                    })
                    .sum::<f64>()
            })
        })
        .sum()
}
