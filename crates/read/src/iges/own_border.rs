//! Outer boundaries that do not close and run along the border of their surface: the missing part is the rest
//! of it.
//!
//! Some writers leave out the side of a patch at which the whole surface closes, and approximate what they do
//! write by one smooth curve, which cuts the corners. The patch itself is then the better description.

use super::boundaries::{Boundary, LOOSE, to_chord};
use super::surfaces::Patch;
use chordal_nurbs::{DVec2, DVec3, Surface};

/// Samples of each side of the patch, and of each piece of the boundary.
const STEPS: u32 = 64;

/// The boundary runs along this share of the border at least.
const MOST: f64 = 0.5;

/// Curves further from their surface than this multiple of the resolution are approximations.
const STRAYS: f64 = 10.0;

/// True where a boundary in space alone strays from its surface, does not close, and runs along most of the
/// border of a spline patch.
pub(crate) fn stands_for_border(boundary: &Boundary, patch: &Patch, resolution: f64) -> bool {
    let (true, Surface::Nurbs(surface)) = (boundary.parameters.is_empty(), &patch.surface) else {
        return false;
    };
    let (Some(first), Some(last)) = (boundary.model.first(), boundary.model.last()) else { return false };
    let slack = (LOOSE * boundary.size()).max(4.0 * resolution);
    let closes = last.end().distance(first.start()) <= slack;
    // What lies on the surface is good as it is: the rest follows the surface.
    if closes || boundary.model_off(patch) <= STRAYS * resolution {
        return false;
    }
    let domain = patch.bounds.unwrap_or_else(|| surface.domain());
    let corners = [
        domain.min,
        DVec2::new(domain.max.x, domain.min.y),
        domain.max,
        DVec2::new(domain.min.x, domain.max.y),
    ];
    let share = |k: u32| f64::from(k) / f64::from(STEPS);
    let border: Vec<DVec3> = (0..4)
        .flat_map(|side: usize| {
            let (a, b) = (corners[side], corners[(side + 1) % 4]);
            (0..STEPS).map(move |k| patch.surface.point(a.lerp(b, share(k))))
        })
        .collect();
    let path: Vec<DVec3> =
        boundary.model.iter().flat_map(|p| (0..=STEPS).map(move |k| p.segment.at(share(k)))).collect();
    let n = border.len();
    let near = |p: &DVec3| (0..n).any(|i| to_chord(*p, [border[i], border[(i + 1) % n]]) <= slack);
    let length = |points: &[DVec3]| points.windows(2).map(|w| w[0].distance(w[1])).sum::<f64>();
    length(&path) > MOST * length(&border) && path.iter().all(near)
}
