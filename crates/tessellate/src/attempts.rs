//! One face with the edges as they are: attempts, each with more remedies than the last ([`crate::effort`]).

use crate::effort::{Effort, Remedy, Setback};
use crate::face_context::FaceContext;
use crate::face_mesh::{FaceMesh, boundary_triangles, shape, sweep_axis};
use crate::face_result::{FaceResult, Proof};
use crate::fill_loop::{fill_and_prove, given_up};
use crate::limits::Limits;
use crate::options::{Cancel, Options};
use crate::prove::Prover;
use crate::triangulate::clip_ears;
use chordal_brep::MeshIssue;
use chordal_chart::{Chart, coarse_chords, cutting_chords, loops_cross, shut_corners};
use chordal_nurbs::{DVec2, SurfaceBounds, UvBox};

/// Meshes one face, in as many attempts as the ladder of remedies has.
///
/// # Errors
/// Where the face's edges must become finer first, or the face fails.
pub(crate) fn mesh_face(
    context: &FaceContext<'_, '_>,
    limits: &Limits,
    options: &Options,
    cancel: &Cancel,
    mut effort: Effort,
) -> Result<Box<FaceResult>, Setback> {
    let any_angle = Limits { angle: f64::INFINITY, ..*limits };
    loop {
        let limits = if effort.has(Remedy::AnyAngle) { &any_angle } else { limits };
        let setback = match attempt(context, limits, options, cancel, effort) {
            Ok(result) => return Ok(result),
            Err(setback @ (Setback::CoarseEdges(_) | Setback::Failed(_))) => return Err(setback),
            Err(setback) => setback,
        };
        if context.is_out_of_time() {
            return Err(MeshIssue::OutOfTime { elements: 0 }.into());
        }
        effort = effort.after(&setback).ok_or(MeshIssue::SeamTooCoarse)?;
    }
}

/// One attempt at a face.
fn attempt(
    context: &FaceContext<'_, '_>,
    limits: &Limits,
    options: &Options,
    cancel: &Cancel,
    effort: Effort,
) -> Result<Box<FaceResult>, Setback> {
    let edges_are_final = effort.has(Remedy::CrossingLoops);
    // A face without area has no triangles, and its neighbours meet where it lies.
    let nothing = || Ok(Box::new(FaceResult { bound: "no area", ..FaceResult::default() }));
    if !context.trimmed.surface.surface.has_area() {
        return nothing();
    }
    // 1. Unroll the face into one chart; its loops may enclose nothing.
    let seams = limits.seams(effort.seam_chord());
    let chart = Chart::new(&context.trimmed, &seams, !effort.has(Remedy::UncutCreases))?;
    if chart.loops.is_empty() {
        return nothing();
    }
    // 2. Triangulate its loops.
    let points: Vec<DVec2> = chart.points.iter().map(|p| p.uv).collect();
    let uv_box = UvBox::from_points(points.iter().copied());
    let shape = shape(context, limits, uv_box);
    let axis = sweep_axis(context, limits, uv_box, shape);
    let (triangles, are_loops_crossing) = match boundary_triangles(&points, &chart, axis) {
        Ok(triangles) => (triangles, false),
        Err(culprits) => (crossing_triangles(context, &chart, &points, &culprits, effort)?, true),
    };
    let mut face = FaceMesh::new(context, limits, chart, shape, triangles, &options.bulk);
    // 3. Fill it and prove it.
    let finest = context.closer.iter().map(|place| place.tolerance).reduce(f64::min);
    let surface = context.trimmed.surface.surface;
    let finer = finest.map(|finest| SurfaceBounds::new(surface, uv_box, finest));
    let bounds = SurfaceBounds::new(surface, uv_box, limits.tolerance);
    let mut prover =
        Prover::new(&bounds, limits, options, context.budget, cancel, effort).with_finer(finer.as_ref());
    if are_loops_crossing && face.is_turned_somewhere() {
        prover = prover.for_crossing_loops();
    }
    let mut proof = fill_and_prove(&mut face, &mut prover, options, edges_are_final)?;
    // 4. A triangle that is turned over may lie outside of the face, which no distance to the surface would
    //    show.
    if are_loops_crossing && face.is_turned_somewhere() {
        proof = Proof { error: f64::INFINITY, bound: "none" };
    } else if !edges_are_final {
        // 5. Corners without an area between their chords need finer chords.
        let shut = shut_corners(&context.trimmed, face.chart());
        if !shut.is_empty() {
            return Err(Setback::CoarseEdges(shut));
        }
    }
    let crossed = are_loops_crossing || loops_cross(face.chart());
    let mut result = face.finish(proof, options.bound, options.quads);
    result.crossed = crossed;
    result.given_up = given_up(&result.trace, options);
    Ok(Box::new(result))
}

/// Loops that cross are not cut into ears where they have more points than this: the time grows with the
/// square.
const MOST_EARS: usize = 20_000;

/// Triangles of loops that cross: as good as they can be, where the loops cross in truth.
///
/// # Errors
/// Where finer edges may uncross the loops, or an attempt without cuts along creases may.
fn crossing_triangles(
    context: &FaceContext<'_, '_>,
    chart: &Chart,
    points: &[DVec2],
    culprits: &[u32],
    effort: Effort,
) -> Result<Vec<[u32; 3]>, Setback> {
    let is_out_of_time = || context.is_out_of_time();
    let coarse = if effort.has(Remedy::CrossingLoops) {
        cutting_chords(&context.trimmed, chart, &is_out_of_time)
    } else {
        coarse_chords(&context.trimmed, chart, culprits, &is_out_of_time)
    };
    if context.is_out_of_time() || points.len() > MOST_EARS {
        return Err(MeshIssue::LoopsCross.into());
    }
    let are_edges_final = effort.has(Remedy::CrossingLoops) && effort.has(Remedy::AsItIs);
    if !are_edges_final && !coarse.is_empty() {
        return Err(Setback::CoarseEdges(coarse));
    }
    let has_creases = context.trimmed.surface.creases.iter().any(|creases| !creases.is_empty());
    if has_creases && !effort.has(Remedy::UncutCreases) {
        return Err(Setback::Crossing);
    }
    Ok(clip_ears(points, &chart.loops).ok_or(MeshIssue::LoopsCross)?)
}
