//! Numbers in text files: the fewest digits that read back as the same 64-bit float (17 at most).

use std::io::Write;

/// Appends `value`, in exponent form where positions would be mostly zeros.
pub(crate) fn push_number(text: &mut Vec<u8>, value: f64) {
    let size = value.abs();
    let written = if value == 0.0 {
        text.push(b'0');
        Ok(())
    } else if (1e-5..1e17).contains(&size) {
        write!(text, "{value}")
    } else {
        write!(text, "{value:e}")
    };
    written.expect("writing to memory cannot fail");
}

/// Appends three numbers, each after a blank.
pub(crate) fn push_point(text: &mut Vec<u8>, p: glam::DVec3) {
    for value in p.to_array() {
        text.push(b' ');
        push_number(text, value);
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn text_of(value: f64) -> String {
        let mut text = Vec::new();
        push_number(&mut text, value);
        String::from_utf8(text).unwrap()
    }

    #[test]
    fn short_numbers_stay_short() {
        for (value, text) in [
            (0.0, "0"),
            (-0.0, "0"),
            (1.0, "1"),
            (-2.5, "-2.5"),
            (0.1, "0.1"),
            (1e-7, "1e-7"),
            (1e300, "1e300"),
        ] {
            assert_eq!(text_of(value), text);
        }
    }

    proptest! {
        #[test]
        fn every_number_reads_back(bits in any::<u64>()) {
            let value = f64::from_bits(bits);
            prop_assume!(value.is_finite());
            let text = text_of(value);
            prop_assert_eq!(text.parse::<f64>().unwrap(), value);
            prop_assert!(text.bytes().filter(u8::is_ascii_digit).count() <= 25);
        }
    }
}
