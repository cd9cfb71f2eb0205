//! Surfaces that bring their own bounds: rectangular-trimmed, curve-bounded, and those that are finite by
//! nature.

use super::builder::Builder;
use super::curves_2d::angular;
use super::document::{Ix, Res};
use super::faces::Trimmed;
use super::keyword::Kw;
use chordal_brep::{Coedge, Edge, EdgeId, Loop, Pcurve, ReadIssue, Source, VertexId};
use chordal_nurbs::{Curve, Curve2, DVec2, Range, Surface, UvBox};
use std::sync::Arc;

/// Two points closer than this part of a surface patch's size are one corner.
const SAME_CORNER: f64 = 1e-7;

/// One side of a rectangle in parameter space.
struct Side {
    from: DVec2,
    to: DVec2,
    start: VertexId,
    end: VertexId,
}

impl Builder<'_> {
    /// The surface and loops of a surface that is a face by itself.
    pub(crate) fn trimmed_surface(&mut self, ix: Ix) -> Res<Trimmed> {
        let mut args = self.doc.open(ix)?;
        match self.doc.kw(ix) {
            Kw::RectangularTrimmedSurface => self.rectangle(ix),
            Kw::CurveBoundedSurface => self.curve_bounded(ix),
            Kw::OrientedSurface => {
                args.skip(1);
                let basis = args.reference()?;
                let same_sense = args.logical(true);
                let mut trimmed = self.geometry.nested(ix, |_| Ok(())).and_then(|()| self.natural(basis))?;
                trimmed.same_sense = trimmed.same_sense == same_sense;
                Ok(trimmed)
            }
            _ => self.natural(ix),
        }
    }

    /// The whole of a surface whose parameters are bounded.
    fn natural(&mut self, ix: Ix) -> Res<Trimmed> {
        let surface = self.geometry.surface(ix)?;
        if !surface.domain().is_finite() {
            return Err(self.doc.bad(ix, ReadIssue::SurfaceUnbounded));
        }
        Ok(Trimmed { surface, same_sense: true, loops: Vec::new() })
    }

    /// RECTANGULAR_TRIMMED_SURFACE(name, basis, u1, u2, v1, v2, usense, vsense).
    fn rectangle(&mut self, ix: Ix) -> Res<Trimmed> {
        let mut args = self.doc.leaf(ix, Kw::RectangularTrimmedSurface)?;
        args.skip(1);
        let surface = self.geometry.surface(args.reference()?)?;
        let unit =
            angular(&surface).map(|is_angle| if is_angle { self.geometry.units.angle_rad } else { 1.0 });
        let [u1, u2] = [args.real()? * unit[0], args.real()? * unit[0]];
        let [v1, v2] = [args.real()? * unit[1], args.real()? * unit[1]];
        let (along_u, along_v) = (args.logical(true), args.logical(true));
        let [period_u, period_v] = surface.periods();
        let u = ordered(u1, u2, along_u, period_u)
            .ok_or_else(|| self.doc.bad(ix, ReadIssue::TrimmedToNothing))?;
        let v = ordered(v1, v2, along_v, period_v)
            .ok_or_else(|| self.doc.bad(ix, ReadIssue::TrimmedToNothing))?;
        let same_sense = along_u == along_v;
        let loops = self.rectangle_loop(self.doc.source(ix), &surface, UvBox::from_ranges(u, v), same_sense);
        Ok(Trimmed { surface, same_sense, loops })
    }

    /// The boundary of a box of parameters as a loop; none where the box is all of a closed surface.
    fn rectangle_loop(
        &mut self,
        source: Source,
        surface: &Arc<Surface>,
        uv: UvBox,
        same_sense: bool,
    ) -> Vec<Loop> {
        let domain = surface.domain();
        if domain.is_finite() && (domain.min - uv.min).abs().max_element() == 0.0 && domain.max == uv.max {
            return Vec::new();
        }
        let corners = uv.corners();
        let points = corners.map(|c| surface.point(c));
        let size = points
            .iter()
            .chain([&surface.point(uv.center())])
            .map(|p| p.distance(points[0]))
            .fold(0.0, f64::max);
        let meets = |a: usize, b: usize| points[a].distance(points[b]) <= SAME_CORNER * size;
        let middle = |a: usize, b: usize| surface.point((corners[a] + corners[b]) * 0.5);
        // A side is a point where its middle lies on its ends; two opposite sides are one seam where both
        // ends meet.
        let pole = |a: usize, b: usize| meets(a, b) && middle(a, b).distance(points[a]) <= SAME_CORNER * size;
        let seam = |[a, b]: [usize; 2], [c, d]: [usize; 2]| {
            meets(a, c) && meets(b, d) && middle(a, b).distance(middle(c, d)) <= SAME_CORNER * size
        };
        let seam_u = seam([0, 3], [1, 2]);
        let seam_v = seam([0, 1], [3, 2]);
        let mut vertex: [Option<VertexId>; 4] = [None; 4];
        for i in 0..4 {
            let known = (0..i).find(|&j| meets(i, j)).and_then(|j| vertex[j]);
            vertex[i] = Some(known.unwrap_or_else(|| self.build.new_vertex(points[i], source)));
        }
        let vertex = vertex.map(|v| v.expect("every corner got a vertex"));
        let side =
            |a: usize, b: usize| Side { from: corners[a], to: corners[b], start: vertex[a], end: vertex[b] };
        let mut edge = |a, b, is_pole| self.side_edge(source, surface, &side(a, b), is_pole);
        let bottom = edge(0, 1, pole(0, 1));
        let right = if seam_u { None } else { Some(edge(1, 2, pole(1, 2))) };
        let top = if seam_v { None } else { Some(edge(3, 2, pole(3, 2))) };
        let left = edge(0, 3, pole(0, 3));
        let right_side = coedge(right.unwrap_or(left), true, &side(1, 2));
        let top_side = coedge(top.unwrap_or(bottom), false, &side(3, 2));
        let mut coedges =
            vec![coedge(bottom, true, &side(0, 1)), right_side, top_side, coedge(left, false, &side(0, 3))];
        if !same_sense {
            coedges.reverse();
            coedges.iter_mut().for_each(|c| c.forward = !c.forward);
        }
        vec![Loop::Edges { coedges, outer: true }]
    }

    fn side_edge(&mut self, source: Source, surface: &Arc<Surface>, side: &Side, pole: bool) -> EdgeId {
        let curve = (!pole).then(|| {
            let curve = Box::new(Curve2::Line { origin: side.from, direction: side.to - side.from });
            Arc::new(Curve::OnSurface { surface: surface.clone(), curve })
        });
        let range = Range::new(0.0, 1.0);
        self.build.push_edge(Edge { curve, range, start: side.start, end: side.end, source })
    }

    /// CURVE_BOUNDED_SURFACE(name, basis, boundaries, implicit_outer).
    fn curve_bounded(&mut self, ix: Ix) -> Res<Trimmed> {
        let mut args = self.doc.leaf(ix, Kw::CurveBoundedSurface)?;
        args.skip(1);
        let basis = args.reference()?;
        let surface = self.geometry.surface(basis)?;
        let boundaries = args.references_strict()?;
        let natural_outer = args.logical(false);
        let mut loops = Vec::new();
        if natural_outer {
            let domain = surface.domain();
            if !domain.is_finite() {
                return Err(self.doc.bad(ix, ReadIssue::SurfaceUnbounded));
            }
            loops = self.rectangle_loop(self.doc.source(ix), &surface, domain, true);
        }
        for boundary in boundaries {
            let pieces = self.geometry.composite_pieces(boundary)?;
            let outer = self.doc.kw(boundary) == Kw::OuterBoundaryCurve;
            let coedges = self.boundary_coedges(boundary, basis, pieces)?;
            loops.push(Loop::Edges { coedges, outer });
        }
        Ok(Trimmed { surface, same_sense: true, loops })
    }
}

/// A side as a coedge with its straight pcurve.
fn coedge(edge: EdgeId, forward: bool, side: &Side) -> Coedge {
    let curve = Arc::new(Curve2::Line { origin: side.from, direction: side.to - side.from });
    Coedge { edge, forward, pcurves: vec![Pcurve { curve, range: Range::new(0.0, 1.0) }] }
}

/// The range between two trims; unwrapped on a periodic surface. `None` where it is empty.
fn ordered(from: f64, to: f64, along: bool, period: Option<f64>) -> Option<Range> {
    let (from, mut to) = if along { (from, to) } else { (to, from) };
    match period {
        Some(period) if to <= from => to += period * ((from - to) / period + 1e-12).ceil().max(1.0),
        Some(period) if to > from + period => to = from + period,
        _ => {}
    }
    if period.is_none() && to < from {
        return Some(Range::new(to, from));
    }
    (from < to).then(|| Range::new(from, to))
}
