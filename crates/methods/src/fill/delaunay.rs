//! Fill points and a Delaunay triangulation of them with the loops.
//!
//! Source: the survey of the Blender wiki, "Delaunay Triangulation". Points are distributed over the face,
//! those outside of its loops are dropped, and the rest is triangulated with the loops as constraints, by the
//! largest smallest angle alone. *Uniform* points form a grid in the plane of parameters, with as many lines
//! as the uniform grid; where triangles are then too large, more points restrict them by size
//! ([`super::size`]). *Adaptive* points are added where a triangle deviates too much, half way along its
//! longest side inside, as Sheng and Hirsch 1992 restrict triangles by deviation. The proof that all methods
//! share decides in the end.
//!
//! Angles are measured in the plane of parameters, stretched in each direction as the surface is on average.

use super::derivatives::SecondNorms;
use super::grid::fewest;
use super::plain::mean_metric;
use super::region::Region;
use super::size::oversized;
use chordal_brep::MeshIssue;
use chordal_nurbs::{DVec2, UvBox};
use chordal_tessellate::method::{
    Check, FaceFiller, FaceMesh, FaceSurface, Location, Metric, NONE, open_out,
};

/// Where fill points go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fill {
    /// On a grid in the plane of parameters.
    Uniform,
    /// Where triangles deviate.
    Adaptive,
}

/// A face filled by points.
pub struct Delaunay {
    region: Region,
    fill: Fill,
    tolerance: f64,
    /// Lines of the uniform grid.
    lines: [usize; 2],
    /// The largest size of a triangle.
    allowed: f64,
    /// How often the proof requested more points.
    refined: usize,
    /// Points of the adaptive fill so far.
    points: Vec<DVec2>,
    metric: Metric,
}

/// Points nearer to a chord than this share of the grid's step are left out.
const BESIDE: f64 = 0.3;

/// Lines of the first grid where nothing is known about the surface.
const FIRST_LINES: usize = 8;

/// Triangles that the proof found too coarse are restricted to this share of what they were before.
const TIGHTER: f64 = 0.6;

/// How often the proof may request more points. Limits of angle are not reached by size, so more rounds would
/// not help.
const MOST_REFINED: usize = 3;

/// Points by size, for each cell of the grid and each vertex of the loops: no face needs as many, so
/// something else is wrong.
const MOST_BY_SIZE: usize = 16;

impl Delaunay {
    pub fn new(face: &FaceMesh<'_, '_>, fill: Fill) -> Self {
        let region = Region::new(face.chart());
        let surface = face.surface();
        let tolerance = face.limits().tolerance;
        let lines = first_lines(surface, region.uv_box, tolerance);
        let metric = mean_metric(surface, region.uv_box);
        Self { region, fill, tolerance, lines, allowed: tolerance, refined: 0, points: Vec::new(), metric }
    }

    fn insert(&self, face: &mut FaceMesh<'_, '_>, p: DVec2, hint: &mut u32) -> bool {
        let at = face.mesh().locate(p, *hint);
        let (Location::Inside(t) | Location::OnEdge(t, _)) = at else { return false };
        *hint = t;
        face.insert_in_metric(p, at, self.metric).is_some()
    }

    fn grid(&self) -> impl Iterator<Item = DVec2> + use<> {
        let ([n, m], b) = (self.lines, self.region.uv_box);
        (1..m).flat_map(move |j| {
            (1..n).map(move |i| b.min + b.size() * DVec2::new(i as f64 / n as f64, j as f64 / m as f64))
        })
    }

    fn fill_uniformly(&self, face: &mut FaceMesh<'_, '_>, check: Check<'_>) -> Result<usize, MeshIssue> {
        let step = self.region.uv_box.size() / DVec2::new(self.lines[0] as f64, self.lines[1] as f64);
        let clear = |p: &DVec2| self.region.contains(*p) && self.region.nearest(*p, step, BESIDE).is_none();
        let points: Vec<DVec2> = self.grid().filter(clear).collect();
        face.foresee(points.iter().copied());
        let mut hint = 0;
        let mut count = 0;
        for p in points {
            if self.insert(face, p, &mut hint) {
                count += 1;
                if count % 256 == 0 {
                    check(count)?;
                }
            }
        }
        Ok(count)
    }

    /// Puts points into triangles that span more than their tolerance allows, until none does.
    fn restrict_by_size(&self, face: &mut FaceMesh<'_, '_>, check: Check<'_>) -> Result<usize, MeshIssue> {
        face.mesh_mut().changed.clear();
        let mut queue: Vec<u32> = (0..face.mesh().triangles.len() as u32).collect();
        let (mut count, mut steps) = (0, 0usize);
        let most = MOST_BY_SIZE * (self.lines[0] * self.lines[1] + face.chart().points.len());
        while let Some(t) = queue.pop() {
            if count == most {
                break;
            }
            steps += 1;
            if steps.is_multiple_of(256) {
                check(count)?;
            }
            let Some(found) = oversized(face, &self.region, t, self.allowed) else { continue };
            let mut hint = t;
            if self.insert(face, found.middle, &mut hint) {
                count += 1;
                queue.append(&mut face.mesh_mut().changed);
                let n = face.mesh().triangles.len() as u32;
                queue.extend(n.saturating_sub(2)..n);
            }
        }
        Ok(count)
    }

    /// Puts points into triangles that deviate, and into those that come of it, until none does.
    fn fill_adaptively(&mut self, face: &mut FaceMesh<'_, '_>, check: Check<'_>) -> Result<usize, MeshIssue> {
        let mut hint = 0;
        for p in std::mem::take(&mut self.points) {
            if self.insert(face, p, &mut hint) {
                self.points.push(p);
            }
        }
        face.mesh_mut().changed.clear();
        let mut queue: Vec<u32> = (0..face.mesh().triangles.len() as u32).collect();
        let mut steps = 0usize;
        while let Some(t) = queue.pop() {
            steps += 1;
            if steps.is_multiple_of(256) {
                check(self.points.len())?;
            }
            let Some(p) = self.too_far(face, t) else { continue };
            let mut hint = t;
            if self.insert(face, p, &mut hint) {
                self.points.push(p);
                queue.append(&mut face.mesh_mut().changed);
                queue.extend(
                    (face.mesh().triangles.len() as u32).saturating_sub(2)
                        ..face.mesh().triangles.len() as u32,
                );
            }
        }
        Ok(self.points.len())
    }

    /// Where a triangle deviates more than the tolerance at its middle: the place for a point.
    fn too_far(&self, face: &FaceMesh<'_, '_>, t: u32) -> Option<DVec2> {
        let c = face.mesh().triangles[t as usize];
        let [a, b, d] = c.map(|v| face.xyz(v));
        let n = (b - a).cross(d - a).try_normalize()?;
        let uv = face.mesh().corners(t);
        let middle = (uv[0] + uv[1] + uv[2]) / 3.0;
        let sides = [0, 1, 2].map(|i| uv[(i + 1) % 3].midpoint(uv[(i + 2) % 3]));
        let far = |p: DVec2| (face.surface().point(p) - a).dot(n).abs();
        let inner = |i: &usize| face.mesh().neighbors[t as usize][*i] != NONE;
        let deviation = sides
            .iter()
            .enumerate()
            .filter(|(i, _)| inner(i))
            .map(|(_, &p)| far(p))
            .fold(far(middle), f64::max);
        if deviation <= self.tolerance {
            return None;
        }
        let length = |i: usize| self.metric.length(uv[(i + 1) % 3] - uv[(i + 2) % 3]);
        let longest = (0..3).max_by(|&i, &j| length(i).total_cmp(&length(j)))?;
        Some(if inner(&longest) { sides[longest] } else { middle })
    }
}

impl FaceFiller for Delaunay {
    fn build(&mut self, face: &mut FaceMesh<'_, '_>, check: Check<'_>) -> Result<(), MeshIssue> {
        face.set_metric(self.metric);
        face.flip_all(&|_, _, _, _| true);
        let count = match self.fill {
            Fill::Uniform => {
                let count = self.fill_uniformly(face, check)?;
                let more = self.restrict_by_size(face, check)?;
                face.count("fill points by size", more);
                count
            }
            Fill::Adaptive => self.fill_adaptively(face, check)?,
        };
        face.mesh_mut().changed.clear();
        let opened = open_out(face);
        face.count("flips at poles", opened);
        let name = match self.fill {
            Fill::Uniform => "uniform fill points",
            Fill::Adaptive => "adaptive fill points",
        };
        face.count(name, count);
        face.count("Delaunay triangles", face.mesh().triangles.len());
        Ok(())
    }

    fn refine(&mut self, coarse: &[DVec2]) -> bool {
        match self.fill {
            Fill::Uniform => {
                self.refined += 1;
                self.allowed *= TIGHTER;
                self.refined <= MOST_REFINED
            }
            Fill::Adaptive => {
                self.points.extend_from_slice(coarse);
                true
            }
        }
    }

    fn cells(&self) -> Vec<UvBox> {
        Vec::new()
    }
}

/// As many lines as a uniform grid would have.
fn first_lines(surface: &FaceSurface<'_>, uv_box: UvBox, tolerance: f64) -> [usize; 2] {
    let Ok(root) = surface.surface.to_nurbs(uv_box) else { return [FIRST_LINES; 2] };
    let norms = SecondNorms::of_surface(&root);
    if !norms.error(1.0, 1.0).is_finite() {
        return [FIRST_LINES; 2];
    }
    let (n, m) = fewest(&norms.over(root.domain().size()), tolerance);
    [n, m]
}
