//! Knot vectors and B-spline basis functions.

use crate::NurbsError;

/// The largest degree accepted.
pub(crate) const MAX_DEGREE: usize = 100;

pub(crate) fn check_knots(degree: usize, knots: &[f64], points: usize) -> Result<(), NurbsError> {
    if degree == 0 || degree > MAX_DEGREE {
        return Err(NurbsError::Degree(degree));
    }
    if points <= degree || knots.len() != points + degree + 1 {
        return Err(NurbsError::KnotCount { knots: knots.len(), points, degree });
    }
    if let Some(i) = (1..knots.len()).find(|&i| !(knots[i] >= knots[i - 1]) || !knots[i].is_finite()) {
        return Err(NurbsError::KnotOrder { index: i, from: knots[i - 1], to: knots[i] });
    }
    if !(knots[points] > knots[degree]) || !(knots[points] - knots[degree]).is_finite() {
        return Err(NurbsError::EmptyDomain);
    }
    Ok(())
}

pub(crate) fn check_weights(weights: Option<Vec<f64>>, points: usize) -> Result<Option<Vec<f64>>, NurbsError> {
    let Some(weights) = weights else { return Ok(None) };
    if weights.len() != points {
        return Err(NurbsError::NetSize { found: weights.len(), expected: points });
    }
    if let Some(index) = weights.iter().position(|w| !w.is_finite() || *w == 0.0) {
        return Err(NurbsError::Weight { index, value: weights[index] });
    }
    let same = weights.iter().all(|w| *w == weights[0]);
    Ok((!same).then_some(weights))
}
