//! Curves derived from others: parallel curves and curves given in the parameter space of a surface.

use crate::conic::Jet3;
use crate::{Curve, Curve2, CurveJet, Surface};
use glam::DVec3;

/// The unit vector along `w` with its first two derivatives, from `w` and its derivatives; `None` where `w`
/// is zero.
///
/// With P = I − nnᵀ: n' = P w'/|w| and n'' = P w''/|w| − 2 n'(n·w')/|w| − n |n'|².
pub(crate) fn unit_jet(w: DVec3, w1: DVec3, w2: DVec3) -> Option<[DVec3; 3]> {
    let length = w.length();
    if length == 0.0 || !length.is_finite() {
        return None;
    }
    let n = w / length;
    let a = w1 / length;
    let rate = n.dot(a);
    let n1 = a - n * rate;
    let b = w2 / length;
    let n2 = b - n * n.dot(b) - n1 * (2.0 * rate) - n * n1.length_squared();
    Some([n, n1, n2])
}

/// A point at `distance` from the basis along `unit(basis' × reference)`; on the basis where that is
/// undefined.
pub(super) fn offset_jet(basis: &Curve, distance: f64, reference: DVec3, t: f64) -> CurveJet {
    let [p, d1, d2, d3] = basis.jet3(t);
    let n = unit_jet(d1.cross(reference), d2.cross(reference), d3.cross(reference)).unwrap_or_default();
    CurveJet { p: p + n[0] * distance, d1: d1 + n[1] * distance, d2: d2 + n[2] * distance }
}

/// The chain rule for `surface(curve(t))`.
pub(super) fn on_surface_jet(surface: &Surface, curve: &Curve2, t: f64) -> CurveJet {
    let c = curve.jet(t);
    let s = surface.jet(c.p);
    let d1 = s.du * c.d1.x + s.dv * c.d1.y;
    let d2 = s.duu * (c.d1.x * c.d1.x)
        + s.duv * (2.0 * c.d1.x * c.d1.y)
        + s.dvv * (c.d1.y * c.d1.y)
        + s.du * c.d2.x
        + s.dv * c.d2.y;
    CurveJet { p: s.p, d1, d2 }
}

/// Adds the third derivative as a central difference of the second.
pub(super) fn with_third(jet: impl Fn(f64) -> CurveJet, step: f64, t: f64) -> Jet3<DVec3> {
    let at = jet(t);
    let third = (jet(t + step).d2 - jet(t - step).d2) / (2.0 * step);
    [at.p, at.d1, at.d2, third]
}
