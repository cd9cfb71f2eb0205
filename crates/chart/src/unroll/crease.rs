//! Cuts along creases: lines of parameter space at which the surface is bent sharply become sides of the
//! polygons.
//!
//! ```text
//!   ┌───────┬──────┐        ┌───────┐ ┌──────┐
//!   │   ┌───┼──┐   │        │   ┌───┘ └──┐   │
//!   │   └───┼──┘   │   →    │   └───┐ ┌──┘   │
//!   └───────┴──────┘        └───────┘ └──────┘
//! ```
//!
//! Both sides of a cut have the same vertices, like those of a seam. The parameters of each side are moved a
//! little away from the crease, so that the surface is evaluated on that side of it.
//!
//! New polygons are walked on each side of the line: along the pieces of boundary on that side and, between
//! two places where the boundary meets the line with the face in between, along the line. Where several
//! pieces leave one point, the walk takes the piece that keeps the interior on the left.

use super::Unroll;
use crate::keys::{ChartPoint, Key, Segment};
use chordal_nurbs::{DVec2, UvBox, math};
use std::collections::BTreeMap;

/// Points nearer to the line than this share of the face are moved onto it, where that moves them by less
/// than the resolution.
const NEAR: f64 = 1e-3;

/// Polygons with more cuts than this are not cut.
const MAX_LINES: usize = 4096;

/// A line of parameter space: the coordinate `axis` has this value.
#[derive(Clone, Copy)]
struct Line {
    axis: usize,
    value: f64,
}

impl Line {
    fn off(&self, p: DVec2) -> f64 {
        p[self.axis] - self.value
    }

    /// Increases along the line in the direction that has the lower side on its left.
    fn along(&self, p: DVec2) -> f64 {
        if self.axis == 0 { p.y } else { -p.x }
    }
}

/// The new key of a point where a line crosses a seam, by the seam's ends: both of its sides get the same.
type Crossings = BTreeMap<(Key, Key), Key>;

/// A step of the walk round a side: from point to point.
#[derive(Clone, Copy)]
struct Step {
    from: usize,
    to: usize,
    segment: Segment,
}

impl Unroll<'_, '_> {
    /// Cuts the face at every crease of its surface that lies inside it.
    pub fn cut_at_creases(&mut self, mut polygons: Vec<Vec<ChartPoint>>) -> Vec<Vec<ChartPoint>> {
        let surface = self.context.surface;
        let extent = UvBox::from_points(polygons.iter().flatten().map(|p| p.uv));
        let mut crossings = Crossings::new();
        for axis in 0..2 {
            let lines = lines_within(&surface.creases[axis], surface.periods[axis], extent, axis);
            for value in lines {
                let line = Line { axis, value };
                polygons = self.cut_along(line, polygons, extent, &mut crossings);
            }
        }
        polygons
    }

    /// Cuts the polygons along one line. They are unchanged where an edge crosses the line between two
    /// samples.
    fn cut_along(
        &mut self,
        line: Line,
        polygons: Vec<Vec<ChartPoint>>,
        extent: UvBox,
        crossings: &mut Crossings,
    ) -> Vec<Vec<ChartPoint>> {
        let near = NEAR * extent.size()[line.axis];
        let snapped: Vec<Vec<ChartPoint>> =
            polygons.iter().map(|p| p.iter().map(|p| self.snapped(line, p, near)).collect()).collect();
        let reaches = |side: f64| snapped.iter().flatten().any(|p| side * line.off(p.uv) > 0.0);
        let aside = self.context.surface.surface.beside_crease(line.axis, line.value);
        match (reaches(-1.0), reaches(1.0)) {
            (true, true) => {}
            (true, false) => return beside(line, snapped, -aside),
            (false, true) => return beside(line, snapped, aside),
            (false, false) => return polygons,
        }
        let crosses_edge = snapped.iter().any(|polygon| {
            (0..polygon.len()).any(|i| {
                let (p, q) = (&polygon[i], &polygon[(i + 1) % polygon.len()]);
                line.off(p.uv) * line.off(q.uv) < 0.0 && matches!(p.segment, Segment::Edge { .. })
            })
        });
        if crosses_edge {
            return polygons;
        }
        let crossed: Vec<Vec<ChartPoint>> =
            snapped.iter().map(|p| self.with_crossings(line, p, crossings)).collect();
        let mut cutter = Cutter::new(line, &crossed);
        for (from, to) in cutter.inner_intervals() {
            let [a, b] = [from, to].map(|i| cutter.points[i].uv);
            let inner = self.along_crease(line, a, b);
            cutter.add_cut(from, to, inner);
        }
        cutter.walk(aside)
    }

    /// The point, moved onto the line where it is nearly on it.
    fn snapped(&self, line: Line, point: &ChartPoint, near: f64) -> ChartPoint {
        let mut on = point.uv;
        on[line.axis] = line.value;
        let close = line.off(point.uv).abs() <= near && {
            let surface = self.context.surface;
            surface.point(on).distance(surface.point(point.uv)) <= self.context.resolution
        };
        if close { ChartPoint { uv: on, ..*point } } else { *point }
    }

    /// The polygon with a point wherever a seam or a pole crosses the line.
    fn with_crossings(
        &mut self,
        line: Line,
        polygon: &[ChartPoint],
        crossings: &mut Crossings,
    ) -> Vec<ChartPoint> {
        let mut points = Vec::with_capacity(polygon.len() + 2);
        for (i, p) in polygon.iter().enumerate() {
            points.push(*p);
            let q = &polygon[(i + 1) % polygon.len()];
            let (a, b) = (line.off(p.uv), line.off(q.uv));
            if a * b >= 0.0 {
                continue;
            }
            let mut uv = p.uv.lerp(q.uv, a / (a - b));
            uv[line.axis] = line.value;
            let key = match p.segment {
                Segment::Pole => p.key,
                _ => *crossings
                    .entry((p.key.min(q.key), p.key.max(q.key)))
                    .or_insert_with(|| self.add_private(uv)),
            };
            points.push(ChartPoint { uv, key, segment: p.segment });
        }
        points
    }

    /// Points strictly between two places on the crease, as many as the more curved of its two sides
    /// requires.
    fn along_crease(&mut self, line: Line, from: DVec2, to: DVec2) -> Vec<(Key, DVec2)> {
        let aside = self.context.surface.surface.beside_crease(line.axis, line.value);
        let sides = [-aside, aside].map(|by| {
            let moved = |mut p: DVec2| {
                p[line.axis] += by;
                p
            };
            self.between(moved(from), moved(to))
        });
        let [low, high] = sides;
        let more = if high.len() > low.len() { high } else { low };
        more.into_iter()
            .map(|mut uv| {
                uv[line.axis] = line.value;
                (self.add_private(uv), uv)
            })
            .collect()
    }
}

/// The creases, at every turn of a closed direction, that lie inside the box.
fn lines_within(creases: &[f64], period: Option<f64>, extent: UvBox, axis: usize) -> Vec<f64> {
    let (low, high) = (extent.min[axis], extent.max[axis]);
    let near = NEAR * (high - low);
    let mut lines: Vec<f64> = creases
        .iter()
        .flat_map(|&value| match period {
            None => vec![value],
            Some(period) => {
                let turns = ((low - value) / period).floor() as i32..=((high - value) / period).ceil() as i32;
                turns.map(|turn| value + f64::from(turn) * period).collect()
            }
        })
        .filter(|&value| value > low - near && value < high + near)
        .collect();
    lines.sort_by(f64::total_cmp);
    lines.truncate(MAX_LINES);
    lines
}

/// A face that ends at a line lies on one side of it: points on the line are moved a little to that side.
fn beside(line: Line, mut polygons: Vec<Vec<ChartPoint>>, aside: f64) -> Vec<Vec<ChartPoint>> {
    for point in polygons.iter_mut().flatten().filter(|p| line.off(p.uv) == 0.0) {
        point.uv[line.axis] += aside;
    }
    polygons
}

/// The polygons around one line.
struct Cutter {
    line: Line,
    points: Vec<ChartPoint>,
    /// The boundary, as steps between points.
    boundary: Vec<Step>,
    /// Cuts along the line in the direction that has the lower side on its left.
    cuts: Vec<Step>,
}

impl Cutter {
    fn new(line: Line, polygons: &[Vec<ChartPoint>]) -> Self {
        let mut points: Vec<ChartPoint> = Vec::new();
        let mut boundary = Vec::new();
        let mut on_line: BTreeMap<(u64, Key), usize> = BTreeMap::new();
        for polygon in polygons {
            let ids: Vec<usize> = polygon
                .iter()
                .map(|p| {
                    let next = points.len();
                    // Loops that touch on the line share their point.
                    let id = if line.off(p.uv) == 0.0 {
                        *on_line.entry((line.along(p.uv).to_bits(), p.key)).or_insert(next)
                    } else {
                        next
                    };
                    if id == next {
                        points.push(*p);
                    }
                    id
                })
                .collect();
            boundary.extend((0..ids.len()).map(|i| Step {
                from: ids[i],
                to: ids[(i + 1) % ids.len()],
                segment: polygon[i].segment,
            }));
        }
        Self { line, points, boundary, cuts: Vec::new() }
    }

    /// Pairs of neighbouring points on the line between which the line lies inside the face, in its
    /// direction.
    fn inner_intervals(&self) -> Vec<(usize, usize)> {
        let Line { axis, value } = self.line;
        let along = |i: usize| self.line.along(self.points[i].uv);
        let mut on: Vec<usize> =
            (0..self.points.len()).filter(|&i| self.line.off(self.points[i].uv) == 0.0).collect();
        on.sort_by(|&i, &j| along(i).total_cmp(&along(j)).then(i.cmp(&j)));
        let is_inside = |middle: f64| {
            let mut inside = false;
            for step in &self.boundary {
                let (p, q) = (self.points[step.from].uv, self.points[step.to].uv);
                let (s, t) = (self.line.along(p), self.line.along(q));
                if (s > middle) == (t > middle) {
                    continue;
                }
                if p[axis] == value && q[axis] == value {
                    return false;
                }
                let crossing = p[axis] + (middle - s) / (t - s) * (q[axis] - p[axis]);
                inside ^= crossing < value;
            }
            inside
        };
        on.windows(2)
            .filter(|w| along(w[0]) < along(w[1]) && is_inside(0.5 * (along(w[0]) + along(w[1]))))
            .map(|w| (w[0], w[1]))
            .collect()
    }

    fn add_cut(&mut self, from: usize, to: usize, inner: Vec<(Key, DVec2)>) {
        let mut last = from;
        for (key, uv) in inner {
            self.points.push(ChartPoint { uv, key, segment: Segment::Seam });
            let next = self.points.len() - 1;
            self.cuts.push(Step { from: last, to: next, segment: Segment::Seam });
            last = next;
        }
        self.cuts.push(Step { from: last, to, segment: Segment::Seam });
    }

    /// The polygons of both sides, moved off the line by `aside`.
    fn walk(&self, aside: f64) -> Vec<Vec<ChartPoint>> {
        let mut polygons = self.walk_side(-1.0, aside);
        polygons.extend(self.walk_side(1.0, aside));
        polygons
    }

    fn walk_side(&self, side: f64, aside: f64) -> Vec<Vec<ChartPoint>> {
        let off = |i: usize| self.line.off(self.points[i].uv);
        let along = |i: usize| self.line.along(self.points[i].uv);
        let belongs = |step: &&Step| {
            let (a, b) = (side * off(step.from), side * off(step.to));
            // A step along the line belongs to the side on its left.
            if a == 0.0 && b == 0.0 {
                side * (along(step.from) - along(step.to)) > 0.0
            } else {
                a >= 0.0 && b >= 0.0
            }
        };
        let mut steps: Vec<Step> = self.boundary.iter().filter(belongs).copied().collect();
        steps.extend(self.cuts.iter().map(|cut| {
            if side < 0.0 { *cut } else { Step { from: cut.to, to: cut.from, segment: cut.segment } }
        }));
        let mut leaving: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for (k, step) in steps.iter().enumerate() {
            leaving.entry(step.from).or_default().push(k);
        }
        let mut used = vec![false; steps.len()];
        let mut polygons = Vec::new();
        for first in 0..steps.len() {
            let mut polygon = Vec::new();
            let mut k = first;
            while !used[k] {
                used[k] = true;
                let step = steps[k];
                let mut point = ChartPoint { segment: step.segment, ..self.points[step.from] };
                if off(step.from) == 0.0 {
                    point.uv[self.line.axis] += side * aside;
                }
                polygon.push(point);
                let free = leaving.get(&step.to).into_iter().flatten().copied().filter(|&n| !used[n]);
                let Some(next) =
                    free.min_by(|&m, &n| self.turn(&step, &steps[m]).total_cmp(&self.turn(&step, &steps[n])))
                else {
                    break;
                };
                k = next;
            }
            if polygon.len() > 2 {
                polygons.push(polygon);
            }
        }
        polygons
    }

    /// The angle clockwise from the way back to the next step: the smallest keeps to the interior on the
    /// left.
    fn turn(&self, step: &Step, next: &Step) -> f64 {
        let at = |i: usize| self.points[i].uv;
        let (back, ahead) = (at(step.from) - at(step.to), at(next.to) - at(next.from));
        let angle = math::angle_to(ahead, back);
        if angle <= 0.0 { angle + std::f64::consts::TAU } else { angle }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polygon(points: &[(f64, f64)], first: u32) -> Vec<ChartPoint> {
        let point = |(i, &(u, v)): (usize, &(f64, f64))| ChartPoint {
            uv: DVec2::new(u, v),
            key: Key::Vertex(first + i as u32),
            segment: Segment::Seam,
        };
        points.iter().enumerate().map(point).collect()
    }

    fn area(polygon: &[ChartPoint]) -> f64 {
        let n = polygon.len();
        (0..n).map(|i| 0.5 * polygon[i].uv.perp_dot(polygon[(i + 1) % n].uv)).sum()
    }

    /// Cuts without points inside; every polygon's area, sorted.
    fn areas(line: Line, polygons: &[Vec<ChartPoint>]) -> Vec<f64> {
        let mut cutter = Cutter::new(line, polygons);
        for (from, to) in cutter.inner_intervals() {
            cutter.add_cut(from, to, Vec::new());
        }
        let mut areas: Vec<f64> = cutter.walk(0.0).iter().map(|p| area(p)).collect();
        areas.sort_by(f64::total_cmp);
        areas
    }

    #[test]
    fn a_hole_on_the_line_opens() {
        let outer = polygon(&[(0., 0.), (2., 0.), (4., 0.), (4., 4.), (2., 4.), (0., 4.)], 0);
        let hole = polygon(&[(1., 1.), (1., 3.), (2., 3.), (3., 3.), (3., 1.), (2., 1.)], 10);
        let both = [outer.clone(), hole];
        assert_eq!(areas(Line { axis: 0, value: 2.0 }, &both), [6.0, 6.0]);
        // A hole on one side stays a hole.
        let aside = polygon(&[(0.5, 1.), (0.5, 3.), (1., 3.), (1., 1.)], 10);
        assert_eq!(areas(Line { axis: 0, value: 2.0 }, &[outer, aside]), [-1.0, 8.0, 8.0]);
    }

    #[test]
    fn both_axes_and_touching_corners() {
        let outer = polygon(&[(0., 0.), (4., 0.), (4., 2.), (4., 4.), (0., 4.), (0., 2.)], 0);
        // The hole touches the line from above with one side, and from below with a corner.
        let above = polygon(&[(1., 2.), (1., 3.), (2., 3.), (2., 2.)], 10);
        let below = polygon(&[(3., 1.), (2.5, 1.5), (3., 2.), (3.5, 1.5)], 20);
        let found = areas(Line { axis: 1, value: 2.0 }, &[outer, above, below]);
        let total: f64 = found.iter().sum();
        assert!((total - (16.0 - 1.0 - 0.5)).abs() < 1e-12, "{found:?}");
        assert!(found.iter().any(|&a| (a - 7.0).abs() < 1e-12), "{found:?}");
    }

    #[test]
    fn a_bay_makes_three_pieces() {
        let u = [
            (0., 0.),
            (1., 0.),
            (3., 0.),
            (3., 3.),
            (1., 3.),
            (0., 3.),
            (0., 2.),
            (1., 2.),
            (2., 2.),
            (2., 1.),
            (1., 1.),
            (0., 1.),
        ];
        assert_eq!(areas(Line { axis: 0, value: 1.0 }, &[polygon(&u, 0)]), [1.0, 1.0, 5.0]);
    }
}
