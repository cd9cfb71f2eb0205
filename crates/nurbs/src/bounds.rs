//! Bounds of second derivatives over boxes of parameter space: what every proof of a facet rests on.

use crate::{Surface, UvBox};
use glam::DVec3;

/// All vectors within `radius` of `center`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    pub center: DVec3,
    pub radius: f64,
}

/// Enclosures of the second derivatives of a surface over a box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SecondDerivativeBounds {
    pub duu: Ball,
    pub duv: Ball,
    pub dvv: Ball,
}

/// A surface prepared for quick bounds over many boxes.
#[derive(Clone, Debug)]
pub struct SurfaceBounds<'a> {
    surface: &'a Surface,
    domain: UvBox,
}

impl<'a> SurfaceBounds<'a> {
    /// Prepares bounds for boxes inside `domain`.
    pub fn new(surface: &'a Surface, domain: UvBox) -> Self {
        Self { surface, domain }
    }
    pub fn surface(&self) -> &'a Surface {
        self.surface
    }
    pub fn domain(&self) -> UvBox {
        self.domain
    }
}
