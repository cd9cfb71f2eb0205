//! Rounds: all faces of a part are meshed, those that find their edges too coarse once more with finer ones.
//!
//! 1. Sample every edge once ([`Pass::sample_edges`]).
//! 2. Mesh the faces, in parallel. A face never changes an edge; it requests finer chords.
//! 3. Merge the requests of all faces, and cut those chords.
//! 4. Mesh the faces at those edges again; go on with 3 until there are no requests, or the last round is
//!    over.
//!
//! What one face does never depends on another face of the same round, so the order of threads changes
//! nothing.

use crate::attempts::mesh_face;
use crate::budget::Budget;
use crate::closer::Closer;
use crate::edges::{SampledEdge, split_chords};
use crate::effort::{Effort, MAX_ROUNDS, Setback};
use crate::face_context::FaceContext;
use crate::face_result::{FaceResult, Meshed};
use crate::memo::Question;
use crate::options::Options;
use crate::panics::caught;
use crate::part_job::{PartJob, edges_of_face};
use crate::shared_edge::SharedEdge;
use chordal_brep::{Edge, MeshIssue};
use chordal_chart::{EdgeSamples, FaceSurface, TrimmedFace};
use chordal_nurbs::{Curve, work};
use rayon::prelude::*;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Rounds in which chords are halved; later ones are quartered. Where a surface turns within almost no
/// distance, halves do not get there in the rounds that there are.
const HALVING_ROUNDS: usize = 3;

/// One pass over a part, from its edges on.
pub(crate) struct Pass<'j, 'a> {
    pub job: &'j PartJob<'a>,
    /// Of every face: the default meshes it and its edges, in place of the methods of the options. None: no
    /// face.
    by_default: Option<(Options, Vec<bool>)>,
    /// Of every face, the places at which its facets must keep a smaller tolerance; empty where no face has
    /// any.
    pub closer: Vec<Vec<Closer>>,
}

/// What a face is before its edges are fine enough for it.
const UNFINISHED: MeshIssue = MeshIssue::EdgesTooCoarse { rounds: MAX_ROUNDS };

/// What a face gave in one round: a mesh or a failure, or chords that must become finer first.
type Answer = Result<Meshed, Vec<(u32, u32)>>;

/// An edge that has no samples, and why.
pub(crate) type EdgeFault = (u32, MeshIssue);

/// The edges of a part as polylines.
pub(crate) struct SampledEdges {
    pub edges: Vec<SampledEdge>,
    pub faults: Vec<EdgeFault>,
}

/// What a pass makes.
#[derive(Clone)]
pub(crate) struct PassResult {
    pub edges: Vec<EdgeSamples>,
    /// Of every edge, the fewest chords that the tolerance allows.
    pub fewest: Vec<f64>,
    /// Edges that the requested edge method gave up.
    pub edges_given_up: usize,
    pub edge_faults: Vec<EdgeFault>,
    pub faces: Vec<Meshed>,
    /// Of every face, what it was meshed by, where that is all that it depends on.
    pub questions: Vec<Option<Question>>,
    /// The number of rounds in which faces requested finer edges.
    pub rounds: usize,
}

impl PassResult {
    /// Triangles of all faces.
    pub fn triangle_count(&self) -> usize {
        self.faces.iter().flatten().map(|face| face.triangles.len()).sum()
    }
}

impl<'j, 'a> Pass<'j, 'a> {
    /// All faces and edges by the methods of the options.
    pub fn new(job: &'j PartJob<'a>) -> Self {
        Self { job, by_default: None, closer: Vec::new() }
    }

    /// These faces and their edges by the default, the others by the methods of the options.
    pub fn with_default_for(job: &'j PartJob<'a>, faces: Vec<bool>) -> Self {
        let options = Options { fill_method: None, edge_splitter: None, ..job.options.clone() };
        Self { job, by_default: Some((options, faces)), closer: Vec::new() }
    }

    fn options_of_face(&self, face: usize) -> &Options {
        match &self.by_default {
            Some((default, faces)) if faces[face] => default,
            _ => self.job.options,
        }
    }

    fn options_of_edge(&self, edge: usize) -> &Options {
        match &self.by_default {
            Some((default, faces)) if self.job.faces_at(edge).any(|f| faces[f]) => default,
            _ => self.job.options,
        }
    }

    /// Samples all edges; those that a panic spoiled have no samples.
    pub fn sample_edges(&self) -> SampledEdges {
        let all = (0..self.job.part.edges.len()).into_par_iter();
        let mut known = self.job.remembered(|memo| std::mem::take(&mut memo.edges)).unwrap_or_default();
        known.resize(self.job.part.edges.len(), None);
        let sampled: Vec<Result<SampledEdge, MeshIssue>> =
            all.zip(known).map(|(i, known)| known.map_or_else(|| self.sample(i, 1), Ok)).collect();
        self.job.remembered(|memo| memo.edges = sampled.iter().map(|edge| edge.clone().ok()).collect());
        let mut faults = Vec::new();
        let mut edges = Vec::with_capacity(sampled.len());
        for (i, result) in sampled.into_iter().enumerate() {
            edges.push(result.unwrap_or_else(|issue| {
                faults.push((i as u32, issue));
                SampledEdge::default()
            }));
        }
        for i in self.twins(&edges) {
            match self.sample(i, 2) {
                Ok(sampled) => edges[i] = sampled,
                Err(issue) => faults.push((i as u32, issue)),
            }
        }
        SampledEdges { edges, faults }
    }

    fn sample(&self, edge: usize, least: usize) -> Result<SampledEdge, MeshIssue> {
        let job = self.job;
        if job.faces_at(edge).next().is_none() {
            return Ok(SampledEdge::default());
        }
        let splitter = self.options_of_edge(edge).edge_splitter.as_deref();
        let sample = |budget| {
            let uses = job.edge_uses(edge);
            let model = &job.part.edges[edge];
            let sampled = SampledEdge::new(job.part, model, &uses, &job.limits, splitter, least, budget);
            if work::is_over() { Err(MeshIssue::EdgeGivenUp) } else { sampled }
        };
        let spent = &job.efforts.edges[edge];
        let mut sampled = caught(|| job.within_budget(spent, sample))??;
        spent.made(sampled.samples.t.len(), job.options.file_budget.as_ref());
        // In a pass by the default, for some of its faces.
        let is_left_to_default = splitter.is_none() && job.options.edge_splitter.is_some();
        let has_curve = job.part.edges[edge].curve.is_some();
        sampled.method_gave_up |= is_left_to_default && has_curve;
        Ok(sampled)
    }

    /// Single chords between the same two vertices as another single chord, where the curve is not straight:
    /// they would enclose nothing.
    fn twins(&self, edges: &[SampledEdge]) -> Vec<usize> {
        let model = &self.job.part.edges;
        let ends = |e: &Edge| (e.start.min(e.end), e.start.max(e.end));
        let mut single: Vec<_> = (0..edges.len())
            .filter(|&i| edges[i].samples.sag.len() == 1)
            .map(|i| (ends(&model[i]), i))
            .collect();
        single.sort_unstable();
        let mut found = Vec::new();
        for group in single.chunk_by(|a, b| a.0 == b.0).filter(|g| g.len() > 1) {
            let curved = |&&(_, i): &&(_, usize)| {
                !matches!(model[i].curve.as_deref(), Some(Curve::Line { .. }) | None)
            };
            found.extend(group.iter().filter(curved).map(|&(_, i)| i));
        }
        found
    }

    /// Meshes one face with the edges as they are.
    ///
    /// # Errors
    /// Where edges must become finer first, or the face fails.
    pub fn mesh_one(
        &self,
        face: usize,
        edges: &[EdgeSamples],
        round: usize,
        doubled: &[SharedEdge],
    ) -> Answer {
        let job = self.job;
        let surface = match job.surface(face) {
            Ok(surface) => surface,
            Err(issue) => return Ok(Err(issue)),
        };
        if job.known.flat.contains(&face) {
            return Ok(Ok(Box::new(FaceResult { bound: "no area", ..FaceResult::default() })));
        }
        if job.cancel.is_cancelled() {
            return Ok(Err(MeshIssue::Cancelled));
        }
        let spent = &job.efforts.faces[face];
        let result = job.within_budget(spent, |budget| {
            if budget.is_over() {
                return Ok(Err(MeshIssue::OutOfTime { elements: 0 }));
            }
            let result = self.mesh_within(face, surface, edges, round, doubled, budget);
            // What reached the limit may have ended early anywhere.
            if work::is_over() { Ok(Err(out_of_time(&result))) } else { result }
        });
        if let Ok(Ok(meshed)) = &result {
            spent.made(meshed.triangles.len(), job.options.file_budget.as_ref());
        }
        result
    }

    /// Meshes one face within the budget.
    fn mesh_within(
        &self,
        face: usize,
        surface: &FaceSurface<'_>,
        edges: &[EdgeSamples],
        round: usize,
        doubled: &[SharedEdge],
        budget: Budget,
    ) -> Answer {
        let job = self.job;
        let context = FaceContext {
            trimmed: TrimmedFace {
                part: job.part,
                face: &job.part.faces[face],
                surface,
                edges,
                touching: job.known.touching.contains(&face),
                resolution: job.resolution,
            },
            doubled,
            closer: self.closer.get(face).map_or(&[], Vec::as_slice),
            budget,
        };
        let options = self.options_of_face(face);
        let attempt = |effort: Effort| {
            let result = caught(|| mesh_face(&context, &job.limits, options, job.cancel, effort));
            match result.unwrap_or_else(|panic| Err(Setback::Failed(panic))) {
                Ok(meshed) => Ok(Ok(meshed)),
                Err(Setback::CoarseEdges(chords)) => Err(chords),
                Err(Setback::Failed(issue)) => Ok(Err(issue)),
                Err(Setback::CoarseSeam | Setback::Crossing | Setback::Stuck) => {
                    Ok(Err(MeshIssue::SeamTooCoarse))
                }
            }
        };
        let effort = Effort::of_round(round);
        attempt(effort).or_else(|mut chords| {
            chords.retain(|&(edge, chord)| self.can_be_finer(&edges[edge as usize], chord as usize));
            // Chords as short as points do not help: better what there is now than the same after more
            // rounds.
            if chords.is_empty() { attempt(effort.with_final_edges()) } else { Err(chords) }
        })
    }

    /// False for a chord, and a curve over it, within one point.
    fn can_be_finer(&self, samples: &EdgeSamples, chord: usize) -> bool {
        let length = samples.points[chord].distance(samples.points[chord + 1]);
        length > self.job.resolution || samples.sag[chord] > self.job.resolution
    }

    /// Meshes all faces; those that request finer edges, and their neighbours, again. `done` gets the number
    /// of faces that are finished for the first time.
    pub fn run(&self, done: &(dyn Fn(usize) + Sync)) -> PassResult {
        self.run_with(self.sample_edges(), done)
    }

    /// The same with edges that are sampled already.
    pub fn run_with(&self, sampled: SampledEdges, done: &(dyn Fn(usize) + Sync)) -> PassResult {
        let SampledEdges { edges, faults: edge_faults } = sampled;
        let edges_given_up = edges.iter().filter(|edge| edge.method_gave_up).count();
        let (edges, fewest): (Vec<EdgeSamples>, Vec<f64>) =
            edges.into_iter().map(|edge| (edge.samples, edge.fewest)).unzip();
        let n = self.job.part.faces.len();
        let faces = vec![Err(UNFINISHED); n];
        let mut result = PassResult {
            edges,
            fewest,
            edges_given_up,
            edge_faults,
            faces,
            questions: vec![None; n],
            rounds: 0,
        };
        self.run_rounds(&mut result, (0..n).collect(), done);
        result
    }

    /// Meshes these faces, again if they have a mesh already; those that request finer edges, and their
    /// neighbours, again.
    pub fn run_rounds(&self, result: &mut PassResult, mut dirty: Vec<usize>, done: &(dyn Fn(usize) + Sync)) {
        let finished = AtomicUsize::new(0);
        let mut rounds = 0;
        for round in 0.. {
            let edges = &result.edges;
            let questions: Vec<Option<Question>> =
                dirty.iter().map(|&face| self.question(face, edges, round)).collect();
            let recalled: Vec<_> = dirty.iter().zip(&questions).map(|(&f, q)| self.recalled(f, *q)).collect();
            let mesh = |(&face, known): (&usize, Option<Answer>)| {
                let result = known.unwrap_or_else(|| self.mesh_one(face, edges, round, &[]));
                if round == 0 {
                    done(finished.fetch_add(1, Ordering::Relaxed) + 1);
                }
                result
            };
            let results: Vec<Answer> = dirty.par_iter().zip(recalled).map(mesh).collect();
            let mut requests = Vec::new();
            for ((&face, question), meshed) in dirty.iter().zip(questions).zip(results) {
                result.questions[face] = question.filter(|_| meshed.is_ok());
                result.faces[face] = meshed.unwrap_or_else(|chords| {
                    self.note_requests(face, question, &chords);
                    requests.extend(chords);
                    Err(UNFINISHED)
                });
            }
            if requests.is_empty() || round == MAX_ROUNDS || self.job.cancel.is_cancelled() {
                break;
            }
            rounds = round + 1;
            dirty = self.refine_edges(&mut result.edges, requests, round);
        }
        result.rounds += rounds;
    }

    /// What a face is meshed by in this round; none where that depends on more.
    fn question(&self, face: usize, edges: &[EdgeSamples], round: usize) -> Option<Question> {
        let job = self.job;
        let is_default = job.options.fill_method.is_none() && job.options.edge_splitter.is_none();
        if !is_default || !self.closer.is_empty() || job.memo.is_none() {
            return None;
        }
        let mut hasher = DefaultHasher::new();
        let known = &job.known;
        (round, known.flat.contains(&face), known.touching.contains(&face)).hash(&mut hasher);
        job.resolution.to_bits().hash(&mut hasher);
        for edge in edges_of_face(job.part, face) {
            let EdgeSamples { t, points, sag } = &edges[edge];
            (edge, t.len()).hash(&mut hasher);
            let coordinates = points.iter().flat_map(|p| p.to_array());
            t.iter().chain(sag).copied().chain(coordinates).for_each(|x| hasher.write_u64(x.to_bits()));
        }
        Some(hasher.finish())
    }

    /// What the question gave in an earlier pass.
    fn recalled(&self, face: usize, question: Option<Question>) -> Option<Answer> {
        let known = self.job.remembered(|memo| memo.recall(face, question?)).flatten()?;
        Some(known.map(Ok))
    }

    fn note_requests(&self, face: usize, question: Option<Question>, chords: &[(u32, u32)]) {
        if let Some(question) = question {
            self.job.remembered(|memo| memo.note_requests(face, question, chords));
        }
    }

    /// Cuts the requested chords; returns the faces at their edges.
    fn refine_edges(
        &self,
        edges: &mut [EdgeSamples],
        mut requests: Vec<(u32, u32)>,
        round: usize,
    ) -> Vec<usize> {
        requests.sort_unstable();
        requests.dedup();
        let pieces = if round < HALVING_ROUNDS { 2 } else { 4 };
        let mut dirty = Vec::new();
        for group in requests.chunk_by(|a, b| a.0 == b.0) {
            let edge = group[0].0 as usize;
            let chords: Vec<u32> = group.iter().map(|request| request.1).collect();
            split_chords(&mut edges[edge], &self.job.part.edges[edge], &chords, pieces);
            dirty.extend(self.job.faces_at(edge));
        }
        dirty.sort_unstable();
        dirty.dedup();
        dirty
    }
}

/// The reason of a face that reached its limit, with the triangles that it had where that is known.
fn out_of_time(result: &Answer) -> MeshIssue {
    match result {
        Ok(Err(issue @ MeshIssue::OutOfTime { .. })) => issue.clone(),
        Ok(Ok(meshed)) => MeshIssue::OutOfTime { elements: meshed.triangles.len() },
        _ => MeshIssue::OutOfTime { elements: 0 },
    }
}
