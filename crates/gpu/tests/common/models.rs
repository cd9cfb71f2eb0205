//! Models of the corpus, read and meshed without the facade, so that this crate's tests need nothing that
//! depends on it.

use chordal_brep::{Color, Model};
use chordal_mesh::{PartMesh, Scene, SceneNode, ScenePart};
use chordal_nurbs::math;
use chordal_tessellate::{Cancel, Options, tessellate_part};
use glam::DVec3;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Largest angle between the exact normals at the two ends of a mesh edge: the facade's default, 20°.
const ANGLE: f64 = 0.349_065_850_398_865_9;

/// A model with its mesh.
pub struct Meshed {
    pub model: Model,
    pub scene: Scene,
    /// The largest proven error of a face, in the units of its part.
    pub proven_error: f64,
}

/// A file of the corpus.
pub fn corpus(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../corpus").join(name)
}

/// A model of the corpus, meshed to a tolerance in percent of its diagonal.
pub fn meshed(name: &str, percent: f64) -> Meshed {
    meshed_file(&corpus(name), percent)
}

/// Any model file, meshed the same way.
pub fn meshed_file(path: &Path, percent: f64) -> Meshed {
    let model =
        chordal_read::read_file(path, &chordal_read::ReadOptions::default()).expect("the model can be read");
    // A coarse mesh first: the box of its vertices is what the percentage refers to.
    let reach = model.parts.iter().flat_map(|p| &p.vertices).map(|v| v.point.abs().max_element());
    let reach = reach.fold(0.0, f64::max);
    let coarse = if reach > 0.0 { 0.01 * reach } else { 0.1 };
    let (scene, _) = mesh_all(&model, coarse);
    let (scene, proven_error) = mesh_all(&model, 0.01 * percent * diagonal(&scene));
    Meshed { model, scene, proven_error }
}

fn mesh_all(model: &Model, tolerance: f64) -> (Scene, f64) {
    let mut worst = 0.0_f64;
    let mut meshes = Vec::new();
    for (index, part) in model.parts.iter().enumerate() {
        let options = Options::new(tolerance / scale_of(model, index)).with_angle(Some(ANGLE));
        let (mesh, report) = tessellate_part(part, &options, &Cancel::default(), &|_| ());
        worst = report.faces.iter().map(|f| f.proven_error).fold(worst, f64::max);
        meshes.push(mesh);
    }
    (scene(model, meshes), worst)
}

/// The largest scale of a part's placements, as far as one matrix tells: the length of its unit in
/// millimetres.
fn scale_of(model: &Model, part: usize) -> f64 {
    let placements = scene(model, vec![PartMesh::default(); model.parts.len()]).placements();
    let of_part = placements.iter().filter(|p| p.part == part);
    let scale = of_part.map(|p| math::cbrt(p.world.matrix3.determinant().abs())).fold(0.0, f64::max);
    if scale > 0.0 { scale } else { 1.0 }
}

fn diagonal(scene: &Scene) -> f64 {
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for placed in scene.placements() {
        for &p in &scene.parts[placed.part].mesh.positions {
            let p = placed.world.transform_point3(p);
            (low, high) = (low.min(p), high.max(p));
        }
    }
    (high - low).length()
}

/// The scene of a model and the meshes of its parts.
fn scene(model: &Model, meshes: Vec<PartMesh>) -> Scene {
    let rgba = |c: Color| c.0;
    let part = |(part, mesh): (&chordal_brep::Part, PartMesh)| {
        let mut of_body = vec![None; part.faces.len()];
        for body in &part.bodies {
            for face in body.shells.iter().flat_map(|shell| &part.shells[shell.index()].faces) {
                of_body[face.index()] = body.color;
            }
        }
        let color = |(face, of_body): (&chordal_brep::Face, Option<Color>)| {
            face.color.or(of_body).or(part.color).map(rgba)
        };
        ScenePart {
            name: part.name.clone(),
            mesh: Arc::new(mesh),
            face_colors: part.faces.iter().zip(of_body).map(color).collect(),
            face_names: part.faces.iter().map(|f| f.name.clone()).collect(),
            ..ScenePart::default()
        }
    };
    let node = |node: &chordal_brep::Node| SceneNode {
        name: node.name.clone(),
        transform: node.transform,
        part: node.part.map(|id| id.index()),
        children: node.children.iter().map(|id| id.index()).collect(),
        color: node.color.map(rgba),
    };
    Scene {
        name: model.name.clone(),
        parts: model.parts.iter().zip(meshes).map(part).collect(),
        nodes: model.nodes.iter().map(node).collect(),
        roots: model.roots.iter().map(|id| id.index()).collect(),
    }
}
