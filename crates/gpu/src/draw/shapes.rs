//! What is drawn: triangles and lines of parts, and where the parts stand.

use bytemuck::{Pod, Zeroable};
use glam::{DAffine3, DVec3};

/// A corner of a triangle, in single precision about the middle of its shape.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Vertex {
    pub position: [f32; 3],
    pub normal: [f32; 3],
    /// sRGB; opacity 0 marks the colour of a measured value, which no assembly overrides.
    pub color: [u8; 4],
}

/// The triangles and lines of one part.
#[derive(Clone, Debug, Default)]
pub struct Shape {
    /// What coordinates are relative to, in the part's units.
    pub middle: DVec3,
    pub vertices: Vec<Vertex>,
    pub triangles: Vec<[u32; 3]>,
    /// Ends of line segments, relative to `middle`.
    pub segments: Vec<[[f32; 3]; 2]>,
}

/// One placement of a shape.
#[derive(Clone, Copy, Debug)]
pub struct Placed {
    pub shape: usize,
    /// From the part's coordinates to millimetres.
    pub world: DAffine3,
    /// Linear, in place of the shape's own colours.
    pub color: Option<[f32; 4]>,
}

/// Everything that is drawn. Shapes are stored once, however often they are placed.
#[derive(Clone, Debug, Default)]
pub struct Scenery {
    pub shapes: Vec<Shape>,
    /// Ordered by shape.
    pub placed: Vec<Placed>,
}

impl Scenery {
    /// Points whose hull holds everything, in millimetres: the vertices of all placements, or, of large scenes, the
    /// corners of their boxes.
    pub fn outline(&self) -> Vec<DVec3> {
        /// More vertices than this are stood for by boxes.
        const MANY: usize = 2_000_000;
        let count: usize = self.placed.iter().map(|p| self.shapes[p.shape].vertices.len()).sum();
        let mut points = Vec::new();
        for placed in &self.placed {
            let shape = &self.shapes[placed.shape];
            let at = |v: [f32; 3]| shape.middle + DVec3::from(v.map(f64::from));
            let own = shape.vertices.iter().map(|v| at(v.position));
            let own = own.chain(shape.segments.iter().flatten().map(|&p| at(p)));
            if count <= MANY {
                points.extend(own.map(|p| placed.world.transform_point3(p)));
            } else if let Some((low, high)) = own.map(|p| (p, p)).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
            {
                points.extend((0..8).map(|corner| {
                    let pick = |axis: usize| if corner >> axis & 1 == 0 { low[axis] } else { high[axis] };
                    placed.world.transform_point3(DVec3::new(pick(0), pick(1), pick(2)))
                }));
            }
        }
        points
    }
}
