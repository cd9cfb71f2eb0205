//! A tree of boxes, split at the median of their centres: items whose boxes meet a box, pairs of items whose
//! boxes meet, and the nearest item, without a look at all of them.

use crate::Box3;
use glam::DVec3;

/// Items in a leaf: below about this many, testing all of them is cheaper than descending.
const LEAF: usize = 8;

/// Items with boxes, prepared for searches.
#[derive(Clone, Debug, Default)]
pub struct BoxTree {
    nodes: Vec<Node>,
    /// Items in the order of the leaves, each with its box.
    items: Vec<(Box3, u32)>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    bounds: Box3,
    first: u32,
    count: u32,
    /// The second child; the first follows its parent. 0: a leaf.
    second: u32,
}

impl BoxTree {
    /// A tree over boxes; item i is the i-th box.
    pub fn new(boxes: impl IntoIterator<Item = Box3>) -> Self {
        let mut items: Vec<(Box3, u32)> = boxes.into_iter().zip(0..).collect();
        let mut nodes = Vec::with_capacity(items.len());
        if !items.is_empty() {
            build(&mut items, 0, &mut nodes);
        }
        Self { nodes, items }
    }

    /// Calls `visit` once for every item whose box meets `query`, in no order that means anything.
    pub fn meeting(&self, query: Box3, mut visit: impl FnMut(u32)) {
        let mut stack = self.root();
        while let Some(at) = stack.pop() {
            let node = &self.nodes[at as usize];
            if !node.bounds.meets(&query) {
                continue;
            }
            if node.second != 0 {
                stack.extend([at + 1, node.second]);
                continue;
            }
            self.leaf(at)
                .iter()
                .filter(|(bounds, _)| bounds.meets(&query))
                .for_each(|&(_, item)| visit(item));
        }
    }

    /// The item with the smallest `distance` up to `limit` from `p`, and that distance; of several, the one
    /// with the lowest index. `distance` is `None` for items that do not count, and never less than the
    /// distance from the item's box.
    pub fn nearest(
        &self,
        p: DVec3,
        limit: f64,
        mut distance: impl FnMut(u32) -> Option<f64>,
    ) -> Option<(u32, f64)> {
        let far = |node: u32| self.nodes[node as usize].bounds.distance(p);
        let mut best = (u32::MAX, limit);
        let mut stack: Vec<(f64, u32)> = self.root().into_iter().map(|root| (far(root), root)).collect();
        while let Some((least, at)) = stack.pop() {
            if least > best.1 {
                continue;
            }
            let second = self.nodes[at as usize].second;
            if second != 0 {
                // The nearer child is searched first.
                let mut next = [(far(at + 1), at + 1), (far(second), second)];
                if next[0].0 < next[1].0 {
                    next.swap(0, 1);
                }
                stack.extend(next);
                continue;
            }
            for &(bounds, item) in self.leaf(at) {
                if bounds.distance(p) > best.1 {
                    continue;
                }
                let Some(found) = distance(item) else { continue };
                if found < best.1 || (found == best.1 && item < best.0) {
                    best = (item, found);
                }
            }
        }
        (best.0 != u32::MAX).then_some(best)
    }

    /// Calls `visit` once for every two items of this tree whose boxes meet, the lower index first.
    pub fn own_pairs(&self, visit: &mut impl FnMut(u32, u32)) {
        let mut stack: Vec<(u32, u32)> = self.root().into_iter().map(|root| (root, root)).collect();
        while let Some((a, b)) = stack.pop() {
            let (of_a, of_b) = (&self.nodes[a as usize], &self.nodes[b as usize]);
            if a != b && !of_a.bounds.meets(&of_b.bounds) {
                continue;
            }
            match (of_a.second, of_b.second) {
                (0, 0) => self.leaf_pairs(a, b, visit),
                (second, _) if a == b => {
                    stack.extend([(a + 1, a + 1), (second, second), (a + 1, second)]);
                }
                (second, other) if second != 0 && (other == 0 || of_a.count >= of_b.count) => {
                    stack.extend([(a + 1, b), (second, b)]);
                }
                (_, second) => stack.extend([(a, b + 1), (a, second)]),
            }
        }
    }

    fn leaf_pairs(&self, a: u32, b: u32, visit: &mut impl FnMut(u32, u32)) {
        let (in_a, in_b) = (self.leaf(a), self.leaf(b));
        for (i, (box_a, x)) in in_a.iter().enumerate() {
            let others = if a == b { &in_b[i + 1..] } else { in_b };
            for (box_b, y) in others {
                if box_a.meets(box_b) {
                    visit(*x.min(y), *x.max(y));
                }
            }
        }
    }

    /// Calls `visit` once for every item of this tree and item of the other whose boxes meet.
    pub fn pairs_with(&self, other: &BoxTree, visit: &mut impl FnMut(u32, u32)) {
        let roots = self.root().into_iter().zip(other.root());
        let mut stack: Vec<(u32, u32)> = roots.collect();
        while let Some((a, b)) = stack.pop() {
            let (of_a, of_b) = (&self.nodes[a as usize], &other.nodes[b as usize]);
            if !of_a.bounds.meets(&of_b.bounds) {
                continue;
            }
            match (of_a.second, of_b.second) {
                (0, 0) => {
                    for (box_a, x) in self.leaf(a) {
                        for (box_b, y) in other.leaf(b) {
                            if box_a.meets(box_b) {
                                visit(*x, *y);
                            }
                        }
                    }
                }
                (second, from) if second != 0 && (from == 0 || of_a.count >= of_b.count) => {
                    stack.extend([(a + 1, b), (second, b)]);
                }
                (_, second) => stack.extend([(a, b + 1), (a, second)]),
            }
        }
    }

    /// The root, if there is one.
    fn root(&self) -> Vec<u32> {
        if self.nodes.is_empty() { Vec::new() } else { vec![0] }
    }

    fn leaf(&self, node: u32) -> &[(Box3, u32)] {
        let node = &self.nodes[node as usize];
        &self.items[node.first as usize..(node.first + node.count) as usize]
    }
}

fn build(items: &mut [(Box3, u32)], first: usize, nodes: &mut Vec<Node>) {
    let mut bounds = Box3::EMPTY;
    let mut middles = Box3::EMPTY;
    for (of_item, _) in items.iter() {
        bounds = bounds.union(*of_item);
        middles = middles.including(of_item.min + of_item.max);
    }
    let index = nodes.len();
    nodes.push(Node { bounds, first: first as u32, count: items.len() as u32, second: 0 });
    if items.len() <= LEAF {
        return;
    }
    let axis = (middles.max - middles.min).max_position();
    let middle = items.len() / 2;
    let key = |item: &(Box3, u32)| item.0.min[axis] + item.0.max[axis];
    items.select_nth_unstable_by(middle, |a, b| key(a).total_cmp(&key(b)).then(a.1.cmp(&b.1)));
    let (lower, upper) = items.split_at_mut(middle);
    build(lower, first, nodes);
    nodes[index].second = nodes.len() as u32;
    build(upper, first + middle, nodes);
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
            let tree = BoxTree::new(all.clone());
            let query = Box3 { min: p - 1.0, max: p + 1.0 };
            let mut found = Vec::new();
            tree.meeting(query, |i| found.push(i));
            found.sort_unstable();
            let expected: Vec<u32> =
                (0..all.len() as u32).filter(|&i| all[i as usize].meets(&query)).collect();
            prop_assert_eq!(found, expected);

            // Whole numbers, so that several items are equally near.
            let far = |i: u32| all[i as usize].distance(p).ceil();
            let nearest = tree.nearest(p, f64::INFINITY, |i| (i % 3 != 0).then(|| far(i)));
            let counting = (0..all.len() as u32).filter(|i| i % 3 != 0);
            let expected = counting.min_by(|&i, &j| far(i).total_cmp(&far(j)).then(i.cmp(&j)));
            prop_assert_eq!(nearest, expected.map(|i| (i, far(i))));
        }

        #[test]
        fn finds_all_pairs(a in boxes(), b in boxes()) {
            let (of_a, of_b) = (BoxTree::new(a.iter().copied()), BoxTree::new(b.iter().copied()));
            let mut found = Vec::new();
            of_a.own_pairs(&mut |i, j| found.push((i, j)));
            found.sort_unstable();
            let n = a.len() as u32;
            let all = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
            let expected: Vec<_> = all.filter(|&(i, j)| a[i as usize].meets(&a[j as usize])).collect();
            prop_assert_eq!(found, expected);

            let mut found = Vec::new();
            of_a.pairs_with(&of_b, &mut |i, j| found.push((i, j)));
            found.sort_unstable();
            let all = (0..n).flat_map(|i| (0..b.len() as u32).map(move |j| (i, j)));
            let expected: Vec<_> = all.filter(|&(i, j)| a[i as usize].meets(&b[j as usize])).collect();
            prop_assert_eq!(found, expected);
        }
    }
}
