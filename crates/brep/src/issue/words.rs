//! The words of sentences: plurals, lengths and numbers, written the same everywhere.

/// `1 face`, `3 faces`; `plural` is the whole plural form.
///
/// ```
/// use chordal_brep::issue::words::count;
/// assert_eq!(count(1, "face", "faces"), "1 face");
/// assert_eq!(count(0, "mesh", "meshes"), "0 meshes");
/// ```
pub fn count(n: usize, singular: &str, plural: &str) -> String {
    format!("{n} {}", if n == 1 { singular } else { plural })
}

/// A number with at most `digits` significant digits, as C's `%g` writes it: no trailing zeros, and an
/// exponent only where the plain form would be long.
///
/// ```
/// use chordal_brep::issue::words::number;
/// assert_eq!(number(0.55, 4), "0.55");
/// assert_eq!(number(1.3e-12, 4), "1.3e-12");
/// assert_eq!(number(1234567.0, 4), "1.235e6");
/// assert_eq!(number(0.0, 4), "0");
/// ```
pub fn number(value: f64, digits: usize) -> String {
    if value == 0.0 {
        return "0".into();
    }
    if !value.is_finite() {
        return if value.is_nan() {
            "unknown"
        } else if value > 0.0 {
            "infinite"
        } else {
            "-infinite"
        }
        .into();
    }
    let digits = digits.max(1);
    let scientific = format!("{value:.*e}", digits - 1);
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    if exponent < -4 || exponent >= digits.max(6) as i32 {
        return format!("{}e{exponent}", without_trailing_zeros(mantissa));
    }
    let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
    without_trailing_zeros(&format!("{value:.decimals$}")).to_owned()
}

/// A length in millimetres with four significant digits: `0.55 mm`.
pub fn length_mm(millimetres: f64) -> String {
    format!("{} mm", number(millimetres, 4))
}

fn without_trailing_zeros(text: &str) -> &str {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { text }
}
