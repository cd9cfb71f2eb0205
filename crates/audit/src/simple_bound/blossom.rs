//! Blossoms of B-splines over a triangle of parameters.
//!
//! A polynomial of degree d in one parameter has a *blossom*: the symmetric function of d parameters, affine
//! in each, that agrees with it where all are equal (Ramshaw 1989). Over a triangle with the parameters t₀ t₁
//! t₂ at its corners, its Bernstein coefficient of index (a, b, c) is the blossom of a times t₀, b times t₁, c
//! times t₂. As a combination of control points it is what de Boor's recursion gives with these parameters at
//! its levels.

/// The largest degree in one parameter: beyond, the products take longer than the mesher's bound.
pub(super) const MOST_DEGREE: usize = 5;

/// The combination of the control points of a span, for one coefficient.
pub(super) type Weights = [f64; MOST_DEGREE + 1];

/// The indices (a, b, c) with the sum `degree`, in the order in which coefficients are kept.
pub(super) fn indices(degree: usize) -> impl Iterator<Item = [usize; 3]> {
    (0..=degree).flat_map(move |a| (0..=degree - a).map(move |b| [a, b, degree - a - b]))
}

/// The place of an index in that order.
pub(super) fn place(degree: usize, [a, b, _]: [usize; 3]) -> usize {
    a * (2 * degree + 3 - a) / 2 + b
}

/// Of every coefficient over a triangle with these parameters at its corners, the combination of the control
/// points span − degree … span.
pub(super) fn weights(knots: &[f64], degree: usize, span: usize, t: [f64; 3], out: &mut Vec<Weights>) {
    let mut gaps = [[0.0; MOST_DEGREE]; MOST_DEGREE];
    for level in 1..=degree {
        for r in 0..level {
            gaps[level - 1][r] = 1.0 / (knots[span + 1 + r] - knots[span + 1 + r - level]);
        }
    }
    out.clear();
    out.extend(indices(degree).map(|[a, b, _]| {
        let mut n = [0.0; MOST_DEGREE + 1];
        n[0] = 1.0;
        for level in 1..=degree {
            let t = if level <= a {
                t[0]
            } else if level <= a + b {
                t[1]
            } else {
                t[2]
            };
            let mut saved = 0.0;
            for r in 0..level {
                let share = n[r] * gaps[level - 1][r];
                n[r] = saved + (knots[span + 1 + r] - t) * share;
                saved = (t - knots[span + 1 + r - level]) * share;
            }
            n[level] = saved;
        }
        n
    }));
}

/// Of the products of two Bernstein polynomials over a triangle, each with the place of its own and its
/// factor; the first index runs slowest.
pub(super) fn products([p, q]: [usize; 2]) -> Vec<(usize, f64)> {
    let mut found = Vec::new();
    for a in indices(p) {
        for b in indices(q) {
            let c = std::array::from_fn(|i| a[i] + b[i]);
            found.push((place(p + q, c), ways(p, a) * ways(q, b) / ways(p + q, c)));
        }
    }
    found
}

/// The multinomial coefficient.
fn ways(degree: usize, [a, b, c]: [usize; 3]) -> f64 {
    let factorial = |n: usize| (1..=n).map(|k| k as f64).product::<f64>();
    factorial(degree) / (factorial(a) * factorial(b) * factorial(c))
}
