//! Boundaries of curve-bounded surfaces: pieces of curves chained to a closed loop.
//!
//! ISO 10303-42 lists the pieces of a composite curve in order, each with its sense. Files list them in any
//! order and with any sense (Creo's do), so the ends decide. The pieces keep the file's curves in the
//! parameter space of the surface: on a cone with two nappes or across a seam nothing else determines which
//! part of the surface is meant.

use super::builder::Builder;
use super::document::{Ix, Res};
use chordal_brep::{Coedge, Edge, Pcurve, ReadIssue, VertexId};
use chordal_nurbs::{CompositeSegment, Curve, DVec3, Range};
use std::sync::Arc;

/// A piece of a boundary, with the entity of its curve where that is one of the file.
pub(crate) struct Piece {
    pub segment: CompositeSegment,
    pub curve: Option<Ix>,
}

impl Piece {
    fn start(&self) -> DVec3 {
        self.segment.curve.point(self.segment.start)
    }

    fn end(&self) -> DVec3 {
        self.segment.curve.point(self.segment.end)
    }

    fn reverse(&mut self) {
        std::mem::swap(&mut self.segment.start, &mut self.segment.end);
    }

    fn has_ends(&self) -> bool {
        let CompositeSegment { start, end, .. } = self.segment;
        start.is_finite()
            && end.is_finite()
            && start != end
            && self.start().is_finite()
            && self.end().is_finite()
    }
}

impl Builder<'_> {
    /// The loop that the pieces of a boundary make on the surface of entity `surface`.
    pub(crate) fn boundary_coedges(&mut self, ix: Ix, surface: Ix, pieces: Vec<Piece>) -> Res<Vec<Coedge>> {
        if !pieces.iter().all(Piece::has_ends) {
            return Err(self.doc.bad(ix, ReadIssue::CurveUnbounded));
        }
        let tolerance = self.meeting_tolerance(&pieces);
        let (pieces, chained) = chained(pieces, tolerance);
        if chained.sorted {
            self.doc.warn(ix, ReadIssue::EdgesSorted);
        }
        if chained.turned {
            self.doc.warn(ix, ReadIssue::EdgeTurned);
        }
        let source = self.doc.source(ix);
        let count = pieces.len();
        // Vertex i is where piece i ends, and unless a gap follows where piece i + 1 starts; a piece that is
        // a single point, at a pole, starts where it ends.
        let points = single_points(&pieces);
        let gap = |i: usize| pieces[i].end().distance(pieces[(i + 1) % count].start());
        let gaps: Vec<f64> = (0..count).map(gap).collect();
        let mut ends: Vec<VertexId> =
            pieces.iter().map(|piece| self.build.new_vertex(piece.end(), source)).collect();
        for i in (0..count).filter(|&i| points[i]) {
            ends[i] = ends[(i + count - 1) % count];
        }
        let mut coedges = Vec::with_capacity(count);
        for (i, piece) in pieces.into_iter().enumerate() {
            let before = (i + count - 1) % count;
            let from = if points[i] || gaps[before] <= tolerance {
                ends[before]
            } else {
                let from = self.build.new_vertex(piece.start(), source);
                let edge = self.build.straight_edge(ends[before], from, source);
                coedges.push(Coedge { edge, forward: true, pcurves: Vec::new() });
                from
            };
            coedges.push(self.boundary_edge(ix, surface, piece, [from, ends[i]], points[i]));
        }
        let widest =
            gaps.iter().zip(&points).filter(|(_, point)| !**point).fold(0.0, |m, (gap, _)| gap.max(m));
        if widest > tolerance {
            self.doc.warn(ix, ReadIssue::GapClosed { gap: self.geometry.units.millimetres(widest) });
        }
        Ok(coedges)
    }

    /// The distance within which two ends of a boundary's pieces are one vertex.
    fn meeting_tolerance(&self, pieces: &[Piece]) -> f64 {
        let first = pieces.first().map_or(DVec3::ZERO, Piece::start);
        let size = pieces.iter().fold(0.0f64, |m, piece| m.max(extent(first, &samples(piece))));
        let stated = self.build.part.uncertainty.unwrap_or(0.0).min(1e-3 * size);
        stated.max(SAME_END * size)
    }

    fn boundary_edge(
        &mut self,
        ix: Ix,
        surface: Ix,
        piece: Piece,
        [from, to]: [VertexId; 2],
        is_point: bool,
    ) -> Coedge {
        let CompositeSegment { curve, start, end } = piece.segment;
        let forward = start < end;
        let (range, first, last) =
            if forward { (Range::new(start, end), from, to) } else { (Range::new(end, start), to, from) };
        let mut pcurves = match &curve {
            Curve::OnSurface { curve, .. } => vec![Pcurve { curve: Arc::new((**curve).clone()), range }],
            _ => Vec::new(),
        };
        let angle = self.geometry.parameter_unit(&curve);
        let curve = (!is_point).then(|| Arc::new(curve));
        let source = self.doc.source(ix);
        let edge = self.build.push_edge(Edge { curve, range, start: first, end: last, source });
        if let Some(own) = piece.curve.filter(|_| pcurves.is_empty()) {
            let file_range = Range::new(range.start / angle, range.end / angle);
            let uses = self.pcurves(own, edge, Some(file_range)).into_iter();
            let uses = uses.filter(|found| found.surface == surface);
            pcurves = uses.map(|found| Pcurve { curve: found.curve, range: found.range }).collect();
        }
        Coedge { edge, forward, pcurves }
    }
}

/// What was done to the pieces to make them a chain.
struct Chained {
    sorted: bool,
    turned: bool,
}

/// The pieces in an order and with senses in which each starts where the one before ends, as far as they
/// meet.
///
/// Pieces that meet already stay as they are. Else the chain begins with the first piece, and takes each time
/// the piece with the end nearest to where the chain ends; in the end most pieces have the direction that the
/// file states.
fn chained(mut pieces: Vec<Piece>, tolerance: f64) -> (Vec<Piece>, Chained) {
    let count = pieces.len();
    let meets = (0..count).all(|i| pieces[i].end().distance(pieces[(i + 1) % count].start()) <= tolerance);
    if meets || !(2..=MOST_PIECES).contains(&count) {
        return (pieces, Chained { sorted: false, turned: false });
    }
    let mut order = vec![(0, false)];
    let mut end = pieces[0].end();
    let mut left: Vec<usize> = (1..count).collect();
    while !left.is_empty() {
        let candidates = left.iter().enumerate().flat_map(|(k, &i)| {
            let ends = [(pieces[i].start(), false), (pieces[i].end(), true)];
            ends.map(|(point, turned)| (point.distance(end), k, turned))
        });
        let Some((_, k, turned)) = candidates.min_by(|a, b| a.0.total_cmp(&b.0)) else { break };
        let i = left.remove(k);
        end = if turned { pieces[i].start() } else { pieces[i].end() };
        order.push((i, turned));
    }
    let turned = order.iter().filter(|(_, turned)| *turned).count();
    if 2 * turned > count {
        order.reverse();
        order.iter_mut().for_each(|(_, turned)| *turned = !*turned);
    }
    let sorted = (0..count).any(|i| order[(i + 1) % count].0 != (order[i].0 + 1) % count);
    let mut taken: Vec<Option<Piece>> = pieces.drain(..).map(Some).collect();
    let chain = order.iter().filter_map(|&(i, turned)| {
        let mut piece = taken[i].take()?;
        if turned {
            piece.reverse();
        }
        Some(piece)
    });
    (chain.collect(), Chained { sorted, turned: turned % count != 0 })
}

/// Which pieces of a boundary stay in one place all along.
fn single_points(pieces: &[Piece]) -> Vec<bool> {
    let samples: Vec<Vec<DVec3>> = pieces.iter().map(samples).collect();
    let size = samples.iter().fold(0.0f64, |m, points| m.max(extent(samples[0][0], points)));
    samples.iter().map(|points| extent(points[0], points) <= ONE_POINT * size && size > 0.0).collect()
}

fn samples(piece: &Piece) -> Vec<DVec3> {
    let CompositeSegment { curve, start, end } = &piece.segment;
    let at = |k: u32| curve.point(start + (end - start) * f64::from(k) / f64::from(PIECE_SAMPLES));
    (0..=PIECE_SAMPLES).map(at).collect()
}

fn extent(from: DVec3, points: &[DVec3]) -> f64 {
    points.iter().fold(0.0f64, |m, p| m.max(p.distance(from)))
}

/// Boundaries of more pieces are taken as they are listed: the search takes time by the square of their
/// number.
const MOST_PIECES: usize = 4096;

/// Places along a piece of a boundary at which its extent is measured.
const PIECE_SAMPLES: u32 = 16;

/// Points nearer than this share of a boundary's size are one: coordinates are commonly rounded to seven
/// digits.
const ONE_POINT: f64 = 1e-7;

/// Ends of pieces nearer than this share of the boundary's size meet, where the file states no accuracy.
const SAME_END: f64 = 1e-5;

#[cfg(test)]
mod tests {
    use super::*;

    fn line(from: [f64; 2], to: [f64; 2]) -> Piece {
        let [p, q] = [from, to].map(|[x, y]| DVec3::new(x, y, 0.0));
        let curve = Curve::Line { origin: p, direction: q - p };
        Piece { segment: CompositeSegment { curve, start: 0.0, end: 1.0 }, curve: None }
    }

    fn corners(pieces: &[Piece]) -> Vec<[f64; 2]> {
        pieces.iter().map(|piece| [piece.start().x, piece.start().y]).collect()
    }

    #[test]
    fn pieces_in_any_order_and_direction_become_a_loop() {
        let [a, b, c, d] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let (loop_1, done) = chained(vec![line(a, b), line(c, d), line(b, c), line(d, a)], 1e-9);
        assert_eq!((corners(&loop_1), done.sorted, done.turned), (vec![a, b, c, d], true, false));
        let (loop_2, done) = chained(vec![line(b, a), line(b, c), line(c, d), line(d, a)], 1e-9);
        assert_eq!((corners(&loop_2), done.sorted, done.turned), (vec![b, c, d, a], false, true));
        let (same, done) = chained(vec![line(a, b), line(b, c), line(c, a)], 1e-9);
        assert_eq!((corners(&same), done.sorted, done.turned), (vec![a, b, c], false, false));
    }
}
