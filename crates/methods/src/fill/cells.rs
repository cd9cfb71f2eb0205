//! The tree of cells over the box of a face's loops, for any rule that cuts them.
//!
//! Cells are defined in the parameters of the surface's NURBS form, their corners also in those of the chart.
//! The two differ by a monotone map in each direction, so lines of constant parameter correspond. A closed
//! spline surface is cut at its seam first. Cells outside of the face are not cut.

use super::node::Measure;
use super::region::Region;
use chordal_brep::MeshIssue;
use chordal_nurbs::{BezierPatch, DVec2, NurbsParameters, NurbsSurface, ParameterMap, Surface, UvBox};
use chordal_tessellate::method::{Check, FaceSurface};

/// A cut of a cell: across u (axis 0) or v at this NURBS parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Split {
    pub axis: usize,
    pub at: f64,
}

/// A method of subdivision.
pub trait Rule: Send {
    /// The name in the trace.
    fn name(&self) -> &'static str;
    /// The cuts that every root gets first, at any error.
    fn first_cuts(&self, _root: &NurbsSurface, _tolerance: f64) -> Vec<Split> {
        Vec::new()
    }
    /// The cuts of a cell that is too coarse for `tolerance`; none where it is fine enough.
    fn cuts(&self, piece: &NurbsSurface, tolerance: f64, measure: Measure) -> Vec<Split>;
    /// The cuts of a cell that the proof found too coarse.
    fn forced(&self, piece: &NurbsSurface, measure: Measure) -> Vec<Split> {
        self.cuts(piece, 0.0, measure)
    }
    /// How far a trimming curve over this cell may lie from its chord, in the cell's own parameters from 0 to
    /// 1; `None` where the method does not judge chords.
    fn chord_share(&self, _piece: &NurbsSurface, _tolerance: f64) -> Option<f64> {
        None
    }
    /// True where all cells are cut as soon as one is too coarse.
    fn is_uniform(&self) -> bool {
        false
    }
}

/// One cell.
#[derive(Clone, Debug)]
pub struct Cell {
    /// In the chart's parameters.
    pub bounds: UvBox,
    pub piece: NurbsSurface,
    /// Index of the root's parameter maps.
    map: usize,
    pub depth: u32,
    /// The face meets it.
    pub met: bool,
    /// No rule cuts it again.
    finished: bool,
}

/// The cells of one face.
pub struct Cells {
    pub leaves: Vec<Cell>,
    /// Of each root.
    maps: Vec<NurbsParameters>,
    /// The NURBS parameters of each root.
    roots: Vec<UvBox>,
}

/// Most cuts of one cell; more would make parameters that doubles cannot tell apart.
const DEEPEST: u32 = 60;

/// Cuts lie at multiples of a root's extent over this number, so that both sides of a border get the same
/// corner.
const STEPS: f64 = (1u32 << 24) as f64;

/// Cells narrower than this share of the face's box are not cut: their corners would be one.
const NARROWEST: f64 = 1e-6;

/// The share of the tolerance that surfaces without an exact NURBS form may differ from the one that is
/// subdivided. The proof is about the surface itself, so this only decides where cells end.
const FORM_SHARE: f64 = 0.1;

impl Cells {
    /// One cell per turn of a closed spline surface, else one.
    ///
    /// # Errors
    /// Where the surface has no NURBS form.
    pub fn new(surface: &FaceSurface<'_>, uv_box: UvBox, tolerance: f64) -> Result<Self, MeshIssue> {
        let mut cells = Self { leaves: Vec::new(), maps: Vec::new(), roots: Vec::new() };
        let [us, vs] = [0, 1].map(|axis| root_breaks(surface, uv_box, axis));
        for u in us.windows(2) {
            for v in vs.windows(2) {
                let bounds = UvBox::new(DVec2::new(u[0], v[0]), DVec2::new(u[1], v[1]));
                let (piece, map) = nurbs_form(surface.surface, bounds, tolerance)?;
                let map_index = cells.maps.len();
                cells.maps.push(map);
                cells.roots.push(piece.domain());
                cells.leaves.push(Cell {
                    bounds,
                    piece,
                    map: map_index,
                    depth: 0,
                    met: true,
                    finished: false,
                });
            }
        }
        Ok(cells)
    }

    /// Makes the first cuts of every root.
    pub fn begin(&mut self, rule: &dyn Rule, region: &Region, tolerance: f64) {
        for i in 0..self.leaves.len() {
            let cuts = rule.first_cuts(&self.leaves[i].piece, tolerance);
            self.cut(i, &cuts, region);
        }
    }

    /// Cuts all cells that the face meets until the rule has no cut for any of them.
    ///
    /// # Errors
    /// An error of `check`, which is called regularly.
    pub fn refine(
        &mut self,
        rule: &dyn Rule,
        region: &Region,
        tolerance: f64,
        measure: Measure,
        check: Check<'_>,
    ) -> Result<(), MeshIssue> {
        let (mut i, mut steps) = (0, 0usize);
        while i < self.leaves.len() {
            steps += 1;
            if steps.is_multiple_of(256) {
                check(self.leaves.len())?;
            }
            let leaf = &self.leaves[i];
            let cuts = if leaf.met && !leaf.finished {
                rule.cuts(&leaf.piece, tolerance, measure)
            } else {
                Vec::new()
            };
            let cuts: Vec<Split> = cuts.into_iter().map(|c| self.rounded(leaf.map, c)).collect();
            if !self.cut(i, &cuts, region) {
                self.leaves[i].finished = true;
                i += 1;
            }
        }
        Ok(())
    }

    /// Cuts the leaves at these points of the chart even if the rule has no cut; true where any could be cut.
    pub fn cut_at(&mut self, points: &[DVec2], rule: &dyn Rule, region: &Region, measure: Measure) -> bool {
        let leaves: Vec<usize> = if rule.is_uniform() {
            (0..self.leaves.len()).filter(|&i| self.leaves[i].met).collect()
        } else {
            self.leaves_at(points)
        };
        let mut any = false;
        for i in leaves {
            let leaf = &self.leaves[i];
            let cuts = rule.forced(&leaf.piece, measure);
            let cuts: Vec<Split> = cuts.into_iter().map(|c| self.rounded(leaf.map, c)).collect();
            any |= self.cut(i, &cuts, region);
        }
        any
    }

    /// The leaf that holds each of these points of the chart.
    pub fn leaf_of_each(&self, points: &[DVec2]) -> Vec<Option<usize>> {
        let mut order: Vec<usize> = (0..points.len()).collect();
        order.sort_unstable_by(|&a, &b| points[a].x.total_cmp(&points[b].x).then(a.cmp(&b)));
        let mut found = vec![None; points.len()];
        for (i, leaf) in self.leaves.iter().enumerate().filter(|(_, leaf)| leaf.met) {
            let b = leaf.bounds;
            let from = order.partition_point(|&k| points[k].x < b.min.x);
            let to = order.partition_point(|&k| points[k].x <= b.max.x);
            for &k in order[from..to].iter().filter(|&&k| b.contains(points[k])) {
                found[k] = Some(i);
            }
        }
        found
    }

    /// The leaves that hold points of the chart, each once, in their order.
    fn leaves_at(&self, points: &[DVec2]) -> Vec<usize> {
        let mut order: Vec<DVec2> = points.to_vec();
        order.sort_unstable_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
        let holds = |bounds: &UvBox| {
            let from = order.partition_point(|p| p.x < bounds.min.x);
            let to = order.partition_point(|p| p.x <= bounds.max.x);
            order[from..to].iter().any(|&p| bounds.contains(p))
        };
        (0..self.leaves.len()).filter(|&i| self.leaves[i].met && holds(&self.leaves[i].bounds)).collect()
    }

    /// Replaces a leaf by its parts: the first in its place, the others at the end. False where it cannot be
    /// cut.
    fn cut(&mut self, index: usize, cuts: &[Split], region: &Region) -> bool {
        if cuts.is_empty() || self.leaves[index].depth >= DEEPEST {
            return false;
        }
        let whole = region.uv_box.size() * NARROWEST;
        let mut parts = self.parts(self.leaves[index].clone(), cuts, whole);
        if parts.len() == 1 {
            return false;
        }
        for part in &mut parts {
            part.met = region.meets(part.bounds);
        }
        self.leaves.splice(index..=index, parts.drain(..1));
        self.leaves.append(&mut parts);
        true
    }

    /// The parts of a cell after a sequence of cuts, in order. Each part keeps only the cuts that may still
    /// meet it, since hundreds of cuts make tens of thousands of parts.
    fn parts(&self, cell: Cell, cuts: &[Split], narrowest: DVec2) -> Vec<Cell> {
        let mut parts = Vec::new();
        let mut open = vec![(cell, cuts.to_vec())];
        while let Some((part, cuts)) = open.pop() {
            let split = |(k, cut): (usize, &Split)| Some((k, self.halves(&part, *cut, narrowest)?));
            let Some((k, (low, high))) = cuts.iter().enumerate().find_map(split) else {
                parts.push(part);
                continue;
            };
            let within = |part: &Cell| {
                let own = part.piece.domain();
                let meets = |c: &&Split| c.at > own.min[c.axis] && c.at < own.max[c.axis];
                cuts[k + 1..].iter().filter(meets).copied().collect()
            };
            let (of_low, of_high) = (within(&low), within(&high));
            open.extend([(high, of_high), (low, of_low)]);
        }
        parts
    }

    /// The same cut at the nearest step of the root.
    fn rounded(&self, root: usize, cut: Split) -> Split {
        let (low, size) = (self.roots[root].min[cut.axis], self.roots[root].size()[cut.axis]);
        Split { at: low + size * (((cut.at - low) / size * STEPS).round() / STEPS), ..cut }
    }

    fn halves(&self, cell: &Cell, cut: Split, narrowest: DVec2) -> Option<(Cell, Cell)> {
        let axis = cut.axis;
        let own = cell.piece.domain();
        if !(cut.at > own.min[axis] && cut.at < own.max[axis]) {
            return None;
        }
        let map = &self.maps[cell.map];
        let map = if axis == 0 { &map.u } else { &map.v };
        let at = map.native_from_nurbs(cut.at);
        let room = (at - cell.bounds.min[axis]).min(cell.bounds.max[axis] - at);
        if !(room > narrowest[axis]) {
            return None;
        }
        let (low, high) = split(&cell.piece, axis, cut.at)?;
        let part = |piece: NurbsSurface, is_low: bool| {
            let mut bounds = cell.bounds;
            if is_low {
                bounds.max[axis] = at;
            } else {
                bounds.min[axis] = at;
            }
            Cell { bounds, piece, map: cell.map, depth: cell.depth + 1, met: true, finished: false }
        };
        Some((part(low, true), part(high, false)))
    }
}

/// The two parts of a piece; one that is a single Bézier patch is halved as such, which costs a fraction.
fn split(piece: &NurbsSurface, axis: usize, at: f64) -> Option<(NurbsSurface, NurbsSurface)> {
    let [p, q] = piece.degree();
    if piece.counts() != [p + 1, q + 1] {
        return if axis == 0 { piece.split_u(at) } else { piece.split_v(at) }.ok();
    }
    let patch = BezierPatch {
        degree: [p, q],
        points: piece.points().to_vec(),
        weights: piece.weights().map(<[f64]>::to_vec),
    };
    let domain = piece.domain();
    let t = (at - domain.min[axis]) / domain.size()[axis];
    let (low, high) = if axis == 0 { patch.split_u(t) } else { patch.split_v(t) };
    let (mut below, mut above) = (domain, domain);
    below.max[axis] = at;
    above.min[axis] = at;
    let over = |b: UvBox, patch: BezierPatch| {
        let knots = |from: f64, to: f64, degree: usize| {
            let mut knots = vec![from; degree + 1];
            knots.resize(2 * (degree + 1), to);
            knots
        };
        let (us, vs) = (knots(b.min.x, b.max.x, p), knots(b.min.y, b.max.y, q));
        NurbsSurface::new([p, q], us, vs, patch.points, patch.weights).ok()
    };
    Some((over(below, low)?, over(above, high)?))
}

/// Where roots end along one direction: the sides of the box, and the seams of a spline surface between them.
fn root_breaks(surface: &FaceSurface<'_>, uv_box: UvBox, axis: usize) -> Vec<f64> {
    let (mut start, mut end) = (uv_box.min[axis], uv_box.max[axis]);
    let domain = surface.domain();
    let (low, high) = (domain.min[axis], domain.max[axis]);
    if !(low.is_finite() && high.is_finite()) || is_angle(surface.surface, axis) {
        return vec![start, end];
    }
    let Some(period) = surface.periods[axis] else {
        // Loops may stray a little beyond the surface; cells cannot.
        start = start.clamp(low, high);
        end = end.clamp(low, high);
        return vec![start, end];
    };
    let mut breaks = vec![start];
    let mut seam = low + ((start - low) / period).ceil() * period;
    let slack = 1e-9 * period;
    while seam < end - slack {
        if seam > start + slack {
            breaks.push(seam);
        }
        seam += period;
    }
    breaks.push(end);
    breaks
}

/// True for parameters that are angles, which go on over the seam.
fn is_angle(surface: &Surface, axis: usize) -> bool {
    match surface {
        Surface::Cylinder { .. } | Surface::Cone { .. } | Surface::Revolution { .. } => axis == 0,
        Surface::Sphere { .. } | Surface::Torus { .. } => true,
        _ => false,
    }
}

fn nurbs_form(
    surface: &Surface,
    bounds: UvBox,
    tolerance: f64,
) -> Result<(NurbsSurface, NurbsParameters), MeshIssue> {
    if let (Ok(piece), Ok(map)) = (surface.to_nurbs(bounds), surface.nurbs_parameters(bounds)) {
        return Ok((piece, map));
    }
    let same = NurbsParameters { u: ParameterMap::Identity, v: ParameterMap::Identity };
    match surface.approximate_nurbs(bounds, FORM_SHARE * tolerance) {
        Ok((piece, _)) => Ok((piece, same)),
        Err(error) => Err(MeshIssue::NoNurbsForm { error }),
    }
}
