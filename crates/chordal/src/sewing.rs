//! Sewing of a model before it is meshed: faces that share no edges get shared ones.

use crate::placement::PartUse;
use crate::quantity::{QuantityError, parse_length};
use chordal_brep::{Model, Part};
use chordal_sew::{SewReport, SewTolerance, has_topology, sew_part};
use rayon::prelude::*;
use std::fmt;
use std::str::FromStr;
use std::sync::Arc;

/// Whether edges that one face alone uses are sewn to their neighbours.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum Sewing {
    /// [`Sewing::Auto`] for parts without an edge that two faces share; other parts stay as they are.
    #[default]
    AutoIfUnshared,
    /// Parts stay as they are.
    Off,
    /// With a tolerance from the part's own resolution and gaps.
    Auto,
    /// Borders within this many millimetres are sewn.
    Millimetres(f64),
}

impl fmt::Display for Sewing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Sewing::AutoIfUnshared => f.write_str("auto-if-unshared"),
            Sewing::Off => f.write_str("off"),
            Sewing::Auto => f.write_str("auto"),
            Sewing::Millimetres(mm) => write!(f, "{mm} mm"),
        }
    }
}

impl FromStr for Sewing {
    type Err = QuantityError;

    fn from_str(text: &str) -> Result<Self, QuantityError> {
        match text.trim() {
            "auto" => Ok(Sewing::Auto),
            "off" => Ok(Sewing::Off),
            length => parse_length(length).map(Sewing::Millimetres),
        }
    }
}

/// Sews the parts of a model, each by itself: the model, and one report per part, `None` where it was not
/// sewn. A model that is not sewn is not copied.
pub fn sew_parts(
    model: Arc<Model>,
    uses: &[PartUse],
    sewing: Sewing,
) -> (Arc<Model>, Vec<Option<SewReport>>) {
    let parts = model.parts.par_iter().zip(uses);
    let sewn: Vec<Option<(Part, SewReport)>> =
        parts.map(|(part, part_use)| Some(sew_part(part, tolerance(part, part_use, sewing)?))).collect();
    if sewn.iter().all(Option::is_none) {
        return (model, sewn.iter().map(|_| None).collect());
    }
    let mut model = Arc::unwrap_or_clone(model);
    let mut reports = Vec::with_capacity(sewn.len());
    for (part, sewn) in model.parts.iter_mut().zip(sewn) {
        reports.push(sewn.map(|(sewn, report)| {
            *part = sewn;
            report
        }));
    }
    (Arc::new(model), reports)
}

fn tolerance(part: &Part, part_use: &PartUse, sewing: Sewing) -> Option<SewTolerance> {
    match sewing {
        _ if part.faces.is_empty() => None,
        Sewing::Off => None,
        Sewing::AutoIfUnshared => (part.faces.len() > 1 && !has_topology(part)).then_some(SewTolerance::Auto),
        Sewing::Auto => Some(SewTolerance::Auto),
        Sewing::Millimetres(mm) => Some(SewTolerance::Length(mm / part_use.scale)),
    }
}
