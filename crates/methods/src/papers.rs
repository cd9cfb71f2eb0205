//! The tables of Balázs, Guthe, Klein 2004, measured on a model: trimming edges per method (Table 2),
//! triangles and time per surface method with and without coherence (Tables 3 and 4).

use crate::compare::{MeshedUse, bound_name, edge_chords};
use crate::edge_method::{EdgeMethod, edge_method_named, edge_methods};
use crate::fill::Cut;
use crate::fill::quadtree::Stretch;
use crate::loops::{LoopRow, loop_rows};
use crate::strategy::Strategy;
use chordal_brep::{FaceGeometry, Part};
use chordal_mesh::FaceMesh;
use chordal_nurbs::{CoherentEvaluator, DVec2, DVec3, NurbsSurface, Surface, UvBox};
use chordal_tessellate::method::{EdgeSplitter, FillMethod};
use chordal_tessellate::{Bound, Stopwatch};
use serde::Serialize;
use std::hint::black_box;
use std::sync::Arc;

/// The tables for one model.
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
    /// Vertices that were added where loops cross in the plane of parameters.
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
    /// Shortest CPU time of all threads (wall time where the system does not tell) of some runs, from the
    /// exact model to the mesh.
    pub seconds: f64,
    /// Vertices of all faces, those at edges once a face.
    pub vertices: usize,
    /// Seconds to evaluate them on the NURBS forms of the faces, each by itself.
    pub evaluation: f64,
    /// Seconds with reuse, the vertices sorted beforehand.
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

/// One row of Tables 3 and 4: how faces are filled and edges are cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceMethod {
    strategy: Option<Strategy>,
    edge_method: Option<EdgeMethod>,
    /// How errors are judged.
    pub bound: Bound,
}

impl SurfaceMethod {
    /// The method for the options of the mesher; none for the default mesher.
    pub fn fill_method(&self) -> Option<Arc<dyn FillMethod>> {
        self.strategy.map(|strategy| Arc::new(strategy) as Arc<dyn FillMethod>)
    }

    /// The edge method for the options of the mesher; none for the default mesher.
    pub fn edge_splitter(&self) -> Option<Arc<dyn EdgeSplitter>> {
        self.edge_method.map(|method| Arc::new(method) as Arc<dyn EdgeSplitter>)
    }
}

/// The methods of Tables 3 and 4, and the default mesher.
pub fn surface_methods() -> Vec<SurfaceMethod> {
    let lifted = edge_method_named("bezier3d").and_then(|e| e.method);
    let quadtree = Strategy::Quadtree(Stretch::SingularValue);
    let planar = EdgeMethod::Bezier2d;
    let mut methods =
        vec![SurfaceMethod { strategy: Some(quadtree), edge_method: Some(planar), bound: Bound::Proven }];
    let lifted_with = [
        quadtree,
        Strategy::Binary(Cut::Midpoint),
        Strategy::Kd(Cut::Midpoint),
        Strategy::Kd(Cut::WorstPoint),
    ];
    let pairs = lifted_with.into_iter().map(|strategy| (Some(strategy), lifted)).chain([(None, None)]);
    for (strategy, edge_method) in pairs {
        let with_bound = |bound| SurfaceMethod { strategy, edge_method, bound };
        methods.extend([Bound::Proven, Bound::Estimated].map(with_bound));
    }
    methods
}

/// Table 2: every edge method on the loops of parts, each with its instances and its tolerance in its own
/// units.
pub fn loop_entries<'a>(parts: impl Iterator<Item = (&'a Part, usize, f64)>) -> Vec<LoopEntry> {
    let methods: Vec<EdgeMethod> = edge_methods().iter().filter_map(|e| e.method).collect();
    let named = |method: &EdgeMethod| LoopEntry { method: method.name().into(), ..LoopEntry::default() };
    let mut entries: Vec<LoopEntry> = methods.iter().map(named).collect();
    for (part, instances, tolerance) in parts.filter(|(_, instances, _)| *instances > 0) {
        for (entry, row) in entries.iter_mut().zip(quickest(part, tolerance, &methods)) {
            entry.conversion += row.conversion;
            entry.approximation += row.approximation;
            entry.edges += instances * row.edges;
            entry.crossings += instances * row.crossings;
            entry.left_out += instances * row.left_out;
        }
    }
    entries
}

/// Rows with the shortest times of some runs.
fn quickest(part: &Part, tolerance: f64, methods: &[EdgeMethod]) -> Vec<LoopRow> {
    let mut rows = loop_rows(part, tolerance, methods);
    for _ in 1..RUNS {
        for (row, again) in rows.iter_mut().zip(loop_rows(part, tolerance, methods)) {
            row.conversion = row.conversion.min(again.conversion);
            row.approximation = row.approximation.min(again.approximation);
        }
    }
    rows
}

/// Runs `mesh` several times and returns its last result with the shortest time; a long run is not repeated.
pub fn timed<T>(mut mesh: impl FnMut() -> T) -> (T, f64) {
    let mut shortest = f64::INFINITY;
    let mut runs = 0;
    loop {
        let clock = Stopwatch::of_process();
        let result = mesh();
        shortest = shortest.min(clock.seconds());
        runs += 1;
        if runs == RUNS || shortest > LONG {
            return (result, shortest);
        }
    }
}

impl SurfaceEntry {
    /// A row of Tables 3 and 4: a model meshed by `method` in `seconds`.
    pub fn of(method: &SurfaceMethod, uses: &[MeshedUse<'_>], seconds: f64) -> Self {
        let default = || "default".to_owned();
        let mut entry = Self {
            strategy: method.strategy.map_or_else(default, |s| s.name().into()),
            edge_method: method.edge_method.map_or_else(default, |m| m.name().into()),
            bound: bound_name(method.bound).into(),
            seconds,
            ..Self::default()
        };
        uses.iter().for_each(|one| entry.add(one));
        entry
    }

    fn add(&mut self, one: &MeshedUse<'_>) {
        self.triangles += one.instances * one.mesh.triangle_count();
        self.edges += one.instances * edge_chords(one.mesh);
        for face in &one.report.faces {
            self.failed_faces += one.instances * usize::from(face.failed.is_some());
            let is_of_cells = |name: &str| name.ends_with("leaves") || name.ends_with("cells");
            let of_cells = face.trace.parts().filter(|(name, _)| is_of_cells(name));
            self.cells += one.instances * of_cells.map(|(_, count)| count).sum::<usize>();
        }
        for face in &one.mesh.faces {
            let geometry = one.part.faces.get(face.face as usize).map(|f| &f.geometry);
            if let Some(FaceGeometry::Surface(surface)) = geometry
                && let Some((form, uv)) = on_form(surface, face)
            {
                self.add_evaluation(&form, &uv);
            }
        }
    }

    fn add_evaluation(&mut self, form: &NurbsSurface, uv: &[DVec2]) {
        self.vertices += uv.len();
        self.evaluation += shortest(|| uv.iter().map(|&p| form.point(p)).sum());
        // Swapping costs as much as the net is large.
        let is_worth = uv.len() > form.points().len();
        let evaluator =
            || if is_worth { CoherentEvaluator::new(form) } else { CoherentEvaluator::unswapped(form) };
        // The paper's vertices come in this order anyway.
        let sorted: Vec<DVec2> = evaluator().order(uv).into_iter().map(|i| uv[i as usize]).collect();
        self.coherent += shortest(|| {
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
