//! The natural boundary: the whole domain of a surface as the outer loop of a face without one.

use super::cuts::Side;
use super::strip::move_into_strip;
use super::winding::seam_beside;
use super::{Unroll, along_axis, area, shifted};
use crate::keys::{ChartPoint, Key, Segment};
use crate::trimmed_face::OpenLoop;
use chordal_brep::MeshIssue;
use chordal_nurbs::{BoxSide, DVec2, UvBox};

impl Unroll<'_, '_> {
    /// True for a face without loops, and for a face on a closed surface whose loops are all holes.
    pub(super) fn needs_natural_boundary(&self, plain: &[OpenLoop]) -> bool {
        let Some(largest) =
            plain.iter().max_by(|a, b| area(&a.points).abs().total_cmp(&area(&b.points).abs()))
        else {
            return true;
        };
        let closed = |axis: usize| {
            self.context.surface.periods[axis].is_some()
                || self.context.surface.poles.iter().filter(|p| p.axis == axis).count() >= 2
        };
        closed(0) && closed(1) && area(&largest.points) < 0.0 && !runs_along_seam(largest)
    }

    /// The whole domain of the surface.
    pub(super) fn natural_boundary(
        &mut self,
        holes: &mut Vec<OpenLoop>,
    ) -> Result<Vec<ChartPoint>, MeshIssue> {
        let domain = self.context.surface.domain();
        if !domain.is_finite() {
            return Err(MeshIssue::UnboundedSurface);
        }
        let UvBox { mut min, mut max } = domain;
        let mut is_free = [true; 2];
        for axis in 0..2 {
            if let Some(period) = self.context.surface.periods[axis] {
                let (place, distance) = seam_beside(holes, axis, period, min[axis]);
                min[axis] = place;
                max[axis] = place + period;
                is_free[axis] = distance > 0.0;
            }
        }
        match is_free {
            [true, true] => {}
            [false, true] => {
                if let Some(polygon) = self.cut_through_holes(0, UvBox { min, max }, holes) {
                    return Ok(polygon);
                }
            }
            [false, false] => {
                if let Some(polygon) = self.cut_twice(holes) {
                    return Ok(polygon);
                }
            }
            [true, false] => {
                if let Some(polygon) = self.cut_through_holes(1, UvBox { min, max }, holes) {
                    return Ok(polygon);
                }
            }
        }
        Ok(self.rectangle(UvBox { min, max }))
    }

    /// The polygon around a box of parameters that is the whole surface, cut open straight.
    fn rectangle(&mut self, whole: UvBox) -> Vec<ChartPoint> {
        let surface = self.context.surface;
        let (corners, sides) = (whole.corners(), whole.sides());
        let poles = sides.map(|side| side.is_pole(&whole, &surface.poles));
        let keys = self.corner_keys(&corners, &poles);
        // Opposite sides of a closed direction share their inner points.
        let mut inner: [Vec<(Key, DVec2)>; 4] = Default::default();
        for k in 0..4 {
            let BoxSide { from, to, .. } = sides[k];
            let is_seam = !poles[k] && surface.periods[sides[k].axis()].is_some();
            let twin = (k >= 2 && is_seam).then(|| k - 2);
            inner[k] = if poles[k] {
                Vec::new()
            } else if let Some(twin) = twin {
                let by = to - sides[twin].from;
                inner[twin].iter().rev().map(|&(key, uv)| (key, uv + by)).collect()
            } else {
                self.between(from, to).into_iter().map(|uv| (self.add_private(uv), uv)).collect()
            };
        }
        let mut polygon = Vec::new();
        for k in 0..4 {
            let segment = if poles[k] { Segment::Pole } else { Segment::Seam };
            polygon.push(ChartPoint { uv: corners[k], key: keys[k], segment });
            polygon.extend(inner[k].iter().map(|&(key, uv)| ChartPoint { uv, key, segment }));
        }
        polygon
    }

    /// The boundary of the whole surface if every straight cut across the closed direction `axis` crosses a
    /// hole. The cut passes through holes, from pole to pole, or between the two sides of a straight cut
    /// along `axis`. `None` on surfaces that have neither poles nor a second closed direction.
    fn cut_through_holes(
        &mut self,
        axis: usize,
        domain: UvBox,
        holes: &mut Vec<OpenLoop>,
    ) -> Option<Vec<ChartPoint>> {
        let across = 1 - axis;
        let turn = along_axis(axis, domain.size()[axis]);
        let (low, high) = (domain.min[across], domain.max[across]);
        let surface = self.context.surface;
        if let Some(period) = surface.periods[across] {
            // The straight cut is a loop on both of its sides.
            let from = domain.min;
            let mut points = vec![ChartPoint { uv: from, key: self.pole_key(from), segment: Segment::Seam }];
            for uv in self.between(from, from + turn) {
                points.push(ChartPoint { uv, key: self.add_private(uv), segment: Segment::Seam });
            }
            let mut winding = [0, 0];
            winding[axis] = 1;
            let mut a = OpenLoop { points, winding, outer: true };
            let step = along_axis(across, period);
            move_into_strip(holes, &a, turn, step);
            let points = shifted(&a.points, step);
            let mut b = OpenLoop { points, ..a.clone() };
            let first = if axis == 0 { &mut b } else { &mut a };
            first.reverse();
            let turn = if axis == 0 { turn } else { -turn };
            return Some(self.between_sides([Side::Loop(&a), Side::Loop(&b)], axis, turn, holes));
        }
        let is_pole = |value: f64| {
            let tiny = 1e-9 * (high - low);
            surface.poles.iter().any(|p| p.axis == across && (p.value - value).abs() <= tiny)
        };
        // The interior is on the left of increasing u and on the right of increasing v.
        let turn = if axis == 0 { turn } else { -turn };
        (is_pole(low) && is_pole(high))
            .then(|| self.between_sides([Side::Pole(low), Side::Pole(high)], axis, turn, holes))
    }

    /// One key per corner of the domain; corners that poles or closed directions identify share theirs.
    fn corner_keys(&mut self, corners: &[DVec2; 4], poles: &[bool; 4]) -> [Key; 4] {
        let [closed_u, closed_v] = self.context.surface.periods.map(|p| p.is_some());
        let mut group = [0usize, 1, 2, 3];
        let mut join = |a: usize, b: usize| {
            let (x, y) = (group[a].min(group[b]), group[a].max(group[b]));
            group.iter_mut().for_each(|g| *g = if *g == y { x } else { *g });
        };
        for k in 0..4 {
            if poles[k] {
                join(k, (k + 1) % 4);
            }
        }
        if closed_u {
            join(0, 1);
            join(3, 2);
        }
        if closed_v {
            join(0, 3);
            join(1, 2);
        }
        let mut keys = [Key::Private(0); 4];
        for k in 0..4 {
            keys[k] = if group[k] == k { self.pole_key(corners[k]) } else { keys[group[k]] };
        }
        keys
    }
}

/// True where a loop uses an edge twice: the face lies on both sides of it, so the loop encloses the face and
/// no hole.
fn runs_along_seam(open: &OpenLoop) -> bool {
    let first = |p: &ChartPoint| match p.segment {
        Segment::Edge { edge, chord: 0 } => Some(edge),
        _ => None,
    };
    let mut edges: Vec<u32> = open.points.iter().filter_map(first).collect();
    edges.sort_unstable();
    edges.windows(2).any(|pair| pair[0] == pair[1])
}
