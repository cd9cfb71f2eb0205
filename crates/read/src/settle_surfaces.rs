//! Surfaces brought to the forms that the mesher works on: without negative sizes, without the inner parts of
//! spindle tori, without spans along which nothing moves.
//!
//! The readers give the radii of the file, whatever their sign, and the parameters and the normal are those
//! of the formulas of [`Surface`]. Here each face gets an equal surface with positive sizes, and with it its
//! curves in parameter space and its sense.
//!
//! Offsets of surfaces of revolution become surfaces of revolution.
//!
//! A spindle torus has two parts that meet at its poles. A face lies on one of them: the one that its edges
//! lie on.

use chordal_brep::{Coedge, Face, FaceGeometry, Loop, Model, Part, Pcurve};
use chordal_nurbs::{DVec3, PositiveSurface, Surface};
use std::sync::Arc;

/// Places along an edge at which the distance to the two parts of a spindle torus is measured: the ends alone
/// may be the poles, which both parts share.
const EDGE_SAMPLES: u32 = 4;

/// Gives every face of the model a surface with positive sizes.
pub(crate) fn make_sizes_positive(model: &mut Model) {
    for part in &mut model.parts {
        let forms: Vec<Option<PositiveSurface>> = part.faces.iter().map(|face| form(part, face)).collect();
        for (face, form) in part.faces.iter_mut().zip(forms) {
            if let Some(form) = form {
                replace(face, form);
            }
        }
    }
}

/// Gives every spline face a surface without spans along which nothing moves. Its parameters change behind
/// such a span, so that curves in the old ones are left out and edges are projected.
pub(crate) fn leave_out_still_spans(model: &mut Model) {
    for face in model.parts.iter_mut().flat_map(|part| &mut part.faces) {
        let FaceGeometry::Surface(surface) = &face.geometry else { continue };
        let Surface::Nurbs(nurbs) = surface.as_ref() else { continue };
        let Some(moving) = nurbs.without_still_spans() else { continue };
        face.geometry = FaceGeometry::Surface(Arc::new(Surface::Nurbs(moving)));
        for coedge in coedges(face) {
            coedge.pcurves.clear();
        }
    }
}

fn coedges(face: &mut Face) -> impl Iterator<Item = &mut Coedge> {
    face.loops.iter_mut().flat_map(|boundary| match boundary {
        Loop::Edges { coedges, .. } => coedges.as_mut_slice(),
        Loop::Vertex(_) | Loop::Polygon { .. } => &mut [],
    })
}

fn form(part: &Part, face: &Face) -> Option<PositiveSurface> {
    let FaceGeometry::Surface(surface) = &face.geometry else { return None };
    surface.with_positive_sizes().or_else(|| {
        let inner = surface.inner_part()?;
        let points = boundary_points(part, face);
        (distance(&inner.surface, &points) < distance(surface, &points)).then_some(inner)
    })
}

/// The sum of the distances of points from a surface.
fn distance(surface: &Surface, points: &[DVec3]) -> f64 {
    points.iter().map(|&p| surface.point(surface.invert(p, None)).distance(p)).sum()
}

/// Gives every face on the offset of a surface of revolution the surface of revolution that it lies on: for
/// that there are bounds. The parameters are the same.
pub(crate) fn turn_offset_profiles(model: &mut Model) {
    for part in &mut model.parts {
        let turned: Vec<Option<Surface>> = part.faces.iter().map(|face| turned_offset(part, face)).collect();
        for (face, surface) in part.faces.iter_mut().zip(turned) {
            if let Some(surface) = surface {
                face.geometry = FaceGeometry::Surface(Arc::new(surface));
            }
        }
    }
}

fn turned_offset(part: &Part, face: &Face) -> Option<Surface> {
    let FaceGeometry::Surface(surface) = &face.geometry else { return None };
    let [one, other] = surface.offset_revolutions()?;
    let points = boundary_points(part, face);
    let is_nearer = |a: &Surface, b: &Surface| distance(a, &points) <= distance(b, &points);
    Some(if is_nearer(&one, &other) { one } else { other })
}

fn boundary_points(part: &Part, face: &Face) -> Vec<DVec3> {
    let point = |v: &chordal_brep::VertexId| part.vertices[v.index()].point;
    let of_edge = |coedge: &Coedge| {
        let edge = &part.edges[coedge.edge.index()];
        let at =
            move |k: u32| edge.range.start + edge.range.length() * f64::from(k) / f64::from(EDGE_SAMPLES);
        edge.curve.iter().flat_map(move |curve| (0..EDGE_SAMPLES).map(move |k| curve.point(at(k))))
    };
    face.loops
        .iter()
        .flat_map(|boundary| match boundary {
            Loop::Edges { coedges, .. } => coedges.iter().flat_map(of_edge).collect::<Vec<_>>(),
            Loop::Vertex(v) => vec![point(v)],
            Loop::Polygon { vertices, .. } => vertices.iter().map(point).collect(),
        })
        .filter(|p| p.is_finite())
        .collect()
}

fn replace(face: &mut Face, form: PositiveSurface) {
    for coedge in coedges(face) {
        coedge.pcurves = coedge.pcurves.iter().filter_map(|old| moved(old, &form)).collect();
    }
    face.same_sense ^= form.reversed;
    face.geometry = FaceGeometry::Surface(Arc::new(form.surface));
}

/// The curve in the new parameters; `None` where its kind cannot be scaled so: it is projected again where
/// needed.
fn moved(old: &Pcurve, form: &PositiveSurface) -> Option<Pcurve> {
    let curve = old.curve.scaled(form.factors)?.translated(form.shift);
    Some(Pcurve { curve: Arc::new(curve), range: old.range })
}
