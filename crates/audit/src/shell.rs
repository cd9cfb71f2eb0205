//! A shell: closed and oriented by the identity of vertices, so that parts that touch do not mix.

use crate::face::FaceFindings;
use crate::part::Context;
use crate::report::{Problem, ProblemKind, ShellAudit, Subject};
use chordal_brep::Loop;
use rustc_hash::FxHashMap;

/// What was found out about one shell.
#[derive(Debug, Default)]
pub(crate) struct ShellFindings {
    pub audit: ShellAudit,
    /// Between different faces.
    pub duplicates: usize,
    pub problems: Vec<Problem>,
}

/// A half-edge between positions as a sortable key: both ends, then the direction.
pub(crate) fn half_key(from: u32, to: u32) -> (u64, bool) {
    let (low, high) = (from.min(to), from.max(to));
    (u64::from(low) << 32 | u64::from(high), from > to)
}

/// Audits a shell whose volume should have the sign `sign` (zero: unknown).
pub(crate) fn audit_shell(
    context: &Context<'_>,
    faces: &[FaceFindings],
    index: usize,
    sign: i8,
) -> ShellFindings {
    let shell = &context.part.shells[index];
    let of_shell = || shell.faces.iter().map(|f| &faces[f.index()]);
    let needless = |face: usize| context.claims.is_some_and(|c| c.get(face).is_some_and(|c| c.needless));
    let audit = ShellAudit {
        shell: index as u32,
        closed_in_file: shell.closed,
        complete: of_shell().zip(&shell.faces).all(|(f, id)| f.audit.triangles > 0 || needless(id.index())),
        volume: of_shell().map(|f| f.volume).sum(),
        ..ShellAudit::default()
    };
    let mut found = ShellFindings { audit, ..ShellFindings::default() };
    count_edges(context, faces, index, &mut found.audit);
    found.duplicates = shared_duplicates(of_shell());
    found.audit.watertight = found.audit.open_edges == 0 && found.audit.inconsistent_edges == 0;
    describe(context, sign, &mut found);
    found
}

fn count_edges(context: &Context<'_>, faces: &[FaceFindings], index: usize, audit: &mut ShellAudit) {
    let shell = &context.part.shells[index];
    let mut keys: Vec<(u64, bool)> =
        shell.faces.iter().flat_map(|f| faces[f.index()].shared.iter().copied()).collect();
    keys.sort_unstable();
    let mut uses = None;
    for group in keys.chunk_by(|a, b| a.0 == b.0) {
        let back = group.iter().filter(|k| k.1).count();
        let balanced = 2 * back == group.len();
        match group.len() {
            2 if balanced => {}
            n => {
                let uses = uses.get_or_insert_with(|| model_uses(context, index));
                let of_model = uses.get(&group[0].0).copied().unwrap_or_default();
                let of_model_open = of_model.there + of_model.back == 1;
                audit.open_edges += usize::from(n == 1);
                audit.open_in_file += usize::from(n == 1 && of_model_open);
                audit.inconsistent_edges += usize::from(n > 1 && !balanced);
                audit.inconsistent_in_file +=
                    usize::from(n > 1 && !balanced && of_model.there != of_model.back);
                audit.non_manifold_edges += usize::from(n > 2 && of_model.there + of_model.back != n);
            }
        }
    }
}

/// How many times the faces of a shell use a chord, in each direction.
#[derive(Clone, Copy, Debug, Default)]
struct Uses {
    there: usize,
    back: usize,
}

fn model_uses(context: &Context<'_>, index: usize) -> FxHashMap<u64, Uses> {
    let mut uses: FxHashMap<u64, Uses> = FxHashMap::default();
    for face in &context.part.shells[index].faces {
        let face = &context.part.faces[face.index()];
        for a_loop in &face.loops {
            let Loop::Edges { coedges, .. } = a_loop else { continue };
            for coedge in coedges {
                for chord in context.mesh.edges[coedge.edge.index()].windows(2) {
                    let (key, turned) = half_key(chord[0], chord[1]);
                    let of_chord = uses.entry(key).or_default();
                    if turned ^ coedge.forward ^ face.flipped {
                        of_chord.there += 1;
                    } else {
                        of_chord.back += 1;
                    }
                }
            }
        }
    }
    uses
}

/// Triangles over the same three shared positions as an earlier one.
fn shared_duplicates<'a>(faces: impl Iterator<Item = &'a FaceFindings>) -> usize {
    let mut triples: Vec<[u32; 3]> = faces.flat_map(|f| f.shared_triangles.iter().copied()).collect();
    triples.sort_unstable();
    triples.windows(2).filter(|w| w[0] == w[1]).count()
}

fn in_file(count: usize) -> String {
    if count == 0 { String::new() } else { format!(", {count} of them in the file") }
}

fn describe(context: &Context<'_>, sign: i8, found: &mut ShellFindings) {
    let audit = found.audit;
    let source = context.part.shells[audit.shell as usize].source;
    let mut add = |kind: ProblemKind, what: String| {
        let sentence = format!("shell {source} {what}");
        found.problems.push(Problem { subject: Subject::Shell(audit.shell), kind, sentence });
    };
    if audit.closed_in_file && audit.complete && audit.open_edges > 0 {
        let in_file = in_file(audit.open_in_file);
        add(
            ProblemKind::OpenShell,
            format!("is said to be closed and has {} open edges{in_file}", audit.open_edges),
        );
    }
    // An open shell may well be put together from faces that do not agree.
    if audit.inconsistent_edges > if audit.closed_in_file { 0 } else { audit.inconsistent_in_file } {
        let in_file = in_file(audit.inconsistent_in_file);
        add(
            ProblemKind::InconsistentEdges,
            format!("has {} inconsistent edges{in_file}", audit.inconsistent_edges),
        );
    }
    if audit.non_manifold_edges > 0 {
        add(
            ProblemKind::NonManifoldEdges,
            format!("has {} edges with more triangles than the model has faces", audit.non_manifold_edges),
        );
    }
    if found.duplicates > 0 {
        add(ProblemKind::DuplicateTriangle, format!("has {} triangles more than once", found.duplicates));
    }
    if audit.is_sound() && sign != 0 && audit.volume * f64::from(sign) < 0.0 {
        add(ProblemKind::InsideOut, format!("is inside out: its volume is {:.6e}", audit.volume));
    }
}
