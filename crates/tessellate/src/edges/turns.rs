//! Chords are halved until no face turns further along them than the limit of angle.

use super::{Sampling, split_where};
use crate::limits::{TURN_LENGTH, turns_too_far};
use chordal_nurbs::Range;

/// A chord is halved at most this often for the turn of a face: two to this power is finer than any surface
/// needs.
const MAX_HALVINGS: usize = 24;

/// Halves chords between whose ends a face turns further than allowed. The face may bend between two probes.
pub(super) fn turning_less(mut t: Vec<f64>, sampling: &Sampling<'_, '_, '_>, range: Range) -> Vec<f64> {
    let Sampling { curve, uses, limits, .. } = sampling;
    // The ends may lie on creases. Normals this far inside belong to this piece.
    let inside = Range::new(range.start + 1e-7 * range.length(), range.end - 1e-7 * range.length());
    for one in uses.iter().filter(|u| !u.surface.is_elementary()) {
        if limits.angle >= std::f64::consts::PI {
            break;
        }
        let mut near = None;
        let mut at = |t: f64| {
            let t = inside.clamp(t);
            let p = curve.point(t);
            let place = one.parameters(p, t, range, near);
            near = Some(place);
            (t, p, one.surface.normal(place.uv))
        };
        let mut fine = vec![t[0]];
        let mut last = at(t[0]);
        for &end in &t[1..] {
            let mut ends = vec![end];
            while let Some(&next) = ends.last() {
                let ahead = at(next);
                let long = last.1.distance(ahead.1) > TURN_LENGTH * limits.tolerance;
                if long && ends.len() < MAX_HALVINGS && turns_too_far(last.2, ahead.2, limits.angle) {
                    ends.push(0.5 * (last.0 + ahead.0));
                    continue;
                }
                fine.push(next);
                last = ahead;
                ends.pop();
            }
        }
        t = fine;
    }
    t
}

/// Where the normals along a chord are compared that was chosen without regard to the faces, as shares of its
/// length.
const TURN_PROBES: [f64; 3] = [0.25, 0.5, 0.75];

/// Halves chords over which a face turns further than allowed, even if it turns back before the end: no facet
/// beside such a chord could reach past the place in between.
pub(super) fn turning_less_between(
    mut t: Vec<f64>,
    sampling: &Sampling<'_, '_, '_>,
    range: Range,
) -> Vec<f64> {
    let Sampling { curve, uses, limits, .. } = sampling;
    if limits.angle >= std::f64::consts::PI {
        return t;
    }
    let inside = Range::new(range.start + 1e-7 * range.length(), range.end - 1e-7 * range.length());
    for one in uses.iter().filter(|u| !u.surface.is_elementary()) {
        let normal = |t: f64| {
            let t = inside.clamp(t);
            one.surface.normal(one.parameters(curve.point(t), t, range, None).uv)
        };
        for _ in 0..MAX_HALVINGS {
            let before = t.len();
            t = split_where(&t, |a, b| {
                let ends = [a, b].map(normal);
                let long = curve.point(a).distance(curve.point(b)) > TURN_LENGTH * limits.tolerance;
                let turns = |share: f64| {
                    let n = normal(a + share * (b - a));
                    ends.iter().any(|&end| turns_too_far(end, n, limits.angle))
                };
                long && TURN_PROBES.into_iter().any(turns)
            });
            if t.len() == before {
                break;
            }
        }
    }
    t
}
