//! The stages of one part, top to bottom, and the rounds in which faces ask for finer edges.

use crate::chart::{FaceContext, Key};
use crate::doubled::{SharedEdge, doubled_edges, sorted};
use crate::edge_method::EdgeMethod;
use crate::edges::{EdgeSamples, EdgeUse};
use crate::face::{FaceResult, Outcome, mesh_face};
use crate::looseness::pcurve_gap;
use crate::lower_bound::lower_bound;
use crate::metric::Limits;
use crate::options::{Bound, Cancel, Options};
use crate::orient::{settle_orientation, turn_inside_out};
use crate::report::{FaceReport, PartReport};
use crate::stitch::stitch;
use crate::strategy::Strategy;
use crate::surface::FaceSurface;
use chordal_brep::{Edge, Face, FaceGeometry, Loop, Part, Pcurve};
use chordal_mesh::PartMesh;
use chordal_nurbs::{Curve, DVec3, Surface};
use rayon::prelude::*;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

/// Rounds in which faces may ask for finer edges; what is still too coarse then is meshed as it is and reported.
const MAX_ROUNDS: usize = 8;

/// In so many rounds points inside are tried before chords with wild bounds are made finer.
const CLOSER_ROUNDS: usize = 3;

/// In so many rounds chords are halved, later quartered: where a surface turns within almost no distance, halves do not get there.
const HALVING_ROUNDS: usize = 3;

/// Rounds in which faces give up edges that others have too.
const SEPARATING_ROUNDS: usize = 3;

/// From this round on loops that still cross are taken to cross in truth.
const LAST_RESORT: usize = 6;

/// Faces that other methods leave undone are left to the default so often; from the second time on with their neighbours, which may
/// be the ones that ask for finer edges.
const LEAVINGS: usize = 2;

/// The share of the tolerance that is aimed at, so that rounding and the last bit of a bound never matter.
const AIM: f64 = 0.995;

/// Points nearer than this share of the tolerance are one point: poles, vertices on them, pcurves that agree.
const SAME_POINT: f64 = 0.02;

/// They are also nearer than this share of the part: a coarse tolerance merges nothing.
const SAME_POINT_OF_PART: f64 = 1e-6;

/// The diagonal of the box of a part's vertices.
fn diagonal(part: &Part) -> f64 {
    let low = part.vertices.iter().fold(DVec3::INFINITY, |m, v| m.min(v.point));
    let high = part.vertices.iter().fold(DVec3::NEG_INFINITY, |m, v| m.max(v.point));
    if low.is_finite() && high != low { (high - low).length() } else { f64::INFINITY }
}

/// Points of the part nearer together than this are one point.
pub(crate) fn resolution(part: &Part, tolerance: f64) -> f64 {
    (SAME_POINT * tolerance).min(SAME_POINT_OF_PART * diagonal(part))
}

/// Why a face is not even tried.
fn unusable(face: &Face) -> Option<String> {
    match &face.geometry {
        FaceGeometry::Failed(reason) => Some(reason.clone()),
        FaceGeometry::Surface(_) => None,
    }
}

/// What is known about an edge beside its curve.
#[derive(Default)]
struct EdgeInfo<'a> {
    uses: Vec<(usize, Option<&'a Pcurve>)>,
}

struct Job<'a> {
    part: &'a Part,
    limits: Limits,
    options: &'a Options,
    cancel: &'a Cancel,
    resolution: f64,
    surfaces: Vec<Option<FaceSurface<'a>>>,
    info: Vec<EdgeInfo<'a>>,
    /// Faces that other methods could not prove, with the options of the default ones.
    left: Option<(Options, Vec<bool>)>,
}

/// Meshes one part. Never fails as a whole: a face that cannot be meshed is reported with its reason.
///
/// `done` is called with the number of faces finished, from any thread, as the work goes on.
pub fn tessellate_part(
    part: &Part,
    options: &Options,
    cancel: &Cancel,
    done: &(dyn Fn(usize) + Sync),
) -> (PartMesh, PartReport) {
    let mut report = PartReport::default();
    let clock = Instant::now();
    let resolution = resolution(part, options.tolerance);
    let exact: Vec<Option<std::borrow::Cow<'_, Surface>>> = part.faces.iter().map(exact_surface).collect();
    let surfaces = exact.iter().map(|s| s.as_deref().map(|s| FaceSurface::new(s, resolution))).collect();
    let mut job = Job {
        part,
        limits: Limits {
            tolerance: AIM * options.tolerance,
            boundary: AIM * options.boundary_tolerance.unwrap_or(options.tolerance),
            angle: options.angle.unwrap_or(f64::INFINITY),
            length: options.max_edge.unwrap_or(f64::INFINITY),
        },
        options,
        cancel,
        resolution,
        surfaces,
        info: edge_info(part),
        left: None,
    };
    report.seconds.heal = clock.elapsed().as_secs_f64();

    let clock = Instant::now();
    let mut edges = job.sample_edges();
    report.seconds.edges = clock.elapsed().as_secs_f64();
    edges.iter().for_each(|e| report.edge_trace.merge(&e.trace));

    let clock = Instant::now();
    let mut outcomes = job.rounds(&mut edges, &mut report, done);
    job.leave_to_default(&mut edges, &mut outcomes, &mut report);
    report.seconds.faces = clock.elapsed().as_secs_f64();

    let clock = Instant::now();
    job.describe(&edges, &outcomes, &mut report);
    let mut faces: Vec<Option<Box<FaceResult>>> = outcomes.into_iter().map(Result::ok).collect();
    settle_orientation(&mut faces);
    turn_inside_out(part, &edges, &mut faces);
    let mesh = stitch(part, &edges, &faces);
    report.seconds.stitch = clock.elapsed().as_secs_f64();
    (mesh, report)
}

/// The surface to mesh on: offsets of elementary surfaces are elementary themselves.
fn exact_surface(face: &Face) -> Option<std::borrow::Cow<'_, Surface>> {
    let FaceGeometry::Surface(surface) = &face.geometry else { return None };
    Some(match surface.as_ref() {
        Surface::Offset { .. } => std::borrow::Cow::Owned(surface.as_ref().clone().simplified()),
        other => std::borrow::Cow::Borrowed(other),
    })
}

fn edge_info(part: &Part) -> Vec<EdgeInfo<'_>> {
    let mut info: Vec<EdgeInfo<'_>> = (0..part.edges.len()).map(|_| EdgeInfo::default()).collect();
    for (f, face) in part.faces.iter().enumerate() {
        if unusable(face).is_some() {
            continue;
        }
        for a_loop in &face.loops {
            let Loop::Edges { coedges, .. } = a_loop else { continue };
            for coedge in coedges {
                info[coedge.edge.index()].uses.push((f, coedge.pcurves.first()));
            }
        }
    }
    info
}

fn face_reach(part: &Part, face: &Face) -> f64 {
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let mut add = |p: DVec3| (low, high) = (low.min(p), high.max(p));
    for a_loop in &face.loops {
        if let Loop::Edges { coedges, .. } = a_loop {
            for coedge in coedges {
                let edge = &part.edges[coedge.edge.index()];
                add(part.vertices[edge.start.index()].point);
                if let Some(curve) = &edge.curve {
                    add(curve.point(0.5 * (edge.range.start + edge.range.end)));
                }
            }
        }
    }
    if low.is_finite() { (high - low).length() } else { 0.0 }
}

impl Job<'_> {
    fn sample(&self, index: usize, reach: &[f64], least: usize) -> EdgeSamples {
        let info = &self.info[index];
        if info.uses.is_empty() {
            return EdgeSamples::default();
        }
        let edge = &self.part.edges[index];
        let uses: Vec<EdgeUse<'_, '_>> = info
            .uses
            .iter()
            .filter_map(|&(f, pcurve)| {
                let surface = self.surfaces[f].as_ref()?;
                Some(EdgeUse { surface, pcurve, reach: reach[f] }.paced(edge, self.limits.tolerance))
            })
            .collect();
        let method = match &self.left {
            Some((default, faces)) if info.uses.iter().any(|&(f, _)| faces[f]) => default.edge_method,
            _ => self.options.edge_method,
        };
        let sampled = catch_unwind(AssertUnwindSafe(|| {
            EdgeSamples::new(self.part, edge, &uses, &self.limits, method, least)
        }));
        sampled.unwrap_or_default()
    }

    fn sample_edges(&self) -> Vec<EdgeSamples> {
        let reach: Vec<f64> = self.part.faces.iter().map(|face| face_reach(self.part, face)).collect();
        let mut edges: Vec<EdgeSamples> =
            (0..self.part.edges.len()).into_par_iter().map(|i| self.sample(i, &reach, 1)).collect();
        for i in self.twins(&edges) {
            edges[i] = self.sample(i, &reach, 2);
        }
        edges
    }

    /// Single chords between the same two vertices as another single chord, where the curve is not straight: they would
    /// enclose nothing.
    fn twins(&self, edges: &[EdgeSamples]) -> Vec<usize> {
        let ends = |e: &Edge| (e.start.min(e.end), e.start.max(e.end));
        let mut single: Vec<_> = (0..edges.len())
            .filter(|&i| edges[i].sag.len() == 1)
            .map(|i| (ends(&self.part.edges[i]), i))
            .collect();
        single.sort_unstable();
        let mut found = Vec::new();
        for group in single.chunk_by(|a, b| a.0 == b.0).filter(|g| g.len() > 1) {
            let curved = |&&(_, i): &&(_, usize)| {
                !matches!(self.part.edges[i].curve.as_deref(), Some(Curve::Line { .. }) | None)
            };
            found.extend(group.iter().filter(curved).map(|&(_, i)| i));
        }
        found
    }

    fn mesh_one(&self, index: usize, edges: &[EdgeSamples], round: usize, doubled: &[SharedEdge]) -> Outcome {
        let face = &self.part.faces[index];
        if let Some(reason) = unusable(face) {
            return Outcome::Failed(reason);
        }
        let Some(surface) = self.surfaces[index].as_ref() else {
            return Outcome::Failed("its surface is missing".into());
        };
        if self.cancel.is_cancelled() {
            return Outcome::Failed("cancelled".into());
        }
        let attempt = |last_resort: bool, accept: bool| {
            let context = FaceContext {
                part: self.part,
                face,
                surface,
                edges,
                doubled,
                last_resort,
                accept,
                closer: round < CLOSER_ROUNDS,
                resolution: self.resolution,
            };
            let options = match &self.left {
                Some((default, faces)) if faces[index] => default,
                _ => self.options,
            };
            // The one place where a panic of ours becomes a face's failure.
            catch_unwind(AssertUnwindSafe(|| mesh_face(&context, &self.limits, options, self.cancel)))
                .unwrap_or_else(|_| Outcome::Failed("internal error".into()))
        };
        match attempt(round >= LAST_RESORT, round == MAX_ROUNDS) {
            Outcome::Finer(mut chords) => {
                chords.retain(|&(edge, chord)| self.can_be_finer(&edges[edge as usize], chord as usize));
                // Chords as short as points do not help: better what there is now than the same after more rounds.
                if chords.is_empty() { attempt(true, true) } else { Outcome::Finer(chords) }
            }
            outcome => outcome,
        }
    }

    /// False for a chord, and a curve over it, within one point.
    fn can_be_finer(&self, samples: &EdgeSamples, chord: usize) -> bool {
        let length = samples.points[chord].distance(samples.points[chord + 1]);
        length > self.resolution || samples.sag[chord] > self.resolution
    }

    /// Meshes all faces; those that ask for finer edges, and their neighbours, again.
    fn rounds(
        &self,
        edges: &mut [EdgeSamples],
        report: &mut PartReport,
        done: &(dyn Fn(usize) + Sync),
    ) -> Vec<Result<Box<FaceResult>, String>> {
        let n = self.part.faces.len();
        let mut results: Vec<Result<Box<FaceResult>, String>> = vec![Err(String::new()); n];
        let mut dirty: Vec<usize> = (0..n).collect();
        let finished = AtomicUsize::new(0);
        for round in 0.. {
            let outcomes: Vec<Outcome> = dirty
                .par_iter()
                .map(|&f| {
                    let outcome = self.mesh_one(f, edges, round, &[]);
                    if round == 0 {
                        done(finished.fetch_add(1, Ordering::Relaxed) + 1);
                    }
                    outcome
                })
                .collect();
            let mut requests = Vec::new();
            for (&f, outcome) in dirty.iter().zip(outcomes) {
                results[f] = match outcome {
                    Outcome::Done(result) => Ok(result),
                    Outcome::Failed(reason) => Err(reason),
                    Outcome::Finer(chords) => {
                        requests.extend(chords);
                        Err(format!("its edges were still too coarse after {MAX_ROUNDS} rounds"))
                    }
                };
            }
            if requests.is_empty() || round == MAX_ROUNDS || self.cancel.is_cancelled() {
                break;
            }
            report.rounds = round + 1;
            requests.sort_unstable();
            requests.dedup();
            dirty.clear();
            for group in requests.chunk_by(|a, b| a.0 == b.0) {
                let index = group[0].0 as usize;
                let chords: Vec<u32> = group.iter().map(|r| r.1).collect();
                let parts = if round < HALVING_ROUNDS { 2 } else { 4 };
                edges[index].split(&self.part.edges[index], &chords, parts);
                dirty.extend(self.info[index].uses.iter().map(|u| u.0));
            }
            dirty.sort_unstable();
            dirty.dedup();
        }
        self.separate(edges, &mut results);
        results
    }

    /// Faces that have no triangles, or no proof where one was asked for.
    fn undone(&self, outcomes: &[Result<Box<FaceResult>, String>]) -> Vec<bool> {
        let is_undone = |outcome: &Result<Box<FaceResult>, String>| match outcome {
            Err(_) => true,
            Ok(result) => self.is_undone(result),
        };
        let faces = self.part.faces.iter().zip(outcomes);
        faces.map(|(face, outcome)| unusable(face).is_none() && is_undone(outcome)).collect()
    }

    /// No proof where one was asked for.
    fn is_undone(&self, result: &FaceResult) -> bool {
        let allowed = self.limits.tolerance.max(self.limits.boundary);
        // Of NaN nothing is proven either.
        self.options.bound == Bound::Proven && !(result.proven_error <= allowed)
    }

    /// Meshes the part once more where other methods left faces undone, those and their edges by the default methods from the
    /// first round on: where a file is loose, loops cross the sooner the finer they are, and a strategy may have asked
    /// for chords that the default can do without.
    fn leave_to_default(
        &mut self,
        edges: &mut Vec<EdgeSamples>,
        outcomes: &mut Vec<Result<Box<FaceResult>, String>>,
        report: &mut PartReport,
    ) {
        let default =
            Options { strategy: Strategy::Default, edge_method: EdgeMethod::Default, ..self.options.clone() };
        let count = |faces: &[bool]| faces.iter().filter(|&&f| f).count();
        let mut left = vec![false; outcomes.len()];
        for pass in 0..LEAVINGS {
            let undone = self.undone(outcomes);
            if default == *self.options || count(&undone) == 0 || self.cancel.is_cancelled() {
                return;
            }
            left.iter_mut().zip(&undone).for_each(|(left, undone)| *left |= undone);
            if pass > 0 {
                left = self.with_neighbours(&left);
            }
            self.left = Some((default.clone(), left.clone()));
            let before = report.rounds;
            let mut again = self.sample_edges();
            let mut found = self.rounds(&mut again, report, &|_| ());
            if count(&self.undone(&found)) >= count(&undone) {
                report.rounds = before;
                return;
            }
            let made = found.iter_mut().zip(&left).filter(|(_, left)| **left);
            for result in made.filter_map(|(outcome, _)| outcome.as_mut().ok()) {
                result.trace.add("faces left to the default methods", 1);
            }
            (*edges, *outcomes) = (again, found);
        }
    }

    /// These faces and all that share an edge with them.
    fn with_neighbours(&self, faces: &[bool]) -> Vec<bool> {
        let mut all = faces.to_vec();
        for info in self.info.iter().filter(|info| info.uses.iter().any(|&(f, _)| faces[f])) {
            info.uses.iter().for_each(|&(f, _)| all[f] = true);
        }
        all
    }

    /// Meshes faces again that have an inner edge which another face has too.
    fn separate(&self, edges: &[EdgeSamples], results: &mut [Result<Box<FaceResult>, String>]) {
        let uses = |edge: u32| self.info[edge as usize].uses.iter().map(|u| u.0);
        let is_flat = |face: u32| {
            let surface = self.surfaces[face as usize].as_ref();
            surface.is_some_and(|s| matches!(s.surface, Surface::Plane { .. }))
        };
        let hopeless = self.undone(results);
        let mut given_up: Vec<(u32, SharedEdge)> = Vec::new();
        for _ in 0..SEPARATING_ROUNDS {
            let single = |i: &usize| edges[*i].sag.len() == 1;
            let ends = |i: usize| {
                [self.part.edges[i].start, self.part.edges[i].end].map(|v| Key::Vertex(v.index() as u32))
            };
            let chords = (0..edges.len()).filter(single).map(|i| sorted(ends(i)));
            let mut more = doubled_edges(results, chords, uses, is_flat);
            // A face of which nothing is proven has worse faults, and takes long.
            more.retain(|&(face, _)| !hopeless[face as usize]);
            if more.is_empty() || self.cancel.is_cancelled() {
                return;
            }
            let mut again: Vec<u32> = more.iter().map(|m| m.0).collect();
            again.dedup();
            given_up.extend(more);
            given_up.sort_unstable();
            let outcomes: Vec<(u32, Outcome)> = again
                .into_par_iter()
                .map(|f| {
                    let of_face = given_up.iter().filter(|g| g.0 == f).map(|g| g.1);
                    (f, self.mesh_one(f as usize, edges, 0, &of_face.collect::<Vec<_>>()))
                })
                .collect();
            for (f, outcome) in outcomes {
                // What was proven stays proven.
                if let Outcome::Done(new) = outcome
                    && !self.is_undone(&new)
                {
                    results[f as usize] = Ok(new);
                }
            }
        }
    }

    fn describe(
        &self,
        edges: &[EdgeSamples],
        outcomes: &[Result<Box<FaceResult>, String>],
        report: &mut PartReport,
    ) {
        let closed: Vec<bool> = self.part.edges.iter().map(|e| e.start == e.end).collect();
        let pcurve_gaps: Vec<f64> = (self.part.faces.par_iter().zip(&self.surfaces))
            .map(|(face, surface)| {
                surface.as_ref().map_or(0.0, |surface| pcurve_gap(self.part, face, surface, edges))
            })
            .collect();
        for (index, outcome) in outcomes.iter().enumerate() {
            let mut entry = FaceReport {
                face: index as u32,
                bound: "none",
                proven_error: f64::NAN,
                ..FaceReport::default()
            };
            match outcome {
                Ok(result) => {
                    entry.triangles = result.triangles.len();
                    entry.proven_error = result.proven_error;
                    entry.boundary_error = result.boundary_error;
                    entry.gap = result.gap;
                    entry.pcurve_gap = pcurve_gaps[index];
                    entry.bound = result.bound;
                    entry.phases = result.phases;
                    entry.trace = result.trace.clone();
                    entry.cells.clone_from(&result.cells);
                    entry.zero_area = result.triangles.is_empty();
                    entry.lower_bound =
                        lower_bound(&self.part.faces[index], edges, &closed, result.curvature_bound);
                }
                Err(reason) => entry.failed = Some(reason.clone()),
            }
            report.faces.push(entry);
        }
    }
}
