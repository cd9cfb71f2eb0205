//! A lower bound of the number of triangles on one face (`docs/report.md`). It depends on the model only, not
//! on the edges of this mesh.

use chordal_brep::{Face, Loop};
use chordal_chart::EdgeSamples;

/// The larger of the bound by curvature and V_b − 2χ, where V_b counts the vertices that the curves of the
/// edges need. `fewest`: of every edge, the fewest chords that its curve needs.
pub(crate) fn lower_bound(
    face: &Face,
    (edges, fewest): (&[EdgeSamples], &[f64]),
    closed: &[bool],
    curvature: f64,
) -> f64 {
    let mut vertices = 0.0;
    let mut components = 0usize;
    for a_loop in &face.loops {
        match a_loop {
            Loop::Vertex(_) => {}
            Loop::Polygon { vertices: polygon, .. } => {
                vertices += polygon.len() as f64;
                components += 1;
            }
            Loop::Edges { coedges, .. } => {
                // A seam occurs twice in its loop and bounds nothing; it separates the pieces of boundary
                // between its two occurrences.
                let is_seam = |i: usize| coedges.iter().filter(|c| c.edge == coedges[i].edge).count() > 1;
                let real: Vec<bool> = (0..coedges.len())
                    .map(|i| !is_seam(i) && !edges[coedges[i].edge.index()].sag.is_empty())
                    .collect();
                let n = coedges.len();
                let runs = (0..n).filter(|&i| real[i] && !real[(i + 1) % n]).count();
                components += if runs == 0 && real.contains(&true) { 1 } else { runs };
                for i in (0..n).filter(|&i| real[i]) {
                    let edge = coedges[i].edge.index();
                    let least = if closed[edge] { 3.0 } else { 1.0 };
                    vertices += fewest[edge].max(least);
                }
            }
        }
    }
    let boundary = if components == 0 { 0.0 } else { vertices + 2.0 * components as f64 - 4.0 };
    boundary.max(curvature).max(1.0)
}
