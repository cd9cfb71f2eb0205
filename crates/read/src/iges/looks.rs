//! Names, colours and levels of entities.
//!
//! A name is a property (406, form 15) that the entity points to behind its own parameters, else its label in
//! the directory. Colours are sRGB percentages; the model holds linear values.

use super::builder::Builder;
use super::document::{Doc, Ix};
use crate::trimmed::Look;
use chordal_brep::Color;

/// The colours that have numbers: black, red, green, blue, yellow, magenta, cyan, white.
const NUMBERED: [[f64; 3]; 8] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [1.0, 1.0, 0.0],
    [1.0, 0.0, 1.0],
    [0.0, 1.0, 1.0],
    [1.0, 1.0, 1.0],
];

impl Builder<'_, '_> {
    /// What an entity has besides its shape.
    pub(crate) fn look(&self, ix: Ix) -> Look {
        Look {
            name: name(self.doc, ix),
            color: color(self.doc, ix),
            layer: layer(self.doc, ix),
            flipped: false,
            source: self.doc.source(ix),
        }
    }
}

/// The name that a property gives, else the label.
pub(crate) fn name(doc: &Doc<'_>, ix: Ix) -> String {
    let stated = properties(doc, ix).into_iter().find_map(|property| {
        let is_name = doc.kind(property) == 406 && doc.entry(property).form == 15;
        let mut args = doc.open(property).ok().filter(|_| is_name)?;
        args.skip(1);
        Some(args.string()).filter(|name| !name.is_empty())
    });
    stated.unwrap_or_else(|| doc.entry(ix).label.clone())
}

/// The number of an entity's own parameters, for the types that may have names.
fn own_parameters(doc: &Doc<'_>, ix: Ix) -> Option<usize> {
    let mut args = doc.open(ix).ok()?;
    let mut number = |skip: usize| {
        args.skip(skip);
        args.integer().ok().and_then(|n| usize::try_from(n).ok()).filter(|&n| n < 1 << 31)
    };
    Some(match doc.kind(ix) {
        108 => 9,
        118 | 120 | 122 => 4,
        128 => {
            let [k1, k2, m1, m2] = [number(0)?, number(0)?, number(0)?, number(0)?];
            9 + (k1 + m1 + 2) + (k2 + m2 + 2) + 4 * (k1 + 1).checked_mul(k2 + 1)? + 4
        }
        140 => 5,
        143 => 3 + number(2)?,
        144 => 4 + number(2)?,
        186 => 3 + 2 * number(2)?,
        308 => 3 + number(2)?,
        402 => 1 + number(0)?,
        408 => 5,
        510 => 3 + number(1)?,
        514 => 1 + 2 * number(0)?,
        _ => return None,
    })
}

/// The properties that an entity points to behind its parameters and its associations.
fn properties(doc: &Doc<'_>, ix: Ix) -> Vec<Ix> {
    let found = || {
        let own = own_parameters(doc, ix)?;
        let mut args = doc.open(ix).ok()?;
        args.skip(own);
        let associations = args.count().ok()?;
        args.skip(associations);
        let count = args.count().ok()?;
        Some((0..count).filter_map(|_| args.optional_reference().ok().flatten()).collect())
    };
    found().unwrap_or_default()
}

/// The level; of several the first.
fn layer(doc: &Doc<'_>, ix: Ix) -> Option<String> {
    let level = doc.entry(ix).level;
    if level < 0 {
        let list = doc.find(level).filter(|&list| doc.kind(list) == 406)?;
        let mut args = doc.open(list).ok()?;
        args.count().ok().filter(|&count| count > 0)?;
        return args.integer().ok().map(|level| level.to_string());
    }
    (level > 0).then(|| level.to_string())
}

fn color(doc: &Doc<'_>, ix: Ix) -> Option<Color> {
    let stated = doc.entry(ix).color;
    if stated > 0 {
        let rgb = usize::try_from(stated - 1).ok().and_then(|i| NUMBERED.get(i))?;
        return Some(linear(*rgb));
    }
    let entity = doc.find(stated).filter(|&color| stated < 0 && doc.kind(color) == 314)?;
    let mut args = doc.open(entity).ok()?;
    let percent = [args.real().ok()?, args.real().ok()?, args.real().ok()?];
    Some(linear(percent.map(|p| (p / 100.0).clamp(0.0, 1.0))))
}

fn linear(srgb: [f64; 3]) -> Color {
    let [r, g, b] = srgb.map(crate::srgb::linear);
    Color([r, g, b, 1.0])
}
