//! Methods by name: a strategy is a choice of parts for the inside of a face.
//!
//! All strategies share the edges, the proof, the stitching and so the watertightness; none may set a vertex on an edge that its
//! neighbours do not know. What they choose is how a face is subdivided, how the subdivision is cut with the face's
//! loops, and how the polygons become triangles. Every part that ran leaves its name in the [`trace::Trace`], which
//! the report shows. `docs/strategies.md` says which document each method comes from.

pub(crate) mod node;
pub(crate) mod quadtree;
pub(crate) mod trace;

pub(crate) mod bezier;
mod borders;
#[cfg(test)]
mod bounds_tests;
mod cells;
mod chords;
mod constrain;
mod coving;
mod cut;
mod delaunay;
mod derivatives;
mod grid;
mod half_edges;
mod kd;
mod leaf_mesh;
mod loop_tree;
mod plain;
mod poles;
mod polygons;
mod projected;
mod recursive;
mod region;
#[cfg(test)]
mod restored;
mod run;
mod scanlines;
mod size;
#[cfg(test)]
mod testing;
mod tracking;

pub use delaunay::Fill;
pub(crate) use poles::refine_opened;
pub use quadtree::Stretch;
pub(crate) use run::fill;

use node::Measure;

/// Where a node of a subdivision is cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cut {
    /// Half way.
    Midpoint,
    /// At the control point farthest from the bilinear approximation.
    WorstPoint,
}

/// How the inside of faces is filled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Strategy {
    /// Grids and strips where the sizing metric allows them, points in the metric elsewhere.
    #[default]
    Default,
    /// A kd-tree whose direction of cutting is chosen at the worst point (Balázs, Guthe, Klein 2004, section 5.2).
    Kd(Cut),
    /// Binary subdivision across the direction that bends more (the same section).
    Binary(Cut),
    /// One grid for the whole face (survey of the Blender wiki, "Uniform Grid Cut").
    UniformGrid,
    /// A fixed number of cells per control cell and direction, 0 for as many as the bound asks for (the same survey,
    /// "direct tessellation").
    ControlCells { per_cell: u32 },
    /// Bézier patches halved by a bound from their derivative patches (the same survey, "Recursive Subdivision").
    Recursive,
    /// Bézier patches cut into four (Kahlesz, Balázs, Klein 2001, sections 4, 6 and 7).
    Quadtree(Stretch),
    /// A grid inside, joined to the boundary by triangles between them (survey of the Blender wiki, "Coving").
    Coving,
    /// Bézier patches as quadrilaterals (Ma, Hewitt 2002).
    Bezier,
    /// Fill points and a Delaunay triangulation (survey of the Blender wiki, "Delaunay Triangulation").
    Delaunay(Fill),
}

/// A strategy as the command line and the documents know it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StrategyEntry {
    pub strategy: Strategy,
    /// The name on the command line and in reports.
    pub name: &'static str,
    /// One line of help.
    pub summary: &'static str,
    /// Where it is described.
    pub source: &'static str,
}

const fn entry(
    strategy: Strategy,
    name: &'static str,
    summary: &'static str,
    source: &'static str,
) -> StrategyEntry {
    StrategyEntry { strategy, name, summary, source }
}

const BALAZS: &str = "Balázs, Guthe, Klein 2004, sections 5.2, 6 and 7";

const KAHLESZ: &str = "Kahlesz, Balázs, Klein 2001, sections 4, 6 and 7";
const GRID_CUT: &str = "Blender wiki, Uniform Grid Cut";
const DIRECT: &str = "Blender wiki, Tessellation Terminology: direct tessellation";
const RECURSIVE: &str = "Blender wiki, Recursive Subdivision / Piecewise Bézier";
const COVING: &str = "Blender wiki, Tessellation Terminology: coving";
const MA_HEWITT: &str = "Ma, Hewitt 2002, section 4";
const DELAUNAY: &str = "Blender wiki, Delaunay Triangulation";

/// Every strategy, in the order of the help.
static ENTRIES: &[StrategyEntry] = &[
    entry(Strategy::Default, "default", "rows and strips in the sizing metric", "docs/decisions"),
    entry(
        Strategy::Kd(Cut::Midpoint),
        "kd-midpoint",
        "kd-tree, halved in the direction of the worst point",
        BALAZS,
    ),
    entry(Strategy::Kd(Cut::WorstPoint), "kd-worst", "kd-tree, cut at the worst control point", BALAZS),
    entry(Strategy::Binary(Cut::Midpoint), "binary-midpoint", "cells halved across the larger bend", BALAZS),
    entry(Strategy::Binary(Cut::WorstPoint), "binary-worst", "cells cut where they bend most", BALAZS),
    entry(Strategy::UniformGrid, "grid", "one uniform grid per face", GRID_CUT),
    entry(Strategy::ControlCells { per_cell: 0 }, "cells", "equally many cells per control cell", DIRECT),
    entry(Strategy::Recursive, "recursive", "Bézier patches halved by their second derivatives", RECURSIVE),
    entry(Strategy::Quadtree(Stretch::SingularValue), "quadtree", "Bézier patches cut into four", KAHLESZ),
    entry(
        Strategy::Quadtree(Stretch::Edges),
        "quadtree-eq3",
        "the same with the document's bilinear norm",
        KAHLESZ,
    ),
    entry(Strategy::Coving, "coving", "a grid inside, triangles between it and the loops", COVING),
    entry(Strategy::Bezier, "bezier", "Bézier patches as quadrilaterals", MA_HEWITT),
    entry(
        Strategy::Delaunay(Fill::Uniform),
        "delaunay-uniform",
        "Delaunay triangles of a grid of points",
        DELAUNAY,
    ),
    entry(
        Strategy::Delaunay(Fill::Adaptive),
        "delaunay-adaptive",
        "Delaunay triangles, points by deviation",
        DELAUNAY,
    ),
];

impl Strategy {
    /// Every strategy with its name and source.
    pub fn entries() -> &'static [StrategyEntry] {
        ENTRIES
    }

    /// The name on the command line and in reports.
    pub fn name(self) -> &'static str {
        let named = match self {
            Strategy::ControlCells { .. } => Strategy::ControlCells { per_cell: 0 },
            other => other,
        };
        ENTRIES.iter().find(|e| e.strategy == named).map_or("unnamed", |e| e.name)
    }

    /// The strategy of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        ENTRIES.iter().find(|e| e.name == name).map(|e| e.strategy)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_strategies_are_one_to_one() {
        for (i, e) in ENTRIES.iter().enumerate() {
            assert_eq!(Strategy::from_name(e.name), Some(e.strategy));
            assert_eq!(e.strategy.name(), e.name);
            assert!(ENTRIES[..i].iter().all(|other| other.strategy != e.strategy && other.name != e.name));
        }
        assert_eq!(Strategy::from_name("nonsense"), None);
    }
}
