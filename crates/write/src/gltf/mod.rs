//! glTF 2.0, in one binary file (GLB) or as JSON text with its buffer embedded.
//!
//! The tree of the scene becomes the tree of nodes; a part becomes one mesh however often it is placed, and
//! one more per colour that an assembly gives it. A mesh has a primitive per colour, in the order of their
//! first face. Vertices are split only where the exact normals of two corners differ. Every triangle of an
//! exact face carries the face's index in its part, by the extension `TM_brep_faces` that cascadio writes and
//! reads.
//!
//! Transforms between nodes are `F·T·F⁻¹`, with `F` the change to metres and to Y up, so no extra root is
//! needed. A mirroring transform stays as it is: by the specification the renderer reverses the winding where
//! the determinant is negative.
//!
//! Coordinates are 32-bit floats, the numbers of node matrices decimal. If a part lies far from its own
//! origin, its mesh is moved to the centre of its box and its node moves it back (see [`origin_of`]):
//! rounding is then relative to the part's size, not to its distance from the origin.

mod buffer;
mod json;
mod mesh;
mod surfaces;

use crate::frame::Frame;
use crate::summary::Tally;
use crate::{Countable, Format, UpAxis, WriteError, WriteOptions, WriteWarning};
use base64::prelude::{BASE64_STANDARD, Engine as _};
use chordal_mesh::{PlacedPart, Scene};
use glam::{DAffine3, DMat3, DVec3};
use mesh::{Meshes, Variant};
use std::io::Write;

/// The largest cosine between two columns of a matrix that is still taken for a rotation with scale.
///
/// glTF forbids shears. Files give directions with as few as six digits, so a smaller value would call those
/// rotations shears; a larger one would let visible shears pass without a warning.
const SHEAR: f64 = 1e-4;

/// Writes JSON and buffer as the two chunks of one binary file (GLB).
pub(crate) fn write_binary(
    scene: &Scene,
    out: &mut impl Write,
    options: &WriteOptions,
    tally: &mut Tally,
) -> Result<(), WriteError> {
    let (root, bytes) = encode(scene, options, tally)?;
    write_chunks(&root, &bytes, out)
}

/// Writes JSON with the buffer embedded as base64, so that one text file holds everything.
pub(crate) fn write_text(
    scene: &Scene,
    out: &mut impl Write,
    options: &WriteOptions,
    tally: &mut Tally,
) -> Result<(), WriteError> {
    let (mut root, bytes) = encode(scene, options, tally)?;
    if let Some(buffer) = root.buffers.first_mut() {
        let mut uri = "data:application/octet-stream;base64,".to_owned();
        BASE64_STANDARD.encode_string(&bytes, &mut uri);
        buffer.uri = Some(uri);
    }
    serde_json::to_writer(out, &root).map_err(std::io::Error::from)?;
    Ok(())
}

/// The JSON tree and the bytes of its one buffer.
fn encode(
    scene: &Scene,
    options: &WriteOptions,
    tally: &mut Tally,
) -> Result<(json::Root, Vec<u8>), WriteError> {
    let frame = Frame::new(options);
    let mut meshes = Meshes::new(scene, frame, options);
    let mut nodes = bare_nodes(scene, frame, tally);
    for placed in scene.placements() {
        let Some(variant) = meshes.variant(&placed, tally)? else { continue };
        attach(&mut nodes, &placed, variant);
    }
    tally.vertices = meshes.vertices;
    Ok(meshes.into_root(|meshes| json::Root {
        asset: asset(options),
        extensions_used: if meshes.has_faces { vec!["TM_brep_faces"] } else { Vec::new() },
        scene: 0,
        scenes: vec![json::Scene { name: scene.name.clone(), nodes: scene.roots.clone() }],
        nodes,
        meshes: Vec::new(),
        materials: Vec::new(),
        accessors: Vec::new(),
        buffer_views: Vec::new(),
        buffers: Vec::new(),
    }))
}

fn asset(options: &WriteOptions) -> json::Asset {
    let (unit, up) = (options.resolved_unit(), options.resolved_up());
    let usual = unit == Format::Glb.default_unit() && up == Format::Glb.default_up();
    let axis = if up == UpAxis::Y { "y" } else { "z" };
    let extras = (!usual).then(|| serde_json::json!({ "unit": unit.symbol(), "up": axis }));
    json::Asset { version: "2.0", generator: format!("Chordal {}", env!("CARGO_PKG_VERSION")), extras }
}

/// The scene's nodes under their own numbers, without meshes.
fn bare_nodes(scene: &Scene, frame: Frame, tally: &mut Tally) -> Vec<json::Node> {
    let mut sheared = 0;
    let node = |n: &chordal_mesh::SceneNode| {
        sheared += usize::from(is_sheared(n.transform.matrix3));
        json::Node {
            name: n.name.clone(),
            mesh: None,
            matrix: matrix(frame.conjugate(n.transform)),
            children: n.children.clone(),
        }
    };
    let nodes = scene.nodes.iter().map(node).collect();
    if sheared > 0 {
        tally.warnings.push(WriteWarning::Sheared { placements: sheared });
    }
    nodes
}

fn is_sheared(m: DMat3) -> bool {
    let cosine = |a: DVec3, b: DVec3| a.dot(b).abs() > SHEAR * a.length() * b.length();
    cosine(m.x_axis, m.y_axis) || cosine(m.y_axis, m.z_axis) || cosine(m.z_axis, m.x_axis)
}

/// A node's matrix, column by column; none for the identity.
fn matrix(t: DAffine3) -> Option<[f64; 16]> {
    (t != DAffine3::IDENTITY).then(|| {
        let m = glam::DMat4::from(t);
        m.to_cols_array()
    })
}

/// Hangs a mesh under its node; a mesh that was moved gets a node of its own unless the node has no children.
fn attach(nodes: &mut Vec<json::Node>, placed: &PlacedPart, variant: &Variant) {
    let node = &mut nodes[placed.node];
    if variant.origin == DVec3::ZERO {
        node.mesh = Some(variant.mesh);
        return;
    }
    let back = DAffine3::from_translation(variant.origin);
    if node.children.is_empty() {
        let own =
            node.matrix.map_or(DAffine3::IDENTITY, |m| DAffine3::from_mat4(glam::DMat4::from_cols_array(&m)));
        node.matrix = matrix(own * back);
        node.mesh = Some(variant.mesh);
        return;
    }
    let child = nodes.len();
    nodes[placed.node].children.push(child);
    nodes.push(json::Node { mesh: Some(variant.mesh), matrix: matrix(back), ..json::Node::default() });
}

/// Where a mesh's own origin should be, in file coordinates: zero unless that halves the largest coordinate.
///
/// The origin has 32-bit coordinates, so that viewers that read matrices in 32 bits find it exactly.
fn origin_of(low: DVec3, high: DVec3) -> DVec3 {
    let farthest = low.abs().max(high.abs()).max_element();
    let half_size = (0.5 * (high - low)).max_element();
    if farthest > 2.0 * half_size { (0.5 * (low + high)).as_vec3().as_dvec3() } else { DVec3::ZERO }
}

/// Header, JSON padded with blanks, bytes padded with zeros.
fn write_chunks(root: &json::Root, bytes: &[u8], out: &mut impl Write) -> Result<(), WriteError> {
    let mut text = serde_json::to_vec(root).map_err(std::io::Error::from)?;
    text.resize(text.len().next_multiple_of(4), b' ');
    let binary = if bytes.is_empty() { 0 } else { 8 + bytes.len() };
    let total = 12 + 8 + text.len() + binary;
    let too_large =
        |_| WriteError::TooLarge { what: Countable::Bytes, count: total as u64, format: Format::Glb };
    let total = u32::try_from(total).map_err(too_large)?;
    out.write_all(b"glTF")?;
    for number in [2, total, text.len() as u32] {
        out.write_all(&number.to_le_bytes())?;
    }
    out.write_all(b"JSON")?;
    out.write_all(&text)?;
    if binary > 0 {
        out.write_all(&(bytes.len() as u32).to_le_bytes())?;
        out.write_all(b"BIN\0")?;
        out.write_all(bytes)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_origin_is_moved_only_where_it_helps() {
        let unit = DVec3::ONE;
        assert_eq!(origin_of(-unit, unit), DVec3::ZERO);
        assert_eq!(origin_of(DVec3::ZERO, unit), DVec3::ZERO);
        assert_eq!(origin_of(100.0 * unit, 102.0 * unit), 101.0 * unit);
        let odd = origin_of(unit * 0.1, unit * 0.1 + 1e-9);
        assert_eq!(odd, odd.as_vec3().as_dvec3());
    }
}
