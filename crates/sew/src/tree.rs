//! A tree of boxes over the chords of all borders: built by halving at the median, for queries by box and for
//! nearest items.

use chordal_nurbs::Box3;
use glam::DVec3;

/// Items in a leaf.
const LEAF: usize = 4;

#[derive(Clone, Copy, Debug)]
struct Node {
    bounds: Box3,
    /// The leaf's run of `order`; of an inner node (`count` zero) the index of its right child, the left one
    /// follows it.
    first: u32,
    count: u32,
}

/// Boxes with the numbers of what is in them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tree {
    nodes: Vec<Node>,
    order: Vec<u32>,
    boxes: Vec<Box3>,
}

impl Tree {
    pub fn new(boxes: Vec<Box3>) -> Self {
        let mut tree = Self { order: (0..boxes.len() as u32).collect(), boxes, nodes: Vec::new() };
        if !tree.boxes.is_empty() {
            let mut order = std::mem::take(&mut tree.order);
            tree.build(&mut order, 0);
            tree.order = order;
        }
        tree
    }

    fn build(&mut self, items: &mut [u32], offset: usize) {
        let bounds = items.iter().fold(Box3::EMPTY, |b, &i| b.union(self.boxes[i as usize]));
        let at = self.nodes.len();
        self.nodes.push(Node { bounds, first: offset as u32, count: items.len() as u32 });
        if items.len() <= LEAF {
            return;
        }
        let centres = items.iter().fold(Box3::EMPTY, |b, &i| b.including(self.boxes[i as usize].center()));
        let axis = (centres.max - centres.min).max_position();
        let middle = items.len() / 2;
        let key = |i: u32| self.boxes[i as usize].center()[axis];
        items.select_nth_unstable_by(middle, |&a, &b| key(a).total_cmp(&key(b)).then(a.cmp(&b)));
        let (left, right) = items.split_at_mut(middle);
        self.build(left, offset);
        let second = self.nodes.len() as u32;
        self.build(right, offset + middle);
        self.nodes[at] = Node { bounds, first: second, count: 0 };
    }

    /// Calls `found` with every item whose box meets `query`, in no order that means anything.
    pub fn visit(&self, query: Box3, mut found: impl FnMut(u32)) {
        let meets = |b: &Box3| b.min.cmple(query.max).all() && b.max.cmpge(query.min).all();
        let mut stack = if self.nodes.is_empty() { Vec::new() } else { vec![0_u32] };
        while let Some(at) = stack.pop() {
            let node = &self.nodes[at as usize];
            if !meets(&node.bounds) {
                continue;
            }
            if node.count == 0 {
                stack.extend([node.first, at + 1]);
                continue;
            }
            let items = &self.order[node.first as usize..(node.first + node.count) as usize];
            items.iter().filter(|&&i| meets(&self.boxes[i as usize])).for_each(|&i| found(i));
        }
    }

    /// The smallest `distance` of an item from `p`, where one is below `limit`. `distance` is `None` for
    /// items that do not count, and never less than the distance from the item's box.
    pub fn nearest(
        &self,
        p: DVec3,
        limit: f64,
        mut distance: impl FnMut(u32) -> Option<f64>,
    ) -> Option<(u32, f64)> {
        let mut best = (u32::MAX, limit);
        let mut stack = if self.nodes.is_empty() { Vec::new() } else { vec![(self.far(0, p), 0_u32)] };
        while let Some((far, at)) = stack.pop() {
            if far >= best.1 {
                continue;
            }
            let node = &self.nodes[at as usize];
            if node.count == 0 {
                let mut next = [(self.far(at + 1, p), at + 1), (self.far(node.first, p), node.first)];
                if next[0].0 < next[1].0 {
                    next.swap(0, 1);
                }
                stack.extend(next);
                continue;
            }
            for &i in &self.order[node.first as usize..(node.first + node.count) as usize] {
                let Some(d) = distance(i) else { continue };
                if d < best.1 || (d == best.1 && i < best.0) {
                    best = (i, d);
                }
            }
        }
        (best.0 != u32::MAX).then_some(best)
    }

    /// The distance of a node's box from `p`.
    fn far(&self, node: u32, p: DVec3) -> f64 {
        let b = &self.nodes[node as usize].bounds;
        (b.min - p).max(p - b.max).max(DVec3::ZERO).length()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn boxes() -> impl Strategy<Value = Vec<Box3>> {
        let one =
            (prop::array::uniform3(-9.0..9.0), prop::array::uniform3(0.0..2.0)).prop_map(|(at, size)| {
                let at = DVec3::from(at);
                Box3 { min: at, max: at + DVec3::from(size) }
            });
        prop::collection::vec(one, 0..60)
    }

    proptest! {
        #[test]
        fn finds_what_all_items_find(all in boxes(), at in prop::array::uniform3(-10.0..10.0)) {
            let p = DVec3::from(at);
            let tree = Tree::new(all.clone());
            let query = Box3 { min: p - 1.0, max: p + 1.0 };
            let mut found = Vec::new();
            tree.visit(query, |i| found.push(i));
            found.sort_unstable();
            let meets = |b: &Box3| b.min.cmple(query.max).all() && b.max.cmpge(query.min).all();
            let expected: Vec<u32> = (0..all.len() as u32).filter(|&i| meets(&all[i as usize])).collect();
            prop_assert_eq!(found, expected);

            let far = |i: u32| { let b = all[i as usize]; (b.min - p).max(p - b.max).max(DVec3::ZERO).length() };
            let nearest = tree.nearest(p, f64::INFINITY, |i| (i % 3 != 0).then(|| far(i)));
            let expected = (0..all.len() as u32).filter(|i| i % 3 != 0).map(far).min_by(f64::total_cmp);
            prop_assert_eq!(nearest.map(|n| n.1), expected);
        }
    }
}
