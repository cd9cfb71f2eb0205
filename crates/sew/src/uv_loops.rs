//! The loops of a face in its parameter plane, and which of them run in the wrong direction.

use crate::border::Border;
use chordal_brep::{Face, FaceGeometry, Loop, Part};
use chordal_nurbs::{Curve, DVec2, Surface, SurfaceInverter};
use rayon::prelude::*;

/// The fewest samples of an edge; more where its polyline has more.
const SAMPLES: usize = 8;

/// A loop in the parameter plane, the interior on its left seen along the surface's own normal.
pub(crate) struct UvLoop {
    /// The index among the face's loops.
    pub index: usize,
    pub points: Vec<DVec2>,
    /// The end of the loop after one turn minus its start: whole periods, or zero.
    pub winding: DVec2,
}

/// The loops of a face; `None` where one cannot be followed.
pub(crate) fn uv_loops(part: &Part, face: &Face, surface: &Surface) -> Option<Vec<UvLoop>> {
    let inverter = SurfaceInverter::new(surface, surface.domain());
    let periods = surface.periods();
    let mut loops = Vec::new();
    for (index, a_loop) in face.loops.iter().enumerate() {
        let Loop::Edges { coedges, .. } = a_loop else { continue };
        let mut points: Vec<DVec2> = Vec::new();
        for coedge in coedges {
            let edge = &part.edges[coedge.edge.index()];
            let Some(curve) = edge.curve.as_deref() else { continue };
            let straight = matches!(curve, Curve::Line { .. }) && matches!(surface, Surface::Plane { .. });
            let mut t = Border::parameters(curve, edge.range, if straight { 1 } else { SAMPLES });
            if !coedge.forward {
                t.reverse();
            }
            for t in &t[..t.len() - 1] {
                let near = points.last().copied();
                let uv = inverter.invert(curve.point(*t), near).uv;
                points.push(near.map_or(uv, |near| turned(uv, near, periods)));
            }
        }
        if points.len() < 2 || points.iter().any(|p| !p.is_finite()) {
            return None;
        }
        let back = turned(points[0], points[points.len() - 1], periods);
        let mut winding = back - points[0];
        if !face.same_sense {
            points.reverse();
            winding = -winding;
        }
        let whole = |d: f64, period: Option<f64>| period.map_or(0.0, |p| p * (d / p).round());
        let winding = DVec2::new(whole(winding.x, periods[0]), whole(winding.y, periods[1]));
        loops.push(UvLoop { index, points, winding });
    }
    Some(loops)
}

/// The same point in the turn nearest to `near`.
fn turned(uv: DVec2, near: DVec2, periods: [Option<f64>; 2]) -> DVec2 {
    let turn =
        |t: f64, near: f64, period: Option<f64>| period.map_or(t, |p| t + p * ((near - t) / p).round());
    DVec2::new(turn(uv.x, near.x, periods[0]), turn(uv.y, near.y, periods[1]))
}

impl UvLoop {
    fn area(&self) -> f64 {
        let n = self.points.len();
        let origin = self.points[0];
        let cross = |i: usize| (self.points[i] - origin).perp_dot(self.points[(i + 1) % n] - origin);
        0.5 * (0..n).map(cross).sum::<f64>()
    }

    fn contains(&self, p: DVec2) -> bool {
        let n = self.points.len();
        let crosses = |i: &usize| {
            let (a, b) = (self.points[*i], self.points[(i + 1) % n]);
            (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)
        };
        (0..n).filter(crosses).count() % 2 == 1
    }
}

/// For each face, the loops that run in the same direction as the loop around them. Meshing reverses them, so
/// they show the wrong orientation of their neighbours. The outermost loop is taken as it is.
pub(crate) fn wrong_loops(part: &Part) -> Vec<Vec<usize>> {
    part.faces.par_iter().with_min_len(64).map(|face| wrong_loops_of(part, face)).collect()
}

fn wrong_loops_of(part: &Part, face: &Face) -> Vec<usize> {
    let FaceGeometry::Surface(surface) = &face.geometry else { return Vec::new() };
    // In a closed direction loops may lie in different periods, so nesting cannot be seen from their places.
    if face.loops.len() < 2 || surface.periods().iter().any(Option::is_some) {
        return Vec::new();
    }
    let loops = uv_loops(part, face, surface).unwrap_or_default();
    if loops.len() < 2 || loops.iter().any(|l| l.winding != DVec2::ZERO) {
        return Vec::new();
    }
    let areas: Vec<f64> = loops.iter().map(UvLoop::area).collect();
    let outer = (0..loops.len()).max_by(|&a, &b| areas[a].abs().total_cmp(&areas[b].abs()));
    let Some(outer) = outer else { return Vec::new() };
    let depth = |i: usize| {
        let p = loops[i].points[0];
        (0..loops.len())
            .filter(|&o| o != i && areas[o].abs() > areas[i].abs() && loops[o].contains(p))
            .count()
    };
    let runs_wrong = |&i: &usize| {
        let alike = (areas[i] > 0.0) == (areas[outer] > 0.0);
        i != outer && alike != depth(i).is_multiple_of(2)
    };
    (0..loops.len()).filter(runs_wrong).map(|i| loops[i].index).collect()
}
