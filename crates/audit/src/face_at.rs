//! A face of the file seen from one of its facets: which point of its surface lies under a place, and where
//! points of the surface lie relative to the face.

use crate::chart::exact;
use crate::precision::{ROUNDING, surface_magnitude};
use chordal_brep::{Face, FaceGeometry, Loop, Part, VertexId};
use chordal_mesh::{FaceMesh, Origin, PartMesh};
use chordal_nurbs::{CurveInverter, DVec2, DVec3, Surface};
use std::borrow::Cow;

/// Steps towards the foot of a point: facets are near their surfaces, and a few digits suffice.
const FOOT_STEPS: usize = 4;

/// A point is inside a face if it is farther from its edges than this many times what edges and chords are
/// off.
const INSIDE: f64 = 2.0;

/// Parameters that differ by less than this share of the parameters of the face are one point of a face that
/// cuts itself.
const SAME_PARAMETERS: f64 = 1e-6;

/// The sine of the angle between two directions in the surface that count as one.
const ALONG: f64 = 0.5;

/// Where a point of the surface lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Place {
    /// In the face, clear of its edges.
    Inside,
    /// On an edge of the face, up to rounding.
    Border,
    /// Outside, or too near to an edge to tell.
    Elsewhere,
}

/// A face seen from one of its facets.
pub(crate) struct FaceAt<'a> {
    pub part: &'a Part,
    pub index: usize,
    pub surface: Cow<'a, Surface>,
    mesh: &'a PartMesh,
    facet: u32,
    periods: [Option<f64>; 2],
    /// The largest distance of a vertex of an edge from the surface.
    gap: f64,
    /// What a point of the surface may be off by rounding.
    pub rounding: f64,
}

/// The point of an edge that is nearest to a point.
struct NearestOnEdge {
    edge: usize,
    point: DVec3,
    distance: f64,
    /// The distance of the point from the chords of the edge.
    off_chords: f64,
    /// It is an end of the edge.
    is_end: bool,
}

impl<'a> FaceAt<'a> {
    /// `None` for a face without a surface.
    pub fn new(part: &'a Part, mesh: &'a PartMesh, index: usize, facet: u32) -> Option<Self> {
        let FaceGeometry::Surface(surface) = &part.faces[index].geometry else { return None };
        let surface = exact(surface);
        let periods = surface.periods();
        let mut face = Self { part, index, surface, mesh, facet, periods, gap: 0.0, rounding: 0.0 };
        let size = face.corners(facet).iter().fold(0.0f64, |m, c| m.max(c.1.abs().max_element()));
        face.rounding = ROUNDING * (size + surface_magnitude(&face.surface));
        face.gap = face.largest_gap();
        Some(face)
    }

    fn face(&self) -> &'a Face {
        &self.part.faces[self.index]
    }

    fn of_mesh(&self) -> &'a FaceMesh {
        &self.mesh.faces[self.index]
    }

    fn corners(&self, triangle: u32) -> [(DVec2, DVec3); 3] {
        let of_face = self.of_mesh();
        of_face.triangles[triangle as usize].map(|c| {
            let corner = of_face.corners[c as usize];
            (corner.uv, self.mesh.positions[corner.position as usize])
        })
    }

    /// The linear parameters at a point of the plane of the facet.
    pub fn parameters_in_facet(&self, at: DVec3) -> DVec2 {
        let [a, b, c] = self.corners(self.facet);
        let (d, e, p) = (b.1 - a.1, c.1 - a.1, at - a.1);
        let (dd, de, ee) = (d.dot(d), d.dot(e), e.dot(e));
        let determinant = dd * ee - de * de;
        let x = (p.dot(d) * ee - p.dot(e) * de) / determinant;
        let y = (p.dot(e) * dd - p.dot(d) * de) / determinant;
        if x.is_finite() && y.is_finite() { a.0 + (b.0 - a.0) * x + (c.0 - a.0) * y } else { a.0 }
    }

    /// The parameters of the point of the surface under a point near the facet, by Gauss and Newton: the
    /// nearest one of all may lie on the other side of a wall.
    pub fn foot(&self, at: DVec3) -> DVec2 {
        let mut uv = self.parameters_in_facet(at);
        for _ in 0..FOOT_STEPS {
            let (p, du, dv) = self.surface.jet1(uv);
            let (uu, uv_, vv) = (du.dot(du), du.dot(dv), dv.dot(dv));
            let (u, v, determinant) = (du.dot(at - p), dv.dot(at - p), uu * vv - uv_ * uv_);
            let step = DVec2::new(u * vv - v * uv_, v * uu - u * uv_) / determinant;
            if !step.is_finite() {
                break;
            }
            uv += step;
        }
        uv
    }

    /// The normal of the facet, not of unit length.
    pub fn normal_of_facet(&self) -> DVec3 {
        let [a, b, c] = self.corners(self.facet).map(|c| c.1);
        (b - a).cross(c - a)
    }

    pub fn size_of_facet(&self) -> f64 {
        let [a, b, c] = self.corners(self.facet).map(|c| c.1);
        a.distance(b).max(b.distance(c)).max(c.distance(a))
    }

    /// The largest distance of a corner of the facet from the surface.
    pub fn gap_of_facet(&self) -> f64 {
        let gap = |(uv, p): (DVec2, DVec3)| self.surface.point(uv).distance(p);
        self.corners(self.facet).map(gap).into_iter().fold(0.0, f64::max)
    }

    fn largest_gap(&self) -> f64 {
        let of_face = self.of_mesh();
        let at_edge =
            |c: &&chordal_mesh::Corner| !matches!(self.mesh.origins[c.position as usize], Origin::Face(_));
        let gap = |c: &chordal_mesh::Corner| {
            self.surface.point(c.uv).distance(self.mesh.positions[c.position as usize])
        };
        of_face.corners.iter().filter(at_edge).map(gap).fold(0.0, f64::max)
    }

    /// True where two parameters are the same point of the surface, up to full turns.
    pub fn is_same_place(&self, uv: DVec2, other: DVec2) -> bool {
        (0..2).all(|axis| {
            let d = uv[axis] - other[axis];
            let d = d - self.periods[axis].map_or(0.0, |p| p * (d / p).round());
            d.abs() <= SAME_PARAMETERS * (1.0 + uv[axis].abs())
        })
    }

    /// The indices of its edges, as often as its loops use them.
    pub fn edges(&self) -> impl Iterator<Item = usize> + '_ {
        let edges = self.face().loops.iter().flat_map(|a_loop| match a_loop {
            Loop::Edges { coedges, .. } => coedges.as_slice(),
            _ => &[],
        });
        edges.map(|coedge| coedge.edge.index())
    }

    /// The vertices of its loops.
    pub fn vertices(&self) -> Vec<VertexId> {
        let ends = self.edges().flat_map(|e| [self.part.edges[e].start, self.part.edges[e].end]);
        let lone = self.face().loops.iter().flat_map(|a_loop| match a_loop {
            Loop::Vertex(vertex) => std::slice::from_ref(vertex),
            Loop::Polygon { vertices, .. } => vertices.as_slice(),
            Loop::Edges { .. } => &[],
        });
        ends.chain(lone.copied()).collect()
    }

    /// How far from an edge a point must be that is known but for `error`, so that it is not on the edge.
    pub fn margin(&self, error: f64) -> f64 {
        INSIDE * self.gap + error
    }

    /// Where a point of the surface lies that is known but for `error`.
    pub fn place(&self, uv: DVec2, p: DVec3, error: f64) -> Place {
        let near = self.nearest_on_edges(p);
        let Some(nearest) = near.iter().min_by(|a, b| a.distance.total_cmp(&b.distance)) else {
            return if self.is_covered(uv) { Place::Inside } else { Place::Elsewhere };
        };
        let margin = self.margin(error);
        if nearest.distance <= self.rounding {
            Place::Border
        } else if nearest.distance <= margin {
            Place::Elsewhere
        } else if near.iter().all(|n| n.distance > margin + INSIDE * n.off_chords) {
            if self.is_covered(uv) { Place::Inside } else { Place::Elsewhere }
        } else if self.is_on_inner_side(nearest, p) {
            Place::Inside
        } else {
            Place::Elsewhere
        }
    }

    /// The nearest point of its edges, if it is no farther from a point than `error`.
    pub fn border_near(&self, p: DVec3, error: f64) -> Option<DVec3> {
        let near = self.nearest_on_edges(p).into_iter().filter(|n| n.distance <= error);
        near.min_by(|a, b| a.distance.total_cmp(&b.distance)).map(|n| n.point)
    }

    /// The nearest points of all edges that may be the nearest one, or nearer than their chords are off.
    fn nearest_on_edges(&self, p: DVec3) -> Vec<NearestOnEdge> {
        let to_chords: Vec<(usize, f64, f64)> = self
            .edges()
            .map(|edge| (edge, self.distance_of_chords(edge, p), self.longest_chord(edge)))
            .collect();
        let least = to_chords.iter().map(|item| item.1 + item.2).fold(f64::INFINITY, f64::min);
        let may_be_near = |item: &&(usize, f64, f64)| item.1 <= least + 2.0 * item.2;
        to_chords.iter().filter(may_be_near).filter_map(|item| self.nearest_on_edge(item.0, p)).collect()
    }

    fn nearest_on_edge(&self, edge: usize, p: DVec3) -> Option<NearestOnEdge> {
        let of_model = &self.part.edges[edge];
        let curve = of_model.curve.as_deref()?;
        let inverter = CurveInverter::new(curve, of_model.range);
        let nearest = inverter.invert(p, None);
        let point = curve.point(nearest.t);
        let off_chords = self.distance_of_chords(edge, point);
        let is_end = [of_model.start, of_model.end]
            .iter()
            .any(|v| self.part.vertices[v.index()].point.distance(point) <= nearest.distance);
        Some(NearestOnEdge { edge, point, distance: nearest.distance, off_chords, is_end })
    }

    /// The distance of a point from the chords of an edge.
    fn distance_of_chords(&self, edge: usize, p: DVec3) -> f64 {
        let chords = self.mesh.edges[edge].windows(2);
        chords.map(|chord| p.distance(self.nearest_on_chord(chord, p))).fold(f64::INFINITY, f64::min)
    }

    fn nearest_on_chord(&self, chord: &[u32], p: DVec3) -> DVec3 {
        let [a, b] = [0, 1].map(|i| self.mesh.positions[chord[i] as usize]);
        let along = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        a + (b - a) * if along.is_nan() { 0.0 } else { along }
    }

    fn longest_chord(&self, edge: usize) -> f64 {
        let at = |i: u32| self.mesh.positions[i as usize];
        self.mesh.edges[edge].windows(2).map(|c| at(c[0]).distance(at(c[1]))).fold(0.0, f64::max)
    }

    /// True where a point near an edge lies on that side of it on which the face has a triangle.
    fn is_on_inner_side(&self, nearest: &NearestOnEdge, p: DVec3) -> bool {
        let to_chord = |chord: &&[u32]| nearest.point.distance(self.nearest_on_chord(chord, nearest.point));
        let chords = self.mesh.edges[nearest.edge].windows(2);
        let chord = chords.min_by(|a, b| to_chord(a).total_cmp(&to_chord(b)));
        let Some(chord) = chord.filter(|_| !nearest.is_end) else { return false };
        let [a, b] = [0, 1].map(|i| self.mesh.positions[chord[i] as usize]);
        let of_face = self.of_mesh();
        let position = |c: u32| of_face.corners[c as usize].position;
        of_face.triangles.iter().any(|t| {
            let corners = t.map(position);
            let opposite = corners.iter().find(|i| !chord.contains(i));
            let has_chord = chord.iter().all(|i| corners.contains(i));
            let (true, Some(&opposite)) = (has_chord, opposite) else { return false };
            let inwards = (self.mesh.positions[opposite as usize] - a).reject_from(b - a);
            inwards.normalize_or_zero().dot((p - nearest.point).normalize_or_zero()) > ALONG
        })
    }

    /// True where a triangle of the face lies over the parameters, or over a full turn of them.
    fn is_covered(&self, uv: DVec2) -> bool {
        let of_face = self.of_mesh();
        let turns = |axis: usize| match self.periods[axis] {
            Some(period) => vec![0.0, period, -period],
            None => vec![0.0],
        };
        let is_over = |p: DVec2| {
            of_face.triangles.iter().any(|t| {
                let [a, b, c] = t.map(|c| of_face.corners[c as usize].uv);
                let turns = [(a, b), (b, c), (c, a)].map(|(a, b)| (b - a).perp_dot(p - a));
                turns.iter().all(|&t| t >= 0.0) || turns.iter().all(|&t| t <= 0.0)
            })
        };
        let (us, vs) = (turns(0), turns(1));
        us.iter().any(|&u| vs.iter().any(|&v| is_over(uv + DVec2::new(u, v))))
    }

    /// The distance of a point from the nearest of some edges and vertices of the file.
    pub fn distance_of(&self, edges: &[usize], vertices: &[VertexId], p: DVec3) -> f64 {
        let to_edges = edges.iter().filter_map(|&e| self.nearest_on_edge(e, p)).map(|n| n.distance);
        let to_vertices = vertices.iter().map(|v| self.part.vertices[v.index()].point.distance(p));
        to_edges.chain(to_vertices).fold(f64::INFINITY, f64::min)
    }
}
