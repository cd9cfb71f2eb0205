//! One face: chart → boundary triangulation → points inside → proof, with requests to edges where they are too coarse.

mod finish;
mod shape;

use self::shape::{Shape, boundary_triangles, shape};
use crate::bulk::Foreseen;
use crate::chart::{FaceContext, Key, Segment};
use crate::crossings::{coarse_chords, shut_corners};
use crate::doubled::SharedEdge;
use crate::metric::{Limits, Metric, Sizing};
use crate::options::{Cancel, Options};
use crate::place::Rows;
use crate::prove::{Prover, Verdict};
use crate::report::Phases;
use crate::strategy::{self, Strategy, trace::Trace};
use crate::triangulate::{Location, NONE, Triangulation, clip_ears, orient};
use crate::unroll::{Chart, SEAM_CHORD};
use chordal_nurbs::{DVec2, DVec3, SurfaceBounds, SurfaceJet, UvBox};
use std::time::Instant;

/// A face's triangles before vertices are joined with the neighbours'.
#[derive(Clone, Debug, Default)]
pub(crate) struct FaceResult {
    pub uv: Vec<DVec2>,
    pub keys: Vec<Key>,
    pub normals: Vec<DVec3>,
    pub triangles: Vec<[u32; 3]>,
    /// Edges between triangles that other faces may have too.
    pub inner: Vec<SharedEdge>,
    /// The first `2 · quads` triangles are halves of quadrilaterals.
    pub quads: usize,
    /// The outer loop runs against the face's sense: the neighbours tell which of the two is right.
    pub doubtful: bool,
    /// Positions of the keys that are private.
    pub private: Vec<DVec3>,
    pub proven_error: f64,
    /// The largest distance of a chord of an edge.
    pub boundary_error: f64,
    pub gap: f64,
    pub bound: &'static str,
    /// c·∫√|K| dA / ε, and the strips of a singly curved face.
    pub curvature_bound: f64,
    /// Which parts ran, and how long.
    pub trace: Trace,
    pub phases: Phases,
    /// The cells of a subdivision, where they are asked for.
    pub cells: Vec<UvBox>,
}

impl FaceResult {
    /// Makes the face face the other way.
    pub fn turn_over(&mut self) {
        self.triangles.iter_mut().for_each(|t| t.swap(1, 2));
        self.normals.iter_mut().for_each(|n| *n = -*n);
    }
}

/// What became of a face in one round.
pub(crate) enum Outcome {
    Done(Box<FaceResult>),
    /// Chords (edge, index) that are too coarse for this face.
    Finer(Vec<(u32, u32)>),
    Failed(String),
}

/// Meshes one face with the edges as they are.
pub(crate) fn mesh_face(
    context: &FaceContext<'_, '_>,
    limits: &Limits,
    options: &Options,
    cancel: &Cancel,
) -> Outcome {
    let mut how = Try {
        seam_chord: SEAM_CHORD,
        accept: context.accept,
        creased: true,
        folds: false,
        closer: context.closer,
    };
    // Where the surface turns at once, no seam is fine enough for the angle: the tolerance comes first, and the audit will tell.
    let any_angle = &Limits { angle: f64::INFINITY, ..*limits };
    for (folds, limits) in [(false, limits), (true, limits), (true, any_angle)] {
        (how.folds, how.seam_chord) = (folds, SEAM_CHORD);
        for _ in 0..SEAM_TRIES {
            match FaceWork::run(context, limits, options, cancel, how) {
                Ok(Attempt::Over(outcome)) => return outcome,
                Ok(Attempt::Crossing) => how.creased = false,
                Ok(Attempt::FinerSeam) => how.seam_chord *= 0.7,
                // Points inside did not do: finer edges must.
                Ok(Attempt::Stuck) if how.closer => how.closer = false,
                // Nothing more can be done about it: better a face that is known to be off than none.
                Ok(Attempt::Stuck) => how.accept = true,
                Err(reason) => return Outcome::Failed(reason),
            }
        }
    }
    how = Try { accept: true, creased: false, closer: false, ..how };
    match FaceWork::run(context, limits, options, cancel, how) {
        Ok(Attempt::Over(outcome)) => outcome,
        Ok(_) => Outcome::Failed("its seam cannot be cut finely enough".into()),
        Err(reason) => Outcome::Failed(reason),
    }
}

/// How one attempt at a face is made.
#[derive(Clone, Copy)]
struct Try {
    seam_chord: f64,
    /// Take what there is, with the error it has.
    accept: bool,
    /// Cut along the creases of the surface.
    creased: bool,
    /// Facets may double back over seams and creases, beyond which the face goes on: it lies narrower there than its tolerance.
    folds: bool,
    /// Look closer at chords whose bounds are far beyond the tolerance before they are made finer.
    closer: bool,
}

/// How one attempt at a face ended.
enum Attempt {
    Over(Outcome),
    /// The seam must be cut finer.
    FinerSeam,
    /// The loops cross in truth: they have no inside that could be cut along creases.
    Crossing,
    /// A triangle can be mended by nothing.
    Stuck,
}

/// Corners at poles are taken this share of their triangle off the pole: half of what bounds of cones still call the apex.
const BESIDE_POLE: f64 = 5e-10;

/// How much the sideways bend of parameter lines counts against their bend along the normal when triangles are shaped.
const SIDEWAYS: f64 = 0.3;

/// A seam that proves too coarse is cut finer this often.
const SEAM_TRIES: usize = 8;

pub(crate) struct FaceWork<'a, 's> {
    pub context: &'a FaceContext<'a, 's>,
    pub limits: &'a Limits,
    pub chart: Chart,
    pub mesh: Triangulation,
    pub metrics: Vec<Metric>,
    /// The surface at each chart vertex (not the mesh vertex, which may lie off it).
    pub xyz: Vec<DVec3>,
    pub normals: Vec<DVec3>,
    pub foreseen: Foreseen,
    /// Chart points at poles: the normal there depends on where one comes from, so no edge turns by it.
    pub at_pole: Vec<bool>,
    /// Regularises metrics that vanish in some direction.
    floor: f64,
    shape: Shape,
    pub trace: Trace,
    pub phases: Phases,
    pub cells: Vec<UvBox>,
    /// Corners of quadrilaterals that were made of two triangles each.
    pub quads: Vec<[u32; 4]>,
}

impl<'a, 's> FaceWork<'a, 's> {
    fn run(
        context: &'a FaceContext<'a, 's>,
        limits: &'a Limits,
        options: &Options,
        cancel: &Cancel,
        how: Try,
    ) -> Result<Attempt, String> {
        let started = Instant::now();
        let chart = Chart::new(context, limits, how.seam_chord, how.creased)?;
        let points: Vec<DVec2> = chart.points.iter().map(|p| p.uv).collect();
        let shape = shape(context, limits, UvBox::from_points(points.iter().copied()));
        let mut clipped = false;
        let triangles = match boundary_triangles(&points, &chart, shape) {
            Ok(triangles) => triangles,
            Err(culprits) => {
                let coarse = coarse_chords(context, &chart, &culprits);
                if !context.last_resort && !coarse.is_empty() {
                    return Ok(Attempt::Over(Outcome::Finer(coarse)));
                }
                if how.creased && context.surface.creases.iter().any(|c| !c.is_empty()) {
                    return Ok(Attempt::Crossing);
                }
                let ears = clip_ears(&points, &chart.loops).ok_or("its loops cross each other")?;
                clipped = true;
                ears
            }
        };
        let uv_box = UvBox::from_points(points.iter().copied());
        let mut work = Self {
            context,
            limits,
            mesh: Triangulation::new(points, triangles),
            metrics: Vec::new(),
            xyz: Vec::new(),
            normals: Vec::new(),
            foreseen: Foreseen::new(&options.bulk),
            at_pole: Vec::new(),
            floor: 0.0,
            shape,
            chart,
            trace: Trace::default(),
            phases: Phases::default(),
            cells: Vec::new(),
            quads: Vec::new(),
        };
        work.measure_boundary();
        let bounds = SurfaceBounds::new(context.surface.surface, uv_box, limits.tolerance);
        let deadline = options.face_timeout.map(|t| started + t);
        // Loops that cross in truth leave triangles turned over, which no refining mends.
        let hopeless = clipped && work.is_turned_somewhere();
        let mut prover = Prover::new(&bounds, limits, options, deadline, cancel, how.accept || hopeless);
        prover.hopeless = hopeless;
        prover.folds = how.folds;
        if !how.closer {
            prover.closer_looks = 0;
        }
        let verdict = match options.strategy {
            Strategy::Default => {
                work.fill_by_rows();
                strategy::refine_opened(&mut work, &mut prover)?
            }
            _ => strategy::fill(&mut work, &mut prover, options)?,
        };
        match verdict {
            Verdict::Finer(chords) => Ok(Attempt::Over(Outcome::Finer(chords))),
            Verdict::FinerSeam => Ok(Attempt::FinerSeam),
            Verdict::Stuck => Ok(Attempt::Stuck),
            // Turned over, a triangle may lie outside of the face, which no distance to the surface would show.
            Verdict::Proven { .. } if clipped && work.is_turned_somewhere() => {
                let result = work.finish(f64::INFINITY, "none", options);
                Ok(Attempt::Over(Outcome::Done(Box::new(result))))
            }
            Verdict::Proven { error, bound } => {
                let shut = if context.last_resort { Vec::new() } else { shut_corners(context, &work.chart) };
                if !shut.is_empty() {
                    return Ok(Attempt::Over(Outcome::Finer(shut)));
                }
                Ok(Attempt::Over(Outcome::Done(Box::new(work.finish(error, bound, options)))))
            }
        }
    }

    /// Adds the geometry of one chart vertex.
    fn measure(&mut self, p_uv: DVec2) {
        let surface = self.context.surface;
        let jet = self.foreseen.jet(surface, p_uv);
        let at_pole = surface.pole_at(jet.p, self.context.resolution).is_some();
        let sizing = if at_pole { None } else { Sizing::new(&jet, self.limits) };
        self.metrics.push(match sizing {
            Some(sizing) => self.metric_of(&jet, sizing),
            // What is left of derivatives at a pole is rounding: triangles there are shaped as a little further inside.
            None => {
                let beside = surface.jet(self.beside_pole(p_uv));
                self.metric_of(&beside, Sizing::new(&beside, self.limits).unwrap_or_default())
            }
        });
        self.xyz.push(jet.p);
        self.normals.push(surface.normal_at(p_uv, &jet));
        self.at_pole.push(at_pole);
    }

    fn metric_of(&self, jet: &SurfaceJet, sizing: Sizing) -> Metric {
        let first =
            Metric { uu: jet.du.length_squared(), uv: jet.du.dot(jet.dv), vv: jet.dv.length_squared() };
        let per_chord = SIDEWAYS / (8.0 * self.limits.tolerance);
        sizing.metric.plus(first, self.floor).plus(Metric::sideways(jet), per_chord).settled()
    }

    fn beside_pole(&self, p_uv: DVec2) -> DVec2 {
        p_uv.lerp(UvBox::from_points(self.mesh.points.iter().copied()).center(), 0.05)
    }

    fn measure_boundary(&mut self) {
        // A hundredth of a chord across the whole face: enough to break ties, too little to matter. No box, which would
        // depend on how the part lies in space.
        let points = || self.chart.points.iter().map(|point| self.position(point.key));
        let middle = points().sum::<DVec3>() / self.chart.points.len().max(1) as f64;
        let radius = points().fold(f64::MIN_POSITIVE, |m, p| m.max(p.distance(middle)));
        self.floor = (0.05 / radius).powi(2);
        for i in 0..self.mesh.points.len() {
            self.measure(self.mesh.points[i]);
        }
    }

    pub fn position(&self, key: Key) -> DVec3 {
        match key {
            Key::Vertex(v) => self.context.part.vertices[v as usize].point,
            Key::Edge(e, i) => self.context.edges[e as usize].points[i as usize],
            // Behind the seam's own points come those inside the face, in the order of the triangulation.
            Key::Private(k) => match self.chart.private.get(k as usize) {
                Some(&point) => point,
                None => self.xyz[k as usize - self.chart.private.len() + self.chart.points.len()],
            },
        }
    }

    pub fn key(&self, vertex: u32) -> Key {
        self.chart.points.get(vertex as usize).map_or_else(
            || Key::Private((self.chart.private.len() + vertex as usize - self.chart.points.len()) as u32),
            |p| p.key,
        )
    }

    /// The normals by which the edges of a triangle turn: those that its corners are written with.
    pub fn turning_normals(&self, triangle: [u32; 3]) -> [DVec3; 3] {
        let mut normals = triangle.map(|v| self.normals[v as usize]);
        if let Some((i, uv)) = self.pole_corner(triangle) {
            normals[i] = self.context.surface.normal(uv);
        }
        normals
    }

    /// The corner of a triangle that lies on a pole, and the place just beside the pole that it is seen from between its other
    /// two: that is where its normal belongs.
    fn pole_corner(&self, triangle: [u32; 3]) -> Option<(usize, DVec2)> {
        let i = (0..3).find(|&i| self.at_pole[triangle[i] as usize])?;
        let corner = triangle[i] as usize;
        let pole = self.context.surface.pole_at(self.xyz[corner], self.context.resolution)?;
        let along = 1 - pole.axis;
        let [a, b] = [1, 2].map(|k| self.mesh.points[triangle[(i + k) % 3] as usize]);
        let own = self.mesh.points[corner];
        let mut uv = own;
        // Just inside: on the pole itself rounding decides which side the normal is taken from.
        uv[pole.axis] += BESIDE_POLE * (a.midpoint(b)[pole.axis] - uv[pole.axis]);
        uv[along] = 0.5 * (a[along] + b[along]);
        let side = |uv: DVec2| orient(uv, a, b);
        // Triangles so thin that they would turn over keep the corner's own place along the pole, or altogether.
        let places = [uv, if along == 0 { DVec2::new(own.x, uv.y) } else { DVec2::new(uv.x, own.y) }];
        let uv = places.into_iter().find(|&uv| side(uv) * side(own) > 0.0).unwrap_or(own);
        Some((i, uv))
    }

    /// True where a triangle runs clockwise in the chart.
    fn is_turned_somewhere(&self) -> bool {
        (0..self.mesh.triangles.len() as u32).any(|t| {
            let [a, b, c] = self.mesh.corners(t);
            orient(a, b, c) < 0.0
        })
    }

    /// The boundary segment from one chart vertex to another, where there is one.
    pub fn segment(&self, a: u32, b: u32) -> Option<Segment> {
        let &(start, end) = self.chart.loops.iter().find(|&&(start, end)| (start..end).contains(&a))?;
        let next = if a + 1 == end { start } else { a + 1 };
        (next == b).then(|| self.chart.points[a as usize].segment)
    }

    /// Better shaped triangles from the boundary alone.
    fn improve_boundary(&mut self) {
        let points = self.mesh.points.clone();
        match self.shape {
            Shape::Flat | Shape::Doubly => self.mesh.flip_all(&self.metrics, &|_, _, _, _| true),
            Shape::Singly { axis } => {
                // A flip must not widen the turn of its triangles.
                let width = |t: [u32; 3]| {
                    let x = t.map(|v| points[v as usize][axis]);
                    x[0].max(x[1]).max(x[2]) - x[0].min(x[1]).min(x[2])
                };
                self.mesh.flip_all(&self.metrics, &|apex, a, b, apex2| {
                    let before = width([apex, a, b]).max(width([apex2, b, a]));
                    let after = width([apex, a, apex2]).max(width([apex, apex2, b]));
                    after <= before * (1.0 + 1e-9)
                });
            }
        }
        self.mesh.changed.clear();
    }

    /// The default strategy.
    pub fn fill_by_rows(&mut self) {
        self.improve_boundary();
        if self.shape == Shape::Doubly {
            self.place_interior();
        }
        self.trace.add("boundary sweep", self.chart.loops.len());
        self.trace.add("points in rows", self.mesh.points.len() - self.chart.points.len());
    }

    fn place_interior(&mut self) {
        let rows = Rows::new(self.context.surface, &self.chart, self.limits);
        let points: Vec<DVec2> = rows.insertion_order().iter().map(|&p| self.chart.grid.snap(p)).collect();
        self.foreseen.ask(self.context.surface, points.iter().copied());
        let mut hint = 0;
        for p in points {
            let at = self.mesh.locate(p, hint);
            let (Location::Inside(t) | Location::OnEdge(t, _)) = at else { continue };
            hint = t;
            if self.too_near(t, p) {
                continue;
            }
            self.insert(p, at);
        }
        self.mesh.changed.clear();
    }

    /// Inserts a point that is known to lie inside; returns its index.
    pub fn insert(&mut self, p: DVec2, at: Location) -> Option<u32> {
        self.measure(p);
        self.keep_inserted(p, at)
    }

    /// Inserts a point whose geometry is known already, or forgets that.
    fn keep_inserted(&mut self, p: DVec2, at: Location) -> Option<u32> {
        let vertex = self.mesh.insert(p, at, &self.metrics);
        if vertex.is_none() {
            self.metrics.pop();
            self.xyz.pop();
            self.normals.pop();
            self.at_pole.pop();
        }
        vertex
    }

    /// Nearer to the corners of its triangle, or to a boundary edge of it, than rows lie apart.
    fn too_near(&self, t: u32, p: DVec2) -> bool {
        let corners = self.mesh.triangles[t as usize];
        let m = Metric::mean(corners.map(|v| self.metrics[v as usize]));
        let c = self.mesh.corners(t);
        if c.iter().any(|&c| m.length(p - c) < 0.45) {
            return true;
        }
        (0..3).any(|i| {
            if self.mesh.neighbors[t as usize][i] != NONE {
                return false;
            }
            let (a, b) = (c[(i + 1) % 3], c[(i + 2) % 3]);
            let length = m.length(b - a);
            // Height over the edge in the metric: area in the metric over the length.
            let height = m.determinant().max(0.0).sqrt() * (b - a).perp_dot(p - a).abs() / length.max(1e-300);
            height < 0.3
        })
    }

    /// Adds a point that no triangle uses yet.
    pub fn add_point(&mut self, p: DVec2, metric: Metric) -> u32 {
        self.measure(p);
        if let Some(last) = self.metrics.last_mut() {
            *last = metric;
        }
        self.mesh.points.push(p);
        self.mesh.points.len() as u32 - 1
    }

    /// The same, with a metric of the caller's choice for the new point.
    pub fn insert_in_metric(&mut self, p: DVec2, at: Location, metric: Metric) -> Option<u32> {
        self.measure(p);
        *self.metrics.last_mut()? = metric;
        self.keep_inserted(p, at)
    }
}
