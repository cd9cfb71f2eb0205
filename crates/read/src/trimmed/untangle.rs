//! Loops that cross, touch or run over each other, as loops that do not: for formats without topology.
//!
//! Source: Balázs, Guthe, Klein 2004, section 5.1. Chains are cut where they meet ([`meet`]); the boundary of
//! the region that their winding numbers describe ([`chordal_brep::winding`]) is put together from the cut
//! pieces, which stay the exact curves of the file.
//!
//! A loop *encircles* a point if its winding number round the point is odd. A point belongs to the face:
//!
//! | the format, the convention | if |
//! |---|---|
//! | distinguishes outer loops from holes | more outer loops than holes encircle the point |
//! | does not; odd; crossing loops of both directions ([`direction`]) | the same |
//! | does not; odd; otherwise | an odd number of loops encircles the point |
//! | does not; even | an even number of loops encircles the point |
//!
//! Chains that meet nowhere but bound the region as they are come back unchanged, so that sound files keep
//! their loops.
//!
//! Not guaranteed: loops round a period of the surface are not changed, and loops are not compared across its
//! seam.

mod direction;

use super::chain::Chain;
use super::meet::{Flat, ONE_PLACE, flattened, meetings};
use super::{Piece, Role, Scale};
use crate::Winding;
use chordal_brep::winding::{Strand, outlines};
use chordal_nurbs::{Curve2, DVec2, Range};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Strands times segments of what is untangled: beyond, the search for winding numbers takes seconds.
const MOST_WORK: usize = 400_000_000;

/// What became of the chains of one face.
pub(super) struct Untangled {
    pub chains: Vec<Chain>,
    /// Points that no loop goes round belong to the face.
    pub whole: bool,
    /// Places where pieces crossed or touched, if the loops were built anew.
    pub rebuilt: Option<usize>,
}

/// The rule by which points belong to the face.
struct Rule {
    roles: Vec<Role>,
}

impl Rule {
    fn is_inside(&self, windings: &[i32]) -> bool {
        let odd = |l: usize| i32::from(windings[l] % 2 != 0);
        let all = || 0..self.roles.len();
        let of = |role: Role| -> i32 { all().filter(|&l| self.roles[l] == role).map(odd).sum() };
        if let Some(Role::ByNesting(winding)) = self.roles.iter().find(|r| matches!(r, Role::ByNesting(_))) {
            let count: i32 = all().map(odd).sum();
            return (count % 2 == 1) == (*winding == Winding::Odd);
        }
        // Holes alone are cut into the whole surface.
        let base = i32::from(!self.roles.contains(&Role::Outer));
        base + of(Role::Outer) > of(Role::Hole)
    }
}

/// The same region with loops that do not cross.
pub(super) fn untangled(chains: Vec<Chain>, scale: &Scale) -> Untangled {
    let (plain, winding): (Vec<Chain>, Vec<Chain>) = chains.into_iter().partition(|chain| !chain.winds);
    let rebuilt = rebuilt(&plain, scale);
    let (mut chains, whole, rebuilt) = match rebuilt {
        Some((chains, whole, places)) => (chains, whole, Some(places)),
        None => (plain, false, None),
    };
    chains.extend(winding);
    Untangled { chains, whole, rebuilt }
}

/// New chains, whether the region is unbounded, and the number of places where pieces met; `None` where the
/// chains are right as they are, or nothing better is found.
fn rebuilt(chains: &[Chain], scale: &Scale) -> Option<(Vec<Chain>, bool, usize)> {
    let flats = flattened(chains, scale);
    let met = meetings(&flats, scale);
    let mut nodes = Nodes::new(scale);
    let mut cut = Vec::new();
    for (i, (chain, flat)) in flats.iter().enumerate() {
        let mut stops = vec![0.0];
        stops.extend(&met.stops[i].shares);
        stops.push(1.0);
        cut.extend(stops.windows(2).map(|pair| Cut { chain: *chain, flat, shares: [pair[0], pair[1]] }));
    }
    let ends: Vec<[u32; 2]> = close(&cut, &mut nodes);
    let visits = nodes.visits(&ends);
    if met.crossings == 0
        && met.touches == 0
        && visits.iter().all(|&n| n <= 1)
        && are_told_apart(chains, scale)
    {
        return None;
    }
    let segments: usize = flats.iter().map(|(_, flat)| flat.points.len()).sum();
    if cut.len().saturating_mul(segments) > MOST_WORK {
        return None;
    }
    let (strands, first) = strands(&cut, &ends, &nodes);
    let rule = Rule { roles: direction::roles(chains, scale) };
    let found = outlines(&strands, chains.len(), &|w| rule.is_inside(w))?;
    if met.crossings == 0 && is_as_given(&strands, &found.sides, chains) {
        return None;
    }
    let whole = rule.is_inside(&vec![0; chains.len()]);
    let new =
        found.loops.iter().map(|one| chain(one, &strands, &first, &cut, chains, &nodes, scale)).collect();
    Some((new, whole, met.crossings + met.touches))
}

/// True where loops that meet nowhere cannot lie in each other with the same role, nor an outer loop in a
/// hole.
fn are_told_apart(chains: &[Chain], scale: &Scale) -> bool {
    let of = |role: Role| -> Vec<&Chain> { chains.iter().filter(|c| c.role == role).collect() };
    match (&of(Role::Outer)[..], &of(Role::Hole)[..]) {
        ([] | [_], []) | ([], [_]) => true,
        ([outer], [hole]) => {
            let [outer, hole] = [outer, hole].map(|chain| bounds(&chain.polygon(scale)));
            !(hole[0].cmple(outer[0]).all() && outer[1].cmple(hole[1]).all())
        }
        _ => false,
    }
}

/// The least and the largest coordinates.
fn bounds(points: &[DVec2]) -> [DVec2; 2] {
    let all = || points.iter().copied();
    [all().fold(DVec2::INFINITY, DVec2::min), all().fold(DVec2::NEG_INFINITY, DVec2::max)]
}

/// Part of a piece between two places where it meets others.
struct Cut<'a> {
    chain: usize,
    flat: &'a Flat<'a>,
    shares: [f64; 2],
}

impl Cut<'_> {
    fn at(&self, share: f64) -> DVec2 {
        let [from, to] = self.shares;
        self.flat.piece.at(from + (to - from) * share)
    }

    /// The piece in the requested direction, between two points; a straight one ends exactly in them.
    fn piece(&self, forward: bool, ends: [DVec2; 2]) -> Piece {
        let whole = self.flat.piece;
        let straight = self.flat.points.len() == 2 || matches!(whole.curve.as_ref(), Curve2::Line { .. });
        if straight && self.shares != [0.0, 1.0] {
            return Piece::line(ends[0], ends[1]);
        }
        let [from, to] = self.shares;
        let parameter = |share: f64| {
            let along = if whole.forward { share } else { 1.0 - share };
            if along == 1.0 { whole.range.end } else { whole.range.start + along * whole.range.length() }
        };
        let (a, b) = (parameter(from), parameter(to));
        Piece {
            curve: Arc::clone(&whole.curve),
            range: Range::new(a.min(b), a.max(b)),
            forward: whole.forward == forward,
        }
    }
}

/// Places where cuts begin and end; those within [`ONE_PLACE`] are one.
struct Nodes<'a> {
    scale: &'a Scale,
    known: BTreeMap<[i64; 2], Vec<u32>>,
    /// In the surface's parameters.
    points: Vec<DVec2>,
}

impl<'a> Nodes<'a> {
    fn new(scale: &'a Scale) -> Self {
        Self { scale, known: BTreeMap::new(), points: Vec::new() }
    }

    fn unit(&self, node: u32) -> DVec2 {
        self.scale.unit(self.points[node as usize])
    }

    fn node(&mut self, p_uv: DVec2) -> u32 {
        let p = self.scale.unit(p_uv);
        let cell = (p / (2.0 * ONE_PLACE)).floor();
        let cell = [cell.x as i64, cell.y as i64];
        for dx in -1..=1 {
            for dy in -1..=1 {
                let near = [cell[0].saturating_add(dx), cell[1].saturating_add(dy)];
                let there = self.known.get(&near).into_iter().flatten();
                if let Some(&n) = there.into_iter().find(|&&n| self.unit(n).distance(p) <= ONE_PLACE) {
                    return n;
                }
            }
        }
        let id = self.points.len() as u32;
        self.points.push(p_uv);
        self.known.entry(cell).or_default().push(id);
        id
    }

    /// How many cuts begin at each node.
    fn visits(&self, ends: &[[u32; 2]]) -> Vec<usize> {
        let mut visits = vec![0; self.points.len()];
        ends.iter().for_each(|e| visits[e[0] as usize] += 1);
        visits
    }
}

/// The nodes at both ends of each cut; a cut ends where the next one of its chain begins, whatever gap was
/// left.
fn close(cut: &[Cut<'_>], nodes: &mut Nodes<'_>) -> Vec<[u32; 2]> {
    let starts: Vec<u32> = cut.iter().map(|c| nodes.node(c.at(0.0))).collect();
    let mut ends = Vec::with_capacity(cut.len());
    let mut first = 0;
    for i in 0..cut.len() {
        if cut[first].chain != cut[i].chain {
            first = i;
        }
        let next = if i + 1 < cut.len() && cut[i + 1].chain == cut[i].chain { i + 1 } else { first };
        ends.push([starts[i], starts[next]]);
    }
    ends
}

/// Cuts as strands; those that run over each other are one. Also the cut that each strand was made of.
fn strands(cut: &[Cut<'_>], ends: &[[u32; 2]], nodes: &Nodes<'_>) -> (Vec<Strand>, Vec<usize>) {
    let mut strands: Vec<Strand> = Vec::with_capacity(cut.len());
    let mut first = Vec::with_capacity(cut.len());
    let mut between: BTreeMap<[u32; 2], Vec<usize>> = BTreeMap::new();
    for (i, (one, &[from, to])) in cut.iter().zip(ends).enumerate() {
        let points = one.flat.between(one.shares, [from, to].map(|n| nodes.unit(n)));
        let still = points.iter().all(|p| p.distance(points[0]) <= ONE_PLACE);
        if from == to && still {
            continue;
        }
        let group = between.entry([from.min(to), from.max(to)]).or_default();
        let middle = nodes.scale.unit(one.at(0.5));
        let same = group.iter().copied().find(|&s| runs_through(cut, first[s], middle, nodes.scale));
        let loops = |times: i32| vec![(one.chain as u32, times)];
        match same {
            Some(s) => {
                let strand: &mut Strand = &mut strands[s];
                strand.loops.extend(loops(if strand.ends == [from, to] { 1 } else { -1 }));
            }
            None => {
                group.push(strands.len());
                first.push(i);
                strands.push(Strand { ends: [from, to], points, loops: loops(1) });
            }
        }
    }
    (strands, first)
}

/// True where a cut runs through a point between its ends.
fn runs_through(cut: &[Cut<'_>], index: usize, p: DVec2, scale: &Scale) -> bool {
    let one = &cut[index];
    let off = |share: f64| scale.unit(one.at(share)).distance(p);
    // The nearest of a few places, then by golden sections.
    let nearest =
        (0..=32).map(|k| f64::from(k) / 32.0).min_by(|a, b| off(*a).total_cmp(&off(*b))).unwrap_or(0.5);
    let (mut low, mut high) = ((nearest - 1.0 / 32.0).max(0.0), (nearest + 1.0 / 32.0).min(1.0));
    for _ in 0..50 {
        let [a, b] = [0.382, 0.618].map(|share| low + share * (high - low));
        if off(a) < off(b) { high = b } else { low = a }
    }
    off(0.5 * (low + high)) <= 2.0 * ONE_PLACE
}

/// True where each chain bounds the region all along, and on the side that its role requires: then nothing is
/// to be mended.
fn is_as_given(strands: &[Strand], sides: &[[bool; 2]], chains: &[Chain]) -> bool {
    let mut seen: Vec<Option<[bool; 2]>> = vec![None; chains.len()];
    for (strand, &sides) in strands.iter().zip(sides) {
        let [(l, times)] = strand.loops[..] else { return false };
        let sides = if times > 0 { sides } else { [sides[1], sides[0]] };
        let of_chain = seen[l as usize].get_or_insert(sides);
        if *of_chain != sides || sides[0] == sides[1] {
            return false;
        }
    }
    true
}

/// One outline as a chain.
fn chain(
    one: &[(usize, bool)],
    strands: &[Strand],
    first: &[usize],
    cut: &[Cut<'_>],
    chains: &[Chain],
    nodes: &Nodes<'_>,
    scale: &Scale,
) -> Chain {
    let pieces: Vec<Piece> = one
        .iter()
        .map(|&(s, forward)| {
            let [a, b] = strands[s].ends.map(|n| nodes.points[n as usize]);
            cut[first[s]].piece(forward, if forward { [a, b] } else { [b, a] })
        })
        .collect();
    let like = &chains[cut[first[one[0].0]].chain];
    let mut new = Chain { pieces, role: Role::Outer, source: like.source, winds: false, touches: true };
    if super::polygon::area(&new.polygon(scale)) < 0.0 {
        new.role = Role::Hole;
    }
    new
}

#[cfg(test)]
mod tests;
