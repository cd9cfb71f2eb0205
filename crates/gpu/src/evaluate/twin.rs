//! The CPU twins of the kernels, run in the order in which the device runs them.

use super::plan::{Plan, Search, Variant, Wanted};
use crate::error::GpuError;
use crate::kernels::basis_indexed::basis_indexed;
use crate::kernels::basis_packed::basis_packed;
use crate::kernels::basis_unpacked::basis_unpacked;
use crate::kernels::{self, samples::Inputs};
use crate::layout::{Params, Row};
use crate::real::Real;
use crate::samples::Samples;
use crate::surfaces::SurfaceSet;

/// The CPU twins, kernel by kernel as on the device: `wanted.stride()` numbers per point.
///
/// # Errors
/// [`GpuError::Unsuitable`] where the variant does not fit the set or the search.
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
