//! Which patches belong to a face, by scanlines.
//!
//! Source: Ma and Hewitt 2002, section 4.3. Lines of constant v lie evenly over the box of the outer loop,
//! the denser the finer the tolerance. Each is cut by the loops in an even number of places, between which it
//! runs inside and outside by turns:
//!
//! ```text
//!            ╭────╮
//!   ─────────┼╌╌╌╌┼───────        ╌ inside        2 crossings
//!     ╭──╮   │    │
//!   ──┴──┴───┼╌╌╌╌┼───────        touched along a chord: its ends, as a pair
//!            ╰─v──╯
//!   ───────────x──────────        touched in a point: that point twice, so that the number stays even
//! ```
//!
//! A patch that a loop meets is cut. For every other patch, one line through it decides whether it is inside;
//! a patch between two lines gets a line of its own.

use super::loop_tree::LoopTree;
use chordal_nurbs::{DVec2, UvBox};

/// The position of a patch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    Inside,
    Outside,
    /// A loop meets it.
    Cut,
}

/// Neither fewer nor more lines than this.
const LINES: (f64, f64) = (2.0, 4096.0);

/// Lines over the box of a face's loops.
#[derive(Debug)]
pub struct Scanlines {
    loops: Vec<LoopTree>,
    low: f64,
    step: f64,
    lines: Vec<Vec<f64>>,
    /// Tangent points that were repeated.
    pub tangent: usize,
}

/// The number of lines for which two neighbours are as far apart as the ends of a chord over an arc as wide
/// as the face: as many as patches where the face bends half around.
pub fn lines_for(height_xyz: f64, tolerance: f64) -> usize {
    (height_xyz / tolerance).sqrt().ceil().clamp(LINES.0, LINES.1) as usize
}

impl Scanlines {
    /// `count` lines across the polygons.
    pub fn new(polygons: &[Vec<DVec2>], count: usize) -> Self {
        let loops: Vec<LoopTree> = polygons.iter().map(|p| LoopTree::new(p)).collect();
        let bounds = UvBox::from_points(polygons.iter().flatten().copied());
        let step = bounds.size().y / count as f64;
        let mut found = Self { loops, low: bounds.min.y, step, lines: Vec::with_capacity(count), tangent: 0 };
        for k in 0..count {
            let (line, tangent) = found.crossings(found.level(k));
            found.tangent += tangent;
            found.lines.push(line);
        }
        found
    }

    /// How many lines there are.
    pub fn count(&self) -> usize {
        self.lines.len()
    }

    fn level(&self, k: usize) -> f64 {
        self.low + (k as f64 + 0.5) * self.step
    }

    pub fn place(&self, patch: UvBox) -> Place {
        if self.loops.iter().any(|tree| tree.meets(patch)) {
            return Place::Cut;
        }
        let middle = patch.center();
        let nearest = ((middle.y - self.low) / self.step).floor().max(0.0) as usize;
        let is_through = |k: &usize| {
            *k < self.lines.len() && self.level(*k) >= patch.min.y && self.level(*k) <= patch.max.y
        };
        let own;
        let line = match is_through(&nearest) {
            true => &self.lines[nearest],
            false => {
                own = self.crossings(middle.y).0;
                &own
            }
        };
        let before = line.iter().filter(|&&u| u <= middle.x).count();
        if before % 2 == 1 { Place::Inside } else { Place::Outside }
    }

    /// Where the loops cut a line, in order, and how many points were repeated.
    fn crossings(&self, level: f64) -> (Vec<f64>, usize) {
        let (mut line, mut tangent) = (Vec::new(), 0);
        for tree in self.loops.iter().filter(|t| t.bounds().min.y <= level && t.bounds().max.y >= level) {
            tangent += cross(tree, level, &mut line);
        }
        line.sort_unstable_by(f64::total_cmp);
        debug_assert!(line.len().is_multiple_of(2), "closed loops cross a line evenly");
        (line, tangent)
    }
}

/// Adds the places where one loop cuts the line; returns how many tangent points there are.
fn cross(tree: &LoopTree, level: f64, line: &mut Vec<f64>) -> usize {
    let mut tangent = 0;
    for k in tree.reaching(level) {
        let [p, q] = tree.chord(k);
        // On the line counts as below it: a point touched from above is a crossing of either of its chords
        // already.
        if (p.y > level) != (q.y > level) {
            line.push(p.x + (level - p.y) / (q.y - p.y) * (q.x - p.x));
        }
        if p.y != level && q.y == level {
            let (left, next) = beyond(tree, k, level);
            let same_side = (p.y > level) == (next.y > level) && next.y != level;
            tangent += usize::from(same_side);
            if same_side && p.y < level {
                line.extend([q.x, left.x]);
            }
        }
    }
    tangent
}

/// The last point on the line after chord `k`, which ends there, and the first one off it.
fn beyond(tree: &LoopTree, k: u32, level: f64) -> (DVec2, DVec2) {
    let n = tree.count();
    let mut at = k;
    for _ in 0..n {
        at = (at + 1) % n;
        let [p, q] = tree.chord(at);
        if q.y != level {
            return (p, q);
        }
    }
    let [p, q] = tree.chord(k);
    (p, q)
}

#[cfg(test)]
mod tests {
    use super::*;
    use chordal_nurbs::math;
    use proptest::prelude::*;

    fn square(a: f64, b: f64) -> Vec<DVec2> {
        [(a, a), (b, a), (b, b), (a, b)].map(DVec2::from).to_vec()
    }

    fn cell(a: (f64, f64), b: (f64, f64)) -> UvBox {
        UvBox::new(DVec2::from(a), DVec2::from(b))
    }

    #[test]
    fn patches_of_a_square_with_a_diamond_hole() {
        let diamond = [(2., 1.), (1., 2.), (2., 3.), (3., 2.)].map(DVec2::from).to_vec();
        // Four lines at ½, 1½, …: one through every patch of side 1, none through the small ones.
        let lines = Scanlines::new(&[square(0., 4.), diamond], 4);
        assert_eq!(lines.place(cell((0.1, 0.1), (0.9, 0.9))), Place::Inside);
        assert_eq!(lines.place(cell((1.6, 1.6), (2.4, 2.4))), Place::Outside);
        assert_eq!(lines.place(cell((1.0, 1.0), (2.0, 2.0))), Place::Cut);
        assert_eq!(lines.place(cell((0.1, 0.6), (0.2, 0.7))), Place::Inside);
        assert_eq!(lines.place(cell((4.1, 0.6), (4.2, 0.7))), Place::Outside);
        assert_eq!(lines.place(cell((0.0, 0.0), (1.0, 1.0))), Place::Cut, "its side lies on the loop");
    }

    #[test]
    fn tangent_points_are_repeated() {
        // The diamond's lowest and highest corners, and the sides of the square, lie on lines: 0 < v < 4,
        // lines at ½, 1½, …
        let diamond = |v: f64| [(2., v), (1., v + 1.), (2., v + 2.), (3., v + 1.)].map(DVec2::from).to_vec();
        let lines = Scanlines::new(&[square(0., 4.), diamond(0.5)], 4);
        assert_eq!(lines.lines[0], [0.0, 2.0, 2.0, 4.0], "touched from above");
        assert_eq!(lines.lines[2], [0.0, 2.0, 2.0, 4.0], "touched from below");
        assert_eq!(lines.lines[1], [0.0, 1.0, 3.0, 4.0]);
        assert_eq!(lines.tangent, 2);
        // A flat top is a pair of its ends.
        let house = [(1., 0.5), (3., 0.5), (3., 1.5), (2., 1.5), (1., 1.5)].map(DVec2::from).to_vec();
        let lines = Scanlines::new(&[square(0., 4.), house], 4);
        assert_eq!(lines.lines[1], [0.0, 1.0, 3.0, 4.0]);
        assert_eq!(lines.lines[0], [0.0, 1.0, 3.0, 4.0]);
    }

    #[test]
    fn lines_get_denser_with_the_tolerance() {
        assert_eq!(lines_for(100.0, 0.01), 100);
        assert_eq!(lines_for(100.0, 0.0001), 1000);
        assert_eq!(lines_for(1.0, 1e-30), 4096);
        assert_eq!(lines_for(0.0, 1.0), 2);
    }

    /// A star-shaped polygon of integer corners, so that many lie on lines.
    fn star(radii: &[u8]) -> Vec<DVec2> {
        let n = radii.len() as f64;
        let corner = |(i, &r): (usize, &u8)| {
            let angle = std::f64::consts::TAU * i as f64 / n;
            (math::direction(angle) * f64::from(r)).round() + 16.5
        };
        radii.iter().enumerate().map(corner).collect()
    }

    proptest! {
        #[test]
        fn patches_are_where_counting_around_a_point_says(
            radii in prop::collection::vec(6u8..16, 5..24), hole in prop::collection::vec(1u8..4, 5..12),
            (x, y, w, h) in (0u8..33, 0u8..33, 1u8..6, 1u8..6), count in 1usize..40,
        ) {
            let polygons = [star(&radii), star(&hole)];
            let lines = Scanlines::new(&polygons, count);
            prop_assert!(lines.lines.iter().all(|l| l.len().is_multiple_of(2)));
            let low = DVec2::new(f64::from(x), f64::from(y)) + 0.25;
            let patch = UvBox::new(low, low + DVec2::new(f64::from(w), f64::from(h)) / 2.0);
            let place = lines.place(patch);
            // Brute force: the sum of angles around the middle, of every loop.
            let turns = |polygon: &Vec<DVec2>| {
                let c = patch.center();
                let n = polygon.len();
                let angle = |i: usize| math::angle_to(polygon[i] - c, polygon[(i + 1) % n] - c);
                ((0..n).map(angle).sum::<f64>() / std::f64::consts::TAU).round() as i64
            };
            if place != Place::Cut {
                let inside = polygons.iter().map(turns).sum::<i64>() % 2 != 0;
                prop_assert_eq!(place == Place::Inside, inside);
            }
        }
    }
}
