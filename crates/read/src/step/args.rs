//! Reads the attributes of one entity, in order, straight from the file's bytes.

use super::document::{Bad, Doc, Ix, Res};
use super::keyword::Kw;
use super::scan::string_end;
use super::text;
use crate::number;
use chordal_brep::{ReadIssue, Real};
use memchr::memmem;

/// What the next attribute is, by its first byte.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// No more attributes.
    End,
    String,
    Reference,
    Number,
    Enumeration,
    Omitted,
    Derived,
    List,
    /// `NAME(…)`
    Typed,
    /// Nothing that Part 21 defines.
    Junk,
}

/// A cursor over the attributes of one entity or over the members of one list.
#[derive(Clone, Debug)]
pub(crate) struct Args<'d> {
    doc: &'d Doc<'d>,
    ix: Ix,
    bytes: &'d [u8],
    at: usize,
    /// The number of attributes taken so far, for messages.
    taken: u32,
}

impl<'d> Args<'d> {
    /// `bytes` starts with the opening parenthesis.
    pub(crate) fn new(doc: &'d Doc<'_>, ix: Ix, bytes: &'d [u8]) -> Self {
        Self { doc, ix, bytes, at: 1, taken: 0 }
    }

    /// The leaves of a complex instance.
    pub(crate) fn leaves(mut self) -> Vec<(Kw, Args<'d>)> {
        let mut leaves = Vec::new();
        while self.kind() == Kind::Typed {
            let (name, body) = self.typed_here();
            leaves.push((self.doc.keywords().find(name), body));
        }
        leaves
    }

    fn bad(&self, expected: &'static str) -> Bad {
        let keyword = self.doc.kw(self.ix).name().into();
        let found: String = self.bytes[self.at..].iter().take(24).map(|&b| char::from(b)).collect();
        let found = found.split([',', '\n', '\r']).next().unwrap_or_default().trim_end();
        if found.is_empty() || found.starts_with(')') {
            let missing = ReadIssue::MissingAttribute { keyword, number: self.taken, expected };
            return self.doc.bad(self.ix, missing);
        }
        let found = found.to_owned();
        self.doc.bad(self.ix, ReadIssue::WrongAttribute { keyword, number: self.taken, expected, found })
    }

    /// An error about the attribute taken last.
    pub(crate) fn wrong(&self, issue: impl Into<ReadIssue>) -> Bad {
        self.doc.bad(self.ix, issue)
    }

    fn byte(&self) -> Option<u8> {
        self.bytes.get(self.at).copied()
    }

    /// Moves to the next attribute and returns its kind.
    pub(crate) fn kind(&mut self) -> Kind {
        loop {
            let Some(b) = self.byte() else { return Kind::End };
            match b {
                b' ' | b'\n' | b'\r' | b'\t' | b',' | 0x0b | 0x0c | 0 => self.at += 1,
                b'/' if self.bytes.get(self.at + 1) == Some(&b'*') => {
                    match memmem::find(&self.bytes[self.at + 2..], b"*/") {
                        Some(end) => self.at += end + 4,
                        None => self.at = self.bytes.len(),
                    }
                }
                b')' | b';' => return Kind::End,
                b'\'' | b'"' => return Kind::String,
                b'#' => return Kind::Reference,
                b'$' => return Kind::Omitted,
                b'*' => return Kind::Derived,
                b'(' => return Kind::List,
                b'.' if self.bytes.get(self.at + 1).is_some_and(u8::is_ascii_digit) => return Kind::Number,
                b'.' => return Kind::Enumeration,
                b'0'..=b'9' | b'+' | b'-' => return Kind::Number,
                b'A'..=b'Z' | b'a'..=b'z' | b'!' | b'_' => return Kind::Typed,
                _ => return Kind::Junk,
            }
        }
    }

    fn next(&mut self) -> Kind {
        self.taken += 1;
        self.kind()
    }

    /// Passes over `count` attributes.
    pub(crate) fn skip(&mut self, count: usize) {
        for _ in 0..count {
            if self.next() == Kind::End {
                return;
            }
            self.pass();
        }
    }

    /// The number of remaining attributes.
    pub(crate) fn left(&self) -> usize {
        let mut rest = self.clone();
        let mut count = 0;
        while rest.kind() != Kind::End {
            rest.pass();
            count += 1;
        }
        count
    }

    /// Passes over the value that starts here, with all it holds; never recursive, always at least a byte.
    fn pass(&mut self) {
        let mut depth = 0usize;
        let start = self.at;
        while let Some(b) = self.byte() {
            match b {
                b'\'' | b'"' => match string_end(self.bytes, self.at + 1, b) {
                    Some(end) => {
                        self.at = end;
                        continue;
                    }
                    None => self.at = self.bytes.len() - 1,
                },
                b'(' => depth += 1,
                b')' if depth == 0 => break,
                b')' => {
                    depth -= 1;
                    if depth == 0 {
                        // A list is one value; in a complex instance the next leaf follows without a comma.
                        self.at += 1;
                        break;
                    }
                }
                b',' if depth == 0 => break,
                b';' => break,
                _ => {}
            }
            self.at += 1;
        }
        if self.at == start && self.byte() == Some(b',') {
            self.at += 1;
        }
    }

    /// The raw bytes of a string, which may be omitted.
    fn raw_string(&mut self) -> Option<&'d [u8]> {
        if self.next() != Kind::String {
            self.pass();
            return None;
        }
        let quote = self.bytes[self.at];
        let start = self.at + 1;
        let mut end = start;
        loop {
            let Some(behind) = string_end(self.bytes, end, quote) else {
                self.at = self.bytes.len();
                return None;
            };
            end = behind;
            if self.bytes.get(end) != Some(&quote) {
                break;
            }
            end += 1;
        }
        self.at = end;
        Some(&self.bytes[start..end - 1])
    }

    /// A string; anything else counts as empty.
    pub(crate) fn string(&mut self) -> String {
        match self.raw_string() {
            Some(raw) if !raw.is_empty() => text::decode(raw),
            _ => String::new(),
        }
    }

    /// A number: an integer, a real, or one wrapped in a type (`LENGTH_MEASURE(1.)`).
    pub(crate) fn real(&mut self) -> Res<f64> {
        match self.next() {
            Kind::Number => self.number_here(),
            Kind::Typed => {
                let start = self.at;
                let mut inner = self.typed_here().1;
                if inner.kind() == Kind::Number {
                    return inner.number_here();
                }
                self.at = start;
                let bad = self.bad("a number");
                self.pass();
                Err(bad)
            }
            _ => Err(self.bad("a number")),
        }
    }

    fn number_here(&mut self) -> Res<f64> {
        let Some((value, length)) = number::parse(&self.bytes[self.at..]) else {
            return Err(self.bad("a number"));
        };
        if !value.is_finite()
            || !matches!(
                self.bytes.get(self.at + length),
                None | Some(b',' | b')' | b';' | b' ' | b'\n' | b'\r' | b'\t' | b'/')
            )
        {
            return Err(self.bad("a finite number"));
        }
        self.at += length;
        Ok(value)
    }

    /// A number, or nothing where it is omitted or no number.
    pub(crate) fn optional_real(&mut self) -> Option<f64> {
        let mut ahead = self.clone();
        match ahead.real() {
            Ok(value) => {
                *self = ahead;
                Some(value)
            }
            Err(_) => {
                self.skip(1);
                None
            }
        }
    }

    /// A whole number; reals are rounded.
    pub(crate) fn integer(&mut self) -> Res<i64> {
        let value = self.real()?;
        if value.abs() > 9e15 {
            return Err(self.wrong(ReadIssue::BadValue { what: "number", value: Real(value) }));
        }
        Ok(value.round() as i64)
    }

    /// The text between the dots of an enumeration.
    pub(crate) fn enumeration(&mut self) -> Option<&'d [u8]> {
        if self.next() != Kind::Enumeration {
            self.pass();
            return None;
        }
        let start = self.at + 1;
        let length =
            self.bytes[start..].iter().take_while(|&&b| b.is_ascii_alphanumeric() || b == b'_').count();
        self.at = start + length;
        if self.byte() == Some(b'.') {
            self.at += 1;
        }
        Some(&self.bytes[start..start + length])
    }

    /// `.T.` or `.F.`; anything else is `otherwise`.
    pub(crate) fn logical(&mut self, otherwise: bool) -> bool {
        match self.enumeration() {
            Some(b"T" | b"TRUE" | b"t") => true,
            Some(b"F" | b"FALSE" | b"f") => false,
            _ => otherwise,
        }
    }

    /// A reference to an entity that the file holds.
    pub(crate) fn reference(&mut self) -> Res<Ix> {
        if self.next() != Kind::Reference {
            let bad = self.bad("a reference");
            self.pass();
            return Err(bad);
        }
        self.reference_here()
    }

    fn reference_here(&mut self) -> Res<Ix> {
        let mut at = self.at + 1;
        let mut id = Some(0u64);
        let start = at;
        while let Some(d) = self.bytes.get(at).map(|b| b.wrapping_sub(b'0')).filter(|&d| d < 10) {
            id = id.and_then(|v| v.checked_mul(10)?.checked_add(u64::from(d)));
            at += 1;
        }
        if at == start {
            let bad = self.bad("a reference");
            self.at += 1;
            self.pass();
            return Err(bad);
        }
        self.at = at;
        let found = id.and_then(|id| self.doc.find_from(id, self.ix));
        found.ok_or_else(|| {
            let name = String::from_utf8_lossy(&self.bytes[start..at]);
            self.wrong(ReadIssue::NameNotFound { what: "entity", name: format!("#{name}") })
        })
    }

    /// A reference, or nothing where it is omitted, missing from the file, or no reference.
    pub(crate) fn optional_reference(&mut self) -> Option<Ix> {
        self.reference().ok()
    }

    /// The members of a list.
    pub(crate) fn list(&mut self) -> Res<Args<'d>> {
        if self.next() != Kind::List {
            let bad = self.bad("a list");
            self.pass();
            return Err(bad);
        }
        Ok(self.list_here())
    }

    fn list_here(&mut self) -> Args<'d> {
        let start = self.at;
        self.pass();
        Args { doc: self.doc, ix: self.ix, bytes: &self.bytes[start..self.at], at: 1, taken: 0 }
    }

    /// `NAME(…)`: the name and its content.
    pub(crate) fn typed(&mut self) -> Option<(&'d [u8], Args<'d>)> {
        if self.next() != Kind::Typed {
            self.pass();
            return None;
        }
        Some(self.typed_here())
    }

    fn typed_here(&mut self) -> (&'d [u8], Args<'d>) {
        let start = self.at;
        while self.byte().is_some_and(|b| b.is_ascii_alphanumeric() || matches!(b, b'_' | b'!' | b'-')) {
            self.at += 1;
        }
        let name = &self.bytes[start..self.at];
        while self.byte().is_some_and(|b| b.is_ascii_whitespace()) {
            self.at += 1;
        }
        if self.byte() != Some(b'(') {
            let empty = Args { doc: self.doc, ix: self.ix, bytes: &[], at: 0, taken: 0 };
            if self.at == start {
                self.at += 1;
            }
            return (name, empty);
        }
        (name, self.list_here())
    }

    /// All members of a list of references; those that lead nowhere are errors of their own.
    pub(crate) fn references(&mut self) -> Res<Vec<Res<Ix>>> {
        let mut list = self.list()?;
        let mut found = Vec::new();
        while list.kind() != Kind::End {
            found.push(list.reference());
        }
        Ok(found)
    }

    /// As [`Args::references`]; references to nothing are ignored with a warning.
    pub(crate) fn references_or_warn(&mut self) -> Vec<Ix> {
        match self.references() {
            Ok(list) => {
                list.into_iter().filter_map(|r| r.map_err(|bad| self.doc.warn_bad(&bad)).ok()).collect()
            }
            Err(bad) => {
                self.doc.warn_bad(&bad);
                Vec::new()
            }
        }
    }

    /// All members of a list of references; the first that leads nowhere is the error.
    pub(crate) fn references_strict(&mut self) -> Res<Vec<Ix>> {
        self.references()?.into_iter().collect()
    }

    /// All members of a list of numbers.
    pub(crate) fn reals(&mut self) -> Res<Vec<f64>> {
        let mut list = self.list()?;
        let mut found = Vec::new();
        while list.kind() != Kind::End {
            found.push(list.real()?);
        }
        Ok(found)
    }

    /// All members of a list of whole numbers.
    pub(crate) fn integers(&mut self) -> Res<Vec<i64>> {
        let mut list = self.list()?;
        let mut found = Vec::new();
        while list.kind() != Kind::End {
            found.push(list.integer()?);
        }
        Ok(found)
    }
}
