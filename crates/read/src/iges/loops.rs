//! A boundary in space as a loop of edges that belong to one face.

use super::boundaries::ModelUse;
use super::builder::Builder;
use super::document::Ix;
use super::surfaces::Patch;
use chordal_brep::{Coedge, Edge, Pcurve, ReadIssue, Source, VertexId};
use chordal_nurbs::{Curve, Curve2, DVec2, DVec3, Range};
use std::sync::Arc;

/// Pieces of a boundary that are the two sides of a seam agree within this part of the boundary's size.
const SAME_SIDE: f64 = 1e-4;

impl Builder<'_, '_> {
    /// The loop of a boundary's pieces; none where it has no extent. It runs counter-clockwise in our
    /// parameters if `outer`, clockwise if not, wherever that can be told: `turn` says which way the pieces
    /// run, true for counter-clockwise.
    pub(crate) fn model_loop(
        &mut self,
        ix: Ix,
        pieces: Vec<ModelUse>,
        size: f64,
        patch: &Patch,
        outer: bool,
        turn: Option<bool>,
    ) -> Option<Vec<Coedge>> {
        let resolution = self.resolution();
        let tiny = (1e-7 * size).max(resolution.min(1e-5 * size));
        let mut pieces: Vec<ModelUse> = pieces.into_iter().filter(|p| p.segment.extent() > tiny).collect();
        if pieces.is_empty() {
            return None;
        }
        let tolerance = (2.0 * resolution).min(1e-3 * size).max(1e-6 * size);
        if turn_misfits(&mut pieces, tolerance) {
            self.doc.warn(ix, ReadIssue::EdgeTurned);
        }
        match area(&pieces).map(|area| area > 0.0).or(turn) {
            Some(ccw) if ccw != outer => reverse(&mut pieces),
            // The file's directions are those of its own normal.
            None if patch.reversed => reverse(&mut pieces),
            _ => {}
        }
        Some(self.chain(ix, &pieces, size, tolerance, patch))
    }

    fn chain(
        &mut self,
        ix: Ix,
        pieces: &[ModelUse],
        size: f64,
        tolerance: f64,
        patch: &Patch,
    ) -> Vec<Coedge> {
        let source = self.doc.source(ix);
        let n = pieces.len();
        // Where piece i starts, and where it ends unless the next one starts there.
        let starts: Vec<VertexId> = pieces.iter().map(|p| self.build.new_vertex(p.start(), source)).collect();
        let gap = |i: usize| pieces[i].end().distance(pieces[(i + 1) % n].start());
        let widest = (0..n).map(gap).fold(0.0, f64::max);
        let closes = patch.surface.periods().iter().any(Option::is_some);
        let mut coedges: Vec<Coedge> = Vec::with_capacity(n);
        let mut made: Vec<Option<usize>> = Vec::with_capacity(n);
        for (i, piece) in pieces.iter().enumerate() {
            let next = starts[(i + 1) % n];
            let meets = gap(i) <= tolerance;
            let end = if meets { next } else { self.build.new_vertex(piece.end(), source) };
            let other =
                if closes { (0..i).find(|&j| two_sides(&pieces[j], piece, SAME_SIDE * size)) } else { None };
            let known = other.and_then(|j| made[j]);
            made.push(Some(coedges.len()));
            coedges.push(match (other, known) {
                (Some(j), Some(k)) => {
                    let edge = coedges[k].edge;
                    let (from, to) = self.build.ends(&coedges[k]);
                    self.build.merge(from, end);
                    self.build.merge(to, starts[i]);
                    // The edge runs with piece j, the curve of this side with piece i.
                    let same = pieces[j].forward != piece.forward;
                    let pcurves = piece.pcurve.iter().map(|p| if same { p.clone() } else { turned(p) });
                    Coedge { edge, forward: !coedges[k].forward, pcurves: pcurves.collect() }
                }
                _ => {
                    let (start, end) = if piece.forward { (starts[i], end) } else { (end, starts[i]) };
                    let curve = Some(Arc::new(piece.segment.curve.clone()));
                    let range = piece.segment.range;
                    let edge = self.build.push_edge(Edge { curve, range, start, end, source });
                    Coedge { edge, forward: piece.forward, pcurves: piece.pcurve.iter().cloned().collect() }
                }
            });
            if !meets {
                coedges.push(self.bridge(end, next, patch, source));
            }
        }
        if widest > tolerance {
            self.doc.warn(ix, ReadIssue::GapOnSurface { gap: self.doc.millimetres(widest) });
        }
        coedges
    }

    /// An edge over a gap: on the surface, straight in its parameters.
    fn bridge(&mut self, from: VertexId, to: VertexId, patch: &Patch, source: Source) -> Coedge {
        let (p, q) = (self.build.point_of(from), self.build.point_of(to));
        let start = patch.surface.invert(p, None);
        let direction = patch.surface.invert(q, Some(start)) - start;
        let range = Range::new(0.0, 1.0);
        if !(direction.length() > 0.0 && start.is_finite() && direction.is_finite()) {
            let edge = self.build.straight_edge(from, to, source);
            return Coedge { edge, forward: true, pcurves: Vec::new() };
        }
        let line = Curve2::Line { origin: start, direction };
        let surface = Arc::new(patch.surface.clone());
        let curve = Some(Arc::new(Curve::OnSurface { surface, curve: Box::new(line.clone()) }));
        let edge = self.build.push_edge(Edge { curve, range, start: from, end: to, source });
        Coedge { edge, forward: true, pcurves: vec![Pcurve { curve: Arc::new(line), range }] }
    }
}

/// Turns pieces that fit only the other way round; true where there were any.
fn turn_misfits(pieces: &mut [ModelUse], tolerance: f64) -> bool {
    let n = pieces.len();
    if n < 2 {
        return false;
    }
    let mut turned = false;
    let away = |p: DVec3, piece: &ModelUse| p.distance(piece.start()).min(p.distance(piece.end()));
    if away(pieces[0].end(), &pieces[1]) > tolerance && away(pieces[0].start(), &pieces[1]) <= tolerance {
        pieces[0].forward = !pieces[0].forward;
        turned = true;
    }
    for i in 1..n {
        let before = pieces[i - 1].end();
        let (ahead, back) = (before.distance(pieces[i].start()), before.distance(pieces[i].end()));
        if ahead > tolerance && back < ahead {
            pieces[i].forward = !pieces[i].forward;
            turned = true;
        }
    }
    turned
}

fn reverse(pieces: &mut [ModelUse]) {
    pieces.reverse();
    pieces.iter_mut().for_each(|piece| piece.forward = !piece.forward);
}

/// The area within the boundary in parameter space; none where that is not closed or not known.
fn area(pieces: &[ModelUse]) -> Option<f64> {
    const STEPS: u32 = 16;
    let mut polygon: Vec<DVec2> = Vec::new();
    let mut ends: Vec<[DVec2; 2]> = Vec::new();
    for piece in pieces {
        let pcurve = piece.pcurve.as_ref()?;
        let at = |k: u32| {
            let k = if piece.forward { k } else { STEPS - k };
            let share = f64::from(k) / f64::from(STEPS);
            pcurve.curve.point(pcurve.range.start + share * pcurve.range.length())
        };
        polygon.extend((0..STEPS).map(at));
        ends.push([at(0), at(STEPS)]);
    }
    let (low, high) = polygon.iter().fold((polygon[0], polygon[0]), |(a, b), p| (a.min(*p), b.max(*p)));
    let size = (high - low).max(DVec2::splat(f64::MIN_POSITIVE));
    let n = ends.len();
    // Along a pole the boundary may jump, but only within its own box; round a closed surface it ends a
    // period away.
    let jump = (ends[n - 1][1] - ends[0][0]) / size;
    if jump.length() > 0.01 && n == 1 || jump.length() > 0.9 {
        return None;
    }
    let unit: Vec<DVec2> = polygon.iter().map(|&p| (p - low) / size).collect();
    let count = unit.len();
    let area = (0..count).map(|i| unit[i].perp_dot(unit[(i + 1) % count])).sum::<f64>() * 0.5;
    (area.abs() > 1e-9).then_some(area)
}

/// True where `b` runs back along `a`.
fn two_sides(a: &ModelUse, b: &ModelUse, tolerance: f64) -> bool {
    a.start().distance(b.end()) <= tolerance
        && a.end().distance(b.start()) <= tolerance
        && [0.25, 0.5, 0.75].into_iter().all(|share| {
            let p = a.segment.at(share);
            let t = b.segment.curve.invert(p, Some(b.segment.range.start + 0.5 * b.segment.range.length()));
            let t = b.segment.range.clamp(t);
            b.segment.curve.point(t).distance(p) <= tolerance
        })
}

/// The same curve run the other way.
fn turned(pcurve: &Pcurve) -> Pcurve {
    let Range { start, end } = pcurve.range;
    let curve = Curve2::Composite(vec![(pcurve.curve.as_ref().clone(), end, start)]);
    Pcurve { curve: Arc::new(curve), range: Range::new(0.0, 1.0) }
}
