//! The file's curves of an edge in the parameter spaces of its faces, with the ranges that correspond to the
//! edge's.

use super::builder::{Builder, SurfaceUse};
use super::curves::{CURVES, is_surface_curve};
use super::document::Ix;
use super::keyword::Kw;
use chordal_brep::EdgeId;
use chordal_nurbs::{Curve2, Range};
use std::sync::Arc;

/// Ranges that differ by less than this part of their length are one.
const SAME_RANGE: f64 = 1e-6;

impl Builder<'_> {
    /// The curves of an edge's geometry in parameter spaces, each over its own range or over the edge's.
    ///
    /// `edge_range` is the edge's in the file's units; none where the edge is not on the file's curve.
    pub(crate) fn pcurves(
        &mut self,
        geometry: Ix,
        edge: EdgeId,
        edge_range: Option<Range>,
    ) -> Vec<SurfaceUse> {
        let Ok((kw, mut args)) = self.doc.body(geometry, &CURVES) else { return Vec::new() };
        let list = match kw {
            Kw::Pcurve | Kw::BoundedPcurve => vec![geometry],
            kw if is_surface_curve(kw) => {
                args.skip(1);
                args.references_or_warn()
            }
            _ => return Vec::new(),
        };
        let mut found = Vec::new();
        for ix in list {
            // A surface in place of a pcurve only states that the edge lies on it.
            if !matches!(self.doc.kw(ix), Kw::Pcurve | Kw::BoundedPcurve | Kw::Complex) {
                continue;
            }
            match self.geometry.bounded_pcurve(ix) {
                Ok((surface, curve, own)) => {
                    let (curve, range) = self.over_edge(edge, edge_range, surface, curve, own);
                    if range.is_finite() && range.start < range.end {
                        found.push(SurfaceUse { surface, curve: Arc::new(curve), range });
                    }
                }
                Err(bad) if self.doc.kw(ix) != Kw::Complex => self.warn_bad(&bad),
                Err(_) => {}
            }
        }
        found
    }

    /// A pcurve with the range that corresponds to the edge's.
    ///
    /// Most writers give both curves the same parameters. Where a bounded pcurve's domain is another one, the
    /// whole pcurve is meant, and it may run either way.
    fn over_edge(
        &mut self,
        edge: EdgeId,
        edge_range: Option<Range>,
        surface: Ix,
        curve: Curve2,
        own: Option<Range>,
    ) -> (Curve2, Range) {
        let domain = own.unwrap_or_else(|| curve.domain());
        match edge_range {
            Some(range) if !domain.is_finite() || within(range, domain) || curve.period().is_some() => {
                return (curve, range);
            }
            Some(range)
                if !matches!(curve, Curve2::Nurbs(_) | Curve2::Polyline(_) | Curve2::Composite(_))
                    && own.is_none() =>
            {
                return (curve, range);
            }
            _ => {}
        }
        if domain.is_finite() && self.runs_backwards(edge, surface, &curve, domain) {
            return (Curve2::Composite(vec![(curve, domain.end, domain.start)]), Range::new(0.0, 1.0));
        }
        (curve, domain)
    }

    /// True where the pcurve starts at the edge's end and ends at its start.
    fn runs_backwards(&mut self, edge: EdgeId, surface: Ix, curve: &Curve2, range: Range) -> bool {
        let Ok(surface) = self.geometry.surface(surface) else { return false };
        let ends = [range.start, range.end].map(|t| surface.point(curve.point(t)));
        let edge = &self.build.part.edges[edge.index()];
        let vertices = [edge.start, edge.end].map(|v| self.build.part.vertices[v.index()].point);
        let forward = ends[0].distance(vertices[0]) + ends[1].distance(vertices[1]);
        let backward = ends[0].distance(vertices[1]) + ends[1].distance(vertices[0]);
        backward < forward
    }
}

/// True where `range` is all or part of `domain`.
fn within(range: Range, domain: Range) -> bool {
    let slack = SAME_RANGE * domain.length();
    range.start >= domain.start - slack && range.end <= domain.end + slack
}
