//! Where a curve loses smoothness.

use crate::bisect::bisect;
use crate::{Curve, Curve2, Range, Surface, UvBox};
use glam::DVec2;

/// More continuity than any knot of the largest degree leaves: every knot counts as a break.
pub(crate) const ANY: usize = 2 * crate::basis::MAX_DEGREE;

/// Samples of a curve in parameter space between which one crossing of a knot line is looked for.
const CROSSING_SAMPLES: usize = 64;

impl Curve {
    /// Parameters strictly inside `range`, in increasing order, where the curve may not be twice continuously
    /// differentiable: corners, joints, knots of high multiplicity.
    pub fn breaks(&self, range: Range) -> Vec<f64> {
        let mut found = Vec::new();
        self.collect_breaks(range, 2, &mut found);
        tidy(found, range)
    }

    /// All knots, corners and joints strictly inside `range`, in increasing order: between two of them the
    /// curve is one analytic piece.
    pub fn all_breaks(&self, range: Range) -> Vec<f64> {
        let mut found = Vec::new();
        self.collect_breaks(range, ANY, &mut found);
        tidy(found, range)
    }

    /// Adds parameters where the curve may not be `continuity` times continuously differentiable.
    fn collect_breaks(&self, range: Range, continuity: usize, out: &mut Vec<f64>) {
        match self {
            Curve::Line { .. }
            | Curve::Circle { .. }
            | Curve::Ellipse { .. }
            | Curve::Parabola { .. }
            | Curve::Hyperbola { .. } => {}
            Curve::Polyline(points) => {
                repeat(range, self, (0..points.len()).map(|i| i as f64).collect(), out);
            }
            Curve::Nurbs(curve) => {
                let mut own = curve.breaks_below(continuity);
                own.extend([curve.domain().start, curve.domain().end]);
                repeat(range, self, own, out);
            }
            Curve::Composite(segments) => {
                let mut own = vec![segments.len() as f64];
                for (i, segment) in segments.iter().enumerate() {
                    own.push(i as f64);
                    let mut inner = Vec::new();
                    segment.curve.collect_breaks(segment.own_range(0.0, 1.0), continuity, &mut inner);
                    own.extend(inner.into_iter().map(|t| i as f64 + segment.from_own(t).clamp(0.0, 1.0)));
                }
                repeat(range, self, own, out);
            }
            Curve::Offset { basis, .. } => basis.collect_breaks(range, continuity.saturating_add(1), out),
            Curve::OnSurface { surface, curve } => {
                let pieces = curve.all_breaks(range);
                out.extend(curve.breaks_below(range, continuity));
                crossings(surface, curve, range, &pieces, continuity, out);
            }
        }
    }
}

/// Adds the breaks of one period at every period that meets `range`.
fn repeat(range: Range, curve: &Curve, own: Vec<f64>, out: &mut Vec<f64>) {
    let domain = curve.domain();
    let beyond = range.start < domain.start || range.end > domain.end;
    let period = if beyond && range.is_finite() { curve.period() } else { None };
    repeat_over(range, period, own, domain.start, out);
}

pub(crate) fn repeat_over(range: Range, period: Option<f64>, own: Vec<f64>, start: f64, out: &mut Vec<f64>) {
    let Some(period) = period else {
        out.extend(own);
        return;
    };
    let first = ((range.start - start) / period).floor();
    let last = ((range.end - start) / period).floor();
    // A range of more turns than this is no edge of a model.
    let turns = (last - first).clamp(0.0, 64.0) as usize;
    for turn in 0..=turns {
        out.extend(own.iter().map(|t| t + (first + turn as f64) * period));
    }
}

/// Sorts, drops what is outside or at the ends of `range`, and drops repetitions.
pub(crate) fn tidy(mut breaks: Vec<f64>, range: Range) -> Vec<f64> {
    let scale =
        [range.start, range.end].iter().filter(|t| t.is_finite()).fold(0.0, |m: f64, t| m.max(t.abs()));
    let length = if range.is_finite() { range.length() } else { 1.0 };
    // A few rounding errors of the parameter, so that no empty piece remains.
    let gap = (8.0 * f64::EPSILON * scale).max(1e-12 * length);
    breaks.retain(|t| *t > range.start + gap && *t < range.end - gap);
    breaks.sort_by(f64::total_cmp);
    breaks.dedup_by(|b, a| *b - *a <= gap);
    breaks
}

/// Lines of the parameter space of `surface` inside `uv` across which it may not be `continuity` times
/// continuously differentiable: values of u, values of v.
pub(crate) fn surface_lines(surface: &Surface, uv: UvBox, continuity: usize) -> [Vec<f64>; 2] {
    match surface {
        Surface::Extrusion { profile, .. } => {
            let mut lines = Vec::new();
            profile.collect_breaks(uv.u(), continuity, &mut lines);
            [tidy(lines, uv.u()), Vec::new()]
        }
        Surface::Revolution { profile, .. } => {
            let mut lines = Vec::new();
            profile.collect_breaks(uv.v(), continuity, &mut lines);
            [Vec::new(), tidy(lines, uv.v())]
        }
        Surface::Nurbs(nurbs) => {
            let domain = nurbs.domain();
            let periods = surface.periods();
            let (mut u, mut v) = (Vec::new(), Vec::new());
            let knots = |knots: &[f64], degree, domain: Range| {
                let mut lines = knot_breaks(knots, degree, continuity);
                lines.extend([domain.start, domain.end]);
                lines
            };
            let [degree_u, degree_v] = nurbs.degree();
            let own_u = knots(nurbs.knots_u(), degree_u, domain.u());
            let own_v = knots(nurbs.knots_v(), degree_v, domain.v());
            repeat_over(uv.u(), periods[0].filter(|_| uv.is_finite()), own_u, domain.min.x, &mut u);
            repeat_over(uv.v(), periods[1].filter(|_| uv.is_finite()), own_v, domain.min.y, &mut v);
            [tidy(u, uv.u()), tidy(v, uv.v())]
        }
        Surface::Offset { basis, .. } => surface_lines(basis, uv, continuity.saturating_add(1)),
        _ => [Vec::new(), Vec::new()],
    }
}

/// Knots of a vector whose multiplicity leaves fewer than `continuity` continuous derivatives.
fn knot_breaks(knots: &[f64], degree: usize, continuity: usize) -> Vec<f64> {
    knots
        .chunk_by(|a, b| a == b)
        .filter(|same| same.len().saturating_add(continuity) > degree)
        .map(|same| same[0])
        .collect()
}

/// Adds parameters where `curve` crosses a line of low smoothness of the surface.
fn crossings(
    surface: &Surface,
    curve: &Curve2,
    range: Range,
    pieces: &[f64],
    continuity: usize,
    out: &mut Vec<f64>,
) {
    let mut stops = vec![range.start];
    stops.extend_from_slice(pieces);
    stops.push(range.end);
    if !range.is_finite() {
        return;
    }
    for pair in stops.windows(2) {
        let at = |i: usize| pair[0] + (pair[1] - pair[0]) * i as f64 / CROSSING_SAMPLES as f64;
        let samples: Vec<DVec2> = (0..=CROSSING_SAMPLES).map(|i| curve.point(at(i))).collect();
        let uv = UvBox::from_points(samples.iter().copied());
        for (axis, lines) in surface_lines(surface, uv, continuity).into_iter().enumerate() {
            for line in lines {
                for i in 0..CROSSING_SAMPLES {
                    if (samples[i][axis] < line) != (samples[i + 1][axis] < line) {
                        out.push(bisect(|t| curve.point(t)[axis] - line, at(i), at(i + 1), 64));
                    }
                }
            }
        }
    }
}
