//! Coedges of one wire, in any order, as chains that run end to start.

use chordal_brep::{Coedge, VertexId};
use rustc_hash::FxHashMap;

/// The chains of a wire.
#[derive(Debug, Default)]
pub(crate) struct Chained {
    /// Chains that end in the vertex where they start.
    pub closed: Vec<Vec<Coedge>>,
    /// Chains that do not, in the order of their first coedges.
    pub open: Vec<Vec<Coedge>>,
    /// The order is not the file's.
    pub sorted: bool,
}

/// Orders coedges by their vertices. Where several could follow, `jump` decides: the distance in parameter
/// space from the end of one to the start of the other, infinite where not known. A chain that could close
/// goes on where going on is the smaller jump: so both sides of a seam stay in one loop.
pub(crate) fn chained(
    coedges: Vec<Coedge>,
    ends: impl Fn(&Coedge) -> (VertexId, VertexId),
    jump: impl Fn(&Coedge, &Coedge) -> f64,
) -> Chained {
    let next = coedges.iter().cycle().skip(1);
    if coedges.iter().zip(next).all(|(a, b)| ends(a).1 == ends(b).0) {
        return Chained { closed: vec![coedges], ..Chained::default() };
    }
    let mut starting: FxHashMap<VertexId, Vec<usize>> = FxHashMap::default();
    for (i, coedge) in coedges.iter().enumerate() {
        starting.entry(ends(coedge).0).or_default().push(i);
    }
    let mut used = vec![false; coedges.len()];
    let mut found = Chained { sorted: true, ..Chained::default() };
    // Chains begin at vertices where nothing ends, then wherever something is left.
    let mut arrivals: FxHashMap<VertexId, i64> = FxHashMap::default();
    for coedge in &coedges {
        *arrivals.entry(ends(coedge).1).or_default() += 1;
        *arrivals.entry(ends(coedge).0).or_default() -= 1;
    }
    let loose_start = |i: &usize| arrivals.get(&ends(&coedges[*i]).0).is_some_and(|&n| n < 0);
    let order = (0..coedges.len()).filter(loose_start).chain(0..coedges.len());
    for first in order.collect::<Vec<_>>() {
        if used[first] {
            continue;
        }
        used[first] = true;
        let mut chain = vec![first];
        let closed = loop {
            let last = &coedges[chain[chain.len() - 1]];
            let end = ends(last).1;
            let candidates = starting.get(&end).into_iter().flatten().copied().filter(|&i| !used[i]);
            let best = candidates
                .map(|i| (jump(last, &coedges[i]), coedges[i].edge == last.edge, i))
                .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2)));
            let may_close = end == ends(&coedges[first]).0;
            match best {
                Some((gap, _, i)) => {
                    let closing = jump(last, &coedges[first]);
                    if may_close && closing.is_finite() && closing <= gap {
                        break true;
                    }
                    used[i] = true;
                    chain.push(i);
                }
                None => break may_close,
            }
        };
        let chain = chain.into_iter().map(|i| coedges[i].clone()).collect();
        if closed { found.closed.push(chain) } else { found.open.push(chain) }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use chordal_brep::EdgeId;
    use chordal_nurbs::math;

    fn coedge(edge: u32, forward: bool) -> Coedge {
        Coedge { edge: EdgeId(edge), forward, pcurves: Vec::new() }
    }

    /// Edge i runs from vertex `table[i].0` to `table[i].1`.
    fn ends(table: &[(u32, u32)]) -> impl Fn(&Coedge) -> (VertexId, VertexId) {
        move |c| {
            let (a, b) = table[c.edge.index()];
            if c.forward { (VertexId(a), VertexId(b)) } else { (VertexId(b), VertexId(a)) }
        }
    }

    #[test]
    fn a_shuffled_square_is_one_loop() {
        let table = [(0, 1), (1, 2), (2, 3), (3, 0)];
        let shuffled = [2, 0, 3, 1].map(|e| coedge(e, true)).to_vec();
        let found = chained(shuffled, ends(&table), |_, _| f64::INFINITY);
        assert!(found.sorted && found.open.is_empty());
        let order: Vec<u32> = found.closed[0].iter().map(|c| c.edge.0).collect();
        assert_eq!(order, [2, 3, 0, 1]);
    }

    #[test]
    fn both_sides_of_a_seam_stay_in_one_loop() {
        // A cylinder: seam 0 from vertex 0 to 1, circle 1 at vertex 1, circle 2 at vertex 0.
        let table = [(0, 1), (1, 1), (0, 0)];
        let wire = vec![coedge(1, false), coedge(0, true), coedge(0, false), coedge(2, true)];
        // Start and end of each in parameter space, the loop running counter-clockwise.
        let uv = |c: &Coedge| match (c.edge.0, c.forward) {
            (0, true) => ((6.0, 0.0), (6.0, 1.0)),
            (0, false) => ((0.0, 1.0), (0.0, 0.0)),
            (1, _) => ((6.0, 1.0), (0.0, 1.0)),
            _ => ((0.0, 0.0), (6.0, 0.0)),
        };
        let jump = |a: &Coedge, b: &Coedge| {
            let (from, to): ((f64, f64), (f64, f64)) = (uv(a).1, uv(b).0);
            math::hypot(from.0 - to.0, from.1 - to.1)
        };
        let found = chained(wire, ends(&table), jump);
        assert_eq!((found.closed.len(), found.open.len()), (1, 0));
        let order: Vec<(u32, bool)> = found.closed[0].iter().map(|c| (c.edge.0, c.forward)).collect();
        assert_eq!(order, [(1, false), (0, false), (2, true), (0, true)]);
    }

    #[test]
    fn an_open_wire_starts_at_its_loose_end() {
        let table = [(1, 2), (0, 1)];
        let found = chained(vec![coedge(0, true), coedge(1, true)], ends(&table), |_, _| f64::INFINITY);
        assert!(found.closed.is_empty());
        assert_eq!(found.open[0].iter().map(|c| c.edge.0).collect::<Vec<_>>(), [1, 0]);
    }
}
