//! Writes a sphere of about a million triangles in every format and prints the times.
//!
//! `cargo run --release -p chordal-write --example sphere -- FOLDER [RINGS]`

use chordal_mesh::{Corner, FaceMesh, Origin, PartMesh, Scene, SceneNode, ScenePart};
use chordal_write::{Format, WriteOptions, write_scene};
use glam::{DAffine3, DVec2, DVec3};
use std::error::Error;
use std::f64::consts::{PI, TAU};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let folder = PathBuf::from(arguments.next().ok_or("name a folder")?);
    let rings = arguments.next().map_or(Ok(708), |r| r.parse())?;
    let scene = scene(sphere(rings));
    let formats = ["stl", "glb", "obj", "ply", "3mf"].iter().filter_map(|e| Format::from_extension(e));
    for format in formats.chain([Format::StlAscii]) {
        let name = if format == Format::StlAscii { "sphere-ascii" } else { "sphere" };
        let path = folder.join(name).with_extension(format.extension());
        let start = Instant::now();
        let summary = write_scene(&scene, &path, &WriteOptions::new(format).with_tolerance_mm(1e-4))?;
        let milliseconds = start.elapsed().as_millis();
        println!("{format}: {} triangles, {} bytes in {milliseconds} ms", summary.triangles, summary.bytes);
        summary.warnings.iter().for_each(|w| println!("  {w}"));
    }
    Ok(())
}

/// A unit sphere: poles, `rings - 1` circles of `rings` points, one face.
fn sphere(rings: u32) -> PartMesh {
    let mut positions = vec![DVec3::Z];
    for ring in 1..rings {
        let (radius, height) = libm::sincos(PI * f64::from(ring) / f64::from(rings));
        positions.extend((0..rings).map(|i| {
            let (sine, cosine) = libm::sincos(TAU * f64::from(i) / f64::from(rings));
            DVec3::new(radius * cosine, radius * sine, height)
        }));
    }
    positions.push(-DVec3::Z);
    let last = positions.len() as u32 - 1;
    let at = |ring: u32, i: u32| 1 + (ring - 1) * rings + i % rings;
    let mut triangles = Vec::new();
    for i in 0..rings {
        triangles.push([0, at(1, i), at(1, i + 1)]);
        for ring in 1..rings - 1 {
            let [a, b, c, d] = [at(ring, i), at(ring + 1, i), at(ring + 1, i + 1), at(ring, i + 1)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
        triangles.push([last, at(rings - 1, i + 1), at(rings - 1, i)]);
    }
    let corner =
        |(position, &normal): (usize, &DVec3)| Corner { position: position as u32, uv: DVec2::ZERO, normal };
    let corners = positions.iter().enumerate().map(corner).collect();
    let origins = vec![Origin::Face(0); positions.len()];
    PartMesh {
        positions,
        origins,
        faces: vec![FaceMesh { face: 0, corners, triangles, quads: 0 }],
        edges: Vec::new(),
    }
}

fn scene(mesh: PartMesh) -> Scene {
    let part = ScenePart { name: "sphere".to_owned(), mesh: Arc::new(mesh), ..ScenePart::default() };
    let node = SceneNode {
        name: "sphere".to_owned(),
        transform: DAffine3::IDENTITY,
        part: Some(0),
        children: Vec::new(),
        color: Some([0.1, 0.3, 0.8, 1.0]),
    };
    Scene { name: "sphere".to_owned(), parts: vec![part], nodes: vec![node], roots: vec![0] }
}
