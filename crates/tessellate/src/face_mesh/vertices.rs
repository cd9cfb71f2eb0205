//! The geometry of the vertices of a face: where they are, which way they face, how triangles at them are
//! shaped.

use super::FaceMesh;
use crate::metric::{Metric, Sizing};
use chordal_nurbs::{DVec2, DVec3, SurfaceJet, UvBox, math};

/// How much the sideways bend of parameter lines counts against their bend along the normal when triangles
/// are shaped. Without it, long edges cut across a surface beside its parameter lines; at its full weight,
/// triangles get short.
const SIDEWAYS: f64 = 0.3;

/// Across the whole face, the metric counts at least this many chords. It breaks ties where the surface is
/// flat and is too little to matter where it is curved.
const LEAST_CHORDS: f64 = 0.05;

/// At a pole, derivatives are rounding: triangles there are shaped as they are this share of the way to the
/// middle of the face.
const BESIDE_POLE: f64 = 0.05;

/// One entry per vertex, in step with the points of the triangulation.
#[derive(Debug, Default)]
pub(super) struct Vertices {
    pub metrics: Vec<Metric>,
    /// The surface at the vertex (not the mesh vertex, which may lie off it).
    pub xyz: Vec<DVec3>,
    pub normals: Vec<DVec3>,
    /// The vertex lies at a pole: its normal depends on where one comes from, so no edge turns by it.
    pub at_pole: Vec<bool>,
    /// Regularises metrics that vanish in some direction.
    floor: f64,
    /// The middle of the box of the loops, which is that of the face.
    middle: DVec2,
}

impl Vertices {
    pub fn pop(&mut self) {
        self.metrics.pop();
        self.xyz.pop();
        self.normals.pop();
        self.at_pole.pop();
    }

    pub fn truncate(&mut self, n: usize) {
        self.metrics.truncate(n);
        self.xyz.truncate(n);
        self.normals.truncate(n);
        self.at_pole.truncate(n);
    }

    pub fn set_last_metric(&mut self, metric: Metric) {
        if let Some(last) = self.metrics.last_mut() {
            *last = metric;
        }
    }
}

impl FaceMesh<'_, '_> {
    /// Measures the points of the loops.
    pub(super) fn measure_loops(&mut self) {
        // The radius about the mean of the points, not a box, which would depend on how the part lies in
        // space.
        let points = || self.chart.points.iter().map(|point| self.position(point.key));
        let middle = points().sum::<DVec3>() / self.chart.points.len().max(1) as f64;
        let radius = points().fold(f64::MIN_POSITIVE, |m, p| m.max(p.distance(middle)));
        self.vertices.floor = math::square(LEAST_CHORDS / radius);
        self.vertices.middle = UvBox::from_points(self.mesh.points.iter().copied()).center();
        for i in 0..self.mesh.points.len() {
            self.measure(self.mesh.points[i]);
        }
    }

    /// Adds the geometry of one vertex.
    pub(super) fn measure(&mut self, p_uv: DVec2) {
        let surface = self.surface();
        let jet = self.foreseen.jet(surface, p_uv);
        let at_pole = surface.pole_at(jet.p, self.context.trimmed.resolution).is_some();
        let sizing = if at_pole { None } else { Sizing::new(&jet, self.limits) };
        let metric = match sizing {
            Some(sizing) => self.metric_of(&jet, sizing),
            None => {
                let beside = surface.jet(self.beside_pole(p_uv));
                self.metric_of(&beside, Sizing::new(&beside, self.limits).unwrap_or_default())
            }
        };
        self.vertices.metrics.push(metric);
        self.vertices.xyz.push(jet.p);
        self.vertices.normals.push(surface.normal_at(p_uv, &jet));
        self.vertices.at_pole.push(at_pole);
    }

    fn metric_of(&self, jet: &SurfaceJet, sizing: Sizing) -> Metric {
        let first =
            Metric { uu: jet.du.length_squared(), uv: jet.du.dot(jet.dv), vv: jet.dv.length_squared() };
        let per_chord = SIDEWAYS / (8.0 * self.limits.tolerance);
        sizing.metric.plus(first, self.vertices.floor).plus(Metric::sideways(jet), per_chord).settled()
    }

    fn beside_pole(&self, p_uv: DVec2) -> DVec2 {
        p_uv.lerp(self.vertices.middle, BESIDE_POLE)
    }
}
