//! The file as a table of entities, found by their number in the directory, read on demand.

use super::global::{Global, padded};
use super::lines::{Line, Sections, number};
use super::parameters::{Record, Value, record};
use super::resynchronise::resynchronised;
use crate::assemble::Notes;
pub(crate) use crate::assemble::{Bad, Res};
use crate::encoding::Encoding;
use chordal_brep::{Millimetres, ReadIssue, Source, Word};
use rustc_hash::FxHashMap;
use std::cell::Cell;

/// The position of an entity in the table.
pub(crate) type Ix = usize;

/// An entity's entry in the directory.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Entry {
    pub kind: u32,
    pub form: i64,
    /// The number of the entity: that of the first of its two lines.
    pub number: u64,
    pub line: u32,
    /// The number of its first parameter line, and how many it has.
    parameter_line: u64,
    parameter_count: u64,
    pub level: i64,
    /// The number of its transformation matrix, 0 for none.
    pub matrix: i64,
    /// A number of a colour, or minus the number of a colour entity.
    pub color: i64,
    /// Blanked, subordinate, use, hierarchy.
    pub status: [u8; 4],
    pub label: String,
}

/// The entities of one file.
#[derive(Debug)]
pub(crate) struct Doc<'a> {
    pub entries: Vec<Entry>,
    by_number: FxHashMap<u64, Ix>,
    parameters: Vec<Line<'a>>,
    /// The position of each parameter line; empty where the numbers are as they should be.
    parameter_positions: FxHashMap<u64, usize>,
    pub global: Global,
    /// Of strings.
    encoding: Encoding,
    pub notes: Notes,
    /// Bytes of parameters that may still be read: it bounds the work on files whose references fan out for
    /// ever.
    budget: Cell<u64>,
}

/// The encoding of the strings of a file: lines are joined, since characters of several bytes may be broken
/// over two.
fn encoding_of(sections: &Sections<'_>) -> Encoding {
    let lines = || sections.global.iter().chain(&sections.parameters).map(|line| line.text);
    if lines().all(<[u8]>::is_ascii) {
        return Encoding::Utf8;
    }
    Encoding::of(&lines().flatten().copied().collect::<Vec<u8>>())
}

impl<'a> Doc<'a> {
    pub(crate) fn new(sections: Sections<'a>, size: usize) -> Self {
        let encoding = encoding_of(&sections);
        let global = Global::read(&sections.global, encoding);
        let notes = Notes::default();
        for issue in &global.issues {
            let line = sections.global.first().map_or(0, |line| line.line);
            notes.warn(Source { entity: 0, line }, issue.clone());
        }
        if let Some(line) = sections.stray {
            notes.warn(Source { entity: 0, line }, ReadIssue::StrayBytes);
        }
        if !sections.ended {
            notes.warn(Source::default(), ReadIssue::SectionMissing { section: "T (terminate)" });
        }
        let entries = directory(&sections.directory, &notes);
        let by_number = entries.iter().enumerate().rev().map(|(ix, entry)| (entry.number, ix)).collect();
        let parameters = sections.parameters;
        let in_order = parameters.iter().enumerate().all(|(i, line)| line.sequence == i as u64 + 1);
        let parameter_positions = if in_order {
            FxHashMap::default()
        } else {
            parameters.iter().enumerate().rev().map(|(i, line)| (line.sequence, i)).collect()
        };
        let budget = Cell::new(64 * size as u64 + 10_000_000);
        Self { entries, by_number, parameters, parameter_positions, global, encoding, notes, budget }
    }

    pub(crate) fn entry(&self, ix: Ix) -> &Entry {
        &self.entries[ix]
    }

    pub(crate) fn kind(&self, ix: Ix) -> u32 {
        self.entries[ix].kind
    }

    pub(crate) fn source(&self, ix: Ix) -> Source {
        Source { entity: self.entries[ix].number, line: self.entries[ix].line }
    }

    /// The entity with this number; pointers may carry a sign.
    pub(crate) fn find(&self, number: i64) -> Option<Ix> {
        self.by_number.get(&number.unsigned_abs()).copied()
    }

    pub(crate) fn bad(&self, ix: Ix, issue: impl Into<ReadIssue>) -> Bad {
        Bad::new(self.source(ix), issue)
    }

    /// An entity is of another kind than `expected`, which carries its article.
    pub(crate) fn unknown(&self, ix: Ix, expected: &'static str) -> Bad {
        self.bad(ix, ReadIssue::UnknownKind { found: self.word(ix), expected })
    }

    /// An entity is defined by itself or by more than `levels` entities one within the other.
    pub(crate) fn recursive(&self, ix: Ix, levels: u32) -> Bad {
        self.bad(ix, ReadIssue::Recursive { keyword: self.word(ix), levels })
    }

    /// The type of an entity for messages.
    pub(crate) fn word(&self, ix: Ix) -> Word {
        format!("type {}", self.kind(ix)).into()
    }

    /// A length in the file's unit, for messages.
    pub(crate) fn millimetres(&self, length: f64) -> Millimetres {
        Millimetres(length * self.global.length_mm)
    }

    pub(crate) fn warn(&self, ix: Ix, issue: impl Into<ReadIssue>) {
        self.notes.warn(self.source(ix), issue);
    }

    /// Some of the file's shape will be missing.
    pub(crate) fn lose(&self, ix: Ix, issue: impl Into<ReadIssue>) {
        self.notes.lose(self.source(ix), issue);
    }

    pub(crate) fn lose_bad(&self, bad: &Bad) {
        self.notes.push(bad.clone().into_error());
    }

    /// The parameters of an entity.
    pub(crate) fn open(&self, ix: Ix) -> Res<Args<'_>> {
        let entry = &self.entries[ix];
        let first = self.parameter_position(entry.parameter_line);
        let Some(first) = first else { return Err(self.bad(ix, ReadIssue::NoAttributes)) };
        let delimiters = [self.global.parameter_delimiter, self.global.record_delimiter];
        let mut text: Vec<u8> = Vec::new();
        let mut taken = 0;
        let mut found = Record::default();
        // The count may be wrong: lines are added until the record ends, while they are the entity's.
        while let Some(line) = self.parameters.get(first + taken) {
            let mine = back_pointer(line.text).is_none_or(|number| number == entry.number);
            if taken as u64 >= entry.parameter_count.max(1) && (found.ended || !mine) {
                break;
            }
            text.extend(padded(&line.text[..line.text.len().min(DATA)]).take(DATA));
            // Column 65 should be blank, but some writers let the last delimiter stand there.
            text.extend(line.text.get(DATA).filter(|column| delimiters.contains(column)));
            taken += 1;
            if taken as u64 >= entry.parameter_count {
                found = record(&text, delimiters[0], delimiters[1]);
            }
        }
        if !found.ended {
            found = record(&text, delimiters[0], delimiters[1]);
        }
        if found.contradicted
            && let Some(better) = resynchronised(&text, delimiters, &[])
        {
            better.wrong_counts.iter().for_each(|wrong| self.warn(ix, wrong.issue("of the entity")));
            found = better;
        }
        let left = self.budget.get().checked_sub(text.len() as u64 + 1);
        self.budget.set(left.ok_or_else(|| self.bad(ix, ReadIssue::TooManyReferences))?);
        match found.values.first() {
            Some(Value::Number(kind)) if *kind == f64::from(entry.kind) => {}
            Some(Value::Number(kind)) => {
                return Err(self.bad(
                    ix,
                    ReadIssue::UnknownKind {
                        found: format!("the parameter record of type {kind}").into(),
                        expected: "that of this entity",
                    },
                ));
            }
            _ => return Err(self.bad(ix, ReadIssue::Missing { what: "readable parameters" })),
        }
        Ok(Args { doc: self, ix, values: found.values, at: 1 })
    }

    fn parameter_position(&self, number: u64) -> Option<usize> {
        if self.parameter_positions.is_empty() {
            let position = usize::try_from(number.checked_sub(1)?).ok()?;
            return (position < self.parameters.len()).then_some(position);
        }
        self.parameter_positions.get(&number).copied()
    }
}

/// Columns of parameter lines that hold parameters.
const DATA: usize = 64;

/// Columns 66 to 72 of a parameter line: the entity it belongs to.
fn back_pointer(text: &[u8]) -> Option<u64> {
    number(text.get(DATA + 1..)?)
}

/// Pairs of lines as entries.
fn directory(lines: &[Line<'_>], notes: &Notes) -> Vec<Entry> {
    let mut entries = Vec::with_capacity(lines.len() / 2);
    let mut rest = lines;
    while let [first, after @ ..] = rest {
        let second = after.first().filter(|second| {
            second.sequence == first.sequence + 1 && kind_of(second.text) == kind_of(first.text)
        });
        match (second, kind_of(first.text)) {
            (Some(second), Some(kind)) => {
                entries.push(entry(kind, first, second));
                rest = &after[1..];
            }
            _ => {
                let source = Source { entity: first.sequence, line: first.line };
                notes.lose(source, ReadIssue::Unsupported { what: "a broken directory entry".into() });
                rest = after;
            }
        }
    }
    entries
}

fn field(text: &[u8], i: usize) -> &[u8] {
    let start = (8 * i).min(text.len());
    text[start..(start + 8).min(text.len())].trim_ascii()
}

fn integer(text: &[u8], i: usize) -> i64 {
    let text = field(text, i);
    std::str::from_utf8(text).ok().and_then(|text| text.parse().ok()).unwrap_or(0)
}

fn kind_of(text: &[u8]) -> Option<u32> {
    u32::try_from(integer(text, 0)).ok().filter(|&kind| kind > 0)
}

fn entry(kind: u32, first: &Line<'_>, second: &Line<'_>) -> Entry {
    let (a, b) = (first.text, second.text);
    let mut status = [0; 4];
    let digits: Vec<u8> = field(a, 8).to_vec();
    let missing = 8usize.saturating_sub(digits.len());
    let digit =
        |i: usize| i.checked_sub(missing).and_then(|i| digits.get(i)).map_or(0, |d| d.wrapping_sub(b'0'));
    for (k, part) in status.iter_mut().enumerate() {
        *part = digit(2 * k).saturating_mul(10).saturating_add(digit(2 * k + 1));
    }
    let subscript = integer(b, 8);
    let label = String::from_utf8_lossy(field(b, 7)).into_owned();
    let label = if subscript > 0 && !label.is_empty() { format!("{label}{subscript}") } else { label };
    let positive = |value: i64| u64::try_from(value).unwrap_or(0);
    Entry {
        kind,
        form: integer(b, 4),
        number: first.sequence,
        line: first.line,
        parameter_line: positive(integer(a, 1)),
        parameter_count: positive(integer(b, 3)),
        level: integer(a, 4),
        matrix: integer(a, 6),
        color: integer(b, 2),
        status,
        label,
    }
}

/// The parameters of an entity, taken one after the other.
#[derive(Clone, Debug)]
pub(crate) struct Args<'d> {
    doc: &'d Doc<'d>,
    ix: Ix,
    values: Vec<Value>,
    at: usize,
}

impl Args<'_> {
    pub(crate) fn left(&self) -> usize {
        self.values.len().saturating_sub(self.at)
    }

    fn next(&mut self) -> Option<&Value> {
        self.at += 1;
        self.values.get(self.at - 1)
    }

    fn wrong(&self, expected: &'static str) -> Bad {
        let (keyword, number) = (self.doc.word(self.ix), (self.at - 1) as u32);
        self.doc.bad(
            self.ix,
            match self.values.get(self.at - 1) {
                Some(Value::Number(value)) => {
                    ReadIssue::WrongAttribute { keyword, number, expected, found: value.to_string() }
                }
                Some(Value::Text(text)) => {
                    let found = String::from_utf8_lossy(text).chars().take(24).collect();
                    ReadIssue::WrongAttribute { keyword, number, expected, found }
                }
                _ => ReadIssue::MissingAttribute { keyword, number, expected },
            },
        )
    }

    pub(crate) fn skip(&mut self, count: usize) {
        self.at = self.at.saturating_add(count);
    }

    /// A finite number; left out, 0.
    pub(crate) fn real(&mut self) -> Res<f64> {
        match self.next() {
            Some(&Value::Number(value)) if value.is_finite() => Ok(value),
            Some(Value::Omitted) => Ok(0.0),
            _ => Err(self.wrong("a number")),
        }
    }

    pub(crate) fn optional_real(&mut self) -> Option<f64> {
        match self.next() {
            Some(&Value::Number(value)) if value.is_finite() => Some(value),
            _ => None,
        }
    }

    /// A whole number; left out, 0.
    pub(crate) fn integer(&mut self) -> Res<i64> {
        let value = self.real()?;
        if value.fract() == 0.0 && value.abs() < 1e15 {
            Ok(value as i64)
        } else {
            Err(self.wrong("a whole number"))
        }
    }

    /// A number of things that follow, at least one parameter each.
    pub(crate) fn count(&mut self) -> Res<usize> {
        let value = self.integer()?;
        match usize::try_from(value) {
            Ok(count) if count <= self.left() => Ok(count),
            _ => {
                let least = usize::try_from(value).unwrap_or(usize::MAX);
                Err(self
                    .doc
                    .bad(self.ix, ReadIssue::TooFew { what: "parameters left", found: self.left(), least }))
            }
        }
    }

    /// `count` numbers. Nothing is allocated unless there are as many.
    pub(crate) fn reals(&mut self, count: usize) -> Res<Vec<f64>> {
        if count > self.left() {
            let few = ReadIssue::TooFew { what: "parameters left", found: self.left(), least: count };
            return Err(self.doc.bad(self.ix, few));
        }
        (0..count).map(|_| self.real()).collect()
    }

    pub(crate) fn point(&mut self) -> Res<chordal_nurbs::DVec3> {
        Ok(chordal_nurbs::DVec3::new(self.real()?, self.real()?, self.real()?))
    }

    /// The entity that a pointer means; none for 0.
    pub(crate) fn optional_reference(&mut self) -> Res<Option<Ix>> {
        let number = self.integer()?;
        if number == 0 {
            return Ok(None);
        }
        let found = self.doc.find(number);
        found.map(Some).ok_or_else(|| self.doc.bad(self.ix, ReadIssue::NotFound { what: "entity", number }))
    }

    pub(crate) fn reference(&mut self) -> Res<Ix> {
        let found = self.optional_reference()?;
        found.ok_or_else(|| self.wrong("a reference"))
    }

    pub(crate) fn string(&mut self) -> String {
        let encoding = self.doc.encoding;
        match self.next() {
            Some(Value::Text(text)) => encoding.decode(text).trim().to_owned(),
            _ => String::new(),
        }
    }
}
