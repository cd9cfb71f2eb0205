//! Places at which facets must lie closer to the surface than the tolerance.

use chordal_nurbs::{Box3, DVec3};

/// A place at which the facets of one face must keep a smaller tolerance.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Closer {
    pub bounds: Box3,
    pub tolerance: f64,
}

/// The tolerance for something within a box, where `otherwise` holds elsewhere.
pub(crate) fn tolerance_within(places: &[Closer], bounds: &Box3, otherwise: f64) -> f64 {
    let here = places.iter().filter(|place| place.bounds.meets(bounds));
    here.fold(otherwise, |least, place| least.min(place.tolerance))
}

/// The smallest box around the corners of a facet or the ends of a chord.
pub(crate) fn box_around(points: &[DVec3]) -> Box3 {
    Box3::from_points(points.iter().copied())
}
