//! The mesh of one part, in the part's own coordinates and units.

use glam::{DVec2, DVec3};

/// What a mesh vertex is a sample of. Indices are those of the part's vectors.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Origin {
    /// The part's vertex.
    Vertex(u32),
    /// Sample `index` (from 1, the ends are vertices) of an edge.
    Edge {
        /// The edge's index in its part.
        edge: u32,
        /// The sample's number along the edge, from 1.
        index: u32,
    },
    /// A point of a face, inside it or on a seam or pole that only this face has.
    Face(u32),
}

/// One corner of a face's triangles: a shared position seen from one face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner {
    /// Index into [`PartMesh::positions`].
    pub position: u32,
    /// Where it lies in the parameter space of the face; corners on a seam or pole share a position, not
    /// their uv.
    pub uv: DVec2,
    /// The exact unit normal of the face there, pointing out of the material.
    pub normal: DVec3,
}

/// The triangles of one face.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FaceMesh {
    /// The face's index in its part.
    pub face: u32,
    /// The corners of its triangles; two corners may share a position but differ in uv or normal.
    pub corners: Vec<Corner>,
    /// Indices into `corners`, counter-clockwise seen from outside the material.
    pub triangles: Vec<[u32; 3]>,
    /// The first `2 · quads` triangles are the halves of quadrilaterals, two by two; formats that have
    /// quadrilaterals keep them.
    pub quads: u32,
}

impl FaceMesh {
    /// The corners of the quadrilateral that two triangles form along the edge that they share, in the sense
    /// of both; each as (which triangle, which corner of it). The first corner is an end of that edge: a fan
    /// around it is the two triangles.
    pub fn quad_of(first: [u32; 3], second: [u32; 3]) -> Option<[(usize, usize); 4]> {
        (0..3).find_map(|i| {
            let (a, b) = (first[(i + 1) % 3], first[(i + 2) % 3]);
            let j = (0..3).find(|&j| second[(j + 1) % 3] == b && second[(j + 2) % 3] == a)?;
            Some([(0, (i + 1) % 3), (1, j), (0, (i + 2) % 3), (0, i)])
        })
    }
}

/// A mesh whose positions are shared by identity: two faces that meet at an edge use the same indices.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PartMesh {
    /// The vertices, in the part's own units.
    pub positions: Vec<DVec3>,
    /// One per position.
    pub origins: Vec<Origin>,
    /// One per face of the part, in its order; without triangles where the face failed.
    pub faces: Vec<FaceMesh>,
    /// Per edge of the part, the positions along it, ends included; empty where no face uses it.
    pub edges: Vec<Vec<u32>>,
}

impl PartMesh {
    /// How many triangles all faces have together.
    pub fn triangle_count(&self) -> usize {
        self.faces.iter().map(|f| f.triangles.len()).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_triangles_with_a_common_edge_are_a_quadrilateral() {
        let corners = |first: [u32; 3], second: [u32; 3]| {
            FaceMesh::quad_of(first, second)
                .map(|quad| quad.map(|(t, i)| if t == 0 { first[i] } else { second[i] }))
        };
        assert_eq!(corners([0, 1, 2], [0, 2, 3]), Some([2, 3, 0, 1]));
        assert_eq!(corners([2, 0, 1], [3, 0, 2]), Some([2, 3, 0, 1]));
        assert_eq!(corners([0, 1, 2], [2, 0, 3]), None, "they run the same way");
        assert_eq!(corners([0, 1, 2], [2, 3, 4]), None, "they share a corner only");
    }
}
