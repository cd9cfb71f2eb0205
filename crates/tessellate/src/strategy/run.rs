//! One face by a strategy: its parts, the common proof, and refinement by the strategy's own means where the proof fails.

use super::Strategy;
use super::bezier::BezierQuads;
use super::cells::{Cells, Rule};
use super::chords::judge_chords;
use super::coving::Coving;
use super::cut::cut;
use super::delaunay::Delaunay;
use super::grid::{ControlCells, UniformGrid};
use super::kd::{Binary, Kd};
use super::node::Measure;
use super::poles::{open_out, refine_opened};
use super::polygons::{Filling, retriangulate};
use super::quadtree::{Quadtree, SURFACE_SHARE};
use super::recursive::Recursive;
use super::region::Region;
use crate::chart::Segment;
use crate::clock::Stopwatch;
use crate::edge_method::EdgeMethod;
use crate::face::FaceWork;
use crate::options::{Bound, Options};
use crate::prove::{Fault, Prover, Verdict};
use crate::triangulate::Triangulation;
use chordal_nurbs::{DVec2, UvBox};

/// So often a strategy may refine what the proof found too coarse; what is left then is mended as the default does.
const ROUNDS: usize = 24;

/// Most cells of one face.
const MOST_CELLS: usize = 4_000_000;

/// A way to fill the inside of a face.
pub(crate) trait Method {
    /// Makes the triangles of the face; `work.mesh` holds the triangulated loops and nothing else.
    ///
    /// # Errors
    /// A sentence, where the face is given up.
    fn build(
        &mut self,
        work: &mut FaceWork<'_, '_>,
        check: &dyn Fn(usize) -> Result<(), String>,
    ) -> Result<(), String>;

    /// Makes the places finer that the proof found too coarse; false where nothing can be done.
    fn refine(&mut self, coarse: &[DVec2]) -> bool;

    /// Chords (edge, index) that the method itself finds too coarse.
    fn coarse_chords(&self, _work: &mut FaceWork<'_, '_>) -> Vec<(u32, u32)> {
        Vec::new()
    }

    /// The cells, to be drawn.
    fn drawing(&self) -> Vec<UvBox>;
}

/// Asked now and then with the number of things made so far; an error ends the work on the face.
pub(crate) type Check<'c> = &'c dyn Fn(usize) -> Result<(), String>;

/// Cells cut with the loops.
struct ByCells {
    region: Region,
    cells: Cells,
    rule: Box<dyn Rule>,
    filling: Filling,
    tolerance: f64,
    measure: Measure,
    /// The rule may find chords of the edges too coarse.
    judges_chords: bool,
    /// How often all cells were halved at once.
    halvings: usize,
}

/// The transitions of the state machine that follows trimming curves over leaves, by their numbers.
const TRANSITIONS: [&str; 4] = [
    "curves reach a border (1)",
    "curves leave a vertex over a leaf (2)",
    "curves end inside a leaf (3)",
    "curves run along a border (4)",
];

/// Uniform subdivisions are halved at most this often: each time costs four times the triangles, and what is still too
/// coarse then lies where loops cut cells, which smaller cells do not mend.
const HALVINGS: usize = 1;

impl Method for ByCells {
    fn build(&mut self, work: &mut FaceWork<'_, '_>, check: Check<'_>) -> Result<(), String> {
        let clock = Stopwatch::of_thread();
        self.cells.refine(&*self.rule, &self.region, self.tolerance, self.measure, check)?;
        work.phases.subdivision += clock.seconds();
        let clock = Stopwatch::of_thread();
        let met = self.drawing();
        let found = cut(work, &self.region, &met);
        retriangulate(&mut work.mesh, &found.fixed, self.filling, &mut work.trace);
        let opened = open_out(work);
        work.phases.triangulation += clock.seconds();
        work.trace.add(self.rule.name(), met.len());
        work.trace.add("corners of cells", found.corners);
        work.trace.add("borders cut by loops", found.crossings);
        work.trace.add("borders given up", found.dropped);
        work.trace.add("flips at poles", opened);
        Ok(())
    }

    fn refine(&mut self, coarse: &[DVec2]) -> bool {
        if self.rule.is_uniform() {
            self.halvings += 1;
            if self.halvings > HALVINGS {
                return false;
            }
        }
        self.cells.cut_at(coarse, &*self.rule, &self.region, self.measure)
    }

    fn coarse_chords(&self, work: &mut FaceWork<'_, '_>) -> Vec<(u32, u32)> {
        if !self.judges_chords {
            return Vec::new();
        }
        let clock = Stopwatch::of_thread();
        let judged = judge_chords(work, &self.cells, &*self.rule);
        work.phases.traversal += clock.seconds();
        for (name, count) in TRANSITIONS.iter().zip(judged.transitions) {
            work.trace.add(name, count);
        }
        work.trace.add("edges of leaves along curves", judged.directed);
        work.trace.add("curves judged by samples", judged.lost);
        judged.coarse
    }

    fn drawing(&self) -> Vec<UvBox> {
        self.cells.leaves.iter().filter(|l| l.met).map(|l| l.bounds).collect()
    }
}

fn method(work: &FaceWork<'_, '_>, options: &Options) -> Result<Box<dyn Method>, String> {
    let strategy = options.strategy;
    // Curves that are approximated in space are not judged in the plane, and leave the surface all of the tolerance.
    let judges_chords = !matches!(options.edge_method, EdgeMethod::Bezier3d { .. });
    let share = if judges_chords { SURFACE_SHARE } else { 1.0 };
    let measure = if options.bound == Bound::Proven { Measure::Conservative } else { Measure::Estimated };
    let (rule, filling): (Box<dyn Rule>, Filling) = match strategy {
        Strategy::Kd(cut) => (Box::new(Kd(cut)), Filling::FanOrMonotone),
        Strategy::Binary(cut) => (Box::new(Binary(cut)), Filling::FanOrMonotone),
        Strategy::UniformGrid => (Box::new(UniformGrid::COARSEST), Filling::FanOrMonotone),
        Strategy::ControlCells { per_cell } => (Box::new(ControlCells { per_cell }), Filling::FanOrMonotone),
        Strategy::Recursive => (Box::new(Recursive), Filling::FanOrMonotone),
        Strategy::Quadtree(stretch) => (Box::new(Quadtree { stretch, share }), Filling::Delaunay),
        Strategy::Coving => return Ok(Box::new(Coving::new(work, measure)?)),
        Strategy::Bezier => return Ok(Box::new(BezierQuads::new(work, measure)?)),
        Strategy::Delaunay(fill) => return Ok(Box::new(Delaunay::new(work, fill))),
        Strategy::Default => return Err("the default strategy has no method of its own".into()),
    };
    let region = Region::new(&work.chart);
    let tolerance = work.limits.tolerance;
    let mut cells = Cells::new(work.context.surface, region.uv_box, tolerance)?;
    cells.begin(&*rule, &region, tolerance);
    Ok(Box::new(ByCells { region, cells, rule, filling, tolerance, measure, judges_chords, halvings: 0 }))
}

/// Fills a face whose loops are triangulated.
///
/// # Errors
/// A sentence, where the face is given up.
pub(crate) fn fill(
    work: &mut FaceWork<'_, '_>,
    prover: &mut Prover<'_>,
    options: &Options,
) -> Result<Verdict, String> {
    let clock = Stopwatch::of_thread();
    let mut method = method(work, options)?;
    work.phases.conversion += clock.seconds();
    let verdict = refine(work, prover, &mut *method, options.bound);
    if options.record_cells {
        work.cells = method.drawing();
    }
    verdict
}

fn refine(
    work: &mut FaceWork<'_, '_>,
    prover: &mut Prover<'_>,
    method: &mut dyn Method,
    bound: Bound,
) -> Result<Verdict, String> {
    let boundary = work.mesh.clone();
    let metrics = work.metrics.clone();
    let mut at_boundary = usize::MAX;
    for round in 0..ROUNDS {
        restore(work, &boundary);
        work.trace = super::trace::Trace::default();
        let check = |cells: usize| {
            if cells > MOST_CELLS {
                Err(format!("it needs more than {MOST_CELLS} cells"))
            } else {
                prover.check_time(cells)
            }
        };
        method.build(work, &check)?;
        let finer = if work.context.last_resort { Vec::new() } else { method.coarse_chords(work) };
        if !finer.is_empty() {
            return Ok(Verdict::Finer(finer));
        }
        work.trace.add("rounds of refinement after the proof", round);
        if bound == Bound::Estimated {
            return Ok(prover.proven(f64::NAN));
        }
        let judged = judge(work, prover)?;
        if let Some(verdict) = judged.request {
            return Ok(verdict);
        }
        if judged.coarse.is_empty() && judged.error <= work.limits.tolerance.max(work.limits.boundary) {
            return Ok(prover.proven(judged.error));
        }
        // Nothing left to cut, and chords too coarse that nobody may cut any more.
        if judged.coarse.is_empty() {
            break;
        }
        // Inside, smaller cells always help in the end. Where a long chord meets small cells they need not.
        if !judged.is_inside && judged.coarse.len() >= at_boundary || !method.refine(&judged.coarse) {
            break;
        }
        at_boundary = if judged.is_inside { usize::MAX } else { judged.coarse.len() };
    }
    let before = work.mesh.triangles.len();
    let verdict = refine_opened(work, prover)?;
    work.trace
        .add("triangles added by the default's means", work.mesh.triangles.len().saturating_sub(before));
    let kept = match verdict {
        Verdict::Stuck => false,
        Verdict::Proven { error, .. } => error <= work.limits.tolerance.max(work.limits.boundary),
        _ => true,
    };
    if kept || prover.hopeless {
        return Ok(verdict);
    }
    // Better a face by the default's own points than one that nothing is proven about.
    restore(work, &boundary);
    work.metrics = metrics;
    work.quads.clear();
    work.trace.add("faces left to the default strategy", 1);
    work.fill_by_rows();
    refine_opened(work, prover)
}

/// Takes everything out of the face but its loops.
pub(super) fn restore(work: &mut FaceWork<'_, '_>, boundary: &Triangulation) {
    let n = boundary.points.len();
    work.mesh = boundary.clone();
    work.metrics.truncate(n);
    work.xyz.truncate(n);
    work.normals.truncate(n);
    work.at_pole.truncate(n);
}

/// What the proof says about triangles as they are.
struct Judged {
    error: f64,
    /// The middles of triangles that must become smaller.
    coarse: Vec<DVec2>,
    /// One of them has no corner on the boundary.
    is_inside: bool,
    /// Edges or seams must become finer first.
    request: Option<Verdict>,
}

fn judge(work: &FaceWork<'_, '_>, prover: &mut Prover<'_>) -> Result<Judged, String> {
    let mut judged = Judged { error: 0.0, coarse: Vec::new(), is_inside: false, request: None };
    let mut chords = Vec::new();
    for t in 0..work.mesh.triangles.len() as u32 {
        if t % 256 == 255 {
            prover.check_budget(work)?;
        }
        let (error, fault) = prover.judge(work, t);
        judged.error = judged.error.max(error);
        match fault {
            Fault::None => {}
            Fault::Edge(_) if prover.accepts() => {}
            Fault::Edge(i) => match prover.boundary_segment(work, t, i) {
                Some(Segment::Edge { edge, chord }) => chords.push((edge, chord)),
                _ => judged.request = Some(Verdict::FinerSeam),
            },
            Fault::Inside(_) | Fault::Fold(_) => {
                let [a, b, c] = work.mesh.corners(t);
                judged.coarse.push((a + b + c) / 3.0);
                let first_inside = work.chart.points.len() as u32;
                judged.is_inside |= work.mesh.triangles[t as usize].iter().all(|&v| v >= first_inside);
            }
        }
    }
    if !chords.is_empty() {
        chords.sort_unstable();
        chords.dedup();
        judged.request = Some(Verdict::Finer(chords));
    }
    Ok(judged)
}
