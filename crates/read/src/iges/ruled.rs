//! Type 118: ruled surfaces, as splines that are linear in v.
//!
//! Points of equal share of the parameter are joined. Rational curves are joined in homogeneous coordinates:
//! the lines are the same, only v runs along them at another pace.

use super::curves::{joined, segments};
use super::document::{Doc, Ix, Res};
use chordal_brep::ReadIssue;
use chordal_nurbs::{Curve, DAffine3, NurbsCurve3, NurbsError, NurbsSurface, Surface, UvBox};

/// Knots of the two curves that are nearer than this (over 0..=1) are one.
const SAME_KNOT: f64 = 1e-9;

/// 118: two curves, whether the second is run backwards, whether the surface is developable. Form 0 requires
/// equal shares of the length: for lines and arcs the same.
pub(crate) fn surface(doc: &Doc<'_>, ix: Ix) -> Res<(Surface, UvBox)> {
    let mut args = doc.open(ix)?;
    let curves = [args.reference()?, args.reference()?];
    let backwards = args.integer()? == 1;
    let bad = |error: NurbsError| doc.bad(ix, error);
    let mut simple = true;
    let mut rails = Vec::new();
    for curve in curves {
        let whole = joined(doc, ix, segments(doc, curve, &DAffine3::IDENTITY)?)?;
        simple &= matches!(whole.curve, Curve::Line { .. } | Curve::Circle { .. });
        rails.push(unit(&whole.curve.to_nurbs(whole.range).map_err(bad)?).map_err(bad)?);
    }
    if doc.entry(ix).form == 0 && !simple {
        doc.warn(ix, ReadIssue::RuledByLength);
    }
    let second = rails.pop().map(|rail| if backwards { rail.reversed() } else { rail });
    let (Some(first), Some(second)) = (rails.pop(), second) else {
        return Err(doc.bad(ix, ReadIssue::Missing { what: "second curve" }));
    };
    let (first, second) = compatible(first, second).map_err(bad)?;
    let weight = |rail: &NurbsCurve3, i: usize| rail.weights().map_or(1.0, |w| w[i]);
    let count = first.points().len();
    let points = (0..count).flat_map(|i| [first.points()[i], second.points()[i]]).collect();
    let weights = (0..count).flat_map(|i| [weight(&first, i), weight(&second, i)]).collect();
    let (degree, knots) = (first.degree(), first.knots().to_vec());
    let nurbs = NurbsSurface::new([degree, 1], knots, vec![0.0, 0.0, 1.0, 1.0], points, Some(weights));
    let nurbs = nurbs.map_err(bad)?;
    let uv = nurbs.domain();
    Ok((Surface::Nurbs(nurbs), uv))
}

/// Clamped, over 0..=1.
fn unit(curve: &NurbsCurve3) -> Result<NurbsCurve3, NurbsError> {
    let curve = curve.clamped()?;
    let domain = curve.domain();
    with_knots(&curve, |t| (t - domain.start) / domain.length())
}

fn with_knots(curve: &NurbsCurve3, map: impl Fn(f64) -> f64) -> Result<NurbsCurve3, NurbsError> {
    let knots = curve.knots().iter().map(|&t| map(t)).collect();
    let weights = curve.weights().map(<[f64]>::to_vec);
    NurbsCurve3::new(curve.degree(), knots, curve.points().to_vec(), weights)
}

/// The same curves with one degree and one knot vector.
fn compatible(mut a: NurbsCurve3, mut b: NurbsCurve3) -> Result<(NurbsCurve3, NurbsCurve3), NurbsError> {
    while a.degree() < b.degree() {
        a = a.elevated()?;
    }
    while b.degree() < a.degree() {
        b = b.elevated()?;
    }
    let known: Vec<f64> = a.knots().to_vec();
    b = with_knots(&b, |t| known.iter().copied().find(|k| (k - t).abs() <= SAME_KNOT).unwrap_or(t))?;
    let (to_a, to_b) = (missing(a.knots(), b.knots()), missing(b.knots(), a.knots()));
    Ok((a.refine(&to_a)?, b.refine(&to_b)?))
}

/// The elements of `wanted` that are not in `knots`; both are in increasing order.
fn missing(knots: &[f64], wanted: &[f64]) -> Vec<f64> {
    let mut left = knots.iter().peekable();
    let mut list = Vec::new();
    for &t in wanted {
        while left.next_if(|&&k| k < t).is_some() {}
        if left.next_if(|&&k| k == t).is_none() {
            list.push(t);
        }
    }
    list
}

#[cfg(test)]
mod tests {
    use super::*;
    use chordal_nurbs::DVec3;

    #[test]
    fn knots_of_one_are_inserted_into_the_other() {
        let line = NurbsCurve3::new(1, vec![0.0, 0.0, 1.0, 1.0], vec![DVec3::ZERO, DVec3::X], None);
        let points =
            [DVec3::Y, DVec3::new(0.3, 1.0, 1.0), DVec3::new(0.6, 1.0, 0.0), DVec3::new(1.0, 1.0, 0.0)];
        let knots = vec![0.0, 0.0, 0.0, 0.4, 1.0, 1.0, 1.0];
        let bent = NurbsCurve3::new(2, knots, points.to_vec(), None).expect("sound");
        let (a, b) = compatible(line.expect("sound"), bent.clone()).expect("compatible");
        assert_eq!(a.knots(), b.knots());
        for i in 0..=10 {
            let t = f64::from(i) / 10.0;
            assert!(a.point(t).distance(DVec3::X * t) < 1e-15);
            assert!(b.point(t).distance(bent.point(t)) < 1e-15);
        }
    }
}
