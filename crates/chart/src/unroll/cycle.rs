//! A surface that is closed in both directions, where every straight cut meets a hole: two cuts through
//! holes.
//!
//! ```text
//!       │ cut
//!   ┌───j───┐
//!   │ root  │
//!   └───i───┘
//!       │ cut
//! ```
//!
//! The first cut begins at a hole and ends at the same hole, one period further. It makes the surface a band
//! between the two sides of the cut. A second cut from one side to the other makes the band a polygon.
//!
//! The side with the face on the left of the way up follows each hole from where the cut enters it to where
//! it leaves it; the other side, on the way down, follows the rest of the hole.

use super::cuts::{Bridge, Cuts, Side};
use super::winding::part_of;
use super::{Unroll, area, shifted};
use crate::keys::{ChartPoint, Segment};
use crate::trimmed_face::OpenLoop;
use chordal_nurbs::DVec2;

impl Unroll<'_, '_> {
    /// The polygon of a surface that is closed in u and in v; `None` where no cut is found.
    pub(super) fn cut_twice(&mut self, holes: &mut Vec<OpenLoop>) -> Option<Vec<ChartPoint>> {
        let [Some(period_u), Some(period_v)] = self.context.surface.periods else { return None };
        let (turn, step) = (DVec2::new(period_u, 0.0), DVec2::new(0.0, period_v));
        let root = holes.iter().position(|hole| area(&hole.points) < 0.0)?;
        let start = holes[root].clone();
        let mut others = holes.clone();
        others.remove(root);
        let count = others.len();
        let repeated = repeated(&others, &start, step);
        let end = OpenLoop { points: shifted(&start.points, step), ..start.clone() };
        let lengths = self.lengths_at(start.points[0].uv);
        let sides = [Side::Loop(&start), Side::Loop(&end)];
        let mut cuts = Cuts::new(sides, &repeated, 0, turn, lengths, self.context.surface.periods);
        cuts.repeat_across(step, count);
        let bridges = cuts.chain()?;
        drop(cuts);
        let winding = self.sides_of_cycle(&start, &bridges, &repeated, step);
        let mut passed: Vec<usize> =
            bridges[1..].iter().map(|bridge| (bridge.from.node - 1) % count).collect();
        passed.sort_unstable();
        for &hole in passed.iter().rev() {
            others.remove(hole);
        }
        let polygon = self.cut(winding, &mut others).ok()?;
        *holes = others;
        Some(polygon)
    }

    /// The two sides of a cut from a hole to itself, one `step` on, as loops that wind round.
    fn sides_of_cycle(
        &mut self,
        root: &OpenLoop,
        bridges: &[Bridge],
        holes: &[OpenLoop],
        step: DVec2,
    ) -> Vec<OpenLoop> {
        let (first, last) = (bridges[0].from, bridges[bridges.len() - 1].to);
        let n = root.points.len();
        // The vector from the root to the end of the cut.
        let by = last.uv - root.points[last.index].uv;
        let around = |by: DVec2| (by - step).x / self.context.surface.periods[0].unwrap_or(1.0);
        let turns = around(by).round() as i32;
        let seam_at = |index: usize, by: DVec2| {
            let point = root.points[index];
            ChartPoint { uv: point.uv + by, segment: Segment::Seam, ..point }
        };
        let mut up = vec![seam_at(first.index, DVec2::ZERO)];
        let mut inner = Vec::with_capacity(bridges.len());
        for (k, bridge) in bridges.iter().enumerate() {
            inner.push(self.seam(&mut up, bridge.to.uv));
            if let Some(next) = bridges.get(k + 1) {
                let hole = &holes[bridge.to.node - 1];
                let by = bridge.to.uv - hole.points[bridge.to.index].uv;
                up.extend(part_of(hole, bridge.to.index, next.from.index, by));
            }
        }
        let mut rest = part_of(root, last.index, first.index, by);
        rest.pop();
        up.extend(rest);
        let mut down = vec![seam_at(last.index, by)];
        for (k, bridge) in bridges.iter().enumerate().rev() {
            Self::seam_back(&mut down, &inner[k], DVec2::ZERO);
            if k > 0 {
                let entry = bridges[k - 1].to;
                let hole = &holes[bridge.from.node - 1];
                let by = entry.uv - hole.points[entry.index].uv;
                down.extend(part_of(hole, bridge.from.index, entry.index, by));
            }
        }
        let count = if first.index == last.index { n } else { (last.index + n - first.index) % n };
        down.extend((0..count).map(|k| root.points[(first.index + k) % n]));
        let open = |points: Vec<ChartPoint>, winding: [i32; 2]| OpenLoop { points, winding, outer: true };
        vec![open(up, [turns, 1]), open(down, [-turns, -1])]
    }
}

/// The holes as often as they lie, whole steps on, between a loop and the same loop one step on.
fn repeated(holes: &[OpenLoop], start: &OpenLoop, step: DVec2) -> Vec<OpenLoop> {
    let reach = |points: &[ChartPoint]| {
        let along = points.iter().map(|p| p.uv.y / step.y);
        along.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), t| (low.min(t), high.max(t)))
    };
    let (low, high) = reach(&start.points);
    let of_holes: Vec<(i32, i32)> = holes
        .iter()
        .map(|hole| {
            let own = reach(&hole.points);
            // Steps k with own.0 + k <= high + 1 and own.1 + k >= low.
            ((low - own.1).ceil() as i32, (high + 1.0 - own.0).floor() as i32)
        })
        .collect();
    let most = of_holes.iter().map(|(first, last)| (last - first).clamp(0, MOST_PLACES)).max().unwrap_or(0);
    let place = |k: i32| {
        let moved = move |(hole, (first, last)): (&OpenLoop, &(i32, i32))| {
            let by = step * f64::from((first + k).min(*last));
            OpenLoop { points: shifted(&hole.points, by), ..hole.clone() }
        };
        holes.iter().zip(&of_holes).map(moved)
    };
    (0..=most).flat_map(place).collect()
}

/// The number of places at which a hole is tried, in addition to the first one.
const MOST_PLACES: i32 = 16;
