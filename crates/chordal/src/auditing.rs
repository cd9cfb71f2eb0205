//! The one place where the facade meets the audit.

use crate::edge_count::EdgeCount;
use crate::job::MeshedPart;
use crate::resolve::Resolved;
use chordal_brep::{FaceId, Model, Part};
use rayon::prelude::*;

/// What the audit found out about one part; lengths in the part's own units.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct AuditedPart {
    pub shells: Vec<AuditedShell>,
    pub degenerate_triangles: usize,
    pub duplicate_triangles: usize,
    /// One sentence each.
    pub problems: Vec<String>,
}

/// One shell.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct AuditedShell {
    pub closed_in_file: bool,
    pub open_edges: usize,
    pub inconsistent_edges: usize,
    /// Faces that should have triangles and have none.
    pub missing_faces: usize,
}

/// Audits every part that is placed.
pub(crate) fn audit_parts(model: &Model, resolved: &Resolved, parts: &[MeshedPart]) -> Vec<AuditedPart> {
    model
        .parts
        .par_iter()
        .zip(parts)
        .zip(&resolved.uses)
        .map(
            |((part, meshed), part_use)| {
                if part_use.instances == 0 { AuditedPart::default() } else { audit(part, meshed) }
            },
        )
        .collect()
}

fn audit(part: &Part, meshed: &MeshedPart) -> AuditedPart {
    let shells = part.shells.iter().map(|s| audit_shell(s.closed, &s.faces, meshed)).collect();
    AuditedPart { shells, ..AuditedPart::default() }
}

fn audit_shell(closed_in_file: bool, faces: &[FaceId], meshed: &MeshedPart) -> AuditedShell {
    let zero_area = |f: &FaceId| meshed.report.faces.get(f.index()).is_some_and(|r| r.zero_area);
    let has_triangles =
        |f: &FaceId| meshed.mesh.faces.get(f.index()).is_some_and(|m| !m.triangles.is_empty());
    let missing_faces = faces.iter().filter(|f| !has_triangles(f) && !zero_area(f)).count();
    let faces = faces.iter().filter_map(|f| meshed.mesh.faces.get(f.index()));
    let triangles = faces.flat_map(|f| f.triangles.iter().map(|t| t.map(|c| f.corners[c as usize].position)));
    let EdgeCount { open, inconsistent } = EdgeCount::of(triangles);
    AuditedShell { closed_in_file, open_edges: open, inconsistent_edges: inconsistent, missing_faces }
}
