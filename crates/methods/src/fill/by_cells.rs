//! Methods that subdivide a face into cells, cut the cells with the loops and triangulate the polygons.

use super::cells::{Cells, Rule};
use super::chords::judge_chords;
use super::cut::cut;
use super::node::Measure;
use super::polygons::{Filling, retriangulate};
use super::region::Region;
use chordal_brep::MeshIssue;
use chordal_nurbs::{DVec2, UvBox};
use chordal_tessellate::method::{Check, FaceFiller, FaceMesh, FillTask, open_out};
use chordal_tessellate::{Stopwatch, Trace};

/// Cells cut with the loops.
pub struct ByCells {
    region: Region,
    cells: Cells,
    rule: Box<dyn Rule>,
    filling: Filling,
    tolerance: f64,
    measure: Measure,
    /// The rule may find chords of the edges too coarse.
    judges_chords: bool,
    /// How often all cells were halved at once.
    halvings: usize,
}

/// The transitions of the state machine that follows trimming curves over leaves, by their numbers.
const TRANSITIONS: [&str; 4] = [
    "curves reach a border (1)",
    "curves leave a vertex over a leaf (2)",
    "curves end inside a leaf (3)",
    "curves run along a border (4)",
];

/// Uniform subdivisions are halved at most this often. Each time costs four times the triangles, and what is
/// still too coarse then lies where loops cut cells, which smaller cells do not mend.
const HALVINGS: usize = 1;

impl ByCells {
    /// Cells that this rule cuts.
    ///
    /// # Errors
    /// Where the surface has no NURBS form.
    pub fn new(
        face: &FaceMesh<'_, '_>,
        task: FillTask,
        rule: Box<dyn Rule>,
        filling: Filling,
    ) -> Result<Self, MeshIssue> {
        let region = Region::new(face.chart());
        let tolerance = face.limits().tolerance;
        let mut cells = Cells::new(face.surface(), region.uv_box, tolerance)?;
        cells.begin(&*rule, &region, tolerance);
        let measure = Measure::of(task.bound);
        // Curves that are approximated in space are not judged in the plane.
        let judges_chords = !task.edges_in_space;
        Ok(Self { region, cells, rule, filling, tolerance, measure, judges_chords, halvings: 0 })
    }
}

impl FaceFiller for ByCells {
    fn build(&mut self, face: &mut FaceMesh<'_, '_>, check: Check<'_>) -> Result<(), MeshIssue> {
        let clock = Stopwatch::of_thread();
        self.cells.refine(&*self.rule, &self.region, self.tolerance, self.measure, check)?;
        face.phases_mut().subdivision += clock.seconds();
        let clock = Stopwatch::of_thread();
        let met = self.cells();
        let found = cut(face, &self.region, &met);
        let mut trace = Trace::default();
        retriangulate(face.mesh_mut(), &found.fixed, self.filling, &mut trace);
        trace.parts().for_each(|(part, count)| face.count(part, count));
        let opened = open_out(face);
        face.phases_mut().triangulation += clock.seconds();
        face.count(self.rule.name(), met.len());
        face.count("corners of cells", found.corners);
        face.count("borders cut by loops", found.crossings);
        face.count("borders given up", found.dropped);
        face.count("flips at poles", opened);
        Ok(())
    }

    fn refine(&mut self, coarse: &[DVec2]) -> bool {
        if self.rule.is_uniform() {
            self.halvings += 1;
            if self.halvings > HALVINGS {
                return false;
            }
        }
        self.cells.cut_at(coarse, &*self.rule, &self.region, self.measure)
    }

    fn coarse_chords(&self, face: &mut FaceMesh<'_, '_>) -> Vec<(u32, u32)> {
        if !self.judges_chords {
            return Vec::new();
        }
        let clock = Stopwatch::of_thread();
        let judged = judge_chords(face, &self.cells, &*self.rule);
        face.phases_mut().traversal += clock.seconds();
        for (name, count) in TRANSITIONS.iter().zip(judged.transitions) {
            face.count(name, count);
        }
        face.count("edges of leaves along curves", judged.directed);
        face.count("curves judged by samples", judged.lost);
        judged.coarse
    }

    fn cells(&self) -> Vec<UvBox> {
        self.cells.leaves.iter().filter(|l| l.met).map(|l| l.bounds).collect()
    }
}
