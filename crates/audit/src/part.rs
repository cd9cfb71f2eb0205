//! The audit of one part, top to bottom: well-formed → edges → faces → shells.

use crate::context::Context;
use crate::edges::{EdgePrecision, audit_edges};
use crate::face::audit_face;
use crate::findings::FaceFindings;
use crate::folds_at_edges::folds_at_edges;
use crate::precision::ROUNDING;
use crate::report::{AuditOptions, Claim, FaceCrossing, PartAudit, Problem, Subject};
use crate::self_intersections::self_intersections;
use crate::shell::audit_shell;
use chordal_brep::issue::MeshDefect;
use chordal_brep::{AuditIssue, BodyKind, Part};
use chordal_mesh::{Origin, PartMesh};
use chordal_nurbs::Box3;
use rayon::prelude::*;
use rustc_hash::FxHashSet;

/// Points nearer together than this share of the tolerance, and of the part, may be one vertex.
const SAME_POINT: f64 = 0.1;
const SAME_POINT_OF_PART: f64 = 1e-6;

fn diagonal(mesh: &PartMesh) -> f64 {
    Box3::from_points(mesh.positions.iter().copied()).diagonal()
}

/// Recomputes everything that was promised of the mesh of a part. `claims`, one per face, are compared with
/// what comes out.
pub fn audit_part(
    part: &Part,
    mesh: &PartMesh,
    options: &AuditOptions,
    claims: Option<&[Claim]>,
) -> PartAudit {
    let mut audit = PartAudit::default();
    if let Some(defect) = malformed(part, mesh) {
        let issue = AuditIssue::MalformedMesh(defect);
        audit.problems.push(Problem::new(Subject::Part, part.source, issue));
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
    let (scale, allowed, millimetres) = (context.scale, context.allowed(), options.millimetres);
    context.edges = audit_edges(part, mesh, EdgePrecision { scale, allowed, millimetres });
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
    audit.problems.extend(folds_at_edges(&context, &faces));
    if options.self_intersections {
        add_self_intersections(&context, &mut audit);
    }
    let mut seen = FxHashSet::default();
    audit.problems.retain(|p| seen.insert((p.subject, p.issue.code())));
    audit.problems.sort_by_key(|p| p.subject);
    audit
}

/// Why nothing else can be checked.
fn malformed(part: &Part, mesh: &PartMesh) -> Option<MeshDefect> {
    let n = mesh.positions.len();
    if mesh.origins.len() != n {
        return Some(MeshDefect::Origins { positions: n, origins: mesh.origins.len() });
    }
    if mesh.faces.len() != part.faces.len() {
        return Some(MeshDefect::Faces { found: mesh.faces.len(), expected: part.faces.len() });
    }
    if mesh.edges.len() != part.edges.len() {
        return Some(MeshDefect::Edges { found: mesh.edges.len(), expected: part.edges.len() });
    }
    if let Some(position) = mesh.positions.iter().position(|p| !p.is_finite()) {
        return Some(MeshDefect::NotFinite { position });
    }
    if mesh.edges.iter().flatten().any(|&p| p as usize >= n) {
        return Some(MeshDefect::EdgePosition);
    }
    mesh.faces.iter().enumerate().find_map(|(i, face)| {
        let corners = face.corners.len();
        let lost = face.corners.iter().any(|c| c.position as usize >= n || !c.uv.is_finite())
            || face.triangles.iter().flatten().any(|&c| c as usize >= corners);
        (lost || face.face as usize != i).then_some(MeshDefect::FaceCorner { face: i })
    })
}

/// Vertices of the part are where the model has them, and there is one of each; edge samples are in their
/// polylines.
fn check_origins(context: &mut Context<'_>, audit: &mut PartAudit) {
    let Context { part, mesh, .. } = *context;
    let rounding = ROUNDING * context.scale + context.options.coordinate_rounding;
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
    let mut add = |count: usize, issue: AuditIssue| {
        if count > 0 {
            audit.problems.push(Problem::new(Subject::Part, part.source, issue));
        }
    };
    add(misplaced, AuditIssue::MisplacedModelVertices { vertices: misplaced });
    add(twice, AuditIssue::RepeatedModelVertices { vertices: twice });
    add(lost, AuditIssue::MalformedMesh(MeshDefect::UnknownOrigins { positions: lost }));
}

/// A bound that is claimed must not be below the one recomputed; beyond rounding in the parameters found
/// again.
fn check_claim(context: &Context<'_>, index: usize, face: &FaceFindings, problems: &mut Vec<Problem>) {
    let Some(claim) = context.claim(index).filter(|_| face.audit.triangles > 0) else { return };
    let floor = 4.0 * face.rounding;
    let understated = |claimed: f64, found: f64| claimed < found * (1.0 - 1e-6) - floor;
    let mut add = |issue| {
        let source = context.part.faces[index].source;
        problems.push(Problem::new(Subject::Face(index as u32), source, issue));
    };
    if understated(claim.proven_error, face.claimable) {
        let (claimed, found) = (context.mm(claim.proven_error), context.mm(face.claimable));
        add(AuditIssue::UnderstatedError { claimed, found });
    }
    if understated(claim.gap, face.surface_gap) {
        let (claimed, found) = (context.mm(claim.gap), context.mm(face.surface_gap));
        add(AuditIssue::UnderstatedGap { claimed, found });
    }
    if claim.proven_error.is_finite() && face.error.is_nan() && context.options.proven {
        add(AuditIssue::Unproven);
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
    for (index, face) in faces.iter().enumerate().filter(|&(i, _)| !vouched[i]) {
        let mut add = |issue| {
            let source = part.faces[index].source;
            audit.problems.push(Problem::new(Subject::Face(index as u32), source, issue));
        };
        if face.turned_over {
            add(AuditIssue::FaceTurnedOver);
        }
        if face.other_side {
            add(AuditIssue::OtherSide);
        }
    }
}

/// Looks for facets that cut each other in every shell that the file calls closed and whose faces all have
/// triangles. The sheets of an open shell may cross in the file, and nobody takes them for the skin of a
/// solid.
fn add_self_intersections(context: &Context<'_>, audit: &mut PartAudit) {
    let closed = audit.shells.iter().filter(|s| s.closed_in_file && s.complete).map(|s| s.shell);
    for shell in closed.collect::<Vec<_>>() {
        let of_model = &context.part.shells[shell as usize];
        let found = self_intersections(context.part, context.mesh, &of_model.faces);
        let sources = |crossing: &FaceCrossing| crossing.faces.map(|f| context.part.faces[f as usize].source);
        if let Some(first) = found.iter().find(|crossing| !crossing.is_complete) {
            let face_pairs = found.iter().filter(|crossing| !crossing.is_complete).count();
            let issue = AuditIssue::TooManyFacetsMeet { face_pairs, faces: sources(first) };
            audit.problems.push(Problem::new(Subject::Shell(shell), of_model.source, issue));
        }
        let found: Vec<FaceCrossing> = found.into_iter().filter(|c| c.facet_pairs > 0).collect();
        let Some(most) = found.iter().rev().max_by_key(|crossing| crossing.facet_pairs) else { continue };
        let issue = AuditIssue::SelfIntersections {
            triangle_pairs: found.iter().map(|crossing| crossing.facet_pairs).sum(),
            face_pairs: found.len(),
            in_file: found.iter().filter(|crossing| crossing.in_file).count(),
            faces_meet: found.iter().filter(|crossing| crossing.faces_meet).count(),
            faces: sources(most),
        };
        audit.problems.push(Problem::new(Subject::Shell(shell), of_model.source, issue));
        audit.self_intersections.extend(found);
    }
}
