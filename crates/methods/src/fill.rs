//! The parts that methods of filling faces are made of.
//!
//! A method is a choice of parts: how a face is subdivided ([`cells`] and a rule each), how the subdivision
//! is cut with the loops ([`borders`], [`cut`], [`constrain`]), and how the polygons become triangles
//! ([`half_edges`], [`polygons`]).

pub mod bezier;
mod borders;
pub mod by_cells;
mod cells;
mod chords;
mod constrain;
pub mod coving;
mod cut;
pub mod delaunay;
mod derivatives;
pub mod grid;
mod half_edges;
pub mod kd;
mod leaf_mesh;
mod loop_tree;
pub mod node;
mod plain;
pub mod polygons;
mod projected;
pub mod quadtree;
pub mod recursive;
mod region;
mod scanlines;
mod size;
mod tracking;

#[cfg(test)]
mod bounds_tests;
#[cfg(test)]
mod restored;
#[cfg(test)]
mod testing;

/// Where a node of a subdivision is cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cut {
    /// Half way.
    Midpoint,
    /// At the control point farthest from the bilinear approximation.
    WorstPoint,
}
