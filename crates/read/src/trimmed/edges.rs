//! Pieces of closed chains as edges of a part.
//!
//! A piece along the border of a spline surface becomes the exact curve of its control points there; others
//! are given as curves on the surface. A piece along one side of a closed surface and the one along the other
//! are one edge.

use super::chain::Chain;
use super::meet::ONE_PLACE;
use super::{Piece, Scale};
use chordal_brep::{Coedge, Edge, EdgeId, Loop, Part, Pcurve, Source, Vertex, VertexId};
use chordal_nurbs::{Curve, Curve2, DVec2, DVec3, Frame, NurbsCurve3, NurbsSurface, Pole, Range, Surface};
use std::sync::Arc;

/// Parameters nearer than this share of the domain to one of its sides lie on it.
const ON_SIDE: f64 = 1e-9;

/// Points nearer than this share of the surface's size are one where the surface closes or ends in a pole, as
/// `chordal_nurbs` has it.
const ONE_POINT: f64 = 1e-7;

/// Adds the edges of the chains of one face; the face's loops.
pub(super) fn loops(part: &mut Part, surface: &Arc<Surface>, chains: Vec<Chain>, scale: &Scale) -> Vec<Loop> {
    let mut maker = Maker {
        part,
        surface,
        scale,
        poles: surface.poles(),
        size: size(surface, &chains),
        border: Vec::new(),
        touched: Vec::new(),
        seams: Vec::new(),
    };
    chains
        .iter()
        .map(|chain| Loop::Edges { coedges: maker.chain(chain), outer: chain.role != super::Role::Hole })
        .collect()
}

/// A rough size of the face in space.
fn size(surface: &Surface, chains: &[Chain]) -> f64 {
    let points: Vec<DVec3> = match surface {
        Surface::Nurbs(nurbs) => nurbs.points().to_vec(),
        _ => chains.iter().flat_map(|c| &c.pieces).map(|piece| surface.point(piece.at(0.5))).collect(),
    };
    points.first().map_or(0.0, |first| points.iter().fold(0.0, |d: f64, p| d.max(p.distance(*first))))
}

/// An edge along a side of the domain where the surface closes.
struct Seam {
    edge: EdgeId,
    axis: usize,
    range: Range,
}

struct Maker<'a> {
    part: &'a mut Part,
    surface: &'a Arc<Surface>,
    scale: &'a Scale,
    poles: Vec<Pole>,
    size: f64,
    /// Vertices on sides of the domain that close or are poles: there different parameters may be one point.
    border: Vec<VertexId>,
    /// Vertices of loops that meet in vertices, in the unit square.
    touched: Vec<(DVec2, VertexId)>,
    seams: Vec<Seam>,
}

/// A piece that lies on a side of the domain.
struct OnSide {
    /// The parameter that stays as it is.
    axis: usize,
    value: f64,
    /// The other parameter, in increasing order.
    range: Range,
    /// The piece runs towards greater values of it.
    ascends: bool,
}

impl OnSide {
    /// The line along the side, with the other parameter as its own: both sides of a seam have the same.
    fn line(&self) -> Arc<Curve2> {
        let (mut origin, mut direction) = (DVec2::ZERO, DVec2::ZERO);
        origin[self.axis] = self.value;
        direction[1 - self.axis] = 1.0;
        Arc::new(Curve2::Line { origin, direction })
    }
}

impl Maker<'_> {
    fn chain(&mut self, chain: &Chain) -> Vec<Coedge> {
        let n = chain.pieces.len();
        let vertices: Vec<VertexId> =
            chain.pieces.iter().map(|piece| self.vertex_of(chain, piece.at(0.0))).collect();
        (0..n)
            .map(|i| self.coedge(&chain.pieces[i], [vertices[i], vertices[(i + 1) % n]], chain.source))
            .collect()
    }

    /// The vertex of a chain at a place; chains that meet there share it.
    fn vertex_of(&mut self, chain: &Chain, p_uv: DVec2) -> VertexId {
        if !chain.touches {
            return self.vertex(p_uv, chain.source);
        }
        let place = self.scale.unit(p_uv);
        if let Some((_, known)) = self.touched.iter().find(|(p, _)| p.distance(place) <= ONE_PLACE) {
            return *known;
        }
        let id = self.vertex(p_uv, chain.source);
        self.touched.push((place, id));
        id
    }

    fn vertex(&mut self, p_uv: DVec2, source: Source) -> VertexId {
        let point = self.surface.point(p_uv);
        let on_border = (0..2).any(|axis| self.side_value(axis, p_uv[axis]).is_some());
        if on_border {
            let near =
                |v: &&VertexId| self.part.vertices[v.index()].point.distance(point) <= ONE_POINT * self.size;
            if let Some(&known) = self.border.iter().find(near) {
                return known;
            }
        }
        let id = VertexId::from(self.part.vertices.len());
        self.part.vertices.push(Vertex { point, source });
        if on_border {
            self.border.push(id);
        }
        id
    }

    /// The end of the domain that a parameter is at.
    fn side_value(&self, axis: usize, t: f64) -> Option<f64> {
        let domain = self.surface.domain();
        let tiny = ON_SIDE * self.scale.uv.size()[axis];
        [domain.min[axis], domain.max[axis]].into_iter().find(|end| (end - t).abs() <= tiny)
    }

    fn on_side(&self, piece: &Piece) -> Option<OnSide> {
        const PROBES: u32 = 8;
        (0..2).find_map(|axis| {
            let value = self.side_value(axis, piece.at(0.0)[axis])?;
            let probes: Vec<DVec2> =
                (0..=PROBES).map(|k| piece.at(f64::from(k) / f64::from(PROBES))).collect();
            if probes.iter().any(|p| self.side_value(axis, p[axis]) != Some(value)) {
                return None;
            }
            let along: Vec<f64> = probes.iter().map(|p| p[1 - axis]).collect();
            let ascends = along[along.len() - 1] > along[0];
            let monotone = along.windows(2).all(|pair| (pair[1] > pair[0]) == ascends && pair[1] != pair[0]);
            let (a, b) = (along[0], along[along.len() - 1]);
            monotone.then(|| OnSide { axis, value, range: Range::new(a.min(b), a.max(b)), ascends })
        })
    }

    fn coedge(&mut self, piece: &Piece, ends: [VertexId; 2], source: Source) -> Coedge {
        let side = self.on_side(piece);
        if let Some(side) = &side
            && ends[0] == ends[1]
            && self.poles.iter().any(|pole| pole.axis == side.axis && pole.value == side.value)
        {
            return self.point_edge(ends[0], source);
        }
        let (curve, pcurve, range, forward) = match &side {
            Some(side) => {
                let line = side.line();
                (
                    self.border_curve(side).unwrap_or_else(|| self.lifted(&line)),
                    line,
                    side.range,
                    side.ascends,
                )
            }
            None => (self.lifted(&piece.curve), piece.curve.clone(), piece.range, piece.forward),
        };
        let pcurves = vec![Pcurve { curve: pcurve, range }];
        let seam = side.as_ref().and_then(|side| self.known_seam(side));
        if let Some(seam) = seam.filter(|seam| self.joins(*seam, ends, forward)) {
            return Coedge { edge: seam, forward, pcurves };
        }
        let edge = EdgeId::from(self.part.edges.len());
        let [start, end] = if forward { ends } else { [ends[1], ends[0]] };
        self.part.edges.push(Edge { curve: Some(Arc::new(curve)), range, start, end, source });
        if let Some(side) = side
            && self.scale.periods[side.axis].is_some()
        {
            self.seams.push(Seam { edge, axis: side.axis, range: side.range });
        }
        Coedge { edge, forward, pcurves }
    }

    /// True where an edge run this way begins and ends in these vertices.
    fn joins(&self, edge: EdgeId, ends: [VertexId; 2], forward: bool) -> bool {
        let edge = &self.part.edges[edge.index()];
        ends == if forward { [edge.start, edge.end] } else { [edge.end, edge.start] }
    }

    /// An edge that is a single point.
    fn point_edge(&mut self, vertex: VertexId, source: Source) -> Coedge {
        let edge = EdgeId::from(self.part.edges.len());
        let range = Range::new(0.0, 1.0);
        self.part.edges.push(Edge { curve: None, range, start: vertex, end: vertex, source });
        Coedge { edge, forward: true, pcurves: Vec::new() }
    }

    /// The edge along the opposite side of a closed surface.
    fn known_seam(&self, side: &OnSide) -> Option<EdgeId> {
        self.scale.periods[side.axis]?;
        let tiny = ON_SIDE * self.scale.uv.size()[1 - side.axis];
        let same = |a: Range, b: Range| (a.start - b.start).abs() <= tiny && (a.end - b.end).abs() <= tiny;
        self.seams.iter().find(|s| s.axis == side.axis && same(s.range, side.range)).map(|s| s.edge)
    }

    /// The curve along a side of a spline surface, with the other parameter as its own.
    fn border_curve(&self, side: &OnSide) -> Option<Curve> {
        let Surface::Nurbs(nurbs) = self.surface.as_ref() else { return None };
        side_curve(nurbs, side.axis, side.value).map(Curve::Nurbs)
    }

    /// A curve of parameter space in space: exact and simple on planes.
    fn lifted(&self, curve: &Arc<Curve2>) -> Curve {
        if let Surface::Plane { frame } = self.surface.as_ref()
            && let Some(curve) = on_plane(frame, curve)
        {
            return curve;
        }
        Curve::OnSurface { surface: self.surface.clone(), curve: Box::new(curve.as_ref().clone()) }
    }
}

fn on_plane(frame: &Frame, curve: &Curve2) -> Option<Curve> {
    let direction = |d: DVec2| frame.x * d.x + frame.y * d.y;
    let point = |p: DVec2| frame.origin + direction(p);
    Some(match curve {
        Curve2::Line { origin, direction: d } => {
            Curve::Line { origin: point(*origin), direction: direction(*d) }
        }
        Curve2::Nurbs(nurbs) => Curve::Nurbs(nurbs.mapped(point)),
        Curve2::Polyline(points) => Curve::Polyline(points.iter().map(|&p| point(p)).collect()),
        Curve2::Circle { frame: f, radius } => {
            let (x, y) = (direction(f.x), direction(f.y));
            let frame = Frame { origin: point(f.origin), x, y, z: x.cross(y) };
            Curve::Circle { frame, radius: *radius }
        }
        _ => return None,
    })
}

/// The control points along a side, where the surface's knots let it interpolate them.
fn side_curve(nurbs: &NurbsSurface, axis: usize, value: f64) -> Option<NurbsCurve3> {
    let [count_u, count_v] = nurbs.counts();
    let degrees = nurbs.degree();
    let (knots, other) =
        if axis == 0 { (nurbs.knots_u(), nurbs.knots_v()) } else { (nurbs.knots_v(), nurbs.knots_u()) };
    let count = if axis == 0 { count_u } else { count_v };
    let degree = degrees[axis];
    let low = knots[1] == value && knots[degree] == value;
    let high = knots[count] == value && knots[count + degree - 1] == value;
    let row = if low {
        0
    } else if high {
        count - 1
    } else {
        return None;
    };
    let indices: Vec<usize> = if axis == 0 {
        (0..count_v).map(|j| row * count_v + j).collect()
    } else {
        (0..count_u).map(|i| i * count_v + row).collect()
    };
    let points = indices.iter().map(|&k| nurbs.points()[k]).collect();
    let weights = nurbs.weights().map(|w| indices.iter().map(|&k| w[k]).collect());
    NurbsCurve3::new(degrees[1 - axis], other.to_vec(), points, weights).ok()
}
