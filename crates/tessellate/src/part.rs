//! The stages of one part, top to bottom.

use crate::budget::Budget;
use crate::clock::Stopwatch;
use crate::effort::Effort;
use crate::face_result::{FaceResult, Meshed};
use crate::fallback::leave_to_default;
use crate::known_faces::KnownFaces;
use crate::lower_bound::lower_bound;
use crate::memo::Memo;
use crate::options::{Cancel, Options};
use crate::orient::{settle_orientation, turn_inside_out};
use crate::panics::caught;
use crate::part_job::{Efforts, PartJob, exact_surfaces};
use crate::parting::{FindCuts, part_facets};
use crate::pcurve_gap::pcurve_gap;
use crate::report::{FaceReport, PartReport};
use crate::rounds::{Pass, PassResult};
use crate::shared_inner_edges::separate;
use crate::stitch::stitch;
use chordal_brep::{MeshIssue, Part};
use chordal_chart::{Chart, Crossed, EdgeSamples, TrimmedFace, Uncrossed, uncrossed};
use chordal_mesh::PartMesh;
use rayon::prelude::*;
use std::sync::{Arc, Mutex};

/// Loops that cross are made anew this often: each time edges have other chords, which may show crossings
/// that coarser ones did not.
const HEALINGS: usize = 3;

/// The faces of a mesh of more triangles are not remembered: they would take as much memory again. The part
/// is then meshed from the start where facets cut each other.
const MOST_REMEMBERED: usize = 1_000_000;

/// Meshes one part. Never fails as a whole: a face that cannot be meshed is reported with its reason.
///
/// `done` is called with the number of faces finished, from any thread, as the work goes on.
pub fn tessellate_part(
    part: &Part,
    options: &Options,
    cancel: &Cancel,
    done: &(dyn Fn(usize) + Sync),
) -> (PartMesh, PartReport) {
    in_healings(part, options, cancel, None, done, &mut Remembered::default())
}

/// What faces and edges of a part took and gave, for [`tessellate_part_apart`].
#[derive(Debug, Default)]
pub struct Remembered {
    efforts: Efforts,
    memo: Mutex<Memo>,
}

/// As [`tessellate_part`], with what it takes to go on from there.
pub fn tessellate_part_remembered(
    part: &Part,
    options: &Options,
    cancel: &Cancel,
    done: &(dyn Fn(usize) + Sync),
) -> (PartMesh, PartReport, Remembered) {
    let mut remembered = Remembered::default();
    let (mesh, report) = in_healings(part, options, cancel, None, done, &mut remembered);
    if mesh.triangle_count() > MOST_REMEMBERED {
        remembered.memo = Mutex::default();
    }
    (mesh, report, remembered)
}

/// Meshes one part as [`tessellate_part`] does, and refines it where facets cut each other until they part.
///
/// `find` is called with the part, healed where its loops cross, and a mesh of it. What is remembered of the
/// part is not made again, and the time that it took counts.
pub fn tessellate_part_apart(
    part: &Part,
    options: &Options,
    cancel: &Cancel,
    find: &FindCuts<'_>,
    mut remembered: Remembered,
) -> (PartMesh, PartReport) {
    in_healings(part, options, cancel, Some(find), &|_| (), &mut remembered)
}

fn in_healings(
    part: &Part,
    options: &Options,
    cancel: &Cancel,
    find: Option<&FindCuts<'_>>,
    done: &(dyn Fn(usize) + Sync),
    remembered: &mut Remembered,
) -> (PartMesh, PartReport) {
    let mut known = KnownFaces::default();
    let turn_to = |remembered: &mut Remembered, healed: Option<&Arc<Part>>| {
        if let Ok(memo) = remembered.memo.get_mut() {
            memo.turn_to(part, healed);
        }
    };
    turn_to(remembered, None);
    let mut made = mesh_once(part, &known, options, remembered, cancel, find, done);
    for _ in 0..HEALINGS {
        let is_new = made.crossed.iter().any(|face| !known.touching.contains(face));
        let uncrossed = made.uncrossed.take();
        if uncrossed.is_none() && !is_new || cancel.is_cancelled() {
            break;
        }
        known.touching.extend(&made.crossed);
        let (healed, crossings) = match uncrossed {
            Some(uncrossed) => {
                known.flat.extend(&uncrossed.flat);
                (Some(Arc::new(uncrossed.part)), uncrossed.faces)
            }
            None => (made.report.healed.clone(), Vec::new()),
        };
        let healed_part = healed.as_deref().unwrap_or(part);
        turn_to(remembered, healed.as_ref());
        let again = mesh_once(healed_part, &known, options, remembered, cancel, find, &|_| ());
        // Loops that still cross stay as they are in the file.
        if again.crossed.len() >= made.crossed.len() {
            break;
        }
        let before = std::mem::replace(&mut made, again).report;
        let report = &mut made.report;
        report.faces.iter_mut().zip(&before.faces).for_each(|(new, old)| new.untangled = old.untangled);
        crossings.iter().for_each(|&(face, count)| report.faces[face].untangled += count.max(1));
        report.healed = healed;
    }
    (made.mesh, made.report)
}

/// A part meshed once.
struct MeshedOnce {
    mesh: PartMesh,
    report: PartReport,
    /// Faces whose loops cross.
    crossed: Vec<usize>,
    /// The part with other loops for those.
    uncrossed: Option<Uncrossed>,
}

fn mesh_once(
    part: &Part,
    known: &KnownFaces,
    options: &Options,
    remembered: &mut Remembered,
    cancel: &Cancel,
    find: Option<&FindCuts<'_>>,
    done: &(dyn Fn(usize) + Sync),
) -> MeshedOnce {
    remembered.efforts.cover(part);
    let Remembered { efforts, memo } = &*remembered;
    let mut report = PartReport::default();
    // 1. Prepare the surfaces.
    let clock = Stopwatch::of_wall();
    let exact = exact_surfaces(part);
    let job = PartJob::new(part, &exact, options, efforts, cancel).with_known(known.clone()).with_memo(memo);
    report.seconds.heal = clock.seconds();
    // 2. Sample the edges.
    let clock = Stopwatch::of_wall();
    let pass = Pass::new(&job);
    let sampled = pass.sample_edges();
    report.seconds.edges = clock.seconds();
    sampled.edges.iter().for_each(|e| report.edge_trace.merge(&e.trace));
    // 3. Mesh the faces, in rounds.
    let clock = Stopwatch::of_wall();
    let mut result = pass.run_with(sampled, done);
    separate(&pass, &mut result);
    let (pass, mut result) = leave_to_default(pass, result);
    if let Some(find) = find {
        result = part_facets(pass, result, find);
    }
    report.seconds.faces = clock.seconds();
    let crossed = crossed_faces(&result);
    let healing = |budget| uncrossed_part(&job, &result.edges, &crossed, budget);
    let uncrossed = job.within_budget(&job.efforts.healing, healing);
    // 4. Join the faces.
    let clock = Stopwatch::of_wall();
    let PassResult { edges, fewest, edges_given_up, edge_faults, faces, questions, rounds } = result;
    report.rounds = rounds;
    report.edge_faults = edge_faults;
    report.edges_given_up = edges_given_up;
    report.faces = face_reports(&job, &edges, &fewest, &faces);
    let mut faces: Vec<Option<Box<FaceResult>>> = faces.into_iter().map(Result::ok).collect();
    settle_orientation(&mut faces);
    turn_inside_out(part, &edges, &mut faces);
    let mesh = stitch(part, &edges, &faces.iter().map(Option::as_deref).collect::<Vec<_>>());
    job.remembered(|memo| {
        for (index, (face, question)) in faces.into_iter().zip(questions).enumerate() {
            if let (Some(face), Some(question)) = (face, question) {
                memo.keep(index, question, face);
            }
        }
    });
    report.seconds.stitch = clock.seconds();
    MeshedOnce { mesh, report, crossed, uncrossed }
}

fn crossed_faces(result: &PassResult) -> Vec<usize> {
    let is_crossed = |face: &usize| match &result.faces[*face] {
        Ok(result) => result.crossed,
        Err(issue) => *issue == MeshIssue::LoopsCross,
    };
    (0..result.faces.len()).filter(is_crossed).collect()
}

/// The part with loops that do not cross, where faces have some that do.
fn uncrossed_part(
    job: &PartJob<'_>,
    edges: &[EdgeSamples],
    crossed: &[usize],
    budget: Budget,
) -> Option<Uncrossed> {
    if crossed.is_empty() || job.cancel.is_cancelled() {
        return None;
    }
    let trimmed: Vec<(usize, TrimmedFace<'_, '_>)> = crossed
        .iter()
        .filter_map(|&face| {
            let trimmed = TrimmedFace {
                part: job.part,
                face: &job.part.faces[face],
                surface: job.surfaces[face].as_ref().ok()?,
                edges,
                touching: job.known.touching.contains(&face),
                resolution: job.resolution,
            };
            Some((face, trimmed))
        })
        .collect();
    let seams = job.limits.seams(Effort::of_round(0).seam_chord());
    // After a panic, the part stays unchanged.
    let healed = caught(|| {
        let charts: Vec<Crossed<'_, '_>> = trimmed
            .iter()
            .filter_map(|(face, context)| {
                let chart = Chart::new(context, &seams, false).ok()?;
                Some(Crossed { face: *face, context, chart })
            })
            .collect();
        uncrossed(job.part, &charts, job.resolution, job.limits.tolerance)
    });
    healed.ok().flatten().filter(|_| !budget.is_over())
}

fn face_reports(
    job: &PartJob<'_>,
    edges: &[EdgeSamples],
    fewest: &[f64],
    faces: &[Meshed],
) -> Vec<FaceReport> {
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
                given_up: result.given_up.clone(),
                mended: result.mended.clone(),
                zero_area: result.triangles.is_empty(),
                lower_bound: lower_bound(
                    &job.part.faces[index],
                    (edges, fewest),
                    &closed,
                    result.curvature_bound,
                ),
                ..entry
            },
            Err(issue) => FaceReport { failed: Some(issue.clone()), ..entry },
        }
    };
    faces.iter().enumerate().map(report).collect()
}
