//! Size and place: rows of points inside a doubly curved face, staggered, at the spacing that the curvature allows.
//!
//! In units of the longest allowed chord (sagitta ε, for the fewest triangles see `docs/report.md`):
//! - K > 0: a triangle must fit in a circle of diameter 1. Equilateral: base √3/2, height 3/4. Where rows are nearer together
//!   (h < 3/4, because a whole number of them must fit) the base may grow to 2√(h − h²), up to 1.
//! - K < 0: only edges matter. Base 1, height √5/2, apex over the middle: the largest triangle there is.
//! - Where rows run across principal directions they are sheared along with them.
//!
//! Rows are lines of one parameter, chosen so that their distance varies least along them.

use crate::limits::Limits;
use crate::metric::Sizing;
use crate::snap::settled;
use crate::surface::FaceSurface;
use crate::unroll::Chart;
use chordal_nurbs::{DVec2, UvBox};

/// How much of an allowed chord is used: the curvature varies over a triangle, and a triangle that fails costs more.
const SAFETY: f64 = 0.97;

/// Samples of the sizing per direction.
const GRID: usize = 12;

/// Spacing that the sizing allows for rows along one axis.
#[derive(Clone, Copy, Debug)]
struct Spacing {
    /// Distance of points along the row.
    base: f64,
    /// Distance to the next row.
    height: f64,
    /// How far along the row the next row's points lie, per unit of the other parameter.
    shear: f64,
    positive: bool,
}

impl Spacing {
    /// For rows along `axis`.
    fn new(sizing: &Sizing, axis: usize, limits: &Limits) -> Self {
        let pick =
            |m: &crate::metric::Metric| if axis == 0 { (m.uu, m.uv, m.vv) } else { (m.vv, m.uv, m.uu) };
        let (along, mixed, across) = pick(&sizing.metric);
        let (q_along, q_mixed, q_across) = pick(&sizing.signed);
        let tiny = 1e-300;
        // What any edge may be by angle and length, and by the absolute curvature, with a little left for diagonals.
        let reduced = (across - mixed * mixed / along.max(tiny)).max(0.0);
        let by_metric =
            |base: f64, height: f64| (base / along.max(tiny).sqrt(), height / reduced.max(tiny).sqrt());
        let positive = sizing.gauss > 0.0;
        let bent_by_angle = limits.angle.is_finite() || limits.length.is_finite();
        if positive {
            let (base, height) = by_metric(0.866, 0.75);
            return Self { base, height, shear: -mixed / along.max(tiny), positive };
        }
        let q_reduced = q_across - q_mixed * q_mixed / q_along;
        // Nearly along an asymptote the base could grow without end: there the absolute metric decides.
        let asymptotic = !(q_along.abs() > 0.4 * along);
        if asymptotic || bent_by_angle {
            let (base, height) = by_metric(0.85, 0.75);
            return Self { base, height, shear: -mixed / along.max(tiny), positive };
        }
        let base = 1.0 / q_along.abs().sqrt();
        Self { base, height: 1.118 / q_reduced.abs().max(tiny).sqrt(), shear: -q_mixed / q_along, positive }
    }
}

/// Points to insert, as rows; each row from one end to the other.
pub(crate) struct Rows {
    pub rows: Vec<Vec<DVec2>>,
}

/// A face seen with rows along the first coordinate.
struct Placer<'a, 's> {
    surface: &'a FaceSurface<'s>,
    limits: &'a Limits,
    axis: usize,
    /// Sides of the polygons in (along, across).
    sides: Vec<[DVec2; 2]>,
    bounds: UvBox,
}

/// Swaps the coordinates where rows run along v.
fn turned(p: DVec2, axis: usize) -> DVec2 {
    if axis == 0 { p } else { DVec2::new(p.y, p.x) }
}

impl Rows {
    /// Rows for the face in this chart; none where the boundary suffices.
    pub fn new(surface: &FaceSurface<'_>, chart: &Chart, limits: &Limits) -> Self {
        let placers = [0, 1].map(|axis| Placer::new(surface, chart, limits, axis));
        let plans: Vec<_> = placers.iter().map(|p| (p, p.plan())).collect();
        let enough = plans.iter().all(|(_, plan)| plan.strips <= 1.0 + 1e-6)
            || plans.iter().any(|(_, p)| p.strips == 0.0);
        // Rows along u unless those along v are clearly better: rounding must not decide.
        let better = |a: &Plan, b: &Plan| a.unevenness < b.unevenness - 1e-9 * (1.0 + b.unevenness);
        let Some((placer, plan)) =
            plans.into_iter().reduce(|best, next| if better(&next.1, &best.1) { next } else { best })
        else {
            return Self { rows: Vec::new() };
        };
        if enough {
            return Self { rows: Vec::new() };
        }
        Self { rows: placer.rows(&plan) }
    }

    /// The points in an order that keeps a growing triangulation balanced: ever denser rounds, each along the rows.
    pub fn insertion_order(&self) -> Vec<DVec2> {
        let mut rounds: Vec<Vec<DVec2>> = vec![Vec::new(); 12];
        let mut k = 0u32;
        for (r, row) in self.rows.iter().enumerate() {
            let round_of =
                |k: u32| ((k.wrapping_mul(2_654_435_761) >> 7 | 1 << 11).trailing_zeros()) as usize;
            let mut place = |p: &DVec2| {
                rounds[round_of(k)].push(*p);
                k = k.wrapping_add(1);
            };
            if r % 2 == 0 { row.iter().for_each(&mut place) } else { row.iter().rev().for_each(&mut place) }
        }
        rounds.into_iter().rev().flatten().collect()
    }
}

/// How a face would be cut into rows.
struct Plan {
    /// Places across and the strips needed up to there.
    across: Vec<f64>,
    strips_up_to: Vec<f64>,
    strips: f64,
    /// How much the distance of rows varies along them: the mean spread of its logarithm.
    unevenness: f64,
    shear: f64,
}

impl<'a, 's> Placer<'a, 's> {
    fn new(surface: &'a FaceSurface<'s>, chart: &Chart, limits: &'a Limits, axis: usize) -> Self {
        let mut sides = Vec::with_capacity(chart.points.len());
        for &(start, end) in &chart.loops {
            for i in start..end {
                let j = if i + 1 == end { start } else { i + 1 };
                let [a, b] = [i, j].map(|k| turned(chart.points[k as usize].uv, axis));
                sides.push([a, b]);
            }
        }
        let bounds = UvBox::from_points(sides.iter().map(|s| s[0]));
        Self { surface, limits, axis, sides, bounds }
    }

    fn spacing(&self, p: DVec2) -> Option<Spacing> {
        let jet = self.surface.jet(turned(p, self.axis));
        Sizing::new(&jet, self.limits).map(|s| Spacing::new(&s, self.axis, self.limits))
    }

    /// The intervals of a row inside the face.
    fn inside(&self, across: f64) -> Vec<[f64; 2]> {
        let mut cuts: Vec<f64> = self
            .sides
            .iter()
            .filter(|[a, b]| (a.y > across) != (b.y > across))
            .map(|[a, b]| a.x + (across - a.y) / (b.y - a.y) * (b.x - a.x))
            .collect();
        cuts.sort_by(f64::total_cmp);
        cuts.chunks_exact(2).map(|c| [c[0], c[1]]).collect()
    }

    fn plan(&self) -> Plan {
        let (low, high) = (self.bounds.min.y, self.bounds.max.y);
        let mut plan =
            Plan { across: vec![low], strips_up_to: vec![0.0], strips: 0.0, unevenness: 0.0, shear: 0.0 };
        let mut weight = 0.0;
        let mut shears = Vec::new();
        for k in 0..GRID {
            let across = low + (high - low) * (k as f64 + 0.5) / GRID as f64;
            let mut heights = Vec::with_capacity(GRID);
            let intervals = self.inside(across);
            let total: f64 = intervals.iter().map(|i| i[1] - i[0]).sum();
            for i in 0..GRID {
                let mut at = total * (i as f64 + 0.5) / GRID as f64;
                for [from, to] in &intervals {
                    if at <= to - from {
                        if let Some(s) = self.spacing(DVec2::new(from + at, across)) {
                            heights.push(s.height);
                            shears.push(s.shear);
                        }
                        break;
                    }
                    at -= to - from;
                }
            }
            heights.sort_by(f64::total_cmp);
            let strips = match heights.get(heights.len() / 4) {
                Some(&height) => {
                    let spread = (heights[heights.len() - 1] / heights[0]).ln();
                    let share = (high - low) / GRID as f64 / height;
                    plan.unevenness += spread.min(50.0) * share;
                    weight += share;
                    share
                }
                None => 0.0,
            };
            plan.strips += strips / SAFETY;
            plan.across.push(low + (high - low) * (k + 1) as f64 / GRID as f64);
            plan.strips_up_to.push(plan.strips);
        }
        plan.unevenness /= weight.max(1e-300);
        shears.sort_by(f64::total_cmp);
        plan.shear = shears.get(shears.len() / 2).copied().unwrap_or(0.0);
        plan
    }

    fn rows(&self, plan: &Plan) -> Vec<Vec<DVec2>> {
        let count = (plan.strips - 0.05).ceil().max(1.0) as usize;
        let tightness = plan.strips / count as f64;
        let mut rows = Vec::with_capacity(count);
        let mut at = 0;
        for k in 1..count {
            let wanted = plan.strips * k as f64 / count as f64;
            while plan.strips_up_to[at + 1] < wanted {
                at += 1;
            }
            let step = plan.strips_up_to[at + 1] - plan.strips_up_to[at];
            let inside = if step > 0.0 { (wanted - plan.strips_up_to[at]) / step } else { 0.5 };
            let across = plan.across[at] + (plan.across[at + 1] - plan.across[at]) * inside;
            let (low, height) = (self.bounds.min.y, self.bounds.max.y - self.bounds.min.y);
            let across = settled(across, low + height * (k as f64 / count as f64), height);
            let mut row = Vec::new();
            for [from, to] in self.inside(across) {
                self.fill(from, to, across, k, tightness, &mut row);
            }
            rows.push(row);
        }
        rows
    }

    /// Places points on one interval of row `k`, every other row shifted by half a step.
    fn fill(&self, from: f64, to: f64, across: f64, k: usize, tightness: f64, row: &mut Vec<DVec2>) {
        const PROBES: usize = 8;
        let width = (to - from) / PROBES as f64;
        let mut sum = [0.0; PROBES + 1];
        for i in 0..PROBES {
            let spacing = self.spacing(DVec2::new(from + (i as f64 + 0.5) * width, across));
            let step = spacing.map_or(0.0, |s| {
                let h = 0.75 * tightness;
                let stretch = if s.positive {
                    (2.0 * (h - h * h).max(0.0).sqrt() / 0.866).clamp(1.0, 1.0 / 0.866)
                } else {
                    1.0
                };
                width / (s.base * stretch * SAFETY)
            });
            sum[i + 1] = sum[i] + step;
        }
        let total = sum[PROBES];
        if !(total > 0.3) || total > 1e6 {
            return;
        }
        let count = (total - 0.1).ceil().max(1.0);
        let phase = if k % 2 == 1 { 0.5 } else { 0.0 };
        let mut at = 0;
        let mut i = if phase > 0.0 { 0.0 } else { 1.0 };
        while i + phase < count {
            let wanted = total * (i + phase) / count;
            while sum[at + 1] < wanted {
                at += 1;
            }
            let step = sum[at + 1] - sum[at];
            let inside = if step > 0.0 { (wanted - sum[at]) / step } else { 0.5 };
            let along = from + (at as f64 + inside) * width;
            let along = settled(along, from + (to - from) * ((i + phase) / count), to - from);
            row.push(turned(DVec2::new(along, across), self.axis));
            i += 1.0;
        }
    }
}
