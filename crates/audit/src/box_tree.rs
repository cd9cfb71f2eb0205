//! A tree of boxes, split at the median of their centres: pairs of boxes that meet, without looking at all
//! pairs.

use chordal_nurbs::Box3;

/// Boxes a leaf holds: below about this many, testing all pairs is cheaper than descending.
const LEAF: usize = 8;

/// Items with boxes, prepared for pairs.
#[derive(Debug, Default)]
pub(crate) struct BoxTree {
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
    pub fn new(boxes: impl Iterator<Item = Box3>) -> Self {
        let mut items: Vec<(Box3, u32)> = boxes.zip(0..).collect();
        let mut nodes = Vec::with_capacity(items.len());
        if !items.is_empty() {
            build(&mut items, 0, &mut nodes);
        }
        Self { nodes, items }
    }

    /// Calls `visit` once for every two items of this tree whose boxes meet, the lower index first.
    pub fn own_pairs(&self, visit: &mut impl FnMut(u32, u32)) {
        if self.nodes.is_empty() {
            return;
        }
        let mut stack = vec![(0u32, 0u32)];
        while let Some((a, b)) = stack.pop() {
            let (of_a, of_b) = (&self.nodes[a as usize], &self.nodes[b as usize]);
            if a != b && !meet(&of_a.bounds, &of_b.bounds) {
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
                if meet(box_a, box_b) {
                    visit(*x.min(y), *x.max(y));
                }
            }
        }
    }

    /// Calls `visit` once for every item of this tree and item of the other whose boxes meet.
    pub fn pairs_with(&self, other: &BoxTree, visit: &mut impl FnMut(u32, u32)) {
        if self.nodes.is_empty() || other.nodes.is_empty() {
            return;
        }
        let mut stack = vec![(0u32, 0u32)];
        while let Some((a, b)) = stack.pop() {
            let (of_a, of_b) = (&self.nodes[a as usize], &other.nodes[b as usize]);
            if !meet(&of_a.bounds, &of_b.bounds) {
                continue;
            }
            match (of_a.second, of_b.second) {
                (0, 0) => {
                    for (box_a, x) in self.leaf(a) {
                        for (box_b, y) in other.leaf(b) {
                            if meet(box_a, box_b) {
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

    fn leaf(&self, node: u32) -> &[(Box3, u32)] {
        let node = &self.nodes[node as usize];
        &self.items[node.first as usize..(node.first + node.count) as usize]
    }
}

/// True where two boxes have a point in common.
pub(crate) fn meet(a: &Box3, b: &Box3) -> bool {
    a.min.cmple(b.max).all() && b.min.cmple(a.max).all()
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
    use chordal_nurbs::DVec3;
    use proptest::prelude::*;

    fn boxes() -> impl Strategy<Value = Vec<Box3>> {
        let corner = || prop::array::uniform3(0.0..1.0f64);
        prop::collection::vec((corner(), corner()), 0..60).prop_map(|all| {
            all.into_iter()
                .map(|(p, size)| {
                    let p = DVec3::from(p);
                    Box3::from_points([p, p + 0.3 * DVec3::from(size)])
                })
                .collect()
        })
    }

    proptest! {
        #[test]
        fn the_tree_finds_all_pairs(a in boxes(), b in boxes()) {
            let mut found = Vec::new();
            BoxTree::new(a.iter().copied()).own_pairs(&mut |i, j| found.push((i, j)));
            found.sort_unstable();
            let n = a.len() as u32;
            let all = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
            let wanted: Vec<_> = all.filter(|&(i, j)| meet(&a[i as usize], &a[j as usize])).collect();
            prop_assert_eq!(found, wanted);

            let mut found = Vec::new();
            let (of_a, of_b) = (BoxTree::new(a.iter().copied()), BoxTree::new(b.iter().copied()));
            of_a.pairs_with(&of_b, &mut |i, j| found.push((i, j)));
            found.sort_unstable();
            let all = (0..n).flat_map(|i| (0..b.len() as u32).map(move |j| (i, j)));
            let wanted: Vec<_> = all.filter(|&(i, j)| meet(&a[i as usize], &b[j as usize])).collect();
            prop_assert_eq!(found, wanted);
        }
    }
}
