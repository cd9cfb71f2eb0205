//! Every basis that OBJ has as B-splines, exactly, one direction at a time.
//!
//! Notation: n degree, K + 1 control points c, segments s over breakpoints. Bézier, Cardinal, Taylor and
//! basis matrix segments are polynomials of their own; each becomes a Bézier segment by a matrix that acts on
//! its control points, and the segments a B-spline whose inner knots have multiplicity n (n + 1 where two
//! segments do not meet).

use chordal_brep::{ReadIssue, Real};
use chordal_nurbs::{DVec4, NurbsError};

/// The kinds of basis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Basis {
    Bspline,
    Bezier,
    Cardinal,
    Taylor,
    Matrix,
}

/// One direction of an element.
#[derive(Clone, Debug)]
pub(super) struct Direction<'a> {
    pub basis: Basis,
    pub degree: usize,
    /// Knots of B-splines, else breakpoints.
    pub parameters: &'a [f64],
    /// Control points from one segment of a basis matrix to the next.
    pub step: usize,
    /// Row i: the coefficients of basis function i by powers of t.
    pub matrix: &'a [f64],
}

/// Control points of one direction with knots for them; each row runs across.
#[derive(Clone, Debug)]
pub(super) struct Spline {
    pub knots: Vec<f64>,
    pub rows: Vec<Vec<DVec4>>,
}

/// More than a B-spline of any file needs.
const MAX_DEGREE: usize = 100;

impl Direction<'_> {
    /// How many control points the parameters are for.
    ///
    /// # Errors
    /// A sentence, where degree, step or parameters make no sense.
    pub(super) fn control_points(&self) -> Result<usize, ReadIssue> {
        let (n, given) = (self.degree, self.parameters.len());
        if !(1..=MAX_DEGREE).contains(&n) {
            return Err(NurbsError::Degree(n).into());
        }
        let few = || ReadIssue::TooFew { what: "parameters", found: given, least: n + 2 };
        let segments = given.checked_sub(1).filter(|&s| s > 0).ok_or_else(few);
        match self.basis {
            Basis::Bspline => given.checked_sub(n + 1).filter(|&points| points > n).ok_or_else(few),
            Basis::Bezier => Ok(segments? * n + 1),
            Basis::Cardinal if n != 3 => {
                Err(ReadIssue::BadValue { what: "Cardinal spline degree", value: Real(n as f64) })
            }
            Basis::Cardinal => Ok(segments? + 3),
            Basis::Taylor => Ok(segments? * (n + 1)),
            Basis::Matrix if self.step == 0 => {
                Err(ReadIssue::BadValue { what: "basis matrix step", value: Real(0.0) })
            }
            Basis::Matrix => (segments? - 1)
                .checked_mul(self.step)
                .and_then(|points| points.checked_add(n + 1))
                .ok_or(ReadIssue::BadValue { what: "basis matrix step", value: Real(self.step as f64) }),
        }
    }

    /// The same curve, row by row, as a B-spline.
    ///
    /// # Errors
    /// A sentence, where the numbers do not fit together.
    pub(super) fn spline(&self, rows: Vec<Vec<DVec4>>) -> Result<Spline, ReadIssue> {
        let expected = self.control_points()?;
        if rows.len() != expected {
            return Err(ReadIssue::Count { what: "control points", found: rows.len(), expected });
        }
        if self.basis == Basis::Bspline {
            return Ok(Spline { knots: self.parameters.to_vec(), rows });
        }
        if let Some(pair) = self.parameters.windows(2).find(|pair| pair[0] >= pair[1]) {
            return Err(ReadIssue::EmptyRange { start: Real(pair[0]), end: Real(pair[1]) });
        }
        let n = self.degree;
        let to_bezier = self.to_bezier()?;
        let stride = match self.basis {
            Basis::Bezier => n,
            Basis::Cardinal | Basis::Bspline => 1,
            Basis::Taylor => n + 1,
            Basis::Matrix => self.step,
        };
        let segments = self.parameters.len() - 1;
        let mut knots = vec![self.parameters[0]; n + 1];
        let mut joined: Vec<Vec<DVec4>> = Vec::with_capacity(segments * n + 1);
        for s in 0..segments {
            let mut bezier = transformed(&to_bezier, &rows[s * stride..s * stride + n + 1]).into_iter();
            let end = self.parameters[s + 1];
            if s > 0 {
                let first = bezier.next().unwrap_or_default();
                let meets = joined.last().is_some_and(|last| meets(last, &first));
                if !meets {
                    knots.push(self.parameters[s]);
                    joined.push(first);
                }
            }
            joined.extend(bezier);
            knots.extend(std::iter::repeat_n(end, if s + 1 == segments { n + 1 } else { n }));
        }
        Ok(Spline { knots, rows: joined })
    }

    /// Row i: how Bézier point i is made from a segment's control points.
    fn to_bezier(&self) -> Result<Vec<Vec<f64>>, ReadIssue> {
        let n = self.degree;
        let sixth = 1.0 / 6.0;
        Ok(match self.basis {
            Basis::Bezier | Basis::Bspline => {
                (0..=n).map(|i| (0..=n).map(|j| if i == j { 1.0 } else { 0.0 }).collect()).collect()
            }
            Basis::Cardinal => vec![
                vec![0.0, 1.0, 0.0, 0.0],
                vec![-sixth, 1.0, sixth, 0.0],
                vec![0.0, sixth, 1.0, -sixth],
                vec![0.0, 0.0, 1.0, 0.0],
            ],
            Basis::Taylor => from_powers(n),
            Basis::Matrix => {
                if self.matrix.len() != (n + 1) * (n + 1) {
                    return Err(ReadIssue::Count {
                        what: "numbers of the basis matrix",
                        found: self.matrix.len(),
                        expected: (n + 1) * (n + 1),
                    });
                }
                // Coefficient of t^k from control point j is element (j, k).
                let element = |i: usize, j: usize, powers: &[Vec<f64>]| {
                    (0..=n).map(|k| powers[i][k] * self.matrix[j * (n + 1) + k]).sum()
                };
                let powers = from_powers(n);
                (0..=n).map(|i| (0..=n).map(|j| element(i, j, &powers)).collect()).collect()
            }
        })
    }
}

/// Bézier point i from coefficients of powers: Σ_{k ≤ i} C(i, k) / C(n, k) a_k.
fn from_powers(n: usize) -> Vec<Vec<f64>> {
    let ratio = |i: usize, k: usize| (0..k).map(|m| (i - m) as f64 / (n - m) as f64).product();
    (0..=n).map(|i| (0..=n).map(|k| if k <= i { ratio(i, k) } else { 0.0 }).collect()).collect()
}

fn transformed(matrix: &[Vec<f64>], rows: &[Vec<DVec4>]) -> Vec<Vec<DVec4>> {
    let width = rows.first().map_or(0, Vec::len);
    let combined = |factors: &Vec<f64>| -> Vec<DVec4> {
        let mut sum = vec![DVec4::ZERO; width];
        for (factor, row) in factors.iter().zip(rows).filter(|(factor, _)| **factor != 0.0) {
            sum.iter_mut().zip(row).for_each(|(sum, point)| *sum += *point * *factor);
        }
        sum
    };
    matrix.iter().map(combined).collect()
}

/// True where two segments end and begin in the same points, but for rounding.
fn meets(a: &[DVec4], b: &[DVec4]) -> bool {
    let size = a.iter().chain(b).fold(0.0f64, |size, p| size.max(p.abs().max_element()));
    a.iter().zip(b).all(|(a, b)| (*a - *b).abs().max_element() <= 1e-12 * size)
}
