//! Size and place: rows of points inside a doubly curved face, staggered, at the spacing that the curvature
//! allows.
//!
//! In units of the longest allowed chord (sagitta ε, for the fewest triangles see `docs/report.md`):
//! - K > 0: a triangle must fit in a circle of diameter 1. Equilateral: base √3/2, height 3/4. Where rows are
//!   nearer together (h < 3/4, because a whole number of them must fit) the base may grow to 2√(h − h²), up
//!   to 1.
//! - K < 0: only edges matter. Base 1, height √5/2, apex over the middle: the largest triangle there is.
//!
//! Rows are lines of one parameter, chosen so that their distance varies least along them.

use crate::limits::Limits;
use crate::metric::Sizing;
use chordal_chart::{Chart, FaceSurface, settled};
use chordal_nurbs::{DVec2, UvBox, math};

/// The share of an allowed chord that is used. The curvature varies over a triangle, and a triangle that
/// fails costs more than the few that a smaller share adds.
const SAFETY: f64 = 0.97;

/// Base and height of the equilateral triangle in a circle of diameter 1: √3/2 and 3/4.
const EQUILATERAL_BASE: f64 = 0.866;
const EQUILATERAL_HEIGHT: f64 = 0.75;

/// Base of a triangle that is limited by the absolute curvature, by angle or by length: a little less than
/// the equilateral one, so that diagonals are within the limit as well.
const ABSOLUTE_BASE: f64 = 0.85;

/// Height of the largest triangle over a base of 1 where the Gaussian curvature is negative: √5/2.
const HYPERBOLIC_HEIGHT: f64 = 1.118;

/// A row is near an asymptotic direction if its signed curvature is below this share of the absolute one. A
/// smaller share makes needles there.
const ASYMPTOTIC: f64 = 0.4;

/// The largest logarithm of a ratio of heights that counts for the unevenness of rows, so that one singular
/// place does not decide.
const LARGEST_SPREAD: f64 = 50.0;

/// This share of a row more than a whole number makes no further row, and of a step no further point:
/// rounding, and facets a little over the limit, which the proof mends.
const NEARLY_A_ROW: f64 = 0.05;
const NEARLY_A_STEP: f64 = 0.1;

/// Pieces of a row shorter than this many steps get no point: the boundary suffices.
const SHORTEST_ROW: f64 = 0.3;

/// Pieces of a row with more steps than this get none: the sizing is meaningless there, and the proof places
/// points.
const LONGEST_ROW: f64 = 1e6;

/// Samples of the sizing in each direction. Fewer miss short bends; the cost grows with the square.
const GRID: usize = 12;

/// The spacing of points for rows along one axis.
#[derive(Clone, Copy, Debug)]
struct Spacing {
    /// Distance between the points of a row.
    base: f64,
    /// Distance to the next row.
    height: f64,
    positive: bool,
}

impl Spacing {
    /// The spacing for rows along `axis`.
    fn new(sizing: &Sizing, axis: usize, limits: &Limits) -> Self {
        let pick =
            |m: &crate::metric::Metric| if axis == 0 { (m.uu, m.uv, m.vv) } else { (m.vv, m.uv, m.uu) };
        let (along, mixed, across) = pick(&sizing.metric);
        let (q_along, q_mixed, q_across) = pick(&sizing.signed);
        let tiny = 1e-300;
        // The longest edge by angle, length and absolute curvature, with a little left for diagonals.
        let reduced = (across - mixed * mixed / along.max(tiny)).max(0.0);
        let by_metric =
            |base: f64, height: f64| (base / along.max(tiny).sqrt(), height / reduced.max(tiny).sqrt());
        let positive = sizing.gauss > 0.0;
        let bent_by_angle = limits.angle.is_finite() || limits.length.is_finite();
        if positive {
            let (base, height) = by_metric(EQUILATERAL_BASE, EQUILATERAL_HEIGHT);
            return Self { base, height, positive };
        }
        let q_reduced = q_across - q_mixed * q_mixed / q_along;
        // Near an asymptotic direction the base could grow without limit: the absolute curvature decides
        // there.
        let asymptotic = !(q_along.abs() > ASYMPTOTIC * along);
        if asymptotic || bent_by_angle {
            let (base, height) = by_metric(ABSOLUTE_BASE, EQUILATERAL_HEIGHT);
            return Self { base, height, positive };
        }
        let base = 1.0 / q_along.abs().sqrt();
        Self { base, height: HYPERBOLIC_HEIGHT / q_reduced.abs().max(tiny).sqrt(), positive }
    }
}

/// The points to insert, row by row; each row runs from one end to the other.
pub(crate) struct Rows {
    pub rows: Vec<Vec<DVec2>>,
}

/// A face in coordinates along and across the rows.
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
    /// The rows of the face in this chart; none where the boundary suffices.
    pub fn new(surface: &FaceSurface<'_>, chart: &Chart, limits: &Limits) -> Self {
        let placers = [0, 1].map(|axis| Placer::new(surface, chart, limits, axis));
        let plans: Vec<_> = placers.iter().map(|p| (p, p.plan())).collect();
        let enough = plans.iter().all(|(_, plan)| plan.strips <= 1.0 + 1e-6)
            || plans.iter().any(|(_, p)| p.strips == 0.0);
        // Rows run along u unless those along v are clearly better, so that rounding does not decide.
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

    /// The points in an order that keeps a growing triangulation balanced: in rounds, each denser than the
    /// last, and each along the rows.
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

/// How a face is cut into rows.
struct Plan {
    /// Places across the rows, and the number of rows needed up to there.
    across: Vec<f64>,
    strips_up_to: Vec<f64>,
    strips: f64,
    /// How much the distance between rows varies along them: the mean spread of its logarithm.
    unevenness: f64,
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
        let mut plan = Plan { across: vec![low], strips_up_to: vec![0.0], strips: 0.0, unevenness: 0.0 };
        let mut weight = 0.0;
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
                        }
                        break;
                    }
                    at -= to - from;
                }
            }
            heights.sort_by(f64::total_cmp);
            let strips = match heights.get(heights.len() / 4) {
                Some(&height) => {
                    let spread = math::ln(heights[heights.len() - 1] / heights[0]);
                    let share = (high - low) / GRID as f64 / height;
                    plan.unevenness += spread.min(LARGEST_SPREAD) * share;
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
        plan
    }

    fn rows(&self, plan: &Plan) -> Vec<Vec<DVec2>> {
        let count = (plan.strips - NEARLY_A_ROW).ceil().max(1.0) as usize;
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
                let h = EQUILATERAL_HEIGHT * tightness;
                let stretch = if s.positive {
                    (2.0 * (h - h * h).max(0.0).sqrt() / EQUILATERAL_BASE).clamp(1.0, 1.0 / EQUILATERAL_BASE)
                } else {
                    1.0
                };
                width / (s.base * stretch * SAFETY)
            });
            sum[i + 1] = sum[i] + step;
        }
        let total = sum[PROBES];
        if !(total > SHORTEST_ROW) || total > LONGEST_ROW {
            return;
        }
        let count = (total - NEARLY_A_STEP).ceil().max(1.0);
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
