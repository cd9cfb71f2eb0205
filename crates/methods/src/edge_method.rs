//! Methods of cutting edges into chords, by name.

use crate::edge::{self, Criterion};
use crate::fill::Cut;
use chordal_tessellate::Trace;
use chordal_tessellate::method::{EdgePiece, EdgeSplitter, EdgeUse};
use std::sync::Arc;

/// How edges become polylines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum EdgeMethod {
    /// Trimming curves approximated in the plane of parameters, over each leaf of a quadtree by what the leaf
    /// stretches lengths.
    Bezier2d,
    /// Trimming curves lifted into space and approximated there.
    Bezier3d {
        criterion: Criterion,
        cut: Cut,
        /// Leave out vertices along the whole curve that a quarter of the tolerance does not need.
        simplified: bool,
    },
}

/// An edge method as the command line and the papers know it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EdgeMethodEntry {
    /// None for the default mesher.
    pub method: Option<EdgeMethod>,
    /// The name on the command line and in reports.
    pub name: &'static str,
    /// One line of help.
    pub summary: &'static str,
}

const fn lifted(
    criterion: Criterion,
    cut: Cut,
    simplified: bool,
    name: &'static str,
    summary: &'static str,
) -> EdgeMethodEntry {
    EdgeMethodEntry { method: Some(EdgeMethod::Bezier3d { criterion, cut, simplified }), name, summary }
}

static ENTRIES: &[EdgeMethodEntry] = &[
    EdgeMethodEntry {
        method: None,
        name: "default",
        summary: "as few chords as the curve and its faces allow",
    },
    EdgeMethodEntry {
        method: Some(EdgeMethod::Bezier2d),
        name: "bezier2d",
        summary: "Bézier curves in the plane of parameters, leaf by leaf of a quadtree",
    },
    lifted(
        Criterion::Line,
        Cut::Midpoint,
        true,
        "bezier3d",
        "lifted Bézier curves halved by their distance to lines, then simplified",
    ),
    lifted(
        Criterion::Line,
        Cut::Midpoint,
        false,
        "bezier3d-line",
        "lifted Bézier curves halved by their distance to lines",
    ),
    lifted(
        Criterion::Point,
        Cut::Midpoint,
        false,
        "bezier3d-point",
        "lifted Bézier curves halved by their distance to points",
    ),
    lifted(
        Criterion::Line,
        Cut::WorstPoint,
        true,
        "bezier3d-worst",
        "lifted Bézier curves cut at control points, lines, then simplified",
    ),
    lifted(
        Criterion::Line,
        Cut::WorstPoint,
        false,
        "bezier3d-worst-line",
        "lifted Bézier curves cut at control points by their distance to lines",
    ),
    lifted(
        Criterion::Point,
        Cut::WorstPoint,
        false,
        "bezier3d-worst-point",
        "lifted Bézier curves cut at control points by their distance to points",
    ),
];

impl EdgeMethodEntry {
    /// The method for the options of the mesher; none for the default mesher.
    pub fn edge_splitter(&self) -> Option<Arc<dyn EdgeSplitter>> {
        self.method.map(|method| Arc::new(method) as Arc<dyn EdgeSplitter>)
    }
}

/// Every edge method with its name, the default mesher first.
pub fn edge_methods() -> &'static [EdgeMethodEntry] {
    ENTRIES
}

/// The edge method of this name.
pub fn edge_method_named(name: &str) -> Option<&'static EdgeMethodEntry> {
    ENTRIES.iter().find(|e| e.name == name)
}

impl EdgeSplitter for EdgeMethod {
    fn name(&self) -> &str {
        ENTRIES.iter().find(|e| e.method == Some(*self)).map_or("unnamed", |e| e.name)
    }

    fn parameters(
        &self,
        piece: &EdgePiece<'_>,
        uses: &[EdgeUse<'_, '_>],
        trace: &mut Trace,
    ) -> Option<Vec<f64>> {
        let found = match *self {
            EdgeMethod::Bezier2d => edge::in_plane(piece, uses, trace),
            EdgeMethod::Bezier3d { criterion, cut, simplified } => {
                edge::in_space(piece, uses, (criterion, cut, simplified), trace)
            }
        }?;
        Some(edge::vertices(piece, found))
    }

    fn is_in_space(&self) -> bool {
        matches!(self, EdgeMethod::Bezier3d { .. })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_methods_are_one_to_one() {
        for (i, e) in ENTRIES.iter().enumerate() {
            assert_eq!(edge_method_named(e.name), Some(e));
            assert_eq!(e.edge_splitter().map(|s| s.name().to_owned()), e.method.map(|_| e.name.to_owned()));
            assert!(ENTRIES[..i].iter().all(|o| o.method != e.method && o.name != e.name));
        }
        assert_eq!(edge_method_named("nonsense"), None);
    }
}
