//! The faces of a part: what became of each, its proof and its gap.

use super::Entry;
use crate::area::face_area;
use crate::names::face_kind;
use crate::placement::PartUse;
use crate::report::*;
use chordal_brep::{Face, Issue, IssueKind, MeshIssue, ResultIssue, Severity};
use chordal_tessellate::FaceReport;

/// Adds every face of a part. `rounding`: how far placing and writing may move a vertex, in millimetres.
pub(super) fn add_faces(report: &mut Report, entry: &Entry<'_>, rounding: f64) {
    let missing = FaceReport::default();
    let scale = entry.part_use.scale;
    for (index, face) in entry.part.faces.iter().enumerate() {
        let of_face = entry.meshed.report.faces.get(index).unwrap_or(&missing);
        add_face(report, entry, face, &with_moves(entry, index, of_face), rounding);
        let mesh = &entry.meshed.mesh;
        if let (Some(entry), Some(face)) = (report.faces_detail.last_mut(), mesh.faces.get(index)) {
            entry.area = scale * scale * face_area(face, &mesh.positions);
        }
    }
}

/// The distance by which sewing moved the border of a face is inaccuracy of the file as well.
fn with_moves(entry: &Entry<'_>, index: usize, of_face: &FaceReport) -> FaceReport {
    let moved = entry.sewn.and_then(|s| s.face_moves.get(index)).copied().unwrap_or(0.0);
    FaceReport { gap: of_face.gap.max(moved), ..of_face.clone() }
}

fn add_face(report: &mut Report, entry: &Entry<'_>, face: &Face, of_face: &FaceReport, rounding: f64) {
    let PartUse { instances, scale, .. } = *entry.part_use;
    let known = |length: f64| length.is_finite().then_some(length * scale);
    let (status, issue) = outcome(face, of_face);
    let gap = of_face.gap.max(of_face.pcurve_gap);
    let proven_error = known(of_face.proven_error).filter(|_| of_face.triangles > 0);
    report.boundary_error =
        report.boundary_error.zip(known(of_face.boundary_error)).map(|(all, own)| all.max(own));
    report.max_edge_gap = report.max_edge_gap.max(known(gap).unwrap_or(0.0));
    report.lower_bound += instances as f64 * of_face.lower_bound;
    match status {
        FaceStatus::Meshed => report.faces.meshed += instances,
        FaceStatus::Failed => report.faces.failed += instances,
        FaceStatus::ZeroArea => report.faces.zero_area += instances,
    }
    let mut problem = |severity, kind: IssueKind| {
        let issue = Issue::new(severity, face.source, kind);
        report
            .problems
            .push(Problem::new(&issue).in_part(&entry.part.name).of_face(report.faces_detail.len()));
    };
    if let Some((severity, kind)) = issue {
        problem(severity, kind);
    }
    if of_face.untangled > 0 {
        problem(Severity::Warning, MeshIssue::LoopsUntangled { crossings: of_face.untangled }.into());
    }
    // A fault of this program takes precedence over the problem that the method gave up.
    if let Some(issue) = of_face.mended.as_ref().or(of_face.given_up.as_ref()) {
        problem(Severity::Warning, issue.clone().into());
    }
    report.faces.given_up += instances * usize::from(of_face.given_up.is_some());
    if status == FaceStatus::Meshed {
        match proven_error.map(|error| error + rounding) {
            Some(error) => {
                report.faces.proven += instances;
                report.proven_error = Some(report.proven_error.map_or(error, |all| all.max(error)));
                let tolerance = report.options.tolerance.max(report.options.boundary_tolerance);
                if error > tolerance {
                    problem(Severity::Error, ResultIssue::OverTolerance { error, tolerance }.into());
                }
            }
            None => {
                if report.options.bound == "proven" {
                    problem(Severity::Error, ResultIssue::Unproven.into());
                }
                report.unproven_faces.push(FaceName {
                    entity: entity_name(face.source),
                    line: line_number(face.source),
                    part: entry.part.name.clone(),
                    instances,
                });
            }
        }
    }
    report.faces_detail.push(FaceEntry {
        entity: entity_name(face.source),
        line: line_number(face.source),
        kind: face_kind(face).into(),
        name: face.name.clone(),
        part: entry.part.name.clone(),
        instances,
        status,
        strategy_requested: report.options.strategy.clone(),
        strategy: strategy(report, of_face),
        triangles: of_face.triangles,
        proven_error,
        gap: known(gap),
        bound: of_face.bound.into(),
        lower_bound: of_face.lower_bound,
        area: 0.0,
    });
}

/// The strategy that made the triangles of a face.
fn strategy(report: &Report, of_face: &FaceReport) -> Option<String> {
    let by = if of_face.given_up.is_some() { "default" } else { &report.options.strategy };
    (of_face.triangles > 0).then(|| by.to_owned())
}

/// The status of a face, and the reason why it has no triangles.
fn outcome(face: &Face, of_face: &FaceReport) -> (FaceStatus, Option<(Severity, IssueKind)>) {
    if let Some(issue) = face.failure() {
        return (FaceStatus::Failed, Some((Severity::Error, issue.for_owner(face.source).kind)));
    }
    match &of_face.failed {
        Some(issue) => (FaceStatus::Failed, Some((Severity::Error, issue.clone().into()))),
        None if of_face.zero_area => {
            (FaceStatus::ZeroArea, Some((Severity::Note, ResultIssue::ZeroArea.into())))
        }
        None if of_face.triangles == 0 => {
            (FaceStatus::Failed, Some((Severity::Error, ResultIssue::NoTriangles.into())))
        }
        None => (FaceStatus::Meshed, None),
    }
}
