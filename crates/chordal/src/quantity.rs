//! Lengths, angles and tolerances as people write them: `0.1mm`, `0.05%`, `20deg`, `off`.

use std::fmt;
use std::str::FromStr;

/// How far the mesh may lie from the exact surfaces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tolerance {
    /// A distance in millimetres.
    Millimetres(f64),
    /// A percentage of the diagonal of the tight axis-aligned box of the whole placed model.
    Percent(f64),
}

impl Default for Tolerance {
    /// 0.1 %.
    fn default() -> Self {
        Tolerance::Percent(0.1)
    }
}

impl fmt::Display for Tolerance {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Tolerance::Millimetres(mm) => write!(f, "{mm} mm"),
            Tolerance::Percent(percent) => write!(f, "{percent} %"),
        }
    }
}

/// Why a quantity cannot be read; the message is one sentence.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum QuantityError {
    /// The text does not begin with a number.
    #[error("`{text}` does not begin with a number")]
    NoNumber {
        /// The text.
        text: String,
    },
    /// The number is zero, negative or infinite.
    #[error("`{text}` is not greater than zero")]
    NotPositive {
        /// The text.
        text: String,
    },
    /// The unit is no unit of length.
    #[error("`{unit}` is no unit of length (use mm, um, cm, m, in or ft)")]
    UnknownLengthUnit {
        /// The unit.
        unit: String,
    },
    /// The unit is no unit of angle.
    #[error("`{unit}` is no unit of angle (use deg or rad, or the word off)")]
    UnknownAngleUnit {
        /// The unit.
        unit: String,
    },
    /// The text is neither a percentage nor a length.
    #[error("`{text}` is neither a percentage nor a length")]
    NoTolerance {
        /// The text.
        text: String,
    },
}

const LENGTH_UNITS: [(&str, f64); 11] = [
    ("nm", 1e-6),
    ("um", 1e-3),
    ("µm", 1e-3),
    ("μm", 1e-3),
    ("mm", 1.0),
    ("cm", 10.0),
    ("m", 1000.0),
    ("mil", 0.0254),
    ("in", 25.4),
    ("inch", 25.4),
    ("ft", 304.8),
];

/// Reads a length such as `0.1mm`, `50um` or `0.002in`; a bare number is in millimetres.
///
/// # Errors
/// Where the text is no number, has an unknown unit, or is not greater than zero.
pub fn parse_length(text: &str) -> Result<f64, QuantityError> {
    let (number, unit) = split(text)?;
    let factor = match unit {
        "" => 1.0,
        _ => LENGTH_UNITS
            .iter()
            .find(|(name, _)| *name == unit)
            .map(|&(_, factor)| factor)
            .ok_or_else(|| QuantityError::UnknownLengthUnit { unit: unit.to_owned() })?,
    };
    positive(number * factor, text)
}

/// Reads an angle such as `20deg`, `20°` or `0.35rad`; a bare number is in degrees. `off`, and 180° or more,
/// is no limit.
///
/// Returns radians.
///
/// # Errors
/// Where the text is no number, has an unknown unit, or is not greater than zero.
pub fn parse_angle(text: &str) -> Result<Option<f64>, QuantityError> {
    if text.trim() == "off" {
        return Ok(None);
    }
    let (number, unit) = split(text)?;
    let radians = match unit {
        "" | "deg" | "°" => number.to_radians(),
        "rad" => number,
        _ => return Err(QuantityError::UnknownAngleUnit { unit: unit.to_owned() }),
    };
    let radians = positive(radians, text)?;
    Ok((radians < std::f64::consts::PI).then_some(radians))
}

impl FromStr for Tolerance {
    type Err = QuantityError;

    fn from_str(text: &str) -> Result<Self, QuantityError> {
        match text.trim().strip_suffix('%') {
            Some(number) => {
                let (number, rest) = split(number)?;
                if !rest.is_empty() {
                    return Err(QuantityError::NoTolerance { text: text.to_owned() });
                }
                positive(number, text).map(Tolerance::Percent)
            }
            None => parse_length(text).map(Tolerance::Millimetres),
        }
    }
}

/// The number at the front of `text`, and the unit that follows it.
fn split(text: &str) -> Result<(f64, &str), QuantityError> {
    let text = text.trim();
    let bytes = text.as_bytes();
    let exponent = |i: usize| {
        matches!(bytes[i], b'e' | b'E')
            && matches!(bytes.get(i + 1), Some(b'0'..=b'9' | b'+' | b'-'))
            && i > 0
            && matches!(bytes[i - 1], b'0'..=b'9' | b'.')
    };
    let sign = |i: usize| matches!(bytes[i], b'+' | b'-') && (i == 0 || matches!(bytes[i - 1], b'e' | b'E'));
    let end = (0..bytes.len())
        .find(|&i| !(matches!(bytes[i], b'0'..=b'9' | b'.') || exponent(i) || sign(i)))
        .unwrap_or(bytes.len());
    let number = text[..end].parse().map_err(|_| QuantityError::NoNumber { text: text.to_owned() })?;
    Ok((number, text[end..].trim()))
}

fn positive(value: f64, text: &str) -> Result<f64, QuantityError> {
    if value > 0.0 && value.is_finite() {
        Ok(value)
    } else {
        Err(QuantityError::NotPositive { text: text.trim().to_owned() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_in_millimetres() {
        for (text, mm) in
            [("0.1", 0.1), ("0.1mm", 0.1), (" 2 cm", 20.0), ("1e-2in", 0.254), ("50um", 0.05), ("1m", 1e3)]
        {
            let found = parse_length(text).expect(text);
            assert!((found - mm).abs() < 1e-12 * mm, "{text}: {found}");
        }
        for text in
            ["", "mm", "0", "-1mm", "1e400", "nan", "inf", "1 parsec", "1,5mm", "0.1mm mm", "1e", "--1", "5%"]
        {
            assert!(parse_length(text).is_err(), "{text}");
        }
    }

    #[test]
    fn angles_are_in_degrees_unless_they_say_otherwise() {
        assert_eq!(parse_angle("off"), Ok(None));
        assert_eq!(parse_angle("180deg"), Ok(None));
        assert_eq!(parse_angle("90"), Ok(Some(std::f64::consts::FRAC_PI_2)));
        assert_eq!(parse_angle("0.5rad"), Ok(Some(0.5)));
        for text in ["0", "-5deg", "twenty", "20grad", "20mm"] {
            assert!(parse_angle(text).is_err(), "{text}");
        }
    }

    #[test]
    fn tolerances_are_lengths_or_percentages() {
        assert_eq!("0.05%".parse(), Ok(Tolerance::Percent(0.05)));
        assert_eq!("0.05 %".parse(), Ok(Tolerance::Percent(0.05)));
        assert_eq!("0.1mm".parse(), Ok(Tolerance::Millimetres(0.1)));
        assert!("1mm%".parse::<Tolerance>().is_err());
        assert!("0%".parse::<Tolerance>().is_err());
        assert!("%".parse::<Tolerance>().is_err());
    }

    #[test]
    fn errors_can_be_matched() {
        let error = |text: &str| text.parse::<Tolerance>().expect_err(text);
        assert!(matches!(error("wide"), QuantityError::NoNumber { .. }));
        assert!(matches!(error("-1mm"), QuantityError::NotPositive { .. }));
        assert!(matches!(error("1 parsec"), QuantityError::UnknownLengthUnit { unit } if unit == "parsec"));
        assert!(matches!(error("1mm%"), QuantityError::NoTolerance { .. }));
        assert!(matches!(parse_angle("1grad"), Err(QuantityError::UnknownAngleUnit { .. })));
    }
}
