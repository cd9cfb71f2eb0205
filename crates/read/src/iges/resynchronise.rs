//! Records whose strings have wrong counts, read again.
//!
//! The count of a string (`5Hhello`) may be wrong where a tool changed the text and not the count. The fields
//! behind it are then shifted. Every delimiter may end such a string. The search takes the ends in order, the
//! counted one first, and goes back where the fields that follow contradict: by their kinds where these are
//! known, and by their own counts. Readings with fewer and smaller errors of counts come first.

use super::parameters::{Record, Value, WrongCount, counted, plain};

/// What a field holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Text,
    Number,
}

/// Fields that the search may try, all together: an unreadable record ends it.
const FIELDS: usize = 20_000;
/// How much longer than its count a string may be. With more, one string could take in all fields that make no
/// sense.
const TOO_SHORT: usize = 8;
/// How much shorter than their counts strings may be: the reading with the least is taken.
const REACHES: [usize; 4] = [8, 32, 128, usize::MAX];
/// Strings with wrong counts in one record: the reading with the fewest is taken.
const WRONG_COUNTS: usize = 4;
/// Ends that the search may try for one string.
const ENDS: usize = 32;

/// True where fields are of other kinds than they must be. A text without a count may stand for a string.
pub(crate) fn contradicts(record: &Record, kinds: &[Kind]) -> bool {
    let wrong = |(value, kind): (&Value, &Kind)| match value {
        Value::Omitted => false,
        Value::Text(_) => *kind == Kind::Number,
        Value::Number(_) => *kind == Kind::Text,
        Value::Bad => *kind == Kind::Number,
    };
    record.values.iter().zip(kinds).any(wrong)
}

/// The record with other ends of its strings; `None` where no choice of them makes sense. Fields beyond
/// `kinds` may be of any kind.
pub(crate) fn resynchronised(text: &[u8], delimiters: [u8; 2], kinds: &[Kind]) -> Option<Record> {
    let mut left = FIELDS;
    let limits = REACHES.into_iter().flat_map(|reach| (1..=WRONG_COUNTS).map(move |most| (reach, most)));
    limits
        .map(|(reach, most_wrong)| Search { text, delimiters, kinds, reach, most_wrong })
        .find_map(|search| search.run(&mut left))
}

struct Search<'a> {
    text: &'a [u8],
    delimiters: [u8; 2],
    kinds: &'a [Kind],
    /// How much shorter than its count a string may be.
    reach: usize,
    /// Strings that may have wrong counts.
    most_wrong: usize,
}

impl Search<'_> {
    /// The first record that makes sense, with at most `left` fields tried.
    fn run(&self, left: &mut usize) -> Option<Record> {
        let &Self { text, delimiters, kinds, reach, most_wrong } = self;
        let mut fields = vec![Field::at(text, 0, delimiters)];
        let mut wrong = 0;
        while *left > 0 {
            *left -= 1;
            let kind = fields.len().checked_sub(1).and_then(|index| kinds.get(index));
            let field = fields.last_mut()?;
            wrong -= usize::from(std::mem::take(&mut field.is_wrong));
            let Some(end) = field.ends.pop() else {
                fields.pop();
                continue;
            };
            field.end = end;
            let count = field.wrong_count(text, 0);
            let is_wrong = count.is_some();
            let is_far = count.is_some_and(|wrong| {
                wrong.length > wrong.count + TOO_SHORT || wrong.count.saturating_sub(wrong.length) > reach
            });
            if is_far || wrong + usize::from(is_wrong) > most_wrong || !fits(&field.value(text), kind) {
                continue;
            }
            field.is_wrong = is_wrong;
            wrong += usize::from(is_wrong);
            if text[end] == delimiters[1] {
                return Some(collected(&fields, text));
            }
            fields.push(Field::at(text, end + 1, delimiters));
        }
        None
    }
}

fn fits(value: &Value, kind: Option<&Kind>) -> bool {
    match value {
        Value::Omitted => true,
        Value::Number(_) => kind != Some(&Kind::Text),
        Value::Text(_) => kind != Some(&Kind::Number),
        Value::Bad => false,
    }
}

fn collected(fields: &[Field], text: &[u8]) -> Record {
    let values = fields.iter().map(|field| field.value(text)).collect();
    let wrong_counts =
        (1..).zip(fields).filter_map(|(number, field)| field.wrong_count(text, number)).collect();
    Record { values, ended: true, contradicted: false, wrong_counts }
}

/// A field that begins at `start`; `end`: the delimiter behind it.
struct Field {
    start: usize,
    end: usize,
    /// Ends that are not tried yet, the next one last.
    ends: Vec<usize>,
    /// It ends elsewhere than its count says.
    is_wrong: bool,
    /// The count of a string, and where its text begins.
    count: Option<(usize, usize)>,
}

impl Field {
    fn at(text: &[u8], from: usize, delimiters: [u8; 2]) -> Self {
        let start = from + text[from..].iter().take_while(|b| b.is_ascii_whitespace()).count();
        let count = counted(&text[start..]).map(|(count, prefix)| (count, start + prefix));
        let all = (start..text.len()).filter(|at| delimiters.contains(&text[*at]));
        let mut ends: Vec<usize> = all.take(if count.is_some() { ENDS } else { 1 }).collect();
        if let Some((count, begin)) = count {
            let counted_end = begin + count;
            let behind = text.get(counted_end..).unwrap_or_default();
            let end = counted_end + behind.iter().take_while(|b| b.is_ascii_whitespace()).count();
            if text.get(end).is_some_and(|b| delimiters.contains(b)) {
                // A string that fits its count is not longer.
                ends.retain(|other| *other < end);
                ends.insert(0, end);
            }
        }
        ends.reverse();
        Self { start, end: start, ends, is_wrong: false, count }
    }

    /// The text of a string as counted where the count leads to the end, else up to the end.
    fn value(&self, text: &[u8]) -> Value {
        let Some((count, begin)) = self.count else { return plain(&text[self.start..self.end]) };
        let content = self.content(text, begin);
        Value::Text(
            if leads_to_end(count, content) { &content[..count] } else { content.trim_ascii_end() }.to_vec(),
        )
    }

    fn content<'a>(&self, text: &'a [u8], begin: usize) -> &'a [u8] {
        &text[begin.min(self.end)..self.end]
    }

    /// Some writers count characters where the standard counts bytes; their counts are not wrong.
    fn wrong_count(&self, text: &[u8], field: usize) -> Option<WrongCount> {
        let (count, begin) = self.count?;
        let content = self.content(text, begin);
        let characters = std::str::from_utf8(content.trim_ascii_end()).map(|text| text.chars().count());
        let right = leads_to_end(count, content) || characters == Ok(count);
        let length = content.trim_ascii_end().len();
        (!right).then_some(WrongCount { field, count, length })
    }
}

fn leads_to_end(count: usize, content: &[u8]) -> bool {
    content.get(count..).is_some_and(|behind| behind.trim_ascii().is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(of: &str) -> Value {
        Value::Text(of.as_bytes().to_vec())
    }

    #[test]
    fn a_count_that_is_too_long_ends_at_the_delimiter() {
        let found = resynchronised(b"9Habc,    3Hxyz,7.;", [b',', b';'], &[]).unwrap();
        assert_eq!(found.values, [text("abc"), text("xyz"), Value::Number(7.0)]);
        assert_eq!(found.wrong_counts, [WrongCount { field: 1, count: 9, length: 3 }]);
    }

    #[test]
    fn kinds_tell_which_delimiter_ends_a_string() {
        let kinds = [Kind::Text, Kind::Number, Kind::Text];
        let found = resynchronised(b"12HFoo, Inc.,1,2HMM;", [b',', b';'], &kinds).unwrap();
        assert_eq!(found.values, [text("Foo, Inc."), Value::Number(1.0), text("MM")]);
        assert_eq!(found.wrong_counts.len(), 1);
    }

    #[test]
    fn a_count_of_characters_is_too_short_in_bytes() {
        let found = resynchronised("2Häö,1;".as_bytes(), [b',', b';'], &[]).unwrap();
        assert_eq!((&found.values[0], found.wrong_counts.len()), (&text("äö"), 0));
    }

    #[test]
    fn nonsense_ends_the_search() {
        assert_eq!(resynchronised(b"9Habc,x,y,z", [b',', b';'], &[]), None);
        let many = b"1Hx1H,".repeat(5_000);
        assert_eq!(resynchronised(&many, [b',', b';'], &[]), None);
    }
}
