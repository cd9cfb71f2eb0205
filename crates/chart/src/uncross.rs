//! Mends loops whose curves cross: the part gets a vertex at each crossing, and faces get loops without
//! crossings.
//!
//! Source: Balázs, Guthe, Klein 2004, section 5.1. There the correction works on polylines of one face. Here
//! it works on the part, so that edges keep their identity for the neighbours, and all later stages get loops
//! that do not cross:
//!
//! 1. [`meetings`]: where chords of a face cross in its chart, carried over to the exact curves.
//! 2. [`split`]: both edges are cut there at a new vertex, for all their faces. Edges that coincide between
//!    the same two vertices become one: where a loop overlaps itself by 1e-7, the face loses two edges, and
//!    its neighbours meet along the edge that remains.
//! 3. [`rebuild`]: the loops of the face from the boundary of the region that winding numbers describe
//!    ([`chordal_brep::winding`]): inside are points that more outer loops than holes go round, each an odd
//!    number of times.
//!
//! ```text
//!        ___________            ____   ____
//!    ___/___     ___\___   →   /    \ /    \
//!       \   \___/   /          \____/ \____/
//!        \_________/
//! ```
//!
//! There are new vertices where two curves cross. Between two of these vertices, curves within the resolution
//! of each other become one edge; otherwise, the region between them is outside of the face or a hole.
//!
//! Not guaranteed: a face of a closed shell whose region would leave a neighbour's edge open, or run it the
//! other way round (a bow tie of shared edges), stays as it is in the file, and is reported as not proven.

mod looseness;
mod meetings;
mod rebuild;
mod split;

use crate::trimmed_face::TrimmedFace;
use crate::unroll::Chart;
use chordal_brep::{EdgeId, FaceId, Loop, Part, VertexId};
use chordal_nurbs::DVec3;
use std::collections::{BTreeMap, BTreeSet};

use self::looseness::Looseness;
pub use meetings::loops_cross;

/// A face whose loops cross, with its chart.
#[derive(Debug)]
pub struct Crossed<'a, 's> {
    /// Its index in the part.
    pub face: usize,
    /// The face.
    pub context: &'a TrimmedFace<'a, 's>,
    /// Its chart, not cut along creases.
    pub chart: Chart,
}

/// A part with loops that do not cross.
#[derive(Debug)]
pub struct Uncrossed {
    /// The part.
    pub part: Part,
    /// Per face with new loops: how many crossings it had.
    pub faces: Vec<(usize, usize)>,
    /// Faces whose loops run back along themselves and bound no region.
    pub flat: BTreeSet<usize>,
}

/// The edges that two faces of a closed shell share. The shell stays closed only if both faces keep these
/// edges, in the same direction.
fn guarded(part: &Part) -> BTreeSet<EdgeId> {
    let mut guarded = BTreeSet::new();
    for shell in part.shells.iter().filter(|shell| shell.closed) {
        let mut seen: BTreeMap<EdgeId, FaceId> = BTreeMap::new();
        for &face in &shell.faces {
            for a_loop in &part.faces[face.index()].loops {
                let Loop::Edges { coedges, .. } = a_loop else { continue };
                let again = coedges.iter().filter(|c| *seen.entry(c.edge).or_insert(face) != face);
                guarded.extend(again.map(|c| c.edge));
            }
        }
    }
    guarded
}

/// A place at which an edge needs a vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Stop {
    edge: u32,
    t: f64,
}

/// A place where two edges meet, or a vertex and an edge.
#[derive(Clone, Debug, PartialEq)]
struct Meeting {
    stops: Vec<Stop>,
    point: DVec3,
    vertex: Option<VertexId>,
}

/// The part with new loops for these faces; `None` where no loop changes. Points nearer together than
/// `resolution` are one point. Curves that stay further apart than `tolerance` do not cross.
pub fn uncrossed(
    part: &Part,
    crossed: &[Crossed<'_, '_>],
    resolution: f64,
    tolerance: f64,
) -> Option<Uncrossed> {
    let mut meetings = Vec::new();
    let mut ends = Vec::new();
    let loose = Looseness::of(part, crossed, resolution);
    for one in crossed {
        meetings.extend(meetings::meetings(one.context, &one.chart, &loose, tolerance));
        ends.push(meetings.len());
    }
    let mut new = part.clone();
    let pieces = split::split(&mut new, &meetings, &loose);
    let guarded = guarded(&new);
    let mut faces = Vec::new();
    let mut flat = BTreeSet::new();
    let mut start = 0;
    for (one, end) in crossed.iter().zip(ends) {
        let places: BTreeSet<VertexId> = pieces.vertices[start..end].iter().copied().collect();
        start = end;
        let Some(loops) = rebuild::loops(one, &new, &pieces, &guarded) else { continue };
        faces.push((one.face, places.len()));
        if loops.is_empty() {
            flat.insert(one.face);
        } else {
            new.faces[one.face].loops = loops;
        }
    }
    (!flat.is_empty() || !faces.is_empty() && new != *part).then_some(Uncrossed { part: new, faces, flat })
}
