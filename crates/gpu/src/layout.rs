//! The records that kernels read, field by field as in `kernels/common.wgsl`.

use bytemuck::{Pod, Zeroable};

/// One non-empty knot span. At `window`: 1 / length, then the knots s-p .. s+p+1 with the span made 0..1.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct Span {
    pub window: u32,
    /// The first control point with a basis function that is not zero.
    pub first: u32,
    pub degree: u32,
    /// Its number among the spans of its direction.
    pub cell: u32,
}

/// One grid or list of points on one surface.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct Head {
    pub net: u32,
    pub stride: u32,
    pub bezier: u32,
    pub cells_v: u32,
    pub row_u: u32,
    pub row_v: u32,
    pub width: u32,
    pub height: u32,
    /// The number of its first point.
    pub first: u32,
    /// 1: a list of points, 0: a grid.
    pub paired: u32,
    pub spare: [u32; 2],
}

impl Head {
    /// The number of its points.
    pub fn points(&self) -> u32 {
        if self.paired == 1 { self.width } else { self.width * self.height }
    }

    /// The number of its tiles.
    pub fn tiles(&self) -> usize {
        let of = |count: u32, size: u32| count.div_ceil(size) as usize;
        if self.paired == 1 { of(self.width, 64) } else { of(self.width, 8) * of(self.height, 8) }
    }
}

/// 64 points of one head.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct Tile {
    pub head: u32,
    pub i: u32,
    pub j: u32,
    pub spare: u32,
}

/// One parameter value; in packs of four, `span` is the degree and the others count vectors.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct Row {
    pub span: u32,
    pub window: u32,
    pub basis: u32,
    pub step: u32,
}

/// What differs from dispatch to dispatch.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct Params {
    pub level: u32,
    pub planes: u32,
    pub columns: u32,
    /// Rows, packs, or for the point kernels one past the last tile.
    pub rows: u32,
    pub tile0: u32,
    pub out0: u32,
    pub half: u32,
    pub groups: u32,
}

/// One direction of one surface, for the search for spans on the device.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct Direction {
    pub breaks: u32,
    pub span: u32,
    pub count: u32,
    pub spare: u32,
}
