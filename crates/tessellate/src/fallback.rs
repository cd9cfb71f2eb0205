//! Faces that the methods of the options could not prove: the default means mesh them in further passes.
//!
//! Each pass starts from the edges. Where a file is loose, loops cross the sooner the finer they are, and a
//! method may have requested chords that the default does not need. A pass counts only if it leaves fewer
//! faces unproven.

use crate::face_result::{Meshed, is_unproven};
use crate::part_job::PartJob;
use crate::rounds::{Pass, PassResult};
use crate::shared_inner_edges::{separate, unproven_faces};
use chordal_brep::{MeshIssue, MethodFault};

/// Passes in which the default takes over: first the unproven faces, then with their neighbours, which may be
/// the ones that request finer edges. Further passes would only add the neighbours' neighbours.
const PASSES: usize = 2;

/// Meshes the part again if a named method could not prove some faces; does nothing without a named method.
/// The result comes with the pass that made it.
pub(crate) fn leave_to_default<'j, 'a>(
    mut pass: Pass<'j, 'a>,
    mut result: PassResult,
) -> (Pass<'j, 'a>, PassResult) {
    let job = pass.job;
    if job.options.fill_method.is_none() && job.options.edge_splitter.is_none() {
        return (pass, result);
    }
    let count = |faces: &[bool]| faces.iter().filter(|&&f| f).count();
    let mut by_default = vec![false; result.faces.len()];
    let mut unproven = unproven_faces(job, &result.faces);
    for number in 0..PASSES {
        if count(&unproven) == 0 || job.cancel.is_cancelled() {
            break;
        }
        by_default.iter_mut().zip(&unproven).for_each(|(by_default, unproven)| *by_default |= unproven);
        if number > 0 {
            by_default = with_neighbours(job, &by_default);
        }
        let next = Pass::with_default_for(job, by_default.clone());
        let mut again = next.run(&|_| ());
        separate(&next, &mut again);
        let still_unproven = unproven_faces(job, &again.faces);
        if count(&still_unproven) >= count(&unproven) {
            break;
        }
        for (face, meshed) in again.faces.iter_mut().enumerate().filter(|(face, _)| by_default[*face]) {
            if let Ok(meshed) = meshed {
                meshed.trace.add("faces left to the default methods", 1);
                meshed.mended = internal_error(&result.faces[face]);
                meshed.given_up = given_up(job, &result.faces[face]);
            }
        }
        again.edge_faults.splice(..0, result.edge_faults);
        (pass, result, unproven) = (next, again, still_unproven);
    }
    (pass, result)
}

/// That the method of the options gave up a face, and why; `before` is what the pass before made of it.
fn given_up(job: &PartJob<'_>, before: &Meshed) -> Option<MeshIssue> {
    let method = job.options.fill_method.as_ref()?;
    let cause = match before {
        Ok(face) if face.given_up.is_some() => return face.given_up.clone(),
        Ok(face) if is_unproven(face, &job.limits, job.options.bound) => MethodFault::Unproven,
        Ok(_) => MethodFault::Neighbour,
        Err(issue) => MethodFault::Issue(Box::new(issue.clone())),
    };
    Some(MeshIssue::MethodGaveUp { method: method.name().into(), cause })
}

/// The fault of this program that a face met before, in this pass or an earlier one.
fn internal_error(before: &Meshed) -> Option<MeshIssue> {
    match before {
        Ok(face) => face.mended.clone(),
        Err(issue) => issue.is_internal().then(|| issue.clone()),
    }
}

/// These faces and all that share an edge with them.
fn with_neighbours(job: &PartJob<'_>, faces: &[bool]) -> Vec<bool> {
    let mut all = faces.to_vec();
    for edge in (0..job.part.edges.len()).filter(|&edge| job.faces_at(edge).any(|f| faces[f])) {
        job.faces_at(edge).for_each(|f| all[f] = true);
    }
    all
}
