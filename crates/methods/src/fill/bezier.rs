//! Bézier patches as quadrilaterals.
//!
//! Source: Ma and Hewitt 2002, sections 4.1 to 4.5:
//!
//! 1. The surface is split by knot refinement to the box of the outer loop, then into Bézier patches,
//!    recursively until their nets are flat ([`super::projected`]).
//! 2. Scanlines and quadtrees of the loops tell patches inside, outside and cut apart ([`super::scanlines`]).
//! 3. Patches inside are quadrilaterals. Those with points of smaller neighbours in their sides become
//!    triangles (its Figure 5): three with one such point, n + 4 around a point in the middle with n of them.
//! 4. What lies between these patches and the loops is closed with triangles, all of one orientation
//!    ([`super::cut`]).
//!
//! ```text
//!   o─────o    o──+──o    o─────o     o corners
//!   │     │    │ ╱ ╲ │    │╲   ╱│     + points of smaller neighbours
//!   │     │    │╱   ╲│    + ╳ ╳ +     the middle is a point of the surface
//!   o─────o    o─────o    o──+──o
//! ```

use super::borders::Borders;
use super::cells::{Cells, Rule};
use super::cut::cut;
use super::node::Measure;
use super::plain::mean_metric;
use super::polygons::{outline, polygons};
use super::projected::ProjectedNet;
use super::region::Region;
use super::scanlines::{Place, Scanlines, lines_for};
use chordal_brep::MeshIssue;
use chordal_nurbs::{DVec2, DVec3, UvBox};
use chordal_tessellate::Stopwatch;
use chordal_tessellate::method::{Check, FaceFiller, FaceMesh, open_out};
use rustc_hash::FxHashSet;

/// Bézier patches of one face.
pub struct BezierQuads {
    region: Region,
    cells: Cells,
    lines: Scanlines,
    tolerance: f64,
    measure: Measure,
    /// Patches outside of the face, found so far.
    removed: usize,
}

impl BezierQuads {
    /// # Errors
    /// Where the surface has no NURBS form.
    pub fn new(face: &FaceMesh<'_, '_>, measure: Measure) -> Result<Self, MeshIssue> {
        let region = Region::new(face.chart());
        let tolerance = face.limits().tolerance;
        let mut cells = Cells::new(face.surface(), region.uv_box, tolerance)?;
        cells.begin(&ProjectedNet, &region, tolerance);
        let polygons: Vec<Vec<DVec2>> = face
            .chart()
            .loops
            .iter()
            .map(|&(start, end)| (start..end).map(|i| face.chart().points[i as usize].uv).collect())
            .collect();
        let lines = Scanlines::new(&polygons, lines_for(height(face, region.uv_box), tolerance));
        Ok(Self { region, cells, lines, tolerance, measure, removed: 0 })
    }

    /// The patches that belong to the face, and which of them no loop crosses.
    fn kept(&mut self) -> (Vec<UvBox>, Vec<bool>) {
        let (mut kept, mut inside) = (Vec::new(), Vec::new());
        self.removed = 0;
        for leaf in &self.cells.leaves {
            // Most patches outside were never subdivided.
            match if leaf.met { self.lines.place(leaf.bounds) } else { Place::Outside } {
                Place::Outside => self.removed += 1,
                place => {
                    kept.push(leaf.bounds);
                    inside.push(place == Place::Inside);
                }
            }
        }
        (kept, inside)
    }
}

/// The length of the middle line of constant u over the box.
fn height(face: &FaceMesh<'_, '_>, b: UvBox) -> f64 {
    const STEPS: usize = 16;
    let at = |i: usize| {
        let v = b.min.y + b.size().y * i as f64 / STEPS as f64;
        face.surface().point(DVec2::new(b.center().x, v))
    };
    (0..STEPS).map(|i| at(i).distance(at(i + 1))).sum()
}

impl FaceFiller for BezierQuads {
    fn build(&mut self, face: &mut FaceMesh<'_, '_>, check: Check<'_>) -> Result<(), MeshIssue> {
        let clock = Stopwatch::of_thread();
        self.cells.refine(&ProjectedNet, &self.region, self.tolerance, self.measure, check)?;
        face.phases_mut().subdivision += clock.seconds();
        let clock = Stopwatch::of_thread();
        let (kept, inside) = self.kept();
        let found = cut(face, &self.region, &kept);
        let borders = Borders::new(&kept);
        let whole: Vec<UvBox> =
            kept.iter().zip(&inside).filter(|(_, inside)| **inside).map(|(b, _)| *b).collect();
        let closed = close(face, &found.fixed, &whole);
        let opened = open_out(face);
        face.phases_mut().triangulation += clock.seconds();
        face.count(ProjectedNet.name(), kept.len());
        face.count("scanlines", self.lines.count());
        face.count("tangent points repeated", self.lines.tangent);
        face.count("patches removed", self.removed);
        face.count("patches inside the loops", whole.len());
        face.count("corners of cells", borders.corners.len());
        face.count("borders cut by loops", found.crossings);
        face.count("borders given up", found.dropped);
        face.count("quadrilaterals", closed.quads);
        face.count("patches with points in their sides", closed.with_points);
        face.count("polygons closed with triangles", closed.triangulated);
        face.count("flips at poles", opened);
        Ok(())
    }

    fn refine(&mut self, coarse: &[DVec2]) -> bool {
        self.cells.cut_at(coarse, &ProjectedNet, &self.region, self.measure)
    }

    fn cells(&self) -> Vec<UvBox> {
        self.cells.leaves.iter().filter(|l| l.met).map(|l| l.bounds).collect()
    }
}

/// How patches were triangulated.
#[derive(Clone, Copy, Debug, Default)]
struct Closed {
    quads: usize,
    with_points: usize,
    triangulated: usize,
}

/// Makes the triangles of every polygon between fixed edges: of patches inside by Figure 5, of all others as
/// they are.
fn close(face: &mut FaceMesh<'_, '_>, fixed: &FxHashSet<(u32, u32)>, whole: &[UvBox]) -> Closed {
    let metric = mean_metric(face.surface(), UvBox::from_points(face.mesh().points.iter().copied()));
    let by_corner = by_corner(whole);
    let mut closed = Closed::default();
    let mut triangles = Vec::with_capacity(face.mesh().triangles.len());
    face.clear_quads();
    for polygon in polygons(face.mesh(), fixed) {
        let patch = outline(face.mesh(), &polygon)
            .filter(|loops| loops.len() == 1)
            .and_then(|mut loops| loops.pop())
            .and_then(|ring| patch_of(&face.mesh().points, &ring, &by_corner).map(|b| (ring, b)));
        match patch {
            Some((ring, _)) if ring.len() == 4 => {
                let quad = [ring[0], ring[1], ring[2], ring[3]];
                triangles.extend(halves(face.surface_points(), quad));
                face.add_quad(quad);
                closed.quads += 1;
            }
            Some((ring, b)) => {
                closed.with_points += 1;
                let corners = ring.iter().position(|&v| !is_corner(face.mesh().points[v as usize], b));
                let apex = match (ring.len(), corners) {
                    (5, Some(i)) => ring[i],
                    _ => face.add_point(b.center(), metric),
                };
                triangles.extend(fan(apex, &ring));
            }
            None => {
                closed.triangulated += 1;
                triangles.extend(polygon.iter().map(|&t| face.mesh().triangles[t as usize]));
            }
        }
    }
    face.set_triangles(triangles);
    closed
}

/// Patches sorted by their lower left corners.
fn by_corner(whole: &[UvBox]) -> Vec<UvBox> {
    let mut sorted = whole.to_vec();
    sorted.sort_unstable_by(|a, b| corner_order(a.min, b.min));
    sorted
}

fn corner_order(a: DVec2, b: DVec2) -> std::cmp::Ordering {
    a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y))
}

fn is_corner(p: DVec2, b: UvBox) -> bool {
    (p.x == b.min.x || p.x == b.max.x) && (p.y == b.min.y || p.y == b.max.y)
}

/// The patch that a ring of vertices runs around, all of its own corners included.
fn patch_of(points: &[DVec2], ring: &[u32], sorted: &[UvBox]) -> Option<UvBox> {
    let bounds = UvBox::from_points(ring.iter().map(|&v| points[v as usize]));
    let at = sorted.binary_search_by(|b| corner_order(b.min, bounds.min)).ok()?;
    let on_border =
        |p: DVec2| p.x == bounds.min.x || p.x == bounds.max.x || p.y == bounds.min.y || p.y == bounds.max.y;
    let corners = ring.iter().filter(|&&v| is_corner(points[v as usize], bounds)).count();
    let all_on = ring.iter().all(|&v| on_border(points[v as usize]));
    (sorted[at] == bounds && corners == 4 && all_on).then_some(bounds)
}

/// The halves of a quadrilateral, on both sides of its shorter diagonal in space.
pub fn halves(xyz: &[DVec3], [a, b, c, d]: [u32; 4]) -> [[u32; 3]; 2] {
    let length = |a: u32, b: u32| xyz[a as usize].distance_squared(xyz[b as usize]);
    // Where the lengths differ by rounding only, the first.
    if length(b, d) < length(a, c) * (1.0 - 1e-9) { [[a, b, d], [b, c, d]] } else { [[a, b, c], [a, c, d]] }
}

/// Triangles from `apex` to every side of the ring that it is not an end of.
pub fn fan(apex: u32, ring: &[u32]) -> impl Iterator<Item = [u32; 3]> + '_ {
    let n = ring.len();
    let side = move |i: usize| [apex, ring[i], ring[(i + 1) % n]];
    (0..n).map(side).filter(|[apex, a, b]| a != apex && b != apex)
}

#[cfg(test)]
mod tests {
    use super::*;
    use chordal_tessellate::method::orient;

    fn area(points: &[DVec2], triangles: &[[u32; 3]]) -> f64 {
        triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|v| points[v as usize]);
                assert!(orient(a, b, c) > 0.0, "{t:?}");
                0.5 * (b - a).perp_dot(c - a)
            })
            .sum()
    }

    #[test]
    fn figure_five() {
        // The unit square with 0, 1, 2, 3 and 4 points in its sides, and a middle.
        let corners = [(0., 0.), (1., 0.), (1., 1.), (0., 1.)].map(DVec2::from);
        let middles = [(0.5, 0.), (1., 0.5), (0.5, 1.), (0., 0.5)].map(DVec2::from);
        for n in 1..=4 {
            let mut points = Vec::new();
            for i in 0..4 {
                points.push(corners[i]);
                if i < n {
                    points.push(middles[i]);
                }
            }
            let ring: Vec<u32> = (0..points.len() as u32).collect();
            let b = UvBox::new(DVec2::ZERO, DVec2::ONE);
            assert_eq!(patch_of(&points, &ring, &[b]), Some(b));
            points.push(DVec2::splat(0.5));
            let apex = if n == 1 { 1 } else { ring.len() as u32 };
            let triangles: Vec<[u32; 3]> = fan(apex, &ring).collect();
            assert_eq!(triangles.len(), if n == 1 { 3 } else { n + 4 }, "{n} points");
            assert!((area(&points, &triangles) - 1.0).abs() < 1e-15);
        }
    }

    #[test]
    fn a_ring_that_is_no_patch_is_none() {
        let b = UvBox::new(DVec2::ZERO, DVec2::ONE);
        let points = [(0., 0.), (1., 0.), (1., 1.), (0.1, 0.9)].map(DVec2::from);
        assert_eq!(patch_of(&points, &[0, 1, 2, 3], &[b]), None, "a corner gave way to a chord");
        let points = [(0., 0.), (1., 0.), (1., 2.), (0., 2.)].map(DVec2::from);
        assert_eq!(patch_of(&points, &[0, 1, 2, 3], &[b]), None, "another patch");
    }
}
