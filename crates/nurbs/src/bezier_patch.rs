//! Bézier patches.

use crate::basis::Basis;
use crate::homogeneous::{self, Homogeneous};
use crate::{SurfaceJet, UvBox, blossom, tensor};
use glam::{DVec2, DVec3};

/// A Bézier patch over the unit square; point (i, j), i along u, is `points[i * (degree[1] + 1) + j]`.
///
/// `points` are projected (not multiplied by weights).
#[derive(Clone, Debug, PartialEq)]
pub struct BezierPatch {
    /// The degrees along u and along v.
    pub degree: [usize; 2],
    /// The control points, projected; `(degree[0] + 1) * (degree[1] + 1)` of them.
    pub points: Vec<DVec3>,
    /// The weights, one per control point in the same order; absent for a polynomial patch.
    pub weights: Option<Vec<f64>>,
}

impl BezierPatch {
    /// The point at `uv`; the polynomial goes on outside the unit square.
    pub fn eval(&self, uv: DVec2) -> DVec3 {
        let [[p]] = self.derivatives::<1>(uv);
        p
    }

    /// Point and all derivatives to the second order, by the patch's own parameters.
    pub fn jet(&self, uv: DVec2) -> SurfaceJet {
        let [[p, dv, dvv], [du, duv, _], [duu, ..]] = self.derivatives::<3>(uv);
        SurfaceJet { p, du, dv, duu, duv, dvv }
    }

    fn derivatives<const R: usize>(&self, uv: DVec2) -> [[DVec3; R]; R] {
        let bu = Basis::<R>::bernstein(self.degree[0], uv.x);
        let bv = Basis::<R>::bernstein(self.degree[1], uv.y);
        tensor::derivatives(&bu, &bv, self.degree[1] + 1, &self.points, self.weights.as_deref())
    }

    /// Control points multiplied by their weights, and the weights (1 where there are none).
    pub(crate) fn homogeneous(&self) -> Vec<Homogeneous<DVec3>> {
        homogeneous::homogeneous(&self.points, self.weights.as_deref())
    }

    /// The inverse of [`Self::homogeneous`]; the weights are dropped where the patch is not `rational`.
    pub(crate) fn from_homogeneous(degree: [usize; 2], net: Vec<Homogeneous<DVec3>>, rational: bool) -> Self {
        let (points, weights) = homogeneous::projected(net, rational);
        Self { degree, points, weights }
    }

    /// Exchanges u and v.
    pub fn swapped(&self) -> Self {
        let [m, n] = self.degree;
        let order = |k: usize| (k % (m + 1)) * (n + 1) + k / (m + 1);
        let count = self.points.len();
        Self {
            degree: [n, m],
            points: (0..count).map(|k| self.points[order(k)]).collect(),
            weights: self.weights.as_ref().map(|w| (0..count).map(|k| w[order(k)]).collect()),
        }
    }

    /// The parts below and above v = `t`, each over the unit square.
    pub fn split_v(&self, t: f64) -> (Self, Self) {
        let mut above = self.homogeneous();
        let below =
            above.chunks_exact_mut(self.degree[1] + 1).flat_map(|row| blossom::split(row, t)).collect();
        let rational = self.weights.is_some();
        (
            Self::from_homogeneous(self.degree, below, rational),
            Self::from_homogeneous(self.degree, above, rational),
        )
    }

    /// The parts below and above u = `t`, each over the unit square.
    pub fn split_u(&self, t: f64) -> (Self, Self) {
        let (below, above) = self.swapped().split_v(t);
        (below.swapped(), above.swapped())
    }

    /// The part over `cell` of the unit square, over the unit square.
    pub fn restricted(&self, cell: UvBox) -> Self {
        let [m, n] = self.degree;
        let mut net = self.homogeneous();
        for row in net.chunks_exact_mut(n + 1) {
            blossom::restrict(row, cell.min.y, cell.max.y);
        }
        let mut column = Vec::with_capacity(m + 1);
        for j in 0..=n {
            column.clear();
            column.extend((0..=m).map(|i| net[i * (n + 1) + j]));
            blossom::restrict(&mut column, cell.min.x, cell.max.x);
            for i in 0..=m {
                net[i * (n + 1) + j] = column[i];
            }
        }
        Self::from_homogeneous(self.degree, net, self.weights.is_some())
    }

    /// The derivative by v as a patch of degree one less in v; `None` where the patch is rational.
    pub fn hodograph_v(&self) -> Option<Self> {
        let [m, n] = self.degree;
        if self.weights.is_some() {
            return None;
        }
        let points = self.points.chunks_exact(n + 1).flat_map(blossom::hodograph).collect();
        Some(Self { degree: [m, n.saturating_sub(1)], points, weights: None })
    }

    /// The derivative by u as a patch of degree one less in u; `None` where the patch is rational.
    pub fn hodograph_u(&self) -> Option<Self> {
        Some(self.swapped().hodograph_v()?.swapped())
    }

    /// The same patch, one degree higher in v.
    pub fn elevated_v(&self) -> Self {
        let [m, n] = self.degree;
        let net = self.homogeneous();
        let raised = net.chunks_exact(n + 1).flat_map(blossom::elevate).collect();
        Self::from_homogeneous([m, n + 1], raised, self.weights.is_some())
    }

    /// The same patch, one degree higher in u.
    pub fn elevated_u(&self) -> Self {
        self.swapped().elevated_v().swapped()
    }

    /// True where every weight has the same sign (or there is none).
    pub fn has_positive_weights(&self) -> bool {
        crate::bezier::same_sign(self.weights.as_deref())
    }
}
