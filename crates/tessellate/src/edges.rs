//! Sampling of edges: every edge becomes one polyline, for its own curve and for all faces that use it.
//!
//! 1. Cut the edge at corners of its curve, at poles and at creases of its faces.
//! 2. Along each piece, integrate the chords per unit of parameter that curve and faces need.
//! 3. Spread that many chords evenly in this measure, and check each one by a proven bound.
//! 4. Halve chords over which a face turns too far.
//!
//! Faces never add vertices on edges on their own. What they find out later comes back as a request
//! ([`split_chords`]).

mod corners;
mod probes;
mod turns;

use self::corners::{passed_over, smooth_pieces};
use self::probes::Probes;
use self::turns::{turning_less, turning_less_between};
use crate::budget::Budget;
use crate::edge_use::{EdgePiece, EdgeSplitter, EdgeUse};
use crate::limits::Limits;
use crate::trace::Trace;
use chordal_brep::{Edge, MeshIssue, Part};
use chordal_chart::{EdgeSamples, Near};
use chordal_nurbs::{Curve, CurveInverter, DVec2, DVec3, Range, bisect};

/// One edge as a polyline, with what its sampling found out.
#[derive(Clone, Debug, Default)]
pub(crate) struct SampledEdge {
    pub samples: EdgeSamples,
    /// The fewest chords that the tolerance allows by the curvature of the curve alone. The lower bound of
    /// the number of triangles needs it.
    pub fewest: f64,
    /// Which parts of an edge method ran.
    pub trace: Trace,
    /// The requested edge method gave the edge up, and the default made chords of it.
    pub method_gave_up: bool,
}

/// The chords of an edge while they are made.
#[derive(Default)]
struct Chords {
    /// The parameters of their ends.
    t: Vec<f64>,
    fewest: f64,
    trace: Trace,
    /// The edge method gave a piece up.
    method_gave_up: bool,
    /// The edge needs more chords, or more time, than one edge may take.
    given_up: bool,
}

/// Chords use this share of the tolerance. The bound of a facet over a chord is a little larger than the
/// bound of the chord itself; with the whole tolerance, such facets would request finer edges.
const CHORD_AIM: f64 = 0.985;

/// A chord without a finite bound is halved this often. Shorter chords mostly have one; where these have
/// none, no shorter one will, and halving on would not end.
const UNBOUNDED_ROUNDS: usize = 4;

/// Chords of a closed edge: fewer enclose nothing.
const LEAST_OF_CLOSED: usize = 3;

/// A total that is this little over a whole number is that number: rounding.
const WHOLE: f64 = 1e-9;

/// How often all chords of a piece are made shorter before single ones are halved, and the most by which they
/// are made shorter at once. Even chords are fewer than halved ones.
const EVEN_ROUNDS: usize = 8;
const MOST_FINER: f64 = 4.0;

/// How often single chords are halved: a limit for curves that never converge.
const HALVINGS: usize = 24;

/// The most chords of an edge. Edges of sound files need thousands; one with a control point at 1e10 needs
/// more than fit into memory. The faces of an edge that needs more fail.
const MOST_CHORDS: usize = 200_000;

/// An edge is given up if this many chords are expected after the first even rounds, when their bounds have
/// become tight: it would reach [`MOST_CHORDS`] and use most of its time.
const HOPELESS: f64 = 16.0 * MOST_CHORDS as f64;
const FIRST_ROUNDS: usize = 2;

/// The clock is read once in this many chords: the bound of a chord on an offset surface takes up to a
/// millisecond.
const CHORDS_PER_LOOK: usize = 32;

/// One edge while it is sampled: its curve, the faces that use it, and the limits.
struct Sampling<'e, 'a, 's> {
    curve: &'e Curve,
    /// The range of the edge.
    range: Range,
    uses: &'e [EdgeUse<'a, 's>],
    /// Limits of the edge's own chords.
    limits: Limits,
    /// Limits by which the faces need chords.
    of_faces: Limits,
    /// When the edge is given up.
    budget: Budget,
}

impl Sampling<'_, '_, '_> {
    /// True if this number of chords, or their time, exceeds the limit.
    fn is_spent(&self, chords: usize) -> bool {
        chords > MOST_CHORDS || self.budget.is_over()
    }

    /// The largest error of the chords between these parameters, and how many chords errors that shrink with
    /// the square of the length let expect; none where the budget is spent.
    fn worst(&self, t: &[f64]) -> Option<(f64, f64)> {
        let (mut worst, mut expected) = (0.0f64, 0.0);
        for (k, pair) in t.windows(2).enumerate() {
            if k % CHORDS_PER_LOOK == 0 && self.is_spent(t.len()) {
                return None;
            }
            let error = self.curve.chord_error(pair[0], pair[1]);
            worst = worst.max(error);
            expected += (error / self.limits.tolerance).max(1.0).sqrt();
        }
        Some((worst, expected))
    }
}

impl SampledEdge {
    /// Samples an edge with at least `least` chords.
    ///
    /// # Errors
    /// Where the edge needs more chords, or more time, than one edge may take.
    pub fn new(
        part: &Part,
        edge: &Edge,
        uses: &[EdgeUse<'_, '_>],
        limits: &Limits,
        splitter: Option<&dyn EdgeSplitter>,
        least: usize,
        budget: Budget,
    ) -> Result<Self, MeshIssue> {
        let ends = [edge.start, edge.end].map(|v| part.vertices[v.index()].point);
        let Some(curve) = edge.curve.as_deref() else {
            let samples = EdgeSamples { t: vec![edge.range.start], points: vec![ends[0]], sag: Vec::new() };
            return Ok(Self { samples, ..Self::default() });
        };
        let sampling = Sampling {
            curve,
            range: edge.range,
            uses,
            limits: Limits { tolerance: CHORD_AIM * limits.boundary, ..*limits },
            // Faces need chords as short as their facets do, but never shorter than the tolerance of the edge
            // needs.
            of_faces: Limits { tolerance: CHORD_AIM * limits.largest(), ..*limits },
            budget,
        };
        let mut chords = Chords { t: vec![edge.range.start], ..Chords::default() };
        // 1. Pieces between corners, poles and creases.
        let mut stops = sampling.poles_on_the_way();
        stops.extend(sampling.crease_crossings());
        let mut pieces = smooth_pieces(curve, edge.range, &stops);
        if splitter.is_none() {
            pieces = passed_over(pieces, &sampling);
        }
        // 2. to 4. The chords of each piece.
        for range in pieces.into_iter().map(|piece| piece.range) {
            let piece = EdgePiece { curve, whole: edge.range, range, tolerance: sampling.limits.tolerance };
            match splitter.and_then(|s| s.parameters(&piece, uses, &mut chords.trace)) {
                Some(t) => chords.add_given(t, &sampling, range),
                None => {
                    chords.method_gave_up |= splitter.is_some();
                    chords.add_smooth(&sampling, range);
                }
            }
            if chords.given_up || sampling.is_spent(chords.t.len()) {
                return Err(MeshIssue::EdgeGivenUp);
            }
        }
        let least = if edge.start == edge.end { least.max(LEAST_OF_CLOSED) } else { least };
        while chords.t.len() < least + 1 {
            chords.t = halved(&chords.t);
        }
        let Chords { t, fewest, trace, method_gave_up, .. } = chords;
        Ok(Self { samples: measured(t, curve, ends), fewest, trace, method_gave_up })
    }
}

/// Positions and bounds of the chords between these parameters; `ends` are the vertices of the part.
fn measured(t: Vec<f64>, curve: &Curve, ends: [DVec3; 2]) -> EdgeSamples {
    let sag = t.windows(2).map(|t| curve.chord_error(t[0], t[1])).collect();
    let mut points: Vec<DVec3> = t.iter().map(|&t| curve.point(t)).collect();
    points[0] = ends[0];
    if let Some(last) = points.last_mut() {
        *last = ends[1];
    }
    EdgeSamples { t, points, sag }
}

/// Cuts the named chords of an edge, which are in order, into this many parts.
pub(crate) fn split_chords(samples: &mut EdgeSamples, edge: &Edge, chords: &[u32], parts: u32) {
    let Some(curve) = edge.curve.as_deref() else { return };
    let ends = [samples.points[0], samples.points[samples.points.len() - 1]];
    let mut t = vec![samples.t[0]];
    for (k, pair) in samples.t.windows(2).enumerate() {
        if chords.binary_search(&(k as u32)).is_ok() {
            let at = |i: u32| pair[0] + (pair[1] - pair[0]) * f64::from(i) / f64::from(parts);
            t.extend((1..parts).map(at));
        }
        t.push(pair[1]);
    }
    *samples = measured(t, curve, ends);
}

impl Chords {
    /// Appends the chords of a piece without corners.
    fn add_smooth(&mut self, sampling: &Sampling<'_, '_, '_>, range: Range) {
        let probes = Probes::new(sampling, range);
        self.fewest += probes.fewest();
        let allowed = sampling.limits.tolerance;
        let mut count = (probes.total() - WHOLE).ceil().max(1.0) as usize;
        for round in 0..EVEN_ROUNDS {
            if sampling.is_spent(count) {
                self.given_up = true;
                return;
            }
            let t = probes.spread(count);
            let Some((worst, expected)) = sampling.worst(&t) else {
                self.given_up = true;
                return;
            };
            // Some curves, such as those on offsets of free surfaces, have no finite bound however short the
            // chords are.
            if worst.is_infinite() {
                break;
            }
            if worst <= allowed {
                self.t.extend_from_slice(&turning_less(t, sampling, range)[1..]);
                return;
            }
            if round >= FIRST_ROUNDS && expected > HOPELESS {
                self.given_up = true;
                return;
            }
            let factor = (worst / allowed).sqrt().clamp(1.0, MOST_FINER);
            count = ((count as f64 * factor).ceil() as usize).max(count + 1);
        }
        if sampling.is_spent(count) {
            self.given_up = true;
            return;
        }
        // The curve is less even than the probes showed: halve the chords that are still too far off.
        self.add_halved(probes.spread(count), sampling, range);
    }

    /// Appends the chords that an edge method made of a piece without corners. Those too far off the curve
    /// are halved.
    fn add_given(&mut self, t: Vec<f64>, sampling: &Sampling<'_, '_, '_>, range: Range) {
        self.fewest += Probes::new(sampling, range).fewest();
        let made = t.len();
        let before = self.t.len();
        let t = turning_less_between(t, sampling, range);
        self.add_halved(t, sampling, range);
        if self.given_up {
            return;
        }
        self.trace.add("chords halved for the edge or a face's turn", self.t.len() - before - (made - 1));
    }

    fn add_halved(&mut self, mut t: Vec<f64>, sampling: &Sampling<'_, '_, '_>, range: Range) {
        for round in 0..HALVINGS {
            let before = t.len();
            let mut judged = 0;
            t = split_where(&t, |a, b| {
                judged += 1;
                self.given_up |= judged % CHORDS_PER_LOOK == 0 && sampling.is_spent(before);
                if self.given_up {
                    return false;
                }
                let error = sampling.curve.chord_error(a, b);
                error > sampling.limits.tolerance && (error.is_finite() || round < UNBOUNDED_ROUNDS)
            });
            if self.given_up || t.len() == before || t.len() > MOST_CHORDS {
                break;
            }
        }
        if sampling.is_spent(t.len()) {
            self.given_up = true;
            return;
        }
        self.t.extend_from_slice(&turning_less(t, sampling, range)[1..]);
    }
}

fn split_where(t: &[f64], mut too_far: impl FnMut(f64, f64) -> bool) -> Vec<f64> {
    let mut fine = vec![t[0]];
    for pair in t.windows(2) {
        if too_far(pair[0], pair[1]) {
            fine.push(0.5 * (pair[0] + pair[1]));
        }
        fine.push(pair[1]);
    }
    fine
}

fn halved(t: &[f64]) -> Vec<f64> {
    split_where(t, |_, _| true)
}

/// Samples along an edge to find its crossings with a crease. Two crossings between neighbouring samples are
/// missed; then a chord passes over the crease, and the proof requests a finer one.
const CROSSING_SAMPLES: usize = 64;

/// Samples nearer to a crease than this multiple of the rounding of its position lie on it. Rounding puts
/// them on either side, which is no crossing.
const ALONG_CREASE: f64 = 1e4;

/// Halvings of the interval in which a crossing lies: as many as a double has bits.
const BISECTIONS: u32 = 52;

impl Sampling<'_, '_, '_> {
    /// Parameters at which the curve runs through a pole of a surface. Charts jump there, so there must be a
    /// vertex.
    fn poles_on_the_way(&self) -> Vec<f64> {
        let Self { curve, range, uses, .. } = *self;
        let mut found = Vec::new();
        if uses.iter().all(|one| one.surface.poles.is_empty()) {
            return found;
        }
        let reach = curve.loose_box(range);
        for EdgeUse { surface, .. } in uses {
            let at_end = |p: DVec3| {
                [range.start, range.end].iter().any(|&t| curve.point(t).distance(p) <= surface.resolution)
            };
            for pole in surface.poles.iter().filter(|pole| !at_end(pole.point)) {
                if pole.point.clamp(reach.min, reach.max).distance(pole.point) > surface.resolution {
                    continue;
                }
                let nearest = CurveInverter::new(curve, range).invert(pole.point, None);
                if nearest.distance <= surface.resolution {
                    found.push(nearest.t);
                }
            }
        }
        found
    }

    /// Parameters at which the edge crosses creases of its faces: there must be a vertex.
    fn crease_crossings(&self) -> Vec<f64> {
        let Self { curve, range, uses, .. } = *self;
        let mut found = Vec::new();
        for one in uses.iter().filter(|u| u.surface.creases.iter().any(|c| !c.is_empty())) {
            let at = |i: usize| range.start + range.length() * i as f64 / CROSSING_SAMPLES as f64;
            let mut places: Vec<Near> = Vec::with_capacity(CROSSING_SAMPLES + 1);
            for i in 0..=CROSSING_SAMPLES {
                places.push(one.parameters(curve.point(at(i)), at(i), range, places.last().copied()));
            }
            for (axis, creases) in one.surface.creases.iter().enumerate() {
                for &value in creases {
                    let off = |p: DVec2| one.surface.offset_from(axis, value, p);
                    // Rounding puts the samples of an edge along the crease on either side of it.
                    let rounding = ALONG_CREASE * one.surface.surface.beside_crease(axis, value);
                    for i in 0..CROSSING_SAMPLES {
                        let (a, b) = (off(places[i].uv), off(places[i + 1].uv));
                        let far = one.surface.periods[axis].is_some_and(|p| (a - b).abs() > 0.5 * p);
                        if (a < 0.0) != (b < 0.0) && !far && a.abs().max(b.abs()) > rounding {
                            let side =
                                |t: f64| off(one.parameters(curve.point(t), t, range, Some(places[i])).uv);
                            found.push(bisect(side, at(i), at(i + 1), BISECTIONS));
                        }
                    }
                }
            }
        }
        found
    }
}
