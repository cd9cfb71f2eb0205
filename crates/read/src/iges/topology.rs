//! Manifold solids: lists of vertices (502) and edges (504), loops (508), faces (510), shells (514), solids
//! (186).

use super::boundaries::directed;
use super::builder::{Builder, EdgeRow, KnownEdge};
use super::curves::{Segment, joined, segments, segments2};
use super::document::{Args, Ix, Res};
use super::matrix;
use super::simpler::elementary;
use super::surfaces::{Patch, surface};
use crate::locate::locate;
use crate::trimmed::Look;
use chordal_brep::{
    Body, BodyKind, Coedge, Edge, EdgeId, Face, FaceGeometry, FaceId, Issue, Loop, Pcurve, ReadIssue, Real,
    Shell, ShellId, VertexId,
};
use chordal_nurbs::{Curve, DAffine3, DVec3, Range};
use std::sync::Arc;

/// A curve's end is at its vertex within this part of the edge's size.
const AT_VERTEX: f64 = 1e-3;

impl Builder<'_, '_> {
    /// 186: shell, its sense, voids with theirs.
    pub(crate) fn solid(&mut self, ix: Ix) -> Res<()> {
        let by = matrix::of_entity(self.doc, ix)?;
        let mut args = self.doc.open(ix)?;
        let mut shells = vec![(args.reference()?, args.integer()? != 0)];
        for _ in 0..args.count()? {
            shells.push((args.reference()?, args.integer()? != 0));
        }
        self.by = by;
        let mut ids = Vec::new();
        for (shell, same_sense) in shells {
            match self.shell(shell, !same_sense, true) {
                Ok(id) => ids.push(id),
                Err(bad) => self.doc.lose_bad(&bad),
            }
        }
        self.by = DAffine3::IDENTITY;
        self.body(ix, BodyKind::Solid, ids);
        Ok(())
    }

    /// A shell that is no solid's.
    pub(crate) fn sheet(&mut self, ix: Ix) -> Res<()> {
        self.by = DAffine3::IDENTITY;
        let closed = self.doc.entry(ix).form == 1;
        let id = self.shell(ix, false, closed)?;
        self.body(ix, BodyKind::Sheet, vec![id]);
        Ok(())
    }

    fn body(&mut self, ix: Ix, kind: BodyKind, shells: Vec<ShellId>) {
        if !shells.is_empty() {
            let Look { name, color, layer, source, .. } = self.look(ix);
            self.build.part.bodies.push(Body { kind, shells, name, color, layer, source });
        }
    }

    /// 514: faces with their senses.
    fn shell(&mut self, ix: Ix, flipped: bool, closed: bool) -> Res<ShellId> {
        if self.doc.kind(ix) != 514 {
            return Err(self.doc.unknown(ix, "a shell"));
        }
        let own = self.look(ix);
        let by = self.by * matrix::of_entity(self.doc, ix)?;
        let mut args = self.doc.open(ix)?;
        let mut faces = Vec::new();
        for _ in 0..args.count()? {
            let (face, same_sense) = (args.reference()?, args.integer()? != 0);
            let mut look = self.look(face);
            look.color = look.color.or(own.color);
            look.layer = look.layer.or_else(|| own.layer.clone());
            look.flipped = flipped == same_sense;
            faces.push(self.face(face, &by, &look));
        }
        let id = ShellId::from(self.build.part.shells.len());
        self.build.part.shells.push(Shell { faces, closed, source: self.doc.source(ix) });
        Ok(id)
    }

    /// A face that is no shell's.
    pub(crate) fn lone_face(&mut self, ix: Ix) -> FaceId {
        self.by = DAffine3::IDENTITY;
        let look = self.look(ix);
        self.face(ix, &DAffine3::IDENTITY, &look)
    }

    fn face(&mut self, ix: Ix, by: &DAffine3, look: &Look) -> FaceId {
        match self.read_face(ix, by) {
            Ok((patch, loops)) => {
                let id = FaceId::from(self.build.part.faces.len());
                self.build.part.faces.push(Face {
                    geometry: FaceGeometry::Surface(Arc::new(patch.surface)),
                    same_sense: !patch.reversed,
                    flipped: look.flipped,
                    loops,
                    name: look.name.clone(),
                    color: look.color,
                    layer: look.layer.clone(),
                    source: look.source,
                });
                id
            }
            Err(bad) => self.failed(bad, look),
        }
    }

    /// 510: surface, number of loops, whether the first is the outer one, loops.
    fn read_face(&mut self, ix: Ix, by: &DAffine3) -> Res<(Patch, Vec<Loop>)> {
        if self.doc.kind(ix) != 510 {
            return Err(self.doc.unknown(ix, "a face"));
        }
        let by = *by * matrix::of_entity(self.doc, ix)?;
        let mut args = self.doc.open(ix)?;
        let basis = args.reference()?;
        let count = args.integer()?;
        let first_is_outer = args.integer()? != 0;
        if count < 0 || count as usize > args.left() {
            return Err(self
                .doc
                .bad(ix, ReadIssue::BadValue { what: "number of loops", value: Real(count as f64) }));
        }
        let patch = surface(self.doc, basis, &by)?;
        let patch = elementary(&patch).filter(|_| count > 0).unwrap_or(patch);
        let mut loops = Vec::new();
        for i in 0..count {
            let outer = i == 0 && first_is_outer;
            loops.push(self.edge_loop(args.reference()?, &patch, outer)?);
        }
        if loops.is_empty() && !patch.surface.domain().is_finite() {
            return Err(self.doc.bad(ix, ReadIssue::NoBoundary));
        }
        Ok((patch, loops))
    }

    /// 508: uses of edges and vertices.
    fn edge_loop(&mut self, ix: Ix, patch: &Patch, outer: bool) -> Res<Loop> {
        if self.doc.kind(ix) != 508 {
            return Err(self.doc.unknown(ix, "a loop"));
        }
        let source = self.doc.source(ix);
        let mut args = self.doc.open(ix)?;
        let (mut coedges, mut lone) = (Vec::new(), None);
        for _ in 0..args.count()? {
            let is_vertex = args.integer()? == 1;
            let list = args.reference()?;
            let position = self.position(&mut args)?;
            let along = args.integer()? != 0;
            let curves = self.parameter_curves(&mut args)?;
            if is_vertex {
                let vertex = self.vertex(list, position)?;
                lone = Some(vertex);
                let range = Range::new(0.0, 1.0);
                let point = Edge { curve: None, range, start: vertex, end: vertex, source };
                let edge = self.build.push_edge(point);
                coedges.push(Coedge { edge, forward: true, pcurves: Vec::new() });
                continue;
            }
            let known = self.edge(list, position)?;
            let forward = along != known.swapped;
            let pcurves = self.pcurves(known.id, &curves, patch);
            coedges.push(Coedge { edge: known.id, forward, pcurves });
        }
        if let (1, Some(vertex)) = (coedges.len(), lone) {
            return Ok(Loop::Vertex(vertex));
        }
        if coedges.is_empty() {
            return Err(self.doc.bad(ix, ReadIssue::NoEdges));
        }
        let gap = self.build.close(&mut coedges, 2.0 * self.resolution(), source);
        if gap > 0.0 {
            self.doc.warn(ix, ReadIssue::GapClosed { gap: self.doc.millimetres(gap) });
        }
        Ok(Loop::Edges { coedges, outer })
    }

    /// A position in a list, from 0; files count from 1.
    fn position(&self, args: &mut Args<'_>) -> Res<usize> {
        Ok(usize::try_from(args.integer()?.saturating_sub(1)).unwrap_or(usize::MAX))
    }

    /// The curves in parameter space of one use: how many, then each with a flag.
    fn parameter_curves(&self, args: &mut Args<'_>) -> Res<Vec<Ix>> {
        let mut curves = Vec::new();
        for _ in 0..args.count()? {
            args.skip(1);
            curves.extend(args.optional_reference()?);
        }
        Ok(curves)
    }

    /// The curve in parameter space of a use, run as the edge runs; none where it is not where the edge is.
    fn pcurves(&self, edge: EdgeId, curves: &[Ix], patch: &Patch) -> Vec<Pcurve> {
        let ([curve], Some(parameters)) = (curves, patch.parameters) else { return Vec::new() };
        let Ok(found) = segments2(self.doc, *curve, |p_uv| parameters.map(p_uv)) else { return Vec::new() };
        let [segment] = found.as_slice() else { return Vec::new() };
        let edge = &self.build.part.edges[edge.index()];
        let Some(space) = &edge.curve else { return Vec::new() };
        let ends = [edge.range.start, edge.range.end].map(|t| space.point(t));
        let lifted = [0.0, 1.0].map(|share| patch.surface.point(segment.at(share)));
        let along = lifted[0].distance(ends[0]) + lifted[1].distance(ends[1]);
        let against = lifted[0].distance(ends[1]) + lifted[1].distance(ends[0]);
        // On closed edges the ends do not tell: the points a quarter in do.
        let quarter = space.point(edge.range.start + 0.25 * edge.range.length());
        let beside = |share: f64| patch.surface.point(segment.at(share)).distance(quarter);
        let same = if along == against || ends[0] == ends[1] {
            beside(0.25) <= beside(0.75)
        } else {
            along <= against
        };
        let size = ends[0].distance(quarter) + ends[1].distance(quarter);
        if along.min(against) > 0.1 * size { Vec::new() } else { vec![directed(segment, same)] }
    }

    /// 502: how many, points.
    fn vertex_list(&mut self, ix: Ix) -> Res<Arc<[DVec3]>> {
        if let Some(known) = self.vertex_lists.get(&ix) {
            return known.clone();
        }
        let read = || -> Res<Arc<[DVec3]>> {
            if self.doc.kind(ix) != 502 {
                return Err(self.doc.unknown(ix, "a list of vertices"));
            }
            let mut args = self.doc.open(ix)?;
            (0..args.count()?).map(|_| args.point()).collect()
        };
        let list = read();
        self.vertex_lists.insert(ix, list.clone());
        list
    }

    fn vertex(&mut self, list: Ix, position: usize) -> Res<VertexId> {
        if let Some(&known) = self.vertices.get(&(list, position)) {
            return Ok(known);
        }
        let points = self.vertex_list(list)?;
        let point = points.get(position).copied();
        let point = point.ok_or_else(|| {
            self.doc.bad(list, ReadIssue::NotFound { what: "vertex", number: position as i64 + 1 })
        })?;
        let point = (self.by * matrix::of_entity(self.doc, list)?).transform_point3(point);
        let id = self.build.new_vertex(point, self.doc.source(list));
        self.vertices.insert((list, position), id);
        Ok(id)
    }

    /// 504: how many, then curves with both ends.
    fn edge_list(&mut self, ix: Ix) -> Res<Arc<[EdgeRow]>> {
        if let Some(known) = self.edge_lists.get(&ix) {
            return known.clone();
        }
        let read = || -> Res<Arc<[EdgeRow]>> {
            if self.doc.kind(ix) != 504 {
                return Err(self.doc.unknown(ix, "a list of edges"));
            }
            let mut args = self.doc.open(ix)?;
            let row = |args: &mut Args<'_>| {
                let curve = args.reference()?;
                let start = (args.reference()?, self.position(args)?);
                let end = (args.reference()?, self.position(args)?);
                Ok(EdgeRow { curve, ends: [start, end] })
            };
            (0..args.count()?).map(|_| row(&mut args)).collect()
        };
        let list = read();
        self.edge_lists.insert(ix, list.clone());
        list
    }

    /// The edge at a position of a list, built once.
    fn edge(&mut self, list: Ix, position: usize) -> Res<KnownEdge> {
        if let Some(known) = self.edges.get(&(list, position)) {
            return known.clone();
        }
        let made = self.new_edge(list, position);
        self.edges.insert((list, position), made.clone());
        made
    }

    fn new_edge(&mut self, list: Ix, position: usize) -> Res<KnownEdge> {
        let rows = self.edge_list(list)?;
        let row = rows.get(position).copied();
        let row = row.ok_or_else(|| {
            self.doc.bad(list, ReadIssue::NotFound { what: "edge", number: position as i64 + 1 })
        })?;
        let [start, end] = row.ends.map(|(list, position)| self.vertex(list, position));
        let (start, end) = (start?, end?);
        let by = self.by * matrix::of_entity(self.doc, list)?;
        let source = self.doc.source(row.curve);
        let curve = segments(self.doc, row.curve, &by).and_then(|all| joined(self.doc, row.curve, all));
        let (p, q) = (self.build.point_of(start), self.build.point_of(end));
        let why = match curve {
            Ok(segment) => match bounded(segment, p, q, start == end) {
                Some((curve, range, swapped)) => {
                    let (start, end) = if swapped { (end, start) } else { (start, end) };
                    let curve = Some(Arc::new(curve));
                    let id = self.build.push_edge(Edge { curve, range, start, end, source });
                    return Ok(KnownEdge { id, swapped });
                }
                None => Box::new(Issue::error(chordal_brep::Source::default(), ReadIssue::NoCurveBetween)),
            },
            Err(bad) => bad.into_cause(source),
        };
        self.doc.warn(row.curve, ReadIssue::EdgeStraightened { cause: why });
        Ok(KnownEdge { id: self.build.straight_edge(start, end, source), swapped: false })
    }
}

/// The part of a curve between two vertices, and whether it runs from the second to the first.
///
/// The curve's own ends are the vertices in files as they should be; else the vertices are looked for along
/// it.
fn bounded(segment: Segment, p: DVec3, q: DVec3, closed: bool) -> Option<(Curve, Range, bool)> {
    let extent = segment.extent();
    let (a, b) = (segment.start(), segment.end());
    let along = a.distance(p).max(b.distance(q));
    let against = a.distance(q).max(b.distance(p));
    if extent > 0.0 && along.min(against) <= AT_VERTEX * extent {
        return Some((segment.curve, segment.range, against < along));
    }
    let located = locate(&segment.curve, p, q, closed, true)?;
    Some((segment.curve, located.range, located.swapped))
}
