//! The issues of one file, counted rather than kept where there are too many.

use chordal_brep::{Issue, ReadIssue, Severity, Source};
use std::cell::{Cell, RefCell};

/// More issues than this are counted, not kept: a broken file of a gigabyte could fill the memory with them.
const MAX_ISSUES: usize = 10_000;

/// The issues of one file.
#[derive(Debug, Default)]
pub(crate) struct Notes {
    kept: RefCell<Vec<Issue>>,
    dropped: Cell<usize>,
    dropped_error: Cell<bool>,
}

impl Notes {
    /// Something was repaired, guessed or ignored; no geometry is missing.
    pub(crate) fn warn(&self, source: Source, issue: impl Into<ReadIssue>) {
        self.push(Issue::warning(source, issue.into()));
    }

    /// Geometry of the file will be missing.
    pub(crate) fn lose(&self, source: Source, issue: impl Into<ReadIssue>) {
        self.push(Issue::error(source, issue.into()));
    }

    pub(crate) fn push(&self, issue: Issue) {
        let mut kept = self.kept.borrow_mut();
        if kept.len() < MAX_ISSUES {
            kept.push(issue);
        } else {
            self.dropped.set(self.dropped.get() + 1);
            self.dropped_error.set(self.dropped_error.get() || issue.is_error());
        }
    }

    pub(crate) fn first(&self) -> Option<Issue> {
        self.kept.borrow().first().cloned()
    }

    /// All of them, the number of those not kept at the end.
    pub(crate) fn take(&self) -> Vec<Issue> {
        let mut all = self.kept.take();
        let issues = self.dropped.take();
        if issues > 0 {
            let severity = if self.dropped_error.take() { Severity::Error } else { Severity::Warning };
            all.push(Issue::new(severity, Source::default(), ReadIssue::NotListed { issues }));
        }
        all
    }
}
