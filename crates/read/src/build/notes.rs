//! Warnings, counted rather than kept where there are too many.

use chordal_brep::{Source, Warning};
use std::cell::{Cell, RefCell};

/// More warnings than this are counted, not kept.
const MAX_WARNINGS: usize = 10_000;

/// The warnings of one file.
#[derive(Debug, Default)]
pub(crate) struct Notes {
    kept: RefCell<Vec<Warning>>,
    dropped: Cell<usize>,
    dropped_lost: Cell<bool>,
}

impl Notes {
    /// Something was repaired, guessed or left out.
    pub(crate) fn warn(&self, source: Source, message: impl Into<String>) {
        self.push(Warning { source, message: message.into(), lost: false });
    }

    /// Some of the file's shape will be missing.
    pub(crate) fn lose(&self, source: Source, message: impl Into<String>) {
        self.push(Warning { source, message: message.into(), lost: true });
    }

    fn push(&self, warning: Warning) {
        let mut kept = self.kept.borrow_mut();
        if kept.len() < MAX_WARNINGS {
            kept.push(warning);
        } else {
            self.dropped.set(self.dropped.get() + 1);
            self.dropped_lost.set(self.dropped_lost.get() || warning.lost);
        }
    }

    pub(crate) fn first(&self) -> Option<Warning> {
        self.kept.borrow().first().cloned()
    }

    /// All of them.
    pub(crate) fn take(&self) -> Vec<Warning> {
        let mut all = self.kept.take();
        if self.dropped.get() > 0 {
            let message = format!("{} further warnings are not listed", self.dropped.get());
            all.push(Warning { source: Source::default(), message, lost: self.dropped_lost.get() });
        }
        all
    }
}
