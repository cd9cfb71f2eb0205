//! Evaluation behind one interface: five kernels, two ways to find spans, two precisions, on the device or by its twins.

mod batches;
mod on_device;
mod run;

pub use on_device::OnDevice;
pub(crate) use on_device::{empty_storage, storage};
pub(crate) use run::read_back;
pub use run::{Evaluated, Evaluation, Evaluator};

use crate::kernels::{
    self, Inputs, basis_indexed::basis_indexed, basis_packed::basis_packed, basis_unpacked::basis_unpacked,
};
use crate::layout::{Params, Row};
use crate::samples::RowTables;
use crate::{GpuError, Real, Samples, SurfaceSet};

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
    /// On the device: single precision then also rounds the knots and the parameter, relative to the whole domain. Not for the
    /// layouts that copy knots.
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
        let refuse = |what: &str| Err(GpuError::Device { doing: "planning".into(), reason: what.into() });
        if variant == Variant::Bernstein && !set.has_bezier() {
            return refuse("the set was made without Bézier nets");
        }
        if search == Search::Device && matches!(variant, Variant::Packed | Variant::Unpacked) {
            return refuse("copies of knots are made where spans are found on the host");
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

/// The CPU twins, kernel by kernel as on the device: `wanted.stride()` numbers per point.
///
/// # Errors
/// [`GpuError::Device`] where the variant does not fit the set or the search.
pub fn evaluate_twin<R: Real>(
    set: &SurfaceSet<R>,
    samples: &Samples<R>,
    variant: Variant,
    wanted: Wanted,
    search: Search,
) -> Result<Vec<R>, GpuError> {
    let plan = Plan::new(set, samples, variant, wanted, search)?;
    let mut rows = plan.tables.rows.clone();
    let mut ts = samples.ts.clone();
    if search == Search::Device {
        let (directions, breaks) = set.search_tables();
        kernels::find_spans::find_spans(&directions, &breaks, &samples.parameters, &mut rows, &mut ts);
    }
    let basis = basis_twin(set, &plan, variant, &rows, &ts);
    let inputs = Inputs {
        heads: &samples.heads,
        tiles: &samples.tiles,
        rows: &rows,
        spans: &set.spans,
        windows: &set.windows,
        net: if variant == Variant::Bernstein { &set.bezier } else { &set.net },
        basis: &basis,
        ts: &ts,
        params: Params {
            planes: plan.planes as u32,
            rows: samples.tiles.len() as u32,
            half: plan.tables.half as u32,
            ..Params::default()
        },
    };
    let mut out = vec![R::zero(); samples.len() * wanted.stride()];
    let kernel = match (variant, wanted) {
        (Variant::Direct, Wanted::Points) => kernels::direct::points,
        (Variant::Direct, Wanted::Normals) => kernels::direct::normals,
        (Variant::Direct, _) => kernels::direct::jets,
        (Variant::Bernstein, Wanted::Points) => kernels::bernstein::points,
        (Variant::Bernstein, Wanted::Normals) => kernels::bernstein::normals,
        (Variant::Bernstein, _) => kernels::bernstein::jets,
        (_, Wanted::Points) => kernels::tensor::points,
        (_, Wanted::Normals) => kernels::tensor::normals,
        _ => kernels::tensor::jets,
    };
    kernel(&inputs, &mut out);
    Ok(out)
}

/// All passes over the basis buffer; nothing for the variants without.
fn basis_twin<R: Real>(
    set: &SurfaceSet<R>,
    plan: &Plan<R>,
    variant: Variant,
    rows: &[Row],
    ts: &[R],
) -> Vec<R> {
    let mut basis = vec![R::zero(); 2 * plan.tables.half];
    let windows = &plan.tables.windows;
    for level in 1..=plan.tables.levels {
        let params = plan.params(level, variant);
        match variant {
            Variant::Indexed => basis_indexed(params, rows, &set.spans, &set.windows, ts, &mut basis),
            Variant::Unpacked => basis_unpacked(params, rows, &set.spans, windows, &mut basis),
            Variant::Packed => {
                basis_packed(params, &plan.tables.packs, windows, &mut basis);
            }
            Variant::Direct | Variant::Bernstein => {}
        }
    }
    basis
}
