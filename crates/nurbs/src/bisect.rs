//! Roots by bisection.

/// A sign change of `f` between `a` and `b`, where f has different signs (zero counts as positive), after so
/// many `halvings` of the interval; about 60 reach the last bits.
pub fn bisect(f: impl Fn(f64) -> f64, mut a: f64, mut b: f64, halvings: u32) -> f64 {
    let negative = f(a) < 0.0;
    for _ in 0..halvings {
        let middle = 0.5 * (a + b);
        if (f(middle) < 0.0) == negative { a = middle } else { b = middle }
    }
    0.5 * (a + b)
}
