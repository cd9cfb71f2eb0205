//! A face with its surface and its sampled edges, and the parameters of its loops.
//!
//! Elementary surfaces have inversion in closed form, so their pcurves are not needed. On other surfaces, the
//! pcurve of the file is used where it agrees with the curve in space; otherwise the samples are projected.
//! Along a loop, parameters are continued by whole periods. Where a loop passes through a pole, the
//! parameters on both sides of it are kept, as two chart points of one vertex.

use crate::edge_samples::EdgeSamples;
use crate::keys::{ChartPoint, Key, Segment};
use crate::surface::{FaceSurface, Near};
use chordal_brep::{Coedge, Face, Loop, MeshIssue, Part, Pcurve};
use chordal_nurbs::{DVec2, DVec3};

/// A loop before it is closed in the chart.
#[derive(Clone, Debug, Default)]
pub(crate) struct OpenLoop {
    pub points: Vec<ChartPoint>,
    /// Periods by which the end lies beyond the start.
    pub winding: [i32; 2],
    /// Whether the file marks it as the outer loop.
    pub outer: bool,
}

/// A face with its surface and its sampled edges.
#[derive(Debug)]
pub struct TrimmedFace<'a, 's> {
    /// The part that the face belongs to.
    pub part: &'a Part,
    /// The face itself.
    pub face: &'a Face,
    /// Its surface.
    pub surface: &'a FaceSurface<'s>,
    /// The samples of all edges of the part, by index.
    pub edges: &'a [EdgeSamples],
    /// Whether loops of the face meet in vertices. Each such vertex is one place in the chart.
    pub touching: bool,
    /// Points nearer together than this are the same point.
    pub resolution: f64,
}

/// One coedge's samples in the direction of the loop.
struct Run {
    uv: Vec<DVec2>,
    keys: Vec<Key>,
    chords: Vec<Segment>,
    /// The pole that the first and last sample lie on.
    poles: [bool; 2],
}

impl Run {
    fn reverse(&mut self) {
        self.uv.reverse();
        self.keys.reverse();
        self.chords.reverse();
        self.poles.reverse();
    }
}

impl TrimmedFace<'_, '_> {
    /// All loops of the face with the interior on their left in the chart, and the vertices of vertex loops.
    ///
    /// # Errors
    /// Where a loop cannot be followed.
    pub(crate) fn loops(&self) -> Result<(Vec<OpenLoop>, Vec<u32>), MeshIssue> {
        let mut loops = Vec::new();
        let mut lone = Vec::new();
        for a_loop in &self.face.loops {
            match a_loop {
                Loop::Vertex(v) => lone.push(v.0),
                Loop::Polygon { vertices, outer } => {
                    let xyz: Vec<DVec3> =
                        vertices.iter().map(|v| self.part.vertices[v.index()].point).collect();
                    let uv = self.inverted(&xyz, None);
                    let points = uv.iter().zip(vertices).map(|(&uv, v)| ChartPoint {
                        uv,
                        key: Key::Vertex(v.0),
                        segment: Segment::Seam,
                    });
                    loops.push(OpenLoop { points: points.collect(), winding: [0, 0], outer: *outer });
                }
                Loop::Edges { coedges, outer } => {
                    if let Some(mut open) = self.join(coedges)? {
                        open.outer = *outer;
                        loops.push(open);
                    }
                }
            }
        }
        for open in &mut loops {
            open.points = without_repeats(std::mem::take(&mut open.points));
            if !self.face.same_sense {
                open.reverse();
            }
        }
        loops.retain(|l| !l.points.is_empty());
        Ok((loops, lone))
    }

    /// True for a face with a loop that is more than a point.
    pub(crate) fn is_trimmed(&self) -> bool {
        self.face.loops.iter().any(|boundary| !matches!(boundary, Loop::Vertex(_)))
    }

    fn inverted(&self, xyz: &[DVec3], start: Option<DVec2>) -> Vec<DVec2> {
        let mut near = start.map(Near::on_surface);
        let mut uv: Vec<DVec2> = Vec::with_capacity(xyz.len());
        for (i, &p) in xyz.iter().enumerate() {
            let place = self.surface.invert_from(p, near);
            let found = place.uv;
            uv.push(found);
            let ahead = match (uv.as_slice(), xyz.get(i + 1)) {
                // The next point is expected straight ahead.
                (&[.., last, _], Some(next)) => {
                    let (run, step) = (p.distance(xyz[i - 1]), p.distance(*next));
                    let share = if run > 0.0 { (step / run).min(2.0) } else { 0.0 };
                    self.surface.inside(found + (found - last) * share)
                }
                _ => found,
            };
            near = Some(Near { uv: ahead, ..place });
        }
        uv
    }

    /// The runs of a coedge in the direction of the loop: one, or as many as poles on the way cut it into.
    fn runs(&self, coedge: &Coedge, near: Option<DVec2>) -> Vec<Run> {
        let edge = &self.part.edges[coedge.edge.index()];
        let samples = &self.edges[coedge.edge.index()];
        let n = samples.sag.len();
        if n == 0 {
            return Vec::new();
        }
        let id = coedge.edge.0;
        let mut keys: Vec<Key> = (0..=n as u32).map(|i| Key::Edge(id, i)).collect();
        keys[0] = Key::Vertex(edge.start.0);
        keys[n] = Key::Vertex(edge.end.0);
        let at_pole = |i: usize| self.surface.pole_at(samples.points[i], self.resolution).is_some();
        let mut cuts = vec![0];
        if !self.surface.poles.is_empty() {
            cuts.extend((1..n).filter(|&i| at_pole(i) && !at_pole(i - 1) && !at_pole(i + 1)));
        }
        cuts.push(n);
        let uv = self.edge_uv(coedge, samples, near);
        let run = |cut: &[usize]| {
            let (from, to) = (cut[0], cut[1]);
            let chord = |i: usize| Segment::Edge { edge: id, chord: i as u32 };
            let mut run = Run {
                uv: uv[from..=to].to_vec(),
                keys: keys[from..=to].to_vec(),
                chords: (from..to).map(chord).collect(),
                poles: [at_pole(from), at_pole(to)],
            };
            self.continue_turns(&mut run.uv);
            if run.poles != [false, false] {
                self.settle_poles(&mut run.uv, &samples.points[from..=to], run.poles);
            }
            if !coedge.forward {
                run.reverse();
            }
            run
        };
        let mut runs: Vec<Run> = cuts.windows(2).map(run).collect();
        if !coedge.forward {
            runs.reverse();
        }
        runs
    }

    /// Parameters of the samples, in the direction of the edge.
    fn edge_uv(&self, coedge: &Coedge, samples: &EdgeSamples, near: Option<DVec2>) -> Vec<DVec2> {
        let project = || {
            let mut xyz = samples.points.clone();
            if !coedge.forward {
                xyz.reverse();
            }
            // Begin beside a pole, where parameters are defined.
            let skip = usize::from(self.surface.pole_at(xyz[0], self.resolution).is_some() && xyz.len() > 2);
            let mut uv = self.inverted(&xyz[skip..], near);
            if skip == 1 {
                uv.insert(0, self.surface.invert(xyz[0], Some(uv[0])));
            }
            if !coedge.forward {
                uv.reverse();
            }
            uv
        };
        if self.surface.is_elementary() {
            return project();
        }
        let Some((uv, gap)) = self.pcurve_uv(coedge, samples, near) else { return project() };
        if gap <= self.resolution {
            return uv;
        }
        let projected = project();
        if self.gap(&projected, samples) < 0.5 * gap { projected } else { uv }
    }

    fn pcurve_uv(
        &self,
        coedge: &Coedge,
        samples: &EdgeSamples,
        near: Option<DVec2>,
    ) -> Option<(Vec<DVec2>, f64)> {
        let first = samples.t[0];
        let length = samples.t[samples.t.len() - 1] - first;
        let sampled = |p: &Pcurve| -> Vec<DVec2> {
            let at = |t: f64| p.range.start + (t - first) / length * p.range.length();
            samples.t.iter().map(|&t| p.curve.point(at(t))).collect()
        };
        let mut best: Option<(Vec<DVec2>, f64)> = None;
        for pcurve in &coedge.pcurves {
            let uv = sampled(pcurve);
            if uv.iter().any(|p| !p.is_finite()) {
                continue;
            }
            let gap = self.gap(&uv, samples);
            let begins = |uv: &[DVec2]| {
                near.map_or(0.0, |n| uv[if coedge.forward { 0 } else { uv.len() - 1 }].distance(n))
            };
            let better = best.as_ref().is_none_or(|(old, old_gap)| {
                let similar =
                    gap <= 2.0 * old_gap + self.resolution && *old_gap <= 2.0 * gap + self.resolution;
                if similar { begins(&uv) < begins(old) } else { gap < *old_gap }
            });
            if better {
                best = Some((uv, gap));
            }
        }
        best
    }

    fn gap(&self, uv: &[DVec2], samples: &EdgeSamples) -> f64 {
        uv.iter().zip(&samples.points).fold(0.0, |m, (&uv, p)| m.max(self.surface.point(uv).distance(*p)))
    }

    /// No step along an edge is longer than half a period.
    fn continue_turns(&self, uv: &mut [DVec2]) {
        for i in 1..uv.len() {
            uv[i] = self.surface.nearest_turn(uv[i], uv[i - 1]);
        }
    }

    /// At a pole the collapsed parameter is that of the neighbouring sample.
    fn settle_poles(&self, uv: &mut [DVec2], xyz: &[DVec3], poles: [bool; 2]) {
        let last = uv.len() - 1;
        for (at_pole, i, neighbor) in [(poles[0], 0, 1), (poles[1], last, last - 1)] {
            if !at_pole || last == 1 && poles[0] && poles[1] {
                continue;
            }
            if let Some(pole) = self.surface.pole_at(xyz[i], self.resolution) {
                let mut settled = uv[neighbor];
                settled[pole.axis] = self.nearest_value(pole.value, uv[neighbor][pole.axis], pole.axis);
                uv[i] = settled;
            }
        }
    }

    fn nearest_value(&self, value: f64, near: f64, axis: usize) -> f64 {
        self.surface.periods[axis].map_or(value, |p| value + p * ((near - value) / p).round())
    }

    /// Joins the coedges of a loop.
    fn join(&self, coedges: &[Coedge]) -> Result<Option<OpenLoop>, MeshIssue> {
        let mut runs: Vec<Run> = Vec::with_capacity(coedges.len());
        let mut near = None;
        for coedge in coedges {
            let of_edge = self.runs(coedge, near);
            // Only an edge that is a single point has no chords.
            if of_edge.is_empty() && self.part.edges[coedge.edge.index()].curve.is_some() {
                let source = self.part.edges[coedge.edge.index()].source;
                return Err(MeshIssue::EdgeWithoutSamples { edge: source });
            }
            near = of_edge.last().and_then(|run| run.uv.last().copied()).or(near);
            runs.extend(of_edge);
        }
        if runs.is_empty() {
            return Ok(None);
        }
        for i in 0..runs.len() {
            let after = (i + 1) % runs.len();
            let (end, start) = (runs[i].keys[runs[i].keys.len() - 1], runs[after].keys[0]);
            if end != start && runs.len() > 1 {
                return Err(MeshIssue::LoopNotClosed { edge: i + 1, next: after + 1 });
            }
        }
        // Begin behind a pole, so that the jump along it closes the loop.
        if let Some(first) = (0..runs.len()).find(|&i| runs[i].poles[0]) {
            runs.rotate_left(first);
        }
        let begins_at_pole = runs[0].poles[0];
        for i in 1..runs.len() {
            let (done, rest) = runs.split_at_mut(i);
            let previous = &done[i - 1];
            let end = previous.uv[previous.uv.len() - 1];
            let shift = if previous.poles[1] && rest[0].poles[0] {
                self.pole_shift(previous.uv[previous.uv.len() - 2], end, rest[0].uv[0])
            } else {
                self.surface.nearest_turn(rest[0].uv[0], end) - rest[0].uv[0]
            };
            rest[0].uv.iter_mut().for_each(|uv| *uv += shift);
        }
        let mut open = OpenLoop::default();
        for run in &runs {
            let n = run.uv.len() - 1;
            open.points.extend((0..n).map(|i| ChartPoint {
                uv: run.uv[i],
                key: run.keys[i],
                segment: run.chords[i],
            }));
            if run.poles[1] {
                open.points.push(ChartPoint { uv: run.uv[n], key: run.keys[n], segment: Segment::Pole });
            }
        }
        let last = &runs[runs.len() - 1];
        if !begins_at_pole {
            let turn = last.uv[last.uv.len() - 1] - open.points[0].uv;
            let whole = |turn: f64, period: Option<f64>| period.map_or(0, |p| (turn / p).round() as i32);
            open.winding = [whole(turn.x, self.surface.periods[0]), whole(turn.y, self.surface.periods[1])];
        }
        Ok(Some(open))
    }

    /// The whole periods to add behind a pole: the loop runs along the pole with the interior on its left,
    /// which is against the parameter where it came from below and with it where it came from above.
    /// `before`: on the way there.
    fn pole_shift(&self, before: DVec2, end: DVec2, start: DVec2) -> DVec2 {
        let Some((axis, upper)) = self.pole_side(before, end) else { return DVec2::ZERO };
        let along = 1 - axis;
        let Some(period) = self.surface.periods[along] else { return DVec2::ZERO };
        // Seen against the face's own sense the loop runs the other way.
        let down = (upper == (axis == 1)) == self.face.same_sense;
        let mut step = (start[along] - end[along]).rem_euclid(period);
        let tiny = 1e-6 * period;
        if step < tiny || step > period - tiny {
            step = 0.0;
        }
        let step = if down {
            step - period
        } else if step == 0.0 {
            period
        } else {
            step
        };
        let mut shift = DVec2::ZERO;
        shift[along] = end[along] + step - start[along];
        shift
    }

    /// The pole line that a loop reaches at `end`, coming from `before`: (the pole's axis, whether the loop
    /// comes from below).
    fn pole_side(&self, before: DVec2, end: DVec2) -> Option<(usize, bool)> {
        let off = |p: &chordal_nurbs::Pole| self.surface.offset_from(p.axis, p.value, end).abs();
        let pole = self.surface.poles.iter().min_by(|a, b| off(a).total_cmp(&off(b)))?;
        Some((pole.axis, before[pole.axis] < end[pole.axis]))
    }
}

impl OpenLoop {
    /// Runs the loop the other way round.
    pub fn reverse(&mut self) {
        let n = self.points.len();
        if n == 0 {
            return;
        }
        let old = std::mem::take(&mut self.points);
        // Point i of the reversed loop is old point n−1−i; its segment is the one that led to it.
        self.points = (0..n)
            .map(|i| ChartPoint { segment: old[(2 * n - 2 - i) % n].segment, ..old[n - 1 - i] })
            .collect();
        self.winding = self.winding.map(|w| -w);
    }
}

/// Drops points that repeat their successor's vertex at the same place.
fn without_repeats(points: Vec<ChartPoint>) -> Vec<ChartPoint> {
    let n = points.len();
    (0..n)
        .filter(|&i| {
            let next = &points[(i + 1) % n];
            !(n > 1 && points[i].key == next.key && points[i].uv == next.uv)
        })
        .map(|i| points[i])
        .collect()
}
