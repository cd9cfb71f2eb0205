//! The exact curve that a Bézier patch makes of a Bézier curve in its parameter space.
//!
//! Source: DeRose et al., *Functional composition algorithms via blossoming*; here de Casteljau's algorithm
//! with polynomials in place of numbers. Notation: the curve is `(X, Y)/W`, the patch `Σ B_i(u) B_j(v) P_ij`
//! in homogeneous coordinates. A blend of the net at `u = X/W`, cleared of the denominator, is `(W − X)·a +
//! X·b`; `du` such blends along u and `dv` along v leave one polynomial of degree `d·(du + dv)`. Products are
//! taken on scaled Bernstein coefficients, so that they are convolutions.

use crate::bernstein::{MAX_SCALED_DEGREE, product, scaled, unscaled};
use crate::homogeneous::Homogeneous;
use crate::{BezierCurve, BezierPatch, NurbsError};
use glam::{DVec2, DVec3};

type Row = Vec<Homogeneous<DVec3>>;

impl BezierPatch {
    /// The curve that the patch makes of `curve`, whose points are in the unit square's coordinates.
    ///
    /// Exact, of degree `curve.degree() * (degree[0] + degree[1])`.
    ///
    /// # Errors
    /// [`NurbsError::NoExactForm`] where that degree passes 1000 and the binomials leave the range of f64.
    pub fn compose(&self, curve: &BezierCurve<DVec2>) -> Result<BezierCurve<DVec3>, NurbsError> {
        compose(self, curve)
    }
}

fn compose(patch: &BezierPatch, curve: &BezierCurve<DVec2>) -> Result<BezierCurve<DVec3>, NurbsError> {
    let [m, n] = patch.degree;
    if curve.degree() * (m + n) > MAX_SCALED_DEGREE {
        return Err(NurbsError::NoExactForm("the composed degree passes 1000"));
    }
    let net = curve.homogeneous();
    let w = scaled(net.iter().map(|h| h.w));
    let along = |get: fn(DVec2) -> f64| {
        let above = scaled(net.iter().map(|h| get(h.v)));
        let below: Vec<f64> = w.iter().zip(&above).map(|(w, x)| w - x).collect();
        [below, above]
    };
    let (u, v) = (along(|p| p.x), along(|p| p.y));

    let origin = patch.points[0];
    let local = BezierPatch {
        degree: patch.degree,
        points: patch.points.iter().map(|&p| p - origin).collect(),
        weights: patch.weights.clone(),
    };
    let points = local.homogeneous();
    let columns: Vec<Row> =
        (0..=n).map(|j| collapse((0..=m).map(|i| vec![points[i * (n + 1) + j]]).collect(), &u)).collect();
    let composed = unscaled(&collapse(columns, &v));

    let rational = patch.weights.is_some() || curve.weights.is_some();
    let mut found = BezierCurve::from_homogeneous(composed, rational);
    found.points.iter_mut().for_each(|p| *p += origin);
    Ok(found)
}

/// De Casteljau's triangle with polynomial blends.
fn collapse(mut rows: Vec<Row>, [below, above]: &[Vec<f64>; 2]) -> Row {
    while rows.len() > 1 {
        rows = rows
            .windows(2)
            .map(|pair| {
                let mut blend = product(below, &pair[0]);
                for (sum, term) in blend.iter_mut().zip(product(above, &pair[1])) {
                    *sum += term;
                }
                blend
            })
            .collect();
    }
    rows.pop().unwrap_or_else(|| vec![Homogeneous::<DVec3>::default(); 1])
}
