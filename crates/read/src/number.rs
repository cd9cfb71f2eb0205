//! Numbers of Part 21, and the odd ones that real files hold (`1`, `1.`, `.5`, `1.E+5`, `1.D0`).
//!
//! The fast path is exact: a mantissa under 2^53 and a power of ten up to 10^22 are both exact in f64, so one
//! multiplication or division rounds once. Everything else goes through the standard library.

const EXACT_POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18,
    1e19, 1e20, 1e21, 1e22,
];

/// The number at the start of `text` and its length in bytes; `None` where there is none. The value may be infinite.
pub(crate) fn parse(text: &[u8]) -> Option<(f64, usize)> {
    let mut at = 0;
    let negative = text.first() == Some(&b'-');
    if matches!(text.first(), Some(b'-' | b'+')) {
        at = 1;
    }
    let start = at;
    let mut digits = Digits::default();
    let mut any = digits.take(text, &mut at, 0);
    if text.get(at) == Some(&b'.') {
        at += 1;
        any |= digits.take(text, &mut at, -1);
    }
    if !any {
        return None;
    }
    let exponent = exponent(text, &mut at);
    let power = digits.scale.saturating_add(exponent);
    let value = if digits.exact && digits.mantissa < (1 << 53) && power.unsigned_abs() <= 22 {
        let factor = EXACT_POWERS[power.unsigned_abs() as usize];
        if power < 0 { digits.mantissa as f64 / factor } else { digits.mantissa as f64 * factor }
    } else {
        slow(&text[start..at])
    };
    Some((if negative { -value } else { value }, at))
}

/// The exponent behind `at`, which it passes over; 0 where there is none.
fn exponent(text: &[u8], at: &mut usize) -> i64 {
    if !matches!(text.get(*at), Some(b'e' | b'E' | b'd' | b'D')) {
        return 0;
    }
    let mut p = *at + 1;
    let negative = text.get(p) == Some(&b'-');
    if matches!(text.get(p), Some(b'-' | b'+')) {
        p += 1;
    }
    let mut value = 0i64;
    while let Some(d) = text.get(p).map(|b| b.wrapping_sub(b'0')).filter(|&d| d < 10) {
        value = (value * 10 + i64::from(d)).min(1_000_000);
        p += 1;
    }
    *at = p;
    if negative { -value } else { value }
}

/// Digits read so far: `mantissa · 10^scale`, trailing zeros kept apart so that `48.0000000000000000` stays small.
struct Digits {
    mantissa: u64,
    scale: i64,
    /// Zeros behind the mantissa's last digit that count only if another digit follows.
    zeros: u32,
    /// The mantissa holds all digits.
    exact: bool,
}

impl Default for Digits {
    fn default() -> Self {
        Self { mantissa: 0, scale: 0, zeros: 0, exact: true }
    }
}

impl Digits {
    /// Takes the digits at `at`, each worth `step` powers of ten less than the one before (0 before the point, -1
    /// behind it); false where there are none.
    fn take(&mut self, text: &[u8], at: &mut usize, step: i64) -> bool {
        let start = *at;
        while let Some(d) = text.get(*at).map(|b| b.wrapping_sub(b'0')).filter(|&d| d < 10) {
            *at += 1;
            if d == 0 {
                self.zeros += 1;
            } else {
                self.push(u64::from(d));
            }
            self.scale += step;
        }
        if step == 0 {
            // Zeros before the point belong to the value whether or not digits follow.
            self.flush();
        } else {
            // Trailing zeros behind the point do not: undo their part of the scale.
            self.scale += i64::from(self.zeros);
            self.zeros = 0;
        }
        *at > start
    }

    fn push(&mut self, d: u64) {
        self.flush();
        match self.mantissa.checked_mul(10).and_then(|m| m.checked_add(d)) {
            Some(m) => self.mantissa = m,
            None => self.exact = false,
        }
    }

    /// Puts the pending zeros into the mantissa.
    fn flush(&mut self) {
        if self.zeros == 0 {
            return;
        }
        if self.mantissa != 0 {
            match 10u64.checked_pow(self.zeros).and_then(|p| self.mantissa.checked_mul(p)) {
                Some(m) => self.mantissa = m,
                None => self.exact = false,
            }
        }
        self.zeros = 0;
    }
}

/// The number that fills `text`, which has no sign.
fn slow(text: &[u8]) -> f64 {
    if let Some(value) = std::str::from_utf8(text).ok().and_then(|text| text.parse().ok()) {
        return value;
    }
    // What the standard library does not take: `1.D3`, `1.E`.
    let mut clean: String =
        text.iter().map(|&b| if matches!(b, b'd' | b'D') { 'e' } else { char::from(b) }).collect();
    if clean.ends_with(['e', 'E', '+', '-']) {
        clean.push('0');
    }
    clean.parse().unwrap_or(f64::NAN)
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
