//! A boundary representation of the archive as faces, edges and vertices of a part.

use super::brep::{CurveUse, RawBrep, RawFace, RawTrim};
use super::bytes::Res;
use super::curves::{RhinoCurve, Stops};
use super::surfaces::RhinoSurface;
use crate::assemble::Notes;
use crate::assemble::PartBuilder;
use crate::trimmed::Look;
use chordal_brep::{
    Body, BodyKind, Coedge, Edge, EdgeId, Face, FaceGeometry, FaceId, Issue, Loop, Millimetres, Pcurve,
    ReadIssue, Real, Shell, ShellId, VertexId,
};
use chordal_nurbs::{Curve, Curve2, DVec3, Range};
use std::sync::Arc;

/// An edge of the part and how it came about.
#[derive(Clone, Copy, Debug)]
struct Made {
    id: EdgeId,
    /// It runs against Rhino's.
    turned: bool,
}

struct Maker<'a> {
    raw: &'a RawBrep,
    builder: &'a mut PartBuilder,
    notes: &'a Notes,
    look: &'a Look,
    vertices: Vec<VertexId>,
    edges: Vec<Option<Made>>,
    curves: Vec<Option<(Arc<Curve>, Stops)>>,
    /// Vertices that were found at the ends of curves.
    found: Vec<VertexId>,
    /// Such vertices are one within this distance.
    rounding: f64,
    /// Millimetres of the file's unit.
    millimetres: f64,
}

/// Ends of curves nearer than this part of the object's size are one vertex: they differ by rounding.
const SAME_POINT: f64 = 1e-9;

/// Adds all faces as a body.
pub(super) fn add(builder: &mut PartBuilder, raw: &RawBrep, look: &Look, notes: &Notes, millimetres: f64) {
    let vertices = raw.vertices.iter().map(|&point| builder.new_vertex(point, look.source)).collect();
    let curves = raw.curves.iter().map(|curve| {
        let (curve, stops) = curve.as_ref().ok()?.in_space();
        Some((Arc::new(curve), stops))
    });
    let curves = curves.collect();
    let edges = vec![None; raw.edges.len()];
    let found = Vec::new();
    let rounding = SAME_POINT * size(raw);
    let mut maker =
        Maker { raw, builder, notes, look, vertices, edges, curves, found, rounding, millimetres };
    let faces: Vec<FaceId> = raw.faces.iter().enumerate().map(|(i, face)| maker.face(i, face)).collect();
    let closed = matches!(raw.solid, 1 | 2) || pairs_up(raw);
    let part = &mut maker.builder.part;
    let shell = ShellId::from(part.shells.len());
    part.shells.push(Shell { faces, closed, source: look.source });
    part.bodies.push(Body {
        kind: if closed { BodyKind::Solid } else { BodyKind::Sheet },
        shells: vec![shell],
        name: look.name.clone(),
        color: look.color,
        layer: look.layer.clone(),
        source: look.source,
    });
}

/// A rough size: how far control points lie from the first.
fn size(raw: &RawBrep) -> f64 {
    let mut points = raw.curves.iter().flatten().flat_map(RhinoCurve::reach);
    let Some(first) = points.next() else { return 0.0 };
    points.fold(0.0, |size, p| size.max(p.distance(first)))
}

fn at<'a, T>(list: &'a [T], index: i32, what: &'static str) -> Res<&'a T> {
    let found = usize::try_from(index).ok().and_then(|i| list.get(i));
    found.ok_or_else(|| ReadIssue::NotFound { what, number: i64::from(index) })
}

fn sound<'a, T>(list: &'a [Res<T>], index: i32, what: &'static str) -> Res<&'a T> {
    at(list, index, what)?.as_ref().map_err(|why| why.clone().within(what, index as usize))
}

impl Maker<'_> {
    /// Adds a face, failed or not.
    fn face(&mut self, place: usize, raw: &RawFace) -> FaceId {
        let (geometry, same_sense, loops) = match self.trimmed(raw) {
            Ok((surface, loops)) => {
                let same_sense = raw.reversed == surface.turned_over();
                (FaceGeometry::Surface(Arc::new(surface.surface.clone())), same_sense, loops)
            }
            Err(why) => {
                let reason = why.within("face", place);
                (FaceGeometry::Failed(Issue::error(self.look.source, reason)), true, Vec::new())
            }
        };
        let id = FaceId::from(self.builder.part.faces.len());
        self.builder.part.faces.push(Face {
            geometry,
            same_sense,
            // Closed, but with its normals inwards.
            flipped: self.raw.solid == 2,
            loops,
            name: self.look.name.clone(),
            color: raw.color.or(self.look.color),
            layer: self.look.layer.clone(),
            source: self.look.source,
        });
        id
    }

    fn trimmed(&mut self, raw: &RawFace) -> Res<(RhinoSurface, Vec<Loop>)> {
        let surface = sound(&self.raw.surfaces, raw.surface, "surface")?.clone();
        let mut loops = Vec::new();
        for &index in &raw.loops {
            let boundary = at(&self.raw.loops, index, "loop")?;
            if boundary.kind > 3 {
                // Curves and points on the face, which bound nothing.
                continue;
            }
            let mut coedges = Vec::new();
            for &trim in &boundary.trims {
                let trim = at(&self.raw.trims, trim, "trim")?;
                coedges.extend(self.coedge(trim, &surface)?);
            }
            if coedges.is_empty() {
                continue;
            }
            let gap = self.builder.close(&mut coedges, 0.0, self.look.source);
            if gap > 0.0 {
                self.notes.warn(
                    self.look.source,
                    ReadIssue::GapClosed { gap: Millimetres(gap * self.millimetres) },
                );
            }
            // Rhino's loops are oriented by the surface's normal, not the face's.
            if raw.reversed {
                coedges.reverse();
                coedges.iter_mut().for_each(|coedge| coedge.forward = !coedge.forward);
            }
            loops.push(Loop::Edges { coedges, outer: boundary.kind != 2 });
        }
        if loops.is_empty() {
            return Err(ReadIssue::NoBoundary);
        }
        Ok((surface, loops))
    }

    /// A trim in the direction of its loop; none where it is a point of which nothing is known.
    fn coedge(&mut self, trim: &RawTrim, surface: &RhinoSurface) -> Res<Option<Coedge>> {
        let curve = sound(&self.raw.curves_2d, trim.curve, "trim curve");
        if trim.edge < 0 {
            let vertex = match (at(&self.vertices, trim.vertices[0], "vertex"), curve) {
                (Ok(&vertex), _) => vertex,
                (Err(_), Ok(curve)) => self.end_of(curve, &trim.proxy, surface, 0.0),
                (Err(_), Err(why)) => return Err(why),
            };
            return Ok(Some(self.point_edge(vertex)));
        }
        let pcurve = curve.and_then(|curve| pcurve(curve, &trim.proxy, surface));
        let made = self.edge(trim)?;
        // Rhino's edges have the direction of their trims unless a flag reverses them.
        let forward = !trim.against ^ made.turned;
        let pcurves = match pcurve {
            Ok((curve, range)) => vec![along_edge(curve, range, forward != trim.proxy.reversed)],
            Err(why) => {
                self.notes.warn(self.look.source, ReadIssue::PcurveRecomputed { cause: why.boxed() });
                Vec::new()
            }
        };
        Ok(Some(Coedge { edge: made.id, forward, pcurves }))
    }

    /// The edge of a trim, made once.
    fn edge(&mut self, trim: &RawTrim) -> Res<Made> {
        let raw = at(&self.raw.edges, trim.edge, "edge")?;
        let place = trim.edge as usize;
        if let Some(made) = self.edges[place] {
            return Ok(made);
        }
        let domain = sound(&self.raw.curves, raw.curve, "curve")?.domain();
        let (curve, stops) = self.curves[raw.curve as usize]
            .clone()
            .ok_or(ReadIssue::Missing { what: "curve of the edge" })?;
        let range = stops.range(part_of(&raw.proxy, domain));
        if !(range.is_finite() && range.start < range.end) {
            return Err(ReadIssue::EmptyRange { start: Real(range.start), end: Real(range.end) }
                .within("edge", place));
        }
        let turned = raw.proxy.reversed;
        let [first, last] = if turned { [raw.vertices[1], raw.vertices[0]] } else { raw.vertices };
        let (start, end) = (self.vertex(first, &curve, range.start), self.vertex(last, &curve, range.end));
        let source = self.look.source;
        let id = self.builder.push_edge(Edge { curve: Some(curve), range, start, end, source });
        let made = Made { id, turned };
        self.edges[place] = Some(made);
        Ok(made)
    }

    /// A vertex of the list, or where there is none a new one at a point of the curve.
    fn vertex(&mut self, index: i32, curve: &Curve, t: f64) -> VertexId {
        match at(&self.vertices, index, "vertex") {
            Ok(&vertex) => vertex,
            Err(_) => self.vertex_at(curve.point(t)),
        }
    }

    fn end_of(
        &mut self,
        curve: &RhinoCurve,
        proxy: &CurveUse,
        surface: &RhinoSurface,
        share: f64,
    ) -> VertexId {
        let (flat, stops) = curve.in_plane();
        let range = part_of(proxy, curve.domain());
        let p_uv = surface.parameters(flat.point(stops.at(range.start + share * range.length())));
        self.vertex_at(surface.surface.point(p_uv))
    }

    /// The vertex at a point, made where there is none yet.
    fn vertex_at(&mut self, point: DVec3) -> VertexId {
        let near = |v: &&VertexId| self.builder.point_of(**v).distance(point) <= self.rounding;
        if let Some(&known) = self.found.iter().find(near) {
            return known;
        }
        let vertex = self.builder.new_vertex(point, self.look.source);
        self.found.push(vertex);
        vertex
    }

    /// An edge that is a single point.
    fn point_edge(&mut self, vertex: VertexId) -> Coedge {
        let (range, source) = (Range::new(0.0, 1.0), self.look.source);
        let edge = self.builder.push_edge(Edge { curve: None, range, start: vertex, end: vertex, source });
        Coedge { edge, forward: true, pcurves: Vec::new() }
    }
}

/// True where two trims of loops run along every edge, one each way: old files do not say that they are
/// closed.
fn pairs_up(raw: &RawBrep) -> bool {
    let mut uses = vec![[0u32; 2]; raw.edges.len()];
    for face in &raw.faces {
        let loops = face.loops.iter().filter_map(|&l| at(&raw.loops, l, "loop").ok());
        let trims = loops.flat_map(|l| &l.trims).filter_map(|&t| at(&raw.trims, t, "trim").ok());
        for trim in trims.filter(|trim| trim.edge >= 0) {
            let Some(count) = uses.get_mut(trim.edge as usize) else { return false };
            count[usize::from(trim.against != face.reversed)] += 1;
        }
    }
    !uses.is_empty() && uses.iter().all(|count| *count == [1, 1])
}

/// The part of a curve's domain that is used.
fn part_of(proxy: &CurveUse, domain: Range) -> Range {
    match proxy.range {
        Some(range) => Range::new(domain.clamp(range.start), domain.clamp(range.end)),
        None => domain,
    }
}

/// A trim's curve in our surface's parameters, in its own direction.
fn pcurve(curve: &RhinoCurve, proxy: &CurveUse, surface: &RhinoSurface) -> Res<(Curve2, Range)> {
    let (flat, stops) = curve.in_plane();
    let range = stops.range(part_of(proxy, curve.domain()));
    if !(range.is_finite() && range.start < range.end) {
        return Err(ReadIssue::EmptyRange { start: Real(range.start), end: Real(range.end) });
    }
    surface.trim(flat, range)
}

/// The curve in the direction of the edge.
fn along_edge(curve: Curve2, range: Range, with_edge: bool) -> Pcurve {
    if with_edge {
        return Pcurve { curve: Arc::new(curve), range };
    }
    let turned = Curve2::Composite(vec![(curve, range.end, range.start)]);
    Pcurve { curve: Arc::new(turned), range: Range::new(0.0, 1.0) }
}
