//! How edges become polylines, by name.
//!
//! The default spreads as few chords as the curve and its faces allow ([`crate::edges`]). The others go the way of Balázs, Guthe,
//! Klein 2004, sections 4 and 5.1: the trimming curve in the plane of parameters becomes Bézier pieces that are cut at the
//! knot lines of the surface, lifted into space and approximated there; or, as in the method that the document
//! compares with (Kahlesz, Balázs, Klein 2001), approximated in the plane, leaf by leaf of a quadtree. What the
//! pipeline yields are parameters on the one shared edge. Every chord is then proven against the model's own curve as
//! any other, so a file whose curves in the plane are loose costs chords and not the promise.

#[cfg(test)]
mod budget_tests;
mod curve;
mod in_plane;
mod in_space;
mod loops;
mod simplify;
mod untangle;

pub use loops::{LoopRow, loop_rows};

use crate::edges::EdgeUse;
use crate::prove::TURN_LENGTH;
use crate::strategy::Cut;
use crate::strategy::trace::Trace;
use chordal_nurbs::{ChordCriterion, ChordCut, Curve, CurveInverter, DVec3, Range};
use curve::TrimmingCurve;

/// The share of the tolerance that curves get where the rest is left to simplification; γ of the document.
pub(crate) const CURVE_SHARE: f64 = 0.75;

/// How edges become polylines.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum EdgeMethod {
    /// As few chords as the curve and its faces allow, evenly spread in that measure.
    #[default]
    Default,
    /// Trimming curves approximated in the plane of parameters, over each leaf of a quadtree by what the leaf stretches lengths.
    Bezier2d,
    /// Trimming curves lifted into space and approximated there.
    Bezier3d {
        criterion: Criterion,
        cut: Cut,
        /// Leave out vertices along the whole curve that a quarter of the tolerance does not need.
        simplified: bool,
    },
}

/// How far a curve in space is said to be from its chord.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Criterion {
    /// By points at equal parameters.
    Point,
    /// By the chord as a line.
    Line,
}

/// An edge method as the command line and the documents know it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EdgeMethodEntry {
    pub method: EdgeMethod,
    pub name: &'static str,
    /// One line of help.
    pub summary: &'static str,
}

const fn lifted(
    criterion: Criterion,
    cut: Cut,
    simplified: bool,
    name: &'static str,
    summary: &'static str,
) -> EdgeMethodEntry {
    EdgeMethodEntry { method: EdgeMethod::Bezier3d { criterion, cut, simplified }, name, summary }
}

static ENTRIES: &[EdgeMethodEntry] = &[
    EdgeMethodEntry {
        method: EdgeMethod::Default,
        name: "default",
        summary: "as few chords as the curve and its faces allow",
    },
    EdgeMethodEntry {
        method: EdgeMethod::Bezier2d,
        name: "bezier2d",
        summary: "Bézier curves in the plane of parameters, leaf by leaf of a quadtree",
    },
    lifted(
        Criterion::Line,
        Cut::Midpoint,
        true,
        "bezier3d",
        "lifted Bézier curves halved by their distance to lines, then simplified",
    ),
    lifted(
        Criterion::Line,
        Cut::Midpoint,
        false,
        "bezier3d-line",
        "lifted Bézier curves halved by their distance to lines",
    ),
    lifted(
        Criterion::Point,
        Cut::Midpoint,
        false,
        "bezier3d-point",
        "lifted Bézier curves halved by their distance to points",
    ),
    lifted(
        Criterion::Line,
        Cut::WorstPoint,
        true,
        "bezier3d-worst",
        "lifted Bézier curves cut at control points, lines, then simplified",
    ),
    lifted(
        Criterion::Line,
        Cut::WorstPoint,
        false,
        "bezier3d-worst-line",
        "lifted Bézier curves cut at control points by their distance to lines",
    ),
    lifted(
        Criterion::Point,
        Cut::WorstPoint,
        false,
        "bezier3d-worst-point",
        "lifted Bézier curves cut at control points by their distance to points",
    ),
];

impl EdgeMethod {
    /// Every edge method with its name.
    pub fn entries() -> &'static [EdgeMethodEntry] {
        ENTRIES
    }

    /// The name on the command line and in reports.
    pub fn name(self) -> &'static str {
        ENTRIES.iter().find(|e| e.method == self).map_or("unnamed", |e| e.name)
    }

    /// The edge method of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        ENTRIES.iter().find(|e| e.name == name).map(|e| e.method)
    }

    /// Parameters of the edge from one end of `range` to the other; `None` where the default has to do it.
    pub(crate) fn parameters(
        self,
        curve: &Curve,
        whole: Range,
        range: Range,
        uses: &[EdgeUse<'_, '_>],
        tolerance: f64,
        trace: &mut Trace,
    ) -> Option<Vec<f64>> {
        let edge = EdgePiece { curve, whole, range, tolerance };
        let found = match self {
            EdgeMethod::Default => None,
            EdgeMethod::Bezier2d => edge.in_plane(uses, trace),
            EdgeMethod::Bezier3d { criterion, cut, simplified } => {
                edge.in_space(uses, (criterion, cut, simplified), trace)
            }
        }?;
        Some(edge.without_specks(increasing(found, range)))
    }
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

/// A piece of an edge without corners.
pub(crate) struct EdgePiece<'a> {
    pub curve: &'a Curve,
    /// The range of the edge.
    pub whole: Range,
    pub range: Range,
    pub tolerance: f64,
}

impl EdgePiece<'_> {
    /// The curve lifted from the face whose curve in the plane is known best.
    fn in_space(
        &self,
        uses: &[EdgeUse<'_, '_>],
        how: (Criterion, Cut, bool),
        trace: &mut Trace,
    ) -> Option<Vec<f64>> {
        let lifted = best_first(uses).into_iter().find_map(|one| {
            let curve = TrimmingCurve::new(self, one)?;
            let pieces = in_space::lifted(&curve)?;
            trace.add(curve.source.name(), 1);
            Some(pieces)
        });
        let pieces = match lifted {
            Some(pieces) => pieces,
            None => {
                let own = in_space::own(self)?;
                trace.add("edges by their own curves", 1);
                own
            }
        };
        trace.add("lifted Bézier pieces", pieces.len());
        let polyline = in_space::polyline(&pieces, self.tolerance, how)?;
        trace.add("vertices left out by simplification", polyline.left_out);
        Some(self.parameters_of(&polyline.points, &polyline.guesses))
    }

    /// Where every face that uses the edge wants a vertex.
    fn in_plane(&self, uses: &[EdgeUse<'_, '_>], trace: &mut Trace) -> Option<Vec<f64>> {
        let mut all = Vec::new();
        // Where a side of the surface is one point, leaves stretch lengths without limit: such faces follow the edge's others.
        for one in uses.iter().filter(|one| one.surface.poles.is_empty()) {
            let Some(curve) = TrimmingCurve::new(self, one) else { continue };
            let stops = in_plane::stops(&curve, self.tolerance)?;
            trace.add(curve.source.name(), 1);
            trace.add("chords in planes of parameters", stops.points.len().saturating_sub(1));
            all.extend(self.parameters_of(&stops.points, &stops.guesses));
        }
        // Two faces rarely want the same vertices; what they both want nearly is one.
        (!all.is_empty()).then(|| without_slivers(increasing(all, self.range)))
    }

    /// Without vertices nearer to the one before, or to the end, than a tenth of the tolerance: parameters of points so near
    /// to each other are not told apart safely on the faces.
    fn without_specks(&self, stops: Vec<f64>) -> Vec<f64> {
        let least = TURN_LENGTH * self.tolerance;
        let end = self.curve.point(self.range.end);
        let mut kept = vec![self.range.start];
        let mut last = self.curve.point(self.range.start);
        let inner = stops.len() - 1;
        for &t in &stops[1..inner] {
            let p = self.curve.point(t);
            if p.distance(last) > least && p.distance(end) > least {
                kept.push(t);
                last = p;
            }
        }
        kept.push(self.range.end);
        kept
    }

    /// Parameters on the edge's own curve of points that lie on it but for what the file is loose by.
    fn parameters_of(&self, points: &[DVec3], guesses: &[f64]) -> Vec<f64> {
        let inverter = CurveInverter::new(self.curve, self.range);
        points
            .iter()
            .zip(guesses)
            .map(|(&p, &guess)| {
                let near = self.curve.point(guess);
                // A guess that is right needs no search.
                if near.distance(p) <= 1e-6 * self.tolerance {
                    guess
                } else {
                    inverter.invert(p, Some(guess)).t
                }
            })
            .collect()
    }
}

/// Uses with a curve of the file first, spline surfaces before others: what is lifted should be the file's own.
fn best_first<'u, 'a, 's>(uses: &'u [EdgeUse<'a, 's>]) -> Vec<&'u EdgeUse<'a, 's>> {
    let mut sorted: Vec<&EdgeUse<'_, '_>> = uses.iter().collect();
    sorted.sort_by_key(|one| {
        let is_spline = matches!(one.surface.surface, chordal_nurbs::Surface::Nurbs(_));
        (!(is_spline && one.pcurve.is_some()), !is_spline)
    });
    sorted
}

/// Parameters nearer together than this share of the range are one.
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

/// A chord shorter than this share of itself and the next one is left out.
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
    fn names_and_methods_are_one_to_one() {
        for (i, e) in ENTRIES.iter().enumerate() {
            assert_eq!(EdgeMethod::from_name(e.name), Some(e.method));
            assert_eq!(e.method.name(), e.name);
            assert!(ENTRIES[..i].iter().all(|o| o.method != e.method && o.name != e.name));
        }
        assert_eq!(EdgeMethod::from_name("nonsense"), None);
    }

    #[test]
    fn parameters_increase_from_end_to_end() {
        let range = Range::new(1.0, 3.0);
        assert_eq!(increasing(vec![2.0, 0.5, 2.0, 1.0, 3.5, 1.5], range), [1.0, 1.5, 2.0, 3.0]);
        assert_eq!(without_slivers(vec![0.0, 0.001, 0.5, 0.501, 0.8, 0.999, 1.0]), [0.0, 0.501, 0.8, 1.0]);
    }
}
