//! Intervals of a parameter and boxes of parameter space.

use glam::DVec2;

/// A closed interval of a parameter; the ends may be infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    pub start: f64,
    pub end: f64,
}

impl Range {
    pub const ALL: Range = Range { start: f64::NEG_INFINITY, end: f64::INFINITY };

    pub fn new(start: f64, end: f64) -> Self {
        Self { start, end }
    }
    pub fn length(&self) -> f64 {
        self.end - self.start
    }
    pub fn is_finite(&self) -> bool {
        self.start.is_finite() && self.end.is_finite()
    }
    pub fn clamp(&self, t: f64) -> f64 {
        t.max(self.start).min(self.end)
    }
    pub fn contains(&self, t: f64) -> bool {
        t >= self.start && t <= self.end
    }
}

/// An axis-aligned box of parameter space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UvBox {
    pub min: DVec2,
    pub max: DVec2,
}

impl UvBox {
    /// The box that contains nothing.
    pub const EMPTY: UvBox = UvBox { min: DVec2::INFINITY, max: DVec2::NEG_INFINITY };

    pub fn new(min: DVec2, max: DVec2) -> Self {
        Self { min, max }
    }
    pub fn from_ranges(u: Range, v: Range) -> Self {
        Self { min: DVec2::new(u.start, v.start), max: DVec2::new(u.end, v.end) }
    }
    pub fn from_points(points: impl IntoIterator<Item = DVec2>) -> Self {
        points.into_iter().fold(Self::EMPTY, |b, p| b.including(p))
    }
    pub fn including(self, p_uv: DVec2) -> Self {
        Self { min: self.min.min(p_uv), max: self.max.max(p_uv) }
    }
    pub fn u(&self) -> Range {
        Range::new(self.min.x, self.max.x)
    }
    pub fn v(&self) -> Range {
        Range::new(self.min.y, self.max.y)
    }
    pub fn size(&self) -> DVec2 {
        self.max - self.min
    }
    pub fn center(&self) -> DVec2 {
        (self.min + self.max) * 0.5
    }
    pub fn is_finite(&self) -> bool {
        self.min.is_finite() && self.max.is_finite()
    }
    pub fn clamp(&self, p_uv: DVec2) -> DVec2 {
        p_uv.max(self.min).min(self.max)
    }
    pub fn contains(&self, p_uv: DVec2) -> bool {
        p_uv.cmpge(self.min).all() && p_uv.cmple(self.max).all()
    }
    pub fn inflated(&self, by: DVec2) -> Self {
        Self { min: self.min - by, max: self.max + by }
    }
}
