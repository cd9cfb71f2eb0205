//! The file as words and numbers between blanks.

use crate::number;
use chordal_brep::ReadIssue;

/// The text cannot be followed from here on: what was expected, and at which line.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Stop {
    pub line: u32,
    pub issue: ReadIssue,
}

/// A place in the file.
#[derive(Clone, Debug)]
pub(crate) struct Tokens<'a> {
    bytes: &'a [u8],
    at: usize,
    line: u32,
}

impl<'a> Tokens<'a> {
    pub(crate) fn new(bytes: &'a [u8], line: u32) -> Self {
        Self { bytes, at: 0, line }
    }

    /// The line of the next token.
    pub(crate) fn line(&mut self) -> u32 {
        self.skip_blanks();
        self.line
    }

    fn skip_blanks(&mut self) {
        while let Some(byte) = self.bytes.get(self.at).filter(|b| b.is_ascii_whitespace() || **b == 0) {
            self.line += u32::from(*byte == b'\n');
            self.at += 1;
        }
    }

    pub(crate) fn stop(&mut self, expected: &'static str) -> Stop {
        let line = self.line();
        let word = self.peek();
        let found = String::from_utf8_lossy(&word[..word.len().min(20)]).into_owned();
        Stop { line, issue: ReadIssue::Expected { expected, found } }
    }

    /// The next word, empty at the end of the file; it is not passed over.
    pub(crate) fn peek(&mut self) -> &'a [u8] {
        self.skip_blanks();
        let rest = &self.bytes[self.at..];
        let end = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        &rest[..end]
    }

    pub(crate) fn word(&mut self) -> &'a [u8] {
        let word = self.peek();
        self.at += word.len();
        word
    }

    /// Passes over the next word where it is `word`.
    pub(crate) fn take(&mut self, word: &[u8]) -> bool {
        let found = self.peek() == word;
        if found {
            self.at += word.len();
        }
        found
    }

    /// A number; NaN where something stands there that cannot be one.
    ///
    /// # Errors
    /// At the end of the file and at the keyword of another section.
    pub(crate) fn real(&mut self) -> Result<f64, Stop> {
        let word = self.peek();
        match number::parse(word) {
            Some((value, length)) if length == word.len() => {
                self.at += length;
                Ok(value)
            }
            _ if word.is_empty() || (word[0].is_ascii_alphabetic() && !is_not_a_number(word)) => {
                Err(self.stop("a number"))
            }
            _ => {
                self.at += word.len();
                Ok(f64::NAN)
            }
        }
    }

    /// A whole number; what follows it in the same word stays (`2CN`).
    ///
    /// # Errors
    /// Where there is none.
    pub(crate) fn integer(&mut self) -> Result<i64, Stop> {
        self.skip_blanks();
        let rest = &self.bytes[self.at..];
        let sign = usize::from(matches!(rest.first(), Some(b'-' | b'+')));
        let digits = rest[sign..].iter().take_while(|b| b.is_ascii_digit()).count();
        let text = std::str::from_utf8(&rest[..sign + digits]).unwrap_or_default();
        match text.parse() {
            Ok(value) => {
                self.at += sign + digits;
                Ok(value)
            }
            Err(_) => Err(self.stop("a whole number")),
        }
    }

    /// A whole number that is not negative.
    ///
    /// # Errors
    /// Where there is none.
    pub(crate) fn count(&mut self) -> Result<usize, Stop> {
        let value = self.integer()?;
        usize::try_from(value).map_err(|_| self.stop("a number that is not negative"))
    }

    /// 0 or 1.
    ///
    /// # Errors
    /// Where there is something else.
    pub(crate) fn flag(&mut self) -> Result<bool, Stop> {
        Ok(self.integer()? != 0)
    }

    /// The continuity that an edge has between two surfaces (`C0`, `G1`, `CN`), which may stand right behind
    /// a number.
    ///
    /// # Errors
    /// Where there is none.
    pub(crate) fn continuity(&mut self) -> Result<(), Stop> {
        match *self.peek() {
            [b'C' | b'G', _, ..] => {
                self.at += 2;
                Ok(())
            }
            _ => Err(self.stop("a continuity")),
        }
    }

    /// Moves to the next line that begins with `keyword`; false, unmoved, where there is none.
    pub(crate) fn seek(&mut self, keyword: &str) -> bool {
        let mut from = self.at;
        while let Some(found) = memchr::memmem::find(&self.bytes[from..], keyword.as_bytes()) {
            let place = from + found;
            let starts_line = place == 0 || matches!(self.bytes[place - 1], b'\n' | b'\r');
            let ends_word = self.bytes.get(place + keyword.len()).is_none_or(u8::is_ascii_whitespace);
            if starts_line && ends_word {
                self.line += memchr::memchr_iter(b'\n', &self.bytes[self.at..place]).count() as u32;
                self.at = place;
                return true;
            }
            from = place + 1;
        }
        false
    }
}

/// Words by which C libraries print what is no number.
fn is_not_a_number(word: &[u8]) -> bool {
    let starts =
        |prefix: &[u8]| word.len() >= prefix.len() && word[..prefix.len()].eq_ignore_ascii_case(prefix);
    starts(b"nan") || starts(b"inf")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_with_what_follows_them() {
        let mut tokens = Tokens::new(b" 3  1 2CN 1\n nan 1.#QNAN -inf 1e-007 Curves", 1);
        assert_eq!((tokens.integer(), tokens.integer(), tokens.integer()), (Ok(3), Ok(1), Ok(2)));
        assert_eq!(tokens.continuity(), Ok(()));
        assert_eq!(tokens.integer(), Ok(1));
        assert!((0..3).all(|_| tokens.real().is_ok_and(f64::is_nan)));
        assert_eq!(tokens.real(), Ok(1e-7));
        assert_eq!(tokens.real().map_err(|stop| stop.line), Err(2));
        assert_eq!(tokens.word(), b"Curves");
    }

    #[test]
    fn sections_are_found_at_the_start_of_lines() {
        let mut tokens = Tokens::new(b"x Surfaces 1\nSurfacesX\nSurfaces 2", 1);
        assert!(tokens.seek("Surfaces"));
        assert_eq!((tokens.line(), tokens.word(), tokens.integer()), (3, &b"Surfaces"[..], Ok(2)));
        assert!(!tokens.seek("Surfaces"));
    }
}
