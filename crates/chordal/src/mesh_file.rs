//! Mesh files, whoever wrote them: checked, compared with a CAD model, sewn.

mod against;
mod check;
mod sewing;

pub use against::{AgainstReport, WorstFace};
pub use check::{CHECK_SCHEMA, CheckReport, check_mesh};
pub use sewing::{LevelEntry, MeshSewing, MeshSewingReport, OpenBorderEntry, SEW_SCHEMA, sew_mesh_file};
