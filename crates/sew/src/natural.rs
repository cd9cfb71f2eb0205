//! Faces without loops are whole surfaces: where such a surface ends its border becomes edges, so that it can
//! be sewn.
//!
//! A side that is closed onto the opposite one is no border, nor one that is a single point.

use chordal_brep::{Coedge, Edge, EdgeId, Face, FaceGeometry, Loop, Part, Pcurve, Source, Vertex, VertexId};
use chordal_nurbs::{
    BoxSide, Curve, Curve2, DVec2, NaturalBorder, NurbsCurve3, NurbsSurface, Range, Surface,
};
use std::sync::Arc;

/// Gives natural borders to the faces without loops; returns how many got one.
pub(crate) fn add_natural_borders(part: &mut Part) -> usize {
    let bare: Vec<usize> = (0..part.faces.len()).filter(|&f| part.faces[f].loops.is_empty()).collect();
    bare.into_iter().filter(|&f| add_border(part, f)).count()
}

fn add_border(part: &mut Part, face: usize) -> bool {
    let Face { geometry: FaceGeometry::Surface(surface), source, same_sense, .. } = &part.faces[face] else {
        return false;
    };
    let (surface, source, same_sense) = (surface.clone(), *source, *same_sense);
    let domain = surface.domain();
    let poles = surface.poles();
    // Rings are loops of their own.
    let (sides, are_rings): (Vec<BoxSide>, bool) = match surface.natural_border() {
        NaturalBorder::None => return false,
        NaturalBorder::Loop(sides) => {
            (sides.into_iter().filter(|side| !side.is_pole(&domain, &poles)).collect(), false)
        }
        NaturalBorder::Rings(sides) => (sides, true),
    };
    let mut corners = Corners { part, surface: &surface, source, known: Vec::new() };
    let coedge = |side: &BoxSide| {
        let edge = corners.edge(Side(*side));
        Coedge { edge, forward: side.is_forward(), pcurves: vec![Side(*side).pcurve(&surface)] }
    };
    let coedges: Vec<Coedge> = sides.iter().map(coedge).collect();
    if coedges.is_empty() {
        return false;
    }
    let mut loops: Vec<Vec<Coedge>> =
        if are_rings { coedges.into_iter().map(|ring| vec![ring]).collect() } else { vec![coedges] };
    if !same_sense {
        for a_loop in &mut loops {
            a_loop.reverse();
            a_loop.iter_mut().for_each(|c| c.forward = !c.forward);
        }
    }
    part.faces[face].loops =
        loops.into_iter().map(|coedges| Loop::Edges { coedges, outer: !are_rings }).collect();
    true
}

struct Corners<'a> {
    part: &'a mut Part,
    surface: &'a Arc<Surface>,
    source: Source,
    known: Vec<(glam::DVec3, VertexId)>,
}

impl Corners<'_> {
    fn edge(&mut self, side: Side) -> EdgeId {
        let range = side.range(self.surface);
        let curve = Arc::new(side.curve(self.surface));
        let start = self.vertex(curve.point(range.start));
        let end = self.vertex(curve.point(range.end));
        self.part.edges.push(Edge { curve: Some(curve), range, start, end, source: self.source });
        EdgeId::from(self.part.edges.len() - 1)
    }

    /// Corners that are one point, up to rounding of a closed surface, are one vertex.
    fn vertex(&mut self, p: glam::DVec3) -> VertexId {
        let size = self.known.iter().fold(p.abs().max_element(), |m, k| m.max(k.0.abs().max_element()));
        if let Some(known) = self.known.iter().find(|k| k.0.distance(p) <= 1e-9 * size) {
            return known.1;
        }
        self.part.vertices.push(Vertex { point: p, source: self.source });
        let id = VertexId::from(self.part.vertices.len() - 1);
        self.known.push((p, id));
        id
    }
}

/// A side of the domain as an edge, in the direction in which its own parameter grows.
#[derive(Clone, Copy)]
struct Side(BoxSide);

impl Side {
    fn range(self, surface: &Surface) -> Range {
        let domain = surface.domain();
        if self.0.axis() == 0 { domain.v() } else { domain.u() }
    }

    fn line(self) -> Curve2 {
        let value = self.0.value();
        if self.0.axis() == 0 {
            Curve2::Line { origin: DVec2::new(value, 0.0), direction: DVec2::Y }
        } else {
            Curve2::Line { origin: DVec2::new(0.0, value), direction: DVec2::X }
        }
    }

    fn pcurve(self, surface: &Surface) -> Pcurve {
        Pcurve { curve: Arc::new(self.line()), range: self.range(surface) }
    }

    fn curve(self, surface: &Arc<Surface>) -> Curve {
        if let Surface::Nurbs(nurbs) = surface.as_ref()
            && let Some(row) = self.row(nurbs)
        {
            return Curve::Nurbs(row);
        }
        Curve::OnSurface { surface: surface.clone(), curve: Box::new(self.line()) }
    }

    /// The row of control points that is the side's own, where the knots are clamped.
    fn row(self, nurbs: &NurbsSurface) -> Option<NurbsCurve3> {
        let [count_u, count_v] = nurbs.counts();
        let [degree_u, degree_v] = nurbs.degree();
        let (axis, is_upper) = (self.0.axis(), self.0.is_upper());
        let (across, degree_across, along, degree) = if axis == 0 {
            (nurbs.knots_u(), degree_u, nurbs.knots_v(), degree_v)
        } else {
            (nurbs.knots_v(), degree_v, nurbs.knots_u(), degree_u)
        };
        let n = across.len();
        let clamped = if is_upper {
            across[n - 1 - degree_across] == across[n - 1]
        } else {
            across[0] == across[degree_across]
        };
        let index = |i: usize| match (axis, is_upper) {
            (0, false) => i,
            (0, true) => (count_u - 1) * count_v + i,
            (_, false) => i * count_v,
            (_, true) => i * count_v + count_v - 1,
        };
        let count = if axis == 0 { count_v } else { count_u };
        let points = (0..count).map(|i| nurbs.points()[index(i)]).collect();
        let weights = nurbs.weights().map(|w| (0..count).map(|i| w[index(i)]).collect());
        if !clamped {
            return None;
        }
        NurbsCurve3::new(degree, along.to_vec(), points, weights).ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn face(surface: Surface) -> Part {
        let face = Face {
            geometry: FaceGeometry::Surface(Arc::new(surface)),
            same_sense: true,
            flipped: false,
            loops: Vec::new(),
            name: String::new(),
            color: None,
            layer: None,
            source: Source::default(),
        };
        Part { faces: vec![face], ..Part::default() }
    }

    #[test]
    fn a_patch_gets_four_sides_that_are_its_own() {
        let points =
            (0..9).map(|i| DVec3::new(f64::from(i / 3), f64::from(i % 3), f64::from(i * i))).collect();
        let knots = vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0];
        let weights = Some((0..9).map(|i| 1.0 + f64::from(i % 4)).collect());
        let nurbs = NurbsSurface::new([2, 2], knots.clone(), knots, points, weights).unwrap();
        let mut part = face(Surface::Nurbs(nurbs.clone()));
        assert_eq!(add_natural_borders(&mut part), 1);
        assert_eq!((part.edges.len(), part.vertices.len()), (4, 4));
        let Loop::Edges { coedges, .. } = &part.faces[0].loops[0] else { panic!("edges") };
        for (i, coedge) in coedges.iter().enumerate() {
            let edge = &part.edges[coedge.edge.index()];
            assert!(matches!(edge.curve.as_deref(), Some(Curve::Nurbs(_))));
            let end = if coedge.forward { edge.end } else { edge.start };
            let next = &part.edges[coedges[(i + 1) % 4].edge.index()];
            let start = if coedges[(i + 1) % 4].forward { next.start } else { next.end };
            assert_eq!(end, start, "the loop is closed");
            for k in 0..=4 {
                let t = f64::from(k) / 4.0;
                let on_surface = nurbs.point(coedge.pcurves[0].curve.point(t));
                assert!(edge.curve.as_ref().unwrap().point(t).distance(on_surface) < 1e-12);
            }
        }
    }

    #[test]
    fn closed_surfaces_have_rings_or_nothing() {
        let frame = chordal_nurbs::Frame::WORLD;
        let mut ball = face(Surface::Sphere { frame, radius: 1.0 });
        assert_eq!(add_natural_borders(&mut ball), 0);
        let profile = Curve::Polyline(vec![DVec3::new(1.0, 0.0, 0.0), DVec3::new(2.0, 0.0, 3.0)]);
        let tube = Surface::Revolution { profile, axis_origin: DVec3::ZERO, axis: DVec3::Z };
        let mut tube = face(tube);
        assert_eq!(add_natural_borders(&mut tube), 1);
        assert_eq!((tube.edges.len(), tube.faces[0].loops.len()), (2, 2));
        assert!(tube.edges.iter().all(|e| e.start == e.end));
    }
}
