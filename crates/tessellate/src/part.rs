//! The stages of one part, top to bottom.

use crate::clock::Stopwatch;
use crate::edges::EdgeSamples;
use crate::face_result::{FaceResult, Meshed};
use crate::fallback::leave_to_default;
use crate::lower_bound::lower_bound;
use crate::options::{Cancel, Options};
use crate::orient::{settle_orientation, turn_inside_out};
use crate::part_job::{PartJob, exact_surfaces};
use crate::pcurve_gap::pcurve_gap;
use crate::report::{FaceReport, PartReport};
use crate::rounds::{Pass, PassResult};
use crate::shared_inner_edges::separate;
use crate::stitch::stitch;
use chordal_brep::Part;
use chordal_mesh::PartMesh;
use rayon::prelude::*;

/// Meshes one part. Never fails as a whole: a face that cannot be meshed is reported with its reason.
///
/// `done` is called with the number of faces finished, from any thread, as the work goes on.
pub fn tessellate_part(
    part: &Part,
    options: &Options,
    cancel: &Cancel,
    done: &(dyn Fn(usize) + Sync),
) -> (PartMesh, PartReport) {
    let mut report = PartReport::default();
    // 1. Prepare the surfaces.
    let clock = Stopwatch::of_wall();
    let exact = exact_surfaces(part);
    let job = PartJob::new(part, &exact, options, cancel);
    report.seconds.heal = clock.seconds();
    // 2. Sample the edges.
    let clock = Stopwatch::of_wall();
    let pass = Pass::new(&job);
    let (edges, edge_faults) = pass.sample_edges();
    report.seconds.edges = clock.seconds();
    edges.iter().for_each(|e| report.edge_trace.merge(&e.trace));
    // 3. Mesh the faces, in rounds.
    let clock = Stopwatch::of_wall();
    let mut result = pass.run_with(edges, edge_faults, done);
    separate(&pass, &mut result);
    let result = leave_to_default(&job, result);
    report.seconds.faces = clock.seconds();
    // 4. Join the faces.
    let clock = Stopwatch::of_wall();
    let PassResult { edges, edge_faults, faces, rounds } = result;
    report.rounds = rounds;
    report.edge_faults = edge_faults;
    report.faces = face_reports(&job, &edges, &faces);
    let mut faces: Vec<Option<Box<FaceResult>>> = faces.into_iter().map(Result::ok).collect();
    settle_orientation(&mut faces);
    turn_inside_out(part, &edges, &mut faces);
    let mesh = stitch(part, &edges, &faces);
    report.seconds.stitch = clock.seconds();
    (mesh, report)
}

fn face_reports(job: &PartJob<'_>, edges: &[EdgeSamples], faces: &[Meshed]) -> Vec<FaceReport> {
    let closed: Vec<bool> = job.part.edges.iter().map(|e| e.start == e.end).collect();
    let pcurve_gaps: Vec<f64> = (job.part.faces.par_iter().zip(&job.surfaces))
        .map(|(face, surface)| {
            surface.as_ref().map_or(0.0, |surface| pcurve_gap(job.part, face, surface, edges))
        })
        .collect();
    let report = |(index, meshed): (usize, &Meshed)| {
        let entry =
            FaceReport { face: index as u32, bound: "none", proven_error: f64::NAN, ..FaceReport::default() };
        match meshed {
            Ok(result) => FaceReport {
                triangles: result.triangles.len(),
                proven_error: result.proven_error,
                boundary_error: result.boundary_error,
                gap: result.gap,
                pcurve_gap: pcurve_gaps[index],
                bound: result.bound,
                phases: result.phases,
                trace: result.trace.clone(),
                cells: result.cells.clone(),
                zero_area: result.triangles.is_empty(),
                lower_bound: lower_bound(&job.part.faces[index], edges, &closed, result.curvature_bound),
                ..entry
            },
            Err(issue) => FaceReport { failed: Some(issue.clone()), ..entry },
        }
    };
    faces.iter().enumerate().map(report).collect()
}
