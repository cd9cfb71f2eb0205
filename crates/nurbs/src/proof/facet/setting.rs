//! What one facet is bounded in: its axes and lengths, and one coordinate of the surface over it as a model
//! with a remainder.

use super::form::{Cubic, Form};
use glam::{DVec2, DVec3};

/// What all stages of one bound share: the axes and lengths of the facet, and the least that is known of the
/// surface.
pub(super) struct Setting {
    /// The facet's unit normal.
    pub n: DVec3,
    /// In-plane normals of the edges, pointing outwards.
    pub m: [DVec3; 3],
    /// Edges in parameter space: d_i is opposite corner i.
    pub d: [DVec2; 3],
    /// Lengths of the edges in space.
    pub length: [f64; 3],
    /// The height of the facet over each edge.
    pub height: [f64; 3],
    /// Twice the area.
    pub area2: f64,
    /// Extents of T in u and v.
    pub size: DVec2,
    /// A lower bound of the weight; 1 for surfaces without weights.
    pub least_weight: f64,
    /// What jumps of the first derivative cost, at most.
    pub kinks: f64,
    /// Jumps of Su and of Sv inside T, at most.
    pub kink: DVec2,
}

/// Second derivatives in one direction and the interpolation error that they make.
pub(super) struct Modelled {
    pub form: Form,
    pub cubic: Cubic,
}

impl Modelled {
    pub fn new(form: Form, setting: &Setting) -> Self {
        Self { cubic: form.error(&setting.d), form }
    }

    /// What lies between the points of a lattice, at most.
    pub fn between(&self, setting: &Setting, parts: usize) -> f64 {
        let scale = 1.0 / (parts * parts) as f64;
        (self.cubic.largest_between(parts) + self.form.reach_along(setting.size) / 8.0) * scale
            + setting.kinks / parts as f64
    }

    /// What a lattice does not show of the difference from the model, along `d`.
    pub fn remainder(&self, d: DVec2, setting: &Setting, parts: usize) -> f64 {
        let parts = parts as f64;
        self.form.reach_along(d) / (8.0 * parts * parts) + setting.kinks / parts
    }

    /// The same on edge `i`.
    pub fn between_on_edge(&self, setting: &Setting, i: usize, parts: usize) -> f64 {
        let parts = parts as f64;
        (self.cubic.steepest(i) + self.form.reach_along(setting.d[i])) / (8.0 * parts * parts)
            + setting.kinks / parts
    }
}
