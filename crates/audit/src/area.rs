//! The area of a face in its parameter space, from its exact loops, against that of its triangles.
//!
//! The loops are followed along the exact curves of their edges: from one place of the mesh on, each next
//! point of a curve is projected onto the surface near the one before, so that closed directions unroll by
//! themselves. Nothing of the mesher's chart is used but that first place. By Green's theorem the area is
//! then a sum of line integrals:
//!
//! ```text
//!   loops that wind round u            loops that wind round v        neither
//!   A = −∮ (v − v₀) du                  A = ∮ (u − u₀) dv              A = ½ ∮ (u dv − v du)
//! ```
//!
//! A loop may be found whole periods away from another: where both directions close, the area is known up to
//! the area of the whole parameter space. If the loops together wind round u once more, a pole closes the
//! face, and v₀ is its v: one of the poles that the surface has must fit. Where loops run the other way round
//! than the triangles, as files have it, the sign changes.
//!
//! Compared is the polygon of the followed points at the vertices of the edges' polylines, which the
//! triangles must fill exactly: to within what the edges lie off the surface, seen in the chart, along the
//! perimeter, and a share.
//!
//! Not checked where the chords alone do not show it: faces with a loop through a pole, where a curve does
//! not determine one of the parameters; loops that wind round both directions at once; curves whose
//! projection does not follow them.

use crate::boundary::Boundary;
use crate::chart::Chart;
use crate::context::Context;
use crate::findings::Log;
use crate::unrolled::is_unrolled;
use chordal_brep::{AuditIssue, Coedge, Loop};
use chordal_nurbs::{Curve, DVec2, DVec3, Frame, Surface, math};
use rustc_hash::FxHashMap;
use std::f64::consts::{PI, TAU};

/// The two areas may differ by this share: far above rounding and far below any wrong region.
const SHARE: f64 = 0.01;

/// Steps of Gauss–Newton per point; the point before is near, and most points need two.
const STEPS: usize = 8;

/// One loop as followed in the chart.
#[derive(Clone, Copy, Debug, Default)]
struct Followed {
    /// −∮ v du, ∮ u dv.
    integrals: [f64; 2],
    /// Whole turns in u and v.
    turns: [i32; 2],
    /// Length in the chart.
    perimeter: f64,
    /// How far the points of the curve lie off the surface, in the chart.
    off: f64,
}

/// Compares the two areas where the loops can be followed.
pub(crate) fn check_area(context: &Context<'_>, chart: &Chart<'_>, bounds: &Boundary, log: &mut Log<'_>) {
    if bounds.missing > 0 || !bounds.stray.is_empty() || bounds.chords.is_empty() {
        return;
    }
    if is_unrolled(context, chart, bounds) {
        return;
    }
    let places = places(chart, bounds);
    let mut loops = Vec::new();
    for (a_loop, direction) in log.face.loops.iter().zip(&bounds.directions) {
        let Some(forward) = *direction else { continue };
        let Some(mut followed) = follow(context, chart, a_loop, &places) else { return };
        if forward == log.face.flipped {
            followed.reverse();
        }
        loops.push(followed);
    }
    let Some(areas) = areas(chart, &loops) else { return };
    let found = mesh_area(chart);
    let scale = |f: &Followed| f.perimeter * (f.off + 1e-9 * f.perimeter);
    let slack = SHARE * found.abs() + loops.iter().map(scale).sum::<f64>();
    let whole = whole_area(chart);
    let misfit = |area: f64| {
        let off = found - area;
        whole.map_or(off.abs(), |whole| (off - whole * (off / whole).round()).abs())
    };
    let Some(best) = areas.iter().copied().min_by(|a, b| misfit(*a).total_cmp(&misfit(*b))) else { return };
    let too_large = whole.is_some_and(|whole| found.abs() > whole * (1.0 + SHARE));
    if misfit(best) > slack || too_large {
        log.add(AuditIssue::WrongArea { share: found / best });
    }
}

impl Followed {
    fn reverse(&mut self) {
        self.integrals = self.integrals.map(|i| -i);
        self.turns = self.turns.map(|t| -t);
    }
}

/// The signed area of all triangles in the chart. A triangle with one corner at a pole stands for the sector
/// between the parameter lines through its other corners; one with two stands for none (see [`crate::fan`]).
fn mesh_area(chart: &Chart<'_>) -> f64 {
    let uv = |corner: u32| chart.mesh.corners[corner as usize].uv;
    let area = |t: &[u32; 3]| {
        let pole = t.map(|c| chart.pole_axis(c));
        let (i, axis) = match pole.iter().filter(|p| p.is_some()).count() {
            0 => return 0.5 * (uv(t[1]) - uv(t[0])).perp_dot(uv(t[2]) - uv(t[0])),
            1 => match pole.iter().enumerate().find_map(|(i, p)| Some((i, (*p)?))) {
                Some(found) => found,
                None => return 0.0,
            },
            _ => return 0.0,
        };
        let (x, y, p) = (uv(t[(i + 1) % 3]), uv(t[(i + 2) % 3]), uv(t[i]));
        let height = 0.5 * (x[axis] + y[axis]) - p[axis];
        let width = y[1 - axis] - x[1 - axis];
        if axis == 0 { height * width } else { -height * width }
    };
    chart.mesh.triangles.iter().map(area).sum()
}

/// A place in the chart of each position on the boundary.
fn places(chart: &Chart<'_>, bounds: &Boundary) -> FxHashMap<u32, DVec2> {
    let ends = bounds.chords.iter().flat_map(|c| [c.half.a, c.half.b]);
    ends.map(|c| &chart.mesh.corners[c as usize]).map(|c| (c.position, c.uv)).collect()
}

/// The area of the whole parameter space, where the surface is closed in both directions.
fn whole_area(chart: &Chart<'_>) -> Option<f64> {
    let extent = |axis: usize| {
        let at = |mut all: Vec<f64>| {
            all.sort_unstable_by(f64::total_cmp);
            Some(all.last()? - all.first()?).filter(|&d| d > 0.0)
        };
        let poles = chart.poles.iter().filter(|p| p.axis == axis).map(|p| p.value).collect();
        chart.period(axis).or_else(|| at(poles))
    };
    Some(extent(0)? * extent(1)?)
}

/// The areas that the loops may bound, one for each pole that may close them.
fn areas(chart: &Chart<'_>, loops: &[Followed]) -> Option<Vec<f64>> {
    let winds = |axis: usize| loops.iter().any(|l| l.turns[axis] != 0);
    let sum = |axis: usize| loops.iter().map(|l| l.integrals[axis]).sum::<f64>();
    let axis = match (winds(0), winds(1)) {
        (true, true) => return None,
        (false, false) => return Some(vec![0.5 * (sum(0) + sum(1))]),
        (true, false) => 0,
        (false, true) => 1,
    };
    let turns: i32 = loops.iter().map(|l| l.turns[axis]).sum();
    if turns == 0 {
        return Some(vec![sum(axis)]);
    }
    let sign = if axis == 0 { 1.0 } else { -1.0 };
    let length = f64::from(turns) * chart.period(axis)?;
    let poles = chart.poles.iter().filter(|p| p.axis == 1 - axis);
    Some(poles.map(|p| sum(axis) + sign * p.value * length).collect())
}

/// Follows one loop; `None` where that is not possible.
fn follow(
    context: &Context<'_>,
    chart: &Chart<'_>,
    a_loop: &Loop,
    places: &FxHashMap<u32, DVec2>,
) -> Option<Followed> {
    let Trail { positions, middles } = Trail::of(context, a_loop)?;
    if positions.iter().any(|&p| is_at_pole(chart, context, p)) {
        return None;
    }
    let uv = *places.get(positions.first()?)?;
    let mut walk = Walk { chart, uv, off: 0.0 };
    let mut corners = Vec::with_capacity(positions.len() + 1);
    corners.push(walk.step(context.mesh.positions[positions[0] as usize])?);
    for (i, middle) in middles.iter().enumerate() {
        if let Some(p) = middle {
            walk.step(*p)?;
        }
        let next = positions[(i + 1) % positions.len()];
        corners.push(walk.step(context.mesh.positions[next as usize])?);
    }
    summed(chart, &corners, walk.off)
}

fn is_at_pole(chart: &Chart<'_>, context: &Context<'_>, position: u32) -> bool {
    let p = context.mesh.positions[position as usize];
    let near = context.same_point.max(1e-6 * context.scale);
    chart.poles.iter().any(|pole| pole.point.distance(p) <= near)
}

/// The points along a loop.
#[derive(Default)]
struct Trail {
    positions: Vec<u32>,
    /// The middle of the exact curve between each position and the next, where it helps to follow a curve.
    middles: Vec<Option<DVec3>>,
}

impl Trail {
    /// `None` for a loop without points, or with an edge whose samples are not in order.
    fn of(context: &Context<'_>, a_loop: &Loop) -> Option<Self> {
        let mut trail = Self::default();
        match a_loop {
            Loop::Vertex(_) => return None,
            Loop::Polygon { vertices, .. } => {
                for v in vertices {
                    trail.positions.push(context.vertex_at.get(v.index()).copied().flatten()?);
                    trail.middles.push(None);
                }
            }
            Loop::Edges { coedges, .. } => {
                for coedge in coedges {
                    trail.add(context, coedge)?;
                }
            }
        }
        Some(trail)
    }

    fn add(&mut self, context: &Context<'_>, coedge: &Coedge) -> Option<()> {
        let index = coedge.edge.index();
        let Some(curve) = &context.part.edges[index].curve else { return Some(()) };
        let line = &context.mesh.edges[index];
        let at = &context.edges[index].parameters;
        if at.len() != line.len() || line.is_empty() {
            return None;
        }
        let needs_middle = !matches!(**curve, Curve::Line { .. });
        let chords = line.len() - 1;
        for k in 0..chords {
            let (from, to) = if coedge.forward { (k, k + 1) } else { (chords - k, chords - k - 1) };
            self.positions.push(line[from]);
            self.middles.push(needs_middle.then(|| curve.point(0.5 * (at[from] + at[to]))));
        }
        Some(())
    }
}

/// Follows points on the surface.
struct Walk<'a, 'b> {
    chart: &'a Chart<'b>,
    uv: DVec2,
    off: f64,
}

impl Walk<'_, '_> {
    /// The parameters of the point of the surface nearest to `p`, near those of the point before.
    fn step(&mut self, p: DVec3) -> Option<DVec2> {
        let (uv, off) = match self.chart.surface {
            Surface::Cylinder { frame, radius } => self.ring(frame, p, |_, z| z, |_| (*radius, 1.0)),
            Surface::Cone { frame, radius, half_angle } => {
                self.ring(frame, p, |_, z| z, |v| (radius + v * math::tan(*half_angle), 1.0))
            }
            Surface::Sphere { frame, radius } if *radius > 0.0 => {
                self.ring(frame, p, |rho, z| math::atan2(z, rho), |v| (radius * math::cos(v), *radius))
            }
            Surface::Torus { frame, major, minor } if major > minor && *minor > 0.0 => {
                let v = |rho: f64, z: f64| {
                    let angle = math::atan2(z, rho - major);
                    angle + TAU * ((self.uv.y - angle) / TAU).round()
                };
                let (uv, _) = self.ring(frame, p, v, |_| (*major, *minor));
                let local = frame.local(p);
                let off = math::hypot(local.z, math::hypot(local.x, local.y) - major) - minor;
                (uv, off.abs() / minor.min(major - minor))
            }
            _ => {
                let uv = self.descend(p)?;
                let (s, du, dv) = self.chart.surface.jet1(self.chart.wrap.apply(uv));
                (uv, s.distance(p) / du.length().min(dv.length()))
            }
        };
        self.uv = uv;
        self.off = self.off.max(off);
        self.off.is_finite().then_some(uv)
    }

    /// On a surface of circles about the frame's axis: `v` of the distance from the axis and the height, and
    /// at v the radius of the circle and the speed along v.
    fn ring(
        &self,
        frame: &Frame,
        p: DVec3,
        v: impl Fn(f64, f64) -> f64,
        at: impl Fn(f64) -> (f64, f64),
    ) -> (DVec2, f64) {
        let local = frame.local(p);
        let rho = math::hypot(local.x, local.y);
        let v = v(rho, local.z);
        let (radius, speed) = at(v);
        // Beyond the apex of a cone the angle is that of the other side.
        let side = if radius < 0.0 { PI } else { 0.0 };
        let angle = math::atan2(local.y, local.x) + side;
        let u = angle + TAU * ((self.uv.x - angle) / TAU).round();
        let off = (rho - radius.abs()).abs() / radius.abs().min(speed);
        (DVec2::new(u, v), off)
    }

    /// Gauss–Newton from the point before, within the domain: beyond it the surface stands still.
    fn descend(&self, p: DVec3) -> Option<DVec2> {
        let mut uv = self.uv;
        let domain = self.chart.surface.domain();
        for _ in 0..STEPS {
            let (s, du, dv) = self.chart.surface.jet1(self.chart.wrap.apply(uv));
            let r = p - s;
            let (a, b, c) = (du.length_squared(), du.dot(dv), dv.length_squared());
            let det = a * c - b * b;
            if det.is_nan() || det <= 1e-12 * a * c {
                return None;
            }
            let (x, y) = (r.dot(du), r.dot(dv));
            let mut step = DVec2::new(c * x - b * y, a * y - b * x) / det;
            let next = uv + step;
            for axis in (0..2).filter(|&axis| self.chart.period(axis).is_none()) {
                step[axis] = next[axis].clamp(domain.min[axis], domain.max[axis]) - uv[axis];
            }
            uv += step;
            if (du * step.x + dv * step.y).length() <= self.chart.rounding.max(1e-6 * r.length()) {
                return Some(uv);
            }
        }
        None
    }
}

/// The integrals over the closed polygon of `corners`, the first repeated at the end whole turns away.
fn summed(chart: &Chart<'_>, corners: &[DVec2], off: f64) -> Option<Followed> {
    let (first, last) = (*corners.first()?, *corners.last()?);
    let mut followed = Followed { off, ..Followed::default() };
    let along = chart.whole_turns(last - first);
    for axis in 0..2 {
        if let Some(period) = chart.period(axis) {
            followed.turns[axis] = (along[axis] / period).round() as i32;
        }
    }
    // Measured from the first corner, so that large parameters keep their digits.
    for w in corners.windows(2) {
        let (a, b) = (w[0], w[1]);
        followed.integrals[0] -= 0.5 * (a.y + b.y) * (b.x - a.x);
        followed.integrals[1] += 0.5 * (a.x + b.x) * (b.y - a.y);
        followed.perimeter += a.distance(b);
    }
    let open = (last - first - along).length();
    (open <= 1e-3 * followed.perimeter + 4.0 * off).then_some(followed)
}
