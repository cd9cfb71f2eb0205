//! Statements: lines without comments, those that end in a backslash joined with the next.

use std::borrow::Cow;

/// A statement and the line that it begins on.
#[derive(Clone, Debug)]
pub(super) struct Statement<'t> {
    pub text: Cow<'t, [u8]>,
    pub line: u32,
}

impl Statement<'_> {
    pub(super) fn words(&self) -> impl Iterator<Item = &[u8]> {
        self.text.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty())
    }
}

/// The statements of a text; empty ones are passed over.
#[derive(Debug)]
pub(super) struct Statements<'t> {
    rest: &'t [u8],
    line: u32,
}

impl<'t> Statements<'t> {
    pub(super) fn new(text: &'t [u8]) -> Self {
        Self { rest: text, line: 0 }
    }

    /// The next line; a return, a line feed or both end it.
    fn physical(&mut self) -> Option<&'t [u8]> {
        if self.rest.is_empty() {
            return None;
        }
        self.line = self.line.saturating_add(1);
        let end = memchr::memchr2(b'\n', b'\r', self.rest).unwrap_or(self.rest.len());
        let line = &self.rest[..end];
        let ending = if self.rest[end..].starts_with(b"\r\n") { 2 } else { 1 };
        self.rest = &self.rest[(end + ending).min(self.rest.len())..];
        Some(line)
    }
}

impl<'t> Iterator for Statements<'t> {
    type Item = Statement<'t>;

    fn next(&mut self) -> Option<Statement<'t>> {
        loop {
            let mut text = Cow::Borrowed(self.physical()?);
            let line = self.line;
            while text.last() == Some(&b'\\') {
                let joined = text.to_mut();
                joined.pop();
                joined.push(b' ');
                match self.physical() {
                    Some(more) => joined.extend_from_slice(more),
                    None => break,
                }
            }
            if let Some(comment) = memchr::memchr(b'#', &text) {
                match &mut text {
                    Cow::Borrowed(text) => *text = &text[..comment],
                    Cow::Owned(text) => text.truncate(comment),
                }
            }
            if !text.iter().all(u8::is_ascii_whitespace) {
                return Some(Statement { text, line });
            }
        }
    }
}

/// A finite number.
pub(super) fn number(word: &[u8]) -> Option<f64> {
    std::str::from_utf8(word).ok()?.parse().ok().filter(|x: &f64| x.is_finite())
}

/// The position that a reference means in a list of `count`: counted from 1, or back from the end where
/// negative.
pub(super) fn position(word: &[u8], count: usize) -> Option<usize> {
    let index: i64 = std::str::from_utf8(word).ok()?.parse().ok()?;
    let count = i64::try_from(count).ok()?;
    let at = if index < 0 { count.checked_add(index)? } else { index.checked_sub(1)? };
    (0..count).contains(&at).then_some(at as usize)
}

/// Words as text, in any encoding.
pub(super) fn text(word: &[u8]) -> String {
    String::from_utf8_lossy(word).into_owned()
}
