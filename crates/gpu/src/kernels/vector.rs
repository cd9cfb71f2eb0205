//! WGSL's numbers and its vectors of three and four, component by component.

use super::basis_pass::Value;
use crate::real::Real;
use bytemuck::{Pod, Zeroable};

macro_rules! vector {
    ($(#[$what:meta])* $name:ident, $n:literal) => {
        $(#[$what])*
        #[repr(transparent)]
        #[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
        pub(crate) struct $name<R>(pub [R; $n]);

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
        impl<R: Real> Value<R> for $name<R> {
            fn splat(value: R) -> Self {
                Self([value; $n])
            }
            fn times(self, other: Self) -> Self {
                Self(std::array::from_fn(|i| self.0[i] * other.0[i]))
            }
            fn quotient(self, by: Self) -> Self {
                let zero = R::zero();
                Self(std::array::from_fn(|i| if by.0[i] == zero { zero } else { self.0[i] / by.0[i] }))
            }
        }
    };
}
vector!(
    /// A number by itself, where code is shared with vectors.
    V1,
    1
);
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
