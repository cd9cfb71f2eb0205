//! Free-form parameters: numbers and strings between delimiters.

use crate::number;
use chordal_brep::ReadIssue;

/// One parameter.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Value {
    /// Left out: its default is meant.
    Omitted,
    Number(f64),
    Text(Vec<u8>),
    /// Neither number nor string.
    Bad,
}

/// Parameters of one record, and whether its end was found.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Record {
    pub values: Vec<Value>,
    pub ended: bool,
    /// The count of a string leads to a place where no field can end.
    pub contradicted: bool,
    /// Counts that were not used.
    pub wrong_counts: Vec<WrongCount>,
}

/// A string whose count is not its length.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct WrongCount {
    /// The number of the field, from 1.
    pub field: usize,
    pub count: usize,
    pub length: usize,
}

impl WrongCount {
    pub(crate) fn issue(self, owner: &'static str) -> ReadIssue {
        ReadIssue::StringCount { field: self.field, owner, counted: self.count, length: self.length }
    }
}

/// Splits text at the delimiters, up to the end of the record. Strings (`5Hhello`) may hold delimiters.
pub(crate) fn record(text: &[u8], parameter: u8, end: u8) -> Record {
    let mut found = Record::default();
    let mut at = 0;
    while at < text.len() {
        at += text[at..].iter().take_while(|b| b.is_ascii_whitespace()).count();
        let (value, length) = match string(&text[at..]) {
            Some((content, length)) => (Value::Text(content.to_vec()), length),
            None => (Value::Omitted, 0),
        };
        let rest = &text[at + length..];
        let stop = rest.iter().position(|&b| b == parameter || b == end).unwrap_or(rest.len());
        let nothing_behind = stop < rest.len() && rest[..stop].trim_ascii().is_empty();
        found.contradicted |= length > 0 && !nothing_behind;
        found.values.push(if length > 0 { value } else { plain(&rest[..stop]) });
        at += length + stop;
        match text.get(at) {
            Some(&b) if b == end => {
                found.ended = true;
                return found;
            }
            _ => at += 1,
        }
    }
    found
}

/// A string with its count, and how many bytes it takes.
fn string(text: &[u8]) -> Option<(&[u8], usize)> {
    let (count, start) = counted(text)?;
    let end = (start + count).min(text.len());
    Some((&text[start..end], end))
}

/// The count of a string, and how many bytes stand before its text.
pub(crate) fn counted(text: &[u8]) -> Option<(usize, usize)> {
    let digits = text.iter().take_while(|b| b.is_ascii_digit()).count();
    if digits == 0 || digits > 6 || !matches!(text.get(digits), Some(b'H' | b'h')) {
        return None;
    }
    let count = std::str::from_utf8(&text[..digits]).ok()?.parse().ok()?;
    Some((count, digits + 1))
}

pub(crate) fn plain(text: &[u8]) -> Value {
    let text = text.trim_ascii();
    if text.is_empty() {
        return Value::Omitted;
    }
    match number::parse(text) {
        Some((value, length)) if length == text.len() => Value::Number(value),
        // Blanks within a number, where a line was broken.
        _ => {
            let joined: Vec<u8> = text.iter().copied().filter(|b| !b.is_ascii_whitespace()).collect();
            match number::parse(&joined) {
                Some((value, length)) if length == joined.len() => Value::Number(value),
                _ => Value::Bad,
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strings_hold_delimiters() {
        let found = record(b"3H,;x, 1.5D0,,-3; 7", b',', b';');
        let expected =
            [Value::Text(b",;x".to_vec()), Value::Number(1.5), Value::Omitted, Value::Number(-3.0)];
        assert_eq!(found, Record { values: expected.to_vec(), ended: true, ..Record::default() });
    }

    #[test]
    fn numbers_broken_over_lines() {
        let found = record(b"1.2 34,x", b',', b';');
        assert_eq!(found.values, [Value::Number(1.234), Value::Bad]);
        assert!(!found.ended);
    }
}
