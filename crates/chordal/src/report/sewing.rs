//! What sewing did, as data.

use super::entity_name;
use chordal_brep::Part;
use chordal_sew::{AutoTolerance, GapBin, SewReport};
use serde::{Deserialize, Serialize};

/// So many open edges of a part are listed, the longest first; all are counted.
const LISTED: usize = 50;

/// What sewing did to one part; lengths are millimetres in its largest placement.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct SewingEntry {
    /// The name of the part.
    pub part: String,
    /// The entity of the part in the file.
    pub entity: Option<String>,
    /// Borders closer than this were joined.
    pub tolerance: f64,
    /// How the tolerance was found; `null` where the caller gave it.
    pub auto: Option<GapSurvey>,
    /// Edges that only one face used before.
    pub open_before: usize,
    /// Edges that borders were joined to.
    pub joined: usize,
    /// Those of them that more than two faces share.
    pub non_manifold: usize,
    /// Edges that were split where the end of another edge meets them.
    pub split: usize,
    /// Edges shorter than the tolerance that became a vertex.
    pub collapsed: usize,
    /// Edges that only one face still uses.
    pub open_after: usize,
    /// The longest of them.
    pub open: Vec<OpenEntry>,
    /// The largest distance that a vertex, or a point of an edge, moved; contained in `max_edge_gap`.
    pub largest_move: f64,
    /// Faces whose orientation was reversed to agree with their neighbours.
    pub flipped: usize,
    /// Pairs of neighbouring faces whose orientations still disagree.
    pub orientation_conflicts: usize,
    /// Connected shells.
    pub shells: usize,
    /// Those of them that are closed.
    pub closed_shells: usize,
}

/// An edge that stays open.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct OpenEntry {
    /// The entity of the edge in the file.
    pub entity: Option<String>,
    /// The entity of its face in the file.
    pub face: Option<String>,
    /// Its length.
    pub length: f64,
    /// From its middle to the nearest other open edge; `null` where there is none.
    pub nearest: Option<f64>,
}

/// The distances between open edges and the tolerance that follows from them; millimetres.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct GapSurvey {
    /// The tolerance that `auto` takes.
    pub tolerance: f64,
    /// The accuracy of the coordinates in the file.
    pub resolution: f64,
    /// The empty range of the histogram between joints, below, and openings, above.
    pub empty_range: [f64; 2],
    /// The range is wide enough that joints and openings do not mix.
    pub unambiguous: bool,
    /// Gaps up to the tolerance.
    pub below: usize,
    /// Gaps above the tolerance.
    pub above: usize,
    /// From, below, count.
    pub histogram: Vec<(f64, f64, usize)>,
}

impl GapSurvey {
    /// `scale`: from the part's units to millimetres.
    pub(crate) fn new(auto: &AutoTolerance, scale: f64) -> Self {
        let bin = |b: &GapBin| (b.from * scale, b.below * scale, b.count);
        Self {
            tolerance: auto.tolerance * scale,
            resolution: auto.resolution * scale,
            empty_range: auto.empty_range.map(|g| g * scale),
            unambiguous: auto.clear,
            below: auto.gaps[0],
            above: auto.gaps[1],
            histogram: auto.histogram.iter().map(bin).collect(),
        }
    }
}

impl SewingEntry {
    /// `scale`: from the part's units to millimetres.
    pub(crate) fn new(part: &Part, report: &SewReport, scale: f64) -> Self {
        let mut open: Vec<&chordal_sew::OpenEdge> = report.open.iter().collect();
        open.sort_by(|a, b| b.length.total_cmp(&a.length).then(a.edge.cmp(&b.edge)));
        let entry = |o: &&chordal_sew::OpenEdge| OpenEntry {
            entity: entity_name(o.source),
            face: entity_name(part.faces[o.face.index()].source),
            length: o.length * scale,
            nearest: o.nearest.map(|d| d * scale),
        };
        Self {
            part: part.name.clone(),
            entity: entity_name(part.source),
            tolerance: report.tolerance * scale,
            auto: report.auto.as_ref().map(|a| GapSurvey::new(a, scale)),
            open_before: report.open_before,
            joined: report.sewn,
            non_manifold: report.shared_by_more,
            split: report.cuts,
            collapsed: report.vanished,
            open_after: report.open.len(),
            open: open.iter().take(LISTED).map(entry).collect(),
            largest_move: report.largest_move * scale,
            flipped: report.turned,
            orientation_conflicts: report.contradictions,
            shells: report.shells,
            closed_shells: report.closed_shells,
        }
    }
}
