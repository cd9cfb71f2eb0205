//! One face by a strategy: its parts, the common proof, and refinement by the strategy's own means where the proof fails.

use super::Strategy;
use super::cells::{Cells, Rule};
use super::cut::cut;
use super::kd::{Binary, Kd};
use super::node::Measure;
use super::polygons::{Filling, retriangulate};
use super::region::Region;
use crate::chart::Segment;
use crate::face::FaceWork;
use crate::options::Bound;
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
}

/// Cells cut with the loops.
struct ByCells {
    region: Region,
    cells: Cells,
    rule: Box<dyn Rule>,
    filling: Filling,
    tolerance: f64,
    measure: Measure,
}

impl Method for ByCells {
    fn build(
        &mut self,
        work: &mut FaceWork<'_, '_>,
        check: &dyn Fn(usize) -> Result<(), String>,
    ) -> Result<(), String> {
        self.cells.refine(&*self.rule, &self.region, self.tolerance, self.measure, check)?;
        let met: Vec<UvBox> = self.cells.leaves.iter().filter(|l| l.met).map(|l| l.bounds).collect();
        let found = cut(work, &self.region, &met);
        retriangulate(&mut work.mesh, &found.fixed, self.filling, &mut work.trace);
        work.trace.add(self.rule.name(), met.len());
        work.trace.add("corners of cells", found.corners);
        work.trace.add("borders cut by loops", found.crossings);
        work.trace.add("borders given up", found.dropped);
        Ok(())
    }

    fn refine(&mut self, coarse: &[DVec2]) -> bool {
        self.cells.cut_at(coarse, &*self.rule, &self.region, self.measure)
    }
}

fn method(work: &FaceWork<'_, '_>, strategy: Strategy, bound: Bound) -> Result<Box<dyn Method>, String> {
    let rule: Box<dyn Rule> = match strategy {
        Strategy::Kd(cut) => Box::new(Kd(cut)),
        Strategy::Binary(cut) => Box::new(Binary(cut)),
        Strategy::Default => return Err("the default strategy has no method of its own".into()),
    };
    let region = Region::new(&work.chart);
    let tolerance = work.limits.tolerance;
    let mut cells = Cells::new(work.context.surface, region.uv_box, tolerance)?;
    cells.begin(&*rule, &region, tolerance);
    let measure = if bound == Bound::Proven { Measure::Conservative } else { Measure::Estimated };
    Ok(Box::new(ByCells { region, cells, rule, filling: Filling::FanOrMonotone, tolerance, measure }))
}

/// Fills a face whose loops are triangulated.
///
/// # Errors
/// A sentence, where the face is given up.
pub(crate) fn fill(
    work: &mut FaceWork<'_, '_>,
    prover: &mut Prover<'_>,
    strategy: Strategy,
    bound: Bound,
) -> Result<Verdict, String> {
    let boundary = work.mesh.clone();
    let mut method = method(work, strategy, bound)?;
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
        work.trace.add("rounds of refinement after the proof", round);
        if bound == Bound::Estimated {
            return Ok(prover.proven(f64::NAN));
        }
        let judged = judge(work, prover)?;
        if let Some(verdict) = judged.request {
            return Ok(verdict);
        }
        if judged.coarse.is_empty() {
            return Ok(prover.proven(judged.error));
        }
        if !method.refine(&judged.coarse) {
            break;
        }
    }
    let before = work.mesh.triangles.len();
    let verdict = prover.refine(work)?;
    work.trace.add("triangles added by the default's means", work.mesh.triangles.len() - before);
    Ok(verdict)
}

/// Takes everything out of the face but its loops.
fn restore(work: &mut FaceWork<'_, '_>, boundary: &Triangulation) {
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
    /// Edges or seams must become finer first.
    request: Option<Verdict>,
}

fn judge(work: &FaceWork<'_, '_>, prover: &mut Prover<'_>) -> Result<Judged, String> {
    let mut judged = Judged { error: 0.0, coarse: Vec::new(), request: None };
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
