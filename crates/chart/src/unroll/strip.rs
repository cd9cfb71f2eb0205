//! Holes of a surface that is closed in both directions, moved into the strip that the face occupies.
//!
//! Notation: `turn` and `step` are the period vectors of the chart, along the border of the face and across
//! it.

use crate::trimmed_face::OpenLoop;
use chordal_nurbs::DVec2;

/// Moves each hole by a multiple of `step` into the face: the strip between the loop `a`, continued by
/// multiples of `turn`, and its copy one `step` further.
pub(super) fn move_into_strip(holes: &mut [OpenLoop], a: &OpenLoop, turn: DVec2, step: DVec2) {
    let border = Border::new(a, turn, step);
    for hole in holes {
        let by = border.steps_into(hole);
        if by != 0.0 {
            hole.points = super::shifted(&hole.points, -step * by);
        }
    }
}

/// A periodic loop, in coordinates along `turn` and `step`.
struct Border {
    turn: DVec2,
    step: DVec2,
    /// The points of one period, and the first point of the next.
    points: Vec<DVec2>,
    middle: f64,
}

/// How many steps to either side of the mean position of a hole are tried. The mean position of a border that
/// folds back on itself may lie outside the strip that the border bounds there.
const STEPS_ASIDE: i32 = 4;

impl Border {
    fn new(a: &OpenLoop, turn: DVec2, step: DVec2) -> Self {
        let mut border = Self { turn, step, points: Vec::new(), middle: 0.0 };
        border.points = a.points.iter().map(|p| border.place(p.uv)).collect();
        border.middle = border.points.iter().map(|p| p.y).sum::<f64>() / border.points.len() as f64;
        border.points.push(border.points[0] + DVec2::X);
        border
    }

    /// A point in coordinates along `turn` and `step`.
    fn place(&self, p_uv: DVec2) -> DVec2 {
        DVec2::new(p_uv.perp_dot(self.step), self.turn.perp_dot(p_uv)) / self.turn.perp_dot(self.step)
    }

    /// The number of steps from the strip behind the border to the strip with most of the hole's points.
    fn steps_into(&self, hole: &OpenLoop) -> f64 {
        let places: Vec<DVec2> = hole.points.iter().map(|p| self.place(p.uv)).collect();
        let mean = places.iter().map(|p| p.y).sum::<f64>() / places.len() as f64;
        let guess = (mean - self.middle).floor();
        let beside = |by: f64| {
            let held = |p: &&DVec2| {
                let p = **p - DVec2::Y * by;
                self.is_beyond(p) && !self.is_beyond(p - DVec2::Y)
            };
            2 * places.iter().filter(held).count() > places.len()
        };
        let aside = (1..=STEPS_ASIDE).flat_map(|k| [k, -k]);
        let mut tried = std::iter::once(0).chain(aside).map(|k| guess + f64::from(k));
        tried.find(|&by| beside(by)).unwrap_or(guess)
    }

    /// True if the point lies beyond the border: the ray from it against `step` crosses the border an odd
    /// number of times.
    fn is_beyond(&self, p: DVec2) -> bool {
        let crossings = self.points.windows(2).map(|side| {
            let (a, b) = (side[0], side[1]);
            let (low, high) = (a.x.min(b.x), a.x.max(b.x));
            // The periods k with low + k <= p.x < high + k.
            let (first, last) = ((p.x - high).floor() as i64 + 1, (p.x - low).floor() as i64);
            let behind = |&k: &i64| {
                let share = (p.x - k as f64 - a.x) / (b.x - a.x);
                a.y + (b.y - a.y) * share < p.y
            };
            (first..=last).filter(behind).count()
        });
        crossings.sum::<usize>() % 2 == 1
    }
}
