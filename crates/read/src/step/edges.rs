//! Vertices and edges: one edge for each EDGE_CURVE, one vertex for each VERTEX_POINT, shared by all faces
//! that use them.

use super::builder::{Builder, KnownEdge};
use super::document::{Ix, Res};
use super::keyword::Kw;
use crate::locate::{self, Located, locate};
use chordal_brep::{Edge, Issue, ReadIssue, Source, VertexId};
use chordal_nurbs::{Curve, Range};
use std::sync::Arc;

/// A gap between a vertex and its curve is noted where it exceeds this part of the edge's length: gaps below
/// it are the rule in files of loose accuracy, and the report lists the widest one anyway.
const NOTED_GAP: f64 = 0.1;

impl Builder<'_> {
    /// VERTEX_POINT.
    pub(crate) fn vertex(&mut self, ix: Ix) -> Res<VertexId> {
        if let Some(&known) = self.vertices.get(&ix) {
            return Ok(known);
        }
        let point_ix = if self.doc.kw(ix) == Kw::CartesianPoint {
            ix
        } else {
            let mut args = self.doc.leaf(ix, Kw::VertexPoint)?;
            if self.doc.kw(ix) != Kw::Complex {
                args.skip(1);
            }
            args.reference()?
        };
        let point = self.geometry.point(point_ix)?;
        let id = self.build.new_vertex(point, self.doc.source(ix));
        self.vertices.insert(ix, id);
        Ok(id)
    }

    /// EDGE_CURVE or SUBEDGE, built once.
    pub(crate) fn edge(&mut self, ix: Ix) -> Res<KnownEdge> {
        if let Some(known) = self.edges.get(&ix) {
            return known.clone();
        }
        let built = self.build_edge(ix);
        self.edges.insert(ix, built.clone());
        built
    }

    fn build_edge(&mut self, ix: Ix) -> Res<KnownEdge> {
        let kind = if self.doc.kw(ix) == Kw::Subedge { Kw::Subedge } else { Kw::EdgeCurve };
        let mut args = self.doc.leaf(ix, kind)?;
        args.skip(1);
        let start = self.vertex(args.reference()?)?;
        let end = self.vertex(args.reference()?)?;
        let (geometry, same_sense) = if kind == Kw::Subedge {
            let parent = args.reference()?;
            let mut args = self.doc.leaf(parent, Kw::EdgeCurve)?;
            args.skip(3);
            (args.reference(), args.logical(true))
        } else {
            (args.reference(), args.logical(true))
        };
        let curve = geometry.clone().and_then(|geometry| self.geometry.curve(geometry));
        let (edge, located) = self.bounded_edge(ix, curve, start, end, same_sense);
        let own_parameters = located.is_some();
        let range = edge.range;
        let angle = edge.curve.as_ref().map_or(1.0, |curve| self.geometry.parameter_unit(curve));
        let id = self.build.push_edge(edge);
        let file_range = own_parameters.then(|| Range::new(range.start / angle, range.end / angle));
        let pcurves = geometry.map_or_else(|_| Vec::new(), |geometry| self.pcurves(geometry, id, file_range));
        Ok(KnownEdge { id, swapped: located.is_some_and(|l| l.swapped), pcurves: pcurves.into() })
    }

    /// The edge between two vertices on a curve; a straight one where the curve cannot be used.
    fn bounded_edge(
        &mut self,
        ix: Ix,
        curve: Res<Curve>,
        start: VertexId,
        end: VertexId,
        same_sense: bool,
    ) -> (Edge, Option<Located>) {
        let source = self.doc.source(ix);
        let [p, q] = [start, end].map(|v| self.build.point_of(v));
        let found = match &curve {
            Ok(curve) => locate(curve, p, q, start == end, same_sense),
            Err(_) => None,
        };
        if let (Ok(curve), Some(located)) = (curve.as_ref(), found) {
            if located.contradicted {
                self.doc.warn(ix, ReadIssue::EdgeSense);
            }
            let Range { start: t0, end: t1 } = located.range;
            let (first, last) = if located.swapped { (end, start) } else { (start, end) };
            let gap = [(t0, first), (t1, last)].map(|(t, v)| curve.point(t).distance(self.build.point_of(v)));
            let gap = gap[0].max(gap[1]);
            if gap.is_finite() {
                self.note_gap(ix, curve, located.range, gap);
                let curve = Some(Arc::new(curve.clone()));
                return (
                    Edge { curve, range: located.range, start: first, end: last, source },
                    Some(located),
                );
            }
        }
        let cause = curve.err().map(|bad| bad.into_cause(source));
        if p == q {
            if start != end || cause.is_some() {
                self.doc.warn(ix, ReadIssue::EdgeIsPoint { cause });
            }
            self.build.merge(start, end);
            return (Edge { curve: None, range: Range::new(0.0, 1.0), start, end: start, source }, None);
        }
        let cause =
            cause.unwrap_or_else(|| Box::new(Issue::error(Source::default(), ReadIssue::NoCurveBetween)));
        self.doc.warn(ix, ReadIssue::EdgeStraightened { cause });
        let line = Curve::Line { origin: p, direction: q - p };
        (Edge { curve: Some(Arc::new(line)), range: Range::new(0.0, 1.0), start, end, source }, None)
    }

    fn note_gap(&self, ix: Ix, curve: &Curve, range: Range, gap: f64) {
        // The chord bounds the length from below: most edges are done with it.
        let chord = curve.point(range.start).distance(curve.point(range.end));
        if gap <= NOTED_GAP * chord {
            return;
        }
        let length = locate::length(curve, range);
        if gap > NOTED_GAP * length {
            let units = &self.geometry.units;
            let (gap, length) = (units.millimetres(gap), units.millimetres(length));
            self.doc.warn(ix, ReadIssue::VertexOffCurve { gap, length });
        }
    }
}
