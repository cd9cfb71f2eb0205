//! Chords of edges that a face requests to be finer.

use crate::effort::Setback;
use crate::face_mesh::FaceMesh;
use chordal_chart::Segment;

/// Chords with this share of the sagitta of another one are as coarse as that one: chords of equal length on
/// a circle differ by rounding, and by half where one of them is halved already.
const ALIKE: f64 = 0.5;

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

    /// Adds the chord of this segment, and all chords of its edge that are as far from the edge as this one.
    /// Facets fold one after the other over chords of one length: requests for one chord at a time would take
    /// a round for each.
    ///
    /// # Errors
    /// As [`ChordRequests::add`].
    pub fn add_alike(&mut self, face: &FaceMesh<'_, '_>, segment: Option<Segment>) -> Result<(), Setback> {
        self.add(segment)?;
        if let Some(Segment::Edge { edge, chord }) = segment {
            let sag = &face.edge_samples(edge).sag;
            let least = ALIKE * sag[chord as usize];
            self.0.extend((0..sag.len()).filter(|&k| sag[k] >= least).map(|k| (edge, k as u32)));
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
