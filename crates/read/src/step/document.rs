//! The file as a table of entities, found by number, read on demand.

use super::keyword::{Keywords, Kw};
use super::scan::{Entry, Scan, scan};
use crate::assemble::Notes;
pub(crate) use crate::assemble::{Bad, Res};
use chordal_brep::{ReadIssue, Source, Word};
use rustc_hash::FxHashMap;
use std::cell::Cell;

/// The position of an entity in the table.
pub(crate) type Ix = u32;

/// Entity numbers to positions: a plain table where numbers are dense, else a hash map.
#[derive(Debug)]
enum Ids {
    Dense(Vec<Ix>),
    Sparse(FxHashMap<u64, Ix>),
}

/// The entities of one file.
#[derive(Debug)]
pub(crate) struct Doc<'a> {
    bytes: &'a [u8],
    pub entries: Vec<Entry>,
    ids: Ids,
    /// All positions of numbers given more than once, in file order.
    repeated: FxHashMap<u64, Vec<Ix>>,
    keywords: Keywords,
    pub data: Option<usize>,
    pub lines: u32,
    pub notes: Notes,
    /// Entities that may still be opened. It bounds the work on files whose references fan out for ever; an
    /// exporter's file needs about one opening per reference, and a reference takes at least three bytes.
    budget: Cell<u64>,
}

impl<'a> Doc<'a> {
    /// Indexes a file.
    pub(crate) fn new(bytes: &'a [u8]) -> Self {
        let keywords = Keywords::new();
        let Scan { mut entries, notes, data, lines } = scan(bytes, &keywords);
        entries.shrink_to_fit();
        let (ids, repeated) = index(&entries, &notes);
        let budget = Cell::new(bytes.len() as u64 + 200_000);
        Self { bytes, entries, ids, repeated, keywords, data, lines, notes, budget }
    }

    /// The entity that a reference in `from` means: of several with one number the nearest before it, else
    /// the first behind it. So reads the kernel in widest use, and so do files pasted together from others
    /// stay whole.
    pub(crate) fn find_from(&self, id: u64, from: Ix) -> Option<Ix> {
        let found = self.find(id)?;
        if self.repeated.is_empty() {
            return Some(found);
        }
        let Some(all) = self.repeated.get(&id) else { return Some(found) };
        let before = all.partition_point(|&ix| ix < from);
        let behind = all[before..].iter().find(|&&ix| ix != from);
        before.checked_sub(1).map(|last| all[last]).or(behind.copied())
    }

    /// The (first) entity with this number.
    pub(crate) fn find(&self, id: u64) -> Option<Ix> {
        match &self.ids {
            Ids::Dense(table) => table.get(usize::try_from(id).ok()?).copied().filter(|&ix| ix != Ix::MAX),
            Ids::Sparse(map) => map.get(&id).copied(),
        }
    }

    pub(crate) fn keywords(&self) -> &Keywords {
        &self.keywords
    }

    pub(crate) fn entry(&self, ix: Ix) -> &Entry {
        &self.entries[ix as usize]
    }

    /// The keyword; of a complex instance [`Kw::Complex`].
    pub(crate) fn kw(&self, ix: Ix) -> Kw {
        self.entry(ix).kw
    }

    pub(crate) fn source(&self, ix: Ix) -> Source {
        let entry = self.entry(ix);
        Source { entity: entry.id, line: entry.line }
    }

    /// Positions of all entities of one keyword, in file order.
    pub(crate) fn all(&self, wanted: impl Fn(Kw) -> bool) -> Vec<Ix> {
        (0..).zip(&self.entries).filter(|(_, entry)| wanted(entry.kw)).map(|(ix, _)| ix).collect()
    }

    /// Notes a warning about an entity.
    pub(crate) fn warn(&self, ix: Ix, issue: impl Into<ReadIssue>) {
        self.notes.warn(self.source(ix), issue);
    }

    /// Notes an entity whose shape, or some of it, will be missing from the model.
    pub(crate) fn lose(&self, ix: Ix, issue: impl Into<ReadIssue>) {
        self.notes.lose(self.source(ix), issue);
    }

    /// Notes what is wrong with an entity whose shape will be missing from the model.
    pub(crate) fn lose_bad(&self, bad: &Bad) {
        self.notes.push(bad.clone().into_error());
    }

    /// Notes what is wrong with an entity that is not used.
    pub(crate) fn warn_bad(&self, bad: &Bad) {
        self.notes.warn(bad.source(), bad.issue().clone());
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

    /// The keyword for messages; an unknown one as it is spelled in the file.
    pub(crate) fn word(&self, ix: Ix) -> Word {
        match self.kw(ix) {
            Kw::Unknown => self.written_name(ix).into(),
            kw => kw.name().into(),
        }
    }

    /// The name as the file spells it; empty for a complex instance.
    pub(crate) fn written_name(&self, ix: Ix) -> String {
        let before = self.bytes[..self.entry(ix).offset as usize].trim_ascii_end();
        let length = before.iter().rev().take_while(|b| b.is_ascii_alphanumeric() || **b == b'_').count();
        String::from_utf8_lossy(&before[before.len() - length..]).to_ascii_uppercase()
    }

    /// The text of an entity from its opening parenthesis on; charged to the budget.
    ///
    /// # Errors
    /// Where the budget is spent.
    pub(super) fn text(&self, ix: Ix) -> Res<&[u8]> {
        let left = self.budget.get();
        if left == 0 {
            return Err(self.bad(ix, ReadIssue::TooManyReferences));
        }
        self.budget.set(left - 1);
        Ok(&self.bytes[self.entry(ix).offset as usize..self.end(ix)])
    }

    fn end(&self, ix: Ix) -> usize {
        self.entries.get(ix as usize + 1).map_or(self.bytes.len(), |next| next.offset as usize)
    }
}

/// The table of entity numbers, and the positions of those given more than once.
fn index(entries: &[Entry], notes: &Notes) -> (Ids, FxHashMap<u64, Vec<Ix>>) {
    let max = entries.iter().map(|entry| entry.id).max().unwrap_or(0);
    let mut repeated: FxHashMap<u64, Vec<Ix>> = FxHashMap::default();
    let mut repeat = |ix: Ix, entry: &Entry, first: Ix| {
        repeated.entry(entry.id).or_insert_with(|| vec![first]).push(ix);
        let source = Source { entity: entry.id, line: entry.line };
        let line = entries[first as usize].line;
        notes.warn(source, ReadIssue::DuplicateNumber { line });
    };
    let ids = if max < entries.len() as u64 * 8 + 4096 {
        let mut table = vec![Ix::MAX; max as usize + 1];
        for (ix, entry) in (0..).zip(entries) {
            let slot = &mut table[entry.id as usize];
            if *slot == Ix::MAX { *slot = ix } else { repeat(ix, entry, *slot) }
        }
        Ids::Dense(table)
    } else {
        let mut map = FxHashMap::with_capacity_and_hasher(entries.len(), Default::default());
        for (ix, entry) in (0..).zip(entries) {
            let first = *map.entry(entry.id).or_insert(ix);
            if first != ix {
                repeat(ix, entry, first);
            }
        }
        Ids::Sparse(map)
    };
    (ids, repeated)
}
