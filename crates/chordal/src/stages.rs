//! The stages of [`Mesher::mesh`](crate::Mesher::mesh) one by one, for programs that time or compare them.
//!
//! Most callers need [`Mesher`](crate::Mesher) only.

pub use crate::meshed_part::MeshedPart;
pub use crate::placement::{PartUse, part_uses};
pub use crate::resolve::Resolved;
pub use crate::sewing::sew_parts;
pub use crate::tight_box::{TightBox, edge_box, tight_box};

use crate::error::Error;
use crate::model::Model;
use crate::options::MeshOptions;
use chordal_tessellate::Cancel;

/// What the options mean for a model.
///
/// # Errors
/// [`Error::Request`] where the tolerance is below what the coordinates can represent, [`Error::File`] where
/// a coordinate is out of range.
pub fn resolve(model: &Model, options: &MeshOptions, cancel: &Cancel) -> Result<Resolved, Error> {
    crate::resolve::resolve(model.brep(), options, model.byte_count(), cancel)
        .map_err(|error| error.named(model.name()))
}

/// Meshes every placed part once, without an audit. One per part of the model, in its order; a part that is
/// never placed has an empty mesh.
pub fn mesh_parts(model: &Model, resolved: &Resolved, cancel: &Cancel) -> Vec<MeshedPart> {
    crate::meshed_part::mesh_parts(model.brep(), resolved, cancel, &|_| ()).0
}
