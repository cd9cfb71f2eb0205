//! The shells of a part: closed, open by design, or leaking.

use super::Entry;
use crate::auditing::AuditedShell;
use crate::report::*;
use chordal_brep::{Issue, ResultIssue, Severity, Source};

/// Whether one shell is closed in the mesh, as far as the file lets us judge.
fn judge(shell: &AuditedShell) -> Closedness {
    if shell.open_edges == 0 && shell.inconsistent_edges == 0 && shell.missing_faces.is_empty() {
        Closedness::Closed
    } else if shell.closed_in_file {
        Closedness::Leaking
    } else {
        Closedness::OpenByDesign
    }
}

/// Adds the shells of a part, with a problem for each that leaks.
pub(super) fn add_shells(report: &mut Report, entry: &Entry<'_>) {
    let instances = entry.part_use.instances;
    let faces = &entry.meshed.mesh.faces;
    let mut free: Vec<bool> = faces.iter().map(|face| !face.triangles.is_empty()).collect();
    for face in entry.part.shells.iter().flat_map(|shell| &shell.faces) {
        if let Some(free) = free.get_mut(face.index()) {
            *free = false;
        }
    }
    report.shells.free_faces += instances * free.iter().filter(|&&free| free).count();
    for (index, shell) in entry.audited.shells.iter().enumerate() {
        // A shell of faces without area, or without faces, has no surface that could be open.
        if shell.meshed_faces == 0 && shell.missing_faces.is_empty() {
            continue;
        }
        report.shells.total += instances;
        if shell.closed_in_file {
            report.shells.closed_in_file += instances;
            report.open_edges += instances * shell.open_edges;
            report.inconsistent_edges += instances * shell.inconsistent_edges;
            report.missing_faces += instances * shell.missing_faces.len();
        }
        match judge(shell) {
            Closedness::Closed => report.shells.closed += instances,
            Closedness::OpenByDesign => report.shells.open_by_design += instances,
            Closedness::Leaking => {
                report.shells.leaking += instances;
                report.problems.push(leak(entry, index, shell));
            }
        }
    }
}

fn leak(entry: &Entry<'_>, index: usize, shell: &AuditedShell) -> Problem {
    let missing_faces: Vec<Source> =
        shell.missing_faces.iter().map(|&face| entry.part.faces[face].source).collect();
    let (open_edges, inconsistent_edges) = (shell.open_edges, shell.inconsistent_edges);
    let kind = ResultIssue::Leaking { open_edges, inconsistent_edges, missing_faces };
    let issue = Issue::new(Severity::Error, entry.part.shells[index].source, kind);
    Problem::new(&issue).in_part(&entry.part.name)
}

/// The sum of all shells. A face outside every shell is open by design: no shell of the file joins it.
pub(super) fn closedness(report: &Report) -> Option<Closedness> {
    let shells = &report.shells;
    if shells.leaking > 0 {
        Some(Closedness::Leaking)
    } else if report.faces.meshed == 0 {
        None
    } else if shells.closed > 0 && shells.open_by_design + shells.free_faces == 0 {
        Some(Closedness::Closed)
    } else {
        Some(Closedness::OpenByDesign)
    }
}
