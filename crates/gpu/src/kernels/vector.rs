//! WGSL's vectors of three and four, component by component.

use crate::Real;

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct V3<R>(pub [R; 3]);

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct V4<R>(pub [R; 4]);

macro_rules! vector {
    ($name:ident, $n:literal) => {
        impl<R: Real> std::ops::Add for $name<R> {
            type Output = Self;
            fn add(self, other: Self) -> Self {
                Self(std::array::from_fn(|i| self.0[i] + other.0[i]))
            }
        }
        impl<R: Real> std::ops::Sub for $name<R> {
            type Output = Self;
            fn sub(self, other: Self) -> Self {
                Self(std::array::from_fn(|i| self.0[i] - other.0[i]))
            }
        }
        impl<R: Real> std::ops::Mul<R> for $name<R> {
            type Output = Self;
            fn mul(self, by: R) -> Self {
                Self(std::array::from_fn(|i| self.0[i] * by))
            }
        }
    };
}
vector!(V3, 3);
vector!(V4, 4);

impl<R: Real> V4<R> {
    pub fn xyz(self) -> V3<R> {
        let [x, y, z, _] = self.0;
        V3([x, y, z])
    }
    pub fn w(self) -> R {
        self.0[3]
    }
}

/// The product of two vectors, lane by lane.
pub(crate) fn lanes<R: Real>(a: [R; 4], b: [R; 4], f: impl Fn(R, R) -> R) -> [R; 4] {
    std::array::from_fn(|i| f(a[i], b[i]))
}
