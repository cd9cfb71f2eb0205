//! Knot vectors, which these formats may omit, shorten or close.

use chordal_brep::{ReadIssue, Real};
/// One parameter direction of a spline.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Direction {
    pub degree: usize,
    pub knots: Vec<f64>,
    /// So many control points, from the second on, are repeated behind the last: the spline is periodic.
    pub wrapped: usize,
    /// The file's knots do not fit and were replaced.
    pub replaced: bool,
}

/// The knots of a direction with `count` control points.
///
/// Without knots that fit (`count + order`, not decreasing) they are spread evenly over 0..1, the ends
/// repeated so that the spline begins and ends in its first and last points. A `closed` direction, of which
/// the caller has made sure that its first and last points agree, is made periodic where its knots do not end
/// it there.
///
/// # Errors
/// Where order and number of points make no spline.
pub(crate) fn direction(
    count: usize,
    order: usize,
    given: &[f64],
    closed: bool,
) -> Result<Direction, ReadIssue> {
    if order < 2 {
        return Err(ReadIssue::BadValue { what: "order", value: Real(order as f64) });
    }
    if count < order {
        return Err(ReadIssue::TooFew { what: "control points", found: count, least: order });
    }
    let degree = order - 1;
    let fits = given.len() == count + order
        && given.iter().all(|k| k.is_finite())
        && given.windows(2).all(|k| k[0] <= k[1])
        && given[degree] < given[count];
    let replaced = !fits && !given.is_empty();
    let mut knots = if fits {
        given.to_vec()
    } else if closed {
        let last = (count + order - 1) as f64;
        (0..count + order).map(|i| i as f64 / last).collect()
    } else {
        clamped(count, degree)
    };
    let ends_there = |ends: &[f64]| ends.windows(2).all(|k| k[0] == k[1]);
    let is_clamped = ends_there(&knots[..order]) || ends_there(&knots[count..]);
    let mut wrapped = 0;
    if closed && !is_clamped {
        wrapped = degree - 1;
        for i in 1..degree {
            let step = knots[i] - knots[i - 1];
            knots.push(knots[knots.len() - 1] + step);
        }
    }
    Ok(Direction { degree, knots, wrapped, replaced })
}

fn clamped(count: usize, degree: usize) -> Vec<f64> {
    let spans = (count - degree) as f64;
    (0..count + degree + 1).map(|i| i.clamp(degree, count).abs_diff(degree) as f64 / spans).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn absent_knots_are_even_and_clamped() {
        let found = direction(5, 4, &[], false).unwrap();
        assert_eq!(found.knots, [0.0, 0.0, 0.0, 0.0, 0.5, 1.0, 1.0, 1.0, 1.0]);
        assert!(!found.replaced);
        let found = direction(5, 4, &[0.0, 1.0], false).unwrap();
        assert_eq!(found.knots, [0.0, 0.0, 0.0, 0.0, 0.5, 1.0, 1.0, 1.0, 1.0]);
        assert!(found.replaced);
    }

    #[test]
    fn closed_directions_become_periodic_unless_their_knots_end_them() {
        let found = direction(5, 3, &[], true).unwrap();
        assert_eq!((found.wrapped, found.knots.len()), (1, 5 + 1 + 3));
        assert!(found.knots.windows(2).all(|k| (k[1] - k[0] - 1.0 / 7.0).abs() < 1e-12));
        let bezier = [0.0, 0.0, 0.0, 1.0, 1.0, 1.0];
        assert_eq!(direction(3, 3, &bezier, true).unwrap().wrapped, 0);
    }

    #[test]
    fn too_few_points_are_refused() {
        assert!(direction(3, 4, &[], false).is_err());
        assert!(direction(3, 1, &[], false).is_err());
    }
}
