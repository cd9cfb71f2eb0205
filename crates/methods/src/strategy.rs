//! Methods of filling faces, by name.
//!
//! Every part of a method that ran leaves its name in the trace of the face, which the report shows.
//! `docs/methods.md` says which document each method comes from.

use crate::fill::Cut;
use crate::fill::bezier::BezierQuads;
use crate::fill::by_cells::ByCells;
use crate::fill::coving::Coving;
use crate::fill::delaunay::{Delaunay, Fill};
use crate::fill::grid::{ControlCells, UniformGrid};
use crate::fill::kd::{Binary, Kd};
use crate::fill::node::Measure;
use crate::fill::polygons::Filling;
use crate::fill::quadtree::{Quadtree, SURFACE_SHARE, Stretch};
use crate::fill::recursive::Recursive;
use chordal_brep::MeshIssue;
use chordal_tessellate::method::{FaceFiller, FaceMesh, FillMethod, FillTask};
use std::sync::Arc;

/// How the inside of faces is filled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Strategy {
    /// A kd-tree whose direction of cutting is chosen at the worst point (Balázs, Guthe, Klein 2004, section
    /// 5.2).
    Kd(Cut),
    /// Binary subdivision across the direction that bends more (the same section).
    Binary(Cut),
    /// One grid for the whole face (survey of the Blender wiki, "Uniform Grid Cut").
    UniformGrid,
    /// A fixed number of cells per control cell and direction, 0 for as many as the bound requires (the same
    /// survey, "direct tessellation").
    ControlCells { per_cell: u32 },
    /// Bézier patches halved by a bound from their derivative patches (the same survey, "Recursive
    /// Subdivision").
    Recursive,
    /// Bézier patches cut into four (Kahlesz, Balázs, Klein 2001, sections 4, 6 and 7).
    Quadtree(Stretch),
    /// A grid inside, joined to the boundary by triangles between them (survey of the Blender wiki,
    /// "Coving").
    Coving,
    /// Bézier patches as quadrilaterals (Ma, Hewitt 2002).
    Bezier,
    /// Fill points and a Delaunay triangulation (survey of the Blender wiki, "Delaunay Triangulation").
    Delaunay(Fill),
}

/// A strategy as the command line and the papers know it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StrategyEntry {
    /// None for the default mesher.
    pub strategy: Option<Strategy>,
    /// The name on the command line and in reports.
    pub name: &'static str,
    /// One line of help.
    pub summary: &'static str,
    /// Where it is described.
    pub source: &'static str,
}

const fn entry(
    strategy: Option<Strategy>,
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
    entry(None, "default", "rows and strips in the sizing metric", "docs/decisions"),
    entry(
        Some(Strategy::Kd(Cut::Midpoint)),
        "kd-midpoint",
        "kd-tree, halved in the direction of the worst point",
        BALAZS,
    ),
    entry(Some(Strategy::Kd(Cut::WorstPoint)), "kd-worst", "kd-tree, cut at the worst control point", BALAZS),
    entry(
        Some(Strategy::Binary(Cut::Midpoint)),
        "binary-midpoint",
        "cells halved across the larger bend",
        BALAZS,
    ),
    entry(Some(Strategy::Binary(Cut::WorstPoint)), "binary-worst", "cells cut where they bend most", BALAZS),
    entry(Some(Strategy::UniformGrid), "grid", "one uniform grid per face", GRID_CUT),
    entry(
        Some(Strategy::ControlCells { per_cell: 0 }),
        "cells",
        "equally many cells per control cell",
        DIRECT,
    ),
    entry(
        Some(Strategy::Recursive),
        "recursive",
        "Bézier patches halved by their second derivatives",
        RECURSIVE,
    ),
    entry(
        Some(Strategy::Quadtree(Stretch::SingularValue)),
        "quadtree",
        "Bézier patches cut into four",
        KAHLESZ,
    ),
    entry(
        Some(Strategy::Quadtree(Stretch::Edges)),
        "quadtree-eq3",
        "quadtree with the norm of equation 3 of Kahlesz 2001",
        KAHLESZ,
    ),
    entry(Some(Strategy::Coving), "coving", "a grid inside, triangles between it and the loops", COVING),
    entry(Some(Strategy::Bezier), "bezier", "Bézier patches as quadrilaterals", MA_HEWITT),
    entry(
        Some(Strategy::Delaunay(Fill::Uniform)),
        "delaunay-uniform",
        "Delaunay triangles of a grid of points",
        DELAUNAY,
    ),
    entry(
        Some(Strategy::Delaunay(Fill::Adaptive)),
        "delaunay-adaptive",
        "Delaunay triangles, points by deviation",
        DELAUNAY,
    ),
];

impl StrategyEntry {
    /// The method for the options of the mesher; none for the default mesher.
    pub fn fill_method(&self) -> Option<Arc<dyn FillMethod>> {
        self.strategy.map(|strategy| Arc::new(strategy) as Arc<dyn FillMethod>)
    }
}

/// Every strategy with its name and source, the default mesher first.
pub fn strategies() -> &'static [StrategyEntry] {
    ENTRIES
}

/// The strategy of this name.
pub fn strategy_named(name: &str) -> Option<&'static StrategyEntry> {
    ENTRIES.iter().find(|e| e.name == name)
}

impl FillMethod for Strategy {
    fn name(&self) -> &str {
        let named = match self {
            Strategy::ControlCells { .. } => Strategy::ControlCells { per_cell: 0 },
            other => *other,
        };
        ENTRIES.iter().find(|e| e.strategy == Some(named)).map_or("unnamed", |e| e.name)
    }

    fn begin(&self, face: &FaceMesh<'_, '_>, task: FillTask) -> Result<Box<dyn FaceFiller>, MeshIssue> {
        let measure = Measure::of(task.bound);
        // Curves that are approximated in space leave the surface all of the tolerance.
        let share = if task.edges_in_space { 1.0 } else { SURFACE_SHARE };
        let cells =
            |rule, filling| Ok(Box::new(ByCells::new(face, task, rule, filling)?) as Box<dyn FaceFiller>);
        match *self {
            Strategy::Kd(cut) => cells(Box::new(Kd(cut)), Filling::FanOrMonotone),
            Strategy::Binary(cut) => cells(Box::new(Binary(cut)), Filling::FanOrMonotone),
            Strategy::UniformGrid => cells(Box::new(UniformGrid::COARSEST), Filling::FanOrMonotone),
            Strategy::ControlCells { per_cell } => {
                cells(Box::new(ControlCells { per_cell }), Filling::FanOrMonotone)
            }
            Strategy::Recursive => cells(Box::new(Recursive), Filling::FanOrMonotone),
            Strategy::Quadtree(stretch) => cells(Box::new(Quadtree { stretch, share }), Filling::Delaunay),
            Strategy::Coving => Ok(Box::new(Coving::new(face, measure)?)),
            Strategy::Bezier => Ok(Box::new(BezierQuads::new(face, measure)?)),
            Strategy::Delaunay(fill) => Ok(Box::new(Delaunay::new(face, fill))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_strategies_are_one_to_one() {
        for (i, e) in ENTRIES.iter().enumerate() {
            assert_eq!(strategy_named(e.name), Some(e));
            assert_eq!(e.fill_method().map(|m| m.name().to_owned()), e.strategy.map(|_| e.name.to_owned()));
            assert!(ENTRIES[..i].iter().all(|other| other.strategy != e.strategy && other.name != e.name));
        }
        assert_eq!(strategy_named("nonsense"), None);
    }
}
