//! A few faces of a file as a file of their own, without names.
//!
//! 1. Of each face, everything that it refers to is kept, as it is written; strings are emptied, entity
//!    numbers stay.
//! 2. Of the units, the context of the representation to which the first face belongs is kept, with names of
//!    units.
//! 3. A shell with the faces, a representation and a product are written behind these.
//!
//! What a face needs from above (the sense of its shell, its placement) is not kept. An entity that the file
//! lacks is missing in the excerpt, too.

use super::document::{Doc, Ix};
use super::keyword::Kw;
use super::scan::string_end;
use std::collections::BTreeSet;
use std::fmt::Write;

/// The number of entities visited in the search for the representation of a face. Only files with recursive
/// references reach it; their excerpt has no representation.
const MOST_VISITS: usize = 20_000_000;

const HEADER: &str = "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\n\
    FILE_NAME('','',(''),(''),'','','');\n\
    FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\n";

/// The faces with these numbers as a file; numbers that the file does not have are ignored.
pub(crate) fn excerpt(bytes: &[u8], faces: &[u64]) -> String {
    let doc = Doc::new(bytes);
    let source = Source { bytes, doc: &doc };
    let found: Vec<Ix> = faces.iter().filter_map(|&face| doc.find(face)).collect();
    let mut kept = BTreeSet::new();
    found.iter().for_each(|&face| source.collect(face, &mut kept));
    let context = found.first().and_then(|&face| source.context_of(face));
    context.iter().for_each(|&context| source.collect(context, &mut kept));
    let mut text = HEADER.to_owned();
    // Numbers that the file refers to and does not have stay without an entity.
    let mut last = 0;
    for &ix in &kept {
        let statement = source.statement(ix);
        let id = doc.entry(ix).id;
        last = statement.references.iter().fold(last.max(id), |last, &id| last.max(id));
        let _ = writeln!(text, "#{id}={};", statement.text);
    }
    let ids =
        |all: &[Ix]| -> Vec<String> { all.iter().map(|&ix| format!("#{}", doc.entry(ix).id)).collect() };
    let (faces, surfaces): (Vec<Ix>, Vec<Ix>) = found.iter().partition(|&&ix| source.is_face(ix));
    let context = context.map(|ix| doc.entry(ix).id);
    text + &frame(last, &ids(&faces), &ids(&surfaces), context) + "ENDSEC;\nEND-ISO-10303-21;\n"
}

/// An entity as it will be written, and the numbers that it refers to.
#[derive(Default)]
struct Statement {
    text: String,
    references: Vec<u64>,
}

struct Source<'d> {
    bytes: &'d [u8],
    doc: &'d Doc<'d>,
}

impl Source<'_> {
    /// Adds an entity and all that it refers to.
    fn collect(&self, first: Ix, kept: &mut BTreeSet<Ix>) {
        let mut stack = vec![first];
        while let Some(ix) = stack.pop() {
            if kept.insert(ix) {
                stack.extend(self.references(ix));
            }
        }
    }

    fn references(&self, ix: Ix) -> Vec<Ix> {
        let references = self.statement(ix).references;
        references.into_iter().filter_map(|id| self.doc.find_from(id, ix)).collect()
    }

    /// Faces go into a shell; what else stands for a face in the file is a bounded surface.
    fn is_face(&self, ix: Ix) -> bool {
        const FACES: [&str; 4] = ["ADVANCED_FACE", "FACE_SURFACE", "FACE", "ORIENTED_FACE"];
        match self.doc.kw(ix) {
            Kw::Complex => {
                let text = self.statement(ix).text;
                FACES[..2].iter().any(|face| text.contains(&format!("{face}(")))
            }
            _ => FACES.contains(&self.doc.written_name(ix).as_str()),
        }
    }

    /// The context of the first representation from which a way leads to the face.
    fn context_of(&self, face: Ix) -> Option<Ix> {
        let mut visits = 0;
        let all = 0..self.doc.entries.len() as Ix;
        let representations = all.filter(|&ix| self.doc.written_name(ix).ends_with("SHAPE_REPRESENTATION"));
        for representation in representations {
            let mut seen = BTreeSet::new();
            let mut stack = vec![representation];
            while let Some(ix) = stack.pop() {
                visits += 1;
                if ix == face {
                    return self.references(representation).last().copied();
                }
                if visits > MOST_VISITS {
                    return None;
                }
                if seen.insert(ix) {
                    stack.extend(self.references(ix));
                }
            }
        }
        None
    }

    /// The entity up to its closing parenthesis, or as far as it goes.
    fn statement(&self, ix: Ix) -> Statement {
        let mut found = Statement::default();
        if self.doc.kw(ix) != Kw::Complex {
            found.text = self.doc.written_name(ix);
        }
        let (mut at, mut depth) = (self.doc.entry(ix).offset as usize, 0usize);
        while let Some(&b) = self.bytes.get(at) {
            at += 1;
            match b {
                b'\'' | b'"' => {
                    let Some(end) = string_end(self.bytes, at, b) else { break };
                    let content = &self.bytes[at..end - 1];
                    // A unit without its name may be another unit.
                    let name = if found.text.ends_with("CONVERSION_BASED_UNIT(") { content } else { &[] };
                    let quote = char::from(b);
                    let _ = write!(found.text, "{quote}{}{quote}", String::from_utf8_lossy(name));
                    at = end;
                    continue;
                }
                b'/' if self.bytes.get(at) == Some(&b'*') => {
                    let comment = &self.bytes[at..];
                    let Some(length) = comment.windows(2).position(|end| end == b"*/") else { break };
                    at += length + 2;
                    continue;
                }
                b'#' => {
                    let digits = self.bytes[at..].iter().take_while(|b| b.is_ascii_digit()).count();
                    let number = std::str::from_utf8(&self.bytes[at..at + digits]).unwrap_or_default();
                    found.references.extend(number.parse::<u64>());
                }
                b'(' => depth += 1,
                b')' => depth = depth.saturating_sub(1),
                b';' => break,
                b if b.is_ascii_whitespace() || !b.is_ascii() => continue,
                _ => {}
            }
            found.text.push(char::from(b));
            if b == b')' && depth == 0 {
                break;
            }
        }
        found
    }
}

/// The shell, representation and product around the faces, with numbers behind `last`.
fn frame(last: u64, faces: &[String], surfaces: &[String], context: Option<u64>) -> String {
    let id = |n: u64| last.saturating_add(n);
    let mut text = String::new();
    let mut add = |n: u64, entity: String| {
        let _ = writeln!(text, "#{}={entity};", id(n));
    };
    let context = context.unwrap_or_else(|| {
        add(1, "(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))".into());
        add(2, "(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))".into());
        let units = format!("GLOBAL_UNIT_ASSIGNED_CONTEXT((#{},#{}))", id(1), id(2));
        add(3, format!("(GEOMETRIC_REPRESENTATION_CONTEXT(3){units}REPRESENTATION_CONTEXT('',''))"));
        id(3)
    });
    let mut items = Vec::new();
    if !faces.is_empty() {
        add(4, format!("OPEN_SHELL('',({}))", faces.join(",")));
        add(5, format!("SHELL_BASED_SURFACE_MODEL('',(#{}))", id(4)));
        items.push(format!("#{}", id(5)));
    }
    if !surfaces.is_empty() {
        add(6, format!("GEOMETRIC_SET('',({}))", surfaces.join(",")));
        items.push(format!("#{}", id(6)));
    }
    let kind = match surfaces.is_empty() {
        true => "MANIFOLD_SURFACE_SHAPE_REPRESENTATION",
        false => "GEOMETRICALLY_BOUNDED_SURFACE_SHAPE_REPRESENTATION",
    };
    add(7, format!("{kind}('',({}),#{context})", items.join(",")));
    add(8, "APPLICATION_CONTEXT('')".into());
    add(9, format!("PRODUCT_CONTEXT('',#{},'mechanical')", id(8)));
    add(10, format!("PRODUCT('','','',(#{}))", id(9)));
    add(11, format!("PRODUCT_DEFINITION_FORMATION('','',#{})", id(10)));
    add(12, format!("PRODUCT_DEFINITION_CONTEXT('',#{},'design')", id(8)));
    add(13, format!("PRODUCT_DEFINITION('','',#{},#{})", id(11), id(12)));
    add(14, format!("PRODUCT_DEFINITION_SHAPE('','',#{})", id(13)));
    add(15, format!("SHAPE_DEFINITION_REPRESENTATION(#{},#{})", id(14), id(7)));
    text
}
