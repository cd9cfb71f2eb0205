//! From results to the report: parts, then shells, then faces, then what they add up to.

mod faces;
mod ledger;
mod shells;

pub(crate) use ledger::Ledger;

use crate::auditing::AuditedPart;
use crate::meshed_part::MeshedPart;
use crate::names::{bound_name, loose_kind};
use crate::options::MeshOptions;
use crate::placement::PartUse;
use crate::report::*;
use crate::resolve::Resolved;
use crate::work_limits::Kept;
use chordal_audit::FaceCrossing;
use chordal_brep::{Issue, MeshIssue, Model, Part, ResultIssue, Severity, Source};
use chordal_sew::SewReport;
use chordal_write::{WriteSummary, WriteWarning};

/// Everything that the stages found out about one model, one entry per part.
pub(crate) struct Findings<'a> {
    pub model: &'a Model,
    pub sewn: &'a [Option<SewReport>],
    pub resolved: &'a Resolved,
    pub parts: &'a [MeshedPart],
    /// How the limits of the file were kept.
    pub kept: Kept,
    pub audits: &'a [AuditedPart],
}

/// One part with everything that is known about it.
struct Entry<'a> {
    part: &'a Part,
    part_use: &'a PartUse,
    meshed: &'a MeshedPart,
    audited: &'a AuditedPart,
    sewn: Option<&'a SewReport>,
}

/// Adds everything up. Times of the stages outside the parts are added by the ledger.
pub(crate) fn account(input: InputReport, options: &MeshOptions, found: &Findings<'_>) -> Report {
    let mut report = Report {
        schema: REPORT_SCHEMA.into(),
        version: env!("CARGO_PKG_VERSION").into(),
        input,
        options: options_report(options, found.resolved),
        boundary_error: Some(0.0),
        loose: loose(found.model),
        work: found.kept.work,
        ..Report::default()
    };
    report.problems.extend(found.model.issues.iter().map(Problem::new));
    report.problems.extend(found.kept.shares.map(|shares| Problem::new(&shares.issue())));
    for (entry, options) in entries(found).iter().zip(&found.resolved.parts) {
        add_part(&mut report, entry, options.tolerance);
        if let Some(sewn) = entry.sewn {
            report.sewing.push(SewingEntry::new(entry.part, sewn, entry.part_use.scale));
        }
        if entry.part_use.instances == 0 {
            let faces = entry.part.faces.len();
            let issue = Issue::new(Severity::Warning, entry.part.source, ResultIssue::NeverPlaced { faces });
            report.problems.push(Problem::new(&issue).in_part(&entry.part.name));
            continue;
        }
        faces::add_faces(&mut report, entry, found.resolved.rounding);
        shells::add_shells(&mut report, entry);
        let first_face = report.faces_detail.len() - entry.part.faces.len();
        report.problems.extend(entry.audited.problems.iter().map(|(face, issue)| {
            let problem = Problem::new(issue).in_part(&entry.part.name);
            match face {
                Some(face) => problem.of_face(first_face + *face as usize),
                None => problem,
            }
        }));
    }
    report.closedness = shells::closedness(&report);
    let clean = report.errors().next().is_none();
    report.clean = clean;
    report
}

fn entries<'a>(found: &Findings<'a>) -> Vec<Entry<'a>> {
    let parts = found.model.parts.iter().zip(&found.resolved.uses).zip(found.parts);
    let parts = parts.zip(found.audits.iter().zip(found.sewn));
    parts
        .map(|(((part, part_use), meshed), (audited, sewn))| Entry {
            part,
            part_use,
            meshed,
            audited,
            sewn: sewn.as_ref(),
        })
        .collect()
}

fn options_report(options: &MeshOptions, resolved: &Resolved) -> OptionsReport {
    let (mesher, limits) = (options.mesher(), options.limits());
    OptionsReport {
        tolerance: resolved.tolerance,
        tolerance_requested: options.tolerance().to_string(),
        boundary_tolerance: resolved.boundary_tolerance,
        angle: mesher.angle.map(f64::to_degrees),
        max_edge: mesher.max_edge,
        strategy: options.fill_method_name().into(),
        edge_method: options.edge_splitter_name().into(),
        sewing: options.sewing().to_string(),
        bound: bound_name(mesher.bound).into(),
        face_timeout: limits.face_timeout.map(|t| t.as_secs_f64()),
        file_timeout: limits.file_timeout.map(|t| t.as_secs_f64()),
        memory: limits.memory,
    }
}

fn add_part(report: &mut Report, entry: &Entry<'_>, tolerance: f64) {
    let Entry { part, part_use, meshed, audited, .. } = entry;
    let instances = part_use.instances;
    let stages = &meshed.report.seconds;
    report.seconds.trim += stages.heal;
    report.seconds.edges += stages.edges;
    report.seconds.faces += stages.faces;
    report.seconds.stitch += stages.stitch;
    if instances > 0 {
        meshed.add_stages(&mut report.stages);
    }
    // Where the default mesher took over from a method, nothing is missing.
    let is_missing = meshed.report.faces.iter().any(|face| face.failed.is_some());
    let severity = if is_missing { Severity::Error } else { Severity::Warning };
    for (edge, fault) in &meshed.report.edge_faults {
        let issue = Issue::new(severity, part.edges[*edge as usize].source, fault.clone());
        report.problems.push(Problem::new(&issue).in_part(&part.name));
    }
    add_given_up_edges(report, entry);
    let input_triangles: usize = part.tessellated.iter().map(|t| t.triangles.len()).sum();
    let input_points: usize = part.tessellated.iter().map(|t| t.points.len()).sum();
    report.triangles += instances * (meshed.mesh.triangle_count() + input_triangles);
    report.vertices += instances * (meshed.mesh.positions.len() + input_points);
    report.edge_rounds = report.edge_rounds.max(meshed.report.rounds);
    report.faces.total += instances * part.faces.len();
    report.faces.distinct += part.faces.len();
    report.parts.push(PartEntry {
        name: part.name.clone(),
        entity: entity_name(part.source),
        instances,
        tolerance,
        faces: part.faces.len(),
        triangles: meshed.mesh.triangle_count(),
        vertices: meshed.mesh.positions.len(),
        edge_rounds: meshed.report.rounds,
        open_edges: audited.shells.iter().map(|s| s.open_edges).sum(),
        inconsistent_edges: audited.shells.iter().map(|s| s.inconsistent_edges).sum(),
        degenerate_triangles: audited.degenerate_triangles,
        duplicate_triangles: audited.duplicate_triangles,
        self_intersections: audited.self_intersections.iter().map(|c| self_intersection(part, c)).collect(),
    });
    report.tessellated_input.extend(part.tessellated.iter().map(|item| TessellatedInput {
        entity: entity_name(item.source),
        name: item.name.clone(),
        part: part.name.clone(),
        triangles: item.triangles.len(),
        instances,
    }));
}

/// Edges that the requested edge method gave up.
fn add_given_up_edges(report: &mut Report, entry: &Entry<'_>) {
    let edges = entry.meshed.report.edges_given_up;
    if edges > 0 {
        report.edges_given_up += entry.part_use.instances * edges;
        let (method, of) = (report.options.edge_method.clone(), entry.part.edges.len());
        let kind = MeshIssue::EdgeMethodGaveUp { method, edges, of };
        let issue = Issue::new(Severity::Warning, entry.part.source, kind);
        report.problems.push(Problem::new(&issue).in_part(&entry.part.name));
    }
}

/// Curves and points that belong to no face.
pub(crate) fn loose(model: &Model) -> Vec<LooseEntry> {
    let of_part = |part: &Part| -> Vec<LooseEntry> {
        let entry = |item: &chordal_brep::LooseItem| LooseEntry {
            entity: entity_name(item.source),
            kind: loose_kind(item.kind).into(),
            name: item.name.clone(),
            part: part.name.clone(),
        };
        part.loose.iter().map(entry).collect()
    };
    model.parts.iter().flat_map(of_part).collect()
}

/// What the reader repaired, guessed or dropped, and the faces that it could not read.
pub(crate) fn model_problems(model: &Model) -> Vec<Problem> {
    model.issues.iter().map(Problem::new).chain(unread_faces(model)).collect()
}

/// The faces that could not be read.
fn unread_faces(model: &Model) -> impl Iterator<Item = Problem> {
    let of_part = |part: &Part| -> Vec<Problem> {
        let problem = |face: &chordal_brep::Face| {
            face.failure().map(|issue| Problem::new(&issue.for_owner(face.source)).in_part(&part.name))
        };
        part.faces.iter().filter_map(problem).collect()
    };
    model.parts.iter().flat_map(of_part)
}

impl Report {
    /// Adds a written file. What the rounding of the format may cost was charged to the error before, where
    /// [`MeshOptions::with_output_format`] names the format.
    pub fn add_output(&mut self, path: &str, format: chordal_write::Format, summary: &WriteSummary) {
        self.output = Some(OutputReport {
            path: path.to_owned(),
            format: format.to_string(),
            bytes: summary.bytes,
            rounding: summary.rounding_mm,
        });
        self.problems.extend(summary.warnings.iter().map(|warning| {
            Problem::new(&Issue::new(Severity::Warning, Source::default(), write_issue(warning)))
        }));
    }
}

fn write_issue(warning: &WriteWarning) -> ResultIssue {
    match *warning {
        WriteWarning::Rounding { format, rounding_mm, tolerance_mm } => ResultIssue::Rounding {
            format: format.to_string(),
            distance: rounding_mm,
            tolerance: tolerance_mm,
        },
        WriteWarning::Collapsed { triangles } => ResultIssue::CollapsedTriangles { triangles },
        WriteWarning::Sheared { placements } => ResultIssue::Sheared { placements },
        _ => ResultIssue::EmptyFile,
    }
}

fn self_intersection(part: &Part, crossing: &FaceCrossing) -> SelfIntersection {
    SelfIntersection {
        faces: crossing.faces.map(|f| entity_name(part.faces[f as usize].source)),
        triangle_pairs: crossing.facet_pairs,
        in_file: crossing.in_file,
        faces_meet: crossing.faces_meet,
    }
}
