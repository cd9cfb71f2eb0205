//! The parts of a model, each meshed once however often it is placed.

use crate::progress::FaceCounter;
use crate::report::StageEntry;
use crate::resolve::Resolved;
use crate::work_limits::Kept;
use chordal_brep::Model;
use chordal_mesh::PartMesh;
use chordal_tessellate::{Cancel, Options, PartReport, Remembered, tessellate_part_remembered};
use rayon::prelude::*;
use std::sync::Arc;

/// The mesh of one part, and what is known about it; lengths in the part's own units.
#[derive(Clone, Debug, Default)]
pub struct MeshedPart {
    /// Its triangles.
    pub mesh: Arc<PartMesh>,
    /// What was done to its faces and edges.
    pub report: PartReport,
    /// What it takes to refine it, until the audit.
    pub(crate) remembered: Arc<Remembered>,
}

impl MeshedPart {
    /// Adds the methods that ran for the faces and edges of the part.
    pub(crate) fn add_stages(&self, stages: &mut Vec<StageEntry>) {
        for (name, faces, count) in self.report.stages() {
            match stages.iter_mut().find(|s| s.name == name) {
                Some(stage) => {
                    stage.faces += faces;
                    stage.count += count;
                }
                None => stages.push(StageEntry { name: name.into(), faces, count }),
            }
        }
    }
}

/// Meshes every placed part once, in parallel; `tell` receives the finished fraction. The result does not
/// depend on the number of threads.
///
/// One per part of the model, in its order; a part that is never placed has an empty mesh. Also what they
/// took.
pub(crate) fn mesh_parts(
    model: &Model,
    resolved: &Resolved,
    cancel: &Cancel,
    tell: &(dyn Fn(f64) + Sync),
) -> (Vec<MeshedPart>, Kept) {
    let counter = FaceCounter::start(model, resolved, tell);
    resolved.limits.keep(&resolved.parts, |options| mesh_with(model, resolved, options, cancel, &counter))
}

fn mesh_with(
    model: &Model,
    resolved: &Resolved,
    options: &[Options],
    cancel: &Cancel,
    counter: &FaceCounter<'_>,
) -> Vec<MeshedPart> {
    model
        .parts
        .par_iter()
        .zip(options)
        .zip(&resolved.uses)
        .map(|((part, options), part_use)| {
            if part_use.instances == 0 {
                return MeshedPart::default();
            }
            let of_part = counter.part(part);
            let done = |done| of_part.done(done);
            let (mesh, report, remembered) = tessellate_part_remembered(part, options, cancel, &done);
            MeshedPart { mesh: Arc::new(mesh), report, remembered: Arc::new(remembered) }
        })
        .collect()
}
