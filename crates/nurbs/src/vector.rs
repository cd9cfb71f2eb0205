//! The few operations that basis functions and Bézier algorithms need of a point, whatever its dimension.

use glam::{DVec2, DVec3, DVec4};
use std::fmt::Debug;
use std::ops::{Add, AddAssign, Mul, Sub};

/// A real vector space element: `f64`, `DVec2`, `DVec3`, `DVec4`.
pub trait Vector:
    Copy
    + Debug
    + Default
    + PartialEq
    + Send
    + Sync
    + Add<Output = Self>
    + AddAssign
    + Sub<Output = Self>
    + Mul<f64, Output = Self>
{
    /// Inner product.
    fn dot(self, other: Self) -> f64;
    /// Euclidean length.
    fn norm(self) -> f64;
    /// True where every component is finite.
    fn all_finite(self) -> bool;
}

impl Vector for f64 {
    fn dot(self, other: Self) -> f64 {
        self * other
    }
    fn norm(self) -> f64 {
        self.abs()
    }
    fn all_finite(self) -> bool {
        self.is_finite()
    }
}

macro_rules! vector {
    ($($t:ty),*) => {$(
        impl Vector for $t {
            fn dot(self, other: Self) -> f64 { <$t>::dot(self, other) }
            fn norm(self) -> f64 { self.length() }
            fn all_finite(self) -> bool { self.is_finite() }
        }
    )*};
}
vector!(DVec2, DVec3, DVec4);

/// The largest of some non-negative values; infinity where one is not a number, so that no overflow passes as
/// proof.
pub(crate) fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(0.0, |most, value| if value.is_nan() { f64::INFINITY } else { most.max(value) })
}
