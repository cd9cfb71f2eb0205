//! The global section: delimiters, units, accuracy.

use super::lines::Line;
use super::parameters::{Record, Value, record};
use super::resynchronise::{Kind, contradicts, resynchronised};
use crate::encoding::Encoding;
use chordal_brep::{ReadIssue, Real};

/// The values of the global section.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Global {
    pub parameter_delimiter: u8,
    pub record_delimiter: u8,
    /// Millimetres per unit, the model's scale included.
    pub length_mm: f64,
    pub unit: String,
    /// The resolution of the writer, in file units.
    pub resolution: Option<f64>,
    pub version: i64,
    pub product: String,
    /// What had to be guessed.
    pub issues: Vec<ReadIssue>,
}

/// Millimetres and name by the flag of the file.
const UNITS: [(u8, f64, &str, &[&str]); 10] = [
    (1, 25.4, "inch", &["IN", "INCH"]),
    (2, 1.0, "mm", &["MM"]),
    (4, 304.8, "foot", &["FT", "FEET", "FOOT"]),
    (5, 1_609_344.0, "mile", &["MI"]),
    (6, 1e3, "m", &["M"]),
    (7, 1e6, "km", &["KM"]),
    (8, 0.0254, "mil", &["MIL"]),
    (9, 1e-3, "µm", &["UM"]),
    (10, 10.0, "cm", &["CM"]),
    (11, 2.54e-5, "microinch", &["UIN"]),
];

/// What the fields of the section hold.
const KINDS: [Kind; 26] = {
    let mut kinds = [Kind::Number; 26];
    let strings = [1, 2, 3, 4, 5, 6, 12, 15, 18, 21, 22, 25, 26];
    let mut i = 0;
    while i < strings.len() {
        kinds[strings[i] - 1] = Kind::Text;
        i += 1;
    }
    kinds
};

impl Global {
    pub(crate) fn read(lines: &[Line<'_>], encoding: Encoding) -> Self {
        let text: Vec<u8> = lines.iter().flat_map(|line| padded(line.text)).collect();
        let [parameter, end] = delimiters(&text);
        // The delimiters are parameters themselves: `1H,` and `1H;`, or left out.
        let mut issues = Vec::new();
        let Record { values, ended, .. } = section(&text, [parameter, end], &mut issues);
        if !ended {
            issues.push(ReadIssue::SectionTruncated {
                section: "G (global)",
                item: values.len(),
                cause: ReadIssue::Missing { what: "record delimiter" }.boxed(),
            });
        }
        let number = |i: usize| match values.get(i - 1) {
            Some(Value::Number(value)) => Some(*value),
            _ => None,
        };
        let string = |i: usize| match values.get(i - 1) {
            Some(Value::Text(text)) => encoding.decode(text).trim().to_owned(),
            _ => String::new(),
        };
        let (mut length_mm, unit) = unit(number(14), &string(15), &mut issues);
        match number(13) {
            Some(scale) if scale > 0.0 && scale.is_finite() => length_mm /= scale,
            None => {}
            Some(scale) => issues.push(ReadIssue::ScaleIgnored { scale: Real(scale) }),
        }
        Self {
            parameter_delimiter: parameter,
            record_delimiter: end,
            length_mm,
            unit,
            resolution: number(19).filter(|r| *r > 0.0 && r.is_finite()),
            version: number(23).unwrap_or(3.0) as i64,
            product: string(3),
            issues,
        }
    }

    /// The version as people write it.
    pub(crate) fn version_name(&self) -> &'static str {
        match self.version {
            ..=2 => "2.0",
            3 => "3.0",
            4 | 5 => "4.0",
            6 | 7 => "5.0",
            8 => "5.1",
            9 => "5.2",
            10 => "5.3",
            _ => "5.3 or later",
        }
    }
}

/// The fields of the section. Where they contradict what they must be, as behind a string whose count is
/// wrong, the delimiters decide.
fn section(text: &[u8], delimiters: [u8; 2], issues: &mut Vec<ReadIssue>) -> Record {
    let counted = record(text, delimiters[0], delimiters[1]);
    if !counted.contradicted && !contradicts(&counted, &KINDS) {
        return counted;
    }
    let Some(found) = resynchronised(text, delimiters, &KINDS) else {
        issues.push(ReadIssue::GlobalSectionShifted);
        return counted;
    };
    issues.extend(found.wrong_counts.iter().map(|wrong| wrong.issue("of the global section")));
    found
}

/// Lines as long as the section's columns: blanks at their ends may have been cut, and strings run on over
/// them.
pub(crate) fn padded(text: &[u8]) -> impl Iterator<Item = u8> {
    let blanks = 72usize.saturating_sub(text.len());
    text.iter().copied().chain(std::iter::repeat_n(b' ', blanks))
}

/// The two delimiters: `,` and `;` unless given as strings of one letter.
fn delimiters(text: &[u8]) -> [u8; 2] {
    let text = text.trim_ascii_start();
    match text {
        [b'1', b'H' | b'h', parameter, separator, rest @ ..] if separator == parameter => {
            let end = match rest.trim_ascii_start() {
                [b'1', b'H' | b'h', end, ..] => *end,
                _ => b';',
            };
            [*parameter, end]
        }
        [b',', b'1', b'H' | b'h', end, ..] => [b',', *end],
        _ => [b',', b';'],
    }
}

fn unit(flag: Option<f64>, name: &str, issues: &mut Vec<ReadIssue>) -> (f64, String) {
    let name = name.to_ascii_uppercase();
    let by_name = UNITS.iter().find(|(.., names)| names.contains(&name.as_str()));
    let by_flag = flag.and_then(|flag| UNITS.iter().find(|(code, ..)| f64::from(*code) == flag));
    let found = match (by_flag, by_name) {
        (Some(found), _) => found,
        (None, Some(found)) => found,
        (None, None) => {
            if flag.is_some_and(|flag| flag != 0.0) || !name.is_empty() {
                issues.push(ReadIssue::UnitUnknown { name, assumed: "inches" });
            }
            &UNITS[0]
        }
    };
    (found.1, found.2.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Global {
        Global::read(&[Line { text: text.as_bytes(), sequence: 1, line: 1 }], Encoding::Utf8)
    }

    #[test]
    fn units_and_scale() {
        let tail = "15H20090315.221637,1e-5,2.5,,,11;";
        let mm = read(&format!(",,4Hpart,1Hx,1Hy,1Hz,32,38,6,38,15,,2.,2,2HMM,1,0.1,{tail}"));
        assert_eq!((mm.length_mm, mm.unit.as_str(), mm.resolution), (0.5, "mm", Some(1e-5)));
        assert_eq!((mm.version_name(), mm.product.as_str()), ("5.3 or later", "part"));
        let default = read(&format!("1H,,1H;,4Hpart,1Hx,1Hy,1Hz,32,38,6,38,15,,1.,0,,1,0.1,{tail}"));
        assert_eq!((default.length_mm, default.issues.len()), (25.4, 0));
        let named = read(&format!("1H,,1H;,4Hpart,1Hx,1Hy,1Hz,32,38,6,38,15,,1.,3,2HCM,1,0.1,{tail}"));
        assert_eq!(named.length_mm, 10.0);
    }

    #[test]
    fn a_wrong_count_does_not_shift_the_unit() {
        let tail = "15H20090315.221637,1e-5,2.5,,,11;";
        // Into the next field but one, to a delimiter, and beyond the whole section.
        for product in ["11Hpart", "8Hpart", "900Hpart", "2Hpart"] {
            let found = read(&format!(",,{product},1Hx,1Hy,1Hz,32,38,6,38,15,,2.,2,2HMM,1,0.1,{tail}"));
            let codes: Vec<&str> = found.issues.iter().map(ReadIssue::code).collect();
            assert_eq!(codes, ["string-count"], "{product}");
            assert_eq!((found.product.as_str(), found.length_mm, found.unit.as_str()), ("part", 0.5, "mm"));
        }
        let hopeless = read(&format!(",,4Hpart,1Hx,1Hy,1Hz,x,38,6,38,15,,2.,2,2HMM,1,0.1,{tail}"));
        let codes: Vec<&str> = hopeless.issues.iter().map(ReadIssue::code).collect();
        assert_eq!((codes, hopeless.length_mm), (vec!["global-section-shifted"], 0.5));
    }

    #[test]
    fn other_delimiters() {
        let odd = read("1H/,1H#,".replace(',', "/").as_str());
        assert_eq!((odd.parameter_delimiter, odd.record_delimiter), (b'/', b'#'));
    }
}
