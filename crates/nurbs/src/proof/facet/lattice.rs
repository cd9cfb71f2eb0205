//! The error of a facet at the points of a lattice, and what it can be between them.

use super::form::Cubic;
use super::refine_bound::{Errors, FINEST};
use super::setting::{Modelled, Setting};
use super::{Facet, lattice_point};
use crate::SurfaceBounds;
use glam::DVec3;

/// Bounds along the normal and sideways, of the facet and its edges.
#[derive(Clone, Copy)]
pub(super) struct Parts {
    pub along: f64,
    pub along_edges: [f64; 3],
    /// How far the image of T reaches over each edge, or falls short of it.
    pub sideways: [f64; 3],
    /// How far the image of each edge bends.
    pub bends: [f64; 3],
}

/// What evaluation at the points of a lattice has shown, at most.
#[derive(Default)]
pub(super) struct Samples {
    /// The lattice seen so far divides edges in so many parts.
    parts: usize,
    pub along: f64,
    along_edges: [f64; 3],
    /// How far w·(S − a)·n is from its model.
    off: f64,
    off_edges: [f64; 3],
    sideways: [f64; 3],
    bends: [f64; 3],
    /// The same on the finest lattice, for the search that refines it.
    pub errors: Errors,
}

impl Samples {
    /// Looks at the points of a lattice that were not seen before.
    pub fn look(
        &mut self,
        bounds: &SurfaceBounds<'_>,
        facet: &Facet,
        setting: &Setting,
        model: &Cubic,
        parts: usize,
    ) {
        let known = parts.checked_div(self.parts).unwrap_or(parts);
        for i in 0..=parts {
            for j in 0..=parts - i {
                if !(i.is_multiple_of(known) && j.is_multiple_of(known)) {
                    let along = self.look_at(bounds, facet, setting, model, lattice_point(i, j, parts));
                    self.errors.set(i * FINEST / parts, j * FINEST / parts, along);
                }
            }
        }
        self.parts = parts;
    }

    /// Returns the error along the normal.
    fn look_at(
        &mut self,
        bounds: &SurfaceBounds<'_>,
        facet: &Facet,
        setting: &Setting,
        model: &Cubic,
        w: [f64; 3],
    ) -> f64 {
        let blend = |p: [DVec3; 3]| p[0] * w[0] + p[1] * w[1] + p[2] * w[2];
        let uv = facet.uv[0] * w[0] + facet.uv[1] * w[1] + facet.uv[2] * w[2];
        let (p, weight) = bounds.weighted_point(uv);
        let e = p - blend(facet.xyz);
        let along = e.dot(setting.n);
        let off = (along * (weight / setting.least_weight) - model.at(w)).abs();
        self.along = self.along.max(along.abs());
        self.off = self.off.max(off);
        for i in 0..3 {
            let out = e.dot(setting.m[i]);
            self.sideways[i] = self.sideways[i].max(out - setting.height[i] * w[i]);
            if w[i] == 0.0 {
                self.along_edges[i] = self.along_edges[i].max(along.abs());
                self.off_edges[i] = self.off_edges[i].max(off);
                self.bends[i] = self.bends[i].max(out.abs());
            }
        }
        along.abs()
    }

    /// Bounds from what was seen and what lies between; `weights` is the share by which values between
    /// samples may be larger because the weight changes.
    pub fn parts(&self, setting: &Setting, normal: &Modelled, forms: &[Modelled; 3], weights: f64) -> Parts {
        let grow = 1.0 + weights;
        let bends = std::array::from_fn(|i| {
            (self.bends[i] + forms[i].between_on_edge(setting, i, self.parts)) * grow
        });
        let direct = (self.along + normal.between(setting, self.parts)) * grow;
        let modelled =
            normal.cubic.largest() + self.off + normal.remainder(setting.size, setting, self.parts);
        Parts {
            along: direct.min(modelled),
            along_edges: std::array::from_fn(|i| {
                let direct = (self.along_edges[i] + normal.between_on_edge(setting, i, self.parts)) * grow;
                let off = self.off_edges[i] + normal.remainder(setting.d[i], setting, self.parts);
                direct.min(normal.cubic.on_edge(i) + off)
            }),
            sideways: std::array::from_fn(|i| {
                ((self.sideways[i] + forms[i].between(setting, self.parts)) * grow).max(bends[i])
            }),
            bends,
        }
    }
}
