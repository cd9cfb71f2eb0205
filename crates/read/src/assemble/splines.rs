//! Spline data as files state them: knots with multiplicities, periodic forms, weights of zero.

use chordal_brep::{ReadIssue, Real};
/// The knots each repeated by its multiplicity. Nothing is allocated before they are known to add up to
/// `expected`.
pub(crate) fn expanded_knots(
    values: &[f64],
    multiplicities: &[i64],
    expected: usize,
) -> Result<Vec<f64>, ReadIssue> {
    if let Some(m) = multiplicities.iter().find(|&&m| m < 1) {
        return Err(ReadIssue::BadValue { what: "knot multiplicity", value: Real(*m as f64) });
    }
    let total: i128 = multiplicities.iter().map(|&m| i128::from(m)).sum();
    if total != expected as i128 || values.len() != multiplicities.len() {
        return Err(ReadIssue::KnotSum { sum: i64::try_from(total).unwrap_or(i64::MAX), expected });
    }
    let repeated = values.iter().zip(multiplicities);
    Ok(repeated.flat_map(|(&value, &m)| std::iter::repeat_n(value, m as usize)).collect())
}

/// A periodic knot vector made an ordinary one over the same domain, and the number of control points it is
/// for: control point `i` is the file's `i mod count`.
///
/// `values` and `multiplicities` hold one period with both its ends; the multiplicities, the last one left
/// out, add up to `count`.
pub(crate) fn unrolled(
    values: &[f64],
    multiplicities: &[i64],
    degree: usize,
    count: usize,
) -> Result<(Vec<f64>, usize), ReadIssue> {
    let (Some(&first), Some(&m0)) = (values.first(), multiplicities.first()) else {
        return Err(ReadIssue::TooFew { what: "knots", found: 0, least: 2 });
    };
    let m0 = usize::try_from(m0).unwrap_or(0);
    if degree == 0 || degree > 100 || m0 == 0 || m0 > degree + 1 {
        return Err(ReadIssue::BadValue {
            what: "first knot multiplicity of a periodic spline",
            value: Real(m0 as f64),
        });
    }
    let inner = expanded_knots(values, multiplicities, count + m0)?;
    let period = values[values.len() - 1] - first;
    let extra = degree + 1 - m0;
    // One period without its last knot: what stands before and behind it repeats this.
    let cycle = &inner[..count];
    let before = (1..=extra).rev().map(|i| {
        let turns = (i - 1) / count + 1;
        cycle[(turns * count - i) % count] - turns as f64 * period
    });
    let behind = (0..extra).map(|i| {
        let at = m0 + i;
        cycle[at % count] + (at / count + 1) as f64 * period
    });
    let knots: Vec<f64> = before.chain(inner.iter().copied()).chain(behind).collect();
    let points = knots.len() - degree - 1;
    Ok((knots, points))
}

/// Replaces weights of zero; true where there were any.
///
/// A control point of weight zero has no effect on the curve, yet the homogeneous form needs it somewhere. A
/// weight of 1e-13 of the largest moves the curve by about 1e-13 of the control net's size: less than
/// rounding does.
pub(crate) fn replace_zero_weights(weights: &mut [f64]) -> bool {
    let largest = weights.iter().fold(0.0f64, |most, w| most.max(w.abs()));
    let mut any = false;
    if largest > 0.0 && largest.is_finite() {
        for weight in weights.iter_mut().filter(|w| **w == 0.0) {
            *weight = 1e-13 * largest;
            any = true;
        }
    }
    any
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_uniform_periodic_cubic() {
        let values: Vec<f64> = (0..=5).map(f64::from).collect();
        let (knots, points) = unrolled(&values, &[1; 6], 3, 5).expect("sound");
        assert_eq!(knots, (-3..=8).map(f64::from).collect::<Vec<_>>());
        assert_eq!(points, 8);
    }

    #[test]
    fn full_multiplicity_repeats_only_the_first_point() {
        let (knots, points) = unrolled(&[0.0, 1.0, 3.0], &[2, 2, 2], 2, 4).expect("sound");
        assert_eq!(knots, [-2.0, 0.0, 0.0, 1.0, 1.0, 3.0, 3.0, 4.0]);
        assert_eq!(points, 5);
    }

    #[test]
    fn a_period_shorter_than_the_degree() {
        let (knots, points) = unrolled(&[0.0, 1.0], &[1, 1], 3, 1).expect("sound");
        assert_eq!(knots, (-3..=4).map(f64::from).collect::<Vec<_>>());
        assert_eq!(points, 4);
    }

    #[test]
    fn huge_multiplicities_allocate_nothing() {
        assert!(expanded_knots(&[0.0, 1.0], &[2_000_000_000, 2_000_000_000], 8).is_err());
        assert!(unrolled(&[0.0, 1.0], &[2_000_000_000, 2], 3, 4).is_err());
    }
}
