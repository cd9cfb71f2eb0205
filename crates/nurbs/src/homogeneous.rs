//! Homogeneous coordinates: what makes every polynomial algorithm serve rational curves and surfaces
//! unchanged.

use crate::Vector;
use crate::math;
use std::ops::{Add, AddAssign, Mul, Sub};

/// A point multiplied by its weight, and the weight.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Homogeneous<V> {
    pub v: V,
    pub w: f64,
}

impl<V: Vector> Homogeneous<V> {
    #[inline]
    pub fn new(point: V, weight: f64) -> Self {
        Self { v: point * weight, w: weight }
    }
    #[inline]
    pub fn project(self) -> V {
        self.v * (1.0 / self.w)
    }
}

impl<V: Vector> Add for Homogeneous<V> {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self { v: self.v + other.v, w: self.w + other.w }
    }
}
impl<V: Vector> AddAssign for Homogeneous<V> {
    #[inline]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}
impl<V: Vector> Sub for Homogeneous<V> {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        Self { v: self.v - other.v, w: self.w - other.w }
    }
}
impl<V: Vector> Mul<f64> for Homogeneous<V> {
    type Output = Self;
    #[inline]
    fn mul(self, factor: f64) -> Self {
        Self { v: self.v * factor, w: self.w * factor }
    }
}
impl<V: Vector> Vector for Homogeneous<V> {
    fn dot(self, other: Self) -> f64 {
        self.v.dot(other.v) + self.w * other.w
    }
    fn norm(self) -> f64 {
        math::hypot(self.v.norm(), self.w)
    }
    fn all_finite(self) -> bool {
        self.v.all_finite() && self.w.is_finite()
    }
}

/// Points with their weights multiplied in; weight 1 where there are none.
pub(crate) fn homogeneous<V: Vector>(points: &[V], weights: Option<&[f64]>) -> Vec<Homogeneous<V>> {
    match weights {
        None => points.iter().map(|&v| Homogeneous { v, w: 1.0 }).collect(),
        Some(weights) => points.iter().zip(weights).map(|(&p, &w)| Homogeneous::new(p, w)).collect(),
    }
}

/// The inverse of [`homogeneous`]: points, and weights where `rational`.
pub(crate) fn projected<V: Vector>(net: Vec<Homogeneous<V>>, rational: bool) -> (Vec<V>, Option<Vec<f64>>) {
    if !rational {
        return (net.into_iter().map(|h| h.v).collect(), None);
    }
    let weights = net.iter().map(|h| h.w).collect();
    (net.into_iter().map(Homogeneous::project).collect(), Some(weights))
}

/// Turns derivatives of a homogeneous curve into derivatives of its projection, order by order.
#[inline]
pub(crate) fn project_jet<V: Vector, const R: usize>(h: [Homogeneous<V>; R]) -> [V; R] {
    const BINOMIAL: [[f64; 4]; 4] =
        [[1.0, 0.0, 0.0, 0.0], [1.0, 1.0, 0.0, 0.0], [1.0, 2.0, 1.0, 0.0], [1.0, 3.0, 3.0, 1.0]];
    let inverse = 1.0 / h[0].w;
    let mut jet = [V::default(); R];
    for k in 0..R {
        let mut sum = h[k].v;
        for i in 1..=k {
            sum = sum - jet[k - i] * (BINOMIAL[k][i] * h[i].w);
        }
        jet[k] = sum * inverse;
    }
    jet
}
