//! Flat spline surfaces without loops whose sides stand still somewhere: planes, bounded by these sides.
//!
//! Wings end in caps between the two sides of a profile, written as one spline surface from the one side to
//! the other. Where the two meet, and along spans without length, its parameters are singular. As a plane it
//! has no such places.
//!
//! Steps: the net lies in a plane; a part of some side has no length; the surface does not fold, by the
//! signed and the absolute area of a grid over each span. Then the parts of the sides that have a length, in
//! order, are the loop.
//!
//! Not done: surfaces that are curved, and faces that have loops.

use chordal_brep::{Coedge, Edge, EdgeId, Face, FaceGeometry, Loop, Model, Part, Vertex, VertexId};
use chordal_nurbs::{Curve, DVec2, DVec3, Frame, NurbsCurve3, NurbsSurface, Range, Surface};
use std::sync::Arc;

/// A net nearer to a plane than this part of its size is flat, and a span shorter than that has no length.
const FLAT: f64 = 1e-9;

/// The signed and the absolute area of a surface that does not fold differ by less than this part.
const UNFOLDED: f64 = 1e-6;

/// Places along each span at which the area and the length are taken.
const SAMPLES: u32 = 4;

/// A part of a side, with the direction in which the loop runs along it.
struct Run {
    curve: Arc<Curve>,
    range: Range,
    forward: bool,
}

/// Makes planes of flat spline faces that have singular sides and no loops.
pub(crate) fn make_planes_of_caps(model: &mut Model) {
    for part in &mut model.parts {
        for index in 0..part.faces.len() {
            if let Some((frame, runs)) = cap(&part.faces[index]) {
                let boundary = add_loop(part, index, &runs);
                let face = &mut part.faces[index];
                face.geometry = FaceGeometry::Surface(Arc::new(Surface::Plane { frame }));
                face.loops = vec![boundary];
                if !face.same_sense {
                    reverse(face);
                }
            }
        }
    }
}

/// The plane of a cap, its z along the normal of the surface, and its sides counter-clockwise about that.
fn cap(face: &Face) -> Option<(Frame, Vec<Run>)> {
    let FaceGeometry::Surface(surface) = &face.geometry else { return None };
    let Surface::Nurbs(nurbs) = surface.as_ref() else { return None };
    if !face.loops.is_empty() || nurbs.weights().is_some_and(|w| w.iter().any(|&w| w <= 0.0)) {
        return None;
    }
    let nurbs = nurbs.clamped().ok()?;
    let size = nurbs.points().iter().fold(0.0f64, |m, p| m.max(p.distance(nurbs.points()[0])));
    let sides = sides(&nurbs)?;
    let runs: Vec<Vec<Run>> = sides.into_iter().map(|side| moving_parts(side, FLAT * size)).collect();
    let spans = |run: &Run| run.range.length();
    let domain = nurbs.domain().size();
    let whole = |k: usize| if k.is_multiple_of(2) { domain.x } else { domain.y };
    let stands_still = |k: usize| runs[k].iter().map(spans).sum::<f64>() < whole(k) * (1.0 - FLAT);
    if !(0..4).any(stands_still) {
        return None;
    }
    let normal = normal_without_folds(&nurbs)?;
    let origin = nurbs.points()[0];
    let off_plane = nurbs.points().iter().any(|p| (*p - origin).dot(normal).abs() > FLAT * size);
    let runs: Vec<Run> = runs.into_iter().flatten().collect();
    (!off_plane && runs.len() > 1)
        .then(|| (Frame::new(origin, normal, normal.any_orthonormal_vector()), runs))
}

/// The sides as curves: v at its start, u at its end, v at its end and u at its start, the last two run
/// backwards.
fn sides(nurbs: &NurbsSurface) -> Option<[Run; 4]> {
    let [rows, columns] = nurbs.counts();
    let [p, q] = nurbs.degree();
    let row = |i: usize| (0..columns).map(move |j| i * columns + j).collect::<Vec<usize>>();
    let column = |j: usize| (0..rows).map(move |i| i * columns + j).collect::<Vec<usize>>();
    let side = |degree: usize, knots: &[f64], order: Vec<usize>, forward: bool| {
        let points = order.iter().map(|&k| nurbs.points()[k]).collect();
        let weights = nurbs.weights().map(|w| order.iter().map(|&k| w[k]).collect());
        let curve = NurbsCurve3::new(degree, knots.to_vec(), points, weights).ok()?;
        let range = curve.domain();
        Some(Run { curve: Arc::new(Curve::Nurbs(curve)), range, forward })
    };
    Some([
        side(p, nurbs.knots_u(), column(0), true)?,
        side(q, nurbs.knots_v(), row(rows - 1), true)?,
        side(p, nurbs.knots_u(), column(columns - 1), false)?,
        side(q, nurbs.knots_v(), row(0), false)?,
    ])
}

/// The parts of a side between spans without length, in the direction of the loop.
fn moving_parts(side: Run, tiny: f64) -> Vec<Run> {
    let Curve::Nurbs(nurbs) = side.curve.as_ref() else { return Vec::new() };
    let mut parts: Vec<Range> = Vec::new();
    for span in nurbs.breaks().windows(2) {
        let at = |k: u32| span[0] + (span[1] - span[0]) * f64::from(k) / f64::from(SAMPLES);
        let from = nurbs.point(span[0]);
        if (1..=SAMPLES).all(|k| nurbs.point(at(k)).distance(from) <= tiny) {
            continue;
        }
        match parts.last_mut() {
            Some(last) if last.end == span[0] => last.end = span[1],
            _ => parts.push(Range::new(span[0], span[1])),
        }
    }
    if !side.forward {
        parts.reverse();
    }
    let run = |range: Range| Run { curve: side.curve.clone(), range, forward: side.forward };
    parts.into_iter().map(run).collect()
}

/// The normal of a flat surface, `None` where it folds over itself.
fn normal_without_folds(nurbs: &NurbsSurface) -> Option<DVec3> {
    let places = |breaks: &[f64]| -> Vec<(f64, f64)> {
        let inside = |span: &[f64]| {
            let width = (span[1] - span[0]) / f64::from(SAMPLES);
            let start = span[0];
            (0..SAMPLES).map(move |k| (start + (f64::from(k) + 0.5) * width, width)).collect::<Vec<_>>()
        };
        breaks.windows(2).flat_map(inside).collect()
    };
    let (us, vs) = (places(&nurbs.breaks_u()), places(&nurbs.breaks_v()));
    let areas = us.iter().flat_map(|&(u, du)| vs.iter().map(move |&(v, dv)| (DVec2::new(u, v), du * dv)));
    let (signed, absolute) = areas.fold((DVec3::ZERO, 0.0), |(signed, absolute), (uv, weight)| {
        let (_, du, dv) = nurbs.jet1(uv);
        let area = du.cross(dv) * weight;
        (signed + area, absolute + area.length())
    });
    (signed.length() > absolute * (1.0 - UNFOLDED)).then(|| signed.normalize())
}

fn add_loop(part: &mut Part, face: usize, runs: &[Run]) -> Loop {
    let source = part.faces[face].source;
    let first = part.vertices.len();
    for run in runs {
        let t = if run.forward { run.range.start } else { run.range.end };
        part.vertices.push(Vertex { point: run.curve.point(t), source });
    }
    let mut coedges = Vec::with_capacity(runs.len());
    for (k, run) in runs.iter().enumerate() {
        let [from, to] = [k, (k + 1) % runs.len()].map(|k| VertexId::from(first + k));
        let (start, end) = if run.forward { (from, to) } else { (to, from) };
        let edge = EdgeId::from(part.edges.len());
        part.edges.push(Edge { curve: Some(run.curve.clone()), range: run.range, start, end, source });
        coedges.push(Coedge { edge, forward: run.forward, pcurves: Vec::new() });
    }
    Loop::Edges { coedges, outer: true }
}

/// Loops run counter-clockwise about the normal of the face, which is against the surface's here.
fn reverse(face: &mut Face) {
    for boundary in &mut face.loops {
        if let Loop::Edges { coedges, .. } = boundary {
            coedges.reverse();
            coedges.iter_mut().for_each(|c| c.forward = !c.forward);
        }
    }
}
