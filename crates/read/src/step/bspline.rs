//! B-spline data of STEP, for curves and surfaces alike: knot vectors from multiplicities, or from the form's
//! name.

use chordal_brep::{ReadIssue, Real};
use chordal_nurbs::NurbsError;
/// How an entity states its knots.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Knots {
    /// Distinct values with multiplicities.
    Listed { multiplicities: Vec<i64>, values: Vec<f64> },
    /// Integer knots, none repeated.
    Uniform,
    /// Integer knots, the ends repeated `degree + 1` times.
    QuasiUniform,
    /// Bézier pieces: interior knots repeated `degree` times.
    Bezier,
}

/// A full knot vector and how many control points at each end it leaves without effect.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct KnotVector {
    pub knots: Vec<f64>,
    pub skip_first: usize,
    pub skip_last: usize,
}

impl Knots {
    /// The knot vector for `count` control points. Nothing is allocated before the multiplicities are known
    /// to add up, for any count that the file states.
    pub(crate) fn vector(&self, degree: usize, count: usize) -> Result<KnotVector, ReadIssue> {
        if degree == 0 || degree > 100 {
            return Err(NurbsError::Degree(degree).into());
        }
        if count <= degree {
            return Err(ReadIssue::TooFew { what: "control points", found: count, least: degree + 1 });
        }
        let plain = |knots| Ok(KnotVector { knots, skip_first: 0, skip_last: 0 });
        match self {
            Knots::Listed { multiplicities, values } => listed(multiplicities, values, degree, count),
            Knots::Uniform => plain((0..count + degree + 1).map(|i| i as f64 - degree as f64).collect()),
            Knots::QuasiUniform => {
                let spans = count - degree;
                plain((0..count + degree + 1).map(|i| i.saturating_sub(degree).min(spans) as f64).collect())
            }
            Knots::Bezier => bezier(degree, count).and_then(plain),
        }
    }
}

fn bezier(degree: usize, count: usize) -> Result<Vec<f64>, ReadIssue> {
    if !(count - 1).is_multiple_of(degree) {
        return Err(ReadIssue::Count {
            what: "control points for whole Bézier pieces",
            found: count,
            expected: (count / degree) * degree + 1,
        });
    }
    let spans = (count - 1) / degree;
    let mut knots = vec![0.0];
    knots.extend((0..=spans).flat_map(|i| std::iter::repeat_n(i as f64, degree)));
    knots.push(spans as f64);
    Ok(knots)
}

fn listed(
    multiplicities: &[i64],
    values: &[f64],
    degree: usize,
    count: usize,
) -> Result<KnotVector, ReadIssue> {
    if multiplicities.len() != values.len() {
        return Err(ReadIssue::Count {
            what: "knot multiplicities",
            found: multiplicities.len(),
            expected: values.len(),
        });
    }
    if let Some(m) = multiplicities.iter().find(|&&m| m < 0) {
        return Err(ReadIssue::BadValue { what: "knot multiplicity", value: Real(*m as f64) });
    }
    let total: i128 = multiplicities.iter().map(|&m| i128::from(m)).sum();
    let expected = count + degree + 1;
    if total != expected as i128 {
        return Err(ReadIssue::KnotSum { sum: i64::try_from(total).unwrap_or(i64::MAX), expected });
    }
    let mut knots = Vec::with_capacity(count + degree + 1);
    for (&m, &value) in multiplicities.iter().zip(values) {
        knots.extend(std::iter::repeat_n(value, m as usize));
    }
    let extra = |m: Option<&i64>| m.map_or(0, |&m| (m as usize).saturating_sub(degree + 1));
    let skip_first = extra(multiplicities.first());
    let skip_last = if multiplicities.len() > 1 { extra(multiplicities.last()) } else { 0 };
    knots.drain(..skip_first);
    knots.truncate(knots.len() - skip_last);
    Ok(KnotVector { knots, skip_first, skip_last })
}

impl KnotVector {
    /// True where an end multiplicity was over the degree + 1.
    pub(crate) fn repaired(&self) -> bool {
        self.skip_first + self.skip_last > 0
    }

    /// Without the control points that have no effect.
    pub(crate) fn trim<T: Clone>(&self, mut points: Vec<T>) -> Vec<T> {
        points.truncate(points.len() - self.skip_last);
        points.drain(..self.skip_first);
        points
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn named_forms() {
        let knots = |k: Knots, degree, count| k.vector(degree, count).map(|v| v.knots);
        assert_eq!(knots(Knots::Uniform, 2, 4), Ok(vec![-2.0, -1.0, 0.0, 1.0, 2.0, 3.0, 4.0]));
        assert_eq!(knots(Knots::QuasiUniform, 2, 4), Ok(vec![0.0, 0.0, 0.0, 1.0, 2.0, 2.0, 2.0]));
        assert_eq!(knots(Knots::Bezier, 2, 5), Ok(vec![0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 2.0]));
        assert!(knots(Knots::Bezier, 2, 4).is_err());
    }

    #[test]
    fn huge_multiplicities_allocate_nothing() {
        let knots =
            Knots::Listed { multiplicities: vec![2_000_000_000, 2_000_000_000], values: vec![0.0, 1.0] };
        assert_eq!(knots.vector(3, 4), Err(ReadIssue::KnotSum { sum: 4_000_000_000, expected: 8 }));
    }

    #[test]
    fn multiplicity_over_degree_plus_one_drops_dead_points() {
        let knots = Knots::Listed { multiplicities: vec![3, 2], values: vec![0.0, 1.0] };
        let vector = knots.vector(1, 3).expect("repairable");
        assert_eq!(vector.knots, vec![0.0, 0.0, 1.0, 1.0]);
        assert_eq!(vector.trim(vec!['a', 'b', 'c']), vec!['b', 'c']);
    }
}
