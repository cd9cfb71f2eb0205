//! How far a job is.

use crate::resolve::Resolved;
use chordal_brep::{Model, Part};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// How far a job is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Progress {
    Reading,
    /// Shared edges of loose faces are being inferred.
    Sewing,
    /// The tolerance is being resolved: the box of the model.
    Measuring,
    /// So many of the distinct faces are done.
    Meshing {
        done: usize,
        faces: usize,
    },
    Auditing,
    Writing,
}

/// Called from any thread.
pub type OnProgress = Arc<dyn Fn(Progress) + Send + Sync>;

/// Adds up the faces that are done over all parts.
pub(crate) struct FaceCounter<'a> {
    done: AtomicUsize,
    faces: usize,
    tell: &'a (dyn Fn(Progress) + Sync),
}

/// The faces of one part that are done.
pub(crate) struct PartCounter<'a> {
    of_part: AtomicUsize,
    faces: usize,
    all: &'a FaceCounter<'a>,
}

impl<'a> FaceCounter<'a> {
    pub fn start(model: &Model, resolved: &Resolved, tell: &'a (dyn Fn(Progress) + Sync)) -> Self {
        let placed = model.parts.iter().zip(&resolved.uses).filter(|(_, u)| u.instances > 0);
        let faces = placed.map(|(p, _)| p.faces.len()).sum();
        tell(Progress::Meshing { done: 0, faces });
        Self { done: AtomicUsize::new(0), faces, tell }
    }
    pub fn part(&'a self, part: &Part) -> PartCounter<'a> {
        PartCounter { of_part: AtomicUsize::new(0), faces: part.faces.len(), all: self }
    }
}

impl PartCounter<'_> {
    /// `done` faces of this part are finished by now, those that ran again counted again; calls may arrive out of
    /// order.
    pub fn done(&self, done: usize) {
        let done = done.min(self.faces);
        let before = self.of_part.fetch_max(done, Ordering::Relaxed);
        let more = done.saturating_sub(before);
        if more > 0 {
            let done = self.all.done.fetch_add(more, Ordering::Relaxed) + more;
            (self.all.tell)(Progress::Meshing { done, faces: self.all.faces });
        }
    }
}
