//! Units of a representation context.

use super::args::Kind;
use super::document::{Doc, Ix};
use super::keyword::Kw;
use chordal_brep::{Millimetres, ReadIssue};

/// Units and accuracy of one context.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Units {
    /// Millimetres per length unit.
    pub length_mm: f64,
    /// Radians per angle unit.
    pub angle_rad: f64,
    /// The stated accuracy, in length units.
    pub uncertainty: Option<f64>,
    pub name: String,
}

impl Default for Units {
    fn default() -> Self {
        Self { length_mm: 1.0, angle_rad: 1.0, uncertainty: None, name: "mm".to_owned() }
    }
}

/// Chains of conversion longer than this are circular.
const MAX_CHAIN: u32 = 8;

/// What one unit entity is.
enum Unit {
    /// Millimetres per unit, and the unit's name.
    Length(f64, String),
    /// Radians per unit.
    Angle(f64),
    Other,
}

impl Units {
    /// A length in the file's unit, for messages.
    pub(crate) fn millimetres(&self, length: f64) -> Millimetres {
        Millimetres(length * self.length_mm)
    }

    /// The units of a context entity; missing units are millimetres and radians.
    pub(crate) fn of_context(doc: &Doc<'_>, context: Ix) -> Self {
        let mut units = Self::default();
        let mut found_length = false;
        if let Ok(Some(mut args)) = doc.find_leaf(context, Kw::GlobalUnitAssignedContext) {
            for unit in args.references_or_warn() {
                match read_unit(doc, unit, 0) {
                    Unit::Length(mm, name) if !found_length => {
                        found_length = true;
                        units.length_mm = mm;
                        units.name = name;
                    }
                    Unit::Angle(rad) => units.angle_rad = rad,
                    _ => {}
                }
            }
        }
        if !found_length {
            doc.warn(context, ReadIssue::UnitMissing);
        }
        if let Ok(Some(mut args)) = doc.find_leaf(context, Kw::GlobalUncertaintyAssignedContext) {
            let stated = args.references_or_warn();
            units.uncertainty = stated.into_iter().find_map(|ix| uncertainty(doc, ix, units.length_mm));
        }
        units
    }
}

/// UNCERTAINTY_MEASURE_WITH_UNIT of a length, in units of `length_mm` millimetres.
fn uncertainty(doc: &Doc<'_>, ix: Ix, length_mm: f64) -> Option<f64> {
    let mut args = doc.leaf(ix, Kw::UncertaintyMeasureWithUnit).ok()?;
    let value = args.real().ok().filter(|&v| v > 0.0)?;
    match args.optional_reference().map(|unit| read_unit(doc, unit, 0)) {
        Some(Unit::Length(mm, _)) => Some(value * mm / length_mm),
        _ => None,
    }
}

fn read_unit(doc: &Doc<'_>, ix: Ix, depth: u32) -> Unit {
    if depth > MAX_CHAIN {
        doc.notes.warn(doc.source(ix), ReadIssue::Recursive { keyword: doc.word(ix), levels: MAX_CHAIN });
        return Unit::Other;
    }
    let kinds = doc.kinds(ix);
    let has = |kw| kinds.contains(&kw);
    let length = has(Kw::LengthUnit);
    let angle = has(Kw::PlaneAngleUnit);
    if has(Kw::ConversionBasedUnit) {
        return conversion(doc, ix, depth);
    }
    if has(Kw::SiUnit) {
        let Ok(mut args) = doc.leaf(ix, Kw::SiUnit) else { return Unit::Other };
        if kinds.len() == 1 && args.left() == 3 {
            args.skip(1);
        }
        let prefix = if args.kind() == Kind::Enumeration {
            args.enumeration()
        } else {
            args.skip(1);
            None
        };
        let (factor, prefix_name) = prefix_factor(prefix.unwrap_or_default());
        return match args.enumeration() {
            Some(b"METRE") => Unit::Length(factor * 1000.0, format!("{prefix_name}m")),
            Some(b"RADIAN") => Unit::Angle(factor),
            _ if length || angle => {
                doc.warn(ix, ReadIssue::UnitUnknown { name: String::new(), assumed: "" });
                Unit::Other
            }
            _ => Unit::Other,
        };
    }
    Unit::Other
}

/// CONVERSION_BASED_UNIT(name, factor): a multiple of another unit.
fn conversion(doc: &Doc<'_>, ix: Ix, depth: u32) -> Unit {
    let Ok(mut args) = doc.leaf(ix, Kw::ConversionBasedUnit) else { return Unit::Other };
    let name = args.string();
    let Some(measure) = args.optional_reference() else { return named(doc, ix, &name) };
    let kinds = [Kw::LengthMeasureWithUnit, Kw::PlaneAngleMeasureWithUnit, Kw::MeasureWithUnit];
    let Some(mut args) = kinds.iter().find_map(|&kw| doc.find_leaf(measure, kw).ok().flatten()) else {
        return named(doc, ix, &name);
    };
    let (Some(factor), Some(unit)) = (args.optional_real(), args.optional_reference()) else {
        return named(doc, ix, &name);
    };
    if factor <= 0.0 {
        return named(doc, ix, &name);
    }
    match read_unit(doc, unit, depth + 1) {
        Unit::Length(mm, _) => Unit::Length(factor * mm, name.to_lowercase()),
        Unit::Angle(rad) => Unit::Angle(exact_degree(factor * rad)),
        Unit::Other => Unit::Other,
    }
}

/// Files round the degree to few digits; the exact one is meant.
fn exact_degree(rad: f64) -> f64 {
    let degree = std::f64::consts::PI / 180.0;
    if (rad / degree - 1.0).abs() < 1e-4 { degree } else { rad }
}

/// A conversion whose factor cannot be read, by the unit's name.
fn named(doc: &Doc<'_>, ix: Ix, name: &str) -> Unit {
    let unit = match name.to_ascii_lowercase().as_str() {
        "inch" | "in" => Unit::Length(25.4, "inch".into()),
        "foot" | "ft" => Unit::Length(304.8, "foot".into()),
        "degree" | "deg" => Unit::Angle(std::f64::consts::PI / 180.0),
        _ => Unit::Other,
    };
    let name = name.to_owned();
    doc.warn(
        ix,
        match unit {
            Unit::Other => ReadIssue::UnitUnknown { name, assumed: "" },
            _ => ReadIssue::UnitByName { name },
        },
    );
    unit
}

fn prefix_factor(prefix: &[u8]) -> (f64, &'static str) {
    match prefix {
        b"EXA" => (1e18, "E"),
        b"PETA" => (1e15, "P"),
        b"TERA" => (1e12, "T"),
        b"GIGA" => (1e9, "G"),
        b"MEGA" => (1e6, "M"),
        b"KILO" => (1e3, "k"),
        b"HECTO" => (1e2, "h"),
        b"DECA" => (1e1, "da"),
        b"DECI" => (1e-1, "d"),
        b"CENTI" => (1e-2, "c"),
        b"MILLI" => (1e-3, "m"),
        b"MICRO" => (1e-6, "µ"),
        b"NANO" => (1e-9, "n"),
        b"PICO" => (1e-12, "p"),
        b"FEMTO" => (1e-15, "f"),
        b"ATTO" => (1e-18, "a"),
        _ => (1.0, ""),
    }
}
