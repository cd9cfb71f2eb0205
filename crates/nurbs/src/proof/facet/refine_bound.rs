//! The error along the normal, looked at closely only where it is near what is allowed.
//!
//! A facet's lattice of 16² small triangles is walked like a quadtree: a triangle of the coarse lattice whose
//! corners show little error is done with, because what may hide between them is known; the others are cut in
//! four. Next to its largest error a facet so costs about as many points as the finest lattice has along an
//! edge.

use super::setting::{Modelled, Setting};
use super::{Facet, lattice_point};
use crate::SurfaceBounds;
use glam::DVec3;

/// The number of parts into which the finest lattice cuts each edge of a facet.
///
/// Enclosures between its points are 256 times smaller than over the facet. A finer lattice would cost more
/// evaluations than cutting the facet; a coarser one would reject facets that are within the tolerance. It is
/// a power of two, because triangles of coarser lattices are halved down to it.
pub(super) const FINEST: usize = 16;

/// Errors along the normal at the points (i, j) of the finest lattice, weights (i, j, 16 − i − j)/16; NaN
/// where not evaluated.
#[derive(Debug)]
pub(super) struct Errors([[f64; FINEST + 1]; FINEST + 1]);

impl Default for Errors {
    fn default() -> Self {
        let mut errors = [[f64::NAN; FINEST + 1]; FINEST + 1];
        // The corners lie on the surface.
        for [i, j] in [[FINEST, 0], [0, FINEST], [0, 0]] {
            errors[i][j] = 0.0;
        }
        Self(errors)
    }
}

impl Errors {
    pub fn set(&mut self, i: usize, j: usize, error: f64) {
        self.0[i][j] = error;
    }
}

/// What a walk needs to know.
pub(super) struct Closer<'a, 'b> {
    pub bounds: &'a SurfaceBounds<'b>,
    pub facet: &'a Facet,
    pub setting: &'a Setting,
    pub normal: &'a Modelled,
    pub weight: &'a Modelled,
    pub errors: &'a mut Errors,
}

/// A triangle of the lattice or an edge of one: its corners and the length of its sides.
type Corners<const N: usize> = [[usize; 2]; N];

impl Closer<'_, '_> {
    /// A bound of the error over the facet, where one not above `target` can be found.
    pub fn bound(&mut self, parts: usize, target: f64) -> Option<f64> {
        let step = FINEST / parts;
        let mut worst = 0.0f64;
        for i in (0..FINEST).step_by(step) {
            for j in (0..FINEST - i).step_by(step) {
                let upright = [[i, j], [i + step, j], [i, j + step]];
                worst = worst.max(self.triangle(upright, step, target)?);
                if i + j + step < FINEST {
                    let inverted = [[i + step, j + step], [i, j + step], [i + step, j]];
                    worst = worst.max(self.triangle(inverted, step, target)?);
                }
            }
        }
        Some(worst)
    }

    /// The same on edge i, opposite corner i.
    pub fn edge_bound(&mut self, edge: usize, parts: usize, target: f64) -> Option<f64> {
        let step = FINEST / parts;
        // Corner 0 has lattice point (16, 0), corner 1 (0, 16), corner 2 (0, 0).
        let at = |k: usize| match edge {
            0 => [0, k],
            1 => [k, 0],
            _ => [k, FINEST - k],
        };
        (0..FINEST).step_by(step).try_fold(0.0f64, |worst, k| {
            Some(worst.max(self.segment(edge, [at(k), at(k + step)], step, target)?))
        })
    }

    fn triangle(&mut self, corners: Corners<3>, step: usize, target: f64) -> Option<f64> {
        let parts = FINEST / step;
        let between = self.normal.between(self.setting, parts);
        let bound = self.local_bound(corners, parts, between, target)?;
        if bound <= target {
            return Some(bound);
        }
        let [a, b, c] = corners;
        let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
        let half = step / 2;
        if half == 0 {
            return None;
        }
        [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
            .into_iter()
            .try_fold(0.0f64, |worst, part| Some(worst.max(self.triangle(part, half, target)?)))
    }

    fn segment(&mut self, edge: usize, ends: Corners<2>, step: usize, target: f64) -> Option<f64> {
        let parts = FINEST / step;
        let between = self.normal.between_on_edge(self.setting, edge, parts);
        let bound = self.local_bound(ends, parts, between, target)?;
        if bound <= target {
            return Some(bound);
        }
        let [a, b] = ends;
        let m = middle(a, b);
        let half = step / 2;
        if half == 0 {
            return None;
        }
        let first = self.segment(edge, [a, m], half, target)?;
        Some(first.max(self.segment(edge, [m, b], half, target)?))
    }

    /// What the corners show and may hide; `None` where they show too much.
    fn local_bound<const N: usize>(
        &mut self,
        corners: Corners<N>,
        parts: usize,
        between: f64,
        target: f64,
    ) -> Option<f64> {
        let shown = corners.iter().fold(0.0f64, |m, &corner| m.max(self.error(corner)));
        // Between samples the weight strays from linear by this share.
        let grow = 1.0 + self.weight.between(self.setting, parts);
        (shown <= target).then_some((shown + between) * grow)
    }

    fn error(&mut self, [i, j]: [usize; 2]) -> f64 {
        let known = self.errors.0[i][j];
        if !known.is_nan() {
            return known;
        }
        let w = lattice_point(i, j, FINEST);
        let uv = self.facet.uv[0] * w[0] + self.facet.uv[1] * w[1] + self.facet.uv[2] * w[2];
        let xyz = &self.facet.xyz;
        let on_facet: DVec3 = xyz[0] * w[0] + xyz[1] * w[1] + xyz[2] * w[2];
        let error = (self.bounds.weighted_point(uv).0 - on_facet).dot(self.setting.n).abs();
        // Not a number is no error that could be bounded.
        let error = if error.is_nan() { f64::INFINITY } else { error };
        self.errors.set(i, j, error);
        error
    }
}

fn middle(a: [usize; 2], b: [usize; 2]) -> [usize; 2] {
    [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2]
}
