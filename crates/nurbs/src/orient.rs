//! On which side of a line a point of the plane lies.

use crate::{DVec2, work};

/// The work of one test.
const TEST: u64 = 4;

/// A number with the exact sign of the turn a → b → c: positive where it is to the left, 0 only where the
/// three points are on one line.
pub fn orient(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    work::count(TEST);
    let coord = |p: DVec2| robust::Coord { x: p.x, y: p.y };
    robust::orient2d(coord(a), coord(b), coord(c))
}
