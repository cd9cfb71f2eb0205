//! The model's edges: where on its curve each sample of an edge lies, and lines as fine as a view needs.

use chordal_brep::{Edge, Part};
use chordal_mesh::PartMesh;
use chordal_nurbs::{Curve, DVec3};
use std::collections::BTreeMap;

/// Of every pair of neighbouring samples of an edge, by the indices of their positions (lower first): the
/// edge, and the number of the lower-numbered sample of the two.
#[derive(Debug)]
pub(crate) struct EdgeParameters<'a> {
    part: &'a Part,
    mesh: &'a PartMesh,
    spans: BTreeMap<[u32; 2], (usize, usize)>,
    parameters: Vec<Option<Vec<f64>>>,
}

impl<'a> EdgeParameters<'a> {
    pub fn new(part: &'a Part, mesh: &'a PartMesh) -> Self {
        let mut spans = BTreeMap::new();
        for (e, line) in mesh.edges.iter().enumerate() {
            for (k, pair) in line.windows(2).enumerate() {
                spans.insert([pair[0].min(pair[1]), pair[0].max(pair[1])], (e, k));
            }
        }
        let parameters =
            mesh.edges.iter().zip(&part.edges).map(|(line, edge)| parameters(edge, line, mesh)).collect();
        Self { part, mesh, spans, parameters }
    }

    /// The derivatives of the edge between two neighbouring samples, by a parameter that runs over 0..=1 from
    /// the first to the second; `None` where they are no neighbours on an edge with a curve.
    pub fn derivatives(&self, from: u32, to: u32) -> Option<[DVec3; 2]> {
        let &(edge, k) = self.spans.get(&[from.min(to), from.max(to)])?;
        let ts = self.parameters[edge].as_ref()?;
        let curve = self.part.edges[edge].curve.as_ref()?;
        let length = ts[k + 1] - ts[k];
        // From within: at a kink both sides have a derivative of their own.
        let inset = 1e-6 * length;
        let [low, high] = [ts[k] + inset, ts[k + 1] - inset].map(|t| curve.jet(t).d1 * length);
        // Of a closed edge of two samples the same pair stands for both ways round.
        Some(if self.mesh.edges[edge][k] == from { [low, high] } else { [-high, -low] })
    }
}

/// The curve's parameters at the samples; `None` where a sample is not on it.
fn parameters(edge: &Edge, line: &[u32], mesh: &PartMesh) -> Option<Vec<f64>> {
    let curve = edge.curve.as_ref()?;
    let points: Vec<DVec3> = line.iter().map(|&i| mesh.positions[i as usize]).collect();
    let count = points.len();
    if count < 2 {
        return None;
    }
    let mut along = vec![0.0];
    for pair in points.windows(2) {
        along.push(along[along.len() - 1] + pair[0].distance(pair[1]));
    }
    let total = along[count - 1];
    let range = edge.range;
    let mut ts = vec![range.start];
    for k in 1..count - 1 {
        let guess = range.start + range.length() * (along[k] / total);
        let t = nearest(curve, points[k], guess, ts[k - 1], range.end);
        if !(t > ts[k - 1]) || curve.point(t).distance(points[k]) > 1e-5 * total {
            return None;
        }
        ts.push(t);
    }
    ts.push(range.end);
    Some(ts)
}

/// The parameter of the point of the curve nearest to `p` near `guess`, by Newton's method between `low` and
/// `high`.
fn nearest(curve: &Curve, p: DVec3, guess: f64, low: f64, high: f64) -> f64 {
    let mut t = guess;
    for _ in 0..16 {
        let jet = curve.jet(t);
        let offset = jet.p - p;
        let slope = jet.d1.length_squared() + offset.dot(jet.d2);
        let speed = jet.d1.length_squared();
        let step = offset.dot(jet.d1) / if slope > 0.1 * speed { slope } else { speed };
        if !step.is_finite() {
            return t;
        }
        let next = (t - step).clamp(low, high);
        if (next - t).abs() <= 1e-14 * (high - low) {
            return next;
        }
        t = next;
    }
    t
}

/// The edges that faces use as lines whose distance from the curve is about `error`, in the part's units.
pub(crate) fn edge_lines(part: &Part, mesh: &PartMesh, error: f64) -> Vec<[DVec3; 2]> {
    let mut found = Vec::new();
    for (edge, samples) in part.edges.iter().zip(&mesh.edges) {
        let Some(curve) = edge.curve.as_ref().filter(|_| samples.len() > 1) else { continue };
        let mut cuts = vec![edge.range.start];
        cuts.extend(curve.breaks(edge.range));
        cuts.push(edge.range.end);
        for pair in cuts.windows(2) {
            let length = pair[1] - pair[0];
            let bend = (0..=8).map(|k| curve.jet(pair[0] + length * f64::from(k) / 8.0).d2.length());
            let bend = bend.fold(0.0, f64::max);
            let count = (length * (bend / (8.0 * error)).sqrt()).ceil().clamp(1.0, 4096.0);
            let at = |k: f64| curve.point(pair[0] + length * (k / count));
            found.extend((0..count as u32).map(|k| [at(f64::from(k)), at(f64::from(k) + 1.0)]));
        }
    }
    found
}
