//! Lines of 80 columns: which section each belongs to, and the file's forms that are refused.

/// A line: its text (columns 1 to 72), its number within its section, and its number in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Line<'a> {
    pub text: &'a [u8],
    pub sequence: u64,
    pub line: u32,
}

/// The lines of the file by section.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sections<'a> {
    pub global: Vec<Line<'a>>,
    pub directory: Vec<Line<'a>>,
    pub parameters: Vec<Line<'a>>,
    /// There is a terminate section.
    pub ended: bool,
    /// Lines that belong to no section, the first of them.
    pub stray: Option<u32>,
    /// The flag of the binary or compressed form.
    pub special: Option<u8>,
}

/// Columns of text before the section's letter.
const TEXT: usize = 72;

/// Lines end in any of the three ways; letters may be small.
pub(crate) fn split(bytes: &[u8]) -> impl Iterator<Item = (u32, &[u8])> {
    let mut rest = bytes;
    let mut number = 0;
    std::iter::from_fn(move || {
        if rest.is_empty() {
            return None;
        }
        number += 1;
        let end = memchr::memchr2(b'\n', b'\r', rest).unwrap_or(rest.len());
        let line = &rest[..end];
        let skip = match &rest[end..] {
            [b'\r', b'\n', ..] => 2,
            [_, ..] => 1,
            [] => 0,
        };
        rest = &rest[end + skip..];
        Some((number, line))
    })
}

/// The letter, text and sequence number of a line. Where the columns are shifted (tabs, cut blanks), the
/// letter before the number at the end of the line.
pub(crate) fn parsed(line: &[u8]) -> Option<(u8, &[u8], u64)> {
    let letter = |b: u8| matches!(b.to_ascii_uppercase(), b'S' | b'G' | b'D' | b'P' | b'T' | b'C' | b'B');
    if let Some(&found) = line.get(TEXT)
        && letter(found)
        && let Some(sequence) = number(&line[TEXT + 1..])
    {
        return Some((found.to_ascii_uppercase(), &line[..TEXT], sequence));
    }
    let end = line.trim_ascii_end();
    let digits = end.iter().rev().take_while(|b| b.is_ascii_digit()).count();
    let before = end[..end.len() - digits].trim_ascii_end();
    let found = *before.last().filter(|b| letter(**b))?;
    let sequence = number(&end[end.len() - digits..])?;
    Some((found.to_ascii_uppercase(), &before[..before.len() - 1], sequence))
}

/// The number that fills some columns, blanks aside.
pub(crate) fn number(columns: &[u8]) -> Option<u64> {
    std::str::from_utf8(columns.trim_ascii()).ok()?.parse().ok()
}

impl<'a> Sections<'a> {
    pub(crate) fn of(bytes: &'a [u8]) -> Self {
        let mut sections = Self::default();
        for (line, content) in split(bytes) {
            match parsed(content) {
                Some((b'S', ..)) => {}
                Some((b'G', text, sequence)) => sections.global.push(Line { text, sequence, line }),
                Some((b'D', text, sequence)) => sections.directory.push(Line { text, sequence, line }),
                Some((b'P', text, sequence)) => sections.parameters.push(Line { text, sequence, line }),
                Some((b'T', ..)) => {
                    sections.ended = true;
                    break;
                }
                Some((flag, ..)) if sections.global.is_empty() => sections.special = Some(flag),
                _ if content.trim_ascii().is_empty() => {}
                _ => sections.stray = sections.stray.or(Some(line)),
            }
        }
        sections
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_end_in_every_way() {
        let all: Vec<_> = split(b"a\r\nb\rc\n\nd").collect();
        assert_eq!(all, [(1, &b"a"[..]), (2, b"b"), (3, b"c"), (4, b""), (5, b"d")]);
    }

    #[test]
    fn columns_may_be_shifted() {
        let exact = format!("{:<72}P{:>7}", "110,1.,2.;", 7);
        assert_eq!(parsed(exact.as_bytes()).map(|(l, _, n)| (l, n)), Some((b'P', 7)));
        assert_eq!(parsed(b"110,1.,2.;      1P      7"), Some((b'P', &b"110,1.,2.;      1"[..], 7)));
        assert_eq!(parsed(b"no section"), None);
    }
}
