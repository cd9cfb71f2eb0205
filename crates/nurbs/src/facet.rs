//! The proven distance between a surface piece and a flat triangle.

use crate::SurfaceBounds;
use glam::{DVec2, DVec3};

/// What is proven about one facet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FacetBound {
    /// Upper bound of the two-sided distance between the surface over the triangle and the facet.
    pub error: f64,
}

/// Bounds the distance between the surface over the triangle `uv` and the facet `xyz`.
pub fn facet_bound(bounds: &SurfaceBounds<'_>, uv: [DVec2; 3], xyz: [DVec3; 3]) -> FacetBound {
    let _ = (bounds, uv, xyz);
    FacetBound { error: f64::INFINITY }
}
