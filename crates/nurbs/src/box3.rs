//! Axis-aligned boxes in space.

use glam::DVec3;

/// An axis-aligned box in model space; may be infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Box3 {
    /// The least coordinates.
    pub min: DVec3,
    /// The largest coordinates.
    pub max: DVec3,
}

impl Box3 {
    /// The box that contains nothing.
    pub const EMPTY: Box3 = Box3 { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };

    /// The smallest box that holds the points; empty without points.
    pub fn from_points(points: impl IntoIterator<Item = DVec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |b, p| b.including(p))
    }
    /// The smallest box that holds this one and a point.
    pub fn including(self, p_xyz: DVec3) -> Self {
        Self { min: self.min.min(p_xyz), max: self.max.max(p_xyz) }
    }
    /// The smallest box that holds both.
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }
    /// The box with every side moved outwards by a length.
    pub fn inflated(self, by: f64) -> Self {
        Self { min: self.min - by, max: self.max + by }
    }
    /// Whether the box contains nothing.
    pub fn is_empty(&self) -> bool {
        self.min.cmpgt(self.max).any()
    }
    /// Whether all six sides are finite numbers.
    pub fn is_finite(&self) -> bool {
        self.min.is_finite() && self.max.is_finite()
    }
    /// The centre.
    pub fn center(&self) -> DVec3 {
        (self.min + self.max) * 0.5
    }
    /// The length of the diagonal; zero where the box is empty.
    pub fn diagonal(&self) -> f64 {
        if self.is_empty() { 0.0 } else { (self.max - self.min).length() }
    }
    /// Whether a point lies in the box or on its border.
    pub fn contains(&self, p_xyz: DVec3) -> bool {
        p_xyz.cmpge(self.min).all() && p_xyz.cmple(self.max).all()
    }
    /// Whether two boxes have a point in common.
    pub fn meets(&self, other: &Self) -> bool {
        self.min.cmple(other.max).all() && other.min.cmple(self.max).all()
    }
    /// The distance from a point; zero inside.
    pub fn distance(&self, p_xyz: DVec3) -> f64 {
        (self.min - p_xyz).max(p_xyz - self.max).max(DVec3::ZERO).length()
    }
}
