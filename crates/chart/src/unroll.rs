//! The loops of a face closed to polygons in one chart.
//!
//! ```text
//!   two loops wind round            one winds round a pole           none: the whole surface
//!
//!   b───────B────────b'             p═══════pole═══════p'            ┌───────────┐
//!   │ seam           │ seam         │ seam             │ seam        │ seam      │ seam
//!   a───────A────────a'             a────────A─────────a'            └───────────┘
//! ```
//!
//! The two sides of a seam have the same vertices, one period apart in the chart; all points of a pole line
//! are one vertex. The outer loop is the one with the largest area, whatever the file states.

mod crease;
mod cuts;
mod cycle;
mod natural;
mod nest;
mod strip;
mod winding;

use crate::keys::{ChartPoint, Key, Segment};
use crate::seams::Seams;
use crate::snap::{Grid, settled};
use crate::trimmed_face::{OpenLoop, TrimmedFace};
use chordal_brep::MeshIssue;
use chordal_nurbs::{DVec2, DVec3, UvBox, work};
use std::collections::BTreeMap;

/// The face as polygons: outer loops counter-clockwise, holes clockwise.
#[derive(Clone, Debug, Default)]
pub struct Chart {
    /// The corners of all polygons.
    pub points: Vec<ChartPoint>,
    /// Runs of `points`.
    pub loops: Vec<(u32, u32)>,
    /// Positions of the vertices with `Key::Private`.
    pub private: Vec<DVec3>,
    /// The outer loop runs in the other direction in the file: it or the sense flag is wrong, or the loop
    /// overlaps itself. Triangles follow the loop until the orientation of the neighbours is known.
    pub reversed: bool,
    /// Points inside the face are placed on this grid.
    pub grid: Grid,
}

/// The places of one vertex in a chart are one where they lie nearer together than this share of the chart:
/// the two sides of a seam are further apart.
const SAME_VERTEX: f64 = 1e-2;

/// A chord of a seam is halved at most this often.
const SEAM_DEPTH: usize = 12;

impl Chart {
    /// Unrolls the face; cuts through it are sampled as `seams` says. `creased`: cut along its surface's
    /// creases.
    ///
    /// # Errors
    /// Where the loops bound no region.
    pub fn new(context: &TrimmedFace<'_, '_>, seams: &Seams<'_>, creased: bool) -> Result<Self, MeshIssue> {
        let (loops, lone) = context.loops()?;
        let mut unroll = Unroll { context, seams, lone, private: Vec::new(), reversed: false };
        let (winding, mut plain): (Vec<_>, Vec<_>) = loops.into_iter().partition(|l| l.winding != [0, 0]);
        plain.retain(|l| encloses_area(l, context.surface.periods));
        // Loops without area bound no face; the face is not the whole surface then.
        if winding.is_empty() && plain.is_empty() && context.is_trimmed() {
            return Ok(Self::default());
        }
        let outer = if !winding.is_empty() {
            Some(unroll.cut(winding, &mut plain)?)
        } else if unroll.needs_natural_boundary(&plain) {
            Some(unroll.natural_boundary(&mut plain)?)
        } else {
            None
        };
        let mut polygons = unroll.nest(outer, plain)?;
        let grid = Grid::over(UvBox::from_points(polygons.iter().flatten().map(|p| p.uv)).size());
        polygons.iter_mut().flatten().for_each(|p| p.uv = grid.snap(p.uv));
        if context.touching {
            unroll.join_vertices(&mut polygons);
        }
        if creased {
            polygons = unroll.cut_at_creases(polygons);
        }
        let subdivided_poles = |polygon| unroll.subdivided_poles(polygon, &grid);
        let mut chart =
            Chart { private: unroll.private.clone(), reversed: unroll.reversed, grid, ..Chart::default() };
        for polygon in polygons {
            let start = chart.points.len() as u32;
            chart.points.extend(subdivided_poles(polygon));
            chart.loops.push((start, chart.points.len() as u32));
        }
        Ok(chart)
    }
}

pub(crate) struct Unroll<'a, 's> {
    pub context: &'a TrimmedFace<'a, 's>,
    seams: &'a Seams<'a>,
    lone: Vec<u32>,
    private: Vec<DVec3>,
    reversed: bool,
}

fn area(points: &[ChartPoint]) -> f64 {
    let origin = points[0].uv;
    let n = points.len();
    (0..n).map(|i| (points[i].uv - origin).perp_dot(points[(i + 1) % n].uv - origin)).sum::<f64>() * 0.5
}

fn mean(points: &[ChartPoint], axis: usize) -> f64 {
    points.iter().map(|p| p.uv[axis]).sum::<f64>() / points.len() as f64
}

fn contains(polygon: &[ChartPoint], p: DVec2) -> bool {
    let mut inside = false;
    let n = polygon.len();
    for i in 0..n {
        let (a, b) = (polygon[i].uv, polygon[(i + 1) % n].uv);
        if (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) {
            inside = !inside;
        }
    }
    inside
}

fn shifted(points: &[ChartPoint], by: DVec2) -> Vec<ChartPoint> {
    points.iter().map(|p| ChartPoint { uv: p.uv + by, ..*p }).collect()
}

fn along_axis(axis: usize, value: f64) -> DVec2 {
    if axis == 0 { DVec2::new(value, 0.0) } else { DVec2::new(0.0, value) }
}

impl Unroll<'_, '_> {
    pub fn add_private(&mut self, p_uv: DVec2) -> Key {
        self.private.push(self.context.surface.point(p_uv));
        Key::Private(self.private.len() as u32 - 1)
    }

    /// A vertex that loops pass more than once has one place in the chart, so that they touch there and do
    /// not cross.
    fn join_vertices(&self, polygons: &mut [Vec<ChartPoint>]) {
        let extent = UvBox::from_points(polygons.iter().flatten().map(|p| p.uv)).size();
        let surface = self.context.surface;
        let mut places: BTreeMap<u32, Vec<DVec2>> = BTreeMap::new();
        for point in polygons.iter_mut().flatten() {
            let Key::Vertex(v) = point.key else { continue };
            let known = places.entry(v).or_default();
            let vertex = self.context.part.vertices[v as usize].point;
            let same = known.iter().find(|&&uv| {
                let apart = (uv - point.uv).abs();
                let beside = apart.x <= SAME_VERTEX * extent.x && apart.y <= SAME_VERTEX * extent.y;
                let off = |uv: DVec2| surface.point(uv).distance(vertex);
                beside && {
                    let distance = surface.point(uv).distance(surface.point(point.uv));
                    distance <= 2.0 * (off(uv) + off(point.uv)) + self.context.resolution
                }
            });
            match same {
                Some(&uv) => point.uv = uv,
                None => known.push(point.uv),
            }
        }
    }

    /// Points strictly between two chart points, as many as the metric requires, and more where a chord is
    /// further from the surface than its curvature at the probes suggests.
    pub fn between(&self, from: DVec2, to: DVec2) -> Vec<DVec2> {
        // Free surfaces may bend many times along a seam.
        let probes = if self.context.surface.is_elementary() { 16 } else { 96 };
        let d = (to - from) / probes as f64;
        let mut sum = vec![0.0];
        for k in 0..probes {
            let jet = self.context.surface.jet(from + d * (k as f64 + 0.5));
            let step = self.seams.metric.length(&jet, d);
            sum.push(sum[k] + step);
        }
        let total = sum[probes];
        let count = (total / self.seams.chord).ceil().clamp(1.0, 1e5) as usize;
        let mut at = 0;
        let mut points = vec![from];
        for k in 1..=count {
            if work::is_over() {
                break;
            }
            let wanted = total * k as f64 / count as f64;
            while at + 1 < probes && sum[at + 1] < wanted {
                at += 1;
            }
            let step = sum[at + 1] - sum[at];
            let inside = if step > 0.0 { ((wanted - sum[at]) / step).min(1.0) } else { 0.5 };
            let share = settled((at as f64 + inside) / probes as f64, k as f64 / count as f64, 1.0);
            let next = if k == count { to } else { from + (to - from) * share };
            self.halve_until_near(points[points.len() - 1], next, SEAM_DEPTH, &mut points);
        }
        points.pop();
        points.drain(..1.min(points.len()));
        points
    }

    /// Appends points behind `from` up to `to`, halving until each chord is near the surface.
    fn halve_until_near(&self, from: DVec2, to: DVec2, depth: usize, points: &mut Vec<DVec2>) {
        let [a, b] = [from, to].map(|uv| self.context.surface.point(uv));
        let chord = b - a;
        let off = |i: i32| {
            let x = self.context.surface.point(from.lerp(to, f64::from(i) / 8.0)) - a;
            let along = (x.dot(chord) / chord.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
            (x - chord * along).length()
        };
        let allowed = self.seams.tolerance * self.seams.chord * self.seams.chord;
        if depth > 0 && !work::is_over() && (1..8).any(|i| off(i) > allowed) {
            let middle = from.midpoint(to);
            self.halve_until_near(from, middle, depth - 1, points);
            self.halve_until_near(middle, to, depth - 1, points);
        } else {
            points.push(to);
        }
    }

    fn pole_key(&mut self, p_uv: DVec2) -> Key {
        let p = self.context.surface.point(p_uv);
        let near = |v: &&u32| {
            self.context.part.vertices[**v as usize].point.distance(p) <= 10.0 * self.context.resolution
        };
        match self.lone.iter().find(near) {
            Some(&v) => Key::Vertex(v),
            None => self.add_private(p_uv),
        }
    }

    /// Gives every pole line as many chart points as a fan of triangles around the pole needs.
    fn subdivided_poles(&self, polygon: Vec<ChartPoint>, grid: &Grid) -> Vec<ChartPoint> {
        if polygon.iter().all(|p| p.segment != Segment::Pole) {
            return polygon;
        }
        let mut fine = Vec::with_capacity(2 * polygon.len());
        let means = [0, 1].map(|axis| mean(&polygon, axis));
        for (i, point) in polygon.iter().enumerate() {
            let next = polygon[(i + 1) % polygon.len()].uv;
            if point.segment != Segment::Pole || next == point.uv {
                fine.push(*point);
                continue;
            }
            let count = self.pole_points(point.uv, next, means.into());
            let at = |k: usize| match k {
                0 => point.uv,
                _ => grid.snap(point.uv + (next - point.uv) * (k as f64 / count as f64)),
            };
            fine.extend((0..count).map(|k| ChartPoint { uv: at(k), ..*point }));
        }
        fine
    }

    /// The number of chords around the surface half way between the pole and the middle of the domain, or of
    /// the face where the domain is unbounded.
    fn pole_points(&self, from: DVec2, to: DVec2, inside: DVec2) -> usize {
        let along = usize::from((to - from).x == 0.0);
        let across = 1 - along;
        let domain = self.context.surface.domain();
        let mut middle = from.midpoint(to);
        let inward = if domain.is_finite() { domain.center()[across] } else { inside[across] };
        middle[across] = 0.5 * (middle[across] + inward);
        let jet = self.context.surface.jet(middle);
        let rate = self.seams.metric.length(&jet, to - from);
        (rate / self.seams.chord).ceil().clamp(2.0, 256.0) as usize
    }
}

/// False where a loop runs back over itself, vertex by vertex, such as two points, or an edge and the same
/// edge back.
fn encloses_area(open: &OpenLoop, periods: [Option<f64>; 2]) -> bool {
    let mut left: Vec<&ChartPoint> = Vec::with_capacity(open.points.len());
    // The two sides of a seam have the same vertices, one period apart.
    let same = |a: &ChartPoint, b: &ChartPoint| {
        let turned = |k: usize| periods[k].is_some_and(|p| (a.uv[k] - b.uv[k]).abs() > 0.5 * p);
        a.key == b.key && !turned(0) && !turned(1)
    };
    for point in &open.points {
        match left[..] {
            [.., before, _] if same(before, point) => {
                left.pop();
            }
            _ => left.push(point),
        }
    }
    let mut ends = 0..left.len();
    while ends.len() > 2 && same(left[ends.start + 1], left[ends.end - 1]) {
        ends = ends.start + 1..ends.end - 1;
    }
    ends.len() > 2
}
