//! NURBS forms of curves and surfaces: exact wherever there is one, approximations where there is none.
//!
//! Source: Piegl and Tiller, *The NURBS Book*, chapters 7 and 8. A conic over t = m + θ, |θ| ≤ h, is a
//! rational quadratic with control points c(m − h), k + A/C, c(m + h) and weights 1, C, 1, where k is the
//! centre, A = c(m) − k and C = cos h (ellipse) or cosh h (hyperbola). Its parameter is x = tan(θ/2)/tan(h/2)
//! or tanh(θ/2)/tanh(h/2): not the angle. Spans are placed at the native parameters of their ends, so that
//! both parameters agree there and between them by the formula of [`ParameterMap`]. Surfaces are products of
//! two such curves.

mod curve;
mod fit;
mod parameters;
mod surface;

pub use parameters::{NurbsParameters, ParameterMap};

use crate::{NurbsError, Range};
use std::f64::consts::FRAC_PI_2;

/// The longest arc of one rational quadratic piece. Its weights stay within 0.7..=1, which keeps bounds
/// tight.
const LONGEST_ARC: f64 = FRAC_PI_2;
/// The longest piece of a hyperbola, for the same reason.
const LONGEST_HYPERBOLA: f64 = 1.0;
/// More turns or pieces than this are no edge or face of a model.
const MOST_SPANS: f64 = 4096.0;

/// Cuts a range into equal spans no longer than `longest`.
fn spans(range: Range, longest: f64) -> Result<usize, NurbsError> {
    // Rounding of a full turn must not cost a span.
    let count = (range.length() / longest - 1e-9).ceil().max(1.0);
    checked(range)?;
    if count > MOST_SPANS {
        return Err(NurbsError::Unbounded(range.start, range.end));
    }
    Ok(count as usize)
}

/// # Errors
/// [`NurbsError::Unbounded`] unless the range is finite and not empty.
fn checked(range: Range) -> Result<(), NurbsError> {
    if range.is_finite() && range.start < range.end {
        Ok(())
    } else {
        Err(NurbsError::Unbounded(range.start, range.end))
    }
}

#[cfg(test)]
mod tests;
