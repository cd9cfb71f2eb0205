//! Extrusions: closed or open profiles moved along a line, with caps or without.
//!
//! Rhino keeps the profiles flat; the path is the z axis of their plane, `up` its y axis. Every piece of a
//! profile becomes a wall; walls and caps share their edges.

use super::bytes::{ANONYMOUS, Bytes, Res};
use super::curves::{Piece, RhinoCurve, Shape, curve_object, profiles};
use crate::assemble::PartBuilder;
use crate::trimmed::Look;
use chordal_brep::{
    Body, BodyKind, Coedge, Edge, EdgeId, Face, FaceGeometry, FaceId, Loop, ReadIssue, Shell, ShellId,
    VertexId,
};
use chordal_nurbs::{Curve, DAffine3, DVec2, DVec3, Frame, NurbsCurve3, Range, Surface, math};
use std::sync::Arc;

struct Extrusion {
    profiles: Vec<RhinoCurve>,
    /// The plane of the first profile, and the way to the end.
    frame: Frame,
    path: DVec3,
    caps: [bool; 2],
}

/// Adds the faces of an extrusion as a body.
pub(super) fn add(builder: &mut PartBuilder, data: Bytes, look: &Look) -> Res<()> {
    let extrusion = read(data)?;
    let mut maker =
        Maker { builder, look, extrusion: &extrusion, faces: Vec::new(), caps: [Vec::new(), Vec::new()] };
    let mut closed = true;
    for (i, profile) in extrusion.profiles.iter().enumerate() {
        closed &= maker.walls(profile, i == 0)?;
    }
    let capped = closed && extrusion.caps == [true; 2];
    if closed {
        maker.caps();
    }
    let faces = maker.faces;
    let part = &mut builder.part;
    let shell = ShellId::from(part.shells.len());
    part.shells.push(Shell { faces, closed: capped, source: look.source });
    part.bodies.push(Body {
        kind: if capped { BodyKind::Solid } else { BodyKind::Sheet },
        shells: vec![shell],
        name: look.name.clone(),
        color: look.color,
        layer: look.layer.clone(),
        source: look.source,
    });
    Ok(())
}

fn read(mut data: Bytes) -> Res<Extrusion> {
    let mut body = data.chunk_of(ANONYMOUS)?;
    let (major, minor) = (body.i32()?, body.i32()?);
    if major != 1 {
        return Err(ReadIssue::UnsupportedVersion { what: "an extrusion", major, minor });
    }
    let start = body;
    body.chunk()?;
    let (from, to) = (body.point()?, body.point()?);
    let along = body.range()?;
    let up = body.point()?;
    let mitred = body.u8()? != 0 || body.u8()? != 0;
    // Normals of the ends, the path's domain, whether parameters are exchanged.
    body.take(48 + 16 + 1)?;
    let count = if minor >= 1 { body.i32()? } else { 1 };
    let caps = if minor >= 2 { [body.u8()? != 0, body.u8()? != 0] } else { [false; 2] };
    if mitred {
        return Err(ReadIssue::Unsupported { what: "extrusion with mitred ends".into() });
    }
    let z = (to - from).try_normalize().ok_or(ReadIssue::NoLength { what: "path of the extrusion" })?;
    let x = up.cross(z).try_normalize().ok_or(ReadIssue::ParallelAxes)?;
    let mut start = start;
    let profiles = if count > 1 { profiles(&mut start)? } else { vec![curve_object(&mut start)?] };
    let frame = Frame::new(from + (to - from) * along.start, z, x);
    Ok(Extrusion { profiles, frame, path: (to - from) * along.length(), caps })
}

struct Maker<'a> {
    builder: &'a mut PartBuilder,
    look: &'a Look,
    extrusion: &'a Extrusion,
    faces: Vec<FaceId>,
    /// The loops of the two caps.
    caps: [Vec<Loop>; 2],
}

impl Maker<'_> {
    /// The walls of a profile; whether it is closed.
    fn walls(&mut self, profile: &RhinoCurve, outer: bool) -> Res<bool> {
        let frame = self.extrusion.frame;
        let placed = |f: &Frame| Frame {
            origin: frame.global(f.origin),
            x: frame.global(f.x) - frame.origin,
            y: frame.global(f.y) - frame.origin,
            z: frame.global(f.z) - frame.origin,
        };
        let mut pieces: Vec<(Curve, Range)> = Vec::new();
        for Piece { shape, own } in &profile.pieces {
            match shape {
                Shape::Nurbs(curve) => {
                    let placed = curve.mapped(|p| frame.global(p));
                    for smooth in smooth_parts(&placed, *own)? {
                        let range = smooth.domain();
                        pieces.push((Curve::Nurbs(smooth), range));
                    }
                }
                Shape::Circle { frame, radius } => {
                    pieces.push((Curve::Circle { frame: placed(frame), radius: *radius }, *own));
                }
            }
        }
        let corners = corners(&pieces);
        let closed = corners.len() == pieces.len();
        let vertices = [DVec3::ZERO, self.extrusion.path].map(|by| {
            corners.iter().map(|&p| self.builder.new_vertex(p + by, self.look.source)).collect::<Vec<_>>()
        });
        let sides: Vec<EdgeId> = (0..corners.len())
            .map(|i| {
                let (a, b) = (vertices[0][i], vertices[1][i]);
                self.builder.straight_edge(a, b, self.look.source)
            })
            .collect();
        // Outer profiles that run clockwise seen against the path, and inner ones that do not, have walls
        // turned over.
        let turned = closed && (area(&pieces, &frame) > 0.0) != outer;
        let mut rims = [Vec::new(), Vec::new()];
        for (i, (curve, range)) in pieces.iter().enumerate() {
            let next = (i + 1) % corners.len();
            let edges = [0, 1].map(|end| self.rim(curve, *range, end, vertices[end][i], vertices[end][next]));
            let [low, high] = edges;
            self.wall(curve, [(low, true), (sides[next], true), (high, false), (sides[i], false)], turned);
            rims[0].push(coedge(low, true));
            rims[1].push(coedge(high, true));
        }
        for (end, rim) in rims.into_iter().enumerate() {
            // Caps look outwards: the one at the start against the path.
            let mut rim = rim;
            if turned != (end == 0) {
                reverse(&mut rim);
            }
            self.caps[end].push(Loop::Edges { coedges: rim, outer });
        }
        Ok(closed)
    }

    fn rim(&mut self, curve: &Curve, range: Range, end: usize, start: VertexId, stop: VertexId) -> EdgeId {
        let by = DAffine3::from_translation(if end == 0 { DVec3::ZERO } else { self.extrusion.path });
        let curve = curve.transformed(&by).map(Arc::new);
        self.builder.push_edge(Edge { curve, range, start, end: stop, source: self.look.source })
    }

    fn wall(&mut self, curve: &Curve, round: [(EdgeId, bool); 4], turned: bool) {
        let mut coedges: Vec<Coedge> =
            round.into_iter().map(|(edge, forward)| coedge(edge, forward)).collect();
        if turned {
            reverse(&mut coedges);
        }
        let surface = Surface::Extrusion { profile: curve.clone(), direction: self.extrusion.path };
        self.face(surface, !turned, vec![Loop::Edges { coedges, outer: true }]);
    }

    fn caps(&mut self) {
        for end in 0..2 {
            let loops = std::mem::take(&mut self.caps[end]);
            if !self.extrusion.caps[end] {
                continue;
            }
            let frame = self.extrusion.frame;
            let origin = frame.origin + if end == 0 { DVec3::ZERO } else { self.extrusion.path };
            self.face(Surface::Plane { frame: Frame { origin, ..frame } }, end == 1, loops);
        }
    }

    fn face(&mut self, surface: Surface, same_sense: bool, loops: Vec<Loop>) {
        self.faces.push(FaceId::from(self.builder.part.faces.len()));
        self.builder.part.faces.push(Face {
            geometry: FaceGeometry::Surface(Arc::new(surface)),
            same_sense,
            flipped: false,
            loops,
            name: self.look.name.clone(),
            color: self.look.color,
            layer: self.look.layer.clone(),
            source: self.look.source,
        });
    }
}

fn coedge(edge: EdgeId, forward: bool) -> Coedge {
    Coedge { edge, forward, pcurves: Vec::new() }
}

fn reverse(coedges: &mut [Coedge]) {
    coedges.reverse();
    coedges.iter_mut().for_each(|coedge| coedge.forward = !coedge.forward);
}

/// A spline cut at its corners.
fn smooth_parts(curve: &NurbsCurve3, own: Range) -> Res<Vec<NurbsCurve3>> {
    let mut stops = vec![own.start];
    let step = 1e-7 * own.length();
    for t in curve.breaks_below(1) {
        let (before, after) =
            (curve.point(t) - curve.point(t - step), curve.point(t + step) - curve.point(t));
        if t > own.start && t < own.end && math::angle_between(before, after) > CORNER {
            stops.push(t);
        }
    }
    stops.push(own.end);
    let part = |pair: &[f64]| curve.piece(Range::new(pair[0], pair[1])).map_err(ReadIssue::from);
    stops.windows(2).map(part).collect()
}

/// Profiles that turn by more than this (radians) at a knot have a corner there, and their walls an edge.
const CORNER: f64 = 0.02;

/// Where pieces begin and, if the last does not end where the first begins, where they end.
fn corners(pieces: &[(Curve, Range)]) -> Vec<DVec3> {
    let mut corners: Vec<DVec3> = pieces.iter().map(|(curve, range)| curve.point(range.start)).collect();
    let Some((curve, range)) = pieces.last() else { return corners };
    let end = curve.point(range.end);
    let size = pieces.iter().fold(0.0f64, |size, (curve, range)| {
        size.max(curve.point(0.5 * (range.start + range.end)).distance(corners[0]))
    });
    // Rhino rounds to about ten digits.
    if end.distance(corners[0]) > 1e-9 * size {
        corners.push(end);
    }
    corners
}

/// The signed area of a profile in its plane, from samples: only the sign is used.
fn area(pieces: &[(Curve, Range)], frame: &Frame) -> f64 {
    const SAMPLES: usize = 32;
    let sample = |curve: &Curve, range: &Range, k: usize| {
        let local = frame.local(curve.point(range.start + range.length() * k as f64 / SAMPLES as f64));
        DVec2::new(local.x, local.y)
    };
    let points: Vec<DVec2> =
        pieces.iter().flat_map(|(curve, range)| (0..SAMPLES).map(move |k| sample(curve, range, k))).collect();
    let n = points.len();
    (0..n).map(|i| (points[i] - points[0]).perp_dot(points[(i + 1) % n] - points[0])).sum::<f64>() * 0.5
}
