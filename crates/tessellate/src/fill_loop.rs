//! Filling one face and proving it: by the default means, or by a method of another crate.
//!
//! A method works in a loop:
//!
//! 1. Build the triangles of the whole face.
//! 2. Ask the method for chords that it finds too coarse: the edges become finer first.
//! 3. Bound every triangle. The face is done if all are within the limits.
//! 4. Let the method refine where triangles are too coarse, and begin again.
//!
//! What is still too coarse when the method can do no more is mended as the default does. A face that is not
//! proven even then is filled by the default from the start.

use crate::clock::Stopwatch;
use crate::default_fill::fill_by_rows;
use crate::effort::Setback;
use crate::face_mesh::FaceMesh;
use crate::face_result::Proof;
use crate::fill_method::{FaceFiller, FillMethod, FillTask};
use crate::limits::Bound;
use crate::options::Options;
use crate::poles::open_out;
use crate::prove::{ChordRequests, Fault, Prover, STEPS_PER_LOOK};
use crate::trace::Trace;
use chordal_brep::{MeshIssue, MethodFault};
use chordal_nurbs::DVec2;

/// A method may refine what the proof found too coarse this often. Each round builds the whole face again.
const METHOD_ROUNDS: usize = 24;

/// Most cells of one face. More would take gigabytes.
const MOST_CELLS: usize = 4_000_000;

/// The name in the trace of a face that a method could not prove.
const LEFT_TO_DEFAULT: &str = "faces left to the default strategy";

/// Whether the method of the options gave the face up: none of its points are in the mesh.
pub(crate) fn given_up(trace: &Trace, options: &Options) -> Option<MeshIssue> {
    let method = options.fill_method.as_ref().filter(|_| trace.count(LEFT_TO_DEFAULT) > 0)?;
    Some(MeshIssue::MethodGaveUp { method: method.name().into(), cause: MethodFault::Unproven })
}

/// Proving inserts points and flips edges, after which triangles at poles may be flat again; they are opened
/// this often.
const OPENINGS: usize = 3;

/// Fills a face whose loops are triangulated, and proves it.
///
/// # Errors
/// Where the edges or seams must become finer first, or no means of this attempt suffices.
pub(crate) fn fill_and_prove(
    face: &mut FaceMesh<'_, '_>,
    prover: &mut Prover<'_>,
    options: &Options,
    edges_are_final: bool,
) -> Result<Proof, Setback> {
    match &options.fill_method {
        Some(method) => fill_by_method(face, prover, &**method, options, edges_are_final),
        None => {
            fill_by_rows(face);
            refine_opened(face, prover)
        }
    }
}

/// Proves a face after its triangles at poles are opened, and again where proving has shut some.
fn refine_opened(face: &mut FaceMesh<'_, '_>, prover: &mut Prover<'_>) -> Result<Proof, Setback> {
    open_out(face);
    for _ in 0..OPENINGS {
        let proof = prover.refine(face)?;
        // Of a face that is accepted as it is, more refining would prove nothing.
        if proof.error.is_infinite() || open_out(face) == 0 {
            return Ok(proof);
        }
    }
    prover.refine(face)
}

fn fill_by_method(
    face: &mut FaceMesh<'_, '_>,
    prover: &mut Prover<'_>,
    method: &dyn FillMethod,
    options: &Options,
    edges_are_final: bool,
) -> Result<Proof, Setback> {
    let clock = Stopwatch::of_thread();
    let edges_in_space = options.edge_splitter.as_ref().is_some_and(|splitter| splitter.is_in_space());
    let mut filler = method.begin(face, FillTask { bound: options.bound, edges_in_space })?;
    face.phases_mut().conversion += clock.seconds();
    let result = refine_by_method(face, prover, &mut *filler, options.bound, edges_are_final);
    if options.record_cells {
        face.set_cells(filler.cells());
    }
    result
}

fn refine_by_method(
    face: &mut FaceMesh<'_, '_>,
    prover: &mut Prover<'_>,
    filler: &mut dyn FaceFiller,
    bound: Bound,
    edges_are_final: bool,
) -> Result<Proof, Setback> {
    let boundary = face.mesh().clone();
    let metrics = face.metrics().to_vec();
    let allowed = face.limits().largest();
    let mut coarse_at_boundary = usize::MAX;
    for round in 0..METHOD_ROUNDS {
        // 1. Build.
        face.restore(&boundary);
        face.set_trace(Trace::default());
        filler.build(face, &|cells| check(prover, cells))?;
        // 2. Chords.
        let finer = if edges_are_final { Vec::new() } else { filler.coarse_chords(face) };
        if !finer.is_empty() {
            return Err(Setback::CoarseEdges(finer));
        }
        face.count("rounds of refinement after the proof", round);
        // 3. Bounds.
        if bound == Bound::Estimated {
            return Ok(prover.proof(f64::NAN));
        }
        let judged = judge_all(face, prover)?;
        if judged.coarse.is_empty() && judged.error <= allowed {
            return Ok(prover.proof(judged.error));
        }
        // No cell can be cut further, and some chords that must not be cut are too coarse.
        if judged.coarse.is_empty() {
            break;
        }
        // 4. Inside, smaller cells always help in the end. Where a long chord meets small cells they need
        //    not.
        if !judged.is_inside && judged.coarse.len() >= coarse_at_boundary || !filler.refine(&judged.coarse) {
            break;
        }
        coarse_at_boundary = if judged.is_inside { usize::MAX } else { judged.coarse.len() };
    }
    let before = face.mesh().triangles.len();
    let result = refine_opened(face, prover);
    if let Err(Setback::Failed(_)) = result {
        return result;
    }
    face.count("triangles added by the default's means", face.mesh().triangles.len().saturating_sub(before));
    let is_kept = match &result {
        Err(Setback::Stuck) => false,
        Ok(proof) => proof.error <= allowed,
        Err(_) => true,
    };
    if is_kept || prover.is_hopeless() {
        return result;
    }
    // Better a face by the default's own points than one of which nothing is proven.
    face.restore(&boundary);
    face.set_metrics(metrics);
    face.clear_quads();
    face.count(LEFT_TO_DEFAULT, 1);
    fill_by_rows(face);
    refine_opened(face, prover)
}

fn check(prover: &Prover<'_>, cells: usize) -> Result<(), MeshIssue> {
    if cells > MOST_CELLS {
        return Err(MeshIssue::TooManyCells { most: MOST_CELLS });
    }
    prover.check_time(cells)
}

/// The proof of the triangles as they are.
struct Judged {
    error: f64,
    /// The middles of triangles that must become smaller.
    coarse: Vec<DVec2>,
    /// One of them has no corner on the boundary.
    is_inside: bool,
}

/// # Errors
/// Where edges or seams must become finer first.
fn judge_all(face: &FaceMesh<'_, '_>, prover: &mut Prover<'_>) -> Result<Judged, Setback> {
    let mut judged = Judged { error: 0.0, coarse: Vec::new(), is_inside: false };
    let mut chords = ChordRequests::default();
    let mut seam = Ok(());
    for t in 0..face.mesh().triangles.len() {
        if t % STEPS_PER_LOOK == STEPS_PER_LOOK - 1 {
            prover.check_time(face.mesh().triangles.len())?;
        }
        let t = t as u32;
        let (error, fault) = prover.judge(face, t);
        judged.error = judged.error.max(error);
        match fault {
            None => {}
            Some(Fault::Edge(_) | Fault::FoldingEdge(_)) if prover.accepts() => {}
            Some(Fault::Edge(i) | Fault::FoldingEdge(i)) => {
                seam = seam.and(chords.add(prover.boundary_segment(face, t, i)))
            }
            Some(Fault::Inside(_) | Fault::Fold(_)) => {
                let [a, b, c] = face.mesh().corners(t);
                judged.coarse.push((a + b + c) / 3.0);
                let first_inside = face.chart().points.len() as u32;
                judged.is_inside |= face.mesh().triangles[t as usize].iter().all(|&v| v >= first_inside);
            }
        }
    }
    // Finer edges come before finer seams: they concern other faces, too.
    chords.into_result()?;
    seam?;
    Ok(judged)
}
