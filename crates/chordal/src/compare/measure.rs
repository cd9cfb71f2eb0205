//! How far a mesh lies from its surfaces, measured.

use chordal_brep::{FaceGeometry, Part};
use chordal_mesh::{FaceMesh, PartMesh};
use chordal_nurbs::{DVec3, Surface, Wrap};
use rayon::prelude::*;

/// Samples of a triangle: its middle, the middles of its sides, and points between.
const WEIGHTS: [[f64; 3]; 10] = [
    [1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0],
    [0.5, 0.5, 0.0],
    [0.0, 0.5, 0.5],
    [0.5, 0.0, 0.5],
    [0.6, 0.2, 0.2],
    [0.2, 0.6, 0.2],
    [0.2, 0.2, 0.6],
    [0.4, 0.4, 0.2],
    [0.2, 0.4, 0.4],
    [0.4, 0.2, 0.4],
];

/// The largest distance, over samples of every triangle's piece of the surface, from that triangle; in the part's units.
pub(super) fn largest_deviation(part: &Part, mesh: &PartMesh) -> f64 {
    mesh.faces
        .par_iter()
        .map(|face| match part.faces.get(face.face as usize).map(|f| &f.geometry) {
            Some(FaceGeometry::Surface(surface)) => deviation(surface, face, mesh),
            _ => 0.0,
        })
        .reduce(|| 0.0, f64::max)
}

fn deviation(surface: &Surface, face: &FaceMesh, mesh: &PartMesh) -> f64 {
    let wrap = Wrap::of(surface);
    face.triangles.iter().fold(0.0, |largest, triangle| {
        let corners = triangle.map(|c| face.corners[c as usize]);
        let xyz = corners.map(|c| mesh.positions[c.position as usize]);
        WEIGHTS.iter().fold(largest, |largest: f64, w| {
            let uv = corners[0].uv * w[0] + corners[1].uv * w[1] + corners[2].uv * w[2];
            let d = distance(wrap.point(surface, uv), xyz);
            if d.is_finite() { largest.max(d) } else { largest }
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
