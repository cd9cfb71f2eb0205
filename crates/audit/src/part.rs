//! The audit of one part, top to bottom: well-formed → edges → faces → shells.

use crate::edges::{CHARGED, EdgeAudit, audit_edges};
use crate::face::{FaceFindings, audit_face};
use crate::prove::AIM;
use crate::report::{AuditOptions, Claim, PartAudit, Problem, ProblemKind, Subject};
use crate::shell::audit_shell;
use chordal_brep::{BodyKind, FaceGeometry, Part};
use chordal_mesh::{Origin, PartMesh};
use chordal_nurbs::Box3;
use rayon::prelude::*;

/// Points nearer together than this share of the tolerance, and of the part, may be one vertex.
const SAME_POINT: f64 = 0.1;
const SAME_POINT_OF_PART: f64 = 1e-6;

fn diagonal(mesh: &PartMesh) -> f64 {
    Box3::from_points(mesh.positions.iter().copied()).diagonal()
}

/// What all faces of a part share.
pub(crate) struct Context<'a> {
    pub part: &'a Part,
    pub mesh: &'a PartMesh,
    pub options: &'a AuditOptions,
    pub claims: Option<&'a [Claim]>,
    /// The largest coordinate of the mesh.
    pub scale: f64,
    /// Points nearer together may be one vertex: the end rows of a surface at a pole.
    pub same_point: f64,
    /// The position of each vertex of the part, where it has one.
    pub vertex_at: Vec<Option<u32>>,
    pub edges: Vec<EdgeAudit>,
}

impl Context<'_> {
    /// A point may be off by this much and is charged for it; by more, and it is misplaced.
    pub fn allowed(&self) -> f64 {
        CHARGED * self.options.tolerance + self.options.coordinate_rounding
    }

    /// Bounds of a facet that are as good as any: a little under the tolerance, and what is claimed of the face.
    pub fn enough(&self, face: usize) -> (f64, f64) {
        let tolerance = self.options.tolerance;
        let claimed = self.claim(face).map_or(tolerance, |c| c.proven_error);
        let claimed =
            if claimed.is_finite() { claimed.clamp(0.01 * tolerance, tolerance) } else { tolerance };
        (AIM * tolerance, claimed)
    }

    pub fn claim(&self, face: usize) -> Option<Claim> {
        self.claims.and_then(|claims| claims.get(face)).copied()
    }

    /// The file, or the mesher, said that this face has no triangles.
    pub fn known_missing(&self, face: usize) -> bool {
        matches!(self.part.faces[face].geometry, FaceGeometry::Failed(_))
            || self.claim(face).is_some_and(|c| c.missing)
    }
}

/// Recomputes everything that was promised of the mesh of a part. `claims`, one per face, are compared with what
/// comes out.
pub fn audit_part(
    part: &Part,
    mesh: &PartMesh,
    options: &AuditOptions,
    claims: Option<&[Claim]>,
) -> PartAudit {
    let mut audit = PartAudit::default();
    if let Some(what) = malformed(part, mesh) {
        let sentence = format!("the mesh is malformed: {what}");
        audit.problems.push(Problem { subject: Subject::Part, kind: ProblemKind::Malformed, sentence });
        return audit;
    }
    let mut context = Context {
        part,
        mesh,
        options,
        claims,
        scale: mesh.positions.iter().fold(0.0, |m: f64, p| m.max(p.abs().max_element())),
        same_point: (SAME_POINT * options.tolerance).min(SAME_POINT_OF_PART * diagonal(mesh)),
        vertex_at: Vec::new(),
        edges: Vec::new(),
    };
    check_origins(&mut context, &mut audit);
    context.edges = audit_edges(part, mesh, context.scale, context.allowed());
    for edge in &context.edges {
        audit.misplaced_vertices += edge.misplaced;
        audit.problems.extend(edge.problem.clone());
    }
    let faces: Vec<FaceFindings> =
        (0..part.faces.len()).into_par_iter().map(|f| audit_face(&context, f)).collect();
    for (index, face) in faces.iter().enumerate() {
        audit.degenerate_triangles += face.degenerate;
        audit.duplicate_triangles += face.duplicates;
        audit.misplaced_vertices += face.misplaced;
        audit.problems.extend(face.problems.iter().cloned());
        check_claim(&context, index, face, &mut audit.problems);
        audit.faces.push(face.audit);
    }
    add_shells(&context, &faces, &mut audit);
    audit.problems.sort();
    audit.problems.dedup_by(|b, a| (a.subject, a.kind) == (b.subject, b.kind));
    audit
}

/// Why nothing else can be looked at.
fn malformed(part: &Part, mesh: &PartMesh) -> Option<String> {
    let n = mesh.positions.len();
    if mesh.origins.len() != n {
        return Some(format!("{n} positions and {} origins", mesh.origins.len()));
    }
    if mesh.faces.len() != part.faces.len() {
        return Some(format!("{} faces of {}", mesh.faces.len(), part.faces.len()));
    }
    if mesh.edges.len() != part.edges.len() {
        return Some(format!("{} edges of {}", mesh.edges.len(), part.edges.len()));
    }
    if let Some(i) = mesh.positions.iter().position(|p| !p.is_finite()) {
        return Some(format!("position {i} is not finite"));
    }
    if mesh.edges.iter().flatten().any(|&p| p as usize >= n) {
        return Some("an edge has a vertex that does not exist".into());
    }
    mesh.faces.iter().enumerate().find_map(|(i, face)| {
        let corners = face.corners.len();
        let lost = face.corners.iter().any(|c| c.position as usize >= n || !c.uv.is_finite())
            || face.triangles.iter().flatten().any(|&c| c as usize >= corners);
        (lost || face.face as usize != i).then(|| format!("face {i} has corners that do not exist"))
    })
}

/// Vertices of the part are where the model has them, and there is one of each; edge samples are in their polylines.
fn check_origins(context: &mut Context<'_>, audit: &mut PartAudit) {
    let Context { part, mesh, .. } = *context;
    let rounding = crate::edges::ROUNDING * context.scale + context.options.coordinate_rounding;
    let mut vertex_at = vec![None; part.vertices.len()];
    let mut twice = 0;
    let mut lost = 0;
    for (i, (&p, origin)) in mesh.positions.iter().zip(&mesh.origins).enumerate() {
        match *origin {
            Origin::Vertex(v) => match part.vertices.get(v as usize) {
                Some(vertex) => {
                    twice += usize::from(vertex_at[v as usize].replace(i as u32).is_some());
                    audit.misplaced_vertices += usize::from(vertex.point.distance(p) > rounding);
                }
                None => lost += 1,
            },
            Origin::Edge { edge, index } => {
                let line = mesh.edges.get(edge as usize);
                let listed = line.is_some_and(|l| l.is_empty() || l.get(index as usize) == Some(&(i as u32)));
                lost += usize::from(!listed);
            }
            Origin::Face(f) => lost += usize::from(f as usize >= part.faces.len()),
        }
    }
    context.vertex_at = vertex_at;
    let misplaced = audit.misplaced_vertices;
    let mut add = |count: usize, kind: ProblemKind, what: &str| {
        if count > 0 {
            audit.problems.push(Problem {
                subject: Subject::Part,
                kind,
                sentence: format!("{count} {what}"),
            });
        }
    };
    add(misplaced, ProblemKind::MisplacedVertex, "vertices of the model are elsewhere in the mesh");
    add(twice, ProblemKind::BrokenPolyline, "vertices of the model are in the mesh more than once");
    add(lost, ProblemKind::Malformed, "positions come from nothing in the model");
}

/// A bound that is claimed must not be below the one recomputed; beyond rounding in the parameters found again.
fn check_claim(context: &Context<'_>, index: usize, face: &FaceFindings, problems: &mut Vec<Problem>) {
    let Some(claim) = context.claim(index).filter(|_| face.audit.triangles > 0) else { return };
    let floor = 4.0 * face.rounding;
    let mut add = |kind: ProblemKind, what: &str, claimed: f64, found: f64| {
        if claimed < found * (1.0 - 1e-6) - floor {
            let source = context.part.faces[index].source;
            let sentence =
                format!("face {source}: the {what} is claimed to be {claimed:.6e} and is {found:.6e}");
            problems.push(Problem { subject: Subject::Face(index as u32), kind, sentence });
        }
    };
    add(ProblemKind::UnderstatedError, "proven error", claim.proven_error, face.claimable);
    add(ProblemKind::UnderstatedGap, "gap", claim.gap, face.surface_gap);
    if claim.proven_error.is_finite() && face.error.is_nan() && context.options.proven {
        let source = context.part.faces[index].source;
        let sentence = format!("face {source}: an error is claimed to be proven and nothing can be");
        problems.push(Problem {
            subject: Subject::Face(index as u32),
            kind: ProblemKind::Unproven,
            sentence,
        });
    }
}

fn add_shells(context: &Context<'_>, faces: &[FaceFindings], audit: &mut PartAudit) {
    let part = context.part;
    // The sign of a shell's volume: outside of a solid positive, its voids negative, anything else unknown.
    let mut signs = vec![0i8; part.shells.len()];
    for body in part.bodies.iter().filter(|b| b.kind == BodyKind::Solid) {
        for (i, shell) in body.shells.iter().enumerate() {
            signs[shell.index()] = if i == 0 { 1 } else { -1 };
        }
    }
    let found: Vec<_> =
        (0..part.shells.len()).into_par_iter().map(|s| audit_shell(context, faces, s, signs[s])).collect();
    let mut vouched = vec![false; faces.len()];
    for mut shell in found {
        let sign = signs[shell.audit.shell as usize];
        if shell.audit.is_sound() && f64::from(sign) * shell.audit.volume > 0.0 {
            part.shells[shell.audit.shell as usize].faces.iter().for_each(|f| vouched[f.index()] = true);
        }
        if shell.audit.closed_in_file && shell.audit.complete {
            audit.open_edges += shell.audit.open_edges;
        }
        audit.inconsistent_edges += shell.audit.inconsistent_edges;
        audit.non_manifold_edges += shell.audit.non_manifold_edges;
        audit.duplicate_triangles += shell.duplicates;
        audit.problems.append(&mut shell.problems);
        audit.shells.push(shell.audit);
    }
    for (index, _) in faces.iter().enumerate().filter(|&(i, f)| f.turned_over && !vouched[i]) {
        audit.problems.push(Problem {
            subject: Subject::Face(index as u32),
            kind: ProblemKind::FoldedTriangle,
            sentence: format!("face {} is turned over as a whole", part.faces[index].source),
        });
    }
}
