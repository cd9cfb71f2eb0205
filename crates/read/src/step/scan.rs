//! One pass over the file: where each entity is, and what it is called. Attributes are read later, where
//! needed.
//!
//! Tolerant: a missing `;` or quote costs at most one entity, a file that ends early keeps all that is
//! complete.

use super::keyword::{Keywords, Kw};
use crate::assemble::Notes;
use chordal_brep::{ReadIssue, Source};
use memchr::{memchr, memchr_iter, memmem};

/// An entity instance of the file.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Entry {
    pub id: u64,
    /// The position of the `(` that opens the attributes (of a complex instance: its leaves).
    pub offset: u64,
    pub line: u32,
    pub kw: Kw,
}

/// What one pass over the file finds.
#[derive(Debug, Default)]
pub(crate) struct Scan {
    pub entries: Vec<Entry>,
    pub notes: Notes,
    /// The position of the first DATA section's content; `None` where there is none.
    pub data: Option<usize>,
    /// Lines of the file, as far as it was read.
    pub lines: u32,
}

/// How a record ended.
enum End {
    /// Behind its closing parenthesis.
    Closed,
    /// A `;` came before the closing parenthesis.
    Early,
    /// The file ends within it.
    OfFile,
}

struct Scanner<'a> {
    bytes: &'a [u8],
    at: usize,
    line: u32,
    out: Scan,
    keywords: &'a Keywords,
    /// Ids whose `&SCOPE … ENDSCOPE` is open.
    scopes: Vec<(u64, u32)>,
    /// No `*/` follows: every further `/*` is known to have no end, without another search.
    comments_open: bool,
}

/// Finds every entity of the file.
pub(crate) fn scan(bytes: &[u8], keywords: &Keywords) -> Scan {
    let Some(data) = find_data(bytes) else {
        return Scan { lines: count_lines(bytes), ..Scan::default() };
    };
    let line = 1 + count_lines(&bytes[..data]);
    let mut scanner = Scanner {
        bytes,
        at: data,
        line,
        out: Scan::default(),
        keywords,
        scopes: Vec::new(),
        comments_open: false,
    };
    scanner.out.data = Some(data);
    scanner.out.entries.reserve(bytes.len() / 96);
    scanner.sections();
    scanner.out.lines = scanner.line;
    scanner.out
}

fn count_lines(bytes: &[u8]) -> u32 {
    u32::try_from(memchr_iter(b'\n', bytes).count()).unwrap_or(u32::MAX)
}

/// The position behind the first `DATA;` or `DATA(…);` that starts a statement.
fn find_data(bytes: &[u8]) -> Option<usize> {
    memmem::find_iter(bytes, b"DATA").find_map(|at| {
        let before = bytes[..at].iter().rposition(|b| !b.is_ascii_whitespace());
        if before.is_some_and(|b| !matches!(bytes[b], b';' | b'/')) {
            return None;
        }
        let mut p = skip_blank(bytes, at + 4);
        if bytes.get(p) == Some(&b'(') {
            let nearby = &bytes[p..bytes.len().min(p + 4096)];
            p = skip_blank(bytes, p + memchr(b';', nearby)?);
        }
        (bytes.get(p) == Some(&b';')).then_some(p + 1)
    })
}

fn skip_blank(bytes: &[u8], mut at: usize) -> usize {
    while bytes.get(at).is_some_and(u8::is_ascii_whitespace) {
        at += 1;
    }
    at
}

fn is_name_byte(b: u8) -> bool {
    b.is_ascii_alphanumeric() || matches!(b, b'_' | b'!' | b'-')
}

/// 0: passed over; otherwise looked at by [`Scanner::record`].
const CLASS: [u8; 256] = {
    let mut class = [0u8; 256];
    class[b'\'' as usize] = 1;
    class[b'(' as usize] = 1;
    class[b')' as usize] = 1;
    class[b';' as usize] = 1;
    class[b'\n' as usize] = 1;
    class[b'/' as usize] = 1;
    class[b'"' as usize] = 1;
    class
};

impl Scanner<'_> {
    fn warn(&self, entity: u64, issue: impl Into<ReadIssue>) {
        self.out.notes.warn(Source { entity, line: self.line }, issue);
    }

    /// Notes that part of the file is missing.
    fn lose(&self, entity: u64, issue: impl Into<ReadIssue>) {
        self.out.notes.lose(Source { entity, line: self.line }, issue);
    }

    /// Passes over white space and comments.
    fn blank(&mut self) {
        while let Some(&b) = self.bytes.get(self.at) {
            match b {
                b'\n' => self.line += 1,
                b' ' | b'\t' | b'\r' | 0x0b | 0x0c | 0 => {}
                b'/' if self.bytes.get(self.at + 1) == Some(&b'*') => {
                    self.comment();
                    continue;
                }
                _ => return,
            }
            self.at += 1;
        }
    }

    /// Passes over the comment that starts here; one without an end is taken for its two first bytes only.
    fn comment(&mut self) {
        let body = &self.bytes[self.at + 2..];
        let end = if self.comments_open { None } else { memmem::find(body, b"*/") };
        match end {
            Some(end) => {
                self.line += count_lines(&body[..end]);
                self.at += end + 4;
            }
            None => {
                if !self.comments_open {
                    self.warn(0, ReadIssue::CommentUnterminated);
                }
                self.comments_open = true;
                self.at += 2;
            }
        }
    }

    fn name(&mut self) -> &[u8] {
        let start = self.at;
        while self.bytes.get(self.at).is_some_and(|&b| is_name_byte(b)) {
            self.at += 1;
        }
        &self.bytes[start..self.at]
    }

    /// Reads statements until the file ends.
    fn sections(&mut self) {
        let mut in_data = true;
        let mut ended = false;
        let mut junk = 0usize;
        loop {
            self.blank();
            let Some(&b) = self.bytes.get(self.at) else { break };
            match b {
                b'#' => self.instance(),
                b';' => self.at += 1,
                b if b.is_ascii_alphabetic() => {
                    let line = self.line;
                    let name = self.name().to_vec();
                    match name.as_slice() {
                        b"ENDSEC" => in_data = false,
                        b"DATA" => in_data = true,
                        b"ENDSCOPE" => {
                            self.end_scope();
                            continue;
                        }
                        b"END-ISO-10303-21" => ended = true,
                        _ if in_data => {
                            self.warn(
                                0,
                                ReadIssue::NotAnEntity { word: String::from_utf8_lossy(&name).into_owned() },
                            );
                        }
                        _ => {}
                    }
                    self.skip_statement();
                    debug_assert!(self.line >= line);
                }
                _ => {
                    junk += 1;
                    if junk == 1 {
                        self.warn(0, ReadIssue::StrayBytes);
                    }
                    self.resynchronise();
                }
            }
        }
        if !ended && in_data {
            self.lose(0, ReadIssue::FileTruncated);
        }
    }

    /// Passes over everything up to the next `;` or to a `#` that starts a line.
    fn skip_statement(&mut self) {
        while let Some(&b) = self.bytes.get(self.at) {
            match b {
                b';' => {
                    self.at += 1;
                    return;
                }
                b'#' if self.bytes[..self.at].last() == Some(&b'\n') => return,
                b'\n' => self.line += 1,
                _ => {}
            }
            self.at += 1;
        }
    }

    fn resynchronise(&mut self) {
        while let Some(&b) = self.bytes.get(self.at) {
            if b == b'#' || b == b';' || b == b'\n' {
                return;
            }
            self.at += 1;
        }
    }

    fn digits(&mut self) -> Option<u64> {
        let start = self.at;
        let mut value = Some(0u64);
        while let Some(d) = self.bytes.get(self.at).map(|b| b.wrapping_sub(b'0')).filter(|&d| d < 10) {
            value = value.and_then(|v| v.checked_mul(10)?.checked_add(u64::from(d)));
            self.at += 1;
        }
        if self.at == start { None } else { value }
    }

    /// `#id = NAME(…);` or `#id = (A(…)B(…));`, at the `#`.
    fn instance(&mut self) {
        let line = self.line;
        self.at += 1;
        let Some(id) = self.digits() else {
            self.warn(0, ReadIssue::NoEntityNumber);
            return self.skip_statement();
        };
        self.blank();
        if self.bytes.get(self.at) != Some(&b'=') {
            self.warn(id, ReadIssue::NoEqualsSign);
            return self.skip_statement();
        }
        self.at += 1;
        self.blank();
        if self.bytes[self.at..].starts_with(b"&SCOPE") {
            self.at += 6;
            self.scopes.push((id, line));
            return;
        }
        self.body(id, line);
    }

    fn end_scope(&mut self) {
        self.blank();
        if self.bytes.get(self.at) == Some(&b'/') {
            // The list of exported ids, `/#1,#2/`.
            self.at += 1;
            let export =
                memchr(b'/', &self.bytes[self.at..]).map_or(self.bytes.len(), |end| self.at + end + 1);
            self.line += count_lines(&self.bytes[self.at..export]);
            self.at = export;
            self.blank();
        }
        match self.scopes.pop() {
            Some((id, line)) => self.body(id, line),
            None => self.skip_statement(),
        }
    }

    /// The name and attributes of entity `id`.
    fn body(&mut self, id: u64, line: u32) {
        let kw = if self.bytes.get(self.at) == Some(&b'(') {
            Kw::Complex
        } else {
            let keywords = self.keywords;
            keywords.find(self.name())
        };
        self.blank();
        if self.bytes.get(self.at) != Some(&b'(') {
            if self.at < self.bytes.len() {
                self.warn(id, ReadIssue::NoAttributes);
            }
            return self.skip_statement();
        }
        let offset = self.at as u64;
        match self.record() {
            End::OfFile => {
                self.lose(id, ReadIssue::EntityTruncated);
                return;
            }
            End::Early => self.warn(id, ReadIssue::ParenthesisMissing),
            End::Closed => self.terminator(id),
        }
        self.out.entries.push(Entry { id, offset, line, kw });
    }

    /// The `;` behind a closed record; its absence is repaired.
    fn terminator(&mut self, id: u64) {
        self.blank();
        match self.bytes.get(self.at) {
            Some(b';') => self.at += 1,
            None => {}
            Some(_) => self.warn(id, ReadIssue::SemicolonMissing),
        }
    }

    /// Passes over the parenthesis that opens here and all it holds.
    fn record(&mut self) -> End {
        let bytes = self.bytes;
        let mut depth = 0usize;
        let mut at = self.at;
        loop {
            while at < bytes.len() && CLASS[bytes[at] as usize] == 0 {
                at += 1;
            }
            let Some(&b) = bytes.get(at) else {
                self.at = at;
                return End::OfFile;
            };
            at += 1;
            match b {
                b'(' => depth += 1,
                b')' => {
                    depth -= 1;
                    if depth == 0 {
                        self.at = at;
                        return End::Closed;
                    }
                }
                b'\n' => self.line += 1,
                b';' => {
                    self.at = at;
                    return End::Early;
                }
                b'/' if bytes.get(at) == Some(&b'*') => {
                    self.at = at - 1;
                    self.comment();
                    at = self.at;
                }
                b'\'' | b'"' => match string_end(bytes, at, b) {
                    Some(end) => {
                        if end - at > 60 || bytes[at..end].contains(&b'\n') {
                            self.line += count_lines(&bytes[at..end]);
                        }
                        at = end;
                    }
                    None => {
                        self.at = at;
                        return self.broken_string();
                    }
                },
                _ => {}
            }
        }
    }

    /// A string without an end: the record ends with the line.
    fn broken_string(&mut self) -> End {
        match memchr(b'\n', &self.bytes[self.at..]) {
            Some(end) => {
                self.at += end;
                End::Early
            }
            None => {
                self.at = self.bytes.len();
                End::OfFile
            }
        }
    }
}

/// The position behind the quote that closes the string whose content starts at `at`; `None` where the string
/// runs into the next entity (a line that starts with `#digits=`).
pub(crate) fn string_end(bytes: &[u8], at: usize, quote: u8) -> Option<usize> {
    let length = memchr(quote, &bytes[at..])?;
    let content = &bytes[at..at + length];
    let runs_over = memchr_iter(b'\n', content).any(|newline| starts_instance(&content[newline + 1..]));
    (!runs_over).then_some(at + length + 1)
}

fn starts_instance(text: &[u8]) -> bool {
    let text = &text[skip_blank(text, 0)..];
    if text.first() != Some(&b'#') {
        return false;
    }
    let digits = text[1..].iter().take_while(|b| b.is_ascii_digit()).count();
    digits > 0 && text.get(skip_blank(text, 1 + digits)) == Some(&b'=')
}
