//! The parts that methods of cutting edges are made of.
//!
//! Source: Balázs, Guthe, Klein 2004, sections 4 and 5.1: the trimming curve in the plane of parameters
//! becomes Bézier pieces that are cut at the knot lines of the surface, lifted into space and approximated
//! there; or, as in the method that the paper compares with (Kahlesz, Balázs, Klein 2001), approximated in
//! the plane, leaf by leaf of a quadtree. What comes out are parameters on the one shared edge. Every chord
//! is then proven against the model's own curve as any other, so a file whose curves in the plane are loose
//! costs chords and not the tolerance.

#[cfg(test)]
mod budget_tests;
pub mod curve;
pub mod in_plane;
pub mod in_space;
pub mod simplify;
pub mod untangle;

use crate::fill::Cut;
use chordal_nurbs::{ChordCriterion, ChordCut, CurveInverter, DVec3, Range};
use chordal_tessellate::Trace;
use chordal_tessellate::method::{EdgePiece, EdgeUse, TURN_LENGTH};
use curve::TrimmingCurve;

/// The share of the tolerance for the approximation of curves where simplification uses the rest; γ of the
/// document.
pub(crate) const CURVE_SHARE: f64 = 0.75;

/// How the distance between a curve in space and its chord is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Criterion {
    /// Between points at equal parameters.
    Point,
    /// From the points of the curve to the line of the chord.
    Line,
}

impl Criterion {
    fn of_curves(self) -> ChordCriterion {
        match self {
            Criterion::Point => ChordCriterion::Point,
            Criterion::Line => ChordCriterion::Line,
        }
    }
}

impl Cut {
    fn of_curves(self) -> ChordCut {
        match self {
            Cut::Midpoint => ChordCut::Midpoint,
            Cut::WorstPoint => ChordCut::WorstPoint,
        }
    }
}

/// Increasing parameters of vertices, far enough apart to be distinct on the faces.
pub fn vertices(edge: &EdgePiece<'_>, found: Vec<f64>) -> Vec<f64> {
    without_specks(edge, increasing(found, edge.range))
}

/// The curve lifted from the face whose parameter curve is known best.
pub fn in_space(
    edge: &EdgePiece<'_>,
    uses: &[EdgeUse<'_, '_>],
    how: (Criterion, Cut, bool),
    trace: &mut Trace,
) -> Option<Vec<f64>> {
    let lifted = best_first(uses).into_iter().find_map(|one| {
        let curve = TrimmingCurve::new(edge, one)?;
        let pieces = in_space::lifted(&curve)?;
        trace.add(curve.source.name(), 1);
        Some(pieces)
    });
    let pieces = match lifted {
        Some(pieces) => pieces,
        None => {
            let own = in_space::own(edge)?;
            trace.add("edges by their own curves", 1);
            own
        }
    };
    trace.add("lifted Bézier pieces", pieces.len());
    let polyline = in_space::polyline(&pieces, edge.tolerance, how)?;
    trace.add("vertices left out by simplification", polyline.left_out);
    Some(parameters_of(edge, &polyline.points, &polyline.guesses))
}

/// Vertices where any face that uses the edge needs one.
pub fn in_plane(edge: &EdgePiece<'_>, uses: &[EdgeUse<'_, '_>], trace: &mut Trace) -> Option<Vec<f64>> {
    let mut all = Vec::new();
    // At a pole, leaves stretch lengths without limit: such a face follows the other faces of the edge.
    for one in uses.iter().filter(|one| one.surface.poles.is_empty()) {
        let Some(curve) = TrimmingCurve::new(edge, one) else { continue };
        let stops = in_plane::stops(&curve, edge.tolerance)?;
        trace.add(curve.source.name(), 1);
        trace.add("chords in planes of parameters", stops.points.len().saturating_sub(1));
        all.extend(parameters_of(edge, &stops.points, &stops.guesses));
    }
    // Two faces rarely need the same vertices; two vertices that nearly coincide become one.
    (!all.is_empty()).then(|| without_slivers(increasing(all, edge.range)))
}

/// Drops vertices nearer to the one before, or to the end, than a tenth of the tolerance: such points are not
/// safely distinct on the faces.
fn without_specks(edge: &EdgePiece<'_>, stops: Vec<f64>) -> Vec<f64> {
    let least = TURN_LENGTH * edge.tolerance;
    let end = edge.curve.point(edge.range.end);
    let mut kept = vec![edge.range.start];
    let mut last = edge.curve.point(edge.range.start);
    let inner = stops.len() - 1;
    for &t in &stops[1..inner] {
        let p = edge.curve.point(t);
        if p.distance(last) > least && p.distance(end) > least {
            kept.push(t);
            last = p;
        }
    }
    kept.push(edge.range.end);
    kept
}

/// Parameters on the edge's own curve of points that lie on it, up to the inaccuracy of the file.
fn parameters_of(edge: &EdgePiece<'_>, points: &[DVec3], guesses: &[f64]) -> Vec<f64> {
    let inverter = CurveInverter::new(edge.curve, edge.range);
    points
        .iter()
        .zip(guesses)
        .map(|(&p, &guess)| {
            let near = edge.curve.point(guess);
            // A guess that is right needs no search.
            if near.distance(p) <= 1e-6 * edge.tolerance { guess } else { inverter.invert(p, Some(guess)).t }
        })
        .collect()
}

/// The uses, sorted: those with a parameter curve in the file first, spline surfaces before others, so that
/// what is lifted is the curve of the file.
fn best_first<'u, 'a, 's>(uses: &'u [EdgeUse<'a, 's>]) -> Vec<&'u EdgeUse<'a, 's>> {
    let mut sorted: Vec<&EdgeUse<'_, '_>> = uses.iter().collect();
    sorted.sort_by_key(|one| {
        let is_spline = matches!(one.surface.surface, chordal_nurbs::Surface::Nurbs(_));
        (!(is_spline && one.pcurve.is_some()), !is_spline)
    });
    sorted
}

/// Parameters that differ by less than this share of the range are one: rounding.
const SAME_PARAMETER: f64 = 1e-7;

/// Sorted, with the ends of the range and without repetitions.
fn increasing(mut found: Vec<f64>, range: Range) -> Vec<f64> {
    let least = SAME_PARAMETER * range.length();
    found.retain(|t| *t > range.start + least && *t < range.end - least);
    found.sort_unstable_by(f64::total_cmp);
    let mut kept = vec![range.start];
    for t in found {
        if t - kept[kept.len() - 1] > least {
            kept.push(t);
        }
    }
    kept.push(range.end);
    kept
}

/// A chord shorter than this share of its length plus that of the next chord is merged with its neighbour:
/// two faces have nearly the same vertex there.
const SLIVER: f64 = 0.05;

fn without_slivers(stops: Vec<f64>) -> Vec<f64> {
    let mut kept = vec![stops[0]];
    for pair in stops[1..].windows(2) {
        let last = kept[kept.len() - 1];
        if pair[0] - last > SLIVER * (pair[1] - last) && pair[1] - pair[0] > SLIVER * (pair[1] - last) {
            kept.push(pair[0]);
        }
    }
    kept.push(stops[stops.len() - 1]);
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parameters_increase_from_end_to_end() {
        let range = Range::new(1.0, 3.0);
        assert_eq!(increasing(vec![2.0, 0.5, 2.0, 1.0, 3.5, 1.5], range), [1.0, 1.5, 2.0, 3.0]);
        assert_eq!(without_slivers(vec![0.0, 0.001, 0.5, 0.501, 0.8, 0.999, 1.0]), [0.0, 0.501, 0.8, 1.0]);
    }
}
