//! The two precisions that kernels run in.

use bytemuck::Pod;
use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// `f32` or `f64`: the type of a kernel's numbers, on the device and in its CPU twin.
pub trait Real:
    Pod
    + Debug
    + Default
    + PartialEq
    + PartialOrd
    + Send
    + Sync
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + 'static
{
    /// The type's name in WGSL.
    const WGSL: &'static str;
    /// Half the distance from 1 to the next number: the largest relative error of one rounding.
    const UNIT: f64;
    /// The squared product of two derivatives is rounding below this share of the longer one to the fourth
    /// power.
    const DEGENERATE: f64;
    /// The nearest number of this type.
    fn from_f64(value: f64) -> Self;
    /// The same number in double precision.
    fn to_f64(self) -> f64;
    /// The square root.
    fn square_root(self) -> Self;
    /// As WGSL's `f32(x)`.
    fn from_u32(value: u32) -> Self;
    /// 0.
    fn zero() -> Self {
        Self::default()
    }
    /// 1.
    fn one() -> Self {
        Self::from_f64(1.0)
    }
}

impl Real for f32 {
    const WGSL: &'static str = "f32";
    const UNIT: f64 = f32::EPSILON as f64 / 2.0;
    const DEGENERATE: f64 = 1e-10;
    fn from_f64(value: f64) -> Self {
        value as f32
    }
    fn to_f64(self) -> f64 {
        f64::from(self)
    }
    fn square_root(self) -> Self {
        self.sqrt()
    }
    fn from_u32(value: u32) -> Self {
        value as f32
    }
}

impl Real for f64 {
    const WGSL: &'static str = "f64";
    const UNIT: f64 = f64::EPSILON / 2.0;
    const DEGENERATE: f64 = 4e-28;
    fn from_f64(value: f64) -> Self {
        value
    }
    fn to_f64(self) -> f64 {
        self
    }
    fn square_root(self) -> Self {
        self.sqrt()
    }
    fn from_u32(value: u32) -> Self {
        f64::from(value)
    }
}
