//! Numbers of Part 21, and the odd ones that real files hold (`1`, `1.`, `.5`, `1.E+5`, `1.D0`).

/// The number at the start of `text` and its length in bytes; `None` where there is none. The value may be
/// infinite.
pub(crate) fn parse(text: &[u8]) -> Option<(f64, usize)> {
    // The crate reads words for infinity too, and no plus.
    let is_signed = matches!(text.first(), Some(b'-' | b'+'));
    if !matches!(text.get(usize::from(is_signed)), Some(b'0'..=b'9' | b'.')) {
        return None;
    }
    let plus = usize::from(text.first() == Some(&b'+'));
    let (value, length) = fast_float2::parse_partial(&text[plus..]).ok()?;
    let end = plus + length;
    match text.get(end) {
        Some(b'e' | b'E' | b'd' | b'D') => Some(with_odd_exponent(text, value, end)),
        _ => Some((value, end)),
    }
}

/// A number whose exponent starts at `at` and is none of C's: Fortran's `D`, or a letter without digits,
/// which is passed over.
fn with_odd_exponent(text: &[u8], mantissa: f64, at: usize) -> (f64, usize) {
    let digits = at + 1 + usize::from(matches!(text.get(at + 1), Some(b'-' | b'+')));
    let end = digits + text[digits..].iter().take_while(|b| b.is_ascii_digit()).count();
    if end == digits {
        return (mantissa, end);
    }
    let mut of_c = text[..end].to_vec();
    of_c[at] = b'e';
    let signed = &of_c[usize::from(text.first() == Some(&b'+'))..];
    (fast_float2::parse(signed).unwrap_or(f64::NAN), end)
}

#[cfg(test)]
mod tests {
    use super::parse;
    use chordal_nurbs::math;
    use proptest::prelude::*;

    #[test]
    fn odd_spellings() {
        for (text, value) in [
            ("1", 1.0),
            ("1.", 1.0),
            (".5", 0.5),
            ("1.E+5", 1e5),
            ("-1.E-5", -1e-5),
            ("1.D3", 1e3),
            ("0.E+000", 0.0),
            ("1.E", 1.0),
            ("1.E+", 1.0),
            ("+2.5", 2.5),
            ("-2.5D-1", -0.25),
            ("+.5d+01", 5.0),
            ("123456789012345678901234567890.", 123456789012345678901234567890.0),
            ("0.00000000000000000000000000000123456789012345678", 1.234_567_890_123_456_8e-30),
            ("1e999", f64::INFINITY),
            ("1e-999", 0.0),
            ("48.00000000000000000", 48.0),
            ("0.10000000000000000000000000", 0.1),
            ("1000000000000000000000.", 1e21),
            ("100.0010", 100.001),
            ("-0.0000000000000000000", 0.0),
            ("1e99999999999999999999", f64::INFINITY),
        ] {
            assert_eq!(parse(text.as_bytes()), Some((value, text.len())), "{text}");
        }
        assert_eq!(parse(b"."), None);
        assert_eq!(parse(b"-"), None);
        assert_eq!(parse(b""), None);
        assert_eq!(parse(b"+-1"), None);
        assert_eq!(parse(b"-inf"), None);
        assert_eq!(parse(b"infinity"), None);
        assert_eq!(parse(b"NaN"), None);
        assert_eq!(parse(b"1.#QNAN"), Some((1.0, 2)));
    }

    proptest! {
        #[test]
        fn equals_the_standard_library(bits in any::<u64>(), decimals in 0usize..20, scale in -30i32..30) {
            let exact = f64::from_bits(bits);
            prop_assume!(exact.is_finite());
            let text = format!("{exact:e}");
            prop_assert_eq!(parse(text.as_bytes()), Some((exact, text.len())));
            let moderate = (bits as f64 / 1e19) * math::powi(10.0, scale);
            let text = format!("{moderate:.decimals$}");
            prop_assert_eq!(parse(text.as_bytes()), Some((text.parse().expect("a number"), text.len())));
        }
    }
}
