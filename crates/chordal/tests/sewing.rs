//! Sewing as a user meets it: models taken apart into islands come out closed again.

use chordal::brep::{Body, BodyKind, FaceId, Loop, Model, Part, Shell, ShellId, Vertex, VertexId};
use chordal::stages::{mesh_parts, part_uses, resolve, sew_parts};
use chordal::{Cancel, MeshOptions, Sewing, Tolerance};
use chordal_audit::{AuditOptions, audit_part};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Every face an island: no edge and no vertex is shared, the shells of a body are one open heap.
fn unsewn(part: &Part) -> Part {
    let mut new = Part { vertices: Vec::new(), edges: Vec::new(), shells: Vec::new(), ..part.clone() };
    for face in &mut new.faces {
        let mut vertex_of = std::collections::BTreeMap::new();
        let mut vertex = |v: VertexId, all: &mut Vec<Vertex>| {
            *vertex_of.entry(v).or_insert_with(|| {
                all.push(part.vertices[v.index()].clone());
                VertexId::from(all.len() - 1)
            })
        };
        for a_loop in &mut face.loops {
            match a_loop {
                Loop::Vertex(v) => *v = vertex(*v, &mut new.vertices),
                Loop::Polygon { vertices, .. } => {
                    vertices.iter_mut().for_each(|v| *v = vertex(*v, &mut new.vertices));
                }
                Loop::Edges { coedges, .. } => {
                    for coedge in coedges {
                        let mut edge = part.edges[coedge.edge.index()].clone();
                        edge.start = vertex(edge.start, &mut new.vertices);
                        edge.end = vertex(edge.end, &mut new.vertices);
                        new.edges.push(edge);
                        coedge.edge = chordal::brep::EdgeId::from(new.edges.len() - 1);
                    }
                }
            }
        }
    }
    let old = std::mem::take(&mut new.bodies);
    for body in old {
        let faces: Vec<FaceId> =
            body.shells.iter().flat_map(|s| part.shells[s.index()].faces.iter().copied()).collect();
        new.shells.push(Shell { faces, closed: false, source: body.source });
        new.bodies.push(Body {
            kind: BodyKind::FaceSet,
            shells: vec![ShellId::from(new.shells.len() - 1)],
            ..body
        });
    }
    new
}

/// What came of one model.
#[derive(Debug, Default)]
struct Outcome {
    closed_before: usize,
    closed_after: usize,
    watertight: usize,
    open_before: usize,
    open_after: usize,
    largest_move: f64,
    opening: f64,
    failed: usize,
    failed_before: usize,
    tolerances: Vec<f64>,
    problems: Vec<String>,
    seconds: f64,
}

/// Closed shells of the file, sheets aside, whose faces all have surfaces.
fn closed_shells(part: &Part) -> usize {
    part.shells.iter().filter(|s| s.closed).count()
}

fn round_trip(path: &Path, mesh: bool) -> Outcome {
    let mut model = chordal::Model::open(path).expect("a model").brep().clone();
    let mut outcome =
        Outcome { closed_before: model.parts.iter().map(closed_shells).sum(), ..Outcome::default() };
    if mesh {
        outcome.failed_before = tessellated(&model, path, &mut Outcome::default());
    }
    for part in &mut model.parts {
        *part = unsewn(part);
    }
    let clock = std::time::Instant::now();
    let uses = part_uses(&model);
    let (model, reports) = sew_parts(Arc::new(model), &uses, Sewing::Auto);
    outcome.seconds = clock.elapsed().as_secs_f64();
    for report in reports.iter().flatten() {
        outcome.open_before += report.open_before;
        outcome.open_after += report.open.len();
        outcome.largest_move = outcome.largest_move.max(report.largest_move);
        outcome.opening = outcome.opening.max(report.largest_opening());
        outcome.tolerances.push(report.tolerance);
        assert!(report.largest_move <= report.tolerance, "{path:?}: {report:?}");
    }
    outcome.closed_after = model.parts.iter().map(closed_shells).sum();
    if mesh {
        outcome.failed = tessellated(&model, path, &mut outcome);
    }
    outcome
}

/// Meshes and audits; returns the failed faces.
fn tessellated(model: &Model, path: &Path, outcome: &mut Outcome) -> usize {
    let options = MeshOptions::default().with_tolerance(Tolerance::Percent(0.2));
    let cancel = Cancel::default();
    let named = chordal::Model::from_brep(model.clone(), &path.display().to_string());
    let resolved = resolve(&named, &options, &cancel).expect("a tolerance");
    let meshed = mesh_parts(&named, &resolved, &cancel);
    let mut failed = 0;
    for ((part, of_part), asked) in model.parts.iter().zip(&meshed).zip(&resolved.parts) {
        failed += of_part.report.faces.iter().filter(|f| f.failed.is_some()).count();
        let audit =
            audit_part(part, &of_part.mesh, &AuditOptions::new(asked.tolerance).with_proven(false), None);
        outcome.watertight += audit.shells.iter().filter(|s| s.is_sound() && s.volume > 0.0).count();
        let told = |p: &&chordal_audit::Problem| p.issue != chordal_brep::AuditIssue::MissingFace;
        outcome.problems.extend(audit.problems.iter().filter(told).map(ToString::to_string));
    }
    failed
}

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn step_files(folder: &Path) -> Vec<PathBuf> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let mut files: Vec<PathBuf> = entries
        .filter_map(|e| e.ok().map(|e| e.path()))
        .filter(|p| {
            p.extension().is_some_and(|e| ["step", "stp"].contains(&&*e.to_string_lossy().to_lowercase()))
        })
        .collect();
    files.sort();
    files
}

/// Models of the corpus whose faces mesh quickly: of every kind of surface and loop.
const MESHED: [&str; 16] = [
    "bracket",
    "cone_halves",
    "cylinder_no_seam",
    "cylinder_seam_hole",
    "extrusion_bspline",
    "faceted",
    "fillets",
    "octant",
    "offset_bspline",
    "revolution_pole",
    "sphere_full",
    "sphere_lunes",
    "spline_cyclic",
    "torus_halves",
    "touching_loops",
    "wedge_hole",
];

#[test]
fn corpus_taken_apart_closes_again() {
    for path in step_files(&repository().join("corpus")) {
        if chordal::Model::open(&path).is_err() {
            continue;
        }
        let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
        let meshed = MESHED.contains(&&*name);
        let found = round_trip(&path, meshed);
        assert!(found.closed_after >= found.closed_before, "{name}: {found:?}");
        if meshed {
            assert!(found.failed <= found.failed_before, "{name}: {found:?}");
            assert!(found.problems.is_empty(), "{name}: {found:?}");
            assert!(found.watertight >= found.closed_before, "{name}: {found:?}");
        }
    }
}

/// Line 3 of the issue: set CHORDAL_MODELS, and run with `--release -- --ignored --nocapture`.
#[test]
#[ignore = "minutes"]
fn models_taken_apart_close_again() {
    let models = std::env::var_os("CHORDAL_MODELS")
        .map_or_else(|| repository().join("../shared/models"), PathBuf::from);
    let only = std::env::var("CHORDAL_ONLY").unwrap_or_default();
    let files = step_files(&models.join("step"));
    if files.is_empty() {
        println!("skipped: there are no models under {}", models.display());
    }
    println!(
        "| file | closed shells | closed again | watertight | failed | open before | after | move | opening \
         | seconds |"
    );
    for path in files.iter().filter(|p| p.to_string_lossy().contains(&only)) {
        let f = round_trip(path, true);
        println!(
            "| {} | {} | {} | {} | {} ({}) | {} | {} | {:.2e} | {:.2e} | {:.2} |",
            path.file_name().expect("a name").to_string_lossy(),
            f.closed_before,
            f.closed_after,
            f.watertight,
            f.failed,
            f.failed_before,
            f.open_before,
            f.open_after,
            f.largest_move,
            f.opening,
            f.seconds
        );
        if !only.is_empty() {
            println!("{:?}\n{:#?}", f.tolerances, f.problems);
        }
    }
}
