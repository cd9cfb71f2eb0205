//! The boundary of a face: exactly the chords of its loops' edges, and cuts whose two sides fit.
//!
//! With every triangle turned the same way in the chart and the boundary being the loops (and cuts along
//! which the surface is glued to itself), the triangles cover the face, and nothing else, once. A hole that
//! was filled lacks its chords; a region that is missing ends where the face has no edge.

use crate::context::Context;
use crate::halves::Half;
use chordal_brep::{Face, Loop};
use chordal_mesh::FaceMesh;

/// The boundary of a face in its chart.
#[derive(Debug, Default)]
pub(crate) struct Boundary {
    /// Chords of the face's loops.
    pub chords: Vec<BoundaryChord>,
    /// The numbers of loops with the direction of the file, and with the opposite one.
    pub forward: usize,
    pub backward: usize,
    /// For each loop, whether its triangles have the direction of the file; `None` where they do not run
    /// along all of it.
    pub directions: Vec<Option<bool>>,
    /// The two sides of a cut through this face.
    pub cuts: Vec<[Half; 2]>,
    /// Half-edges that are neither.
    pub stray: Vec<Half>,
    /// Chords of loops along which no triangle runs, and an edge that has one.
    pub missing: usize,
    pub missing_edge: Option<u32>,
}

/// A half-edge that is the chord of a loop.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BoundaryChord {
    pub half: Half,
    /// The bound of its distance from its curve.
    pub sag: f64,
    /// The edge and the index of the chord in it; none along a polygon without edges.
    pub of: Option<(u32, u32)>,
}

/// A chord of a loop: from position to position, and its edge.
#[derive(Clone, Copy)]
struct Chord {
    from: u32,
    to: u32,
    /// The edge and the index of the chord in it; none along a polygon without edges.
    of: Option<(u32, u32)>,
}

/// Sorts half-edges by what they are.
pub(crate) fn boundary(context: &Context<'_>, face: &Face, of_face: &FaceMesh, single: &[Half]) -> Boundary {
    let position = |corner: u32| of_face.corners[corner as usize].position;
    let ends = |h: &Half| (position(h.a), position(h.b));
    let mut halves = single.to_vec();
    halves.sort_unstable_by_key(|h| (ends(h), h.a, h.b));
    let keys: Vec<(u32, u32)> = halves.iter().map(ends).collect();
    let mut found = Boundary::default();
    let mut pool = Pool { taken: vec![None; keys.len()], keys };
    for a_loop in &face.loops {
        let mut chords = loop_chords(context, a_loop, &mut found);
        if face.flipped {
            reverse(&mut chords);
        }
        let direction = claim_loop(&mut pool, chords, &mut found);
        found.directions.push(direction);
    }
    let chord = |i: usize| {
        let of = pool.taken[i]?;
        Some(BoundaryChord { half: halves[i], sag: of.map_or(0.0, |of| sag_of(context, of)), of })
    };
    found.chords = (0..halves.len()).filter_map(chord).collect();
    pair_cuts(&mut pool, &halves, of_face, &mut found);
    found.stray = (0..halves.len()).filter(|&i| pool.taken[i].is_none()).map(|i| halves[i]).collect();
    found
}

fn sag_of(context: &Context<'_>, (edge, chord): (u32, u32)) -> f64 {
    context.edges[edge as usize].sag.get(chord as usize).copied().unwrap_or(f64::INFINITY)
}

fn reverse(chords: &mut [Chord]) {
    for chord in chords {
        std::mem::swap(&mut chord.from, &mut chord.to);
    }
}

/// Half-edges sorted by their positions, each to be used once.
struct Pool {
    keys: Vec<(u32, u32)>,
    /// The owner of the half-edge: the chord of an edge, or none.
    taken: Vec<Option<Option<(u32, u32)>>>,
}

impl Pool {
    fn take(&mut self, chord: &Chord) -> Option<usize> {
        let key = (chord.from, chord.to);
        let start = self.keys.partition_point(|&k| k < key);
        let free = (start..self.keys.len())
            .take_while(|&i| self.keys[i] == key)
            .find(|&i| self.taken[i].is_none())?;
        self.taken[free] = Some(chord.of);
        Some(free)
    }

    /// Takes the half-edges of all chords that have one; returns them and the chords that have none.
    fn take_all(&mut self, chords: &[Chord]) -> (Vec<usize>, Vec<Chord>) {
        let mut taken = Vec::with_capacity(chords.len());
        let mut missing = Vec::new();
        for chord in chords {
            match self.take(chord) {
                Some(i) => taken.push(i),
                None => missing.push(*chord),
            }
        }
        (taken, missing)
    }

    fn put_back(&mut self, taken: &[usize]) {
        taken.iter().for_each(|&i| self.taken[i] = None);
    }
}

/// Books the chords of one loop. Files give loops the wrong way round; a loop must only run one way as a
/// whole.
fn claim_loop(pool: &mut Pool, mut chords: Vec<Chord>, found: &mut Boundary) -> Option<bool> {
    let (taken, missing) = pool.take_all(&chords);
    if missing.is_empty() {
        found.forward += usize::from(!chords.is_empty());
        return (!chords.is_empty()).then_some(true);
    }
    pool.put_back(&taken);
    reverse(&mut chords);
    let (taken_back, missing_back) = pool.take_all(&chords);
    if missing_back.is_empty() {
        found.backward += 1;
        return Some(false);
    }
    // A path along edges and back encloses nothing, so it may be missing.
    if encloses_nothing(&chords) && taken.is_empty() && taken_back.is_empty() {
        return None;
    }
    let mut missing = missing_back;
    if taken.len() > taken_back.len() {
        pool.put_back(&taken_back);
        reverse(&mut chords);
        missing = pool.take_all(&chords).1;
    }
    found.missing += missing.len();
    found.missing_edge = found.missing_edge.or(missing[0].of.map(|of| of.0));
    None
}

fn encloses_nothing(chords: &[Chord]) -> bool {
    let mut there: Vec<_> = chords.iter().map(|c| (c.from, c.to)).collect();
    let mut back: Vec<_> = chords.iter().map(|c| (c.to, c.from)).collect();
    there.sort_unstable();
    back.sort_unstable();
    there == back
}

fn loop_chords(context: &Context<'_>, a_loop: &Loop, found: &mut Boundary) -> Vec<Chord> {
    let Context { part, mesh, .. } = context;
    let mut chords = Vec::new();
    match a_loop {
        Loop::Vertex(_) => {}
        Loop::Polygon { vertices, .. } => {
            let n = vertices.len();
            let at = |i: usize| vertices[i % n].0;
            let place = |v: u32| context.vertex_at[v as usize];
            for i in 0..n {
                if at(i) == at(i + 1) {
                    continue;
                }
                match (place(at(i)), place(at(i + 1))) {
                    (Some(from), Some(to)) => {
                        chords.push(Chord { from, to, of: None });
                    }
                    _ => found.missing += 1,
                }
            }
        }
        Loop::Edges { coedges, .. } => {
            for coedge in coedges {
                let line = mesh.edges.get(coedge.edge.index()).map_or(&[][..], Vec::as_slice);
                if line.is_empty() && part.edges[coedge.edge.index()].curve.is_some() {
                    // Only there-and-back loops may lack their polylines.
                    let uses = coedges.iter().filter(|c| c.edge == coedge.edge).count();
                    if uses != 2 {
                        found.missing += 1;
                        found.missing_edge = found.missing_edge.or(Some(coedge.edge.0));
                    }
                }
                chords.extend(line.windows(2).enumerate().map(|(i, w)| {
                    let (from, to) = if coedge.forward { (w[0], w[1]) } else { (w[1], w[0]) };
                    Chord { from, to, of: Some((coedge.edge.0, i as u32)) }
                }));
            }
        }
    }
    chords
}

/// Pairs the remaining half-edges: the two sides of a cut pass the same positions in opposite directions.
fn pair_cuts(pool: &mut Pool, halves: &[Half], of_face: &FaceMesh, found: &mut Boundary) {
    let uv = |corner: u32| of_face.corners[corner as usize].uv;
    for i in 0..halves.len() {
        if pool.taken[i].is_some() {
            continue;
        }
        let (from, to) = pool.keys[i];
        let start = pool.keys.partition_point(|&k| k < (to, from));
        let candidates = (start..halves.len())
            .take_while(|&j| pool.keys[j] == (to, from))
            .filter(|&j| pool.taken[j].is_none() && j != i);
        // Of several candidates, the one whose two ends are moved by the same vector.
        let misfit = |j: usize| {
            let at_a = uv(halves[j].b) - uv(halves[i].a);
            let at_b = uv(halves[j].a) - uv(halves[i].b);
            at_a.distance_squared(at_b)
        };
        if let Some(j) = candidates.min_by(|&j, &k| misfit(j).total_cmp(&misfit(k))) {
            pool.taken[i] = Some(None);
            pool.taken[j] = Some(None);
            found.cuts.push([halves[i], halves[j]]);
        }
    }
}
