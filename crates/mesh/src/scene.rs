//! What writers need: meshes with names and colours, placed by a tree. Lengths are millimetres after the
//! root.

use crate::{AnalyticFace, PartMesh};
use glam::{DAffine3, DVec3};
use std::sync::Arc;

/// Linear RGB with opacity.
pub type Rgba = [f32; 4];

/// Triangles that came with the file; nothing is proven about them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PassThrough {
    /// The name in the file; may be empty.
    pub name: String,
    /// The vertices, in the part's own units.
    pub points: Vec<DVec3>,
    /// Indices into `points`, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Unit normals, one per point; empty if the file has none.
    pub normals: Vec<DVec3>,
    /// The colour; absent if the file has none.
    pub color: Option<Rgba>,
}

/// One mesh with what belongs to it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ScenePart {
    /// The name; may be empty.
    pub name: String,
    /// The mesh of the exact faces.
    pub mesh: Arc<PartMesh>,
    /// One per face of the mesh: its own colour, else its body's, else its part's.
    pub face_colors: Vec<Option<Rgba>>,
    /// One per face: its name in the file; may be empty.
    pub face_names: Vec<String>,
    /// One per face: the index into `body_names` of the body that it belongs to.
    pub face_bodies: Vec<u32>,
    /// The names of the bodies.
    pub body_names: Vec<String>,
    /// One per face: the elementary surface under it, if it has one; empty if not requested.
    pub face_surfaces: Vec<Option<AnalyticFace>>,
    /// Triangles that the file had beside exact faces.
    pub pass_through: Vec<PassThrough>,
}

/// One occurrence; see `chordal_brep::Node`.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneNode {
    /// The name; may be empty.
    pub name: String,
    /// To the parent's coordinates, of a root to millimetres.
    pub transform: DAffine3,
    /// The part that stands here: an index into [`Scene::parts`].
    pub part: Option<usize>,
    /// The nodes below: indices into [`Scene::nodes`].
    pub children: Vec<usize>,
    /// Overrides the colours of everything below.
    pub color: Option<Rgba>,
}

/// A tree of placed meshes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scene {
    /// The name of the model; may be empty.
    pub name: String,
    /// The meshes, each once however often it is placed.
    pub parts: Vec<ScenePart>,
    /// The nodes of the tree.
    pub nodes: Vec<SceneNode>,
    /// The nodes without a parent: indices into `nodes`.
    pub roots: Vec<usize>,
}

/// One placed part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacedPart {
    /// The node: an index into [`Scene::nodes`].
    pub node: usize,
    /// The part: an index into [`Scene::parts`].
    pub part: usize,
    /// From the part's coordinates to millimetres.
    pub world: DAffine3,
    /// The colour of the topmost node on the way down that has one: assemblies override their parts.
    pub color: Option<Rgba>,
}

impl Scene {
    /// Every placed part, depth first in the order of the tree.
    pub fn placements(&self) -> Vec<PlacedPart> {
        let mut found = Vec::new();
        let mut stack: Vec<_> = self.roots.iter().rev().map(|&n| (n, DAffine3::IDENTITY, None)).collect();
        while let Some((node, parent, above)) = stack.pop() {
            let n = &self.nodes[node];
            let world = parent * n.transform;
            let color = above.or(n.color);
            if let Some(part) = n.part {
                found.push(PlacedPart { node, part, world, color });
            }
            stack.extend(n.children.iter().rev().map(|&child| (child, world, color)));
        }
        found
    }
}
