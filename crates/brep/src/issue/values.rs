//! Values of issues that are written with a unit or a fixed number of digits.

use super::words::{length_mm, number};
use chordal_nurbs::NurbsError;
use serde::{Serialize, Serializer};
use std::fmt;

/// A length in millimetres, written `5 mm`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Millimetres(pub f64);

impl fmt::Display for Millimetres {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&length_mm(self.0))
    }
}

/// A share in percent, written `80 %`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Percent(pub f64);

impl Percent {
    /// The share `part` of one.
    pub fn of(part: f64) -> Self {
        Self(100.0 * part)
    }
}

impl fmt::Display for Percent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} %", number(self.0, 3))
    }
}

/// A number without a unit, written with at most six significant digits.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Real(pub f64);

impl fmt::Display for Real {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&number(self.0, 6))
    }
}

/// What is wrong with the degree, knots, weights or control points of a spline.
#[derive(Clone, Debug, PartialEq)]
pub struct SplineFault(pub NurbsError);

impl fmt::Display for SplineFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

/// The sentence.
impl Serialize for SplineFault {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(&self.0)
    }
}
