//! A quadtree of the chords of one trimming loop: which boxes it meets.
//!
//! Source: Ma and Hewitt 2002, abstract and section 4.3: the inner loops are kept in quadtrees, with which
//! patches are compared.

use super::region::chord_meets;
use chordal_nurbs::{DVec2, UvBox};

/// Leaves with more chords are cut into four.
const MOST_CHORDS: usize = 8;

/// Where many chords meet in one point, cutting does not part them.
const DEEPEST: usize = 16;

/// One loop's chords by place.
#[derive(Debug)]
pub struct LoopTree {
    chords: Vec<[DVec2; 2]>,
    root: Node,
}

#[derive(Debug)]
struct Node {
    bounds: UvBox,
    content: Content,
}

#[derive(Debug)]
enum Content {
    Chords(Vec<u32>),
    Quarters(Box<[Node; 4]>),
}

impl LoopTree {
    /// Of a closed polygon.
    pub fn new(polygon: &[DVec2]) -> Self {
        let n = polygon.len();
        let chords: Vec<[DVec2; 2]> = (0..n).map(|i| [polygon[i], polygon[(i + 1) % n]]).collect();
        let bounds = UvBox::from_points(polygon.iter().copied());
        let all = (0..n as u32).collect();
        let root = Node::new(bounds, all, &chords, 0);
        Self { chords, root }
    }

    /// The loop's box.
    pub fn bounds(&self) -> UvBox {
        self.root.bounds
    }

    /// True where the loop has a point in the closed box.
    pub fn meets(&self, b: UvBox) -> bool {
        self.root.any(b, &mut |k| {
            let [p, q] = self.chords[k as usize];
            chord_meets(p, q, b)
        })
    }

    /// The chords whose boxes reach the line v = `level`, each once, in their order.
    pub fn reaching(&self, level: f64) -> Vec<u32> {
        let b = self.bounds();
        let line = UvBox::new(DVec2::new(b.min.x, level), DVec2::new(b.max.x, level));
        let mut found = Vec::new();
        self.root.any(line, &mut |k| {
            let [p, q] = self.chords[k as usize];
            if p.y.min(q.y) <= level && p.y.max(q.y) >= level {
                found.push(k);
            }
            false
        });
        found.sort_unstable();
        found.dedup();
        found
    }

    /// How many chords there are.
    pub fn count(&self) -> u32 {
        self.chords.len() as u32
    }

    pub fn chord(&self, k: u32) -> [DVec2; 2] {
        self.chords[k as usize]
    }
}

impl Node {
    fn new(bounds: UvBox, chords: Vec<u32>, all: &[[DVec2; 2]], depth: usize) -> Self {
        if chords.len() <= MOST_CHORDS || depth == DEEPEST {
            return Self { bounds, content: Content::Chords(chords) };
        }
        let c = bounds.center();
        let quarter = |high_u: bool, high_v: bool| {
            let mut b = bounds;
            if high_u {
                b.min.x = c.x
            } else {
                b.max.x = c.x
            }
            if high_v {
                b.min.y = c.y
            } else {
                b.max.y = c.y
            }
            let own = chords.iter().copied().filter(|&k| {
                let [p, q] = all[k as usize];
                chord_meets(p, q, b)
            });
            Self::new(b, own.collect(), all, depth + 1)
        };
        let quarters =
            [quarter(false, false), quarter(true, false), quarter(false, true), quarter(true, true)];
        Self { bounds, content: Content::Quarters(Box::new(quarters)) }
    }

    /// True as soon as `test` is for a chord in a leaf that meets the box.
    fn any(&self, b: UvBox, test: &mut dyn FnMut(u32) -> bool) -> bool {
        if !(self.bounds.min.cmple(b.max).all() && self.bounds.max.cmpge(b.min).all()) {
            return false;
        }
        match &self.content {
            Content::Chords(chords) => chords.iter().any(|&k| test(k)),
            Content::Quarters(quarters) => quarters.iter().any(|q| q.any(b, test)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_tree_finds_what_a_look_at_every_chord_finds(
            points in prop::collection::vec((0u8..32, 0u8..32), 3..60),
            (x, y, w, h) in (0u8..32, 0u8..32, 0u8..9, 0u8..9),
        ) {
            let p = |&(x, y): &(u8, u8)| DVec2::new(f64::from(x), f64::from(y));
            let polygon: Vec<DVec2> = points.iter().map(p).collect();
            let tree = LoopTree::new(&polygon);
            let low = p(&(x, y));
            let b = UvBox::new(low, low + p(&(w, h)));
            let n = polygon.len();
            let chord = |i: usize| (polygon[i], polygon[(i + 1) % n]);
            prop_assert_eq!(tree.meets(b), (0..n).any(|i| chord_meets(chord(i).0, chord(i).1, b)));
            let reach = |i: &usize| {
                let (p, q) = chord(*i);
                p.y.min(q.y) <= low.y && p.y.max(q.y) >= low.y
            };
            let brute: Vec<u32> = (0..n).filter(reach).map(|i| i as u32).collect();
            prop_assert_eq!(tree.reaching(low.y), brute);
        }
    }
}
