//! What the stages of one face share.

use crate::budget::Budget;
use crate::closer::Closer;
use crate::shared_edge::SharedEdge;
use chordal_chart::TrimmedFace;

/// A face with what its mesh must keep to.
#[derive(Debug)]
pub(crate) struct FaceContext<'a, 's> {
    /// The face with its surface and its sampled edges.
    pub trimmed: TrimmedFace<'a, 's>,
    /// Inner edges that it must do without: another face has them.
    pub doubled: &'a [SharedEdge],
    /// Places at which its facets must keep a smaller tolerance.
    pub closer: &'a [Closer],
    /// When the face is given up.
    pub budget: Budget,
}

impl FaceContext<'_, '_> {
    /// True where the time of the face is over.
    pub fn is_out_of_time(&self) -> bool {
        self.budget.is_over()
    }
}
