//! Pieces between the same two vertices that run along each other within the tolerance become one edge.
//!
//! Two pieces are a pair. Where more meet, they are paired so that as few as possible remain: pieces of one
//! body before pieces of two bodies, closer ones first, and never two faces that coincide. A piece that
//! remains joins the edge of a pair (three faces at an edge).

use crate::border::{Border, Borders};
use crate::cut::{Piece, Pieces};
use crate::foot::{foot, segment_distance};
use chordal_brep::{FaceGeometry, Loop, Part};
use chordal_nurbs::{Curve, DVec3, Range};
use rayon::prelude::*;

/// Distances that differ by less than this share of the tolerance count as equal.
const ALIKE: f64 = 0.02;
/// Up to this many pieces all ways of pairing are compared; for more, the best pair is taken first, then the
/// next.
const ALL_WAYS: usize = 6;
/// Two faces whose inward directions are this near (as a cosine) coincide.
const ON_EACH_OTHER: f64 = 0.98;
/// Faces are compared at this share of a piece's length away from the piece.
const BESIDE: f64 = 0.05;
/// Faces are compared at least this many tolerances away. Pieces shorter than twice that give no direction.
const FAR: f64 = 20.0;
/// A face whose border runs along itself is a seam where the rest of it is longer than this many tolerances.
const SEAM_REST: f64 = 8.0;

/// Pieces that become one edge.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Joint {
    /// The piece whose curve is kept; then the others, each with whether it runs in the opposite direction,
    /// and its distance.
    pub leader: u32,
    pub others: Vec<(u32, bool, f64)>,
    /// The two faces that continue each other at the edge; the others only touch it.
    pub pair: [u32; 2],
}

/// The input of pairing.
pub(crate) struct Pairing<'a> {
    pub part: &'a Part,
    pub borders: &'a Borders,
    pub pieces: &'a Pieces,
    /// The body of every face; faces without one share a number.
    pub body: &'a [u32],
    pub tolerance: f64,
}

/// Two pieces of a group that may be one edge.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    a: usize,
    b: usize,
    distance: f64,
    reversed: bool,
    cost: [u32; 3],
}

impl Pairing<'_> {
    /// All joints, in the order of their vertices.
    pub fn joints(&self) -> Vec<Joint> {
        let mut keys: Vec<([u32; 2], u32)> = self
            .pieces
            .all
            .iter()
            .enumerate()
            .map(|(i, p)| ([p.ends[0].min(p.ends[1]), p.ends[0].max(p.ends[1])], i as u32))
            .collect();
        keys.sort_unstable();
        let groups: Vec<&[([u32; 2], u32)]> =
            keys.chunk_by(|a, b| a.0 == b.0).filter(|g| g.len() > 1).collect();
        let doubles = self.doubles(&groups);
        groups
            .par_iter()
            .with_min_len(16)
            .flat_map_iter(|group| {
                let members: Vec<u32> = group.iter().map(|g| g.1).collect();
                self.group(&members, &doubles)
            })
            .collect()
    }

    /// Pairs of faces that may be joined along more than one piece: only these can be copies.
    fn doubles(&self, groups: &[&[([u32; 2], u32)]]) -> Vec<[u32; 2]> {
        let mut pairs: Vec<[u32; 2]> = Vec::new();
        for group in groups {
            let faces: Vec<u32> = group.iter().take(ALL_WAYS).map(|g| self.border(g.1).of.face).collect();
            for (i, a) in faces.iter().enumerate() {
                pairs.extend(faces[i + 1..].iter().filter(|b| *b != a).map(|b| [*a.min(b), *a.max(b)]));
            }
        }
        pairs.sort_unstable();
        pairs.chunk_by(|a, b| a == b).filter(|g| g.len() > 1).map(|g| g[0]).collect()
    }

    fn border(&self, piece: u32) -> &Border {
        &self.borders.all[self.pieces.all[piece as usize].border as usize]
    }

    fn group(&self, members: &[u32], doubles: &[[u32; 2]]) -> Vec<Joint> {
        let mut candidates = Vec::new();
        for a in 0..members.len() {
            for b in a + 1..members.len() {
                candidates.extend(self.candidate(members, a, b, doubles));
            }
        }
        candidates.sort_unstable_by(|x, y| {
            x.cost.cmp(&y.cost).then(x.distance.total_cmp(&y.distance)).then((x.a, x.b).cmp(&(y.a, y.b)))
        });
        let chosen = if members.len() <= ALL_WAYS {
            best_matching(members.len(), &candidates)
        } else {
            greedy_matching(members.len(), &candidates)
        };
        let mut joints: Vec<Joint> = chosen.iter().map(|&c| self.joint(members, candidates[c])).collect();
        self.add_lone_ones(members, &candidates, &chosen, &mut joints);
        joints
    }

    fn candidate(&self, members: &[u32], a: usize, b: usize, doubles: &[[u32; 2]]) -> Option<Candidate> {
        let (pa, pb) = (members[a], members[b]);
        let faces = [self.border(pa).of.face, self.border(pb).of.face];
        if faces[0] == faces[1] && !self.is_seam(pa, pb) {
            return None;
        }
        let (distance, reversed) = self.along(pa, pb)?;
        let ring = self.pieces.all[pa as usize].ends[0] == self.pieces.all[pa as usize].ends[1];
        let often = doubles.binary_search(&[faces[0].min(faces[1]), faces[0].max(faces[1])]).is_ok();
        if faces[0] != faces[1] && (ring || often) && self.on_each_other(pa, pb) {
            return None;
        }
        let alike = (distance / (ALIKE * self.tolerance)) as u32;
        let across = u32::from(self.body[faces[0] as usize] != self.body[faces[1] as usize]);
        Some(Candidate { a, b, distance, reversed, cost: [across, u32::from(faces[0] == faces[1]), alike] })
    }

    /// How far two pieces are apart, and whether they run against each other; `None` where that is too far.
    fn along(&self, a: u32, b: u32) -> Option<(f64, bool)> {
        let (pa, pb) = (self.pieces.all[a as usize], self.pieces.all[b as usize]);
        let (there, ts) = self.one_way(a, b)?;
        let (back, _) = self.one_way(b, a)?;
        let closed = pa.ends[0] == pa.ends[1];
        let reversed = if closed { runs_back(&ts, pb.range) } else { pa.ends[0] != pb.ends[0] };
        Some((there.max(back), reversed))
    }

    /// The largest distance of samples of `a` from `b`, and the parameters of their feet.
    fn one_way(&self, a: u32, b: u32) -> Option<(f64, Vec<f64>)> {
        let (pa, pb) = (self.pieces.all[a as usize], self.pieces.all[b as usize]);
        let (from, onto) = (self.border(a), self.border(b));
        let first = onto.t.partition_point(|&t| t <= pb.range.start).saturating_sub(1);
        let last = onto.t.partition_point(|&t| t < pb.range.end).min(onto.t.len() - 1);
        let mut feet = Vec::new();
        let mut largest = 0.0_f64;
        for t in from.between(pa.range) {
            let p = from.curve.point(t);
            let near = (first..last)
                .map(|k| (segment_distance(p, onto.points[k], onto.points[k + 1]), k))
                .min_by(|x, y| x.0.0.total_cmp(&y.0.0))?;
            let ((_, s), k) = near;
            let start = onto.t[k] + (onto.t[k + 1] - onto.t[k]) * s;
            let (foot, distance) = foot(&onto.curve, pb.range, p, start);
            largest = largest.max(distance);
            if !(largest <= self.tolerance) {
                return None;
            }
            feet.push(foot);
        }
        Some((largest, feet))
    }

    /// True where a face that runs along itself does so because it is closed, not because it is narrow.
    fn is_seam(&self, a: u32, b: u32) -> bool {
        let (x, y) = (self.border(a), self.border(b));
        let face = &self.part.faces[x.of.face as usize];
        let FaceGeometry::Surface(surface) = &face.geometry else { return false };
        let closed = surface.periods().iter().any(Option::is_some);
        if x.edge == y.edge || x.of.in_loop != y.of.in_loop {
            return closed;
        }
        let Some(Loop::Edges { coedges, .. }) = face.loops.get(x.of.in_loop as usize) else { return false };
        let (i, j) = (x.of.coedge.min(y.of.coedge) as usize, x.of.coedge.max(y.of.coedge) as usize);
        let length = |range: &mut dyn Iterator<Item = usize>| -> f64 {
            range.map(|k| curve_length(self.part, coedges[k].edge.index())).sum()
        };
        let inner = length(&mut (i + 1..j));
        let outer = length(&mut (0..i).chain(j + 1..coedges.len()));
        let enough = SEAM_REST * self.tolerance;
        if inner > enough && outer > enough {
            return true;
        }
        let at_pole = |p: DVec3| surface.poles().iter().any(|pole| pole.point.distance(p) <= self.tolerance);
        let ends = [x.points[0], x.points[x.points.len() - 1]];
        closed && (inner > enough || at_pole(ends[0]) || at_pole(ends[1]))
    }

    /// True where two faces coincide beside the pieces: copies, or sides of bodies that touch. Sewn to each
    /// other they would enclose no volume.
    fn on_each_other(&self, a: u32, b: u32) -> bool {
        let (Some(x), Some(y)) = (self.inward(a), self.inward(b)) else { return false };
        if x.dot(y) <= ON_EACH_OTHER {
            return false;
        }
        let surface = |piece: u32| match &self.part.faces[self.border(piece).of.face as usize].geometry {
            FaceGeometry::Surface(surface) => Some(surface.clone()),
            FaceGeometry::Failed(_) => None,
        };
        let (Some(of_a), Some(of_b)) = (surface(a), surface(b)) else { return false };
        let piece = self.pieces.all[a as usize];
        let border = self.border(a);
        let middle = border.curve.point(0.5 * (piece.range.start + piece.range.end));
        let share = piece.range.length() / border.range.length();
        let length = share * border.length;
        // Far enough away that faces at any angle are further apart than the tolerance.
        let away = (BESIDE * length).max(FAR * self.tolerance);
        if away > 0.5 * length {
            return false;
        }
        let beside = middle + x * away;
        let on_a = of_a.point(of_a.invert(beside, None));
        of_b.point(of_b.invert(on_a, None)).distance(on_a) <= self.tolerance
    }

    /// The direction in which the face lies, at the middle of a piece.
    fn inward(&self, piece: u32) -> Option<DVec3> {
        let border = self.border(piece);
        let face = &self.part.faces[border.of.face as usize];
        let FaceGeometry::Surface(surface) = &face.geometry else { return None };
        let range = self.pieces.all[piece as usize].range;
        let jet = border.curve.jet(0.5 * (range.start + range.end));
        let normal = surface.normal(surface.invert(jet.p, None))?;
        let side = if border.of.forward == face.same_sense { 1.0 } else { -1.0 };
        (normal.cross(jet.d1) * side).try_normalize()
    }

    fn joint(&self, members: &[u32], c: Candidate) -> Joint {
        let (a, b) = (members[c.a], members[c.b]);
        let (leader, other) =
            if self.accuracy(b, c.distance) < self.accuracy(a, c.distance) { (b, a) } else { (a, b) };
        Joint { leader, others: vec![(other, c.reversed, c.distance)], pair: [a, b] }
    }

    /// A rank, of which the smallest is best: the distance of the curve from its own face where that is
    /// relevant, then how simple the curve is.
    fn accuracy(&self, piece: u32, apart: f64) -> (u64, u32, u32) {
        let border = self.border(piece);
        let alike = ALIKE * self.tolerance;
        let off = if apart > alike { self.off_its_face(piece) } else { 0.0 };
        (((off / alike) as u64), rank(&border.curve), border.edge.0)
    }

    fn off_its_face(&self, piece: u32) -> f64 {
        let border = self.border(piece);
        let face = &self.part.faces[border.of.face as usize];
        let FaceGeometry::Surface(surface) = &face.geometry else { return f64::INFINITY };
        let coedge = match face.loops.get(border.of.in_loop as usize) {
            Some(Loop::Edges { coedges, .. }) => coedges.get(border.of.coedge as usize),
            _ => None,
        };
        let range = self.pieces.all[piece as usize].range;
        let mut near = None;
        (1..5).fold(0.0, |off: f64, i| {
            let t = range.start + range.length() * f64::from(i) / 5.0;
            let p = border.curve.point(t);
            let uv = match coedge.and_then(|c| c.pcurves.first()) {
                Some(pcurve) => {
                    let share = (t - border.range.start) / border.range.length();
                    pcurve.curve.point(pcurve.range.start + share * pcurve.range.length())
                }
                None => surface.invert(p, near),
            };
            near = Some(uv);
            off.max(surface.point(uv).distance(p))
        })
    }

    /// Pieces without a partner join the nearest pair that they run along.
    fn add_lone_ones(
        &self,
        members: &[u32],
        candidates: &[Candidate],
        chosen: &[usize],
        joints: &mut [Joint],
    ) {
        let taken = |m: usize| chosen.iter().any(|&c| candidates[c].a == m || candidates[c].b == m);
        for lone in (0..members.len()).filter(|&m| !taken(m)) {
            let reach = |joint: &Joint| self.along(joint.leader, members[lone]);
            let own = self.border(members[lone]).of.face;
            let known = |joint: &Joint| joint.pair.iter().any(|&p| self.border(p).of.face == own);
            let best = joints
                .iter_mut()
                .filter(|j| !known(j))
                .filter_map(|j| reach(j).map(|(d, reversed)| (d, reversed, j)))
                .min_by(|x, y| x.0.total_cmp(&y.0));
            if let Some((distance, reversed, joint)) = best {
                joint.others.push((members[lone], reversed, distance));
            }
        }
    }
}

fn curve_length(part: &Part, edge: usize) -> f64 {
    let edge = &part.edges[edge];
    let Some(curve) = edge.curve.as_deref().filter(|_| edge.range.is_finite()) else { return 0.0 };
    let at = |i: u32| curve.point(edge.range.start + edge.range.length() * f64::from(i) / 8.0);
    (0..8).map(|i| at(i).distance(at(i + 1))).sum()
}

/// Feet of samples in order: whether most steps go back, a closed range's jump aside.
fn runs_back(ts: &[f64], range: Range) -> bool {
    let half = 0.5 * range.length();
    let steps = ts.windows(2).map(|w| w[1] - w[0]).filter(|s| s.abs() < half && *s != 0.0);
    steps.map(|s| if s < 0.0 { 1 } else { -1 }).sum::<i32>() > 0
}

/// Simple curves first: they are exact, and quick to follow.
fn rank(curve: &Curve) -> u32 {
    match curve {
        Curve::Line { .. } => 0,
        Curve::Circle { .. } | Curve::Ellipse { .. } => 1,
        Curve::Parabola { .. } | Curve::Hyperbola { .. } => 2,
        Curve::Nurbs(_) => 3,
        Curve::OnSurface { .. } => 5,
        Curve::Polyline(_) => 6,
        _ => 4,
    }
}

/// The best pair first, then the best of the rest.
fn greedy_matching(count: usize, candidates: &[Candidate]) -> Vec<usize> {
    let mut free = vec![true; count];
    let mut chosen = Vec::new();
    for (i, c) in candidates.iter().enumerate() {
        if free[c.a] && free[c.b] {
            (free[c.a], free[c.b]) = (false, false);
            chosen.push(i);
        }
    }
    chosen
}

/// The pairing with the most pairs and among these the least sum of costs.
fn best_matching(count: usize, candidates: &[Candidate]) -> Vec<usize> {
    let mut best: (usize, [u32; 3], Vec<usize>) = (0, [0; 3], Vec::new());
    let mut chosen = Vec::new();
    search(candidates, 0, &mut vec![true; count], [0; 3], &mut chosen, &mut best);
    best.2
}

fn search(
    candidates: &[Candidate],
    from: usize,
    free: &mut [bool],
    cost: [u32; 3],
    chosen: &mut Vec<usize>,
    best: &mut (usize, [u32; 3], Vec<usize>),
) {
    if chosen.len() > best.0 || chosen.len() == best.0 && cost < best.1 {
        *best = (chosen.len(), cost, chosen.clone());
    }
    for i in from..candidates.len() {
        let c = candidates[i];
        if !(free[c.a] && free[c.b]) {
            continue;
        }
        (free[c.a], free[c.b]) = (false, false);
        chosen.push(i);
        let sum = std::array::from_fn(|k| cost[k] + c.cost[k]);
        search(candidates, i + 1, free, sum, chosen, best);
        chosen.pop();
        (free[c.a], free[c.b]) = (true, true);
    }
}

/// The pieces that run over less than the tolerance around one vertex: they vanish into it.
pub(crate) fn vanishes(border: &Border, piece: &Piece, target: DVec3, tolerance: f64) -> bool {
    piece.ends[0] == piece.ends[1]
        && border.between(piece.range).iter().all(|&t| border.curve.point(t).distance(target) <= tolerance)
}
