//! How much work a frame of exact faces was.

/// What one frame took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct FrameCounts {
    /// Faces drawn, those of parts that are placed several times once for all placements that share samples.
    pub faces: usize,
    /// Faces evaluated for this frame, and their points.
    pub evaluated: usize,
    pub points: usize,
    /// Faces beyond the picture, and faces that show their backs.
    pub outside: usize,
    pub backs: usize,
    /// Placements beyond the picture.
    pub placements_outside: usize,
}
