//! Frames that show all of a model and need nothing but what the frame before them drew: no face is looked
//! at.

use super::frame_counts::FrameCounts;
use super::visible::{Level, Visible};
use std::ops::Range;

/// What a frame showed, where it showed all faces of all levels.
#[derive(Debug)]
pub(crate) struct StillFrame {
    levels: Vec<StillLevel>,
    counts: FrameCounts,
}

#[derive(Debug)]
struct StillLevel {
    shape: usize,
    class: i32,
    placed: Range<u32>,
    /// The errors between which all samples serve.
    served: [f64; 2],
}

impl StillFrame {
    /// Of a frame; `served` gives for a level the errors between which the samples of each face serve, if all
    /// faces have samples.
    pub fn of(
        visible: &Visible,
        counts: &FrameCounts,
        served: impl Fn(&Level) -> Option<Vec<[f64; 2]>>,
    ) -> Option<Self> {
        if counts.outside > 0 || counts.backs > 0 {
            return None;
        }
        let mut levels = Vec::new();
        for level in &visible.levels {
            let of_faces = served(level).filter(|_| level.whole)?;
            let both = |a: [f64; 2], b: &[f64; 2]| [a[0].max(b[0]), a[1].min(b[1])];
            levels.push(StillLevel {
                shape: level.shape,
                class: level.class,
                placed: level.placed.clone(),
                served: of_faces.iter().fold([0.0, f64::INFINITY], both),
            });
        }
        Some(Self { levels, counts: FrameCounts { evaluated: 0, points: 0, ..*counts } })
    }

    /// The counts of a frame that needs nothing else; `closed` marks the parts that may have faces that are
    /// left out for showing their backs.
    pub fn counts(&self, visible: &Visible, leave_out_backs: bool, closed: &[bool]) -> Option<FrameCounts> {
        let same = |(was, is): (&StillLevel, &Level)| {
            (was.shape, was.class, &was.placed) == (is.shape, is.class, &is.placed)
                && is.whole
                && !(leave_out_backs && closed[is.shape])
                && (was.served[0]..=was.served[1]).contains(&is.error)
        };
        let all = self.levels.len() == visible.levels.len();
        (all && self.levels.iter().zip(&visible.levels).all(same)).then_some(self.counts)
    }
}
