//! Proof: every triangle of a face gets an upper bound of its distance from the surface, and what is over the
//! limits is mended.
//!
//! [`Prover::refine`] takes triangles from a queue, one after the other:
//!
//! 1. Bound the triangle, and find what is wrong with it ([`Prover::judge`]).
//! 2. A chord of an edge that is too coarse is noted: after all triangles, the face requests finer edges.
//! 3. A chord of a seam that is too coarse ends the attempt: the seam is this face's own, and is cut finer.
//! 4. Anything else is mended inside ([`mend`]): an edge is flipped, or a point is inserted. The triangles
//!    that this changes go back to the queue. Once a finer edge is requested, nothing is mended any more,
//!    since the face runs again.
//! 5. Where the queue is empty, triangles without area are flipped; that may fill the queue again.
//!
//! In the end every triangle has a bound, or the attempt has failed with a [`Setback`]. A face may also be
//! stuck: the number of steps is limited, and a triangle may have no place for a point.
//!
//! Not guaranteed: that mending ends for every surface; the limit of steps ends it.

mod chords;
mod flip;
mod judge;
mod mend;
mod requests;
mod sampled;

pub(crate) use judge::Fault;
pub(crate) use requests::ChordRequests;

use crate::budget::Budget;
use crate::effort::{Effort, Remedy, Setback};
use crate::face_mesh::FaceMesh;
use crate::face_result::Proof;
use crate::limits::{Bound, Limits};
use crate::options::{Cancel, Options};
use chordal_brep::MeshIssue;
use chordal_chart::Segment;
use chordal_nurbs::{Piece, Surface, SurfaceBounds};
use chords::POINTS_FIRST;
use std::collections::VecDeque;

/// Steps that one face may take: this many for each triangle that it begins with, and some more. Where
/// mending never ends, this limit ends it; a lower one would stop faces that need many points in one place.
const STEPS: (usize, usize) = (16, 4_000);

/// The limit for a face that cannot be proven, because its loops cross: a little effort suffices.
const HOPELESS_STEPS: (usize, usize) = (4, 100);

/// The budget and the cancel flag are checked once in this many steps: a step takes a microsecond on a
/// cylinder and up to a millisecond on an offset surface.
pub(crate) const STEPS_PER_LOOK: usize = 16;

/// Flips of triangles without area are followed by refining, and that by flips, this often. Without a limit,
/// the two could undo each other for ever.
const SLIVER_PASSES: u32 = 3;

pub(crate) struct Prover<'a> {
    bounds: &'a SurfaceBounds<'a>,
    /// Tight bounds for places at which facets must lie closer to the surface.
    finer: Option<&'a SurfaceBounds<'a>>,
    limits: &'a Limits,
    most_triangles: usize,
    budget: Budget,
    cancel: &'a Cancel,
    scratch: Vec<Piece>,
    /// Nothing can be bounded on this surface, or nothing is to be: samples must do.
    sampled: bool,
    effort: Effort,
    /// How often points inside may still be tried before a chord with a wild bound is made finer.
    points_first: u32,
    /// Whatever is mended, the face will not be proven: little effort will do.
    is_hopeless: bool,
}

impl<'a> Prover<'a> {
    pub fn new(
        bounds: &'a SurfaceBounds<'a>,
        limits: &'a Limits,
        options: &Options,
        budget: Budget,
        cancel: &'a Cancel,
        effort: Effort,
    ) -> Self {
        // A fill method sets its points before the proof: chords are judged by their own bounds alone.
        let tries_points = options.fill_method.is_none() && !effort.has(Remedy::FinerChords);
        Self {
            bounds,
            finer: None,
            limits,
            most_triangles: options.face_triangles,
            budget,
            cancel,
            scratch: Vec::new(),
            sampled: options.bound == Bound::Estimated || !bounds.is_bounded(),
            effort,
            points_first: if tries_points { POINTS_FIRST } else { 0 },
            is_hopeless: false,
        }
    }

    /// The prover of a face with places at which its facets must lie closer to the surface.
    pub fn with_finer(self, finer: Option<&'a SurfaceBounds<'a>>) -> Self {
        Self { finer, ..self }
    }

    /// The prover of a face whose loops cross in truth: triangles that are turned over are accepted.
    pub fn for_crossing_loops(self) -> Self {
        Self { effort: self.effort.with(Remedy::AsItIs), is_hopeless: true, ..self }
    }

    /// True where what cannot be mended is accepted.
    pub fn accepts(&self) -> bool {
        self.effort.has(Remedy::AsItIs)
    }

    pub fn is_hopeless(&self) -> bool {
        self.is_hopeless
    }

    /// Refines until every triangle is within the limits.
    ///
    /// # Errors
    /// Where the edges or seams must become finer first, or no means of this attempt mends a triangle.
    pub fn refine(&mut self, face: &mut FaceMesh<'_, '_>) -> Result<Proof, Setback> {
        if self.is_exact(face) {
            return Ok(Proof { error: 0.0, bound: "plane" });
        }
        let mut queue = Queue::of_all(face);
        let mut requests = ChordRequests::default();
        let (per_triangle, more) = if self.is_hopeless { HOPELESS_STEPS } else { STEPS };
        let most_steps = per_triangle * face.mesh().triangles.len() + more;
        let mut steps = 0usize;
        let mut sliver_passes = 0..SLIVER_PASSES;
        loop {
            let Some(t) = queue.triangles.pop_front() else {
                // 5. Triangles without area.
                if requests.is_empty() && sliver_passes.next().is_some() {
                    self.flip_slivers(face);
                    queue.take_changed(face);
                }
                if queue.triangles.is_empty() {
                    break;
                }
                continue;
            };
            if queue.is_judged(t) {
                continue;
            }
            steps += 1;
            if steps.is_multiple_of(STEPS_PER_LOOK) {
                self.check_time(face.mesh().triangles.len())?;
            }
            // 1. Bound the triangle.
            let (error, fault) = self.judge(face, t);
            queue.errors[t as usize] = error;
            match fault {
                None => continue,
                Some(Fault::Edge(_) | Fault::FoldingEdge(_)) if self.accepts() => continue,
                // 2. and 3. Chords that are too coarse.
                Some(Fault::Edge(i)) => requests.add(self.boundary_segment(face, t, i))?,
                Some(Fault::FoldingEdge(i)) if self.effort.has(Remedy::FinerChords) => {
                    requests.add_alike(face, self.boundary_segment(face, t, i))?;
                }
                Some(Fault::FoldingEdge(i)) => requests.add(self.boundary_segment(face, t, i))?,
                Some(Fault::Inside(_) | Fault::Fold(_)) if !requests.is_empty() => continue,
                Some(_) if steps > most_steps && self.accepts() => continue,
                Some(_) if steps > most_steps => return Err(Setback::Stuck),
                // 4. What can be mended inside.
                Some(fault @ (Fault::Inside(edge) | Fault::Fold(edge))) => {
                    self.check_size(face)?;
                    let is_flipped = matches!(fault, Fault::Fold(_)) && self.flip_helps(face, t);
                    if !is_flipped && !self.mend(face, t, error, edge) {
                        match self.coarse_boundary(face, t) {
                            _ if self.accepts() => continue,
                            Some(chord) => requests.push(chord),
                            None => return Err(Setback::Stuck),
                        }
                    }
                }
            }
            queue.take_changed(face);
        }
        requests.into_result()?;
        Ok(self.proof(queue.largest_error()))
    }

    /// True for a face on which every triangle is exact.
    fn is_exact(&self, face: &FaceMesh<'_, '_>) -> bool {
        matches!(self.bounds.surface(), Surface::Plane { .. })
            && self.limits.length.is_infinite()
            && face.context().doubled.is_empty()
    }

    /// The proof over triangles of which none is further off than `error`.
    pub fn proof(&self, error: f64) -> Proof {
        let bound = match self.bounds.surface() {
            _ if self.sampled => "sampled",
            _ if error.is_infinite() => "none",
            Surface::Cylinder { .. } => "cylinder",
            Surface::Cone { .. } => "cone",
            Surface::Sphere { .. } => "sphere",
            _ => "second derivatives",
        };
        Proof { error: if self.sampled { f64::NAN } else { error }, bound }
    }

    fn check_size(&self, face: &FaceMesh<'_, '_>) -> Result<(), MeshIssue> {
        let triangles = face.mesh().triangles.len();
        if triangles > self.most_triangles {
            return Err(MeshIssue::TooManyTriangles { triangles });
        }
        Ok(())
    }

    /// # Errors
    /// Where the job was cancelled or the face's time is over.
    pub fn check_time(&self, elements: usize) -> Result<(), MeshIssue> {
        if self.cancel.is_cancelled() {
            return Err(MeshIssue::Cancelled);
        }
        if self.budget.is_over() {
            return Err(MeshIssue::OutOfTime { elements });
        }
        Ok(())
    }

    /// The boundary segment opposite corner `i`, where there is one.
    pub fn boundary_segment(&self, face: &FaceMesh<'_, '_>, t: u32, i: usize) -> Option<Segment> {
        let corners = face.mesh().triangles[t as usize];
        face.segment(corners[(i + 1) % 3], corners[(i + 2) % 3])
    }
}

/// Triangles yet to be judged, and the bounds of the others.
struct Queue {
    triangles: VecDeque<u32>,
    /// One per triangle; NaN where it is not judged yet.
    errors: Vec<f64>,
}

impl Queue {
    fn of_all(face: &FaceMesh<'_, '_>) -> Self {
        let n = face.mesh().triangles.len();
        Self { triangles: (0..n as u32).collect(), errors: vec![f64::NAN; n] }
    }

    fn is_judged(&self, t: u32) -> bool {
        !self.errors[t as usize].is_nan()
    }

    /// Triangles that changed are to be judged anew.
    fn take_changed(&mut self, face: &mut FaceMesh<'_, '_>) {
        self.errors.resize(face.mesh().triangles.len(), f64::NAN);
        for t in face.mesh_mut().changed.drain(..) {
            self.errors[t as usize] = f64::NAN;
            self.triangles.push_back(t);
        }
    }

    fn largest_error(&self) -> f64 {
        self.errors.iter().fold(0.0f64, |m, &e| m.max(e))
    }
}
