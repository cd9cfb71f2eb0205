//! Faces without loops are whole surfaces: where such a surface ends its border becomes edges, so that it can
//! be sewn.
//!
//! A side that is closed onto the opposite one is no border, nor one that is a single point.

use chordal_brep::{Coedge, Edge, EdgeId, Face, FaceGeometry, Loop, Part, Pcurve, Source, Vertex, VertexId};
use chordal_nurbs::{Curve, Curve2, DVec2, NurbsCurve3, NurbsSurface, Range, Surface};
use std::sync::Arc;

/// One side of the domain: `axis` is the parameter that is constant, at its lower or upper end.
#[derive(Clone, Copy, Debug)]
struct Side {
    axis: usize,
    upper: bool,
}

/// The sides as a loop with the interior on its left; each is run forward where its own parameter grows.
const LOOP: [(Side, bool); 4] = [
    (Side { axis: 1, upper: false }, true),
    (Side { axis: 0, upper: true }, true),
    (Side { axis: 1, upper: true }, false),
    (Side { axis: 0, upper: false }, false),
];

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
    if !domain.is_finite() {
        return false;
    }
    let periods = surface.periods();
    let poles = surface.poles();
    let is_pole = |side: Side| {
        let value = side.value(&surface);
        poles
            .iter()
            .any(|p| p.axis == side.axis && (p.value - value).abs() <= 1e-9 * domain.size()[side.axis])
    };
    let open = |side: Side| periods[side.axis].is_none() && !is_pole(side);
    let mut corners = Corners { part, surface: &surface, source, known: Vec::new() };
    let mut runs: Vec<Coedge> = Vec::new();
    for (side, forward) in LOOP.into_iter().filter(|s| open(s.0)) {
        let edge = corners.edge(side);
        runs.push(Coedge { edge, forward, pcurves: vec![side.pcurve(&surface)] });
    }
    if runs.is_empty() {
        return false;
    }
    // Sides whose neighbours are closed are rings, each a loop of its own.
    let rings = periods.iter().any(Option::is_some);
    let mut loops: Vec<Vec<Coedge>> =
        if rings { runs.into_iter().map(|run| vec![run]).collect() } else { vec![runs] };
    if !same_sense {
        for a_loop in &mut loops {
            a_loop.reverse();
            a_loop.iter_mut().for_each(|c| c.forward = !c.forward);
        }
    }
    part.faces[face].loops =
        loops.into_iter().map(|coedges| Loop::Edges { coedges, outer: !rings }).collect();
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

impl Side {
    fn value(self, surface: &Surface) -> f64 {
        let domain = surface.domain();
        if self.upper { domain.max[self.axis] } else { domain.min[self.axis] }
    }

    fn range(self, surface: &Surface) -> Range {
        let domain = surface.domain();
        if self.axis == 0 { domain.v() } else { domain.u() }
    }

    fn line(self, surface: &Surface) -> Curve2 {
        let value = self.value(surface);
        if self.axis == 0 {
            Curve2::Line { origin: DVec2::new(value, 0.0), direction: DVec2::Y }
        } else {
            Curve2::Line { origin: DVec2::new(0.0, value), direction: DVec2::X }
        }
    }

    fn pcurve(self, surface: &Surface) -> Pcurve {
        Pcurve { curve: Arc::new(self.line(surface)), range: self.range(surface) }
    }

    fn curve(self, surface: &Arc<Surface>) -> Curve {
        if let Surface::Nurbs(nurbs) = surface.as_ref()
            && let Some(row) = self.row(nurbs)
        {
            return Curve::Nurbs(row);
        }
        Curve::OnSurface { surface: surface.clone(), curve: Box::new(self.line(surface)) }
    }

    /// The row of control points that is the side's own, where the knots are clamped.
    fn row(self, nurbs: &NurbsSurface) -> Option<NurbsCurve3> {
        let [count_u, count_v] = nurbs.counts();
        let [degree_u, degree_v] = nurbs.degree();
        let (across, degree_across, along, degree) = if self.axis == 0 {
            (nurbs.knots_u(), degree_u, nurbs.knots_v(), degree_v)
        } else {
            (nurbs.knots_v(), degree_v, nurbs.knots_u(), degree_u)
        };
        let n = across.len();
        let clamped = if self.upper {
            across[n - 1 - degree_across] == across[n - 1]
        } else {
            across[0] == across[degree_across]
        };
        let index = |i: usize| match (self.axis, self.upper) {
            (0, false) => i,
            (0, true) => (count_u - 1) * count_v + i,
            (_, false) => i * count_v,
            (_, true) => i * count_v + count_v - 1,
        };
        let count = if self.axis == 0 { count_v } else { count_u };
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
