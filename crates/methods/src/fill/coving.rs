//! Coving: triangles between a boundary and the border of a region inside it, which is tessellated by itself.
//!
//! Source: the survey of the Blender wiki, "Tessellation Terminology", after Kumar and others 1997 and Piegl
//! and Tiller 1998: boundaries are often sampled by other rules than the inside (an error bound of their own,
//! or a neighbour that they are sewn to), so there must be a general way to join the two. Here it is a plane
//! sweep over the polygon between them: the loops of the face on the outside, the loops around the region as
//! holes. It sets no vertex.
//!
//! ```text
//!   ●────●──────●───●        ● the boundary's own samples
//!   │╲  ╱ ╲   ╱ ╲  ╱│        o the region's own corners
//!   │ o────o────o──o│        ╱ coving triangles
//! ```
//!
//! In this method, the region consists of the cells of a uniform grid that keep clear of the loops. If a
//! triangle of the strip spans too much ([`super::size`]), no cell had room there: the grid gets twice as
//! many lines across, until one has.

use super::bezier::{fan, halves};
use super::borders::Borders;
use super::cells::Cells;
use super::grid::UniformGrid;
use super::node::Measure;
use super::plain::mean_metric;
use super::region::Region;
use super::size::oversized;
use chordal_brep::MeshIssue;
use chordal_nurbs::{DVec2, UvBox};
use chordal_tessellate::method::{Check, FaceFiller, FaceMesh, open_out, sweep};
use rustc_hash::FxHashSet;
use std::collections::{BTreeMap, BTreeSet};

/// Cells nearer to a loop than this share of their size are left out: triangles between them and the loop
/// would be slivers.
const CLEAR: f64 = 0.25;

/// Triangles of the strip between loops (each a range of `points`, the face on their left) and the borders of
/// a region (closed chains of indices into `points`, the region on their left).
///
/// # Errors
/// Where the loops, or the borders, cross each other or themselves.
pub fn cove(
    points: &[DVec2],
    loops: &[(u32, u32)],
    borders: &[Vec<u32>],
) -> Result<Vec<[u32; 3]>, &'static str> {
    let outer = loops.last().map_or(0, |&(_, end)| end);
    let mut own: Vec<u32> = (0..outer).collect();
    let mut ranges = loops.to_vec();
    for border in borders {
        let start = own.len() as u32;
        // The strip is on the other side of the region's border.
        own.extend(border.iter().rev());
        ranges.push((start, own.len() as u32));
    }
    let local: Vec<DVec2> = own.iter().map(|&v| points[v as usize]).collect();
    let triangles = sweep(&local, &ranges).map_err(|_| "the boundary and the region cross")?;
    Ok(triangles.into_iter().map(|t| t.map(|v| own[v as usize])).collect())
}

/// A uniform grid inside, coved to the loops.
pub struct Coving {
    region: Region,
    cells: Cells,
    tolerance: f64,
    measure: Measure,
    grid: UniformGrid,
    halvings: usize,
}

/// All cells are halved at most this often.
const HALVINGS: usize = 2;

/// How often a grid that has no cell clear of the loops gets twice as many lines in one direction.
const DOUBLINGS: usize = 4;

/// A grid is not refined beyond this many cells to find cells clear of the loops.
const MOST_CELLS: usize = 40_000;

impl Coving {
    /// # Errors
    /// Where the surface has no NURBS form.
    pub fn new(face: &FaceMesh<'_, '_>, measure: Measure) -> Result<Self, MeshIssue> {
        let region = Region::new(face.chart());
        let tolerance = face.limits().tolerance;
        let mut cells = Cells::new(face.surface(), region.uv_box, tolerance)?;
        let grid = UniformGrid::COARSEST;
        cells.begin(&grid, &region, tolerance);
        Ok(Self { region, cells, tolerance, measure, grid, halvings: 0 })
    }

    /// Triangles that span too much, and the direction in which the first of them does.
    fn too_wide(&self, face: &FaceMesh<'_, '_>) -> (usize, usize) {
        let triangles = 0..face.mesh().triangles.len() as u32;
        let mut found = triangles.filter_map(|t| oversized(face, &self.region, t, self.tolerance));
        found.next().map_or((0, 0), |first| (1 + found.count(), first.axis))
    }

    /// Makes the grid, with the number of lines multiplied.
    ///
    /// # Errors
    /// Where the surface has no NURBS form.
    fn regrid(&mut self, face: &FaceMesh<'_, '_>, finer: [usize; 2]) -> Result<(), MeshIssue> {
        self.grid = UniformGrid { finer };
        self.cells = Cells::new(face.surface(), self.region.uv_box, self.tolerance)?;
        self.cells.begin(&self.grid, &self.region, self.tolerance);
        Ok(())
    }

    /// The cells, the strip between them and the loops; false where the loops cross.
    fn lay(&self, face: &mut FaceMesh<'_, '_>) -> bool {
        let metric = mean_metric(face.surface(), self.region.uv_box);
        face.set_metric(metric);
        let inner = self.inner();
        let borders = Borders::new(&inner);
        let first = face.chart().points.len() as u32;
        let rings: Vec<Vec<u32>> = rings(&borders, &inner)
            .into_iter()
            .map(|ring| ring.into_iter().map(|i| i + first).collect())
            .collect();
        let edges = border_edges(&rings);
        let mut points = face.mesh().points.clone();
        points.extend_from_slice(&borders.corners);
        let Ok(strip) = cove(&points, &face.chart().loops, &chains(&edges)) else { return false };
        for &p in &borders.corners {
            face.add_point(p, metric);
        }
        let mut triangles = strip.clone();
        for (ring, cell) in rings.iter().zip(&inner) {
            if let [a, b, c, d] = ring[..] {
                triangles.extend(halves(face.surface_points(), [a, b, c, d]));
            } else {
                let middle = face.add_point(cell.center(), metric);
                triangles.extend(fan(middle, ring));
            }
        }
        face.set_triangles(triangles);
        let fixed: FxHashSet<(u32, u32)> = edges.iter().map(|&(a, b)| (a.min(b), a.max(b))).collect();
        face.flip_all(&|_, a, b, _| !fixed.contains(&(a.min(b), a.max(b))));
        face.mesh_mut().changed.clear();
        face.count("cells clear of the loops", inner.len());
        face.count("coving triangles", strip.len());
        true
    }

    /// Cells that keep clear of the loops.
    fn inner(&self) -> Vec<UvBox> {
        let clear = |b: &UvBox| {
            let around = b.inflated(b.size() * CLEAR);
            self.region.contains(b.center()) && !self.region.is_crossed(around)
        };
        let mut inner: Vec<UvBox> = self.cells.leaves.iter().map(|l| l.bounds).filter(clear).collect();
        // Where two cells share a corner only, the border would touch itself there.
        loop {
            let loose = pinched(&inner);
            if loose.is_empty() {
                return inner;
            }
            let mut index = 0;
            inner.retain(|_| {
                index += 1;
                !loose.contains(&(index - 1))
            });
        }
    }
}

/// The coarsest grid that leaves about as few triangles too wide as any other. Twice the cells for a tenth
/// less would not pay.
fn best_grid(tried: &[(usize, [usize; 2])]) -> [usize; 2] {
    let least = tried.iter().map(|t| t.0).min().unwrap_or(0);
    let enough = least + tried.first().map_or(0, |t| t.0.saturating_sub(least) / 5);
    tried.iter().find(|t| t.0 <= enough).map_or([1, 1], |t| t.1)
}

/// A cell at every corner through which the border of all cells runs twice.
fn pinched(cells: &[UvBox]) -> BTreeSet<usize> {
    let mut starts: BTreeMap<u32, usize> = BTreeMap::new();
    let borders = Borders::new(cells);
    for (a, _) in border_edges(&rings(&borders, cells)) {
        *starts.entry(a).or_default() += 1;
    }
    let twice = starts.iter().filter(|(_, count)| **count > 1).map(|(&c, _)| borders.corners[c as usize]);
    twice.filter_map(|p| cells.iter().rposition(|b| b.contains(p))).collect()
}

fn rings(borders: &Borders, cells: &[UvBox]) -> Vec<Vec<u32>> {
    cells.iter().map(|&cell| borders.ring(cell)).collect()
}

/// Directed sides of rings that no other ring runs back along, sorted.
fn border_edges(rings: &[Vec<u32>]) -> Vec<(u32, u32)> {
    let sides = |ring: &Vec<u32>| {
        let n = ring.len();
        (0..n).map(|i| (ring[i], ring[(i + 1) % n])).collect::<Vec<_>>()
    };
    let mut all: Vec<(u32, u32)> = rings.iter().flat_map(sides).collect();
    all.sort_unstable();
    let back = |&(a, b): &(u32, u32)| all.binary_search(&(b, a)).is_err();
    all.iter().copied().filter(back).collect()
}

/// Closed chains of border edges, each corner at most once in all of them.
fn chains(edges: &[(u32, u32)]) -> Vec<Vec<u32>> {
    let mut next: BTreeMap<u32, u32> = edges.iter().copied().collect();
    let mut found = Vec::new();
    while let Some((&start, _)) = next.iter().next() {
        let mut chain = Vec::new();
        let mut at = start;
        while let Some(to) = next.remove(&at) {
            chain.push(at);
            at = to;
        }
        found.push(chain);
    }
    found
}

impl FaceFiller for Coving {
    fn build(&mut self, face: &mut FaceMesh<'_, '_>, check: Check<'_>) -> Result<(), MeshIssue> {
        self.cells.refine(&self.grid, &self.region, self.tolerance, self.measure, check)?;
        let boundary = face.mesh().clone();
        let trace = face.trace().clone();
        // The grids that were tried, each with the number of triangles that are too wide.
        let mut tried: Vec<(usize, [usize; 2])> = Vec::new();
        loop {
            if !self.lay(face) {
                // Loops that cross themselves: their triangles are there already.
                face.count("faces that could not be coved", 1);
                return Ok(());
            }
            check(face.mesh().triangles.len())?;
            let (count, axis) = if self.halvings > 0 { (0, 0) } else { self.too_wide(face) };
            tried.push((count, self.grid.finer));
            let has_room = tried.len() <= DOUBLINGS && 2 * self.cells.leaves.len() <= MOST_CELLS;
            if count == 0 || !has_room {
                break;
            }
            let mut finer = self.grid.finer;
            finer[1 - axis] *= 2;
            face.restore(&boundary);
            face.set_trace(trace.clone());
            self.regrid(face, finer)?;
        }
        let best = best_grid(&tried);
        if best != self.grid.finer {
            face.restore(&boundary);
            face.set_trace(trace);
            self.regrid(face, best)?;
            self.lay(face);
        }
        if best != [1, 1] {
            face.count("grids made finer for want of room", 1);
        }
        let opened = open_out(face);
        face.count("flips at poles", opened);
        Ok(())
    }

    fn refine(&mut self, coarse: &[DVec2]) -> bool {
        self.halvings += 1;
        self.halvings <= HALVINGS && self.cells.cut_at(coarse, &self.grid, &self.region, self.measure)
    }

    fn cells(&self) -> Vec<UvBox> {
        self.inner()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use chordal_nurbs::math;
    use chordal_tessellate::method::orient;

    fn ring(n: u32, radius: f64, phase: f64) -> Vec<DVec2> {
        (0..n)
            .map(|i| math::direction(std::f64::consts::TAU * f64::from(i) / f64::from(n) + phase) * radius)
            .collect()
    }

    fn area(points: &[DVec2], triangles: &[[u32; 3]]) -> f64 {
        let one = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|v| points[v as usize]);
            assert!(orient(a, b, c) > 0.0);
            0.5 * (b - a).perp_dot(c - a)
        };
        triangles.iter().map(one).sum()
    }

    /// A regular polygon's area.
    fn regular(n: u32, radius: f64) -> f64 {
        0.5 * f64::from(n) * radius * radius * math::sin(std::f64::consts::TAU / f64::from(n))
    }

    #[test]
    fn a_fine_boundary_is_joined_to_a_coarse_region() {
        // 100 samples around, 8 inside: n + m triangles, none in the region, none of the strip left out.
        let mut points = ring(100, 2.0, 0.1);
        points.extend(ring(8, 1.0, 0.0));
        let strip = cove(&points, &[(0, 100)], &[(100..108).collect()]).expect("they do not cross");
        assert_eq!(strip.len(), 108);
        assert!((area(&points, &strip) - regular(100, 2.0) + regular(8, 1.0)).abs() < 1e-12);
        for t in &strip {
            let outer = t.iter().filter(|&&v| v < 100).count();
            assert!(outer > 0, "{t:?} lies in the region");
        }
    }

    #[test]
    fn a_finer_grid_must_be_worth_it() {
        assert_eq!(best_grid(&[(0, [1, 1])]), [1, 1]);
        assert_eq!(best_grid(&[(10, [1, 1]), (10, [1, 2]), (0, [1, 4])]), [1, 4]);
        assert_eq!(best_grid(&[(10, [1, 1]), (1, [1, 2]), (0, [1, 4])]), [1, 2]);
        assert_eq!(best_grid(&[(10, [1, 1]), (12, [1, 2]), (15, [1, 4])]), [1, 1]);
    }

    #[test]
    fn two_regions_and_a_hole() {
        // A face with a hole, and two regions beside it.
        let shift = |ring: Vec<DVec2>, x: f64| ring.into_iter().map(move |p| p + DVec2::new(x, 0.0));
        let mut points = ring(40, 4.0, 0.0);
        points.extend(ring(12, 0.5, 0.0).into_iter().rev());
        points.extend(shift(ring(6, 1.0, 0.0), 2.0));
        points.extend(shift(ring(5, 1.0, 0.0), -2.0));
        let borders = [(52..58).collect(), (58..63).collect()];
        let strip = cove(&points, &[(0, 40), (40, 52)], &borders).expect("they do not cross");
        let expected = regular(40, 4.0) - regular(12, 0.5) - regular(6, 1.0) - regular(5, 1.0);
        assert!((area(&points, &strip) - expected).abs() < 1e-12);
        // n corners and h holes: n + 2h − 2.
        assert_eq!(strip.len(), 63 + 2 * 3 - 2);
    }

    #[test]
    fn a_region_that_crosses_the_boundary_is_refused() {
        let mut points = ring(10, 1.0, 0.0);
        points.extend(ring(10, 1.0, 0.3).into_iter().map(|p| p + DVec2::X * 0.5));
        assert!(cove(&points, &[(0, 10)], &[(10..20).collect()]).is_err());
    }

    #[test]
    fn borders_of_cells_are_chains_that_touch_nowhere() {
        let cell = |i: u32, j: u32| {
            let low = DVec2::new(f64::from(i), f64::from(j));
            UvBox::new(low, low + 1.0)
        };
        // Three in a row, and one diagonal to the last: that corner is a pinch.
        let mut cells = vec![cell(0, 0), cell(1, 0), cell(2, 0), cell(3, 1)];
        assert_eq!(pinched(&cells), BTreeSet::from([3]));
        cells.pop();
        assert!(pinched(&cells).is_empty());
        let borders = Borders::new(&cells);
        let found = chains(&border_edges(&rings(&borders, &cells)));
        assert_eq!(found.iter().map(Vec::len).collect::<Vec<_>>(), [8]);
        // A ring of eight cells has a border outside and one inside.
        let around: Vec<UvBox> = (0..9).filter(|k| *k != 4).map(|k| cell(k % 3, k / 3)).collect();
        let borders = Borders::new(&around);
        assert_eq!(chains(&border_edges(&rings(&borders, &around))).len(), 2);
    }
}
