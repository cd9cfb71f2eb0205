//! Proof: every triangle gets a bound; one over budget is flipped, gets a point inside, or asks its edge to be finer.

mod chords;
mod flip;
mod sampled;

use self::chords::{CHORD_BENDS, CLOSER_LOOKS, bend, close_to_boundary};
use self::sampled::sampled_bound;
use crate::chart::{Key, Segment};
use crate::doubled::sorted;
use crate::face::FaceWork;
use crate::metric::{Limits, Metric};
use crate::options::{Bound, Cancel, Options};
use crate::strategy::Strategy;
use crate::triangulate::{Location, NONE, orient};
use chordal_nurbs::{DVec2, DVec3, Facet, FacetBound, Piece, Surface, SurfaceBounds, facet_bound};
use std::collections::VecDeque;
use std::time::Instant;

/// The result of refining a face.
pub(crate) enum Verdict {
    Proven {
        error: f64,
        bound: &'static str,
    },
    Finer(Vec<(u32, u32)>),
    /// A seam, which only this face knows, is too coarse.
    FinerSeam,
    /// A triangle can be mended by nothing.
    Stuck,
}

pub(crate) struct Prover<'a> {
    bounds: &'a SurfaceBounds<'a>,
    limits: &'a Limits,
    options: &'a Options,
    deadline: Option<Instant>,
    cancel: &'a Cancel,
    scratch: Vec<Piece>,
    /// Nothing can be bounded on this surface: samples must do.
    sampled: bool,
    /// The last round: what cannot be mended is accepted and reported with its error.
    accept: bool,
    /// Chords with bounds far beyond the tolerance are looked at in parts: the default's own way. The other methods set their points
    /// before the proof speaks, and what they are is what they would be without it.
    pub closer_looks: u32,
    /// Whatever is mended, the face will not be proven: little effort will do.
    pub hopeless: bool,
    /// Facets may double back where the face goes on beyond them.
    pub folds: bool,
}

/// Steps per triangle that a face begins with, and some more, after which it is stuck.
const BUDGET: (usize, usize) = (16, 4_000);

/// The same for faces that will not be proven.
const HOPELESS_BUDGET: (usize, usize) = (4, 100);

/// A flip is worth trying for facets whose error is at most this many tolerances.
const FLIP_HELPS: f64 = 3.0;

/// Edges shorter than this share of the tolerance may turn by any angle: at singular points, where the surface turns within no
/// distance at all, there would be no end to refining.
pub(crate) const TURN_LENGTH: f64 = 0.1;

/// A crease that cuts off less than this share of a facet's width passes its corner: a point on it would all but fall on that corner.
const CREASE_BESIDE: f64 = 0.01;

/// Facets lower than this share of the tolerance may face any way.
const FOLD_HEIGHT: f64 = 0.05;

/// Flips of triangles without area are followed by refining, and that by flips, this often.
const SLIVER_PASSES: u32 = 3;

/// What is wrong with a triangle.
pub(crate) enum Fault {
    None,
    /// The edge opposite this corner is too long for this face, whatever is done inside.
    Edge(usize),
    /// Too far from the surface, or turning too much across the edge opposite the corner.
    Inside(Option<usize>),
    /// Turned over where it meets the boundary; its longest inner edge lies opposite the corner.
    Fold(Option<usize>),
}

impl<'a> Prover<'a> {
    pub fn new(
        bounds: &'a SurfaceBounds<'a>,
        limits: &'a Limits,
        options: &'a Options,
        deadline: Option<Instant>,
        cancel: &'a Cancel,
        accept: bool,
    ) -> Self {
        let sampled = options.bound == Bound::Estimated || !bounds.is_bounded();
        Self {
            bounds,
            limits,
            options,
            deadline,
            cancel,
            scratch: Vec::new(),
            sampled,
            accept,
            closer_looks: if options.strategy == Strategy::Default { CLOSER_LOOKS } else { 0 },
            hopeless: false,
            folds: false,
        }
    }

    /// Refines until every triangle is within the limits.
    ///
    /// # Errors
    /// A sentence, where the face is given up.
    pub fn refine(&mut self, work: &mut FaceWork<'_, '_>) -> Result<Verdict, String> {
        if matches!(self.bounds.surface(), Surface::Plane { .. })
            && self.limits.length.is_infinite()
            && work.context.doubled.is_empty()
        {
            return Ok(Verdict::Proven { error: 0.0, bound: "plane" });
        }
        let mut requests = Vec::new();
        let mut errors: Vec<f64> = vec![f64::NAN; work.mesh.triangles.len()];
        let mut queue: VecDeque<u32> = (0..work.mesh.triangles.len() as u32).collect();
        let (per_triangle, more) = if self.hopeless { HOPELESS_BUDGET } else { BUDGET };
        let budget = per_triangle * work.mesh.triangles.len() + more;
        let mut steps = 0usize;
        let mut sliver_passes = 0..SLIVER_PASSES;
        loop {
            let Some(t) = queue.pop_front() else {
                if requests.is_empty() && sliver_passes.next().is_some() {
                    self.flip_slivers(work);
                    take_changed(work, &mut errors, &mut queue);
                }
                if queue.is_empty() {
                    break;
                }
                continue;
            };
            if !errors[t as usize].is_nan() {
                continue;
            }
            steps += 1;
            if steps.is_multiple_of(256) {
                self.check_budget(work)?;
            }
            let (error, fault) = self.judge(work, t);
            errors[t as usize] = error;
            match fault {
                Fault::None => continue,
                Fault::Edge(_) if self.accept => continue,
                Fault::Edge(i) => match self.boundary_segment(work, t, i) {
                    Some(Segment::Edge { edge, chord }) => requests.push((edge, chord)),
                    _ => return Ok(Verdict::FinerSeam),
                },
                Fault::Inside(edge) | Fault::Fold(edge) => {
                    if !requests.is_empty() {
                        // The face runs again with finer edges: no need to fill it now.
                        continue;
                    }
                    let overdone = steps > budget;
                    if overdone && !self.accept {
                        return Ok(Verdict::Stuck);
                    }
                    if overdone {
                        continue;
                    }
                    if work.mesh.triangles.len() > self.options.face_triangles {
                        return Err(format!("it needs more than {} triangles", work.mesh.triangles.len()));
                    }
                    let flipped = matches!(fault, Fault::Fold(_)) && self.flip_helps(work, t);
                    if !flipped && !self.mend(work, t, error, edge) {
                        match self.coarse_boundary(work, t) {
                            Some(_) if self.accept => continue,
                            Some(chord) => requests.push(chord),
                            None if self.accept => continue,
                            None => return Ok(Verdict::Stuck),
                        }
                    }
                }
            }
            take_changed(work, &mut errors, &mut queue);
        }
        if !requests.is_empty() {
            requests.sort_unstable();
            requests.dedup();
            return Ok(Verdict::Finer(requests));
        }
        let error = errors.iter().fold(0.0f64, |m, &e| m.max(e));
        Ok(self.proven(error))
    }

    /// The verdict over triangles of which none is further off than `error`.
    pub fn proven(&self, error: f64) -> Verdict {
        let bound = match self.bounds.surface() {
            _ if self.sampled => "sampled",
            _ if error.is_infinite() => "none",
            Surface::Cylinder { .. } => "cylinder",
            Surface::Cone { .. } => "cone",
            Surface::Sphere { .. } => "sphere",
            _ => "second derivatives",
        };
        Verdict::Proven { error: if self.sampled { f64::NAN } else { error }, bound }
    }

    pub fn check_budget(&self, work: &FaceWork<'_, '_>) -> Result<(), String> {
        self.check_time(work.mesh.triangles.len())
    }

    /// # Errors
    /// A sentence, where the job was cancelled or the face's time is over.
    pub fn check_time(&self, triangles: usize) -> Result<(), String> {
        if self.cancel.is_cancelled() {
            return Err("cancelled".into());
        }
        if self.deadline.is_some_and(|d| Instant::now() > d) {
            return Err(format!("out of time at {triangles} triangles"));
        }
        Ok(())
    }

    /// True where what cannot be mended is taken as it is.
    pub fn accepts(&self) -> bool {
        self.accept
    }

    fn facet(work: &FaceWork<'_, '_>, t: u32) -> Facet {
        let corners = work.mesh.triangles[t as usize];
        Facet {
            uv: corners.map(|v| work.mesh.points[v as usize]),
            xyz: corners.map(|v| work.xyz[v as usize]),
            sag: std::array::from_fn(|i| Self::sag(work, t, i)),
        }
    }

    /// The sagitta of the edge opposite corner `i`, where it is a chord of a model edge.
    fn sag(work: &FaceWork<'_, '_>, t: u32, i: usize) -> Option<f64> {
        if work.mesh.neighbors[t as usize][i] != NONE {
            return None;
        }
        let corners = work.mesh.triangles[t as usize];
        match work.segment(corners[(i + 1) % 3], corners[(i + 2) % 3]) {
            Some(Segment::Edge { edge, chord }) => {
                Some(work.context.edges[edge as usize].sag[chord as usize])
            }
            _ => None,
        }
    }

    fn bound(&mut self, work: &FaceWork<'_, '_>, facet: &Facet, allowed: f64) -> FacetBound {
        if self.sampled {
            sampled_bound(work, facet)
        } else {
            facet_bound(self.bounds, facet, allowed, &mut self.scratch)
        }
    }

    /// How far off a facet may be: beside an edge as far as that, where it may be farther.
    ///
    /// Not over its chords only: a facet that reaches from one end of a long chord to its middle is long itself.
    fn allowed(&self, work: &FaceWork<'_, '_>, corners: [u32; 3]) -> f64 {
        let on_edge = |v: u32| !matches!(work.key(v), Key::Private(_));
        let boundary = self.limits.boundary;
        if boundary > self.limits.tolerance && corners.into_iter().any(on_edge) {
            boundary
        } else {
            self.limits.tolerance
        }
    }

    /// A triangle whose corners are not three vertices is not written.
    fn collapsed(work: &FaceWork<'_, '_>, t: u32) -> bool {
        let [a, b, c] = work.mesh.triangles[t as usize].map(|v| work.key(v));
        a == b || b == c || c == a
    }

    /// An inner edge that another face has too.
    fn doubled_side(work: &FaceWork<'_, '_>, t: u32) -> Option<usize> {
        if work.context.doubled.is_empty() {
            return None;
        }
        let keys = work.mesh.triangles[t as usize].map(|v| work.key(v));
        let inner = |&i: &usize| {
            let across = work.mesh.neighbors[t as usize][i];
            across != NONE && !Self::collapsed(work, across)
        };
        (0..3)
            .filter(inner)
            .find(|&i| work.context.doubled.contains(&sorted([keys[(i + 1) % 3], keys[(i + 2) % 3]])))
    }

    pub fn judge(&mut self, work: &FaceWork<'_, '_>, t: u32) -> (f64, Fault) {
        if Self::collapsed(work, t) {
            return (0.0, Fault::None);
        }
        let facet = Self::facet(work, t);
        let [a, b, c] = facet.uv;
        if self.accept && orient(a, b, c) < 0.0 {
            return (f64::INFINITY, Fault::None);
        }
        if let Some(i) = Self::doubled_side(work, t) {
            return (f64::INFINITY, Fault::Inside(Some(i)));
        }
        let tolerance = self.allowed(work, work.mesh.triangles[t as usize]);
        let bound = self.bound(work, &facet, tolerance);
        let boundary = work.mesh.neighbors[t as usize].map(|n| n == NONE);
        if bound.error > tolerance {
            let coarse = (0..3).filter(|&i| boundary[i] && bound.edges[i] > tolerance);
            let worst = coarse.max_by(|&a, &b| bound.edges[a].total_cmp(&bound.edges[b]));
            let worst = worst.filter(|&i| self.is_coarse_chord(&facet, i, tolerance));
            let worst = worst.or_else(|| close_to_boundary(work, &facet, boundary, FOLD_HEIGHT * tolerance));
            return (bound.error, worst.map_or(Fault::Inside(None), Fault::Edge));
        }
        let corners = work.mesh.triangles[t as usize];
        // Folds inside the face only cover it more than once; where they meet its boundary they may reach beyond it.
        let ends = |&v: &u32| match work.key(v) {
            Key::Private(_) => !self.folds && (v as usize) < work.chart.points.len(),
            _ => true,
        };
        if corners.iter().any(ends)
            && let Some(height) = self.folded_height(facet.xyz, corners.map(|v| work.normals[v as usize]))
        {
            // A chord that leaves the face by about as much as the facet is high must be finer; else an inner edge leaves it.
            let leaves = |i: usize| facet.sag[i].or_else(|| boundary[i].then(|| bend(work, &facet, i)));
            let coarse = (0..3).find(|&i| leaves(i).is_some_and(|bend| bend > CHORD_BENDS * height));
            let inner = || Fault::Fold(longest_inner(work, t, &facet));
            return (f64::INFINITY, coarse.map_or_else(inner, Fault::Edge));
        }
        let normals = work.turning_normals(corners);
        // Chords first: a point inside does not help them, and the face runs again with finer ones anyhow.
        for i in (0..3).filter(|&i| boundary[i]).chain((0..3).filter(|&i| !boundary[i])) {
            let [n, m] = [normals[(i + 1) % 3], normals[(i + 2) % 3]];
            let length =
                work.xyz[corners[(i + 1) % 3] as usize].distance(work.xyz[corners[(i + 2) % 3] as usize]);
            let turns = length > TURN_LENGTH * tolerance && turns_too_far(n, m, self.limits.angle);
            if turns || length > self.limits.length * (1.0 + 1e-9) {
                let fault = if boundary[i] { Fault::Edge(i) } else { Fault::Inside(Some(i)) };
                return (bound.error, fault);
            }
        }
        (bound.error, Fault::None)
    }

    /// The height of a facet that faces away from the surface at its corners: it lies outside the face, doubled back.
    fn folded_height(&self, xyz: [DVec3; 3], normals: [DVec3; 3]) -> Option<f64> {
        let [a, b, c] = xyz;
        let cross = (b - a).cross(c - a);
        let longest =
            (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared()).sqrt();
        // Facets lower than this can do no harm whichever way they face.
        let height = cross.length() / longest.max(f64::MIN_POSITIVE);
        let [n, m, k] = normals;
        // Where the normals themselves disagree, one facet cannot tell.
        let agree = n.dot(m).min(m.dot(k)).min(k.dot(n)) > 0.3;
        (agree && height > FOLD_HEIGHT * self.limits.tolerance && (n + m + k).dot(cross) < 0.0)
            .then_some(height)
    }

    /// True where an edge of this triangle turns too far.
    fn turns(&self, work: &FaceWork<'_, '_>, corners: [u32; 3]) -> bool {
        let [n, m, k] = work.turning_normals(corners);
        [(n, m), (m, k), (k, n)].iter().any(|&(n, m)| turns_too_far(n, m, self.limits.angle))
    }

    pub fn boundary_segment(&self, work: &FaceWork<'_, '_>, t: u32, i: usize) -> Option<Segment> {
        let corners = work.mesh.triangles[t as usize];
        work.segment(corners[(i + 1) % 3], corners[(i + 2) % 3])
    }

    /// Flips an edge or inserts a point; false where neither is possible.
    fn mend(&mut self, work: &mut FaceWork<'_, '_>, t: u32, error: f64, edge: Option<usize>) -> bool {
        if edge.is_none() && error < FLIP_HELPS * self.limits.tolerance && self.flip_helps(work, t) {
            return true;
        }
        let corners = work.mesh.corners(t);
        let m = Metric::mean(work.mesh.triangles[t as usize].map(|v| work.metrics[v as usize]));
        let longest = edge.or_else(|| {
            let length = |i: usize| m.length(corners[(i + 2) % 3] - corners[(i + 1) % 3]);
            clearly_longest(0..3, length)
        });
        let center = (corners[0] + corners[1] + corners[2]) / 3.0;
        let on_crease = self.crease_point(corners);
        let at_middle = longest.filter(|&i| work.mesh.neighbors[t as usize][i] != NONE);
        let middle = at_middle.map(|i| corners[(i + 1) % 3].midpoint(corners[(i + 2) % 3]));
        let snapped = |p: DVec2| work.chart.grid.snap(p);
        let middle = middle.map(snapped).zip(at_middle);
        let places =
            [on_crease.map(|p| (p, None)), middle.map(|(p, i)| (p, Some(i))), Some((snapped(center), None))];
        for (p, edge) in places.into_iter().flatten() {
            let at = match edge {
                Some(i) => work.mesh.locate_on(t, i, p),
                None => work.mesh.locate(p, t),
            };
            if !matches!(at, Location::Inside(_) | Location::OnEdge(..)) {
                continue;
            }
            if work.insert(p, at).is_some() {
                return true;
            }
        }
        false
    }

    /// A place inside the triangle on a line at which the surface has a crease.
    fn crease_point(&self, corners: [DVec2; 3]) -> Option<DVec2> {
        let (us, vs) = self.bounds.creases();
        for (axis, values) in [(0, us), (1, vs)] {
            for value in values {
                let side = corners.map(|c| c[axis] - value);
                let size = side.iter().fold(0.0f64, |m, s| m.max(s.abs()));
                let beside = CREASE_BESIDE * size;
                if side.iter().any(|&s| s > beside) && side.iter().any(|&s| s < -beside) {
                    let cuts: Vec<DVec2> = (0..3)
                        .filter(|&i| side[i] * side[(i + 1) % 3] < 0.0)
                        .map(|i| {
                            corners[i].lerp(corners[(i + 1) % 3], side[i] / (side[i] - side[(i + 1) % 3]))
                        })
                        .collect();
                    let mut p = cuts.iter().copied().sum::<DVec2>() / cuts.len().max(1) as f64;
                    p[axis] = value;
                    return (!cuts.is_empty()).then_some(p);
                }
            }
        }
        None
    }

    /// A boundary chord of a triangle that nothing else can mend.
    fn coarse_boundary(&self, work: &FaceWork<'_, '_>, t: u32) -> Option<(u32, u32)> {
        (0..3).find_map(|i| match self.boundary_segment(work, t, i) {
            Some(Segment::Edge { edge, chord }) if work.mesh.neighbors[t as usize][i] == NONE => {
                Some((edge, chord))
            }
            _ => None,
        })
    }
}

/// Triangles that changed are to be judged anew.
fn take_changed(work: &mut FaceWork<'_, '_>, errors: &mut Vec<f64>, queue: &mut VecDeque<u32>) {
    errors.resize(work.mesh.triangles.len(), f64::NAN);
    for t in work.mesh.changed.drain(..) {
        errors[t as usize] = f64::NAN;
        queue.push_back(t);
    }
}

/// The longest edge in space that is no boundary, by the corner opposite to it.
fn longest_inner(work: &FaceWork<'_, '_>, t: u32, facet: &Facet) -> Option<usize> {
    let inner = (0..3).filter(|&i| work.mesh.neighbors[t as usize][i] != NONE);
    let length = |i: usize| facet.xyz[(i + 1) % 3].distance_squared(facet.xyz[(i + 2) % 3]);
    clearly_longest(inner, length)
}

/// The longest; of those that only rounding tells apart the first, so that the same part elsewhere gets the same mesh.
fn clearly_longest(of: impl Iterator<Item = usize>, length: impl Fn(usize) -> f64) -> Option<usize> {
    of.reduce(|best, i| if length(i) > length(best) * (1.0 + 1e-9) { i } else { best })
}

pub(crate) fn turns_too_far(n: DVec3, m: DVec3, limit: f64) -> bool {
    limit < std::f64::consts::PI
        && n != DVec3::ZERO
        && m != DVec3::ZERO
        && n.dot(m) < (limit * (1.0 + 1e-9)).cos() - 1e-12
}
