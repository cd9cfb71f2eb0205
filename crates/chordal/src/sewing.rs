//! Sewing of a model before it is meshed, and what the report says of it.

use crate::placement::{PartUse, part_uses};
use crate::{QuantityError, parse_length};
use chordal_brep::{Model, Part};
use chordal_sew::{SewReport, SewTolerance, has_topology, sew_part};
use rayon::prelude::*;
use std::fmt;
use std::str::FromStr;

/// Whether edges that one face alone uses are sewn to their neighbours.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Sew {
    /// `Auto` for parts no two faces of which share an edge: their file has no topology. Other parts stay as they are.
    #[default]
    WhereLoose,
    Off,
    /// With a tolerance from the part's own resolution and gaps.
    Auto,
    /// Borders within this many millimetres are sewn.
    Millimetres(f64),
}

impl fmt::Display for Sew {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Sew::WhereLoose => f.write_str("auto-if-unshared"),
            Sew::Off => f.write_str("off"),
            Sew::Auto => f.write_str("auto"),
            Sew::Millimetres(mm) => write!(f, "{mm} mm"),
        }
    }
}

impl FromStr for Sew {
    type Err = QuantityError;

    fn from_str(text: &str) -> Result<Self, QuantityError> {
        match text.trim() {
            "auto" => Ok(Sew::Auto),
            "off" => Ok(Sew::Off),
            length => parse_length(length).map(Sew::Millimetres),
        }
    }
}

/// Sews the parts of a model in place, each by itself; one report per part, `None` where nothing was asked.
pub fn sew_model(model: &mut Model, sew: Sew) -> Vec<Option<SewReport>> {
    let uses = part_uses(model);
    let parts = model.parts.par_iter_mut().zip(&uses);
    parts
        .map(|(part, part_use)| {
            let tolerance = tolerance(part, part_use, sew)?;
            let (sewn, report) = sew_part(part, tolerance);
            *part = sewn;
            Some(report)
        })
        .collect()
}

fn tolerance(part: &Part, part_use: &PartUse, sew: Sew) -> Option<SewTolerance> {
    match sew {
        _ if part.faces.is_empty() => None,
        Sew::Off => None,
        Sew::WhereLoose => (part.faces.len() > 1 && !has_topology(part)).then_some(SewTolerance::Auto),
        Sew::Auto => Some(SewTolerance::Auto),
        Sew::Millimetres(mm) => Some(SewTolerance::Length(mm / part_use.scale)),
    }
}
