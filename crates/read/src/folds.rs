//! Loops that run back over themselves: edges of no length, edges that coincide, closed edges folded in two.
//!
//! Purpose: a face between two edges that coincide as well as the file is accurate has no area. Its
//! neighbours must meet there, which they do when both edges are one.
//!
//! ```text
//!   v═══════════a══════w───────b────────x        the loop comes along b to v and goes back along a
//!
//!   v═══════════a══════w───────b'───────x        b is cut at w; for all faces, a replaces its first part
//! ```
//!
//! Steps, part by part:
//! 1. The ends of an edge without length become one vertex, and loops omit it.
//! 2. A closed edge that returns on its own way is cut at its far end into two, and these become one edge.
//! 3. Where a loop turns back at a vertex along the edge on which it came, the longer of the two edges is cut
//!    where the shorter one ends, and the two equal parts become one edge. A loop omits an edge that
//!    it runs there and back, unless nothing else is left of it.
//!
//! Notation: the *looseness* of an edge is how far its curve ends from its vertices.
//!
//! Not done: loops that fold at a pole of their surface, where the two ways are the two sides of a seam.

use chordal_brep::{Coedge, Edge, EdgeId, FaceGeometry, Loop, Model, Part, Pcurve, Vertex, VertexId};
use chordal_nurbs::{CurveInverter, DVec3, Range};

/// What is shorter than this part of its part's size has no length, whatever the file states: it is rounding.
const NO_LENGTH: f64 = 1e-9;

/// A stated accuracy counts as it is up to this part of the part's size: at the finest tolerance in common
/// use, 0.01 %, what is merged moves by a tenth of it.
const CREDIBLE: f64 = 1e-5;

/// Some files state more than the width of their smallest faces, or any number. Of what they state this part
/// of the part's size counts.
const ACCURACY: f64 = 1e-7;

/// Two edges coincide only where they are this many times as long as they are apart.
const SLENDER: f64 = 100.0;

/// The cosine of the angle between two edges that may coincide: narrow enough to leave out nearly all
/// corners.
const SAME_WAY: f64 = 0.99;

/// Places along an edge at which its distance to another is measured.
const SAMPLES: u32 = 16;

/// A loop that folds more often than this is left as it is.
const FOLDS: usize = 16;

/// Makes one edge of edges that coincide.
pub(crate) fn close_folds(model: &mut Model) {
    for part in &mut model.parts {
        let mut folding = Folding::new(part);
        folding.collapse_edges_without_length();
        for face in 0..folding.part.faces.len() {
            for index in 0..folding.part.faces[face].loops.len() {
                folding.fold_closed_edge(face, index);
                let _folds = (0..FOLDS).take_while(|_| folding.fold_once(face, index)).count();
            }
        }
    }
}

/// An edge as it leaves one of its vertices.
#[derive(Clone, Copy, PartialEq)]
struct Way {
    edge: EdgeId,
    /// From the edge's start to its end.
    forward: bool,
}

struct Folding<'a> {
    part: &'a mut Part,
    size: f64,
}

impl<'a> Folding<'a> {
    fn new(part: &'a mut Part) -> Self {
        let middle = |edge: &Edge| {
            let at = |share: f64| edge.range.start + edge.range.length() * share;
            let shares = [0.25, 0.5, 0.75];
            edge.curve.as_ref().map_or([DVec3::NAN; 3], |curve| shares.map(|share| curve.point(at(share))))
        };
        let vertices = part.vertices.iter().map(|v| v.point);
        let points = vertices.chain(part.edges.iter().flat_map(middle)).filter(|p| p.is_finite());
        let (low, high) =
            points.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(a, b), p| (a.min(p), b.max(p)));
        let size = (high - low).length();
        Self { part, size: if size.is_finite() { size } else { 0.0 } }
    }

    fn edge(&self, way: Way) -> &Edge {
        &self.part.edges[way.edge.index()]
    }

    /// The vertices at which a way starts and ends.
    fn ends(&self, way: Way) -> [VertexId; 2] {
        let edge = self.edge(way);
        if way.forward { [edge.start, edge.end] } else { [edge.end, edge.start] }
    }

    /// The parameter and the place at a share of a way.
    fn at(&self, way: Way, share: f64) -> Option<(f64, DVec3)> {
        let edge = self.edge(way);
        let share = if way.forward { share } else { 1.0 - share };
        let t = edge.range.start + edge.range.length() * share;
        let p = edge.curve.as_ref()?.point(t);
        p.is_finite().then_some((t, p))
    }

    fn samples(&self, way: Way) -> Option<Vec<DVec3>> {
        (0..=SAMPLES).map(|k| Some(self.at(way, f64::from(k) / f64::from(SAMPLES))?.1)).collect()
    }

    fn looseness(&self, way: Way) -> f64 {
        let ends = self.ends(way).map(|v| self.part.vertices[v.index()].point);
        let off = |share: f64, end: DVec3| self.at(way, share).map_or(0.0, |(_, p)| p.distance(end));
        off(0.0, ends[0]).max(off(1.0, ends[1]))
    }

    /// The distance below which the file does not tell places apart.
    fn accuracy(&self) -> f64 {
        let stated = self.part.uncertainty.unwrap_or(0.0);
        let is_credible = stated <= CREDIBLE * self.size;
        let counts = if is_credible { stated } else { ACCURACY * self.size };
        counts.max(NO_LENGTH * self.size)
    }

    /// How far apart two edges may lie to be one.
    fn allowed(&self, a: Way, b: Way) -> f64 {
        self.looseness(a) + self.looseness(b) + self.accuracy()
    }

    /// How long an edge is along its curve, where it is a curve.
    fn length_of(&self, edge: EdgeId) -> Option<f64> {
        let ends = |edge: &Edge| [edge.start, edge.end].map(|v| self.part.vertices[v.index()].point);
        let [a, b] = ends(&self.part.edges[edge.index()]);
        Some(length(&self.samples(Way { edge, forward: true })?).max(a.distance(b)))
    }

    /// Of every edge, whether it has no length: rounding is all there is of it, or it is within the accuracy
    /// and stands between edges that are much longer in all its loops. Of small faces with short edges
    /// something would be lost.
    fn without_length(&self) -> Vec<bool> {
        let all = 0..self.part.edges.len();
        let lengths: Vec<Option<f64>> = all.map(|i| self.length_of(EdgeId::from(i))).collect();
        let is_below = |edge: EdgeId, limit: f64| lengths[edge.index()].is_some_and(|length| length <= limit);
        let (rounding, accuracy) = (NO_LENGTH * self.size, self.accuracy());
        let mut found: Vec<bool> = (0..lengths.len()).map(|i| is_below(EdgeId::from(i), accuracy)).collect();
        if accuracy <= rounding || !found.contains(&true) {
            return found;
        }
        for boundary in self.part.faces.iter().flat_map(|face| &face.loops) {
            let Loop::Edges { coedges, .. } = boundary else { continue };
            for run in runs(coedges, |c| is_below(c.edge, accuracy)) {
                let total: f64 = run.short.iter().filter_map(|c| lengths[c.edge.index()]).sum();
                let is_slender =
                    |c: &Coedge| lengths[c.edge.index()].is_some_and(|length| length >= SLENDER * total);
                if !(total <= accuracy && run.beside.is_some_and(|two| two.into_iter().all(is_slender))) {
                    run.short.iter().for_each(|c| found[c.edge.index()] = is_below(c.edge, rounding));
                }
            }
        }
        found
    }

    /// Step 1.
    fn collapse_edges_without_length(&mut self) {
        let mut same: Vec<u32> = (0..self.part.vertices.len() as u32).collect();
        let collapsed = self.without_length();
        for i in (0..collapsed.len()).filter(|&i| collapsed[i]) {
            let edge = &self.part.edges[i];
            let [from, to] = [same[edge.start.index()], same[edge.end.index()]];
            let (keep, drop) = (from.min(to), from.max(to));
            same.iter_mut().filter(|v| **v == drop).for_each(|v| *v = keep);
        }
        if !collapsed.contains(&true) {
            return;
        }
        let settle = |v: &mut VertexId| *v = VertexId(same[v.index()]);
        for (edge, collapsed) in self.part.edges.iter_mut().zip(&collapsed) {
            settle(&mut edge.start);
            settle(&mut edge.end);
            if *collapsed {
                edge.curve = None;
            }
        }
        for boundary in self.part.faces.iter_mut().flat_map(|face| &mut face.loops) {
            match boundary {
                Loop::Vertex(v) => settle(v),
                Loop::Polygon { vertices, .. } => vertices.iter_mut().for_each(settle),
                Loop::Edges { coedges, .. } => {
                    if coedges.iter().any(|c| !collapsed[c.edge.index()]) {
                        coedges.retain(|c| !collapsed[c.edge.index()]);
                    }
                }
            }
        }
    }

    fn coedges(&self, face: usize, index: usize) -> &[Coedge] {
        match &self.part.faces[face].loops[index] {
            Loop::Edges { coedges, .. } => coedges,
            Loop::Vertex(_) | Loop::Polygon { .. } => &[],
        }
    }

    /// Step 2, for a loop of one edge.
    fn fold_closed_edge(&mut self, face: usize, index: usize) {
        let [only] = self.coedges(face, index) else { return };
        let way = Way { edge: only.edge, forward: true };
        let [start, end] = self.ends(way);
        let Some(points) = self.samples(way).filter(|_| start == end) else { return };
        let around = points.windows(2).map(|p| (p[0] - points[0]).cross(p[1] - points[0])).sum::<DVec3>();
        let length = length(&points);
        // What encloses an area is no fold.
        if around.length() > length * length / SLENDER {
            return;
        }
        let from = points[0];
        let distance = |t: f64| self.at(way, t).map_or(0.0, |(_, p)| p.distance(from));
        let shares = (0..=SAMPLES).map(|k| f64::from(k) / f64::from(SAMPLES));
        let farthest = shares.max_by(|a, b| distance(*a).total_cmp(&distance(*b))).unwrap_or(0.5);
        let tip = highest(distance, farthest, 1.0 / f64::from(SAMPLES));
        let Some((t, p)) = self.at(way, tip).filter(|_| tip > 0.0 && tip < 1.0) else { return };
        let edge = self.edge(way);
        let Some(curve) = &edge.curve else { return };
        let back = CurveInverter::new(curve, Range::new(t, edge.range.end));
        let off = |k: u32| {
            let share = tip * f64::from(k) / f64::from(SAMPLES);
            self.at(way, share).map_or(f64::INFINITY, |(_, p)| back.invert(p, None).distance)
        };
        let apart = (0..=SAMPLES).map(off).fold(0.0, f64::max);
        if apart > self.allowed(way, way) || apart * SLENDER > length {
            return;
        }
        let vertex = self.add_vertex(p, edge.source);
        let second = self.split(way, t, vertex);
        self.merge(way.edge, second);
    }

    /// Step 3, for the first fold of a loop; false where there is none.
    fn fold_once(&mut self, face: usize, index: usize) -> bool {
        let way = |c: &Coedge| Way { edge: c.edge, forward: c.forward };
        let coedges = self.coedges(face, index).iter().filter(|c| self.has_length(c));
        let ways: Vec<Way> = coedges.map(way).collect();
        let n = ways.len();
        for i in 0..n {
            let back = Way { forward: !ways[i].forward, ..ways[i] };
            let on = ways[(i + 1) % n];
            if n < 2 || back.edge == on.edge || !self.leave_together(back, on) {
                continue;
            }
            if let Some((keep, drop)) = self.common_part(face, back, on) {
                self.merge(keep, drop);
                self.leave_out_returns(face, index);
                return true;
            }
        }
        false
    }

    /// True where two ways leave the same vertex in nearly the same direction.
    fn leave_together(&self, a: Way, b: Way) -> bool {
        if self.ends(a)[0] != self.ends(b)[0] {
            return false;
        }
        let direction = |way: Way| {
            let step = 1.0 / f64::from(SAMPLES);
            (self.at(way, step)?.1 - self.at(way, 0.0)?.1).try_normalize()
        };
        let (Some(a), Some(b)) = (direction(a), direction(b)) else { return false };
        a.dot(b) > SAME_WAY
    }

    /// Cuts the longer of two ways where the shorter one ends, if they coincide so far: (the edge to keep,
    /// the edge that becomes it).
    fn common_part(&mut self, face: usize, a: Way, b: Way) -> Option<(EdgeId, EdgeId)> {
        let [of_a, of_b] = [self.samples(a)?, self.samples(b)?].map(|points| length(&points));
        let (short, long) = if of_a <= of_b { (a, b) } else { (b, a) };
        let allowed = self.allowed(a, b).min(of_a.min(of_b) / SLENDER);
        let edge = self.edge(long);
        let curve = edge.curve.clone()?;
        let inverter = CurveInverter::new(&curve, edge.range);
        let feet: Vec<_> = self.samples(short)?.into_iter().map(|p| inverter.invert(p, None)).collect();
        if feet.iter().any(|foot| !(foot.distance <= allowed)) || self.folds_at_pole(face, short, allowed) {
            return None;
        }
        let [_, far] = self.ends(short);
        let [_, end] = self.ends(long);
        if far == end {
            // The one that ends nearer to its vertices is better known.
            let loose = self.looseness(long) > self.looseness(short);
            return Some(if loose { (short.edge, long.edge) } else { (long.edge, short.edge) });
        }
        let t = feet[feet.len() - 1].t;
        let beyond = |end: f64| (t - end).abs() > NO_LENGTH * edge.range.length();
        if !beyond(edge.range.start) || !beyond(edge.range.end) {
            return None;
        }
        let second = self.split(long, t, far);
        Some((short.edge, if long.forward { long.edge } else { second }))
    }

    /// True where a way starts or ends at a pole of the surface of a face.
    fn folds_at_pole(&self, face: usize, way: Way, distance: f64) -> bool {
        let FaceGeometry::Surface(surface) = &self.part.faces[face].geometry else { return false };
        let poles = surface.poles_within(distance);
        let ends = self.ends(way).map(|v| self.part.vertices[v.index()].point);
        poles.iter().any(|pole| ends.iter().any(|p| p.distance(pole.point) <= 10.0 * distance))
    }

    fn add_vertex(&mut self, point: DVec3, source: chordal_brep::Source) -> VertexId {
        self.part.vertices.push(Vertex { point, source });
        VertexId::from(self.part.vertices.len() - 1)
    }

    /// Cuts an edge in two for all faces; returns the second part.
    fn split(&mut self, way: Way, t: f64, vertex: VertexId) -> EdgeId {
        let second = EdgeId::from(self.part.edges.len());
        let edge = &mut self.part.edges[way.edge.index()];
        let whole = edge.range;
        let rest = Edge { range: Range::new(t, whole.end), start: vertex, ..edge.clone() };
        edge.range = Range::new(whole.start, t);
        edge.end = vertex;
        self.part.edges.push(rest);
        let share = (t - whole.start) / whole.length();
        for boundary in self.part.faces.iter_mut().flat_map(|face| &mut face.loops) {
            let Loop::Edges { coedges, .. } = boundary else { continue };
            if coedges.iter().any(|c| c.edge == way.edge) {
                *coedges = coedges.drain(..).flat_map(|c| halves(c, way.edge, second, share)).collect();
            }
        }
        second
    }

    /// Makes all faces use one edge for another one with the same ends.
    fn merge(&mut self, keep: EdgeId, drop: EdgeId) {
        let same_way = self.part.edges[keep.index()].start == self.part.edges[drop.index()].start;
        for boundary in self.part.faces.iter_mut().flat_map(|face| &mut face.loops) {
            let Loop::Edges { coedges, .. } = boundary else { continue };
            for coedge in coedges.iter_mut().filter(|c| c.edge == drop) {
                coedge.edge = keep;
                coedge.forward = coedge.forward == same_way;
                if !same_way {
                    coedge.pcurves.clear();
                }
            }
        }
    }

    fn has_length(&self, coedge: &Coedge) -> bool {
        self.part.edges[coedge.edge.index()].curve.is_some()
    }

    /// Leaves out edges that a loop runs there and back, with single points between the two, unless these are
    /// all that it is.
    fn leave_out_returns(&mut self, face: usize, index: usize) {
        loop {
            let coedges = self.coedges(face, index);
            let long: Vec<usize> = (0..coedges.len()).filter(|&i| self.has_length(&coedges[i])).collect();
            let n = long.len();
            let returns = |i: &usize| {
                let (a, b) = (&coedges[long[*i]], &coedges[long[(i + 1) % n]]);
                a.edge == b.edge && a.forward != b.forward
            };
            let Some(i) = (0..n).find(returns).filter(|_| n > 2) else { return };
            let (from, to) = (long[i], long[(i + 1) % n]);
            let is_left = |k: usize| if from <= to { k >= from && k <= to } else { k >= from || k <= to };
            let kept = (0..coedges.len()).filter(|&k| !is_left(k)).map(|k| coedges[k].clone()).collect();
            if let Loop::Edges { coedges, .. } = &mut self.part.faces[face].loops[index] {
                *coedges = kept;
            }
        }
    }
}

/// A coedge over an edge that was cut at a share of its range.
fn halves(coedge: Coedge, first: EdgeId, second: EdgeId, share: f64) -> Vec<Coedge> {
    if coedge.edge != first {
        return vec![coedge];
    }
    let part_of = |edge: EdgeId, from: f64, to: f64| {
        let of_range = |r: Range| Range::new(r.start + r.length() * from, r.start + r.length() * to);
        let part = |p: &Pcurve| Pcurve { curve: p.curve.clone(), range: of_range(p.range) };
        let pcurves = coedge.pcurves.iter().map(part).collect();
        Coedge { edge, forward: coedge.forward, pcurves }
    };
    let mut parts = vec![part_of(first, 0.0, share), part_of(second, share, 1.0)];
    if !coedge.forward {
        parts.reverse();
    }
    parts
}

/// Consecutive short edges of a loop, and the edges before and after them; none where all are short.
struct Run<'c> {
    short: Vec<&'c Coedge>,
    beside: Option<[&'c Coedge; 2]>,
}

fn runs(coedges: &[Coedge], is_short: impl Fn(&Coedge) -> bool) -> Vec<Run<'_>> {
    let n = coedges.len();
    let Some(first) = coedges.iter().position(|c| !is_short(c)) else {
        return vec![Run { short: coedges.iter().collect(), beside: None }];
    };
    // From one long edge to the next, once round.
    let mut found = Vec::new();
    let mut before = &coedges[first];
    let mut short = Vec::new();
    for coedge in (1..=n).map(|k| &coedges[(first + k) % n]) {
        if is_short(coedge) {
            short.push(coedge);
            continue;
        }
        if !short.is_empty() {
            found.push(Run { short: std::mem::take(&mut short), beside: Some([before, coedge]) });
        }
        before = coedge;
    }
    found
}

fn length(points: &[DVec3]) -> f64 {
    points.windows(2).map(|p| p[0].distance(p[1])).sum()
}

/// The highest place of a function near `middle`, by thirds.
fn highest(f: impl Fn(f64) -> f64, middle: f64, reach: f64) -> f64 {
    let (mut a, mut b) = ((middle - reach).max(0.0), (middle + reach).min(1.0));
    for _ in 0..80 {
        let (c, d) = (a + (b - a) / 3.0, b - (b - a) / 3.0);
        if f(c) < f(d) { a = c } else { b = d }
    }
    0.5 * (a + b)
}
