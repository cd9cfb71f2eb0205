//! What can be wrong with a curve or a surface as given.

/// A curve or surface that cannot be built, or an operation that has no exact result.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NurbsError {
    #[error("degree {0} is not between 1 and 100")]
    Degree(usize),
    #[error("{knots} knots for {points} control points of degree {degree} (expected {})", points + degree + 1)]
    KnotCount { knots: usize, points: usize, degree: usize },
    #[error("knot {index} decreases from {from} to {to}")]
    KnotOrder { index: usize, from: f64, to: f64 },
    #[error("knot vector spans no parameter range")]
    EmptyDomain,
    #[error("control net has {found} points, expected {expected}")]
    NetSize { found: usize, expected: usize },
    #[error("control point {0} is not finite")]
    NotFinite(usize),
    #[error("weight {index} is {value}")]
    Weight { index: usize, value: f64 },
    #[error("no exact NURBS form: {0}")]
    NoExactForm(&'static str),
    #[error("parameter range {0}..{1} is unbounded or empty")]
    Unbounded(f64, f64),
}
