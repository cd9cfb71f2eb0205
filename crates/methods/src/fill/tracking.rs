//! Trimming curves followed over the leaves of a subdivision.
//!
//! Source: Kahlesz, Balázs, Klein 2001, section 6 and its Figure 1. A chain of Bézier curves is cut where it
//! leaves a leaf, by a state machine with two states:
//!
//! ```text
//!              1  the curve reaches the border of the leaf: a vertex there
//!        ┌───────────────────────────────────────────┐
//!   ╔════╧══════╗                             ╔══════▼════╗
//!   ║ OverFace  ║                             ║ InVertex  ║
//!   ╚═╤══▲══▲═══╝                             ╚══╤══╤══▲══╝
//!     └──┘  └────────────────────────────────────┘  └──┘
//!      3 it ends inside     2 it leaves over a face      4 it leaves along an edge, which gets its
//!                                                          direction, and reaches the edge's other end or
//!                                                          ends before it
//! ```
//!
//! Every piece over a leaf is kept. Where a curve runs along an edge, the edge is used in its place.

use super::leaf_mesh::LeafMesh;
use chordal_nurbs::{BezierCurve, DVec2, LineCrossings};

/// A part of a chain over one leaf.
#[derive(Clone, Debug, PartialEq)]
pub struct TrackedPiece {
    /// Index of the curve in its chain.
    pub curve: usize,
    /// Its parameters.
    pub range: [f64; 2],
    /// `None`: it runs along an edge.
    pub leaf: Option<u32>,
}

/// The result for one chain.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tracked {
    pub pieces: Vec<TrackedPiece>,
    /// How often each of the four transitions was taken.
    pub transitions: [usize; 4],
    /// The chain left the leaves, or could not be followed to its end.
    pub lost: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    OverFace(u32),
    InVertex(u32),
}

/// Parameters nearer to an end than this are that end.
const END: f64 = 1e-9;

/// A chain crosses no more borders than this.
const MOST_STEPS: usize = 100_000;

/// Follows a chain; vertices and directions are added to the mesh.
pub fn track(mesh: &mut LeafMesh, chain: &[BezierCurve<DVec2>]) -> Tracked {
    let mut found = Tracked::default();
    let Some(mut state) = chain.first().and_then(|c| start(mesh, c.points[0])) else {
        found.lost = true;
        return found;
    };
    let mut steps = 0;
    for (index, curve) in chain.iter().enumerate() {
        let mut t = 0.0;
        while t < 1.0 {
            steps += 1;
            let rest = if t == 0.0 { curve.clone() } else { curve.restricted(t, 1.0) };
            let step = match state {
                State::OverFace(face) => over_face(mesh, face, &rest),
                State::InVertex(vertex) => in_vertex(mesh, vertex, &rest),
            };
            let Some(step) = step.filter(|_| steps < MOST_STEPS) else {
                found.lost = true;
                return found;
            };
            found.transitions[step.transition - 1] += 1;
            let end = if step.to >= 1.0 - END { 1.0 } else { t + (1.0 - t) * step.to };
            if step.to > 0.0 {
                found.pieces.push(TrackedPiece { curve: index, range: [t, end], leaf: step.leaf });
                t = end;
            }
            state = step.state;
        }
    }
    found
}

/// The result of one transition.
struct Step {
    transition: usize,
    state: State,
    /// How far it goes along the rest of the curve; 0 for transition 2.
    to: f64,
    leaf: Option<u32>,
}

fn start(mesh: &mut LeafMesh, p: DVec2) -> Option<State> {
    let leaves = mesh.leaves_at(p);
    let &first = leaves.first()?;
    let on_border = mesh.vertex_on(first, p).or_else(|| leaves.iter().find_map(|&l| mesh.vertex_on(l, p)));
    Some(on_border.map_or(State::OverFace(first), State::InVertex))
}

/// Transitions 1 and 3.
fn over_face(mesh: &mut LeafMesh, face: u32, rest: &BezierCurve<DVec2>) -> Option<Step> {
    let leaf = Some(face);
    let Some(to) = first_on_border(mesh, face, rest) else {
        return Some(Step { transition: 3, state: State::OverFace(face), to: 1.0, leaf });
    };
    let vertex = mesh.vertex_on(face, rest.eval(to))?;
    Some(Step { transition: 1, state: State::InVertex(vertex), to, leaf })
}

/// Transitions 2 and 4.
fn in_vertex(mesh: &mut LeafMesh, vertex: u32, rest: &BezierCurve<DVec2>) -> Option<Step> {
    if let Some(step) = along_edge(mesh, vertex, rest) {
        return Some(step);
    }
    let at = mesh.vertices[vertex as usize];
    mesh.leaves_at(at).into_iter().find_map(|face| {
        let to = first_on_border(mesh, face, rest).unwrap_or(1.0);
        let b = mesh.leaves[face as usize];
        let p = rest.eval(0.5 * to);
        let inside = p.cmpgt(b.min).all() && p.cmplt(b.max).all();
        inside.then_some(Step { transition: 2, state: State::OverFace(face), to: 0.0, leaf: None })
    })
}

/// The smallest parameter, its start aside, at which a curve is on the border of a leaf.
fn first_on_border(mesh: &LeafMesh, face: u32, curve: &BezierCurve<DVec2>) -> Option<f64> {
    let b = mesh.leaves[face as usize];
    let (low, high) = (b.min - mesh.same, b.max + mesh.same);
    let sides = [(b.min, DVec2::Y, 0), (b.max, DVec2::Y, 0), (b.min, DVec2::X, 1), (b.max, DVec2::X, 1)];
    let mut first: Option<f64> = None;
    for (origin, direction, axis) in sides {
        let LineCrossings::At(all) = curve.line_crossings(origin, direction, 0.25 * mesh.same[axis]) else {
            continue;
        };
        let on_side = |t: &f64| {
            let p = curve.eval(*t);
            *t > END && p.cmpge(low).all() && p.cmple(high).all()
        };
        if let Some(t) = all.into_iter().find(on_side) {
            first = Some(first.map_or(t, |f| f.min(t)));
        }
    }
    first
}

/// Transition 4, where the curve runs along one of the vertex's edges.
fn along_edge(mesh: &mut LeafMesh, vertex: u32, rest: &BezierCurve<DVec2>) -> Option<Step> {
    let from = mesh.vertices[vertex as usize];
    let ahead = rest.eval(2.0 * END) - from;
    let next = mesh.neighbors(vertex).iter().copied().find(|&v| {
        let edge = mesh.vertices[v as usize] - from;
        let axis = usize::from(edge.x == 0.0);
        let zero = mesh.same[1 - axis];
        edge.dot(ahead) > 0.0 && rest.line_crossings(from, edge, zero) == LineCrossings::Along
    })?;
    let target = mesh.vertices[next as usize];
    let axis = usize::from((target - from).x == 0.0);
    let mut across = DVec2::ZERO;
    across[1 - axis] = 1.0;
    let reached = match rest.line_crossings(target, across, 0.25 * mesh.same[axis]) {
        LineCrossings::At(all) => all.into_iter().find(|&t| t > END),
        LineCrossings::Along => None,
    };
    let (end, to) = match reached {
        Some(t) => (next, t),
        // It ends before: a new vertex there.
        None => (mesh.split_edge((vertex.min(next), vertex.max(next)), rest.eval(1.0)), 1.0),
    };
    mesh.direct(vertex, end);
    Some(Step { transition: 4, state: State::InVertex(end), to, leaf: None })
}

#[cfg(test)]
mod tests {
    use super::*;
    use chordal_nurbs::{UvBox, math};
    use proptest::prelude::*;

    /// The unit square in 4 × 4 leaves, the one at (1, 1) cut into four.
    fn leaves() -> LeafMesh {
        let cell = |i: f64, j: f64, s: f64| UvBox::new(DVec2::new(i, j), DVec2::new(i + s, j + s));
        let mut all = Vec::new();
        for i in 0..4 {
            for j in 0..4 {
                let (u, v) = (f64::from(i) / 4.0, f64::from(j) / 4.0);
                if (i, j) == (1, 1) {
                    all.extend(
                        [(0., 0.), (1., 0.), (0., 1.), (1., 1.)]
                            .map(|(a, b)| cell(u + a / 8.0, v + b / 8.0, 0.125)),
                    );
                } else {
                    all.push(cell(u, v, 0.25));
                }
            }
        }
        LeafMesh::new(all)
    }

    fn polyline(points: &[(f64, f64)]) -> Vec<BezierCurve<DVec2>> {
        let segment =
            |w: &[(f64, f64)]| BezierCurve { points: vec![w[0].into(), w[1].into()], weights: None };
        points.windows(2).map(segment).collect()
    }

    /// Pieces follow each other without a gap and lie over their leaves.
    fn check(mesh: &LeafMesh, chain: &[BezierCurve<DVec2>], tracked: &Tracked) -> Result<(), TestCaseError> {
        prop_assert!(!tracked.lost);
        let mut at = (0, 0.0);
        for piece in &tracked.pieces {
            prop_assert_eq!((piece.curve, piece.range[0]), at, "a gap");
            at = if piece.range[1] == 1.0 { (piece.curve + 1, 0.0) } else { (piece.curve, piece.range[1]) };
            let Some(leaf) = piece.leaf else { continue };
            let b = mesh.leaves[leaf as usize];
            for k in 0..=10 {
                let t = piece.range[0] + (piece.range[1] - piece.range[0]) * f64::from(k) / 10.0;
                let p = chain[piece.curve].eval(t);
                let far = (b.min - p).max(p - b.max).max_element();
                prop_assert!(far <= 1e-8, "{p} is {far:e} outside of {b:?}");
            }
        }
        prop_assert_eq!(at, (chain.len(), 0.0), "not to the end");
        Ok(())
    }

    #[test]
    fn all_four_transitions() {
        let mut mesh = leaves();
        // From inside a leaf over its right side, to the middle of the next; then to a vertex and along two
        // edges and a half.
        let chain = polyline(&[(0.1, 0.6), (0.35, 0.6), (0.25, 0.5), (0.9, 0.5), (0.9, 0.6)]);
        let tracked = track(&mut mesh, &chain);
        check(&mesh, &chain, &tracked).expect("followed");
        // 1: at u = ¼, and at the vertex (¼, ½). 2: from u = ¼ on, and up at the end. 3: in the second leaf,
        // and at the end. 4: from ¼ along ⅜, ½, ¾ to 0.9.
        assert_eq!(tracked.transitions, [2, 2, 2, 4]);
        let directed: Vec<_> =
            mesh.edges.iter().filter_map(|(&(a, b), e)| e.forward.map(|f| (a, b, f))).collect();
        assert_eq!(directed.len(), 4);
        for (a, b, forward) in directed {
            let (p, q) = (mesh.vertices[a as usize], mesh.vertices[b as usize]);
            assert_eq!((q.x > p.x) == forward, p.y == 0.5 && q.y == 0.5, "they run to the right");
        }
        assert!(
            mesh.vertices.contains(&DVec2::new(0.9, 0.5)),
            "where the curve leaves the edge before its end"
        );
    }

    #[test]
    fn an_edge_run_backwards_is_directed_so() {
        let mut mesh = leaves();
        let chain = polyline(&[(0.75, 0.25), (0.5, 0.25)]);
        let tracked = track(&mut mesh, &chain);
        assert_eq!(tracked.transitions, [0, 0, 0, 1]);
        let (&(a, b), edge) = mesh.edges.iter().find(|(_, e)| e.forward.is_some()).expect("one");
        assert_eq!(edge.forward == Some(true), mesh.vertices[a as usize].x > mesh.vertices[b as usize].x);
    }

    #[test]
    fn a_circle_crosses_what_a_look_along_it_crosses() {
        let h = 0.5f64.sqrt();
        let (c, r) = (DVec2::new(0.47, 0.52), 0.31);
        let corners =
            [(1., 0.), (1., 1.), (0., 1.), (-1., 1.), (-1., 0.), (-1., -1.), (0., -1.), (1., -1.), (1., 0.)];
        let chain: Vec<BezierCurve<DVec2>> = (0..4)
            .map(|k| BezierCurve {
                points: corners[2 * k..2 * k + 3].iter().map(|&p| c + DVec2::from(p) * r).collect(),
                weights: Some(vec![1.0, h, 1.0]),
            })
            .collect();
        let mut mesh = leaves();
        let tracked = track(&mut mesh, &chain);
        check(&mesh, &chain, &tracked).expect("followed");
        let at = |k: usize| c + math::direction(std::f64::consts::TAU * k as f64 / 100_000.0) * r;
        let leaf = |p: DVec2| mesh.leaves_at(p)[0];
        let changes = (0..100_000).filter(|&k| leaf(at(k)) != leaf(at(k + 1))).count();
        assert_eq!(tracked.transitions[0], changes);
        assert_eq!(tracked.transitions[1], changes);
    }

    #[test]
    fn a_chain_that_leaves_the_leaves_is_lost() {
        assert!(track(&mut leaves(), &polyline(&[(0.5, 0.6), (0.6, 1.2)])).lost);
        assert!(track(&mut leaves(), &polyline(&[(2.0, 0.6), (0.6, 0.2)])).lost);
    }

    proptest! {
        #[test]
        fn chains_are_followed_to_their_ends(
            net in prop::collection::vec((0.0f64..1.0, 0.0f64..1.0, -1.0f64..1.0), 7),
                rational in any::<bool>(),
            on_lines in any::<bool>(),
        ) {
            // Corners on multiples of 1/16 lie on borders and vertices often.
            let place = |&(u, v, _): &(f64, f64, f64)| match on_lines {
                true => (DVec2::new(u, v) * 16.0).round() / 16.0,
                false => DVec2::new(u, v),
            };
            let chain: Vec<BezierCurve<DVec2>> = [0, 3]
                .map(|k| BezierCurve {
                    points: net[k..k + 4].iter().map(place).collect(),
                    weights: rational.then(|| net[k..k + 4].iter().map(|n| math::pow(10.0, n.2)).collect()),
                })
                .to_vec();
            prop_assume!(chain.iter().all(|c| c.points.windows(2).all(|w| w[0] != w[1])));
            let mut mesh = leaves();
            let tracked = track(&mut mesh, &chain);
            check(&mesh, &chain, &tracked)?;
        }
    }
}
