//! Polygons from loops that wind round a closed surface: cut open along a seam, in pairs, or closed by a pole.

use super::{Unroll, along_axis, mean, shifted};
use crate::chart::OpenLoop;
use crate::keys::{ChartPoint, Key, Segment};
use chordal_brep::MeshIssue;
use chordal_nurbs::DVec2;

impl Unroll<'_, '_> {
    /// The polygon of one or two loops that wind round the surface.
    pub(super) fn cut(
        &mut self,
        mut winding: Vec<OpenLoop>,
        holes: &[OpenLoop],
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
                        // Nothing closes it on the side it claims: the file has it the wrong way round.
                        a.reverse();
                        self.reversed = true;
                        self.pole_beyond(across, value, is_lower(&a)).ok_or(MeshIssue::UnboundedFace)?
                    }
                };
                Ok(self.cap(&a, axis, period, value))
            }
            2 => {
                let (a, b) = self.pair(winding, axis);
                Ok(self.band(&a, &b, along_axis(axis, period * f64::from(a.winding[axis])), holes))
            }
            loops => Err(MeshIssue::ManyEncirclingLoops { loops }),
        }
    }

    /// The first pole line above or below a value, in whichever turn of a closed direction.
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
    /// With w the whole turns of the first, p ↦ w × p (in turns) tells how far across a place lies: the other loop is moved by
    /// whole turns to the first place on the left.
    fn slanted_band(
        &mut self,
        mut winding: Vec<OpenLoop>,
        holes: &[OpenLoop],
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
        let across = |l: &OpenLoop| {
            let p = DVec2::new(mean(&l.points, 0), mean(&l.points, 1)) / periods;
            turns((i, j)).perp_dot(p)
        };
        let by = -(across(&b) - across(&a)).floor();
        b.points = shifted(&b.points, turns((m, n)) * by * periods);
        Ok(self.band(&a, &b, turns((i, j)) * periods, holes))
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
            // On an open surface the values tell which is lower, whatever the file says.
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
    fn seam(&mut self, polygon: &mut Vec<ChartPoint>, to: DVec2) -> Vec<(Key, DVec2)> {
        let Some(last) = polygon.last_mut() else { return Vec::new() };
        last.segment = Segment::Seam;
        let from = last.uv;
        let inner: Vec<(Key, DVec2)> =
            self.between(from, to).into_iter().map(|uv| (self.add_private(uv), uv)).collect();
        polygon.extend(inner.iter().map(|&(key, uv)| ChartPoint { uv, key, segment: Segment::Seam }));
        inner
    }

    /// The same seam back, seen from its other side.
    fn seam_back(polygon: &mut Vec<ChartPoint>, inner: &[(Key, DVec2)], by: DVec2) {
        if let Some(last) = polygon.last_mut() {
            last.segment = Segment::Seam;
        }
        polygon.extend(inner.iter().rev().map(|&(key, uv)| ChartPoint {
            uv: uv + by,
            key,
            segment: Segment::Seam,
        }));
    }

    /// The region between a loop and the pole line at `value`.
    fn cap(&mut self, a: &OpenLoop, axis: usize, period: f64, value: f64) -> Vec<ChartPoint> {
        let across = 1 - axis;
        let by = along_axis(axis, -period * f64::from(a.winding[axis]));
        let mut polygon = Self::once_round(a, 0, -by);
        let mut corner = polygon[polygon.len() - 1].uv;
        corner[across] = value;
        let inner = self.seam(&mut polygon, corner);
        let key = self.pole_key(corner);
        polygon.push(ChartPoint { uv: corner, key, segment: Segment::Pole });
        polygon.push(ChartPoint { uv: corner + by, key, segment: Segment::Seam });
        Self::seam_back(&mut polygon, &inner, by);
        polygon
    }

    /// The region between two loops, the first of which ends one `turn` beyond its start.
    fn band(&mut self, a: &OpenLoop, b: &OpenLoop, turn: DVec2, holes: &[OpenLoop]) -> Vec<ChartPoint> {
        let (i, j, turns) = self.bridge(a, b, turn, holes);
        let mut polygon = Self::once_round(a, i, turn);
        // The upper loop begins where the lower one ended, one period on, and runs back.
        let moved =
            OpenLoop { points: shifted(&b.points, turn * (turns + 1.0)), winding: b.winding, outer: false };
        let back = Self::once_round(&moved, j, -turn);
        let inner = self.seam(&mut polygon, back[0].uv);
        polygon.extend(back);
        Self::seam_back(&mut polygon, &inner, -turn);
        polygon
    }

    /// Points of the two loops to cut between, and by how many turns the upper one moves: the shortest cut that crosses no loop.
    fn bridge(&self, a: &OpenLoop, b: &OpenLoop, turn: DVec2, holes: &[OpenLoop]) -> (usize, usize, f64) {
        let stride = |n: usize| n.div_ceil(400);
        let (du, dv) = {
            let (_, du, dv) = self.context.surface.surface.jet1(a.points[0].uv);
            (du.length(), dv.length())
        };
        let mut candidates = Vec::new();
        for i in (0..a.points.len()).step_by(stride(a.points.len())) {
            for j in (0..b.points.len()).step_by(stride(b.points.len())) {
                let d = b.points[j].uv - a.points[i].uv;
                let turns = -whole_turns(d, turn);
                let d = d + turn * turns;
                candidates.push(((d.x * du).powi(2) + (d.y * dv).powi(2), i, j, turns));
            }
        }
        candidates.sort_by(|x, y| x.0.total_cmp(&y.0));
        // Of cuts that only rounding tells apart, the one between the first samples.
        let scale = candidates[0].0;
        candidates
            .chunk_by_mut(|x, y| y.0 - x.0 <= 1e-9 * (scale + x.0))
            .for_each(|equal| equal.sort_by_key(|c| (a.points[c.1].key, b.points[c.2].key)));
        let crosses = |&&(_, i, j, turns): &&(f64, usize, usize, f64)| {
            let (p, q) = (a.points[i].uv, b.points[j].uv + turn * turns);
            !holes.iter().chain([a, b]).any(|hole| self.crosses_loop(p, q, hole, turn))
        };
        let best = candidates.iter().take(2000).find(crosses).unwrap_or(&candidates[0]);
        (best.1, best.2, best.3)
    }

    /// True where the segment p–q crosses the loop in any turn.
    fn crosses_loop(&self, p: DVec2, q: DVec2, hole: &OpenLoop, turn: DVec2) -> bool {
        let n = hole.points.len();
        let side = |a: DVec2, b: DVec2, c: DVec2| (b - a).perp_dot(c - a) > 0.0;
        let tiny = 1e-12 * turn.length();
        let near = |x: DVec2, y: DVec2| x.abs_diff_eq(y, tiny);
        let winding = |axis: usize| {
            self.context.surface.periods[axis].map_or(0.0, |p| p * f64::from(hole.winding[axis]))
        };
        let closing = DVec2::new(winding(0), winding(1));
        [-1.0, 0.0, 1.0].iter().any(|extra| {
            let base = turn * (whole_turns(p - hole.points[0].uv, turn) + extra);
            (0..n).any(|i| {
                let (a, mut b) = (hole.points[i].uv + base, hole.points[(i + 1) % n].uv + base);
                if i + 1 == n {
                    b += closing;
                }
                let touches = [a, b].iter().any(|&x| near(x, p) || near(x, q));
                !touches && side(p, q, a) != side(p, q, b) && side(a, b, p) != side(a, b, q)
            })
        })
    }
}

/// Where to cut a closed direction so that the seam keeps away from all holes: at `start` if none is near.
pub(super) fn seam_beside(holes: &[OpenLoop], axis: usize, period: f64, start: f64) -> f64 {
    const PLACES: usize = 64;
    if holes.is_empty() {
        return start;
    }
    let distance = |place: f64| {
        holes.iter().fold(period, |nearest, hole| {
            let low = hole.points.iter().fold(f64::INFINITY, |m, p| m.min(p.uv[axis]));
            let high = hole.points.iter().fold(f64::NEG_INFINITY, |m, p| m.max(p.uv[axis]));
            let behind = (place - low).rem_euclid(period);
            if behind <= high - low { 0.0 } else { nearest.min(behind - (high - low)).min(period - behind) }
        })
    };
    let places = (0..PLACES).map(|k| start + period * k as f64 / PLACES as f64);
    places
        .fold((start, distance(start)), |best, place| {
            let d = distance(place);
            // Of places that only rounding tells apart, the first.
            if d > best.1 + 1e-9 * period { (place, d) } else { best }
        })
        .0
}

/// The whole number of turns nearest to a vector.
fn whole_turns(d: DVec2, turn: DVec2) -> f64 {
    (d.dot(turn) / turn.length_squared()).round()
}
