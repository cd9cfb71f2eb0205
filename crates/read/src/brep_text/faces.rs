//! Faces: a surface, and wires as loops.

use super::builder::{Builder, PlacedPatch};
use super::locations::Loc;
use super::shapes::{EdgeData, FaceData, Ix, Kind, Orientation, Shape};
use crate::assemble::{Chained, chained};
use crate::trimmed::{self, Look, Piece, Role, TrimLoop};
use chordal_brep::{
    Coedge, Edge, Face, FaceGeometry, FaceId, Loop, Millimetres, Pcurve, ReadIssue, TessellatedItem, VertexId,
};
use chordal_nurbs::{DVec2, UvBox};

/// The vertices of one loop are within this many times the file's tolerance of where its edges end.
const TOLERANCES: f64 = 2.0;

impl Builder<'_> {
    /// Adds the face of a record at a place, `flipped` where its user turns it over; a face that has
    /// triangles but no surface becomes a tessellated item.
    pub(crate) fn face(&mut self, ix: Ix, loc: Loc, flipped: bool) -> Vec<FaceId> {
        let look = Look { flipped, source: self.doc.source(ix), ..Look::default() };
        match self.read_face(ix, loc, &look) {
            Ok(faces) => faces,
            Err(why) => {
                vec![trimmed::add_failed(&mut self.build.part, why, &look)]
            }
        }
    }

    fn read_face(&mut self, ix: Ix, loc: Loc, look: &Look) -> Result<Vec<FaceId>, ReadIssue> {
        let shape = self.shape(ix)?;
        let Kind::Face(data) = &shape.kind else {
            return Err(ReadIssue::UnknownKind { found: "the shape".into(), expected: "a face" });
        };
        let at = self.within(loc, data.location)?;
        if data.surface == 0 {
            return self.triangles(data, at, look);
        }
        let patch = self.patch(data.surface, at)?;
        let mut loops = Vec::new();
        for coedges in self.wires(&shape, data, loc, at, &patch)? {
            loops.extend(self.loops(coedges, look)?);
        }
        if loops.is_empty() {
            return self.whole(&patch, look);
        }
        let id = FaceId::from(self.build.part.faces.len());
        self.build.part.faces.push(Face {
            geometry: FaceGeometry::Surface(patch.surface),
            same_sense: !patch.reversed,
            flipped: look.flipped,
            loops,
            name: String::new(),
            color: None,
            layer: None,
            source: look.source,
        });
        Ok(vec![id])
    }

    /// The uses of edges by each wire of the face.
    fn wires(
        &mut self,
        shape: &Shape,
        data: &FaceData,
        loc: Loc,
        surface_at: Loc,
        patch: &PlacedPatch,
    ) -> Result<Vec<Vec<Coedge>>, ReadIssue> {
        let mut wires = Vec::new();
        for wire in &shape.subs {
            let record = self.shape(wire.shape)?;
            if record.kind != Kind::Wire || wire.orientation == Orientation::Aside {
                // A vertex or a wire within the face bounds nothing.
                continue;
            }
            let at = self.within(loc, wire.location)?;
            let forward = wire.orientation == Orientation::Forward;
            let mut coedges = Vec::new();
            for sub in &record.subs {
                if sub.orientation == Orientation::Aside {
                    continue;
                }
                if !self.spend() {
                    return Err(ReadIssue::TooManyReferences);
                }
                let edge_at = self.within(at, sub.location)?;
                let edge = self.edge(sub.shape, edge_at)?;
                let forward = forward == (sub.orientation == Orientation::Forward);
                let pcurves = match self.shape(sub.shape)?.kind {
                    Kind::Edge(edge) => {
                        self.pcurves(&edge, edge_at, data.surface, surface_at, forward, patch)
                    }
                    _ => Vec::new(),
                };
                coedges.push(Coedge { edge, forward, pcurves });
            }
            if !forward {
                coedges.reverse();
            }
            if !coedges.is_empty() {
                wires.push(coedges);
            }
        }
        Ok(wires)
    }

    /// The edge's curve in the parameter space of the face: along a seam, that of this side.
    fn pcurves(
        &mut self,
        edge: &EdgeData,
        edge_at: Loc,
        surface: i64,
        surface_at: Loc,
        forward: bool,
        patch: &PlacedPatch,
    ) -> Vec<Pcurve> {
        let same_surface = |all: &EdgeData| -> Vec<usize> {
            (0..all.on_surfaces.len()).filter(|&i| all.on_surfaces[i].surface == surface).collect()
        };
        let candidates = same_surface(edge);
        let here = candidates
            .iter()
            .copied()
            .find(|&i| self.within(edge_at, edge.on_surfaces[i].location).is_ok_and(|at| at == surface_at));
        let Some(i) = here.or(candidates.first().copied()) else { return Vec::new() };
        let found = &edge.on_surfaces[i];
        self.pcurve(found.curves[usize::from(!forward)], found.range, patch).into_iter().collect()
    }

    /// The loops that the edges of one wire make.
    fn loops(&mut self, coedges: Vec<Coedge>, look: &Look) -> Result<Vec<Loop>, ReadIssue> {
        let part = &self.build.part;
        let Chained { mut closed, open, sorted } =
            chained(coedges, |c| ends(&part.edges, c), |a, b| jump(a, b).unwrap_or(f64::INFINITY));
        let was_open = !open.is_empty();
        let stated = TOLERANCES * self.build.part.uncertainty.unwrap_or(0.0);
        if was_open {
            let mut joined: Vec<Coedge> = open.into_iter().flatten().collect();
            let gap = self.build.close(&mut joined, stated, look.source);
            if gap > 0.0 {
                let what = ReadIssue::GapClosed { gap: Millimetres(gap) };
                self.doc.notes.warn(look.source, what);
            }
            closed.push(joined);
        } else if sorted && closed.len() > 1 {
            let what = ReadIssue::WireIsLoops { loops: closed.len() };
            self.doc.notes.warn(look.source, what);
        }
        Ok(closed.into_iter().map(|coedges| Loop::Edges { coedges, outer: false }).collect())
    }

    /// A face without wires: all of its surface, or the rectangle that it is trimmed to.
    fn whole(&mut self, patch: &PlacedPatch, look: &Look) -> Result<Vec<FaceId>, ReadIssue> {
        let trims: Vec<TrimLoop> = patch.trims.into_iter().map(|uv| rectangle(uv, look)).collect();
        if trims.is_empty() && !patch.surface.domain().is_finite() {
            return Err(ReadIssue::NoBoundary);
        }
        let look = Look { flipped: look.flipped != patch.reversed, ..look.clone() };
        let faces = trimmed::add_faces(&mut self.build.part, &patch.surface, &trims, &look, &self.doc.notes);
        Ok(faces)
    }

    /// A face that is nothing but triangles.
    fn triangles(&mut self, data: &FaceData, at: Loc, look: &Look) -> Result<Vec<FaceId>, ReadIssue> {
        if data.triangulation == 0 {
            return Err(ReadIssue::NoSurface);
        }
        let found = super::document::numbered(&self.doc.triangulations, data.triangulation, "triangulation")?;
        let by = self.doc.locations.matrix(at);
        let turned = look.flipped != (by.matrix3.determinant() < 0.0);
        let normal_by = by.matrix3.inverse().transpose();
        let side = if look.flipped { -1.0 } else { 1.0 };
        let triangles = found.triangles.iter().map(|&[a, b, c]| if turned { [a, c, b] } else { [a, b, c] });
        let item = TessellatedItem {
            points: found.points.iter().map(|&p| by.transform_point3(p)).collect(),
            triangles: triangles.collect(),
            normals: found.normals.iter().map(|&n| (normal_by * n).normalize_or_zero() * side).collect(),
            source: look.source,
            ..TessellatedItem::default()
        };
        self.build.part.tessellated.push(item);
        Ok(Vec::new())
    }
}

fn ends(edges: &[Edge], coedge: &Coedge) -> (VertexId, VertexId) {
    let edge = &edges[coedge.edge.index()];
    if coedge.forward { (edge.start, edge.end) } else { (edge.end, edge.start) }
}

/// The distance in parameter space from the end of one coedge to the start of another.
fn jump(from: &Coedge, to: &Coedge) -> Option<f64> {
    let at = |coedge: &Coedge, at_start: bool| -> Option<DVec2> {
        let pcurve = coedge.pcurves.first()?;
        let t = if at_start == coedge.forward { pcurve.range.start } else { pcurve.range.end };
        Some(pcurve.curve.point(t))
    };
    Some(at(from, false)?.distance(at(to, true)?)).filter(|d| d.is_finite())
}

fn rectangle(uv: UvBox, look: &Look) -> TrimLoop {
    let corners = [uv.min, DVec2::new(uv.max.x, uv.min.y), uv.max, DVec2::new(uv.min.x, uv.max.y)];
    let pieces = (0..4).map(|k| Piece::line(corners[k], corners[(k + 1) % 4])).collect();
    TrimLoop { pieces, role: Role::Outer, source: look.source }
}
