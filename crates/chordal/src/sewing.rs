//! Sewing of a model before it is meshed, and what the report says of it.

use crate::names::entity_id;
use crate::placement::{PartUse, part_uses};
use crate::{QuantityError, parse_length};
use chordal_brep::{Model, Part};
use chordal_sew::{AutoTolerance, GapBin, SewReport, SewTolerance, has_topology, sew_part};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// So many open edges of a part are listed, the longest first; all are counted.
const LISTED: usize = 50;

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
            Sew::WhereLoose => f.write_str("auto where loose"),
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

/// What sewing did to one part; lengths are millimetres in its largest placement.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SewingEntry {
    pub part: String,
    pub id: String,
    /// The merge tolerance.
    pub tolerance: f64,
    /// How it was found; `null` where it was given.
    pub auto: Option<GapSurvey>,
    /// Edges that one face alone used.
    pub open_before: usize,
    /// Edges that borders were joined to, those with more than two faces among them, and cuts at T-ends.
    pub sewn: usize,
    pub shared_by_more: usize,
    pub cuts: usize,
    /// Edges shorter than the tolerance that became a vertex.
    pub vanished: usize,
    /// Edges that one face alone still uses.
    pub open_after: usize,
    /// The longest of them.
    pub open: Vec<OpenEntry>,
    /// The largest distance that a vertex, or a point of an edge, was moved by; contained in `max_gap`.
    pub largest_move: f64,
    /// Faces that were turned over to agree with their neighbours, and pairs that still disagree.
    pub turned: usize,
    pub contradictions: usize,
    /// Connected shells, and those of them that are closed.
    pub shells: usize,
    pub closed_shells: usize,
}

/// An edge that stays open.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct OpenEntry {
    /// The entity in the file of the edge, and of its face.
    pub id: String,
    pub face: String,
    pub length: f64,
    /// From its middle to the nearest other open edge.
    pub nearest: Option<f64>,
}

/// How far borders are from each other, and the tolerance that follows; millimetres.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct GapSurvey {
    pub tolerance: f64,
    pub resolution: f64,
    /// The lower and upper end of the valley between joints and openings.
    pub valley: [f64; 2],
    pub clear: bool,
    /// Gaps measured up to the tolerance, and above it.
    pub below: usize,
    pub above: usize,
    /// From, below, count.
    pub histogram: Vec<(f64, f64, usize)>,
}

impl GapSurvey {
    pub(crate) fn new(auto: &AutoTolerance, scale: f64) -> Self {
        let bin = |b: &GapBin| (b.from * scale, b.below * scale, b.count);
        Self {
            tolerance: auto.tolerance * scale,
            resolution: auto.resolution * scale,
            valley: auto.valley.map(|g| g * scale),
            clear: auto.clear,
            below: auto.gaps[0],
            above: auto.gaps[1],
            histogram: auto.histogram.iter().map(bin).collect(),
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

impl SewingEntry {
    pub(crate) fn new(part: &Part, report: &SewReport, scale: f64) -> Self {
        let mut open: Vec<&chordal_sew::OpenEdge> = report.open.iter().collect();
        open.sort_by(|a, b| b.length.total_cmp(&a.length).then(a.edge.cmp(&b.edge)));
        let entry = |o: &&chordal_sew::OpenEdge| OpenEntry {
            id: entity_id(o.source),
            face: entity_id(part.faces[o.face.index()].source),
            length: o.length * scale,
            nearest: o.nearest.map(|d| d * scale),
        };
        Self {
            part: part.name.clone(),
            id: entity_id(part.source),
            tolerance: report.tolerance * scale,
            auto: report.auto.as_ref().map(|a| GapSurvey::new(a, scale)),
            open_before: report.open_before,
            sewn: report.sewn,
            shared_by_more: report.shared_by_more,
            cuts: report.cuts,
            vanished: report.vanished,
            open_after: report.open.len(),
            open: open.iter().take(LISTED).map(entry).collect(),
            largest_move: report.largest_move * scale,
            turned: report.turned,
            contradictions: report.contradictions,
            shells: report.shells,
            closed_shells: report.closed_shells,
        }
    }
}
