//! The tables of Balázs, Guthe, Klein 2004, measured on a model: trimming edges per method (Table 2), triangles and time per
//! surface method with and without coherence (Tables 3 and 4).

use crate::compare::placed;
use crate::error::Error;
use crate::meshed_part::{MeshedPart, mesh_parts};
use crate::model::Model;
use crate::options::MeshOptions;
use crate::resolve::{Resolved, resolve};
use chordal_brep::FaceGeometry;
use chordal_mesh::FaceMesh;
use chordal_methods::{
    Cut, EdgeMethod, LoopRow, Strategy, Stretch, edge_method_named, edge_methods, loop_rows,
};
use chordal_nurbs::{CoherentEvaluator, DVec2, DVec3, NurbsSurface, Surface, UvBox};
use chordal_tessellate::method::{EdgeSplitter, FillMethod};
use chordal_tessellate::{Bound, Cancel, Stopwatch};
use serde::Serialize;
use std::hint::black_box;
use std::path::Path;
use std::sync::Arc;

/// What a model gives in the tables.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct PaperTables {
    /// The name of the file.
    pub model: String,
    /// Faces, as placed.
    pub faces: usize,
    /// In millimetres.
    pub tolerance: f64,
    /// Table 2.
    pub loops: Vec<LoopEntry>,
    /// Tables 3 and 4.
    pub surfaces: Vec<SurfaceEntry>,
}

/// One way to make polylines of all trimming loops, each face its own.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct LoopEntry {
    /// The name of the method.
    pub method: String,
    /// Seconds from the model to Bézier curves.
    pub conversion: f64,
    /// Seconds from Bézier curves to polylines.
    pub approximation: f64,
    /// As placed.
    pub edges: usize,
    /// Vertices set where loops cross in the plane of parameters.
    pub crossings: usize,
    /// Uses of edges without a curve in the plane of parameters.
    pub left_out: usize,
}

/// One way to make a mesh.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct SurfaceEntry {
    /// The name of the strategy.
    pub strategy: String,
    /// The name of the edge method.
    pub edge_method: String,
    /// "proven" or "estimated".
    pub bound: String,
    /// As placed.
    pub triangles: usize,
    /// Chords of the model's edges.
    pub edges: usize,
    /// Shortest CPU time of all threads (wall time where the system does not tell) of some runs, from the exact model to the mesh.
    pub seconds: f64,
    /// Vertices of all faces, those at edges once a face.
    pub vertices: usize,
    /// Seconds to evaluate them on the NURBS forms of the faces, each by itself and with reuse; sorted beforehand.
    pub evaluation: f64,
    /// With reuse.
    pub coherent: f64,
    /// Cells of the subdivisions at the end.
    pub cells: usize,
    /// Faces that failed, as placed.
    pub failed_faces: usize,
}

/// Runs per mesh and per evaluation; the shortest counts.
const RUNS: usize = 3;

/// Seconds after which a mesh is made only once.
const LONG: f64 = 5.0;

/// Measures all tables on the model in `input`.
///
/// # Errors
/// Where the model cannot be read or the options make no sense for it.
pub fn paper_tables(input: &Path, options: &MeshOptions, cancel: &Cancel) -> Result<PaperTables, Error> {
    let model = Model::open(input)?;
    let named = |error: crate::resolve::ResolveError| error.named(model.name());
    let resolved = resolve(model.brep(), options, cancel).map_err(named)?;
    let mut tables = PaperTables {
        model: input.file_name().unwrap_or_default().to_string_lossy().into_owned(),
        faces: model.face_count(),
        tolerance: resolved.tolerance,
        loops: loops(model.brep(), &resolved),
        surfaces: Vec::new(),
    };
    for (strategy, edge_method, bound) in surface_methods() {
        let fill = strategy.map(|strategy| Arc::new(strategy) as Arc<dyn FillMethod>);
        let split = edge_method.map(|method| Arc::new(method) as Arc<dyn EdgeSplitter>);
        let options = options.clone().with_fill_method(fill).with_edge_splitter(split).with_bound(bound);
        tables.surfaces.push(surface(&model, &options, cancel)?);
    }
    Ok(tables)
}

fn loops(model: &chordal_brep::Model, resolved: &Resolved) -> Vec<LoopEntry> {
    let methods: Vec<EdgeMethod> = edge_methods().iter().filter_map(|e| e.method).collect();
    let mut entries: Vec<LoopEntry> = Vec::new();
    for (part, (part_use, options)) in model.parts.iter().zip(resolved.uses.iter().zip(&resolved.parts)) {
        if part_use.instances == 0 {
            continue;
        }
        for row in quickest(part, options.tolerance, &methods) {
            let name = EdgeSplitter::name(&row.method);
            if !entries.iter().any(|e| e.method == name) {
                entries.push(LoopEntry { method: name.into(), ..LoopEntry::default() });
            }
            let entry = entries.iter_mut().find(|e| e.method == name).expect("just pushed");
            entry.conversion += row.conversion;
            entry.approximation += row.approximation;
            entry.edges += part_use.instances * row.edges;
            entry.crossings += part_use.instances * row.crossings;
            entry.left_out += part_use.instances * row.left_out;
        }
    }
    entries
}

/// Rows with the shortest times of some runs.
fn quickest(part: &chordal_brep::Part, tolerance: f64, methods: &[EdgeMethod]) -> Vec<LoopRow> {
    let mut rows = loop_rows(part, tolerance, methods);
    for _ in 1..RUNS {
        for (row, again) in rows.iter_mut().zip(loop_rows(part, tolerance, methods)) {
            row.conversion = row.conversion.min(again.conversion);
            row.approximation = row.approximation.min(again.approximation);
        }
    }
    rows
}

/// The methods of Tables 3 and 4, and ours.
fn surface_methods() -> Vec<(Option<Strategy>, Option<EdgeMethod>, Bound)> {
    let lifted = edge_method_named("bezier3d").and_then(|e| e.method);
    let quadtree = Strategy::Quadtree(Stretch::SingularValue);
    let mut methods = vec![(Some(quadtree), Some(EdgeMethod::Bezier2d), Bound::Proven)];
    for strategy in [
        quadtree,
        Strategy::Binary(Cut::Midpoint),
        Strategy::Kd(Cut::Midpoint),
        Strategy::Kd(Cut::WorstPoint),
    ] {
        methods.extend([Bound::Proven, Bound::Estimated].map(|bound| (Some(strategy), lifted, bound)));
    }
    methods.extend([Bound::Proven, Bound::Estimated].map(|b| (None, None, b)));
    methods
}

fn surface(model: &Model, options: &MeshOptions, cancel: &Cancel) -> Result<SurfaceEntry, Error> {
    let resolved = resolve(model.brep(), options, cancel).map_err(|error| error.named(model.name()))?;
    let mut entry = SurfaceEntry {
        strategy: options.fill_method_name().into(),
        edge_method: options.edge_splitter_name().into(),
        bound: crate::names::bound_name(options.mesher().bound).into(),
        seconds: f64::INFINITY,
        ..SurfaceEntry::default()
    };
    let mut parts = Vec::new();
    for _ in 0..RUNS {
        let clock = Stopwatch::of_process();
        parts = mesh_parts(model.brep(), &resolved, cancel, &|_| ());
        entry.seconds = entry.seconds.min(clock.seconds());
        if entry.seconds > LONG {
            break;
        }
    }
    for (i, part, instances, _) in placed(&resolved, &parts) {
        book(&model.brep().parts[i], part, instances, &mut entry);
    }
    Ok(entry)
}

fn book(part: &chordal_brep::Part, meshed: &MeshedPart, instances: usize, entry: &mut SurfaceEntry) {
    entry.triangles += instances * meshed.mesh.triangle_count();
    entry.edges += instances * meshed.mesh.edges.iter().map(|e| e.len().saturating_sub(1)).sum::<usize>();
    for face in &meshed.report.faces {
        entry.failed_faces += instances * usize::from(face.failed.is_some());
        let of_cells =
            face.trace.parts().filter(|(name, _)| name.ends_with("leaves") || name.ends_with("cells"));
        entry.cells += instances * of_cells.map(|(_, count)| count).sum::<usize>();
    }
    for face in &meshed.mesh.faces {
        let Some(FaceGeometry::Surface(surface)) = part.faces.get(face.face as usize).map(|f| &f.geometry)
        else {
            continue;
        };
        let Some((form, uv)) = on_form(surface, face) else { continue };
        entry.vertices += uv.len();
        entry.evaluation += shortest(|| uv.iter().map(|&p| form.point(p)).sum());
        // Swapping costs as much as the net is large.
        let is_worth = uv.len() > form.points().len();
        let evaluator =
            || if is_worth { CoherentEvaluator::new(&form) } else { CoherentEvaluator::unswapped(&form) };
        // The document's vertices come in this order anyway.
        let sorted: Vec<DVec2> = evaluator().order(&uv).into_iter().map(|i| uv[i as usize]).collect();
        entry.coherent += shortest(|| {
            let mut evaluator = evaluator();
            sorted.iter().map(|&p| evaluator.point(p)).sum()
        });
    }
}

/// The corners of a face in the parameters of its NURBS form; `None` where it has no exact one.
fn on_form(surface: &Surface, face: &FaceMesh) -> Option<(NurbsSurface, Vec<DVec2>)> {
    let uv: Vec<DVec2> = face.corners.iter().map(|c| c.uv).collect();
    if let Surface::Nurbs(spline) = surface {
        return Some((spline.clone(), uv));
    }
    let within = UvBox::from_points(uv.iter().copied());
    let form = surface.to_nurbs(within).ok()?;
    let map = surface.nurbs_parameters(within).ok()?;
    Some((form, uv.into_iter().map(|p| map.nurbs_from_native(p)).collect()))
}

fn shortest(evaluate: impl Fn() -> DVec3) -> f64 {
    let run = || {
        let clock = Stopwatch::of_thread();
        black_box(evaluate());
        clock.seconds()
    };
    (0..RUNS).map(|_| run()).fold(f64::INFINITY, f64::min)
}
