//! From results to the report.

use crate::auditing::{AuditedPart, AuditedShell};
use crate::compare::add_stages;
use crate::info::{loose, warnings};
use crate::job::{Job, MeshedPart};
use crate::names::{bound_name, entity_id, face_kind};
use crate::placement::PartUse;
use crate::process::peak_memory;
use crate::report::*;
use crate::resolve::Resolved;
use crate::sewing::SewingEntry;
use chordal_brep::{Face, Model, Part};
use chordal_sew::SewReport;
use chordal_tessellate::{Bound, FaceReport};
use chordal_write::{Format, WriteSummary};
use std::path::Path;
use std::time::Instant;

/// The clock of a job.
#[derive(Debug)]
pub(crate) struct Ledger {
    started: Instant,
    seconds: Seconds,
}

impl Ledger {
    pub fn start() -> Self {
        Self { started: Instant::now(), seconds: Seconds::default() }
    }

    /// Runs one stage and books its wall time.
    pub fn time<T>(&mut self, stage: impl Fn(&mut Seconds) -> &mut f64, work: impl FnOnce() -> T) -> T {
        let started = Instant::now();
        let result = work();
        *stage(&mut self.seconds) += started.elapsed().as_secs_f64();
        result
    }

    /// Writes times, memory and threads into the report.
    pub fn close(self, report: &mut Report) {
        let s = &mut report.seconds;
        (s.read, s.sew, s.resolve, s.audit, s.write) = (
            self.seconds.read,
            self.seconds.sew,
            self.seconds.resolve,
            self.seconds.audit,
            self.seconds.write,
        );
        s.total = self.started.elapsed().as_secs_f64();
        report.peak_memory = peak_memory();
        report.threads = rayon::current_num_threads();
    }
}

/// One part with everything that is known about it.
struct Entry<'a> {
    part: &'a Part,
    part_use: &'a PartUse,
    meshed: &'a MeshedPart,
    audited: &'a AuditedPart,
    sewn: Option<&'a SewReport>,
}

impl Entry<'_> {
    /// Every face with what was reported about it, if anything was.
    fn faces(&self) -> impl Iterator<Item = (&Face, Option<&FaceReport>)> {
        self.part.faces.iter().enumerate().map(|(i, face)| (face, self.meshed.report.faces.get(i)))
    }

    /// What sewing moved the border of a face by is looseness of the file as well.
    fn with_moves(&self, index: usize, of_face: &FaceReport) -> FaceReport {
        let moved = self.sewn.and_then(|s| s.face_moves.get(index)).copied().unwrap_or(0.0);
        FaceReport { gap: of_face.gap.max(moved), ..of_face.clone() }
    }
}

/// Adds everything up. Times of the stages outside the parts are added by the ledger.
pub(crate) fn account(
    job: &Job,
    model: &Model,
    sewn: &[Option<SewReport>],
    resolved: &Resolved,
    parts: &[MeshedPart],
    audits: &[AuditedPart],
) -> Report {
    let entries: Vec<Entry> = model
        .parts
        .iter()
        .zip(&resolved.uses)
        .zip(parts.iter().zip(audits))
        .zip(sewn)
        .map(|(((part, part_use), (meshed, audited)), sewn)| Entry {
            part,
            part_use,
            meshed,
            audited,
            sewn: sewn.as_ref(),
        })
        .collect();
    let mut report = Report {
        schema: REPORT_SCHEMA.into(),
        version: env!("CARGO_PKG_VERSION").into(),
        input: input_report(job, model, resolved),
        options: options_report(job, resolved),
        boundary_error: Some(0.0),
        loose: loose(model),
        warnings: warnings(model),
        ..Report::default()
    };
    for (entry, options) in entries.iter().zip(&resolved.parts) {
        add_part(&mut report, entry, options.tolerance);
        add_shells(&mut report, entry);
        if let Some(sewn) = entry.sewn {
            report.sewing.push(SewingEntry::new(entry.part, sewn, entry.part_use.scale));
        }
        if entry.part_use.instances == 0 {
            report.warnings.push(never_placed(entry.part));
            continue;
        }
        let missing =
            FaceReport { failed: Some("nothing was reported about it".into()), ..FaceReport::default() };
        for (index, (face, of_face)) in entry.faces().enumerate() {
            let of_face = entry.with_moves(index, of_face.unwrap_or(&missing));
            add_face(&mut report, entry, face, &of_face);
        }
    }
    report.watertight = report.shells.watertight == report.shells.closed_in_file;
    report.proven_error = proven_error(&report, resolved.rounding);
    report.undone = undone(&report, job.options.bound);
    report.clean = report.undone.is_empty();
    report
}

fn input_report(job: &Job, model: &Model, resolved: &Resolved) -> InputReport {
    InputReport {
        path: job.input.display().to_string(),
        bytes: std::fs::metadata(&job.input).map_or(0, |m| m.len()),
        schema: model.schema.clone(),
        unit: model.unit.clone(),
        diagonal: resolved.diagonal,
    }
}

fn options_report(job: &Job, resolved: &Resolved) -> OptionsReport {
    let options = &job.options;
    OptionsReport {
        tolerance: resolved.tolerance,
        tolerance_asked: options.tolerance.to_string(),
        boundary_tolerance: resolved.boundary_tolerance,
        angle: options.angle.map(f64::to_degrees),
        max_edge: options.max_edge,
        strategy: options.strategy.name().into(),
        edge_method: options.edge_method.name().into(),
        sew: options.sew.to_string(),
        bound: bound_name(options.bound).into(),
        face_timeout: options.face_timeout.map(|t| t.as_secs_f64()),
        strict: options.strict,
    }
}

fn add_part(report: &mut Report, entry: &Entry<'_>, tolerance: f64) {
    let Entry { part, part_use, meshed, audited, .. } = entry;
    let instances = part_use.instances;
    let stages = &meshed.report.seconds;
    report.seconds.heal += stages.heal;
    report.seconds.edges += stages.edges;
    report.seconds.faces += stages.faces;
    report.seconds.stitch += stages.stitch;
    if instances > 0 {
        add_stages(&mut report.stages, meshed);
    }
    let passed_through: usize = part.tessellated.iter().map(|t| t.triangles.len()).sum();
    let passed_points: usize = part.tessellated.iter().map(|t| t.points.len()).sum();
    report.triangles += instances * (meshed.mesh.triangle_count() + passed_through);
    report.vertices += instances * (meshed.mesh.positions.len() + passed_points);
    report.rounds = report.rounds.max(meshed.report.rounds);
    report.faces.total += instances * part.faces.len();
    report.faces.distinct += part.faces.len();
    report.parts.push(PartEntry {
        name: part.name.clone(),
        id: entity_id(part.source),
        instances,
        tolerance,
        faces: part.faces.len(),
        triangles: meshed.mesh.triangle_count(),
        vertices: meshed.mesh.positions.len(),
        rounds: meshed.report.rounds,
        open_edges: audited.shells.iter().map(|s| s.open_edges).sum(),
        inconsistent_edges: audited.shells.iter().map(|s| s.inconsistent_edges).sum(),
        degenerate_triangles: audited.degenerate_triangles,
        duplicate_triangles: audited.duplicate_triangles,
        problems: audited.problems.iter().map(ToString::to_string).collect(),
    });
    report.passed_through.extend(part.tessellated.iter().map(|item| PassedThroughEntry {
        id: entity_id(item.source),
        name: item.name.clone(),
        part: part.name.clone(),
        triangles: item.triangles.len(),
        instances,
    }));
}

fn never_placed(part: &Part) -> WarningEntry {
    let message =
        format!("the part `{}` is never placed: its {} faces are not meshed", part.name, part.faces.len());
    WarningEntry { id: entity_id(part.source), line: part.source.line, message, lost: false }
}

fn add_shells(report: &mut Report, entry: &Entry<'_>) {
    let instances = entry.part_use.instances;
    let sound = |s: &AuditedShell| s.open_edges == 0 && s.inconsistent_edges == 0 && s.missing_faces == 0;
    for shell in &entry.audited.shells {
        report.shells.total += instances;
        if shell.closed_in_file {
            report.shells.closed_in_file += instances;
            report.shells.watertight += if sound(shell) { instances } else { 0 };
            report.open_edges += instances * shell.open_edges;
            report.inconsistent_edges += instances * shell.inconsistent_edges;
        }
    }
}

fn add_face(report: &mut Report, entry: &Entry<'_>, face: &Face, of_face: &FaceReport) {
    let PartUse { instances, scale, .. } = *entry.part_use;
    let known = |length: f64| length.is_finite().then_some(length * scale);
    let failed = |reason: String| FailedFace {
        id: entity_id(face.source),
        line: face.source.line,
        kind: face_kind(face).into(),
        name: face.name.clone(),
        part: entry.part.name.clone(),
        instances,
        reason,
    };
    match &of_face.failed {
        Some(reason) => report.faces.failed.push(failed(reason.clone())),
        None if of_face.zero_area => {
            report.faces.zero_area.push(failed("no area at the accuracy of the file".into()));
        }
        None if of_face.triangles == 0 => {
            report.faces.failed.push(failed("no triangle came out of it".into()))
        }
        None => report.faces.meshed += instances,
    }
    let gap = of_face.gap.max(of_face.pcurve_gap);
    report.boundary_error =
        report.boundary_error.zip(known(of_face.boundary_error)).map(|(all, own)| all.max(own));
    report.max_gap = report.max_gap.max(known(gap).unwrap_or(0.0));
    report.lower_bound += instances as f64 * of_face.lower_bound;
    report.face_list.push(FaceEntry {
        id: entity_id(face.source),
        line: face.source.line,
        kind: face_kind(face).into(),
        part: entry.part.name.clone(),
        instances,
        triangles: of_face.triangles,
        proven_error: known(of_face.proven_error),
        gap: known(gap),
        bound: of_face.bound.into(),
        lower_bound: of_face.lower_bound,
    });
}

/// The largest error of all faces that have triangles, with the rounding of the written numbers; `None` where one of
/// them has no proof, or where there is none and only triangles of the file are passed through.
fn proven_error(report: &Report, rounding: f64) -> Option<f64> {
    let mut meshed = report.face_list.iter().filter(|f| f.triangles > 0 && f.instances > 0).peekable();
    if meshed.peek().is_none() && !report.passed_through.is_empty() {
        return None;
    }
    let largest = meshed.map(|f| f.proven_error).try_fold(0.0, |largest, e| Some(f64::max(largest, e?)));
    largest.map(|error| error + rounding)
}

/// One sentence for everything that was left undone.
fn undone(report: &Report, bound: Bound) -> Vec<String> {
    let mut undone = Vec::new();
    let failed: usize = report.faces.failed.iter().map(|f| f.instances).sum();
    if let Some(first) = report.faces.failed.first() {
        let id =
            if first.id.is_empty() { String::new() } else { format!(" {} (line {})", first.id, first.line) };
        undone.push(format!(
            "{failed} of {} faces failed; the first is the {} face{id}: {}",
            report.faces.total, first.kind, first.reason
        ));
    }
    let mut lost = report.warnings.iter().filter(|w| w.lost);
    if let Some(first) = lost.next() {
        let others = match lost.count() {
            0 => String::new(),
            n => format!(" (and {n} more)"),
        };
        let at = place(&first.id, first.line);
        undone.push(format!("part of the file's shape may be missing: {at}{}{others}", first.message));
    }
    let tolerance = report.options.tolerance.max(report.options.boundary_tolerance);
    match report.proven_error {
        Some(error) if error > tolerance => {
            undone.push(format!(
                "the proven error is {error:.4e} mm, over the tolerance of {tolerance:.4e} mm"
            ));
        }
        None if bound == Bound::Proven => {
            let unproven =
                report.face_list.iter().filter(|f| f.triangles > 0 && f.proven_error.is_none()).count();
            if unproven > 0 {
                undone.push(format!("the error of {unproven} faces is not proven"));
            }
        }
        _ => (),
    }
    if !report.watertight {
        undone.push(format!(
            "{} of {} closed shells are not watertight: {} open and {} inconsistent edges",
            report.shells.closed_in_file - report.shells.watertight,
            report.shells.closed_in_file,
            report.open_edges,
            report.inconsistent_edges
        ));
    }
    undone.extend(report.parts.iter().filter_map(audit_sentence));
    undone
}

fn place(id: &str, line: u32) -> String {
    match (id.is_empty(), line) {
        (true, 0) => String::new(),
        (true, line) => format!("line {line}: "),
        (false, line) => format!("{id} (line {line}): "),
    }
}

fn audit_sentence(part: &PartEntry) -> Option<String> {
    let first = part.problems.first()?;
    let name = if part.name.is_empty() { String::new() } else { format!(" of part `{}`", part.name) };
    Some(match part.problems.len() - 1 {
        0 => format!("the audit{name} found: {first}"),
        more => format!("the audit{name} found: {first} (and {more} more)"),
    })
}

impl Report {
    /// Books the written file. What the format's rounding really cost was kept back already.
    pub(crate) fn add_output(&mut self, path: &Path, format: Format, summary: &WriteSummary) {
        self.output = Some(OutputReport {
            path: path.display().to_string(),
            format: format.to_string(),
            bytes: summary.bytes,
            rounding: summary.rounding_mm,
        });
        self.warnings.extend(
            summary
                .warnings
                .iter()
                .map(|w| WarningEntry { message: w.to_string(), ..WarningEntry::default() }),
        );
    }
}
