//! The GLB writer against the rules of glTF 2.0: chunks, alignment, bounds, boxes, indices, names of the
//! extension.
#![allow(clippy::unwrap_used)] // A failed test says where.

mod common;

use chordal_mesh::{AnalyticFace, Scene};
use chordal_write::{Format, WriteOptions};
use common::*;
use glam::{DAffine3, DMat4, DVec3};
use serde_json::Value;

struct Glb {
    json: Value,
    binary: Vec<u8>,
}

fn u32_at(bytes: &[u8], at: usize) -> usize {
    u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize
}

impl Glb {
    fn parse(bytes: &[u8]) -> Self {
        assert_eq!(&bytes[..4], b"glTF");
        assert_eq!((u32_at(bytes, 4), u32_at(bytes, 8)), (2, bytes.len()));
        let length = u32_at(bytes, 12);
        assert_eq!((&bytes[16..20], length % 4), (&b"JSON"[..], 0));
        let json: Value = serde_json::from_slice(&bytes[20..20 + length]).unwrap();
        let rest = &bytes[20 + length..];
        if rest.is_empty() {
            return Self { json, binary: Vec::new() };
        }
        assert_eq!(&rest[4..8], b"BIN\0");
        assert_eq!((u32_at(rest, 0), rest.len() % 4), (rest.len() - 8, 0));
        Self { json, binary: rest[8..].to_vec() }
    }

    fn list(&self, name: &str) -> &[Value] {
        self.json[name].as_array().map_or(&[], Vec::as_slice)
    }

    /// The numbers of an accessor, its component type and its target.
    fn accessor(&self, index: &Value) -> (Vec<Vec<f64>>, u64, Option<u64>) {
        let accessor = &self.list("accessors")[index.as_u64().unwrap() as usize];
        let view = &self.list("bufferViews")[accessor["bufferView"].as_u64().unwrap() as usize];
        let (start, length) = (view["byteOffset"].as_u64().unwrap(), view["byteLength"].as_u64().unwrap());
        assert_eq!((view["buffer"].as_u64(), start % 4), (Some(0), 0));
        let bytes = &self.binary[start as usize..(start + length) as usize];
        let component = accessor["componentType"].as_u64().unwrap();
        let width = match component {
            5123 => 2,
            5125 | 5126 => 4,
            other => panic!("component type {other}"),
        };
        let items = match accessor["type"].as_str().unwrap() {
            "SCALAR" => 1,
            "VEC3" => 3,
            other => panic!("type {other}"),
        };
        let count = accessor["count"].as_u64().unwrap() as usize;
        assert!(count > 0);
        assert_eq!(bytes.len(), count * width * items);
        let number = |b: &[u8]| match component {
            5126 => f64::from(f32::from_le_bytes(b.try_into().unwrap())),
            5125 => f64::from(u32::from_le_bytes(b.try_into().unwrap())),
            _ => f64::from(u16::from_le_bytes(b.try_into().unwrap())),
        };
        let numbers: Vec<f64> = bytes.chunks(width).map(number).collect();
        (numbers.chunks(items).map(<[f64]>::to_vec).collect(), component, view["target"].as_u64())
    }

    fn validate(&self) {
        assert_eq!(self.json["asset"]["version"], "2.0");
        if !self.binary.is_empty() {
            assert_eq!(self.json["buffers"][0]["byteLength"], self.binary.len());
        }
        self.validate_tree();
        let mut extension_used = false;
        for primitive in self.list("meshes").iter().flat_map(|m| m["primitives"].as_array().unwrap()) {
            extension_used |= self.validate_primitive(primitive);
        }
        assert_eq!(self.json["extensionsUsed"].is_array(), extension_used);
        for material in self.list("materials") {
            let color = material["pbrMetallicRoughness"]["baseColorFactor"].as_array().unwrap();
            assert!(color.iter().all(|c| (0.0..=1.0).contains(&c.as_f64().unwrap())));
            assert_eq!(material["alphaMode"] == "BLEND", color[3].as_f64().unwrap() < 1.0);
        }
    }

    fn validate_tree(&self) {
        let nodes = self.list("nodes");
        let mut parents = vec![0; nodes.len()];
        for node in nodes {
            for child in node["children"].as_array().into_iter().flatten() {
                parents[child.as_u64().unwrap() as usize] += 1;
            }
            if let Some(matrix) = node["matrix"].as_array() {
                let numbers: Vec<f64> = matrix.iter().map(|n| n.as_f64().unwrap()).collect();
                assert_eq!((numbers[3], numbers[7], numbers[11], numbers[15]), (0.0, 0.0, 0.0, 1.0));
                let m = DMat4::from_cols_slice(&numbers);
                assert!(m != DMat4::IDENTITY, "the identity is left out");
            }
            if let Some(mesh) = node["mesh"].as_u64() {
                assert!((mesh as usize) < self.list("meshes").len());
            }
        }
        for root in self.json["scenes"][0]["nodes"].as_array().unwrap() {
            parents[root.as_u64().unwrap() as usize] += 1;
        }
        assert!(parents.iter().all(|&p| p == 1), "{parents:?}");
    }

    /// Returns whether the primitive carries face ids.
    fn validate_primitive(&self, primitive: &Value) -> bool {
        let (positions, component, target) = self.accessor(&primitive["attributes"]["POSITION"]);
        assert_eq!((component, target), (5126, Some(34962)));
        let accessor =
            &self.list("accessors")[primitive["attributes"]["POSITION"].as_u64().unwrap() as usize];
        for axis in 0..3 {
            let values = positions.iter().map(|p| p[axis]);
            assert_eq!(accessor["min"][axis].as_f64().unwrap(), values.clone().fold(f64::MAX, f64::min));
            assert_eq!(accessor["max"][axis].as_f64().unwrap(), values.fold(f64::MIN, f64::max));
        }
        let (indices, component, target) = self.accessor(&primitive["indices"]);
        assert_eq!(target, Some(34963));
        let reserved = if component == 5123 { 65535 } else { u32::MAX as usize };
        let mut used = vec![false; positions.len()];
        for index in indices.iter().map(|i| i[0] as usize) {
            assert!(index < reserved);
            used[index] = true;
        }
        assert!(used.iter().all(|u| *u), "a vertex that nothing uses");
        assert!((primitive["material"].as_u64().unwrap() as usize) < self.list("materials").len());
        if primitive["mode"] == 1 {
            assert_eq!(indices.len() % 2, 0);
            return false;
        }
        assert_eq!((primitive["mode"].as_u64(), indices.len() % 3), (Some(4), 0));
        if !primitive["attributes"]["NORMAL"].is_null() {
            let (normals, _, _) = self.accessor(&primitive["attributes"]["NORMAL"]);
            assert_eq!(normals.len(), positions.len());
            assert!(normals.iter().all(|n| (DVec3::from_slice(n).length() - 1.0).abs() < 1e-6));
        }
        let faces = &primitive["extensions"]["TM_brep_faces"];
        if faces.is_null() {
            return false;
        }
        let (ids, component, target) = self.accessor(&faces["faceIndices"]);
        assert_eq!((ids.len(), component, target), (indices.len() / 3, 5125, None));
        if let Some(faces) = faces["faces"].as_array() {
            assert!(ids.iter().all(|id| (id[0] as usize) < faces.len()));
            let numbered = faces.iter().enumerate().filter(|(_, f)| !f.is_null());
            numbered.for_each(|(index, face)| assert_eq!(face["face_index"], index));
        }
        true
    }
}

fn glb(scene: &Scene, options: &WriteOptions) -> Glb {
    let glb = Glb::parse(&write(scene, options).0);
    glb.validate();
    glb
}

#[test]
fn every_scene_is_valid() {
    let mut empty = cube();
    empty.nodes[0].part = None;
    for scene in [cube(), assembly(), empty] {
        for edges in [false, true] {
            glb(&scene, &WriteOptions::new(Format::Glb).with_edge_lines(edges));
        }
    }
}

#[test]
fn instances_share_meshes_and_overrides_get_their_own() {
    let glb = glb(&assembly(), &WriteOptions::new(Format::Glb));
    let mesh_of = |name: &str| {
        glb.list("nodes").iter().find(|n| n["name"] == name && n["mesh"].is_u64()).map(|n| n["mesh"].as_u64())
    };
    assert_eq!(mesh_of("first"), mesh_of("second"));
    assert_eq!((glb.list("meshes").len(), glb.list("nodes").len()), (3, 6));
    // Uncoloured, red, glass; one primitive per colour, the painted brick in one.
    let primitives = |mesh: usize| glb.list("meshes")[mesh]["primitives"].as_array().unwrap().len();
    assert_eq!((glb.list("materials").len(), primitives(0), primitives(1), primitives(2)), (3, 3, 1, 1));
    let names: Vec<_> = glb.list("materials").iter().map(|m| m["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["uncoloured", "color_FF0000", "color_00BCFF40"]);
}

#[test]
fn a_moved_mesh_does_not_move_the_children_of_its_node() {
    let away = DVec3::new(1e5, 2e5, 3e5);
    let mut scene = single(part("p", box_mesh(away, away + 1.0)), DAffine3::IDENTITY);
    scene.nodes[0].children = vec![1];
    scene.nodes.push(node(
        "child",
        DAffine3::from_quat(glam::DQuat::from_xyzw(0.0, 0.0, 0.6, 0.8)),
        Some(0),
        &[],
    ));
    let glb = glb(&scene, &WriteOptions::new(Format::Glb));
    // The child is a leaf and takes the move into its own matrix; its parent's mesh gets a node of its own.
    assert_eq!(glb.list("nodes").len(), 3);
    assert_eq!(glb.list("nodes")[0]["children"], serde_json::json!([1, 2]));
    let soup = round_trip(&scene, &WriteOptions::new(Format::Glb)).into_millimetres_z_up();
    assert_same(&soup, &expected(&scene), 1e-6);
}

#[test]
fn units_and_axes_follow_the_specification_unless_told_otherwise() {
    let scene =
        single(part("p", box_mesh(DVec3::ZERO, DVec3::new(1000.0, 2000.0, 3000.0))), DAffine3::IDENTITY);
    let size = |glb: &Glb| glb.list("accessors")[0]["max"].as_array().unwrap().clone();
    let usual = glb(&scene, &WriteOptions::new(Format::Glb));
    assert_eq!(size(&usual), [1.0, 3.0, 0.0].map(Value::from));
    assert!(usual.json["asset"]["extras"].is_null());
    let own =
        WriteOptions::new(Format::Glb).with_up(chordal_write::UpAxis::Z).with_unit(chordal_write::Unit::Foot);
    let own = glb(&scene, &own);
    assert_eq!(own.json["asset"]["extras"], serde_json::json!({"unit": "ft", "up": "z"}));
    assert!((size(&own)[2].as_f64().unwrap() - 3000.0 / 304.8).abs() < 1e-6);
}

#[test]
fn a_mirror_stays_in_the_node() {
    let mirror = DAffine3::from_scale(DVec3::new(1.0, -1.0, 1.0));
    let turned = |transform| {
        let scene = single(part("p", box_mesh(DVec3::ZERO, DVec3::ONE)), transform);
        let glb = glb(&scene, &WriteOptions::new(Format::Glb));
        (glb.binary.clone(), glb.list("nodes")[0]["matrix"].clone())
    };
    let (plain, mirrored) = (turned(DAffine3::IDENTITY), turned(mirror));
    assert_eq!(plain.0, mirrored.0, "the same triangles in the same order");
    let numbers: Vec<f64> = mirrored.1.as_array().unwrap().iter().map(|n| n.as_f64().unwrap()).collect();
    assert_eq!(DMat4::from_cols_slice(&numbers).determinant(), -1.0);
}

#[test]
fn elementary_surfaces_are_stated_as_cascadio_does() {
    let away = DVec3::new(4000.0, 0.0, 2000.0);
    let mut scene = single(part("p", box_mesh(away, away + DVec3::splat(1000.0))), DAffine3::IDENTITY);
    let surface = AnalyticFace::Cylinder {
        origin: away,
        axis: DVec3::Z,
        radius: 500.0,
        extent_angle: [0.0, 1.0],
        extent_height: [0.0, 1000.0],
    };
    scene.parts[0].face_surfaces = vec![None, Some(surface), None, None, None, None];
    let glb = glb(&scene, &WriteOptions::new(Format::Glb));
    let faces = &glb.list("meshes")[0]["primitives"][0]["extensions"]["TM_brep_faces"]["faces"];
    assert_eq!(faces.as_array().unwrap().len(), 6);
    assert!(faces[0].is_null());
    // The mesh was moved to the box's centre, (4.5, 2.5, −0.5) in metres and Y up.
    let wanted = serde_json::json!({
        "face_index": 1, "type": "cylinder", "origin": [-0.5, -0.5, 0.5], "axis": [0.0, 1.0, 0.0],
        "radius": 0.5, "extent_angle": [0.0, 1.0], "extent_height": [0.0, 1.0],
    });
    assert_eq!(faces[1], wanted);
}

#[test]
fn vertices_are_split_only_where_normals_differ() {
    let mut smooth = box_mesh(DVec3::ZERO, DVec3::ONE);
    let corners: usize = smooth.faces.iter().map(|f| f.corners.len()).sum();
    assert_eq!(write(&cube(), &WriteOptions::new(Format::Glb)).1.vertices, corners as u64);
    for face in &mut smooth.faces {
        for corner in &mut face.corners {
            corner.normal = (smooth.positions[corner.position as usize] - 0.5).normalize();
        }
    }
    let scene = single(part("smooth", smooth), DAffine3::IDENTITY);
    assert_eq!(write(&scene, &WriteOptions::new(Format::Glb)).1.vertices, 8);
}

#[test]
fn large_meshes_use_wide_indices() {
    // 30,000 boxes in one mesh: 240,000 positions.
    let mut mesh = chordal_mesh::PartMesh::default();
    for i in 0..30_000 {
        let low = DVec3::new(f64::from(i), 0.0, 0.0);
        let one = box_mesh(low, low + 0.5);
        let start = mesh.positions.len() as u32;
        mesh.positions.extend(one.positions);
        for mut face in one.faces {
            face.face = mesh.faces.len() as u32;
            face.corners.iter_mut().for_each(|c| c.position += start);
            mesh.faces.push(face);
        }
    }
    glb(&single(part("many", mesh), DAffine3::IDENTITY), &WriteOptions::new(Format::Glb));
}
