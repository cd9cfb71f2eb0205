//! The tables of Balázs, Guthe, Klein 2004 for a model: see [`chordal_methods::papers`].

use crate::compare::placed;
use crate::error::Error;
use crate::model::Model;
use crate::options::MeshOptions;
use chordal_methods::papers::{loop_entries, surface_methods, timed};
use chordal_tessellate::Cancel;
use std::path::Path;

pub use chordal_methods::papers::{LoopEntry, PaperTables, SurfaceEntry};

/// Measures all tables on the model in `input`.
///
/// # Errors
/// Where the model cannot be read or the options make no sense for it.
pub fn paper_tables(input: &Path, options: &MeshOptions, cancel: &Cancel) -> Result<PaperTables, Error> {
    let model = Model::open(input)?;
    let resolved = |options: &MeshOptions| crate::stages::resolve(&model, options, cancel);
    let of_options = resolved(options)?;
    let parts = model.brep().parts.iter().zip(of_options.uses.iter().zip(&of_options.parts));
    let mut tables = PaperTables {
        model: input.file_name().unwrap_or_default().to_string_lossy().into_owned(),
        faces: model.face_count(),
        tolerance: of_options.tolerance,
        loops: loop_entries(parts.map(|(part, (one, options))| (part, one.instances, options.tolerance))),
        surfaces: Vec::new(),
    };
    for method in surface_methods() {
        let options = options
            .clone()
            .with_fill_method(method.fill_method())
            .with_edge_splitter(method.edge_splitter())
            .with_bound(method.bound);
        let resolved = resolved(&options)?;
        let (parts, seconds) = timed(|| crate::stages::mesh_parts(&model, &resolved, cancel));
        tables.surfaces.push(SurfaceEntry::of(&method, &placed(&model, &resolved, &parts), seconds));
    }
    Ok(tables)
}
