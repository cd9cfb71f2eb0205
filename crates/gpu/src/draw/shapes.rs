//! What is drawn: triangles and lines of parts, and where the parts stand.

use bytemuck::{Pod, Zeroable};
use glam::{DAffine3, DVec3};

/// A corner of a triangle, in single precision about the middle of its shape.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Vertex {
    /// Its position.
    pub position: [f32; 3],
    /// The unit normal.
    pub normal: [f32; 3],
    /// sRGB and opacity; 0 of that marks the colour of a measured value, which no assembly overrides.
    pub color: [u8; 4],
    /// The face's number: neighbours that are seen through each other differ in it.
    pub face: u32,
}

/// The triangles and lines of one part.
#[derive(Clone, Debug, Default)]
pub struct Shape {
    /// What coordinates are relative to, in the part's units.
    pub middle: DVec3,
    /// Nothing of the part is further from the middle.
    pub radius: f64,
    /// The corners of the triangles.
    pub vertices: Vec<Vertex>,
    /// Triangles by their corners.
    pub triangles: Vec<[u32; 3]>,
    /// Ends of line segments, relative to `middle`.
    pub segments: Vec<[[f32; 3]; 2]>,
}

/// One placement of a shape.
#[derive(Clone, Copy, Debug)]
pub struct Placed {
    /// The shape, by index.
    pub shape: usize,
    /// From the part's coordinates to millimetres.
    pub world: DAffine3,
    /// Linear, in place of the shape's own colours.
    pub color: Option<[f32; 4]>,
}

/// Everything that is drawn. Shapes are stored once, however often they are placed.
#[derive(Clone, Debug, Default)]
pub struct Scenery {
    /// The shapes.
    pub shapes: Vec<Shape>,
    /// Ordered by shape.
    pub placed: Vec<Placed>,
}
