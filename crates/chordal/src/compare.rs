//! The same model by several strategies, side by side.

use crate::error::Error;
use crate::meshed_part::MeshedPart;
use crate::model::Model;
use crate::options::MeshOptions;
use crate::resolve::Resolved;
use chordal_methods::StrategyEntry;
use chordal_methods::compare::{MeshedUse, bound_name, fewest_triangles};
use chordal_tessellate::{Bound, Cancel, Stopwatch};

pub use chordal_methods::compare::{COMPARE_SCHEMA, ComparedRow, Comparison, PhaseSeconds, StageCount, plot};

/// Meshes the model once for every strategy and bound. The lower bound of triangles is that of the first row:
/// it is a property of the model, up to rounding.
///
/// # Errors
/// Where the model cannot be read or the options make no sense for it.
pub fn compare(
    model: &Model,
    options: &MeshOptions,
    strategies: &[&StrategyEntry],
    bounds: &[Bound],
    cancel: &Cancel,
    tell: &mut dyn FnMut(&ComparedRow),
) -> Result<Comparison, Error> {
    let mut comparison = Comparison {
        schema: COMPARE_SCHEMA.into(),
        model: model.name().to_owned(),
        angle: options.mesher().angle.map(f64::to_degrees),
        faces: model.face_count(),
        edge_method: options.edge_splitter_name().into(),
        ..Comparison::default()
    };
    let mut fewest = None;
    for strategy in strategies {
        for &bound in bounds {
            let options = options.clone().with_fill_method(strategy.fill_method()).with_bound(bound);
            let resolved = crate::stages::resolve(model, &options, cancel)?;
            comparison.tolerance = resolved.tolerance;
            let clock = Stopwatch::of_process();
            let parts = crate::stages::mesh_parts(model, &resolved, cancel);
            let seconds = clock.seconds();
            if cancel.is_cancelled() {
                return Err(Error::Cancelled);
            }
            let uses = placed(model, &resolved, &parts);
            let fewest = *fewest.get_or_insert_with(|| fewest_triangles(&uses));
            let row = ComparedRow {
                strategy: strategy.name.into(),
                bound: bound_name(bound).into(),
                seconds,
                ..ComparedRow::of(&uses, fewest)
            };
            tell(&row);
            comparison.rows.push(row);
        }
    }
    Ok(comparison)
}

/// The parts that are placed.
pub(crate) fn placed<'a>(
    model: &'a Model,
    resolved: &Resolved,
    parts: &'a [MeshedPart],
) -> Vec<MeshedUse<'a>> {
    let uses = model.brep().parts.iter().zip(&resolved.uses).zip(parts);
    uses.filter(|((_, part_use), _)| part_use.instances > 0)
        .map(|((part, part_use), meshed)| MeshedUse {
            part,
            mesh: &meshed.mesh,
            report: &meshed.report,
            instances: part_use.instances,
            scale: part_use.scale,
        })
        .collect()
}
