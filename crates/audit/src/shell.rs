//! A shell: closed and oriented by the identity of vertices, so that parts that touch do not mix.

use crate::context::Context;
use crate::findings::FaceFindings;
use crate::halves::half_key;
use crate::report::{Problem, ShellAudit, Subject};
use chordal_brep::{AuditIssue, Loop};
use chordal_nurbs::math;
use rustc_hash::FxHashMap;

/// The findings about one shell.
#[derive(Debug, Default)]
pub(crate) struct ShellFindings {
    pub audit: ShellAudit,
    /// Between different faces.
    pub duplicates: usize,
    pub problems: Vec<Problem>,
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

fn describe(context: &Context<'_>, sign: i8, found: &mut ShellFindings) {
    let audit = found.audit;
    let source = context.part.shells[audit.shell as usize].source;
    let mut add = |issue| found.problems.push(Problem::new(Subject::Shell(audit.shell), source, issue));
    if audit.closed_in_file && audit.complete && audit.open_edges > 0 {
        add(AuditIssue::OpenShell { open_edges: audit.open_edges, in_file: audit.open_in_file });
    }
    // The faces of an open shell need not agree on an orientation in the file.
    if audit.inconsistent_edges > if audit.closed_in_file { 0 } else { audit.inconsistent_in_file } {
        let (edges, in_file) = (audit.inconsistent_edges, audit.inconsistent_in_file);
        add(AuditIssue::InconsistentEdges { edges, in_file });
    }
    if audit.non_manifold_edges > 0 {
        add(AuditIssue::NonManifoldEdges { edges: audit.non_manifold_edges });
    }
    if found.duplicates > 0 {
        add(AuditIssue::DuplicateTriangles { triangles: found.duplicates });
    }
    if audit.is_sound() && sign != 0 && audit.volume * f64::from(sign) < 0.0 {
        add(AuditIssue::InsideOut { volume: audit.volume * math::powi(context.options.millimetres, 3) });
    }
}
