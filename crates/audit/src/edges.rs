//! Edges: every polyline runs along its curve, in order, without a missing sample.
//!
//! The parameter of each sample is found again from its position, so that the bound of each chord rests on
//! nothing that the mesher said.

use crate::precision::{ROUNDING, curve_magnitude};
use crate::report::{Problem, Subject};
use chordal_brep::issue::PolylineDefect;
use chordal_brep::{AuditIssue, Edge, Part};
use chordal_mesh::{Origin, PartMesh};
use chordal_nurbs::{Curve, CurveInverter, DVec3, Range};
use rayon::prelude::*;
use std::cmp::Ordering;

/// A parameter that is found nearer to a break of the curve than this part of the edge is the break: the rest
/// is rounding. The point there is compared as well.
const BREAK: f64 = 1e-12;

/// The findings about one edge.
#[derive(Clone, Debug, Default)]
pub(crate) struct EdgeAudit {
    /// Per chord, the bound of its distance from the curve.
    pub sag: Vec<f64>,
    /// The curve's parameter at every point of the polyline, found again from the points.
    pub parameters: Vec<f64>,
    /// The largest distance of an end vertex, or of a sample, from the curve.
    pub gap: f64,
    pub misplaced: usize,
    pub problem: Option<Problem>,
}

/// How exactly the samples of an edge can be checked, in the units of the part.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EdgePrecision {
    /// The largest coordinate of the mesh.
    pub scale: f64,
    /// A sample farther from its curve is misplaced.
    pub allowed: f64,
    /// Millimetres in one unit of the part.
    pub millimetres: f64,
}

/// Audits the polylines of all edges.
pub(crate) fn audit_edges(part: &Part, mesh: &PartMesh, precision: EdgePrecision) -> Vec<EdgeAudit> {
    (0..part.edges.len())
        .into_par_iter()
        .with_min_len(64)
        .map(|e| match mesh.edges.get(e) {
            Some(line) if !line.is_empty() => audit_edge(part, mesh, e, line, precision),
            _ => EdgeAudit::default(),
        })
        .collect()
}

fn audit_edge(
    part: &Part,
    mesh: &PartMesh,
    index: usize,
    line: &[u32],
    precision: EdgePrecision,
) -> EdgeAudit {
    let edge = &part.edges[index];
    let mut audit = EdgeAudit::default();
    if let Some(defect) = wrong_origins(mesh, edge, index, line) {
        audit.problem = Some(problem(edge, index, AuditIssue::BrokenPolyline(defect)));
        return audit;
    }
    let Some(curve) = edge.curve.as_deref() else {
        let defect = PolylineDefect::NoCurve;
        audit.problem = Some(problem(edge, index, AuditIssue::BrokenPolyline(defect)));
        return audit;
    };
    let at = |i: usize| mesh.positions[line[i] as usize];
    let last = line.len() - 1;
    let ends = [edge.range.start, edge.range.end].map(|t| curve.point(t));
    audit.gap = at(0).distance(ends[0]).max(at(last).distance(ends[1]));
    let rounding = ROUNDING * (precision.scale + curve_magnitude(curve));
    let breaks = curve.all_breaks(edge.range);
    let mut tracer = Tracer { curve, range: edge.range, breaks, t: edge.range.start, p: ends[0], rounding };
    audit.parameters.push(edge.range.start);
    for i in 1..=last {
        let before = tracer.t;
        if i < last {
            let distance = tracer.follow(at(i));
            if distance > rounding {
                audit.gap = audit.gap.max(distance);
            }
            if distance > rounding + precision.allowed {
                audit.misplaced += 1;
                let distance = distance * precision.millimetres;
                audit.problem = Some(problem(edge, index, AuditIssue::MisplacedEdgeSample { distance }));
            }
        } else {
            tracer.t = edge.range.end;
        }
        if tracer.t.partial_cmp(&before) != Some(Ordering::Greater) {
            let issue = AuditIssue::BrokenPolyline(PolylineDefect::Unordered { chord: i });
            audit.problem.get_or_insert(problem(edge, index, issue));
            audit.sag = vec![f64::INFINITY; last];
            return audit;
        }
        audit.parameters.push(tracer.t);
        audit.sag.push(curve.chord_error(before, tracer.t));
    }
    audit
}

fn problem(edge: &Edge, index: usize, issue: AuditIssue) -> Problem {
    Problem::new(Subject::Edge(index as u32), edge.source, issue)
}

/// A polyline runs from the start vertex over the samples 1, 2, … to the end vertex.
fn wrong_origins(mesh: &PartMesh, edge: &Edge, index: usize, line: &[u32]) -> Option<PolylineDefect> {
    let last = line.len() - 1;
    if last == 0 {
        return Some(PolylineDefect::OnePoint);
    }
    let place = (0..=last).find(|&i| {
        let wanted = match i {
            0 => Origin::Vertex(edge.start.0),
            i if i == last => Origin::Vertex(edge.end.0),
            i => Origin::Edge { edge: index as u32, index: i as u32 },
        };
        mesh.origins[line[i] as usize] != wanted
    })?;
    Some(PolylineDefect::ForeignSample { place })
}

/// Finds the parameters of points that follow each other along a curve.
struct Tracer<'a> {
    curve: &'a Curve,
    range: Range,
    /// Knots, corners and joints of the curve.
    breaks: Vec<f64>,
    /// The parameter and the point found last.
    t: f64,
    p: DVec3,
    rounding: f64,
}

impl Tracer<'_> {
    /// Steps to the next point; returns its distance from the curve.
    fn follow(&mut self, p: DVec3) -> f64 {
        let before = self.t;
        let speed = self.curve.jet(before).d1.length();
        let step = p.distance(self.p) / speed;
        let room = self.range.end - before;
        let guess = before + if step.is_finite() { step.min(0.5 * room) } else { 0.5 * room };
        let (mut t, mut distance) = match self.curve {
            Curve::Line { .. } | Curve::Circle { .. } => {
                let t = self.range.clamp(self.curve.invert(p, Some(guess)));
                (t, self.curve.point(t).distance(p))
            }
            _ => self.newton(p, guess),
        };
        if distance > self.rounding || t <= before {
            let ahead = CurveInverter::new(self.curve, Range::new(before, self.range.end)).invert(p, None);
            if t <= before || ahead.distance < distance {
                (t, distance) = (ahead.t, ahead.distance);
            }
        }
        self.t = self.at_break(t, p, distance).unwrap_or(t);
        self.p = p;
        distance
    }

    /// The break of the curve that a parameter is meant to be. Beside it, a bound over the chord would take
    /// the derivatives of both pieces.
    fn at_break(&self, t: f64, p: DVec3, distance: f64) -> Option<f64> {
        let beyond = self.breaks.partition_point(|&b| b < t);
        let beside = [beyond.checked_sub(1), Some(beyond)].into_iter().flatten();
        let near = beside.filter_map(|i| self.breaks.get(i).copied());
        let is_same = |b: &f64| (b - t).abs() <= BREAK * self.range.length();
        near.filter(is_same).find(|&b| self.curve.point(b).distance(p) <= distance.max(self.rounding))
    }

    /// Gauss–Newton: quadratic here, because the point lies on the curve.
    fn newton(&self, p: DVec3, guess: f64) -> (f64, f64) {
        let mut t = guess;
        let mut distance = f64::INFINITY;
        for _ in 0..16 {
            let jet = self.curve.jet(t);
            let r = p - jet.p;
            distance = r.length();
            let step = r.dot(jet.d1) / jet.d1.length_squared();
            let next = self.range.clamp(t + step);
            if !next.is_finite() || (next - t).abs() <= f64::EPSILON * t.abs() {
                break;
            }
            t = next;
        }
        (t, self.curve.point(t).distance(p).min(distance))
    }
}
