//! Intervals of a parameter and boxes of parameter space.

use glam::DVec2;

/// A closed interval of a parameter; the ends may be infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// The lower end.
    pub start: f64,
    /// The upper end.
    pub end: f64,
}

impl Range {
    /// All numbers.
    pub const ALL: Range = Range { start: f64::NEG_INFINITY, end: f64::INFINITY };

    /// The interval between two ends; `start` should not exceed `end`.
    pub fn new(start: f64, end: f64) -> Self {
        Self { start, end }
    }
    /// The length; negative if the ends are exchanged.
    pub fn length(&self) -> f64 {
        self.end - self.start
    }
    /// Whether both ends are finite.
    pub fn is_finite(&self) -> bool {
        self.start.is_finite() && self.end.is_finite()
    }
    /// The nearest number in the interval.
    pub fn clamp(&self, t: f64) -> f64 {
        t.max(self.start).min(self.end)
    }
    /// Whether a number lies in the interval or is one of its ends.
    pub fn contains(&self, t: f64) -> bool {
        t >= self.start && t <= self.end
    }
}

/// An axis-aligned box of parameter space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UvBox {
    /// The least parameters.
    pub min: DVec2,
    /// The largest parameters.
    pub max: DVec2,
}

impl UvBox {
    /// The box that contains nothing.
    pub const EMPTY: UvBox = UvBox { min: DVec2::INFINITY, max: DVec2::NEG_INFINITY };

    /// The box between two corners.
    pub fn new(min: DVec2, max: DVec2) -> Self {
        Self { min, max }
    }
    /// The box of all (u, v) with u and v in their intervals.
    pub fn from_ranges(u: Range, v: Range) -> Self {
        Self { min: DVec2::new(u.start, v.start), max: DVec2::new(u.end, v.end) }
    }
    /// The smallest box that holds the points; empty without points.
    pub fn from_points(points: impl IntoIterator<Item = DVec2>) -> Self {
        points.into_iter().fold(Self::EMPTY, |b, p| b.including(p))
    }
    /// The smallest box that holds this one and a point.
    pub fn including(self, p_uv: DVec2) -> Self {
        Self { min: self.min.min(p_uv), max: self.max.max(p_uv) }
    }
    /// The interval of u.
    pub fn u(&self) -> Range {
        Range::new(self.min.x, self.max.x)
    }
    /// The interval of v.
    pub fn v(&self) -> Range {
        Range::new(self.min.y, self.max.y)
    }
    /// The lengths of the sides.
    pub fn size(&self) -> DVec2 {
        self.max - self.min
    }
    /// The centre.
    pub fn center(&self) -> DVec2 {
        (self.min + self.max) * 0.5
    }
    /// Whether all four sides are finite.
    pub fn is_finite(&self) -> bool {
        self.min.is_finite() && self.max.is_finite()
    }
    /// The nearest point in the box.
    pub fn clamp(&self, p_uv: DVec2) -> DVec2 {
        p_uv.max(self.min).min(self.max)
    }
    /// Whether a point lies in the box or on its border.
    pub fn contains(&self, p_uv: DVec2) -> bool {
        p_uv.cmpge(self.min).all() && p_uv.cmple(self.max).all()
    }
    /// The corners counter-clockwise, from the least parameters on.
    pub fn corners(&self) -> [DVec2; 4] {
        let Self { min, max } = *self;
        [min, DVec2::new(max.x, min.y), max, DVec2::new(min.x, max.y)]
    }
    /// The sides counter-clockwise: from corner to corner, with the box on the left.
    pub fn sides(&self) -> [BoxSide; 4] {
        let corners = self.corners();
        std::array::from_fn(|k| BoxSide { index: k, from: corners[k], to: corners[(k + 1) % 4] })
    }
    /// The box with every side moved outwards, by different lengths along u and v.
    pub fn inflated(&self, by: DVec2) -> Self {
        Self { min: self.min - by, max: self.max + by }
    }
}

/// One side of a box of parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoxSide {
    /// Its place among the sides.
    index: usize,
    /// Where it starts.
    pub from: DVec2,
    /// Where it ends.
    pub to: DVec2,
}

impl BoxSide {
    /// The parameter that is constant along the side: 0 for u, 1 for v.
    pub fn axis(&self) -> usize {
        1 - self.index % 2
    }
    /// The constant parameter.
    pub fn value(&self) -> f64 {
        self.from[self.axis()]
    }
    /// Whether the side is at the upper end of the constant parameter.
    pub fn is_upper(&self) -> bool {
        matches!(self.index, 1 | 2)
    }
    /// Whether the other parameter grows along the side.
    pub fn is_forward(&self) -> bool {
        self.index < 2
    }
}
