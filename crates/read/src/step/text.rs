//! Strings of Part 21: the control directives `\X2\…\X0\`, `\X4\…\X0\`, `\X\hh`, `\S\c`, `\P.\`, doubled
//! quotes and backslashes; raw UTF-8 and Latin-1 bytes are accepted too.

/// The text of the raw bytes between two quotes.
pub(crate) fn decode(raw: &[u8]) -> String {
    if !raw.iter().any(|&b| b == b'\\' || b == b'\'' || b >= 0x80 || b == b'\n' || b == b'\r') {
        return raw.iter().map(|&b| char::from(b)).collect();
    }
    let unescaped = unescape(raw);
    unescaped.replace(['\n', '\r'], "")
}

fn unescape(raw: &[u8]) -> String {
    let mut out = String::with_capacity(raw.len());
    let mut rest = raw;
    while let Some(&b) = rest.first() {
        let used = match b {
            b'\'' => {
                out.push('\'');
                if rest.starts_with(b"''") { 2 } else { 1 }
            }
            b'\\' => directive(rest, &mut out),
            0..=0x7f => {
                out.push(char::from(b));
                1
            }
            _ => high_byte(rest, &mut out),
        };
        rest = &rest[used..];
    }
    out
}

/// A UTF-8 sequence where it is one, else a Latin-1 byte.
fn high_byte(rest: &[u8], out: &mut String) -> usize {
    for length in 2..=4usize.min(rest.len()) {
        if let Ok(text) = std::str::from_utf8(&rest[..length]) {
            out.push_str(text);
            return length;
        }
    }
    out.push(char::from(rest[0]));
    1
}

/// Writes what the directive at the start of `rest` stands for; returns its length (at least 1).
fn directive(rest: &[u8], out: &mut String) -> usize {
    if rest.starts_with(b"\\\\") {
        out.push('\\');
        return 2;
    }
    if rest.starts_with(b"\\S\\") && rest.len() > 3 {
        out.push(char::from(rest[3] | 0x80));
        return 4;
    }
    if rest.starts_with(b"\\P") && rest.get(3) == Some(&b'\\') {
        return 4;
    }
    if rest.starts_with(b"\\X\\") {
        if let Some(code) = rest.get(3..5).and_then(hex) {
            out.extend(char::from_u32(code));
            return 5;
        }
        return 3;
    }
    for (start, width) in [(b"\\X2\\", 4), (b"\\X4\\", 8)] {
        if rest.starts_with(start) {
            return wide(rest, width, out);
        }
    }
    out.push('\\');
    1
}

/// The body of `\X2\` (`width` 4, UTF-16) or `\X4\` (`width` 8) up to `\X0\` or the first digit that is none.
fn wide(rest: &[u8], width: usize, out: &mut String) -> usize {
    let mut at = 4;
    let mut units = Vec::new();
    while let Some(code) = rest.get(at..at + width).and_then(hex) {
        if width == 4 {
            units.push(code as u16);
        } else {
            out.push(char::from_u32(code).unwrap_or(char::REPLACEMENT_CHARACTER));
        }
        at += width;
    }
    out.extend(char::decode_utf16(units).map(|unit| unit.unwrap_or(char::REPLACEMENT_CHARACTER)));
    if rest[at..].starts_with(b"\\X0\\") { at + 4 } else { at }
}

fn hex(digits: &[u8]) -> Option<u32> {
    digits.iter().try_fold(0u32, |value, &b| Some((value << 4) | char::from(b).to_digit(16)?))
}

#[cfg(test)]
mod tests {
    use super::decode;

    #[test]
    fn directives() {
        assert_eq!(decode(b"plain"), "plain");
        assert_eq!(decode(b"it''s"), "it's");
        assert_eq!(decode(b"a\\\\b"), "a\\b");
        assert_eq!(decode(b"\\X2\\0414043504420430043B044C\\X0\\1"), "Деталь1");
        assert_eq!(decode(b"\\X4\\0001F600\\X0\\"), "😀");
        assert_eq!(decode(b"\\X2\\D83DDE00\\X0\\"), "😀");
        assert_eq!(decode(b"\\X\\E4"), "ä");
        assert_eq!(decode(b"\\S\\d"), "ä");
        assert_eq!(decode(b"\\PA\\x"), "x");
        assert_eq!(decode("größe".as_bytes()), "größe");
        assert_eq!(decode(b"gr\xf6\xdfe"), "größe");
        assert_eq!(decode(b"cut \\X2\\041"), "cut 041");
        assert_eq!(decode(b"wrapped\r\nline"), "wrappedline");
    }
}
