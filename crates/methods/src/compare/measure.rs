//! How far a mesh lies from its surfaces, measured.
//!
//! Samples lie inside the triangles of the plane of parameters: between a trimming curve and its chord there
//! may be surface that is not the face's. A sample that its own triangle does not come near may be covered by
//! another one.

use chordal_audit::TriangleTree;
use chordal_brep::{FaceGeometry, Part};
use chordal_mesh::{FaceMesh, PartMesh};
use chordal_nurbs::{DVec3, Surface, Wrap};
use rayon::prelude::*;

/// Samples of a triangle: its middle, points beside the middles of its sides, and points towards its corners.
const WEIGHTS: [[f64; 3]; 7] = [
    [1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0],
    [0.45, 0.45, 0.1],
    [0.1, 0.45, 0.45],
    [0.45, 0.1, 0.45],
    [0.6, 0.2, 0.2],
    [0.2, 0.6, 0.2],
    [0.2, 0.2, 0.6],
];

/// The largest distance of samples of the surfaces from the mesh of a part, in the part's units.
pub fn largest_deviation(part: &Part, mesh: &PartMesh) -> f64 {
    let corners =
        |face: &FaceMesh, t: &[u32; 3]| t.map(|c| mesh.positions[face.corners[c as usize].position as usize]);
    let triangles = mesh.faces.iter().flat_map(|f| f.triangles.iter().map(move |t| corners(f, t)));
    let tree = TriangleTree::new(triangles.collect());
    mesh.faces
        .par_iter()
        .map(|face| match part.faces.get(face.face as usize).map(|f| &f.geometry) {
            Some(FaceGeometry::Surface(surface)) => deviation(surface, face, mesh, &tree),
            _ => 0.0,
        })
        .reduce(|| 0.0, f64::max)
}

fn deviation(surface: &Surface, face: &FaceMesh, mesh: &PartMesh, tree: &TriangleTree) -> f64 {
    let wrap = Wrap::of(surface);
    face.triangles.iter().fold(0.0, |largest, triangle| {
        let corners = triangle.map(|c| face.corners[c as usize]);
        let xyz = corners.map(|c| mesh.positions[c.position as usize]);
        WEIGHTS.iter().fold(largest, |largest: f64, w| {
            let uv = corners[0].uv * w[0] + corners[1].uv * w[1] + corners[2].uv * w[2];
            let p = wrap.point(surface, uv);
            let own = distance(p, xyz);
            if own.is_finite() && own > largest { largest.max(tree.distance(p, own)) } else { largest }
        })
    })
}

/// The distance of a point from a triangle.
fn distance(p: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    let n = (b - a).cross(c - a);
    let sides = [(a, b), (b, c), (c, a)];
    if n != DVec3::ZERO && sides.iter().all(|&(a, b)| (b - a).cross(p - a).dot(n) >= 0.0) {
        return (p - a).dot(n.normalize()).abs();
    }
    sides.iter().fold(f64::INFINITY, |nearest, &(a, b)| {
        let d = b - a;
        let t = ((p - a).dot(d) / d.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        nearest.min(p.distance(a + d * t))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distance_to_a_triangle_by_region() {
        let t = [DVec3::ZERO, DVec3::X * 2.0, DVec3::Y * 2.0];
        for (p, d) in [
            (DVec3::new(0.5, 0.5, 3.0), 3.0),
            (DVec3::new(-3.0, 1.0, 4.0), 5.0),
            (DVec3::new(5.0, 0.0, 0.0), 3.0),
            (DVec3::new(2.0, 2.0, 0.0), 2f64.sqrt()),
        ] {
            assert!((distance(p, t) - d).abs() < 1e-12, "{p}");
        }
    }
}
