//! The sections of the file in their order. A section that cannot be followed to its end is left at that
//! place; the next one is found by its keyword.

use super::curves::{Bounded, Parsed, curve, curve2};
use super::locations::Locations;
use super::shapes::{Ix, Orientation, Shape, Sub, reference, shape};
use super::surfaces::{Patch, surface};
use super::tokens::{Stop, Tokens};
use super::triangulations::{Triangulation, triangulation};
use crate::assemble::Notes;
use chordal_brep::{ReadIssue, Source};
use chordal_nurbs::{Curve, Curve2};

/// A table of the file, numbered from 1.
pub(crate) type Table<T> = Vec<Result<T, ReadIssue>>;

/// Everything in the file, not yet put together.
#[derive(Debug)]
pub(crate) struct Document {
    pub locations: Locations,
    pub curves2: Table<Bounded<Curve2>>,
    pub curves: Table<Bounded<Curve>>,
    pub surfaces: Table<Patch>,
    pub triangulations: Table<Triangulation>,
    pub shapes: Table<Shape>,
    /// The number of shapes that the file states: it numbers them from the last to the first.
    declared: usize,
    /// The shape that the file is about; where it names none, those that no other uses.
    pub roots: Vec<Sub>,
    pub notes: Notes,
}

impl Document {
    pub(crate) fn read(bytes: &[u8], version: u32, first_line: u32) -> Self {
        let notes = Notes::default();
        let mut tokens = Tokens::new(bytes, first_line);
        let mut locations = Locations::new();
        section(&mut tokens, "Locations", &notes, |tokens| locations.read_one(tokens));
        let curves2 = section(&mut tokens, "Curve2ds", &notes, |tokens| curve2(tokens, 0));
        let curves = section(&mut tokens, "Curves", &notes, |tokens| curve(tokens, 0));
        let surfaces = section(&mut tokens, "Surfaces", &notes, |tokens| surface(tokens, 0));
        let triangulations =
            section(&mut tokens, "Triangulations", &notes, |tokens| triangulation(tokens, version));
        let (shapes, declared, root) = topology(&mut tokens, version, &notes);
        let roots = root.map_or_else(|| unused(&shapes), |root| vec![root]);
        Self { locations, curves2, curves, surfaces, triangulations, shapes, declared, roots, notes }
    }

    /// The source of a record, by the number that the file gives it.
    pub(crate) fn source(&self, ix: Ix) -> Source {
        let line = self.shapes[ix].as_ref().map_or(0, |shape| shape.line);
        Source { entity: self.declared.saturating_sub(ix) as u64, line }
    }
}

/// An entry of a table by its number; a sentence where there is none.
pub(crate) fn numbered<'t, T>(
    table: &'t Table<T>,
    number: i64,
    what: &'static str,
) -> Result<&'t T, ReadIssue> {
    let found = usize::try_from(number).ok().and_then(|n| table.get(n.checked_sub(1)?));
    match found {
        Some(Ok(item)) => Ok(item),
        Some(Err(issue)) => Err(issue.clone().within(what, usize::try_from(number).unwrap_or(0))),
        None => Err(ReadIssue::NotFound { what, number }),
    }
}

fn at_line(line: u32) -> Source {
    Source { entity: 0, line }
}

/// The items of one section.
fn section<T>(
    tokens: &mut Tokens<'_>,
    keyword: &'static str,
    notes: &Notes,
    mut read: impl FnMut(&mut Tokens<'_>) -> Parsed<T>,
) -> Table<T> {
    let mut table = Table::new();
    if !tokens.seek(keyword) {
        let line = tokens.line();
        notes.warn(at_line(line), ReadIssue::SectionMissing { section: keyword });
        return table;
    }
    tokens.word();
    let stopped = tokens.count().and_then(|count| {
        for _ in 0..count {
            table.push(read(tokens)?);
        }
        Ok(())
    });
    if let Err(Stop { line, issue }) = stopped {
        let item = table.len() + 1;
        let cause = issue.boxed();
        notes.warn(at_line(line), ReadIssue::SectionTruncated { section: keyword, item, cause });
    }
    table
}

/// The records of the shapes, how many there should be, and the one that the file is about.
fn topology(tokens: &mut Tokens<'_>, version: u32, notes: &Notes) -> (Table<Shape>, usize, Option<Sub>) {
    let mut shapes = Table::new();
    if !tokens.seek("TShapes") {
        return (shapes, 0, None);
    }
    tokens.word();
    let declared = tokens.count().unwrap_or(0);
    let mut records = || {
        while shapes.len() < declared {
            let read = shape(tokens, version, shapes.len(), declared)?;
            if let Ok(Shape { line, problem: Some(problem), .. }) = &read {
                let entity = (declared - shapes.len()) as u64;
                notes.lose(Source { entity, line: *line }, problem.clone());
            }
            shapes.push(read);
        }
        reference(tokens)
    };
    let root = match records() {
        Ok(Some((number, orientation, location))) => {
            let target = usize::try_from(number).ok().and_then(|n| declared.checked_sub(n));
            let found = target.filter(|&shape| shape < declared);
            found.map(|shape| Sub { shape, orientation, location })
        }
        Ok(None) => None,
        Err(Stop { line, issue }) => {
            let missing = declared - shapes.len();
            let cause = issue.boxed();
            let issue = match missing {
                0 => ReadIssue::Damaged { what: "the reference to the root shape", cause },
                _ => ReadIssue::ItemsMissing { what: "shapes", missing, declared, cause },
            };
            notes.lose(at_line(line), issue);
            None
        }
    };
    (shapes, declared, root)
}

/// Faces and larger shapes that no other shape uses.
fn unused(shapes: &Table<Shape>) -> Vec<Sub> {
    use super::shapes::Kind;
    let mut used = vec![false; shapes.len()];
    for sub in shapes.iter().flatten().flat_map(|shape| &shape.subs) {
        used[sub.shape] = true;
    }
    let large = |shape: &Shape| !matches!(shape.kind, Kind::Vertex { .. } | Kind::Edge(_) | Kind::Wire);
    let left = shapes.iter().enumerate().filter(|(ix, shape)| !used[*ix] && shape.as_ref().is_ok_and(large));
    left.map(|(shape, _)| Sub { shape, orientation: Orientation::Forward, location: 0 }).collect()
}
