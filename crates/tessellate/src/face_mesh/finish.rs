//! The result of a face: its triangles, its gap, and its share of the lower bound.

use super::{FaceMesh, Shape};
use crate::face_result::{FaceResult, Proof};
use crate::limits::{Bound, Limits};
use crate::metric::Sizing;
use crate::quads::pairs;
use crate::shared_edge::{SharedEdge, is_shareable, sorted};
use crate::triangulate::NONE;
use chordal_chart::{Key, Segment};
use chordal_nurbs::{DVec2, Surface, UvBox};

/// c of the lower bound where the Gaussian curvature is positive: 2/(3√3), from the largest triangle in a
/// circle.
const ELLIPTIC: f64 = 0.3849;

/// c where it is negative: √5/10, from the largest triangle between two asymptotic directions.
const HYPERBOLIC: f64 = 0.2236;

/// Samples along the curved direction of a singly curved face, for the number of its strips.
const STRIP_SAMPLES: usize = 16;

impl FaceMesh<'_, '_> {
    /// The edges inside the face that another face may have too.
    fn inner_edges(&self, keys: &[Key]) -> Vec<SharedEdge> {
        let collapsed = |corners: [u32; 3]| {
            let [a, b, c] = corners.map(|v| keys[v as usize]);
            a == b || b == c || c == a
        };
        let mut inner = Vec::new();
        for (t, (corners, neighbors)) in self.mesh.triangles.iter().zip(&self.mesh.neighbors).enumerate() {
            for i in (0..3).filter(|&i| neighbors[i] != NONE && neighbors[i] as usize > t) {
                let pair = [corners[(i + 1) % 3], corners[(i + 2) % 3]].map(|v| keys[v as usize]);
                // A triangle that is not written counts as boundary.
                let both = !collapsed(*corners) && !collapsed(self.mesh.triangles[neighbors[i] as usize]);
                if is_shareable(pair) && both {
                    inner.push(sorted(pair));
                }
            }
        }
        inner
    }

    /// Assembles the result.
    pub(crate) fn finish(mut self, proof: Proof, bound: Bound, keep_quads: bool) -> FaceResult {
        let gap = self.gap();
        let curvature_bound = self.curvature_bound();
        let mut keys: Vec<Key> = (0..self.mesh.points.len() as u32).map(|v| self.key(v)).collect();
        let mut private = self.chart.private.clone();
        private.extend_from_slice(&self.vertices.xyz[self.chart.points.len()..]);
        let reversed = self.face().normal_reversed() != self.chart.reversed;
        let keep = |t: &&[u32; 3]| {
            let [a, b, c] = t.map(|v| keys[v as usize]);
            a != b && b != c && c != a
        };
        let triangles = self
            .mesh
            .triangles
            .iter()
            .filter(keep)
            .map(|&[a, b, c]| if reversed { [a, c, b] } else { [a, b, c] });
        let mut triangles: Vec<[u32; 3]> = triangles.collect();
        let quads = if keep_quads { pairs_first(&self.quads, &mut triangles) } else { 0 };
        let inner = self.inner_edges(&keys);
        let gap = gap.max(self.separate_pole_corners(&mut triangles, &mut keys));
        let mut boundary_error = 0.0f64;
        for point in &self.chart.points {
            if let Segment::Edge { edge, chord } = point.segment {
                boundary_error = boundary_error.max(self.edge_samples(edge).sag[chord as usize]);
            }
        }
        let proven = bound == Bound::Proven && proof.error.is_finite();
        let proven_error = if proven { proof.error.max(boundary_error) } else { f64::NAN };
        let sign = if reversed { -1.0 } else { 1.0 };
        FaceResult {
            given_up: None,
            normals: self.vertices.normals.iter().map(|n| *n * sign).collect(),
            uv: self.mesh.points,
            keys,
            triangles,
            inner,
            crossed: false,
            turned: false,
            quads,
            doubtful: self.chart.reversed,
            private,
            proven_error,
            boundary_error,
            gap,
            bound: proof.bound,
            curvature_bound,
            trace: self.trace,
            phases: self.phases,
            cells: self.cells,
            mended: None,
        }
    }

    /// The gap: the largest distance from the surface of a boundary vertex, or of the edge half way along a
    /// chord.
    fn gap(&self) -> f64 {
        let mut gap = 0.0f64;
        for (i, point) in self.chart.points.iter().enumerate() {
            gap = gap.max(self.position(point.key).distance(self.vertices.xyz[i]));
            let Segment::Edge { edge, chord } = point.segment else { continue };
            let samples = self.edge_samples(edge);
            let Some(curve) = self.part().edges[edge as usize].curve.as_deref() else { continue };
            let exact = matches!(self.surface().surface, Surface::Plane { .. })
                && matches!(curve, chordal_nurbs::Curve::Line { .. });
            if !exact {
                let p = curve.point(0.5 * (samples.t[chord as usize] + samples.t[chord as usize + 1]));
                let next = self.next_on_boundary(i);
                let middle = point.uv.midpoint(self.chart.points[next].uv);
                let uv = self.surface().descend(p, middle);
                gap = gap.max(self.surface().point(uv).distance(p));
            }
        }
        gap
    }

    fn next_on_boundary(&self, i: usize) -> usize {
        let at = i as u32;
        let runs_to = self.chart.loops.iter().find(|&&(start, end)| (start..end).contains(&at));
        match runs_to {
            Some(&(start, end)) if at + 1 == end => start as usize,
            _ => i + 1,
        }
    }

    /// The lower bound by curvature: c·∫√|K| dA / ε over the triangles (`docs/report.md`), or the strips of a
    /// singly curved face.
    fn curvature_bound(&self) -> f64 {
        let limits = Limits { angle: f64::INFINITY, length: f64::INFINITY, ..*self.limits };
        match self.shape {
            Shape::Flat => 0.0,
            Shape::Singly { axis } => {
                let bounds = UvBox::from_points(self.mesh.points.iter().copied());
                let mut d = DVec2::ZERO;
                d[axis] = bounds.size()[axis] / STRIP_SAMPLES as f64;
                let start = {
                    let mut s = bounds.center();
                    s[axis] = bounds.min[axis];
                    s
                };
                let strips: f64 = (0..STRIP_SAMPLES)
                    .map(|k| {
                        let jet = self.surface().jet(start + d * (k as f64 + 0.5));
                        Sizing::new(&jet, &limits).map_or(0.0, |s| s.metric.length(d))
                    })
                    .sum();
                2.0 * (strips - 1e-9).ceil().max(1.0)
            }
            Shape::Doubly => self
                .mesh
                .triangles
                .iter()
                .map(|t| {
                    let [a, b, c] = t.map(|v| self.mesh.points[v as usize]);
                    let jet = self.surface().jet((a + b + c) / 3.0);
                    let area = 0.5 * (b - a).perp_dot(c - a).abs();
                    Sizing::new(&jet, &limits).map_or(0.0, |s| {
                        let constant = if s.gauss > 0.0 { ELLIPTIC } else { HYPERBOLIC };
                        constant * s.gauss.abs().sqrt() * s.area * area / self.limits.tolerance
                    })
                })
                .sum(),
        }
    }
}

/// Moves the halves of complete quadrilaterals to the front, in pairs; returns their number.
fn pairs_first(quads: &[[u32; 4]], triangles: &mut Vec<[u32; 3]>) -> usize {
    let pairs = pairs(quads, triangles);
    let mut order: Vec<usize> = pairs.iter().flatten().copied().collect();
    let mut rest = vec![true; triangles.len()];
    order.iter().for_each(|&t| rest[t] = false);
    order.extend((0..triangles.len()).filter(|&t| rest[t]));
    *triangles = order.into_iter().map(|t| triangles[t]).collect();
    pairs.len()
}
