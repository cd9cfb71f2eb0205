//! One face: its corners lie on the surface, its triangles cover it once, and each is within its bound.

use crate::area::check_area;
use crate::boundary::{Boundary, boundary};
use crate::chart::{Chart, exact, turn, turned_triangles};
use crate::context::Context;
use crate::findings::{AtEdge, FaceFindings, Log};
use crate::halves::{Half, Halves, half_key};
use crate::overlap::overlaps;
use crate::precision::CHUNK;
use crate::prove;
use crate::region::{LoopSide, check_region, loop_side};
use crate::report::FaceAudit;
use crate::second_bound::check_second_bound;
use chordal_brep::issue::MeshDefect;
use chordal_brep::{AuditIssue, Face, FaceGeometry, Loop};
use chordal_mesh::{FaceMesh, Origin};
use chordal_nurbs::{DVec2, DVec3, Surface, SurfaceInverter, math};
use rayon::prelude::*;

/// Edges shorter than this share of the tolerance may turn by any angle: at singular points some always do.
const TURN_LENGTH: f64 = 0.1;

/// Normals are recomputed to this.
const NORMAL: f64 = 1e-6;

/// Audits one face.
pub(crate) fn audit_face(context: &Context<'_>, index: usize) -> FaceFindings {
    let face = &context.part.faces[index];
    let mesh = &context.mesh.faces[index];
    let mut found = FaceFindings {
        audit: FaceAudit { face: index as u32, triangles: mesh.triangles.len(), ..FaceAudit::default() },
        ..FaceFindings::default()
    };
    let mut log = Log::new(index, face);
    if mesh.triangles.is_empty() {
        if !context.known_missing(index) {
            log.add(AuditIssue::MissingFace);
        }
        found.audit.proven_error = f64::NAN;
        found.error = f64::NAN;
        found.problems = log.problems;
        return found;
    }
    let FaceGeometry::Surface(surface) = &face.geometry else {
        log.add(AuditIssue::MalformedMesh(MeshDefect::NoSurface));
        found.problems = log.problems;
        return found;
    };
    let surface = exact(surface);
    let mut chart = Chart::new(context, &surface, mesh);
    found.rounding = chart.rounding;
    chart.turned = 2 * turned_triangles(mesh) > mesh.triangles.len();
    check_corners(context, &mut chart, &mut found, &mut log);
    let halves = Halves::of(&mesh.triangles, mesh.corners.len());
    let bounds_of = boundary(context, face, mesh, &halves.single);
    let folded = check_triangles(context, &chart, &mut found, &mut log);
    found.is_along_sense = chart.turned == face.normal_reversed();
    found.at_edges.extend(bounds_of.chords.iter().filter_map(|chord| {
        let (edge, index) = chord.of?;
        Some(AtEdge { edge, chord: index, triangle: chord.half.triangle, side: chord.half.side })
    }));
    found.turned_over = is_turned_over(&chart, &bounds_of, log.face);
    let side = loop_side(&chart, &bounds_of, log.face);
    found.other_side = side == LoopSide::AgainstLoops;
    if side == LoopSide::AgainstSense {
        log.add(AuditIssue::OtherSide);
    }
    check_boundary(context, &chart, &bounds_of, &mut log);
    check_region(context, &chart, &bounds_of, &halves.single, &mut log);
    if folded == 0 {
        let places = overlaps(&chart, &halves.single);
        if places > 0 {
            log.add(AuditIssue::Overlap { places });
        }
        check_area(context, &chart, &bounds_of, &mut log);
    }
    gather_shared(context, mesh, &halves, &mut found);
    if found.duplicates > 0 {
        log.add(AuditIssue::DuplicateTriangles { triangles: found.duplicates });
    }
    let sides = prove::sides(&chart, &bounds_of);
    prove::prove(context, &chart, &bounds_of, &sides, &mut found, &mut log);
    check_second_bound(context, &chart, &sides, &found, &mut log);
    found.audit.proven_error = found.error + context.options.coordinate_rounding;
    found.problems = log.problems;
    found
}

/// The surface at a corner.
#[derive(Clone, Copy)]
struct OnSurface {
    point: DVec3,
    derivatives: [DVec3; 2],
}

/// The findings about the corners of one task.
#[derive(Clone, Copy, Default)]
struct CornerFindings {
    gap: f64,
    misplaced: usize,
    farthest: f64,
    wrong_normals: usize,
}

/// Recomputes point and normal of every corner.
fn check_corners(context: &Context<'_>, chart: &mut Chart<'_>, found: &mut FaceFindings, log: &mut Log<'_>) {
    let sign = if chart.turned { -1.0 } else { 1.0 };
    let chunks: Vec<(Vec<OnSurface>, CornerFindings)> = chart
        .mesh
        .corners
        .par_chunks(CHUNK)
        .map(|corners| {
            let mut sum = CornerFindings::default();
            let xyz = corners.iter().map(|c| {
                let uv = chart.wrap.apply(c.uv);
                let (p, du, dv) = chart.surface.jet1(uv);
                if !normal_agrees(chart.surface, uv, du.cross(dv) * sign, c.normal, sign) {
                    sum.wrong_normals += 1;
                }
                let position = context.mesh.positions[c.position as usize];
                let distance = p.distance(position);
                sum.gap = sum.gap.max(distance);
                if distance > chart.rounding + context.allowed()
                    && is_misplaced(context, chart, c.position, p)
                {
                    sum.misplaced += 1;
                    sum.farthest = sum.farthest.max(distance);
                }
                OnSurface { point: p, derivatives: [du, dv] }
            });
            (xyz.collect(), sum)
        })
        .collect();
    let mut wrong = 0;
    let mut farthest = 0.0f64;
    for (xyz, sum) in chunks {
        chart.xyz.extend(xyz.iter().map(|s| s.point));
        chart.derivatives.extend(xyz.iter().map(|s| s.derivatives));
        found.audit.gap = found.audit.gap.max(sum.gap);
        found.misplaced += sum.misplaced;
        farthest = farthest.max(sum.farthest);
        wrong += sum.wrong_normals;
    }
    found.surface_gap = found.audit.gap;
    found.audit.gap =
        found.audit.gap.max(loop_edges(log.face).map(|e| context.edges[e].gap).fold(0.0, f64::max));
    if found.misplaced > 0 {
        let distance = context.mm(farthest);
        log.add(AuditIssue::MisplacedVertices { vertices: found.misplaced, distance });
    }
    if wrong > 0 {
        log.add(AuditIssue::WrongNormals { corners: wrong });
    }
}

fn loop_edges(face: &Face) -> impl Iterator<Item = usize> + '_ {
    face.loops.iter().flat_map(|l| match l {
        Loop::Edges { coedges, .. } => coedges.iter().map(|c| c.edge.index()).collect(),
        _ => Vec::new(),
    })
}

/// True where a corner far from its point of the surface is the mesh's fault and not the file's: a vertex of
/// the face's own, or one of an edge that the surface has a nearer point for than the corner's.
fn is_misplaced(context: &Context<'_>, chart: &Chart<'_>, position: u32, on_surface: DVec3) -> bool {
    let p = context.mesh.positions[position as usize];
    let distance = p.distance(on_surface);
    if matches!(context.mesh.origins[position as usize], Origin::Face(_)) {
        // Control rows that all but meet are one pole, and one vertex.
        let pole = chart.poles.iter().any(|pole| pole.point.distance(p) <= 0.1 * context.options.tolerance);
        return !pole || distance > 0.1 * context.options.tolerance + context.options.coordinate_rounding;
    }
    // The mesher reports this distance as the looseness of the file, and nothing contradicts that.
    if context
        .claim(chart.mesh.face as usize)
        .is_some_and(|c| distance <= c.gap * (1.0 + 1e-6) + chart.rounding)
    {
        return false;
    }
    let nearest = SurfaceInverter::new(chart.surface, chart.uv_box).invert(p, None).distance;
    distance > 2.0 * nearest + 0.1 * context.options.tolerance + context.options.coordinate_rounding
}

/// The quick normal settles all but degenerate places.
fn normal_agrees(surface: &Surface, uv: DVec2, cross: DVec3, stated: DVec3, sign: f64) -> bool {
    let near = |n: DVec3| n.distance_squared(stated) <= NORMAL * NORMAL;
    if cross.try_normalize().is_some_and(near) {
        return true;
    }
    match surface.normal(uv) {
        Some(n) => near(n * sign),
        None => true,
    }
}

/// The findings about the triangles of one task.
#[derive(Clone, Copy, Default)]
struct TriangleFindings {
    degenerate: usize,
    folded: usize,
    against: usize,
    volume: f64,
    least_cosine: f64,
}

/// Orientation in the chart, area, normals, volume, angles; returns the number of inverted triangles.
fn check_triangles(
    context: &Context<'_>,
    chart: &Chart<'_>,
    found: &mut FaceFindings,
    log: &mut Log<'_>,
) -> usize {
    let origin = context.mesh.positions[0];
    let positions = &context.mesh.positions;
    let corners = &chart.mesh.corners;
    let check = |triangles: &[[u32; 3]]| {
        let mut sum = TriangleFindings { least_cosine: 1.0, ..TriangleFindings::default() };
        for t in triangles {
            let c = t.map(|c| &corners[c as usize]);
            let [p, q, r] = c.map(|c| positions[c.position as usize]);
            sum.volume += (p - origin).dot((q - origin).cross(r - origin));
            sum.degenerate += usize::from(is_degenerate(c.map(|c| c.position), [p, q, r], chart.rounding));
            let turn = turn(chart.mesh, t);
            let ideal = t.map(|c| chart.xyz[c as usize]);
            let normal = (ideal[1] - ideal[0]).cross(ideal[2] - ideal[0]);
            let against = c.iter().all(|c| c.normal.dot(normal) < 0.0);
            sum.folded += usize::from(if chart.turned { turn >= 0.0 } else { turn <= 0.0 });
            sum.against += usize::from(against);
            let sides = [p.distance(q), q.distance(r), r.distance(p)];
            for i in (0..3).filter(|&i| sides[i] > TURN_LENGTH * context.options.tolerance) {
                let (n, m) = (c[i].normal, c[(i + 1) % 3].normal);
                if n != DVec3::ZERO && m != DVec3::ZERO {
                    sum.least_cosine = sum.least_cosine.min(n.dot(m));
                }
            }
        }
        sum
    };
    let sums: Vec<TriangleFindings> = chart.mesh.triangles.par_chunks(CHUNK).map(check).collect();
    let (mut folded, mut against) = (0, 0);
    let mut least = 1.0f64;
    for sum in sums {
        found.degenerate += sum.degenerate;
        found.volume += sum.volume / 6.0;
        folded += sum.folded;
        against += sum.against;
        least = least.min(sum.least_cosine);
    }
    found.audit.max_angle = math::acos(least.clamp(-1.0, 1.0));
    if found.degenerate > 0 {
        log.add(AuditIssue::DegenerateTriangles { triangles: found.degenerate });
    }
    found.audit.leaning = against;
    if folded > 0 {
        log.add(AuditIssue::InvertedTriangles { triangles: folded });
    }
    if let Some(limit) =
        context.options.angle.filter(|&l| found.audit.max_angle > l * (1.0 + NORMAL) + NORMAL)
    {
        log.add(AuditIssue::OverAngle { angle: found.audit.max_angle, limit });
    }
    folded
}

/// Two corners in one place, or a height that is only rounding.
fn is_degenerate(index: [u32; 3], p: [DVec3; 3], rounding: f64) -> bool {
    if index[0] == index[1] || index[1] == index[2] || index[2] == index[0] {
        return true;
    }
    let longest = (p[1] - p[0]).length().max((p[2] - p[1]).length()).max((p[0] - p[2]).length());
    (p[1] - p[0]).cross(p[2] - p[0]).length() <= longest * rounding / 16.0
}

/// Files lie about the sense of a surface or about the direction of a loop, but hardly about both; unless the
/// shell is inside out in the file, which only its volume shows.
fn is_turned_over(chart: &Chart<'_>, bounds: &Boundary, face: &Face) -> bool {
    chart.turned != face.normal_reversed() && bounds.forward == 0
}

/// True on the side of the surface's own domain that bounds a face without loops.
fn is_natural(chart: &Chart<'_>, face: &Face, half: &Half) -> bool {
    let domain = chart.surface.domain();
    let [a, b] = [half.a, half.b].map(|c| chart.mesh.corners[c as usize].uv);
    let near = 1e-9 * domain.size();
    face.loops.is_empty()
        && (0..2).any(|i| {
            [domain.min[i], domain.max[i]]
                .iter()
                .any(|side| (a[i] - side).abs() <= near[i] && (b[i] - side).abs() <= near[i])
        })
}

fn check_boundary(context: &Context<'_>, chart: &Chart<'_>, bounds: &Boundary, log: &mut Log<'_>) {
    if bounds.missing > 0 {
        let edge = bounds.missing_edge.map(|e| context.part.edges[e as usize].source);
        log.add(AuditIssue::MissingChords { chords: bounds.missing, edge });
    }
    let stray = bounds.stray.iter().filter(|h| !is_natural(chart, log.face, h)).count();
    if stray > 0 {
        log.add(AuditIssue::StrayBoundary { sides: stray });
    }
}

/// Half-edges and triangles that the shell compares with other faces'; duplicates inside this one.
fn gather_shared(context: &Context<'_>, mesh: &FaceMesh, halves: &Halves, found: &mut FaceFindings) {
    let position = |c: u32| mesh.corners[c as usize].position;
    let is_shared = |p: u32| !matches!(context.mesh.origins[p as usize], Origin::Face(_));
    found.shared.extend(halves.single.iter().map(|h| half_key(position(h.a), position(h.b))));
    for &(a, b) in &halves.matched {
        let (a, b) = (position(a), position(b));
        if is_shared(a) && is_shared(b) {
            found.shared.extend([half_key(a, b), half_key(b, a)]);
        }
    }
    let sorted = |t: &[u32; 3]| {
        let mut t = t.map(position);
        t.sort_unstable();
        t
    };
    let is_inner = |t: &[u32; 3]| t.iter().any(|&p| !is_shared(p));
    found.shared_triangles = mesh.triangles.iter().map(sorted).filter(|t| !is_inner(t)).collect();
    if halves.repeated > 0 {
        let mut inner: Vec<[u32; 3]> = mesh.triangles.iter().map(sorted).filter(is_inner).collect();
        inner.sort_unstable();
        found.duplicates = inner.windows(2).filter(|w| w[0] == w[1]).count();
    }
}
