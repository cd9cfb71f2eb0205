//! One evaluation: its variant, requested values and search, and the tables it needs beside the surfaces.

use crate::error::{GpuError, Unsuitable};
use crate::layout::{Params, Row};
use crate::real::Real;
use crate::samples::{RowTables, Samples};
use crate::surfaces::SurfaceSet;

/// How points are calculated. All give the same points within [`crate::SurfaceEntry::point_bound`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Variant {
    /// Basis functions by passes from degree to degree, four parameters a vector (the paper's choice).
    Packed,
    /// By passes, every parameter with its own copy of its knots.
    Unpacked,
    /// By passes, every parameter pointing to the knots of its span.
    Indexed,
    /// Basis functions and sum in one kernel.
    Direct,
    /// One Bézier net a span; needs a set made by [`SurfaceSet::with_bezier`].
    Bernstein,
}

impl Variant {
    /// All, the paper's first.
    pub const ALL: [Self; 5] = [Self::Packed, Self::Unpacked, Self::Indexed, Self::Direct, Self::Bernstein];

    /// Its name, as in benchmarks.
    pub fn name(self) -> &'static str {
        match self {
            Self::Packed => "packed",
            Self::Unpacked => "unpacked",
            Self::Indexed => "indexed",
            Self::Direct => "direct",
            Self::Bernstein => "bernstein",
        }
    }

    /// True for the paper's three, which evaluate basis functions by passes.
    pub fn has_passes(self) -> bool {
        matches!(self, Self::Packed | Self::Unpacked | Self::Indexed)
    }
}

/// What is calculated at every point, in local coordinates and the surface's own parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Wanted {
    /// x, y, z.
    Points,
    /// Point, unit normal (zero where there is none).
    Normals,
    /// Point, derivatives by u and by v, unit normal.
    First,
    /// As [`Wanted::First`], then the derivatives by uu, uv and vv.
    Second,
}

impl Wanted {
    /// Numbers per point.
    pub fn stride(self) -> usize {
        match self {
            Self::Points => 3,
            Self::Normals => 6,
            Self::First => 12,
            Self::Second => 21,
        }
    }
    pub(crate) fn planes(self) -> usize {
        match self {
            Self::Points => 1,
            Self::Normals | Self::First => 2,
            Self::Second => 3,
        }
    }
}

/// Where the knot span of a parameter is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Search {
    /// Here, in double precision.
    Host,
    /// On the device: single precision then also rounds the knots and the parameter, relative to the whole
    /// domain. Not for the layouts that copy knots.
    Device,
}

/// What one evaluation needs beside the surfaces.
pub(crate) struct Plan<R> {
    pub tables: RowTables<R>,
    pub planes: usize,
}

impl<R: Real> Plan<R> {
    pub fn new(
        set: &SurfaceSet<R>,
        samples: &Samples<R>,
        variant: Variant,
        wanted: Wanted,
        search: Search,
    ) -> Result<Self, GpuError> {
        let planes = wanted.planes();
        if variant == Variant::Bernstein && !set.has_bezier() {
            return Err(GpuError::Unsuitable(Unsuitable::NoBezierNets));
        }
        if search == Search::Device && matches!(variant, Variant::Packed | Variant::Unpacked) {
            return Err(GpuError::Unsuitable(Unsuitable::SpansOnDevice));
        }
        let mut tables = match variant {
            Variant::Packed => RowTables::packed(set, samples, planes),
            Variant::Unpacked => RowTables::unpacked(set, samples, planes),
            Variant::Indexed => RowTables::indexed(set, samples, planes),
            Variant::Direct | Variant::Bernstein => {
                RowTables { rows: samples.plain_rows(), ..RowTables::default() }
            }
        };
        if search == Search::Device {
            for (row, &direction) in tables.rows.iter_mut().zip(&samples.row_directions) {
                *row = Row { window: direction, ..*row };
            }
        }
        Ok(Self { tables, planes })
    }

    pub fn params(&self, level: u32, variant: Variant) -> Params {
        let packed = variant == Variant::Packed;
        Params {
            level,
            planes: self.planes as u32,
            columns: self.tables.levels + 1,
            rows: if packed { self.tables.packs.len() } else { self.tables.rows.len() } as u32,
            half: self.tables.half as u32 / if packed { 4 } else { 1 },
            ..Params::default()
        }
    }
}
