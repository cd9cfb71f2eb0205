//! Integrals over a face from its loops alone: the orientation of a closed shell, and whether a point is
//! inside it.
//!
//! For any g on the parameter plane, ∬ g du dv = −∮ F du with F(u, v) = ∫ g dv from v₀ to v, the interior on
//! the left (Green). So a loop that winds round a closed direction needs no seam, and a pole at v₀ adds
//! nothing. Where a loop winds in v, u and v change roles. The quadrature is accurate enough for signs and
//! for whole numbers.

use crate::uv_loops::{UvLoop, uv_loops};
use chordal_brep::{Face, FaceGeometry, Part};
use chordal_nurbs::{DVec2, DVec3, Surface, math};
use rayon::prelude::*;

/// Gauss–Legendre nodes and weights on 0..1.
const GAUSS: [(f64, f64); 4] = [
    (0.069_431_844_202_973_7, 0.173_927_422_568_726_9),
    (0.330_009_478_207_571_9, 0.326_072_577_431_273_1),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_1),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_9),
];
/// Each path from v₀ is cut into this many pieces.
const PIECES: usize = 4;

/// The flux of a field through a face along its normal as a part of its shell; `None` where it has no surface
/// or loops that cannot be followed.
fn flux(part: &Part, face: &Face, pieces: usize, field: impl Fn(DVec3) -> DVec3) -> Option<f64> {
    let FaceGeometry::Surface(surface) = &face.geometry else { return None };
    let loops = uv_loops(part, face, surface)?;
    if loops.is_empty() {
        return None;
    }
    let axis = usize::from(loops.iter().any(|l| l.winding.y != 0.0));
    let base = base(surface, &loops, axis)?;
    let density = |uv: DVec2| {
        let (p, du, dv) = surface.jet1(uv);
        field(p).dot(du.cross(dv))
    };
    let mut sum = 0.0;
    for a_loop in &loops {
        let n = a_loop.points.len();
        for i in 0..n {
            let from = a_loop.points[i];
            let to = if i + 1 == n { a_loop.points[0] + a_loop.winding } else { a_loop.points[i + 1] };
            let step = (to - from)[axis];
            if step != 0.0 {
                // Simpson along the loop.
                let inner = |s: f64| across(&density, from.lerp(to, s), axis, base, pieces);
                sum += step * (inner(0.0) + 4.0 * inner(0.5) + inner(1.0)) / 6.0;
            }
        }
    }
    // −∮ F du, and +∮ G dv.
    let sign = if (axis == 0) ^ face.normal_reversed() { -1.0 } else { 1.0 };
    Some(sign * sum)
}

/// ∫ density along the other parameter, from `base` to the point.
fn across(density: &impl Fn(DVec2) -> f64, at: DVec2, axis: usize, base: f64, pieces: usize) -> f64 {
    let other = 1 - axis;
    let step = (at[other] - base) / pieces as f64;
    let mut sum = 0.0;
    for k in 0..pieces {
        for (x, w) in GAUSS {
            let mut uv = at;
            uv[other] = base + step * (k as f64 + x);
            sum += w * density(uv);
        }
    }
    sum * step
}

/// Where the paths begin: at the pole that a single winding loop encloses, or at the lowest value of the
/// loops.
fn base(surface: &Surface, loops: &[UvLoop], axis: usize) -> Option<f64> {
    let other = 1 - axis;
    let winding: f64 = loops.iter().map(|l| l.winding[axis]).sum();
    if winding.abs() > 1e-9 {
        // The interior of a loop along +u is above it; along +v it is to the left, below.
        let upper = (winding > 0.0) == (axis == 0);
        let poles = surface.poles().into_iter().filter(|p| p.axis == other).map(|p| p.value);
        return if upper { poles.max_by(f64::total_cmp) } else { poles.min_by(f64::total_cmp) };
    }
    loops.iter().flat_map(|l| &l.points).map(|p| p[other]).min_by(f64::total_cmp)
}

/// Three times the volume that faces enclose, and the sum of the absolute values of its parts, relative to
/// `origin`.
pub(crate) fn volume(part: &Part, faces: &[usize], origin: DVec3) -> Option<(f64, f64)> {
    // On a plane the density is constant.
    let pieces = |face: &Face| if is_plane(face) { 1 } else { PIECES };
    let of_face = |&f: &usize| flux(part, &part.faces[f], pieces(&part.faces[f]), |p| p - origin);
    let parts: Option<Vec<f64>> = faces.par_iter().with_min_len(64).map(of_face).collect();
    parts.map(|p| p.iter().fold((0.0, 0.0), |sum, x| (sum.0 + x, sum.1 + x.abs())))
}

/// How many times faces wind around a point: about ±1 inside, 0 outside.
pub(crate) fn winding(part: &Part, faces: &[usize], p: DVec3) -> Option<f64> {
    let field = |q: DVec3| (q - p) / math::powi((q - p).length(), 3);
    let of_face = |&f: &usize| flux(part, &part.faces[f], PIECES, field);
    let parts: Option<Vec<f64>> = faces.par_iter().with_min_len(64).map(of_face).collect();
    parts.map(|p| p.iter().sum::<f64>() / (4.0 * std::f64::consts::PI))
}

fn is_plane(face: &Face) -> bool {
    matches!(&face.geometry, FaceGeometry::Surface(s) if matches!(**s, Surface::Plane { .. }))
}
