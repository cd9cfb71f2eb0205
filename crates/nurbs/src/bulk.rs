//! Evaluation of many points of one surface at once: the seam to devices other than the calling thread.

use crate::{NurbsSurface, SurfaceJet};
use glam::DVec2;
use std::fmt::Debug;

/// Evaluates many points of one spline surface at once, to double precision.
pub trait BulkEvaluator: Debug + Send + Sync {
    /// Point, first and second derivatives at each of the parameters `at`, which lie in the surface's domain;
    /// in the order of `at`. `None` if the evaluator cannot do it now, or a call is not worth its cost: the
    /// caller then evaluates the points itself. A result must not depend on other calls.
    fn jets(&self, surface: &NurbsSurface, at: &[DVec2]) -> Option<Vec<SurfaceJet>>;
}
