//! Where a polynomial in Bernstein form changes its sign.
//!
//! Source: the variation-diminishing property. Coefficients without a change of sign have no root between;
//! with one change they have exactly one, which bisection finds; with more, the interval is halved. What
//! stays undecided in an interval of rounding's width counts as one root there where the ends differ in sign,
//! else as none.

use crate::blossom;

/// Intervals are halved at most this often.
const DEEPEST: u32 = 52;

/// The parameters strictly between 0 and 1 at which the polynomial with these Bernstein coefficients changes
/// its sign, increasing.
///
/// Coefficients below `zero` in size count as zero; a polynomial that is zero throughout changes nowhere.
pub(crate) fn sign_changes(coefficients: &[f64], zero: f64) -> Vec<f64> {
    let mut found = Vec::new();
    let mut stack = vec![(coefficients.to_vec(), 0.0, 1.0, 0u32)];
    while let Some((row, a, b, depth)) = stack.pop() {
        match changes(&row, zero) {
            0 => {}
            1 => found.push(bisected(&row, a, b)),
            _ if depth >= DEEPEST => found.push(0.5 * (a + b)),
            _ => {
                let mut above = row;
                let below = blossom::split(&mut above, 0.5);
                let middle = 0.5 * (a + b);
                // A root right in the middle leaves both halves without a change.
                let at = above[0];
                if at.abs() <= zero && side(&below, zero) * side(&above, zero) < 0.0 {
                    let (left, right) = (changes(&below, zero), changes(&above, zero));
                    if left == 0 && right == 0 {
                        found.push(middle);
                        continue;
                    }
                }
                stack.push((above, middle, b, depth + 1));
                stack.push((below, a, middle, depth + 1));
            }
        }
    }
    found.sort_unstable_by(f64::total_cmp);
    found.dedup();
    found.retain(|&t| t > 0.0 && t < 1.0);
    found
}

/// The sign of the first coefficient that has one.
fn side(row: &[f64], zero: f64) -> f64 {
    row.iter().find(|c| c.abs() > zero).map_or(0.0, |c| c.signum())
}

fn changes(row: &[f64], zero: f64) -> usize {
    let mut last = 0.0;
    let mut count = 0;
    for c in row.iter().filter(|c| c.abs() > zero) {
        if last != 0.0 && c.signum() != last {
            count += 1;
        }
        last = c.signum();
    }
    count
}

/// The one root of a row with one change of sign, as a parameter of the whole.
fn bisected(row: &[f64], a: f64, b: f64) -> f64 {
    let rising = row.iter().find(|c| **c != 0.0).is_some_and(|c| *c < 0.0);
    let (mut low, mut high) = (0.0, 1.0);
    let mut scratch = row.to_vec();
    for _ in 0..DEEPEST {
        let t = 0.5 * (low + high);
        scratch.copy_from_slice(row);
        let value = blossom::split(&mut scratch, t)[row.len() - 1];
        if value == 0.0 {
            low = t;
            high = t;
            break;
        }
        if (value < 0.0) == rising { low = t } else { high = t }
    }
    a + (b - a) * 0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bernstein::{product, unscaled};
    use proptest::prelude::*;

    /// Bernstein coefficients of Π (t − r).
    fn with_roots(roots: &[f64]) -> Vec<f64> {
        let all = roots.iter().fold(vec![1.0], |p, r| product(&[-r, 1.0 - r], &p));
        unscaled(&all)
    }

    #[test]
    fn double_roots_change_no_sign() {
        assert!(sign_changes(&with_roots(&[0.25, 0.25]), 0.0).is_empty());
        assert_eq!(sign_changes(&[0.0; 5], 0.0), []);
        assert_eq!(sign_changes(&[-1.0, 1.0], 0.0), [0.5]);
        // Symmetric about the middle: the root lies where the interval is halved first.
        let found = sign_changes(&with_roots(&[0.5, 0.2, 0.8]), 0.0);
        assert_eq!(found.len(), 3);
        assert!((found[1] - 0.5).abs() < 1e-15);
    }

    proptest! {
        #[test]
        fn simple_roots_are_all_found(
            steps in prop::collection::vec(0.05f64..1.0, 2..8),
            outside in prop::collection::vec(1.2f64..3.0, 0..3),
        ) {
            let total: f64 = steps.iter().sum();
            let mut at = 0.0;
            let mut roots: Vec<f64> = steps[1..].iter().map(|s| { at += s / total; at }).collect();
            let inside = roots.clone();
            roots.extend(outside);
            let row = with_roots(&roots);
            let found = sign_changes(&row, 0.0);
            prop_assert_eq!(found.len(), inside.len());
            for (f, r) in found.iter().zip(&inside) {
                prop_assert!((f - r).abs() < 1e-7, "{f} {r}");
            }
        }
    }
}
