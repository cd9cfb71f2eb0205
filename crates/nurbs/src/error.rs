//! What can be wrong with a curve or a surface as given.

/// A curve or surface that cannot be built, or an operation that has no exact result.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NurbsError {
    /// The degree is 0 or above 100.
    #[error("degree {0} is not between 1 and 100")]
    Degree(usize),
    /// The number of knots is not `points + degree + 1`.
    #[error("{knots} knots for {points} control points of degree {degree} (expected {})",
        points + degree + 1)]
    KnotCount {
        /// How many knots there are.
        knots: usize,
        /// How many control points there are.
        points: usize,
        /// The degree.
        degree: usize,
    },
    /// A knot is less than the one before it, or not a number.
    #[error("knot {index} decreases from {from} to {to}")]
    KnotOrder {
        /// The index of the knot.
        index: usize,
        /// The knot before it.
        from: f64,
        /// The knot.
        to: f64,
    },
    /// All knots of the domain are equal.
    #[error("knot vector spans no parameter range")]
    EmptyDomain,
    /// The number of control points does not agree with the knots.
    #[error("control net has {found} points, expected {expected}")]
    NetSize {
        /// How many points there are.
        found: usize,
        /// How many there must be.
        expected: usize,
    },
    /// The control point with this index has a coordinate that is infinite or not a number.
    #[error("control point {0} is not finite")]
    NotFinite(usize),
    /// A weight is zero, infinite or not a number.
    #[error("weight {index} is {value}")]
    Weight {
        /// The index of the weight.
        index: usize,
        /// The weight.
        value: f64,
    },
    /// The operation has no exact result in NURBS form, for the reason given.
    #[error("no exact NURBS form: {0}")]
    NoExactForm(&'static str),
    /// The parameter range is empty, infinite or not a number.
    #[error("parameter range {0}..{1} is unbounded or empty")]
    Unbounded(f64, f64),
}
