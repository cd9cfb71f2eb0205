//! Chords of edges that a face asks to be made finer.

use crate::effort::Setback;
use chordal_chart::Segment;

/// Chords by edge and index.
#[derive(Debug, Default)]
pub(crate) struct ChordRequests(Vec<(u32, u32)>);

impl ChordRequests {
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub fn push(&mut self, chord: (u32, u32)) {
        self.0.push(chord);
    }

    /// Adds the chord of this segment.
    ///
    /// # Errors
    /// Where the segment is no chord of an edge: then a seam is too coarse.
    pub fn add(&mut self, segment: Option<Segment>) -> Result<(), Setback> {
        match segment {
            Some(Segment::Edge { edge, chord }) => self.push((edge, chord)),
            _ => return Err(Setback::CoarseSeam),
        }
        Ok(())
    }

    /// # Errors
    /// Where there is a request: all of them, sorted, each once.
    pub fn into_result(mut self) -> Result<(), Setback> {
        if self.0.is_empty() {
            return Ok(());
        }
        self.0.sort_unstable();
        self.0.dedup();
        Err(Setback::CoarseEdges(self.0))
    }
}
