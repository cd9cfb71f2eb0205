//! NURBS approximations of curves and surfaces without an exact form: cubic Hermite interpolation, refined
//! until samples agree.
//!
//! Each piece takes over points and first derivatives (for surfaces also the twist) at its ends, so its error
//! falls with the fourth power of its length. **The error is an estimate**: the largest difference at equal
//! parameters among samples inside every piece, times a margin. It is no proof.

use super::checked;
use crate::{Curve, NurbsCurve3, NurbsError, NurbsSurface, Range, Surface, UvBox};
use glam::{DVec2, DVec3};

/// Samples inside a piece, for each direction, at which it is compared.
const CHECKS: usize = 5;
/// Sampled differences times this are the stated error: the samples may miss the peak.
const MARGIN: f64 = 1.25;
/// Halvings of the first pieces.
const ROUNDS: usize = 10;
/// Most pieces of one direction of a surface.
const MOST: usize = 128;
/// Where a break may be, derivatives are taken this part of a piece inside it.
const INSIDE: f64 = 1e-8;

impl Curve {
    /// A cubic spline with the same parameters that follows the curve over `range`, and an **estimate** of
    /// the largest distance at equal parameters: within `tolerance` (model units) unless the limit of pieces
    /// is reached first.
    ///
    /// # Errors
    /// [`NurbsError::Unbounded`] where the range is, [`NurbsError::NotFinite`] where the curve is.
    pub fn approximate_nurbs(&self, range: Range, tolerance: f64) -> Result<(NurbsCurve3, f64), NurbsError> {
        checked(range)?;
        let mut stops = with_middles(range, &self.all_breaks(range));
        let mut error = 0.0;
        for _ in 0..ROUNDS {
            let errors: Vec<f64> = stops.windows(2).map(|s| self.hermite_error(s[0], s[1])).collect();
            error = MARGIN * errors.iter().copied().fold(0.0, f64::max);
            if error <= tolerance || stops.len() > 16 * MOST {
                break;
            }
            stops = split_where(&stops, |i| MARGIN * errors[i] > tolerance);
        }
        let mut points = vec![self.point(range.start)];
        for s in stops.windows(2) {
            points.extend_from_slice(&self.hermite(s[0], s[1])[1..]);
        }
        Ok((NurbsCurve3::new(3, triple_knots(&stops), points, None)?, error))
    }

    fn hermite(&self, a: f64, b: f64) -> [DVec3; 4] {
        let h = b - a;
        let (p, q) = (self.point(a), self.point(b));
        let (dp, dq) = (self.jet(a + INSIDE * h).d1, self.jet(b - INSIDE * h).d1);
        [p, p + dp * (h / 3.0), q - dq * (h / 3.0), q]
    }

    fn hermite_error(&self, a: f64, b: f64) -> f64 {
        let net = self.hermite(a, b);
        (1..=CHECKS)
            .map(|k| k as f64 / (CHECKS + 1) as f64)
            .map(|s| weighted(net, cubic(s)).distance(self.point(a + (b - a) * s)))
            .fold(0.0, f64::max)
    }
}

impl Surface {
    /// A bicubic spline surface with the same parameters that follows this one over a finite box, and an
    /// **estimate** of the largest distance at equal parameters: within `tolerance` (model units) unless the
    /// limit of pieces is reached first.
    ///
    /// # Errors
    /// [`NurbsError::Unbounded`] where the box is, [`NurbsError::NotFinite`] where the surface is.
    pub fn approximate_nurbs(&self, uv: UvBox, tolerance: f64) -> Result<(NurbsSurface, f64), NurbsError> {
        checked(uv.u())?;
        checked(uv.v())?;
        let [breaks_u, breaks_v] = self.all_breaks(uv);
        let mut us = with_middles(uv.u(), &breaks_u);
        let mut vs = with_middles(uv.v(), &breaks_v);
        let mut error = 0.0;
        for _ in 0..ROUNDS {
            let found = self.cell_errors(&us, &vs);
            error = MARGIN * found.largest;
            let full = us.len().max(vs.len()) > MOST;
            if error <= tolerance || full {
                break;
            }
            let limit = tolerance / MARGIN;
            us = split_where(&us, |i| found.rows[i] > limit);
            vs = split_where(&vs, |j| found.columns[j] > limit);
        }
        Ok((self.hermite_net(&us, &vs)?, error))
    }

    /// The sixteen Bézier points of a cell, u outer.
    fn hermite_cell(&self, u: [f64; 2], v: [f64; 2]) -> [[DVec3; 4]; 4] {
        let (hu, hv) = (u[1] - u[0], v[1] - v[0]);
        let mut net = [[DVec3::ZERO; 4]; 4];
        for (i, su) in [(0, 1.0), (1, -1.0)] {
            for (j, sv) in [(0, 1.0), (1, -1.0)] {
                let corner = DVec2::new(u[i], v[j]);
                let p = self.point(corner);
                let jet = self.jet(corner + DVec2::new(su * hu, sv * hv) * INSIDE);
                let (du, dv) = (jet.du * (su * hu / 3.0), jet.dv * (sv * hv / 3.0));
                let twist = jet.duv * (su * sv * hu * hv / 9.0);
                let (i0, i1) = if i == 0 { (0, 1) } else { (3, 2) };
                let (j0, j1) = if j == 0 { (0, 1) } else { (3, 2) };
                net[i0][j0] = p;
                net[i1][j0] = p + du;
                net[i0][j1] = p + dv;
                net[i1][j1] = p + du + dv + twist;
            }
        }
        net
    }

    fn cell_errors(&self, us: &[f64], vs: &[f64]) -> CellErrors {
        let mut found =
            CellErrors { rows: vec![0.0; us.len() - 1], columns: vec![0.0; vs.len() - 1], largest: 0.0 };
        for i in 0..us.len() - 1 {
            for j in 0..vs.len() - 1 {
                let (u, v) = ([us[i], us[i + 1]], [vs[j], vs[j + 1]]);
                let net = self.hermite_cell(u, v);
                let error = |s: f64, t: f64| {
                    let curve = net.map(|row| weighted(row, cubic(t)));
                    let at = DVec2::new(u[0] + (u[1] - u[0]) * s, v[0] + (v[1] - v[0]) * t);
                    weighted(curve, cubic(s)).distance(self.point(at))
                };
                let at = |k: usize| k as f64 / (CHECKS + 1) as f64;
                let along_u =
                    (1..=CHECKS).map(|k| error(at(k), 0.0).max(error(at(k), 1.0))).fold(0.0, f64::max);
                let along_v =
                    (1..=CHECKS).map(|k| error(0.0, at(k)).max(error(1.0, at(k)))).fold(0.0, f64::max);
                let inside = (1..=CHECKS)
                    .flat_map(|k| (1..=CHECKS).map(move |l| (k, l)))
                    .map(|(k, l)| error(at(k), at(l)))
                    .fold(0.0, f64::max);
                let largest = inside.max(along_u).max(along_v);
                found.largest = found.largest.max(largest);
                // Whichever direction bends more is to blame for the inside; both where neither border shows
                // it.
                let blame_u = if along_u >= 0.5 * along_v { largest } else { along_u };
                let blame_v = if along_v >= 0.5 * along_u { largest } else { along_v };
                found.rows[i] = found.rows[i].max(blame_u);
                found.columns[j] = found.columns[j].max(blame_v);
            }
        }
        found
    }

    fn hermite_net(&self, us: &[f64], vs: &[f64]) -> Result<NurbsSurface, NurbsError> {
        let (rows, columns) = (3 * (us.len() - 1) + 1, 3 * (vs.len() - 1) + 1);
        let mut points = vec![DVec3::ZERO; rows * columns];
        for i in 0..us.len() - 1 {
            for j in 0..vs.len() - 1 {
                let net = self.hermite_cell([us[i], us[i + 1]], [vs[j], vs[j + 1]]);
                for (k, row) in net.iter().enumerate() {
                    for (l, p) in row.iter().enumerate() {
                        points[(3 * i + k) * columns + 3 * j + l] = *p;
                    }
                }
            }
        }
        NurbsSurface::new([3, 3], triple_knots(us), triple_knots(vs), points, None)
    }
}

/// Largest differences by row of cells, by column, and of all.
struct CellErrors {
    rows: Vec<f64>,
    columns: Vec<f64>,
    largest: f64,
}

/// Cubic Bernstein polynomials.
fn cubic(s: f64) -> [f64; 4] {
    let r = 1.0 - s;
    [r * r * r, 3.0 * r * r * s, 3.0 * r * s * s, s * s * s]
}

fn weighted(points: [DVec3; 4], b: [f64; 4]) -> DVec3 {
    points[0] * b[0] + points[1] * b[1] + points[2] * b[2] + points[3] * b[3]
}

/// The ends, the breaks, and the middle where there are none.
fn with_middles(range: Range, breaks: &[f64]) -> Vec<f64> {
    let mut stops = vec![range.start];
    stops.extend_from_slice(breaks);
    if breaks.is_empty() {
        stops.push(0.5 * (range.start + range.end));
    }
    stops.push(range.end);
    stops
}

fn split_where(stops: &[f64], split: impl Fn(usize) -> bool) -> Vec<f64> {
    let mut found = vec![stops[0]];
    for (i, s) in stops.windows(2).enumerate() {
        if split(i) {
            found.push(0.5 * (s[0] + s[1]));
        }
        found.push(s[1]);
    }
    found
}

/// Knots of cubic Bézier pieces: the ends four times, the others three times.
fn triple_knots(stops: &[f64]) -> Vec<f64> {
    let mut knots: Vec<f64> = stops.iter().flat_map(|&s| [s; 3]).collect();
    knots.insert(0, stops[0]);
    knots.push(stops[stops.len() - 1]);
    knots
}
