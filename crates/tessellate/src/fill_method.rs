//! Methods of other crates that fill the inside of faces.
//!
//! All methods share the edges, the proof and the stitching, and so the watertightness: a method may not set
//! a vertex on an edge, since the neighbours would not have it. What a method chooses is how a face is
//! subdivided, how the subdivision is cut with the loops, and how the polygons become triangles.

use crate::face_mesh::FaceMesh;
use crate::limits::Bound;
use chordal_brep::MeshIssue;
use chordal_nurbs::{DVec2, UvBox};
use std::fmt::Debug;

/// A way to fill the inside of faces, in place of the default one.
pub trait FillMethod: Debug + Send + Sync {
    /// The name in reports.
    fn name(&self) -> &str;

    /// Begins with one face, whose loops are triangulated.
    ///
    /// # Errors
    /// Where the method cannot fill this face.
    fn begin(&self, face: &FaceMesh<'_, '_>, task: FillTask) -> Result<Box<dyn FaceFiller>, MeshIssue>;
}

/// The data of the job that a method needs beside the face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FillTask {
    /// How errors are judged.
    pub bound: Bound,
    /// Edges are approximated in space ([`crate::method::EdgeSplitter::is_in_space`]): the method leaves
    /// their chords alone.
    pub edges_in_space: bool,
}

/// Called now and then with the number of things made so far; an error ends the work on the face.
pub type Check<'c> = &'c dyn Fn(usize) -> Result<(), MeshIssue>;

/// A method at work on one face.
pub trait FaceFiller {
    /// Makes the triangles of the face, whose mesh holds the triangulated loops and nothing else.
    ///
    /// # Errors
    /// Where the face is given up.
    fn build(&mut self, face: &mut FaceMesh<'_, '_>, check: Check<'_>) -> Result<(), MeshIssue>;

    /// Makes the places finer that the proof found too coarse; false where nothing can be done. The face is
    /// then built once more.
    fn refine(&mut self, coarse: &[DVec2]) -> bool;

    /// Chords (edge, index) that the method itself finds too coarse.
    fn coarse_chords(&self, _face: &mut FaceMesh<'_, '_>) -> Vec<(u32, u32)> {
        Vec::new()
    }

    /// The cells of the subdivision, to be drawn.
    fn cells(&self) -> Vec<UvBox>;
}
