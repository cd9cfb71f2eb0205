//! How far a facet is off its surface, estimated where nothing is to be proven.

use crate::face_mesh::FaceMesh;
use chordal_nurbs::{Facet, FacetBound};

/// The largest distance at the middle and along the edges: an estimate, below the truth.
pub(super) fn sampled_bound(face: &FaceMesh<'_, '_>, facet: &Facet) -> FacetBound {
    let [a, b, c] = facet.xyz;
    let Some(n) = (b - a).cross(c - a).try_normalize() else {
        return FacetBound { error: 0.0, edges: [0.0; 3] };
    };
    let at = |weights: [f64; 3]| {
        let uv = facet.uv[0] * weights[0] + facet.uv[1] * weights[1] + facet.uv[2] * weights[2];
        face.surface().point(uv)
    };
    let edges = std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let (p, q) = (facet.xyz[j], facet.xyz[k]);
        let d = q - p;
        [0.25, 0.5, 0.75].iter().fold(0.0f64, |m, &t| {
            let mut weights = [0.0; 3];
            weights[j] = 1.0 - t;
            weights[k] = t;
            let x = at(weights) - p;
            let along = (x.dot(d) / d.length_squared().max(1e-300)).clamp(0.0, 1.0);
            m.max((x - d * along).length())
        })
    });
    let inside = [[1.0 / 3.0; 3], [0.6, 0.2, 0.2], [0.2, 0.6, 0.2], [0.2, 0.2, 0.6]];
    let error = inside.iter().fold(0.0f64, |m, &w| m.max((at(w) - a).dot(n).abs()));
    FacetBound { error: error.max(edges[0]).max(edges[1]).max(edges[2]), edges }
}
