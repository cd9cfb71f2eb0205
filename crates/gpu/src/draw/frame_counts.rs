//! How much work a frame of exact faces was.

/// What one frame took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct FrameCounts {
    /// Faces drawn. A face of a part that is placed several times counts once for all placements that share
    /// its samples.
    pub faces: usize,
    /// Faces evaluated for this frame.
    pub evaluated: usize,
    /// Points of the faces evaluated for this frame.
    pub points: usize,
    /// Faces beyond the picture.
    pub outside: usize,
    /// Faces that show their backs.
    pub backs: usize,
    /// Placements beyond the picture.
    pub placements_outside: usize,
}
