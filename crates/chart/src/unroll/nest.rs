//! Outer loop and holes: which loop is which, and the periods by which holes are moved into the outer loop.

use super::{Unroll, area, contains, shifted};
use crate::keys::ChartPoint;
use crate::trimmed_face::OpenLoop;
use chordal_brep::MeshIssue;
use chordal_nurbs::{DVec2, UvBox};

/// A hole is moved by this many periods at most. A hole further away is not found to be inside the outer
/// loop.
const MOST_TURNS: f64 = 64.0;

impl Unroll<'_, '_> {
    /// Orients the loops, and moves holes by whole periods into the outer loop.
    pub(super) fn nest(
        &mut self,
        outer: Option<Vec<ChartPoint>>,
        mut plain: Vec<OpenLoop>,
    ) -> Result<Vec<Vec<ChartPoint>>, MeshIssue> {
        let outer = match outer {
            Some(mut polygon) => {
                if area(&polygon) < 0.0 {
                    let mut open = OpenLoop { points: polygon, ..OpenLoop::default() };
                    open.reverse();
                    polygon = open.points;
                }
                polygon
            }
            None => {
                let size = |l: &OpenLoop| area(&l.points).abs();
                let largest = (0..plain.len()).max_by(|&a, &b| size(&plain[a]).total_cmp(&size(&plain[b])));
                let mut open = plain.remove(largest.ok_or(MeshIssue::NoArea)?);
                if area(&open.points) < 0.0 {
                    self.reversed = true;
                    open.reverse();
                }
                open.points
            }
        };
        let mut holes = Vec::with_capacity(plain.len());
        let mut inside = Vec::with_capacity(plain.len());
        for mut open in plain {
            let by = self.shift_into(&outer, &open.points);
            if self.reversed {
                open.reverse();
            }
            open.points = shifted(&open.points, by.unwrap_or(DVec2::ZERO));
            inside.push(by.is_some());
            holes.push(open);
        }
        // A loop with the direction of a hole is a hole, even if coarse chords make it cross the outer loop.
        // A loop with the direction of an outer loop is a separate region of the face if it is outside the
        // outer loop or inside a hole (an island); else its direction is wrong.
        let wrong: Vec<bool> = (0..holes.len())
            .map(|i| area(&holes[i].points) > 0.0 && inside[i] && holes_around(&holes, i).is_multiple_of(2))
            .collect();
        holes.iter_mut().zip(wrong).filter(|(_, wrong)| *wrong).for_each(|(hole, _)| hole.reverse());
        let mut polygons = vec![outer];
        polygons.extend(holes.into_iter().map(|hole| hole.points));
        Ok(polygons)
    }

    /// The periods by which a loop must be moved to be inside the outer one; `None` if it is outside of it.
    fn shift_into(&self, outer: &[ChartPoint], hole: &[ChartPoint]) -> Option<DVec2> {
        let [pu, pv] = self.context.surface.periods;
        let (to, from) =
            (UvBox::from_points(outer.iter().map(|p| p.uv)), UvBox::from_points(hole.iter().map(|p| p.uv)));
        let steps = |axis: usize| match self.context.surface.periods[axis] {
            Some(period) => {
                // Near periods first. A cut through holes may move the outer loop by several periods.
                let far = |d: f64| (d.abs() / period).ceil().clamp(2.0, MOST_TURNS);
                let most = far(to.min[axis] - from.max[axis]).max(far(to.max[axis] - from.min[axis]));
                let turns = (1..=most as i32).flat_map(|k| [f64::from(k), f64::from(-k)]);
                std::iter::once(0.0).chain(turns).collect()
            }
            None => vec![0.0],
        };
        for v in steps(1) {
            for u in steps(0) {
                let by = DVec2::new(u * pu.unwrap_or(0.0), v * pv.unwrap_or(0.0));
                let inside = hole.iter().filter(|p| contains(outer, p.uv + by)).count();
                if 2 * inside > hole.len() {
                    return Some(by);
                }
            }
        }
        None
    }
}

/// The number of other loops that contain a loop completely.
fn holes_around(loops: &[OpenLoop], i: usize) -> usize {
    let own = &loops[i].points;
    let around = |other: &&OpenLoop| {
        let extent = UvBox::from_points(other.points.iter().map(|p| p.uv));
        own.iter().all(|p| extent.contains(p.uv)) && own.iter().all(|p| contains(&other.points, p.uv))
    };
    let others = loops.iter().enumerate().filter(|&(k, _)| k != i).map(|(_, other)| other);
    others.filter(around).count()
}
