//! The tight axis-aligned box of a whole placed model: what a tolerance in percent is a percentage of.
//!
//! Steps: (1) vertices, and edges sampled and then refined where an extreme may lie between samples; (2) of
//! the faces that can bulge beyond their edges (spheres, tori, revolutions, free forms, offsets) those whose
//! outer box leaves the box of step 1; (3) a coarse mesh of these, each triangle that may hold an extreme
//! searched on the exact surface. Planes, cylinders, cones and extrusions are ruled: a linear function over a
//! trimmed piece has its maximum on the border, so they need no step 3.
//!
//! Every point that enters the box lies on the model, so the box is never too large (beyond what edges are
//! loose by); it is too small by less than 1e-4 of its diagonal on the shapes of the tests. That is no proof,
//! and none is needed: the box only turns a percentage into millimetres, and the millimetres are what is
//! proven.

mod edges;
mod faces;
mod hull;

use crate::placement::PartUse;
use crate::work_limits::{FileLimits, WorkLimits};
use chordal_brep::Model;
use chordal_tessellate::{Bound, Cancel, Options};
use glam::{DAffine3, DVec3};
use std::time::Duration;

/// An axis-aligned box in millimetres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TightBox {
    /// The lowest corner.
    pub min: DVec3,
    /// The highest corner.
    pub max: DVec3,
}

impl TightBox {
    const EMPTY: TightBox = TightBox { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };

    /// The length of the diagonal; zero where the box is empty.
    pub fn diagonal(&self) -> f64 {
        if self.is_empty() { 0.0 } else { (self.max - self.min).length() }
    }
    /// Nothing is in it.
    pub fn is_empty(&self) -> bool {
        self.min.cmpgt(self.max).any()
    }
    /// The largest absolute coordinate.
    pub fn largest_coordinate(&self) -> f64 {
        if self.is_empty() { 0.0 } else { self.min.abs().max(self.max.abs()).max_element() }
    }
    fn include(&mut self, p_xyz: DVec3) {
        if p_xyz.is_finite() {
            self.min = self.min.min(p_xyz);
            self.max = self.max.max(p_xyz);
        }
    }
    /// The extreme value along a signed axis.
    fn extreme(&self, direction: Direction) -> f64 {
        if direction.negative { -self.min[direction.axis] } else { self.max[direction.axis] }
    }
}

/// One of the six signed axes of the world.
#[derive(Clone, Copy, Debug)]
struct Direction {
    axis: usize,
    negative: bool,
}

impl Direction {
    const ALL: [Direction; 6] = [
        Direction { axis: 0, negative: false },
        Direction { axis: 0, negative: true },
        Direction { axis: 1, negative: false },
        Direction { axis: 1, negative: true },
        Direction { axis: 2, negative: false },
        Direction { axis: 2, negative: true },
    ];

    /// The gradient of "how far along this direction" in the part's coordinates, and its constant.
    fn in_part(self, world: &DAffine3) -> (DVec3, f64) {
        let sign = if self.negative { -1.0 } else { 1.0 };
        (world.matrix3.row(self.axis) * sign, world.translation[self.axis] * sign)
    }
}

/// The box of vertices, edges and passed-through triangles: cheap, and tight unless a face bulges.
pub fn edge_box(model: &Model, uses: &[PartUse]) -> TightBox {
    let mut found = TightBox::EMPTY;
    for (part, part_use) in model.parts.iter().zip(uses).filter(|(_, u)| u.instances > 0) {
        edges::include(&mut found, part, part_use);
        for item in &part.tessellated {
            for world in &part_use.worlds {
                item.points.iter().for_each(|&p| found.include(world.transform_point3(p)));
            }
        }
    }
    found
}

/// The tight box of every placed face, without a limit of time for all faces together. A face that takes
/// longer than `face_timeout` counts by its edges only.
pub fn tight_box(
    model: &Model,
    uses: &[PartUse],
    edges: TightBox,
    face_timeout: Option<Duration>,
    cancel: &Cancel,
) -> TightBox {
    let limits = WorkLimits { face_timeout, file_timeout: None, memory: None };
    tight_box_within(model, uses, edges, &FileLimits::new(limits, model, uses, 0, 1.0), cancel)
}

/// The tight box of every placed face; starts from [`edge_box`]. A face that takes more than the limits
/// counts by its edges only.
pub(crate) fn tight_box_within(
    model: &Model,
    uses: &[PartUse],
    edges: TightBox,
    limits: &FileLimits,
    cancel: &Cancel,
) -> TightBox {
    let options = [limits.face_options(Options::new(1.0).with_bound(Bound::Estimated))];
    let (found, _) = limits.keep(&options, |options| {
        let mut found = edges;
        for (part, part_use) in model.parts.iter().zip(uses).filter(|(_, u)| u.instances > 0) {
            faces::include(&mut found, part, part_use, &options[0], cancel);
        }
        found
    });
    found
}
