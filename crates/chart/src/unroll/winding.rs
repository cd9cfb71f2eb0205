//! Polygons from loops that wind round a closed surface: cut open along a seam, in pairs, or closed by a
//! pole.
//!
//! Holes that the cut leads through become sides of the polygon and are taken out of the list of holes.

use super::cuts::{Bridge, BridgeEnd, Cuts, Side, nearest_period};
use super::strip::move_into_strip;
use super::{Unroll, along_axis, mean, shifted};
use crate::keys::{ChartPoint, Key, Segment};
use crate::trimmed_face::OpenLoop;
use chordal_brep::MeshIssue;
use chordal_nurbs::{DVec2, math};

/// The number of shortest straight cuts that are tried before a cut through holes.
const STRAIGHT_CUTS: usize = 2000;

impl Unroll<'_, '_> {
    /// The polygon of one or two loops that wind round the surface.
    pub(super) fn cut(
        &mut self,
        mut winding: Vec<OpenLoop>,
        holes: &mut Vec<OpenLoop>,
    ) -> Result<Vec<ChartPoint>, MeshIssue> {
        let axis = usize::from(winding[0].winding[0] == 0);
        let across = 1 - axis;
        if winding.len() == 2 && winding[0].winding[across] != 0 {
            return self.slanted_band(winding, holes);
        }
        if winding.iter().any(|l| l.winding[axis].abs() != 1 || l.winding[across] != 0) {
            return Err(MeshIssue::EncirclesRepeatedly);
        }
        let period = self.context.surface.periods[axis].ok_or(MeshIssue::EncirclesOpenSurface)?;
        // Along u the interior is above a loop that runs upwards in u; along v it is on the other side.
        let is_lower = |l: &OpenLoop| (l.winding[axis] > 0) == (axis == 0);
        match winding.len() {
            1 => {
                let mut a = winding.remove(0);
                let value = mean(&a.points, across);
                let value = match self.pole_beyond(across, value, is_lower(&a)) {
                    Some(value) => value,
                    None => {
                        // The face is unbounded on the side that the loop states: its direction is wrong in
                        // the file.
                        a.reverse();
                        self.reversed = true;
                        self.pole_beyond(across, value, is_lower(&a)).ok_or(MeshIssue::UnboundedFace)?
                    }
                };
                let turn = along_axis(axis, period * f64::from(a.winding[axis]));
                if let Some(period) = self.context.surface.periods[across] {
                    let step =
                        along_axis(across, if value > mean(&a.points, across) { period } else { -period });
                    move_into_strip(holes, &a, turn, step);
                }
                Ok(self.between_sides([Side::Loop(&a), Side::Pole(value)], axis, turn, holes))
            }
            2 => {
                let (a, b) = self.pair(winding, axis);
                let turn = along_axis(axis, period * f64::from(a.winding[axis]));
                if let Some(period) = self.context.surface.periods[across] {
                    move_into_strip(holes, &a, turn, along_axis(across, period));
                }
                Ok(self.between_sides([Side::Loop(&a), Side::Loop(&b)], axis, turn, holes))
            }
            loops => Err(MeshIssue::ManyEncirclingLoops { loops }),
        }
    }

    /// The first pole line above or below a value, in any period of a closed direction.
    fn pole_beyond(&self, axis: usize, value: f64, upper: bool) -> Option<f64> {
        let surface = self.context.surface;
        let poles = surface.poles.iter().filter(|p| p.axis == axis).map(|p| p.value);
        let distance = |pole: f64| {
            let ahead = if upper { pole - value } else { value - pole };
            surface.periods[axis].map_or(ahead, |period| ahead.rem_euclid(period))
        };
        let nearest = poles.map(distance).filter(|&d| d > 0.0).min_by(f64::total_cmp)?;
        Some(if upper { value + nearest } else { value - nearest })
    }

    /// The polygon of two loops that wind round a torus both ways at once.
    ///
    /// With w the whole turns of the first, p ↦ w × p (in turns) tells how far across a place lies: the other
    /// loop is moved by whole turns to the first place on the left.
    fn slanted_band(
        &mut self,
        mut winding: Vec<OpenLoop>,
        holes: &mut Vec<OpenLoop>,
    ) -> Result<Vec<ChartPoint>, MeshIssue> {
        let mut b = winding.remove(1);
        let a = winding.remove(0);
        let [Some(pu), Some(pv)] = self.context.surface.periods else {
            return Err(MeshIssue::EncirclesOpenSurface);
        };
        let periods = DVec2::new(pu, pv);
        if b.winding == a.winding {
            self.reversed = true;
            b.reverse();
        }
        let [i, j] = a.winding;
        // Whole turns that lead exactly one step across; there are none for a loop that winds several times.
        let reach = i.abs().max(j.abs());
        let steps = (-reach..=reach).flat_map(|m| (-reach..=reach).map(move |n| (m, n)));
        let step = steps.filter(|&(m, n)| i * n - j * m == 1).min_by_key(|&(m, n)| m.abs() + n.abs());
        let (Some((m, n)), true) = (step, b.winding == [-i, -j]) else {
            return Err(MeshIssue::EncirclingLoopsDiffer);
        };
        let turns = |(m, n): (i32, i32)| DVec2::new(f64::from(m), f64::from(n));
        let across = |p: DVec2| turns((i, j)).perp_dot(p / periods);
        let of_loop = |l: &OpenLoop| across(DVec2::new(mean(&l.points, 0), mean(&l.points, 1)));
        let by = -(of_loop(&b) - of_loop(&a)).floor();
        let step = turns((m, n)) * periods;
        b.points = shifted(&b.points, step * by);
        move_into_strip(holes, &a, turns((i, j)) * periods, step);
        Ok(self.between_sides([Side::Loop(&a), Side::Loop(&b)], 0, turns((i, j)) * periods, holes))
    }

    /// The lower loop, and the upper one moved above it.
    fn pair(&mut self, mut winding: Vec<OpenLoop>, axis: usize) -> (OpenLoop, OpenLoop) {
        let across = 1 - axis;
        let mut b = winding.remove(1);
        let mut a = winding.remove(0);
        let is_lower = |l: &OpenLoop| (l.winding[axis] > 0) == (axis == 0);
        if !is_lower(&a) && is_lower(&b) {
            std::mem::swap(&mut a, &mut b);
        }
        match self.context.surface.periods[across] {
            Some(period) => {
                let gap = (mean(&b.points, across) - mean(&a.points, across)).rem_euclid(period);
                let by = mean(&a.points, across) + gap - mean(&b.points, across);
                b.points = shifted(&b.points, along_axis(across, by));
            }
            // On an open surface the parameters decide which loop is lower, whatever the file states.
            None if mean(&a.points, across) > mean(&b.points, across) => std::mem::swap(&mut a, &mut b),
            None => {}
        }
        if !is_lower(&a) {
            self.reversed = true;
            a.reverse();
        }
        if is_lower(&b) {
            b.reverse();
        }
        (a, b)
    }

    /// `a` from point `i` once round, its first point repeated at the end, moved by the whole turn `by` on.
    fn once_round(a: &OpenLoop, i: usize, by: DVec2) -> Vec<ChartPoint> {
        let n = a.points.len();
        let mut points: Vec<ChartPoint> = a.points[i..].to_vec();
        points.extend(shifted(&a.points[..i], by));
        points.push(ChartPoint { uv: a.points[i].uv + by, ..a.points[i] });
        debug_assert_eq!(points.len(), n + 1);
        points
    }

    /// A seam from the end of `polygon` to the chart point `to`, and the keys and places of its inner points.
    pub(super) fn seam(&mut self, polygon: &mut Vec<ChartPoint>, to: DVec2) -> Vec<(Key, DVec2)> {
        let Some(last) = polygon.last_mut() else { return Vec::new() };
        last.segment = Segment::Seam;
        let from = last.uv;
        let inner: Vec<(Key, DVec2)> =
            self.between(from, to).into_iter().map(|uv| (self.add_private(uv), uv)).collect();
        polygon.extend(inner.iter().map(|&(key, uv)| ChartPoint { uv, key, segment: Segment::Seam }));
        inner
    }

    /// The same seam back, seen from its other side.
    pub(super) fn seam_back(polygon: &mut Vec<ChartPoint>, inner: &[(Key, DVec2)], by: DVec2) {
        if let Some(last) = polygon.last_mut() {
            last.segment = Segment::Seam;
        }
        polygon.extend(inner.iter().rev().map(|&(key, uv)| ChartPoint {
            uv: uv + by,
            key,
            segment: Segment::Seam,
        }));
    }

    /// The polygon of the face between two sides, the first of which ends one `turn` beyond its start.
    pub(super) fn between_sides(
        &mut self,
        sides: [Side<'_>; 2],
        axis: usize,
        turn: DVec2,
        holes: &mut Vec<OpenLoop>,
    ) -> Vec<ChartPoint> {
        let place = match (sides, holes.first()) {
            ([Side::Loop(open), _], _) | ([Side::Pole(_), Side::Loop(open)], _) | (_, Some(open)) => {
                open.points[0].uv
            }
            _ => DVec2::ZERO,
        };
        let lengths = self.lengths_at(place);
        let cuts = Cuts::new(sides, holes, axis, turn, lengths, self.context.surface.periods);
        let straight = self.straight_cut(&cuts, sides, axis, turn, lengths, holes.len());
        let bridges = match straight {
            Ok(bridge) => vec![bridge],
            // If no bridge is free, the loops cross each other; a later stage requests finer chords.
            Err(shortest) => cuts.chain().unwrap_or_else(|| vec![shortest]),
        };
        drop(cuts);
        let polygon = self.cut_open(sides, &bridges, turn, holes);
        let mut passed: Vec<usize> = bridges[1..].iter().map(|bridge| bridge.from.node - 1).collect();
        passed.sort_unstable();
        for &hole in passed.iter().rev() {
            holes.remove(hole);
        }
        polygon
    }

    /// Lengths in space of steps in u and v at a place.
    pub(super) fn lengths_at(&self, p_uv: DVec2) -> DVec2 {
        let (_, du, dv) = self.context.surface.surface.jet1(self.context.surface.wrapped(p_uv));
        DVec2::new(du.length(), dv.length())
    }

    /// The straight cut that crosses no loop: from the start of a loop to a pole, or the shortest between two
    /// loops. `Err`: the one that would be taken if nothing were in the way.
    fn straight_cut(
        &self,
        cuts: &Cuts<'_>,
        sides: [Side<'_>; 2],
        axis: usize,
        turn: DVec2,
        lengths: DVec2,
        holes: usize,
    ) -> Result<Bridge, Bridge> {
        let stop = |node: usize, index: usize, uv: DVec2| BridgeEnd { node, index, uv };
        let checked = |bridge: Bridge| {
            if cuts.is_free(bridge.from.uv, bridge.to.uv) { Ok(bridge) } else { Err(bridge) }
        };
        match sides {
            [Side::Loop(a), Side::Loop(b)] => {
                let between = |&(_, i, j, turns): &(f64, usize, usize, f64)| Bridge {
                    from: stop(0, i, a.points[i].uv),
                    to: stop(holes + 1, j, b.points[j].uv + turn * turns),
                };
                let candidates = straight_cuts(a, b, turn, lengths);
                let free = candidates
                    .iter()
                    .take(STRAIGHT_CUTS)
                    .map(between)
                    .find_map(|bridge| checked(bridge).ok());
                free.ok_or_else(|| between(&candidates[0]))
            }
            [Side::Loop(a), Side::Pole(value)] => {
                let from = a.points[0].uv;
                let mut to = from;
                to[1 - axis] = value;
                checked(Bridge { from: stop(0, 0, from), to: stop(holes + 1, 0, to) })
            }
            [Side::Pole(value), other] => {
                let mut from = match other {
                    Side::Loop(b) => b.points[0].uv,
                    Side::Pole(_) => self.context.surface.domain().min,
                };
                let mut to = from;
                from[1 - axis] = value;
                if let Side::Pole(end) = other {
                    to[1 - axis] = end;
                }
                checked(Bridge { from: stop(0, 0, from), to: stop(holes + 1, 0, to) })
            }
        }
    }

    /// The polygon along the first side, up the cut, back along the second side and down the cut.
    fn cut_open(
        &mut self,
        sides: [Side<'_>; 2],
        bridges: &[Bridge],
        turn: DVec2,
        holes: &[OpenLoop],
    ) -> Vec<ChartPoint> {
        let (start, end) = (bridges[0].from, bridges[bridges.len() - 1].to);
        // The second side begins where the first one ends, one turn on, and runs back.
        let end = match sides[1] {
            Side::Loop(b) => {
                let own = b.points[end.index].uv;
                BridgeEnd { uv: own + turn * (nearest_period(end.uv - own, turn) + 1.0), ..end }
            }
            Side::Pole(_) => BridgeEnd { uv: end.uv + turn, ..end },
        };
        let mut polygon = self.once_along(sides[0], start, turn);
        let mut inner = Vec::with_capacity(bridges.len());
        for (k, bridge) in bridges.iter().enumerate() {
            let to = if k + 1 == bridges.len() { end.uv } else { bridge.to.uv + turn };
            inner.push(self.seam(&mut polygon, to));
            if let Some(next) = bridges.get(k + 1) {
                let hole = &holes[bridge.to.node - 1];
                let by = bridge.to.uv - hole.points[bridge.to.index].uv + turn;
                polygon.extend(part_of(hole, bridge.to.index, next.from.index, by));
            }
        }
        polygon.extend(self.once_along(sides[1], end, -turn));
        for (k, bridge) in bridges.iter().enumerate().rev() {
            Self::seam_back(&mut polygon, &inner[k], -turn);
            if k > 0 {
                let hole = &holes[bridge.from.node - 1];
                let entry = bridges[k - 1].to;
                let by = entry.uv - hole.points[entry.index].uv;
                polygon.extend(part_of(hole, bridge.from.index, entry.index, by));
            }
        }
        polygon
    }

    /// One side of the face from a stop on it to the same place one `turn` on.
    fn once_along(&mut self, side: Side<'_>, from: BridgeEnd, turn: DVec2) -> Vec<ChartPoint> {
        match side {
            Side::Loop(open) => {
                let turns = nearest_period(from.uv - open.points[from.index].uv, turn);
                let moved = OpenLoop { points: shifted(&open.points, turn * turns), ..OpenLoop::default() };
                Self::once_round(&moved, from.index, turn)
            }
            Side::Pole(_) => {
                let key = self.pole_key(from.uv);
                vec![
                    ChartPoint { uv: from.uv, key, segment: Segment::Pole },
                    ChartPoint { uv: from.uv + turn, key, segment: Segment::Seam },
                ]
            }
        }
    }
}

/// The points of a hole from one to another, in its own direction; from one to itself all round.
pub(super) fn part_of(hole: &OpenLoop, from: usize, to: usize, by: DVec2) -> Vec<ChartPoint> {
    let n = hole.points.len();
    let count = if from == to { 0 } else { (to + n - from) % n };
    (0..=count).map(|k| hole.points[(from + k) % n]).map(|p| ChartPoint { uv: p.uv + by, ..p }).collect()
}

/// Points of two loops to cut between, and by how many turns the second one moves, the shortest first:
/// (square of the length, point of the first, point of the second, turns).
fn straight_cuts(a: &OpenLoop, b: &OpenLoop, turn: DVec2, lengths: DVec2) -> Vec<(f64, usize, usize, f64)> {
    let stride = |n: usize| n.div_ceil(400);
    let mut candidates = Vec::new();
    for i in (0..a.points.len()).step_by(stride(a.points.len())) {
        for j in (0..b.points.len()).step_by(stride(b.points.len())) {
            let d = b.points[j].uv - a.points[i].uv;
            let turns = -nearest_period(d, turn);
            let d = d + turn * turns;
            candidates.push((math::square(d.x * lengths.x) + math::square(d.y * lengths.y), i, j, turns));
        }
    }
    candidates.sort_by(|x, y| x.0.total_cmp(&y.0));
    // Of cuts whose costs differ by rounding only, the one between the first samples.
    let scale = candidates[0].0;
    candidates
        .chunk_by_mut(|x, y| y.0 - x.0 <= 1e-9 * (scale + x.0))
        .for_each(|equal| equal.sort_by_key(|c| (a.points[c.1].key, b.points[c.2].key)));
    candidates
}

/// Where to cut a closed direction straight so that the seam keeps away from all holes, and how far it does:
/// at `start` if none is near, and 0 where no such place exists.
pub(super) fn seam_beside(holes: &[OpenLoop], axis: usize, period: f64, start: f64) -> (f64, f64) {
    const PLACES: usize = 64;
    if holes.is_empty() {
        return (start, period);
    }
    let extent = |hole: &OpenLoop| {
        let low = hole.points.iter().fold(f64::INFINITY, |m, p| m.min(p.uv[axis]));
        let high = hole.points.iter().fold(f64::NEG_INFINITY, |m, p| m.max(p.uv[axis]));
        (low, high - low)
    };
    let extents: Vec<(f64, f64)> = holes.iter().map(extent).collect();
    let distance = |place: f64| {
        extents.iter().fold(period, |nearest, &(low, length)| {
            let behind = (place - low).rem_euclid(period);
            if behind <= length { 0.0 } else { nearest.min(behind - length).min(period - behind) }
        })
    };
    let better = |best: (f64, f64), place: f64| {
        let d = distance(place);
        // Of places that differ by rounding only, the first.
        if d > best.1 + 1e-9 * period { (place, d) } else { best }
    };
    let places = (0..PLACES).map(|k| start + period * k as f64 / PLACES as f64);
    let best = places.fold((start, distance(start)), better);
    if best.1 > 0.0 {
        return best;
    }
    // The gaps between holes may be narrower than that: the middle of the widest.
    let next = |end: f64| extents.iter().map(|e| (e.0 - end).rem_euclid(period)).fold(period, f64::min);
    let ends = extents.iter().map(|&(low, length)| low + length);
    ends.map(|end| start + (end + 0.5 * next(end) - start).rem_euclid(period)).fold(best, better)
}
