//! Where two faces meet at an edge, their facets go on from each other as their normals say.
//!
//! That the triangles of two faces run along their common edge in opposite directions
//! ([`crate::shell`]) does not tell a face from one that is folded back onto its neighbour:
//!
//! ```text
//!      n   n                       n
//!      │   │                       │
//!   ───●───●───  as in the file   ═●   folded: the edges agree, and both facets lie on one side
//! ```
//!
//! The file tells by the exact normals of the two faces and by their senses. Where the normals agree at both
//! ends of a chord of the edge, the faces go on smoothly, and the two facets at it must not lie on one side.
//! Where they are opposite, the file itself has a cusp there (two cylinders that touch in a line have one), and
//! at any other angle nothing is folded.
//!
//! Not compared: faces of which one is turned over against its sense in the file, which contradicts itself
//! there; edges with more than two faces; facets that are no higher than twice the tolerance over the edge,
//! whose direction means nothing.

use crate::context::Context;
use crate::findings::{AtEdge, FaceFindings};
use crate::report::{Problem, Subject};
use chordal_brep::AuditIssue;
use chordal_nurbs::DVec3;

/// Normals go on smoothly if the cosine of the angle between them is more: 10 degrees.
const SMOOTH: f64 = 0.985;

/// Facets that go on smoothly have normals that differ less; their cosine for 120 degrees.
const FOLDED: f64 = -0.5;

/// Facets that are higher than so many times the tolerance.
const HIGH: f64 = 2.0;

/// What lies along a chord.
#[derive(Clone, Copy, Debug, Default)]
enum Along {
    #[default]
    Nothing,
    One(u32, AtEdge),
    Two,
    /// Two facets that are folded onto each other.
    Folded(u32, u32),
    More,
}

/// The edges at which facets of two faces are folded onto each other.
pub(crate) fn folds_at_edges(context: &Context<'_>, faces: &[FaceFindings]) -> Vec<Problem> {
    let mut starts = vec![0usize];
    starts.extend(context.mesh.edges.iter().scan(0, |sum, line| {
        *sum += line.len().saturating_sub(1);
        Some(*sum)
    }));
    let mut along = vec![Along::Nothing; starts[starts.len() - 1]];
    for (face, found) in faces.iter().enumerate() {
        for at in &found.at_edges {
            let place = &mut along[starts[at.edge as usize] + at.chord as usize];
            *place = match *place {
                Along::Nothing => Along::One(face as u32, *at),
                Along::One(other, its)
                    if other == face as u32
                        || !is_folded(context, faces, [(other, &its), (face as u32, at)]) =>
                {
                    Along::Two
                }
                Along::One(other, _) => Along::Folded(other, face as u32),
                _ => Along::More,
            };
        }
    }
    let of_edge = |edge: usize| {
        let mut folded = along[starts[edge]..starts[edge + 1]].iter().filter_map(|along| match along {
            Along::Folded(a, b) => Some((*a, *b)),
            _ => None,
        });
        let (a, b) = folded.next()?;
        let faces = [a, b].map(|f| context.part.faces[f as usize].source);
        let issue = AuditIssue::FoldedAtEdge { chords: 1 + folded.count(), faces };
        Some(Problem::new(Subject::Edge(edge as u32), context.part.edges[edge].source, issue))
    };
    (0..context.mesh.edges.len()).filter_map(of_edge).collect()
}

fn is_folded(context: &Context<'_>, faces: &[FaceFindings], both: [(u32, &AtEdge); 2]) -> bool {
    let [a, b] = both.map(|(face, at)| Facet::new(context, face, at));
    let [s, t] = both.map(|(face, _)| faces[face as usize].is_along_sense);
    // They run along the edge in opposite directions; if not, the shell is reported.
    let goes_on = s == t && a.ends[0].0 == b.ends[1].0 && a.ends[1].0 == b.ends[0].0;
    let is_smooth = |i: usize| a.ends[i].1.dot(b.ends[1 - i].1) > SMOOTH;
    if !goes_on || !is_smooth(0) || !is_smooth(1) {
        return false;
    }
    let least = HIGH * context.options.tolerance;
    let along = a.chord.length();
    let is_high = |facet: &Facet| facet.normal.length() > least * along;
    is_high(&a) && is_high(&b) && a.normal.dot(b.normal) < FOLDED * a.normal.length() * b.normal.length()
}

/// A facet along a chord.
struct Facet {
    /// Positions of the chord's ends, as the facet runs, with the exact normals of its face there.
    ends: [(u32, DVec3); 2],
    chord: DVec3,
    /// As long as twice the area.
    normal: DVec3,
}

impl Facet {
    fn new(context: &Context<'_>, face: u32, at: &AtEdge) -> Self {
        let mesh = &context.mesh.faces[face as usize];
        let t = mesh.triangles[at.triangle as usize];
        let corner = |k: usize| &mesh.corners[t[(usize::from(at.side) + k) % 3] as usize];
        let [top, from, to] = [0, 1, 2].map(corner);
        let [p, q, r] = [top, from, to].map(|c| context.mesh.positions[c.position as usize]);
        Self {
            ends: [(from.position, from.normal), (to.position, to.normal)],
            chord: r - q,
            normal: (q - p).cross(r - p),
        }
    }
}
