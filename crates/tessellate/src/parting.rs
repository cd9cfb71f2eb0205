//! Parting: facets that cut each other where the faces do not are refined on both sides until they part.
//!
//! Every facet is within the tolerance of its face. Where two faces are nearer together than that (thin
//! walls, fillets that are nearly tangent), their facets may cut each other all the same.
//!
//! 1. Whoever called finds pairs of facets that cut each other ([`FindCuts`]).
//! 2. Around each cut both faces get a smaller tolerance ([`STEP`]), and chords of their edges that are
//!    further off are halved.
//! 3. These faces are meshed again in rounds, with the neighbours whose edges became finer
//!    ([`Pass::run_rounds`]).
//! 4. Go on with 1 until nothing cuts, [`PARTINGS`] times at most.
//! 5. If some pairs of faces never part, the refinement starts again without them.
//!
//! A mesh in which another face is not proven, or that is much larger, is never taken. Not guaranteed: that
//! faces which are apart are parted; the audit reports what still cuts.

use crate::closer::{Closer, box_around, tolerance_within};
use crate::edges::split_chords;
use crate::face_result::FaceResult;
use crate::part_job::{PartJob, edges_of_face};
use crate::rounds::{Pass, PassResult};
use crate::shared_inner_edges::{separate, unproven_faces};
use crate::stitch::stitch;
use chordal_brep::Part;
use chordal_chart::EdgeSamples;
use chordal_mesh::PartMesh;
use chordal_nurbs::Box3;
use std::collections::BTreeSet;

/// Two facets that cut each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FacetCut {
    /// Indices of their faces in the part.
    pub faces: [u32; 2],
    /// A box around the line along which they cut each other.
    pub bounds: Box3,
}

/// Finds facets of a mesh of a part that cut each other although their faces do not.
pub type FindCuts<'f> = dyn Fn(&Part, &PartMesh) -> Vec<FacetCut> + Sync + 'f;

/// How often both sides of what cuts are refined. With [`STEP`], the last tolerance is 1/65536 of the first:
/// walls thinner than that are below what files keep.
const PARTINGS: usize = 8;

/// The tolerance around a cut as a share of the one before. Chords become half as long by it. A larger share
/// needs more rounds, each with a search of the whole part; a smaller one makes more triangles than needed.
/// Steps by the distance of the faces from each other were tried: they need more triangles and part fewer.
const STEP: f64 = 0.25;

/// Parting may add this many triangles for each one there is, and some more. Where it takes more, the faces
/// touch along lines or areas, and no refinement parts them.
const MORE_TRIANGLES: (usize, usize) = (1, 2_000);

/// Halvings of the chords around one cut: as many as [`STEP`] ever needs for a smooth curve, and some more.
const HALVINGS: usize = 4;

type FacePair = [u32; 2];

/// Refines the faces whose facets cut each other until they part, as far as they do.
pub(crate) fn part_facets(pass: Pass<'_, '_>, result: PassResult, find: &FindCuts<'_>) -> PassResult {
    let mut parting = Parting { pass, find, left: BTreeSet::new() };
    let cuts = parting.cuts(&result);
    if cuts.is_empty() {
        return result;
    }
    let before = pairs(&cuts);
    let (refined, still) = parting.refined(&result, cuts.clone());
    if still.is_empty() {
        return refined;
    }
    if still.is_superset(&before) {
        return result;
    }
    parting.left = still.intersection(&before).copied().collect();
    let (without_left, again) = parting.refined(&result, cuts);
    match () {
        () if still.len() < again.len() => refined,
        () if again.len() < before.len() => without_left,
        () => result,
    }
}

fn pairs(cuts: &[FacetCut]) -> BTreeSet<FacePair> {
    cuts.iter().map(|cut| cut.faces).collect()
}

struct Parting<'j, 'a, 'f> {
    pass: Pass<'j, 'a>,
    find: &'f FindCuts<'f>,
    /// Pairs of faces that are not refined.
    left: BTreeSet<FacePair>,
}

impl<'a> Parting<'_, 'a, '_> {
    fn job(&self) -> &PartJob<'a> {
        self.pass.job
    }

    fn cuts(&self, result: &PassResult) -> Vec<FacetCut> {
        let faces: Vec<Option<&FaceResult>> = result.faces.iter().map(|face| face.as_deref().ok()).collect();
        (self.find)(self.job().part, &stitch(self.job().part, &result.edges, &faces))
    }

    /// The part with what cuts refined, and the pairs of faces that cut even so.
    fn refined(&mut self, start: &PassResult, mut cuts: Vec<FacetCut>) -> (PassResult, BTreeSet<FacePair>) {
        self.pass.closer = vec![Vec::new(); start.faces.len()];
        let most = start.triangle_count() * (1 + MORE_TRIANGLES.0) + MORE_TRIANGLES.1;
        let unproven = unproven_faces(self.job(), &start.faces);
        let mut now = start.clone();
        for _ in 0..PARTINGS {
            cuts.retain(|cut| !self.left.contains(&cut.faces));
            let mut next = now.clone();
            let dirty = self.tighten(&mut next.edges, &cuts);
            if dirty.is_empty() || self.job().cancel.is_cancelled() {
                break;
            }
            self.pass.run_rounds(&mut next, dirty, &|_| ());
            separate(&self.pass, &mut next);
            if is_worse(self.job(), &unproven, &now, &next) || next.triangle_count() > most {
                break;
            }
            now = next;
            cuts = self.cuts(&now);
        }
        let still = pairs(&cuts);
        (now, still)
    }

    /// Sets smaller tolerances around cuts and halves chords that are further off; returns the faces to be
    /// meshed again.
    fn tighten(&mut self, edges: &mut [EdgeSamples], cuts: &[FacetCut]) -> Vec<usize> {
        let job = self.pass.job;
        let mut places: Vec<(usize, Closer)> = Vec::new();
        for cut in cuts {
            let both = if cut.faces[0] == cut.faces[1] { &cut.faces[..1] } else { &cut.faces[..] };
            for face in both.iter().map(|&face| face as usize) {
                let before = tolerance_within(&self.pass.closer[face], &cut.bounds, job.limits.tolerance);
                let tolerance = STEP * before;
                if before > job.resolution {
                    places.push((face, Closer { bounds: cut.bounds.inflated(tolerance), tolerance }));
                }
            }
        }
        let mut dirty: BTreeSet<usize> = places.iter().map(|place| place.0).collect();
        for (face, place) in places {
            for edge in edges_of_face(job.part, face) {
                if halve_chords(job, edges, edge, &place) {
                    dirty.extend(job.faces_at(edge));
                }
            }
            self.pass.closer[face].push(place);
        }
        dirty.into_iter().collect()
    }
}

/// True where a face has no proof or no triangles that had some.
fn is_worse(job: &PartJob<'_>, unproven: &[bool], before: &PassResult, after: &PassResult) -> bool {
    let now_unproven = unproven_faces(job, &after.faces);
    let loses_proof = unproven.iter().zip(&now_unproven).any(|(&before, &now)| now && !before);
    loses_proof || before.faces.iter().zip(&after.faces).any(|(before, now)| before.is_ok() && now.is_err())
}

/// Halves the chords of an edge that are further off than a place allows; false where there are none.
fn halve_chords(job: &PartJob<'_>, edges: &mut [EdgeSamples], edge: usize, place: &Closer) -> bool {
    let mut is_changed = false;
    for _ in 0..HALVINGS {
        let samples = &edges[edge];
        let is_coarse = |&chord: &u32| {
            let [a, b] = [0, 1].map(|i| samples.points[chord as usize + i]);
            let sag = samples.sag[chord as usize];
            sag > place.tolerance
                && sag.is_finite()
                && a.distance(b) > job.resolution
                && box_around(&[a, b]).inflated(sag).meets(&place.bounds)
        };
        let chords: Vec<u32> = (0..samples.sag.len() as u32).filter(is_coarse).collect();
        if chords.is_empty() {
            break;
        }
        split_chords(&mut edges[edge], &job.part.edges[edge], &chords, 2);
        is_changed = true;
    }
    is_changed
}
