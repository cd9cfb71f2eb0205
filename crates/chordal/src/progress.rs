//! How far a run is, and whether it goes on.

use crate::error::Error;
use crate::resolve::Resolved;
use chordal_brep::{Model, Part};
use chordal_tessellate::Cancel;
use std::fmt;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The phases of meshing a model, in their order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Phase {
    /// Faces that share no edges are joined.
    Sewing,
    /// The model is measured, so that a percentage becomes a length.
    Measuring,
    /// Faces are meshed.
    Meshing,
    /// The mesh is checked.
    Auditing,
}

/// Receives the progress, and may cancel.
#[derive(Clone, Default)]
pub(crate) struct Listener {
    call: Option<Call>,
    cancel: Cancel,
}

type Call = Arc<dyn Fn(Phase, f64) -> ControlFlow<()> + Send + Sync>;

impl fmt::Debug for Listener {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Listener").field("cancel", &self.cancel).finish_non_exhaustive()
    }
}

impl Listener {
    pub fn set_call(&mut self, call: impl Fn(Phase, f64) -> ControlFlow<()> + Send + Sync + 'static) {
        self.call = Some(Arc::new(call));
    }
    pub fn set_cancel(&mut self, cancel: Cancel) {
        self.cancel = cancel;
    }
    /// Starts a run. If the callback cancels one run, later runs are not affected.
    pub fn start(&self) -> Run {
        Run { call: self.call.clone(), cancel: self.cancel.child() }
    }
}

/// Progress of one run.
pub(crate) struct Run {
    call: Option<Call>,
    cancel: Cancel,
}

impl Run {
    /// Reports that a phase is done to this fraction.
    pub fn tell(&self, phase: Phase, fraction: f64) {
        if self.call.as_ref().is_some_and(|call| call(phase, fraction).is_break()) {
            self.cancel.cancel();
        }
    }

    /// The flag that the stages look at.
    pub fn cancel(&self) -> &Cancel {
        &self.cancel
    }

    /// # Errors
    /// [`Error::Cancelled`] where the caller cancelled.
    pub fn check(&self) -> Result<(), Error> {
        if self.cancel.is_cancelled() { Err(Error::Cancelled) } else { Ok(()) }
    }
}

/// Adds up the faces that are done over all parts.
pub(crate) struct FaceCounter<'a> {
    done: AtomicUsize,
    faces: usize,
    tell: &'a (dyn Fn(f64) + Sync),
}

/// The faces of one part that are done.
pub(crate) struct PartCounter<'a> {
    of_part: AtomicUsize,
    faces: usize,
    all: &'a FaceCounter<'a>,
}

impl<'a> FaceCounter<'a> {
    /// `tell` receives the finished fraction.
    pub fn start(model: &Model, resolved: &Resolved, tell: &'a (dyn Fn(f64) + Sync)) -> Self {
        let placed = model.parts.iter().zip(&resolved.uses).filter(|(_, u)| u.instances > 0);
        let faces = placed.map(|(p, _)| p.faces.len()).sum();
        tell(0.0);
        Self { done: AtomicUsize::new(0), faces, tell }
    }
    pub fn part(&'a self, part: &Part) -> PartCounter<'a> {
        PartCounter { of_part: AtomicUsize::new(0), faces: part.faces.len(), all: self }
    }
}

impl PartCounter<'_> {
    /// `done` faces of this part are finished by now, those that ran again counted again; calls may arrive
    /// out of order.
    pub fn done(&self, done: usize) {
        let done = done.min(self.faces);
        let before = self.of_part.fetch_max(done, Ordering::Relaxed);
        let more = done.saturating_sub(before);
        if more > 0 {
            let done = self.all.done.fetch_add(more, Ordering::Relaxed) + more;
            (self.all.tell)(done as f64 / self.all.faces as f64);
        }
    }
}
