//! The triangulation of one face as it grows: the chart, its triangles, and the geometry of every vertex.
//!
//! A vertex has an index: first come the points of the chart's loops, then those inside, in the order of
//! insertion. Methods that fill a face add points and connect them; vertices of the loops are never added or
//! moved, because the faces beside them have the same ones.

mod finish;
mod pole_corners;
mod shape;
mod vertices;

pub(crate) use shape::{Shape, boundary_triangles, shape, sweep_axis};

use crate::bulk::{Bulk, Foreseen};
use crate::face_context::FaceContext;
use crate::limits::Limits;
use crate::metric::Metric;
use crate::report::Phases;
use crate::trace::Trace;
use crate::triangulate::{Location, Triangulation};
use chordal_brep::{Face, Part};
use chordal_chart::{Chart, EdgeSamples, FaceSurface, Key, Segment};
use chordal_nurbs::orient;
use chordal_nurbs::{DVec2, DVec3, UvBox};
use vertices::Vertices;

/// One face: its chart, its triangles and the geometry of their vertices.
#[derive(Debug)]
pub struct FaceMesh<'a, 's> {
    context: &'a FaceContext<'a, 's>,
    limits: &'a Limits,
    chart: Chart,
    mesh: Triangulation,
    vertices: Vertices,
    foreseen: Foreseen,
    shape: Shape,
    trace: Trace,
    phases: Phases,
    cells: Vec<UvBox>,
    /// Corners of quadrilaterals that were made of two triangles each.
    quads: Vec<[u32; 4]>,
}

impl<'a, 's> FaceMesh<'a, 's> {
    /// A face with these triangles between the points of its loops.
    pub(crate) fn new(
        context: &'a FaceContext<'a, 's>,
        limits: &'a Limits,
        chart: Chart,
        shape: Shape,
        triangles: Vec<[u32; 3]>,
        bulk: &Bulk,
    ) -> Self {
        let points: Vec<DVec2> = chart.points.iter().map(|p| p.uv).collect();
        let mut face = Self {
            context,
            limits,
            mesh: Triangulation::new(points, triangles),
            vertices: Vertices::default(),
            foreseen: Foreseen::new(bulk),
            shape,
            chart,
            trace: Trace::default(),
            phases: Phases::default(),
            cells: Vec::new(),
            quads: Vec::new(),
        };
        face.measure_loops();
        face
    }

    pub(crate) fn context(&self) -> &'a FaceContext<'a, 's> {
        self.context
    }

    pub(crate) fn shape(&self) -> Shape {
        self.shape
    }

    /// The surface of the face.
    pub fn surface(&self) -> &'a FaceSurface<'s> {
        self.context.trimmed.surface
    }

    /// The face in the model.
    pub fn face(&self) -> &'a Face {
        self.context.trimmed.face
    }

    /// The part that the face belongs to.
    pub fn part(&self) -> &'a Part {
        self.context.trimmed.part
    }

    /// The polyline of an edge of the part.
    pub fn edge_samples(&self, edge: u32) -> &'a EdgeSamples {
        &self.context.trimmed.edges[edge as usize]
    }

    /// What the mesh must keep.
    pub fn limits(&self) -> &'a Limits {
        self.limits
    }

    /// The loops as polygons.
    pub fn chart(&self) -> &Chart {
        &self.chart
    }

    /// The triangles.
    pub fn mesh(&self) -> &Triangulation {
        &self.mesh
    }

    /// The triangles, to be connected otherwise. Points are added by the methods of this type only.
    pub fn mesh_mut(&mut self) -> &mut Triangulation {
        &mut self.mesh
    }

    /// The surface at every vertex, in the order of vertices. A mesh vertex of an edge may lie off it.
    pub fn surface_points(&self) -> &[DVec3] {
        &self.vertices.xyz
    }

    pub(crate) fn normal(&self, vertex: u32) -> DVec3 {
        self.vertices.normals[vertex as usize]
    }

    /// The surface at a vertex.
    pub fn xyz(&self, vertex: u32) -> DVec3 {
        self.vertices.xyz[vertex as usize]
    }

    /// The metric in which triangles at a vertex are shaped.
    pub fn metric(&self, vertex: u32) -> Metric {
        self.vertices.metrics[vertex as usize]
    }

    pub(crate) fn metrics(&self) -> &[Metric] {
        &self.vertices.metrics
    }

    pub(crate) fn set_metrics(&mut self, metrics: Vec<Metric>) {
        self.vertices.metrics = metrics;
    }

    /// Shapes triangles in one metric everywhere.
    pub fn set_metric(&mut self, metric: Metric) {
        self.vertices.metrics.fill(metric);
    }

    pub(crate) fn is_at_pole(&self, vertex: u32) -> bool {
        self.vertices.at_pole[vertex as usize]
    }

    pub(crate) fn touches_pole(&self) -> bool {
        self.vertices.at_pole.contains(&true)
    }

    /// Which parts ran for this face.
    pub fn trace(&self) -> &Trace {
        &self.trace
    }

    /// Counts `count` things made by `part`.
    pub fn count(&mut self, part: &'static str, count: usize) {
        self.trace.add(part, count);
    }

    /// Replaces the counts of all parts.
    pub fn set_trace(&mut self, trace: Trace) {
        self.trace = trace;
    }

    /// Seconds spent in the phases of a method.
    pub fn phases_mut(&mut self) -> &mut Phases {
        &mut self.phases
    }

    pub(crate) fn set_cells(&mut self, cells: Vec<UvBox>) {
        self.cells = cells;
    }

    /// Corners of a quadrilateral that two triangles make up.
    pub fn add_quad(&mut self, corners: [u32; 4]) {
        self.quads.push(corners);
    }

    /// Forgets all quadrilaterals.
    pub fn clear_quads(&mut self) {
        self.quads.clear();
    }

    /// The position of a mesh vertex: for edges and vertices of the part their own, for others a point of the
    /// surface.
    pub fn position(&self, key: Key) -> DVec3 {
        match key {
            Key::Vertex(v) => self.context.trimmed.part.vertices[v as usize].point,
            Key::Edge(e, i) => self.context.trimmed.edges[e as usize].points[i as usize],
            // Behind the seam's own points come those inside the face, in the order of the triangulation.
            Key::Private(k) => match self.chart.private.get(k as usize) {
                Some(&point) => point,
                None => self.vertices.xyz[k as usize - self.chart.private.len() + self.chart.points.len()],
            },
        }
    }

    /// The name of a vertex.
    pub fn key(&self, vertex: u32) -> Key {
        self.chart.points.get(vertex as usize).map_or_else(
            || Key::Private((self.chart.private.len() + vertex as usize - self.chart.points.len()) as u32),
            |p| p.key,
        )
    }

    /// The boundary segment from one vertex to another, where there is one.
    pub(crate) fn segment(&self, a: u32, b: u32) -> Option<Segment> {
        let &(start, end) = self.chart.loops.iter().find(|&&(start, end)| (start..end).contains(&a))?;
        let next = if a + 1 == end { start } else { a + 1 };
        (next == b).then(|| self.chart.points[a as usize].segment)
    }

    /// True where a triangle runs clockwise in the chart.
    pub(crate) fn is_turned_somewhere(&self) -> bool {
        (0..self.mesh.triangles.len() as u32).any(|t| {
            let [a, b, c] = self.mesh.corners(t);
            orient(a, b, c) < 0.0
        })
    }

    /// Flips edges of all triangles towards the Delaunay criterion in the metric, where `allowed` says so: it
    /// gets the corner opposite the edge, the edge's ends and the corner on its other side.
    pub fn flip_all(&mut self, allowed: &dyn Fn(u32, u32, u32, u32) -> bool) {
        self.mesh.flip_all(&self.vertices.metrics, allowed);
    }

    /// Announces points that will be inserted, so that a device may evaluate them all at once.
    pub fn foresee(&mut self, points: impl Iterator<Item = DVec2>) {
        self.foreseen.ask(self.context.trimmed.surface, points);
    }

    /// Inserts a point that is known to lie at this place; returns its index, or `None` on a vertex, on the
    /// boundary or outside.
    pub fn insert(&mut self, p: DVec2, at: Location) -> Option<u32> {
        self.measure(p);
        self.keep_inserted(p, at)
    }

    /// Inserts a point as [`Self::insert`] does, with a metric of the caller's choice.
    pub fn insert_in_metric(&mut self, p: DVec2, at: Location, metric: Metric) -> Option<u32> {
        self.measure(p);
        self.vertices.set_last_metric(metric);
        self.keep_inserted(p, at)
    }

    fn keep_inserted(&mut self, p: DVec2, at: Location) -> Option<u32> {
        let vertex = self.mesh.insert(p, at, &self.vertices.metrics);
        if vertex.is_none() {
            self.vertices.pop();
        }
        vertex
    }

    /// Adds a point that no triangle uses yet.
    pub fn add_point(&mut self, p: DVec2, metric: Metric) -> u32 {
        self.measure(p);
        self.vertices.set_last_metric(metric);
        self.mesh.points.push(p);
        self.mesh.points.len() as u32 - 1
    }

    /// Connects the points by these triangles in place of those that there are.
    pub fn set_triangles(&mut self, triangles: Vec<[u32; 3]>) {
        let points = std::mem::take(&mut self.mesh.points);
        self.mesh = Triangulation::new(points, triangles);
    }

    /// Puts back an earlier triangulation and forgets all vertices that came after it.
    pub fn restore(&mut self, earlier: &Triangulation) {
        self.mesh = earlier.clone();
        self.vertices.truncate(earlier.points.len());
    }
}
