//! Edges: one for each record and location.

use super::builder::Builder;
use super::locations::Loc;
use super::shapes::{EdgeData, Ix, Kind, Orientation, Shape};
use chordal_brep::{Edge, EdgeId, Issue, ReadIssue, Real, Source, VertexId};
use chordal_nurbs::{Curve, Range};
use std::sync::Arc;

/// Ends of a curve nearer than this part of its length are one vertex, where the file gives it none.
const SAME_END: f64 = 1e-9;

impl Builder<'_> {
    /// The edge of a record at a place, built once.
    pub(crate) fn edge(&mut self, ix: Ix, loc: Loc) -> Result<EdgeId, ReadIssue> {
        if let Some(known) = self.edges.get(&(ix, loc)) {
            return known.clone();
        }
        let made = self.new_edge(ix, loc);
        self.edges.insert((ix, loc), made.clone());
        made
    }

    fn new_edge(&mut self, ix: Ix, loc: Loc) -> Result<EdgeId, ReadIssue> {
        let shape = self.shape(ix)?;
        let Kind::Edge(data) = &shape.kind else {
            return Err(ReadIssue::UnknownKind { found: "a shape of the wire".into(), expected: "an edge" });
        };
        let source = self.doc.source(ix);
        self.note_tolerance(data.tolerance, loc);
        let ends = self.end_vertices(&shape, loc)?;
        if data.degenerated {
            return self.point_edge(ends, source);
        }
        let (curve, range) = match self.curve_of_edge(data, loc) {
            Ok(found) => found,
            Err(why) => return self.substitute(ends, source, why),
        };
        let [start, end] = match ends {
            [Some(start), Some(end)] => [start, end],
            _ => self.ends_of_curve(ends, &curve, range, source)?,
        };
        let curve = Some(Arc::new(curve));
        Ok(self.build.push_edge(Edge { curve, range, start, end, source }))
    }

    /// The vertices where the edge starts and ends.
    fn end_vertices(&mut self, shape: &Shape, loc: Loc) -> Result<[Option<VertexId>; 2], ReadIssue> {
        let mut ends = [None; 2];
        for sub in &shape.subs {
            let end = match sub.orientation {
                Orientation::Forward => 0,
                Orientation::Reversed => 1,
                Orientation::Aside => continue,
            };
            let at = self.within(loc, sub.location)?;
            ends[end] = Some(self.vertex(sub.shape, at)?);
        }
        Ok(ends)
    }

    /// An edge that is a single point: a pole, an apex.
    fn point_edge(&mut self, ends: [Option<VertexId>; 2], source: Source) -> Result<EdgeId, ReadIssue> {
        let vertex = ends[0].or(ends[1]).ok_or(ReadIssue::Missing { what: "vertex of the edge" })?;
        self.build.merge(vertex, ends[1].unwrap_or(vertex));
        let range = Range::new(0.0, 1.0);
        Ok(self.build.push_edge(Edge { curve: None, range, start: vertex, end: vertex, source }))
    }

    /// The edge's curve in space, else its curve on a surface.
    fn curve_of_edge(&mut self, data: &EdgeData, loc: Loc) -> Result<(Curve, Range), ReadIssue> {
        let sound = |range: Range| range.is_finite() && range.start < range.end;
        let mut problem = ReadIssue::Missing { what: "curve" };
        if let Some((number, location, range)) = data.curve {
            let at = self.within(loc, location)?;
            match self.curve(number, at) {
                Ok(curve) if sound(range) => return Ok((curve, range)),
                Ok(_) => problem = ReadIssue::EmptyRange { start: Real(range.start), end: Real(range.end) },
                Err(why) => problem = why,
            }
        }
        for on_surface in &data.on_surfaces {
            let at = self.within(loc, on_surface.location)?;
            let Ok(patch) = self.patch(on_surface.surface, at) else { continue };
            if let Ok(pcurve) = self.pcurve(on_surface.curves[0], on_surface.range, &patch) {
                let curve = Box::new(pcurve.curve.as_ref().clone());
                return Ok((Curve::OnSurface { surface: patch.surface, curve }, pcurve.range));
            }
        }
        Err(problem)
    }

    /// A straight edge in place of one that cannot be understood.
    fn substitute(
        &mut self,
        ends: [Option<VertexId>; 2],
        source: Source,
        why: ReadIssue,
    ) -> Result<EdgeId, ReadIssue> {
        let [Some(start), Some(end)] = ends else { return Err(why) };
        let cause = Box::new(Issue::error(Source::default(), why));
        self.doc.notes.warn(source, ReadIssue::EdgeStraightened { cause });
        Ok(self.build.straight_edge(start, end, source))
    }

    /// New vertices at the ends of a curve for those that the file leaves out.
    fn ends_of_curve(
        &mut self,
        ends: [Option<VertexId>; 2],
        curve: &Curve,
        range: Range,
        source: Source,
    ) -> Result<[VertexId; 2], ReadIssue> {
        let points = [range.start, range.end].map(|t| curve.point(t));
        if !points.iter().all(|p| p.is_finite()) {
            return Err(ReadIssue::Missing { what: "ends of the edge" });
        }
        let middle = curve.point((range.start + range.end) * 0.5);
        let size = points[0].distance(middle) + points[1].distance(middle);
        if points[0].distance(points[1]) <= SAME_END * size {
            let vertex = ends[0].or(ends[1]).unwrap_or_else(|| self.build.new_vertex(points[0], source));
            return Ok([vertex; 2]);
        }
        let [start, end] =
            [0, 1].map(|i| ends[i].unwrap_or_else(|| self.build.new_vertex(points[i], source)));
        Ok([start, end])
    }
}
