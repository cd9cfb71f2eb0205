//! From the model and its meshes to the scene that writers write.

use chordal_brep::{Color, Model, Node, Part};
use chordal_mesh::{PartMesh, PassThrough, Rgba, Scene, SceneNode, ScenePart};
use std::sync::Arc;

/// Joins names, colours and placements of the model with the meshes of its parts, one per part in the model's
/// order.
pub(crate) fn scene(model: &Model, meshes: Vec<Arc<PartMesh>>) -> Scene {
    Scene {
        name: model.name.clone(),
        parts: model.parts.iter().zip(meshes).map(|(part, mesh)| scene_part(part, mesh)).collect(),
        nodes: model.nodes.iter().map(scene_node).collect(),
        roots: model.roots.iter().map(|id| id.index()).collect(),
    }
}

fn scene_node(node: &Node) -> SceneNode {
    SceneNode {
        name: node.name.clone(),
        transform: node.transform,
        part: node.part.map(|id| id.index()),
        children: node.children.iter().map(|id| id.index()).collect(),
        color: node.color.map(rgba),
    }
}

fn scene_part(part: &Part, mesh: Arc<PartMesh>) -> ScenePart {
    let (face_bodies, mut body_names) = face_bodies(part);
    let face_colors = part
        .faces
        .iter()
        .zip(&face_bodies)
        .map(|(face, &body)| {
            let of_body = part.bodies.get(body as usize).and_then(|b| b.color);
            face.color.or(of_body).or(part.color).map(rgba)
        })
        .collect();
    if body_names.is_empty() {
        body_names.push(part.name.clone());
    }
    ScenePart {
        name: part.name.clone(),
        face_surfaces: Vec::new(),
        mesh,
        face_colors,
        face_names: part.faces.iter().map(|f| f.name.clone()).collect(),
        face_bodies,
        body_names,
        pass_through: part
            .tessellated
            .iter()
            .map(|item| PassThrough {
                name: item.name.clone(),
                points: item.points.clone(),
                triangles: item.triangles.clone(),
                normals: item.normals.clone(),
                color: item.color.or(part.color).map(rgba),
            })
            .collect(),
    }
}

/// The body of every face, and the names of the bodies. Faces of no body share one more, named as the part.
fn face_bodies(part: &Part) -> (Vec<u32>, Vec<String>) {
    let none = part.bodies.len() as u32;
    let mut of_face = vec![none; part.faces.len()];
    for (body_index, body) in part.bodies.iter().enumerate() {
        for shell in &body.shells {
            for face in &part.shells[shell.index()].faces {
                of_face[face.index()] = body_index as u32;
            }
        }
    }
    let mut names: Vec<String> = part.bodies.iter().map(|b| b.name.clone()).collect();
    if of_face.contains(&none) {
        names.push(part.name.clone());
    }
    (of_face, names)
}

fn rgba(color: Color) -> Rgba {
    color.0
}
