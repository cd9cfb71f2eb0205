//! How many samples a view needs: continuously, and in each direction by itself.
//!
//! A cell of h × k in the parameters, drawn as two triangles, departs from the surface by at most
//! (h² |S_uu| + 2 h k |S_uv| + k² |S_vv|) / 8. Each direction gets half of the allowed error, after the
//! mixed term has been shared between the squares: 2 h k m ≤ m (r h² + k²/r) with r the ratio of the two.

use super::model::TrimmedFace;
use chordal_nurbs::math;

/// Points of one face at most; a view that needs more shows the difference only where the face fills it
/// many times.
const MOST: f64 = 2048.0;
const MOST_POINTS: f64 = 400_000.0;

/// What the steps along u and v are proportional to, the error's root being the divisor.
fn proportions(face: &TrimmedFace) -> [f64; 2] {
    let [uu, uv, vv] = face.bends;
    let ratio = if uu > 0.0 && vv > 0.0 { (uu / vv).sqrt() } else { 1.0 };
    let size = face.uv.size();
    [size.x * (0.25 * (uu + uv * ratio)).sqrt(), size.y * (0.25 * (vv + uv / ratio)).sqrt()]
}

/// Steps along u and v for an error in the part's units, before kinks are added.
pub(crate) fn steps(face: &TrimmedFace, error: f64) -> [f64; 2] {
    let mut steps = proportions(face).map(|x| (x / error.sqrt()).ceil().clamp(1.0, MOST));
    while steps[0] * steps[1] > MOST_POINTS {
        let larger = usize::from(steps[1] > steps[0]);
        steps[larger] = (0.5 * steps[larger]).ceil();
    }
    steps
}

/// The smallest and the largest error for which this number of steps is used: at most twice the steps that
/// are needed.
pub(crate) fn errors_served(face: &TrimmedFace, steps: [f64; 2]) -> [f64; 2] {
    if 4.0 * steps[0] * steps[1] > MOST_POINTS || steps.iter().any(|s| *s >= MOST) {
        // A number that the limits have cut is requested again each time.
        return [f64::INFINITY, 0.0];
    }
    let of = |axis: usize| {
        let least = math::square(proportions(face)[axis] / steps[axis]);
        [least, if steps[axis] <= 2.0 { f64::INFINITY } else { 4.0 * least }]
    };
    let ([a, b], [c, d]) = (of(0), of(1));
    [a.max(c), b.min(d)]
}

/// The native parameters of the face along u and v, in `steps` steps. Knot lines across which the surface has
/// a kink are among them.
pub(crate) fn grid(face: &TrimmedFace, steps: [f64; 2]) -> [Vec<f64>; 2] {
    [0, 1].map(|axis| spread(face.uv.min[axis], face.uv.max[axis], &face.kinks[axis], steps[axis]))
}

/// `steps` equal steps from `start` to `end`, rounded up in each of the parts that `kinks` cut it into.
fn spread(start: f64, end: f64, kinks: &[f64], steps: f64) -> Vec<f64> {
    let mut cuts = vec![start];
    cuts.extend(kinks.iter().copied().filter(|k| *k > start && *k < end));
    cuts.push(end);
    let mut found = vec![start];
    for pair in cuts.windows(2) {
        let count = (steps * (pair[1] - pair[0]) / (end - start) - 1e-9).ceil().max(1.0) as usize;
        found.extend((1..=count).map(|k| {
            if k == count { pair[1] } else { pair[0] + (pair[1] - pair[0]) * (k as f64 / count as f64) }
        }));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinks_are_samples() {
        let found = spread(0.0, 10.0, &[3.0, 12.0], 4.0);
        assert_eq!(found[0], 0.0);
        assert_eq!(*found.last().unwrap(), 10.0);
        assert!(found.contains(&3.0) && found.windows(2).all(|w| w[0] < w[1] && w[1] - w[0] <= 2.5 + 1e-9));
        assert_eq!(spread(0.0, 1.0, &[], 1.0), [0.0, 1.0]);
    }
}
