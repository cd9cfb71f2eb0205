//! Tokens of the text encodings of Inventor and VRML. Commas are blanks, `#` begins a comment.

use super::graph::parse_number;

/// A token; words borrow from the file.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Token<'a> {
    Word(&'a str),
    Number(f64),
    Text(String),
    /// One of `{ } [ ] ( ) = ~ |`.
    Sign(u8),
    End,
}

/// Reads tokens one at a time.
#[derive(Debug)]
pub(super) struct Lexer<'a> {
    bytes: &'a [u8],
    at: usize,
    pub line: u32,
}

impl<'a> Lexer<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0, line: 1 }
    }

    /// The next token without taking it.
    pub(super) fn peek(&mut self) -> Token<'a> {
        let (at, line) = (self.at, self.line);
        let token = self.next();
        (self.at, self.line) = (at, line);
        token
    }

    /// True where the next token is this sign; it is taken.
    pub(super) fn take(&mut self, sign: u8) -> bool {
        self.skip_blanks();
        let found = self.bytes.get(self.at) == Some(&sign);
        if found {
            self.at += 1;
        }
        found
    }

    pub(super) fn next(&mut self) -> Token<'a> {
        self.skip_blanks();
        let Some(&first) = self.bytes.get(self.at) else { return Token::End };
        if is_sign(first) {
            self.at += 1;
            return Token::Sign(first);
        }
        if first == b'"' {
            return self.text();
        }
        let rest = &self.bytes[self.at..];
        let length = rest.iter().position(|&b| !is_word(b)).unwrap_or(rest.len()).max(1);
        self.at += length;
        match std::str::from_utf8(&rest[..length]) {
            Ok(word) => parse_number(word).map_or(Token::Word(word), Token::Number),
            // Names in other encodings are never those of nodes and fields that are read.
            Err(_) => Token::Word("?"),
        }
    }

    /// Gives back the sign just taken.
    pub(super) fn give_back(&mut self) {
        self.at = self.at.saturating_sub(1);
    }

    /// Skips to the end of the line.
    pub(super) fn skip_line(&mut self) {
        let rest = &self.bytes[self.at..];
        self.at += memchr::memchr2(b'\n', b'\r', rest).unwrap_or(rest.len());
    }

    fn skip_blanks(&mut self) {
        while let Some(&b) = self.bytes.get(self.at) {
            match b {
                b'\n' => self.line += 1,
                b' ' | b'\t' | b'\r' | b',' | 0 | 0x0b | 0x0c => {}
                b'#' => {
                    self.skip_line();
                    continue;
                }
                0xef if self.bytes[self.at..].starts_with(&[0xef, 0xbb, 0xbf]) => self.at += 2,
                _ => return,
            }
            self.at += 1;
        }
    }

    fn text(&mut self) -> Token<'a> {
        let mut text = Vec::new();
        self.at += 1;
        while let Some(&b) = self.bytes.get(self.at) {
            self.at += 1;
            match b {
                b'"' => break,
                b'\\' => {
                    if let Some(&escaped) = self.bytes.get(self.at) {
                        self.line += u32::from(escaped == b'\n');
                        text.push(escaped);
                        self.at += 1;
                    }
                }
                _ => {
                    self.line += u32::from(b == b'\n');
                    text.push(b);
                }
            }
        }
        Token::Text(String::from_utf8_lossy(&text).into_owned())
    }
}

fn is_sign(b: u8) -> bool {
    matches!(b, b'{' | b'}' | b'[' | b']' | b'(' | b')' | b'=' | b'~' | b'|')
}

fn is_word(b: u8) -> bool {
    !is_sign(b) && !matches!(b, b' ' | b'\t' | b'\r' | b'\n' | b',' | b'"' | b'#' | 0 | 0x0b | 0x0c)
}
