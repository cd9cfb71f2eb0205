//! Splines: types 126 and 128 (rational B-splines), 112 and 114 (parametric cubics).

use super::document::{Args, Doc, Ix, Res};
use crate::assemble::replace_zero_weights;
use chordal_brep::ReadIssue;
use chordal_nurbs::{Curve, DVec3, NurbsCurve3, NurbsSurface, Range, Surface, UvBox};

/// The number of knots for an upper index and a degree, both as the file states them.
fn sizes(doc: &Doc<'_>, ix: Ix, upper: i64, degree: i64) -> Res<(usize, usize, usize)> {
    match (usize::try_from(upper), usize::try_from(degree)) {
        (Ok(upper), Ok(degree)) if (1..=100).contains(&degree) && upper >= degree && upper < 1 << 31 => {
            Ok((upper + 1, degree, upper + degree + 2))
        }
        _ => {
            let found = usize::try_from(upper.saturating_add(1)).unwrap_or(0);
            let least = usize::try_from(degree.saturating_add(1)).unwrap_or(1).max(2);
            Err(doc.bad(ix, ReadIssue::TooFew { what: "control points", found, least }))
        }
    }
}

/// The part of a domain that the file's own range leaves; all of it where that range is invalid.
fn within(domain: Range, start: f64, end: f64) -> Range {
    let range = Range::new(start.max(domain.start), end.min(domain.end));
    // Ends that are rounded to fewer digits than the knots are the knots.
    let near = |a: f64, b: f64| (a - b).abs() <= 1e-9 * domain.length();
    let range = Range::new(
        if near(range.start, domain.start) { domain.start } else { range.start },
        if near(range.end, domain.end) { domain.end } else { range.end },
    );
    if range.start < range.end { range } else { domain }
}

/// 126: K, M, four properties, knots, weights, points, range.
pub(crate) fn curve(doc: &Doc<'_>, ix: Ix) -> Res<(Curve, Range)> {
    let mut args = doc.open(ix)?;
    let (upper, degree) = (args.integer()?, args.integer()?);
    args.skip(4);
    let (count, degree, knot_count) = sizes(doc, ix, upper, degree)?;
    let knots = args.reals(knot_count)?;
    let weights = weights(doc, ix, &mut args, count)?;
    let points = points(&mut args, count)?;
    let nurbs = NurbsCurve3::new(degree, knots, points, Some(weights)).map_err(|error| doc.bad(ix, error))?;
    let domain = nurbs.domain();
    let range = match (args.optional_real(), args.optional_real()) {
        (Some(start), Some(end)) => within(domain, start, end),
        _ => domain,
    };
    Ok((Curve::Nurbs(nurbs), range))
}

fn weights(doc: &Doc<'_>, ix: Ix, args: &mut Args<'_>, count: usize) -> Res<Vec<f64>> {
    let mut weights = args.reals(count)?;
    if replace_zero_weights(&mut weights) {
        doc.warn(ix, ReadIssue::ZeroWeight);
    }
    Ok(weights)
}

fn points(args: &mut Args<'_>, count: usize) -> Res<Vec<DVec3>> {
    let flat = args.reals(count.saturating_mul(3))?;
    Ok(flat.chunks_exact(3).map(|p| DVec3::new(p[0], p[1], p[2])).collect())
}

/// 128: K1, K2, M1, M2, five properties, knots, weights and points with the first index fastest, ranges.
pub(crate) fn surface(doc: &Doc<'_>, ix: Ix) -> Res<(Surface, UvBox)> {
    let mut args = doc.open(ix)?;
    let [k1, k2, m1, m2] = [args.integer()?, args.integer()?, args.integer()?, args.integer()?];
    args.skip(5);
    let (nu, degree_u, knots_u) = sizes(doc, ix, k1, m1)?;
    let (nv, degree_v, knots_v) = sizes(doc, ix, k2, m2)?;
    let (knots_u, knots_v) = (args.reals(knots_u)?, args.reals(knots_v)?);
    let weights = weights(doc, ix, &mut args, nu.saturating_mul(nv))?;
    let points = points(&mut args, nu * nv)?;
    let turned = |i: usize| i % nv * nu + i / nv;
    let points = (0..nu * nv).map(|i| points[turned(i)]).collect();
    let weights = (0..nu * nv).map(|i| weights[turned(i)]).collect();
    let nurbs = NurbsSurface::new([degree_u, degree_v], knots_u, knots_v, points, Some(weights));
    let nurbs = nurbs.map_err(|error| doc.bad(ix, error))?;
    let domain = nurbs.domain();
    let mut ends = [None; 4];
    ends.iter_mut().for_each(|end| *end = args.optional_real());
    let uv = match ends {
        [Some(u0), Some(u1), Some(v0), Some(v1)] => {
            UvBox::from_ranges(within(domain.u(), u0, u1), within(domain.v(), v0, v1))
        }
        _ => domain,
    };
    Ok((Surface::Nurbs(nurbs), uv))
}

/// Bézier points of a cubic in powers of `s` over `0..=h`.
fn bezier(power: [DVec3; 4], h: f64) -> [DVec3; 4] {
    let [a, b, c, d] = power;
    let (b, c, d) = (b * h, c * (h * h), d * (h * h * h));
    [a, a + b / 3.0, a + b * (2.0 / 3.0) + c / 3.0, a + b + c + d]
}

/// Break points as the knots of cubic pieces that need only be continuous.
fn cubic_knots(breaks: &[f64]) -> Vec<f64> {
    let mut knots = vec![breaks[0]];
    knots.extend(breaks.iter().flat_map(|&t| [t; 3]));
    knots.push(breaks[breaks.len() - 1]);
    knots
}

/// 112: type, continuity, dimensions, N, N + 1 break points, twelve coefficients for each piece.
pub(crate) fn cubic_curve(doc: &Doc<'_>, ix: Ix) -> Res<(Curve, Range)> {
    let mut args = doc.open(ix)?;
    args.skip(3);
    let count = args.count()?;
    if count == 0 {
        return Err(doc.bad(ix, ReadIssue::TooFew { what: "pieces", found: 0, least: 1 }));
    }
    let breaks = args.reals(count + 1)?;
    let flat = args.reals(12 * count)?;
    let mut points = Vec::with_capacity(3 * count + 1);
    for (i, piece) in flat.chunks_exact(12).enumerate() {
        let power = std::array::from_fn(|k| DVec3::new(piece[k], piece[4 + k], piece[8 + k]));
        let net = bezier(power, breaks[i + 1] - breaks[i]);
        points.extend(&net[usize::from(i > 0)..]);
    }
    let nurbs =
        NurbsCurve3::new(3, cubic_knots(&breaks), points, None).map_err(|error| doc.bad(ix, error))?;
    let range = nurbs.domain();
    Ok((Curve::Nurbs(nurbs), range))
}

/// 114: type, patch type, M, N, break points along u and v, 48 coefficients for each of (M + 1)(N + 1)
/// patches, the last row and column of which mean nothing.
pub(crate) fn cubic_surface(doc: &Doc<'_>, ix: Ix) -> Res<(Surface, UvBox)> {
    let mut args = doc.open(ix)?;
    args.skip(2);
    let [m, n] = [args.count()?, args.count()?];
    if m == 0 || n == 0 {
        return Err(doc.bad(ix, ReadIssue::TooFew { what: "patches", found: 0, least: 1 }));
    }
    let (tu, tv) = (args.reals(m + 1)?, args.reals(n + 1)?);
    let mut rows: Vec<Vec<DVec3>> = Vec::new();
    for i in 0..m {
        let mut strip: Vec<Vec<DVec3>> = vec![Vec::new(); 4];
        for j in 0..n {
            let patch = args.reals(48)?;
            let (hu, hv) = (tu[i + 1] - tu[i], tv[j + 1] - tv[j]);
            // Powers of s within powers of t; each as Bézier points along u first.
            let along_u: [[DVec3; 4]; 4] = std::array::from_fn(|t| {
                let power = std::array::from_fn(|s| {
                    let k = 4 * t + s;
                    DVec3::new(patch[k], patch[16 + k], patch[32 + k])
                });
                bezier(power, hu)
            });
            for (row, line) in strip.iter_mut().enumerate() {
                let points = bezier(std::array::from_fn(|t| along_u[t][row]), hv);
                line.extend(&points[usize::from(j > 0)..]);
            }
        }
        // The patch beyond the last one.
        args.skip(48);
        rows.extend(strip.into_iter().skip(usize::from(i > 0)));
    }
    let net = rows.into_iter().flatten().collect();
    let nurbs = NurbsSurface::new([3, 3], cubic_knots(&tu), cubic_knots(&tv), net, None);
    let nurbs = nurbs.map_err(|error| doc.bad(ix, error))?;
    let uv = nurbs.domain();
    Ok((Surface::Nurbs(nurbs), uv))
}
