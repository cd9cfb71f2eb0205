//! Points and segments.

use crate::Vector;

/// Where the point of the segment from `a` to `b` that is closest to `p` lies: 0 at `a`, 1 at `b`. 0 for a
/// segment without length.
///
/// ```
/// use chordal_nurbs::{DVec2, segment_foot};
/// let (a, b) = (DVec2::ZERO, DVec2::new(4.0, 0.0));
/// assert_eq!(segment_foot(DVec2::new(1.0, 7.0), a, b), 0.25);
/// assert_eq!(segment_foot(DVec2::new(-1.0, 7.0), a, b), 0.0);
/// ```
pub fn segment_foot<V: Vector>(p: V, a: V, b: V) -> f64 {
    let (along, to) = (b - a, p - a);
    let squared = along.dot(along);
    if squared > 0.0 { (to.dot(along) / squared).clamp(0.0, 1.0) } else { 0.0 }
}

/// The distance of `p` from the segment between `a` and `b`.
pub fn segment_distance<V: Vector>(p: V, a: V, b: V) -> f64 {
    (p - a - (b - a) * segment_foot(p, a, b)).norm()
}
