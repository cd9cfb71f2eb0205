//! Why an entity cannot be used.

use chordal_brep::{Issue, ReadIssue, Source};

/// What is wrong, and the entity with which it is wrong.
///
/// One pointer wide, since nearly every function of a reader returns it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Bad(Box<(Source, ReadIssue)>);

impl Bad {
    pub(crate) fn new(source: Source, issue: impl Into<ReadIssue>) -> Self {
        Self(Box::new((source, issue.into())))
    }

    pub(crate) fn source(&self) -> Source {
        self.0.0
    }

    pub(crate) fn issue(&self) -> &ReadIssue {
        &self.0.1
    }

    /// As the reason of an issue of `owner`, which is not named again.
    pub(crate) fn into_cause(self, owner: Source) -> Box<Issue> {
        let source = if self.0.0 == owner { Source::default() } else { self.0.0 };
        Box::new(Issue::error(source, self.0.1))
    }

    /// As an issue of a shape that will be missing.
    pub(crate) fn into_error(self) -> Issue {
        Issue::error(self.0.0, self.0.1)
    }
}

/// A result whose error names an entity and what is wrong with it.
pub(crate) type Res<T> = Result<T, Bad>;
