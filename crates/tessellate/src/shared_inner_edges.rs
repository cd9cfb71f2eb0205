//! Inner edges of one face that are also inner edges of another: two sides of something thinner than the
//! tolerance.
//!
//! Where two faces run along each other within the tolerance (a trailing edge, a rib that tapers off), both
//! may connect the same two vertices of their common boundary. The mesh would have an edge with four
//! triangles, or the same triangle twice. All but one of the faces are meshed again without this edge: they
//! insert a point in its middle, which lies on their own surface.

use crate::face_result::{Meshed, is_unproven};
use crate::part_job::PartJob;
use crate::rounds::{Pass, PassResult};
use crate::shared_edge::{SharedEdge, sorted};
use chordal_chart::Key;
use chordal_nurbs::Surface;
use rayon::prelude::*;

/// Rounds in which faces give up such edges: a face that is meshed again may share another one. What is
/// shared after the last round is found by the audit.
const SEPARATING_ROUNDS: usize = 3;

/// Meshes faces again that share an inner edge with another face.
pub(crate) fn separate(pass: &Pass<'_, '_>, result: &mut PassResult) {
    let job = pass.job;
    let is_flat = |face: u32| {
        let surface = job.surfaces[face as usize].as_ref();
        surface.is_ok_and(|s| matches!(s.surface, Surface::Plane { .. }))
    };
    let unproven = unproven_faces(job, &result.faces);
    let mut given_up: Vec<(u32, SharedEdge)> = Vec::new();
    for _ in 0..SEPARATING_ROUNDS {
        let uses = |edge: u32| job.faces_at(edge as usize);
        let mut more = shared_inner_edges(&result.faces, single_chords(result, pass), uses, is_flat);
        // A face without a proof has worse faults, and takes long.
        more.retain(|&(face, _)| !unproven[face as usize]);
        if more.is_empty() || job.cancel.is_cancelled() {
            return;
        }
        let mut again: Vec<u32> = more.iter().map(|m| m.0).collect();
        again.dedup();
        given_up.extend(more);
        given_up.sort_unstable();
        let mesh = |face: u32| {
            let of_face: Vec<SharedEdge> = given_up.iter().filter(|g| g.0 == face).map(|g| g.1).collect();
            (face, pass.mesh_one(face as usize, &result.edges, 0, &of_face))
        };
        let meshed: Vec<_> = again.into_par_iter().map(mesh).collect();
        for (face, new) in meshed {
            // A proven face is replaced by a proven one only.
            if let Ok(Ok(new)) = new
                && !is_unproven(&new, &job.limits, job.options.bound)
            {
                result.faces[face as usize] = Ok(new);
                result.questions[face as usize] = None;
            }
        }
    }
}

/// The edges of the part that are single chords, by their ends.
fn single_chords<'a>(
    result: &'a PassResult,
    pass: &'a Pass<'_, '_>,
) -> impl Iterator<Item = SharedEdge> + 'a {
    let single = (0..result.edges.len()).filter(|&i| result.edges[i].sag.len() == 1);
    single.map(|i| {
        let edge = &pass.job.part.edges[i];
        sorted([edge.start, edge.end].map(|v| Key::Vertex(v.index() as u32)))
    })
}

/// For every face: true if it has no triangles, or no proof although one is requested.
pub(crate) fn unproven_faces(job: &PartJob<'_>, faces: &[Meshed]) -> Vec<bool> {
    let is_unproven = |(face, meshed): (usize, &Meshed)| match meshed {
        Err(_) => job.surfaces[face].is_ok(),
        Ok(result) => is_unproven(result, &job.limits, job.options.bound),
    };
    faces.iter().enumerate().map(is_unproven).collect()
}

/// For faces, in order, the inner edges that they must give up. `chords`: edges of the part of a single
/// chord; `uses`: the faces at every edge of the part; `is_flat`: faces that keep an edge rather than
/// another.
fn shared_inner_edges<I: Iterator<Item = usize>>(
    faces: &[Meshed],
    chords: impl Iterator<Item = SharedEdge>,
    uses: impl Fn(u32) -> I + Copy,
    is_flat: impl Fn(u32) -> bool,
) -> Vec<(u32, SharedEdge)> {
    let mut sides: Vec<([u64; 2], u32, SharedEdge)> = Vec::new();
    for (f, face) in faces.iter().enumerate() {
        let Ok(face) = face else { continue };
        let shared = face.inner.iter().filter(|pair| have_two_faces(**pair, uses));
        sides.extend(shared.map(|&pair| (packed(pair), f as u32, pair)));
    }
    if sides.is_empty() {
        return Vec::new();
    }
    sides.extend(chords.map(|pair| (packed(pair), CHORD, pair)));
    sides.sort_unstable_by_key(|side| (side.0, side.1));
    let mut given_up = Vec::new();
    for group in sides.chunk_by(|a, b| a.0 == b.0).filter(|group| group.len() > 1) {
        let mut inner: Vec<u32> = group.iter().map(|side| side.1).filter(|&f| f != CHORD).collect();
        // One face may keep the edge, unless it is a chord of an edge of the part.
        let kept = usize::from(inner.len() == group.len());
        inner.dedup();
        inner.sort_by_key(|&f| (!is_flat(f), f));
        given_up.extend(inner.into_iter().skip(kept).map(|f| (f, group[0].2)));
    }
    given_up.sort_unstable();
    given_up
}

/// Stands for a chord of the part in place of a face.
const CHORD: u32 = u32::MAX;

/// False where no two faces lie at both of its ends.
fn have_two_faces<I: Iterator<Item = usize>>(pair: SharedEdge, uses: impl Fn(u32) -> I) -> bool {
    match pair {
        [Key::Edge(e, _), Key::Edge(f, _)] if e != f => {
            uses(e).filter(|&face| uses(f).any(|other| other == face)).count() > 1
        }
        _ => true,
    }
}

/// Numbers in place of keys, which sort faster.
fn packed(pair: SharedEdge) -> [u64; 2] {
    pair.map(|key| match key {
        Key::Vertex(v) => u64::from(v),
        Key::Edge(e, i) => 1 << 63 | u64::from(e) << 32 | u64::from(i),
        Key::Private(_) => u64::MAX,
    })
}
