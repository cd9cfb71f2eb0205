//! The one place where the facade meets the audit.

use crate::meshed_part::MeshedPart;
use crate::resolve::Resolved;
use chordal_audit::{
    AuditOptions, Claim, FaceCrossing, PartAudit, Problem, Subject, audit_part, facet_crossings,
};
use chordal_brep::{AuditIssue, Issue, Model, Part, Shell};
use chordal_mesh::PartMesh;
use chordal_tessellate::{Bound, Cancel, FaceReport, FacetCut, Options, Remembered, tessellate_part_apart};
use rayon::prelude::*;
use std::sync::Arc;

/// The findings of the audit about one part; lengths are in the units of the part.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct AuditedPart {
    pub shells: Vec<AuditedShell>,
    pub degenerate_triangles: usize,
    pub duplicate_triangles: usize,
    /// Faces of closed shells whose triangles cut each other.
    pub self_intersections: Vec<FaceCrossing>,
    /// What is wrong with it, with the index of the face where it is one.
    pub problems: Vec<(Option<u32>, Issue)>,
}

/// One shell.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct AuditedShell {
    pub closed_in_file: bool,
    pub open_edges: usize,
    pub inconsistent_edges: usize,
    /// Faces with triangles.
    pub meshed_faces: usize,
    /// Indices of the faces that should have triangles and have none.
    pub missing_faces: Vec<usize>,
}

/// Audits every part that is placed. What the audit proves of a face less tightly than the mesher takes the
/// place of the mesher's own figure. A part whose facets cut each other although its faces do not is meshed
/// again, finer there.
pub(crate) fn audit_parts(
    model: &Model,
    resolved: &Resolved,
    parts: &mut [MeshedPart],
    self_intersections: bool,
    cancel: &Cancel,
) -> Vec<AuditedPart> {
    model
        .parts
        .par_iter()
        .zip(parts.par_iter_mut())
        .zip(resolved.uses.par_iter().zip(&resolved.parts))
        .map(|((part, meshed), (part_use, options))| {
            if part_use.instances == 0 {
                AuditedPart::default()
            } else {
                let requested = AuditOptions::new(options.largest_tolerance())
                    .with_angle(limit_of_facets(options))
                    .with_proven(options.bound == Bound::Proven)
                    .with_millimetres(part_use.scale)
                    .with_self_intersections(self_intersections);
                let audit = audited(part, meshed, &requested);
                let remembered = Arc::into_inner(std::mem::take(&mut meshed.remembered));
                let remembered = remembered.unwrap_or_default();
                let audit = parted(part, meshed, remembered, audit, options, &requested, cancel);
                account_of(part, meshed, audit, options)
            }
        })
        .collect()
}

/// The largest angle along a mesh edge that facets must keep. Without a proof, the facets of a fill method of
/// another crate are those of its own estimate, which does not limit the angle.
fn limit_of_facets(options: &Options) -> Option<f64> {
    let is_estimated = options.bound == Bound::Estimated && options.fill_method.is_some();
    options.angle.filter(|_| !is_estimated)
}

/// The findings of the audit about a meshed part, and the claims of the mesher. Where loops were untangled,
/// the mesh is of the healed part.
fn audited(part: &Part, meshed: &MeshedPart, asked: &AuditOptions) -> PartAudit {
    let part = meshed.report.healed.as_deref().unwrap_or(part);
    audit_part(part, &meshed.mesh, asked, Some(&claims(meshed)))
}

fn claims(meshed: &MeshedPart) -> Vec<Claim> {
    meshed.report.faces.iter().map(claim).collect()
}

/// Meshes a part once more where facets cut each other and their faces do not, and takes this mesh if fewer
/// faces cut each other and nothing else is worse.
fn parted(
    part: &Part,
    meshed: &mut MeshedPart,
    remembered: Remembered,
    audit: PartAudit,
    options: &Options,
    asked: &AuditOptions,
    cancel: &Cancel,
) -> PartAudit {
    let meshed_part = meshed.report.healed.as_deref().unwrap_or(part);
    let crossing: Vec<u32> = audit
        .problems
        .iter()
        .filter(|problem| matches!(problem.issue, AuditIssue::SelfIntersections { .. }))
        .filter_map(|problem| if let Subject::Shell(shell) = problem.subject { Some(shell) } else { None })
        .filter(|&shell| is_proven(&meshed_part.shells[shell as usize], meshed, options))
        .collect();
    if crossing.is_empty() {
        return audit;
    }
    let find = |part: &Part, mesh: &PartMesh| -> Vec<FacetCut> {
        let cuts = facet_crossings(part, mesh, &crossing).into_iter();
        cuts.map(|cut| FacetCut { faces: cut.faces, bounds: cut.bounds }).collect()
    };
    if find(meshed_part, &meshed.mesh).is_empty() {
        return audit;
    }
    let (mesh, report) = tessellate_part_apart(part, options, cancel, &find, remembered);
    let again = MeshedPart { mesh: Arc::new(mesh), report, remembered: Arc::default() };
    let audit_again = audited(part, &again, asked);
    let is_better = audit_again.self_intersections.len() < audit.self_intersections.len()
        && audit_again.problems.len() <= audit.problems.len();
    if !is_better {
        return audit;
    }
    *meshed = again;
    audit_again
}

/// True where all faces of a shell are proven. A face without a proof has worse faults than cuts, and takes
/// long.
fn is_proven(shell: &Shell, meshed: &MeshedPart, options: &Options) -> bool {
    let is_over = |face: usize| !(meshed.report.faces[face].proven_error <= options.largest_tolerance());
    options.bound == Bound::Estimated || !shell.faces.iter().any(|face| is_over(face.index()))
}

fn account_of(part: &Part, meshed: &mut MeshedPart, audit: PartAudit, options: &Options) -> AuditedPart {
    let healed = meshed.report.healed.clone();
    let part = healed.as_deref().unwrap_or(part);
    let claims = claims(meshed);
    for (of_face, audited) in meshed.report.faces.iter_mut().zip(&audit.faces) {
        // Not where nothing is proven: that stays so.
        if of_face.proven_error < audited.proven_error {
            of_face.proven_error = audited.proven_error;
        }
        of_face.gap = of_face.gap.max(audited.gap);
    }
    let shells = part.shells.iter().zip(&audit.shells).map(|(shell, audited)| AuditedShell {
        closed_in_file: audited.closed_in_file,
        open_edges: audited.open_edges,
        inconsistent_edges: audited.inconsistent_edges,
        meshed_faces: shell.faces.iter().filter(|f| has_triangles(meshed, f.index())).count(),
        missing_faces: shell.faces.iter().map(|f| f.index()).filter(|&f| is_missing(meshed, f)).collect(),
    });
    AuditedPart {
        shells: shells.collect(),
        degenerate_triangles: audit.degenerate_triangles,
        duplicate_triangles: audit.duplicate_triangles,
        self_intersections: audit.self_intersections,
        problems: audit
            .problems
            .into_iter()
            .filter(|p| !is_reported(p, &claims, options))
            .map(issue)
            .collect(),
    }
}

fn claim(of_face: &FaceReport) -> Claim {
    Claim {
        proven_error: of_face.proven_error,
        gap: of_face.gap,
        missing: of_face.failed.is_some() || of_face.zero_area,
        needless: of_face.zero_area,
    }
}

fn issue(problem: Problem) -> (Option<u32>, Issue) {
    let face = match problem.subject {
        Subject::Face(face) => Some(face),
        _ => None,
    };
    (face, problem.into_issue())
}

fn has_triangles(meshed: &MeshedPart, face: usize) -> bool {
    meshed.mesh.faces.get(face).is_some_and(|m| !m.triangles.is_empty())
}

fn is_missing(meshed: &MeshedPart, face: usize) -> bool {
    let zero_area = meshed.report.faces.get(face).is_some_and(|r| r.zero_area);
    !zero_area && !has_triangles(meshed, face)
}

/// The report states it elsewhere: it counts shells that are not watertight, and the mesher itself reports
/// errors over the tolerance.
fn is_reported(problem: &Problem, claims: &[Claim], options: &Options) -> bool {
    let reported = |f: u32| {
        claims.get(f as usize).is_some_and(|c| !(c.proven_error <= options.largest_tolerance()) || c.missing)
    };
    match (&problem.issue, problem.subject) {
        (AuditIssue::OpenShell { .. } | AuditIssue::InconsistentEdges { .. }, _) => true,
        (AuditIssue::OverTolerance { .. }, Subject::Face(f)) => reported(f),
        _ => false,
    }
}
