//! How far a file contradicts itself: vertices off their curves, curves off the surfaces they bound.
//!
//! Measured at samples, so a lower bound: a description of the file, no part of any proof.

use chordal_brep::{Edge, Face, FaceGeometry, Loop, Part, Source};
use chordal_nurbs::{Range, SurfaceInverter, UvBox};
use glam::DVec3;

/// Samples per edge.
const SAMPLES: usize = 8;

/// The largest gap of a kind, in the part's units, and the entity it was found at.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Gap {
    pub distance: f64,
    pub source: Source,
}

impl Gap {
    fn include(&mut self, distance: f64, source: Source) {
        if distance > self.distance {
            *self = Gap { distance, source };
        }
    }
}

/// The largest gaps of one part.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Gaps {
    /// From a vertex to the end of a curve.
    pub vertex_to_curve: Gap,
    /// From an edge's curve to the surface of a face that it bounds.
    pub curve_to_surface: Gap,
}

pub(crate) fn gaps(part: &Part) -> Gaps {
    let mut found = Gaps::default();
    for edge in &part.edges {
        if let Some([start, end]) = curve_ends(edge) {
            let at = |v: chordal_brep::VertexId| part.vertices[v.index()].point;
            found.vertex_to_curve.include(start.distance(at(edge.start)), edge.source);
            found.vertex_to_curve.include(end.distance(at(edge.end)), edge.source);
        }
    }
    for face in &part.faces {
        face_gap(part, face, &mut found.curve_to_surface);
    }
    found
}

fn curve_ends(edge: &Edge) -> Option<[DVec3; 2]> {
    let curve = edge.curve.as_deref().filter(|_| edge.range.is_finite())?;
    Some([curve.point(edge.range.start), curve.point(edge.range.end)])
}

fn face_gap(part: &Part, face: &Face, gap: &mut Gap) {
    let FaceGeometry::Surface(surface) = &face.geometry else { return };
    let inverter = SurfaceInverter::new(surface, usable(surface.domain()));
    for a_loop in &face.loops {
        let Loop::Edges { coedges, .. } = a_loop else { continue };
        for edge in coedges.iter().map(|c| &part.edges[c.edge.index()]) {
            let Some(curve) = edge.curve.as_deref().filter(|_| edge.range.is_finite()) else { continue };
            let mut near = None;
            for i in 0..=SAMPLES {
                let t = edge.range.start + edge.range.length() * i as f64 / SAMPLES as f64;
                let found = inverter.invert(curve.point(t), near);
                near = Some(found.uv);
                gap.include(found.distance, edge.source);
            }
        }
    }
}

/// An unbounded direction is sampled nowhere in particular.
fn usable(domain: UvBox) -> UvBox {
    let finite = |r: Range| if r.is_finite() { r } else { Range::new(0.0, 1.0) };
    UvBox::from_ranges(finite(domain.u()), finite(domain.v()))
}
