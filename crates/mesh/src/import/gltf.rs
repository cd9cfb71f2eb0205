//! glTF 2.0, binary (GLB) or as text: triangles of every placed mesh, in scene coordinates, with the face ids
//! of `TM_brep_faces`.

use super::bytes::Cursor;
use super::error::{AccessorFault, Fault, ImportFault};
use super::ply::unit_mm;
use super::weld::{Builder, reverses};
use base64::prelude::{BASE64_STANDARD, Engine as _};
use glam::{DAffine3, DMat4, DQuat, DVec3};
use serde_json::Value;

/// The most triangles that are read with every instance counted.
///
/// Instances of instances let a file of a kilobyte state more triangles than any memory holds. A smaller
/// limit would refuse large assemblies; a larger one would need over 10 GB.
pub(super) const MOST_TRIANGLES: u64 = 200_000_000;

/// Reads a binary file (GLB): the JSON in its first chunk, the buffer in its second.
pub(super) fn read_binary(bytes: &[u8], builder: &mut Builder) -> Result<(), Fault> {
    let (json, binary) = chunks(bytes)?;
    read(&parse(json)?, binary, builder)
}

/// Reads JSON text, whose one buffer must be embedded as a data URI.
pub(super) fn read_text(bytes: &[u8], builder: &mut Builder) -> Result<(), Fault> {
    let mut root = parse(bytes)?;
    let binary = match root["buffers"].get_mut(0) {
        Some(buffer) => embedded(&mut buffer["uri"])?,
        None => Vec::new(),
    };
    read(&root, &binary, builder)
}

fn parse(json: &[u8]) -> Result<Value, Fault> {
    serde_json::from_slice(json).map_err(|e| ImportFault::Json { reason: e.to_string() }.into())
}

/// Takes the bytes of a data URI out of the JSON, so that accessors find them as they find a binary chunk.
fn embedded(uri: &mut Value) -> Result<Vec<u8>, Fault> {
    let uri = uri.take();
    let data = uri.as_str().and_then(|u| u.strip_prefix("data:")).and_then(|u| u.split_once(";base64,"));
    let (_, text) = data.ok_or(ImportFault::OtherFile)?;
    BASE64_STANDARD.decode(text).map_err(|e| ImportFault::Base64 { reason: e.to_string() }.into())
}

fn read(root: &Value, binary: &[u8], builder: &mut Builder) -> Result<(), Fault> {
    let file = File { root, binary };
    let extras = &root["asset"]["extras"];
    builder.unit_mm = extras["unit"].as_str().and_then(|u| unit_mm(u.as_bytes())).or(Some(1000.0));
    builder.y_up = extras["up"].as_str() != Some("z");
    if let Some(needed) = root["extensionsRequired"].as_array().and_then(|e| e.first()) {
        let name = needed.as_str().unwrap_or_default().to_owned();
        return Err(ImportFault::Extension { name }.into());
    }
    file.read_scene(builder)
}

/// The JSON and the binary chunk.
fn chunks(bytes: &[u8]) -> Result<(&[u8], &[u8]), Fault> {
    let mut cursor = Cursor { rest: bytes };
    if cursor.take(4) != Some(b"glTF") {
        return Err(ImportFault::Start { expected: "glTF" }.into());
    }
    match (cursor.u32_le(), cursor.u32_le()) {
        (Some(2), Some(_)) => {}
        (Some(version), Some(_)) => return Err(ImportFault::Version { version, supported: 2 }.into()),
        _ => return Err(ImportFault::EndsInside { what: "header" }.into()),
    }
    let mut chunk = |kind: &[u8]| {
        let length = cursor.u32_le()? as usize;
        if cursor.take(4)? != kind {
            return None;
        }
        cursor.take(length)
    };
    let json = chunk(b"JSON").ok_or(ImportFault::Missing { what: "complete JSON chunk" })?;
    Ok((json, chunk(b"BIN\0").unwrap_or_default()))
}

struct File<'a> {
    root: &'a Value,
    binary: &'a [u8],
}

/// Faces and triangles counted over all placed meshes.
#[derive(Default)]
struct Count {
    faces: i64,
    triangles: u64,
}

impl File<'_> {
    fn read_scene(&self, builder: &mut Builder) -> Result<(), Fault> {
        let nodes = self.root["nodes"].as_array().map_or(&[][..], Vec::as_slice);
        let mut visited = vec![false; nodes.len()];
        let mut count = Count::default();
        let mut stack: Vec<_> =
            self.roots(nodes).into_iter().rev().map(|n| (n, DAffine3::IDENTITY)).collect();
        while let Some((index, parent)) = stack.pop() {
            let node = nodes.get(index).ok_or_else(|| unknown("node", index))?;
            if std::mem::replace(&mut visited[index], true) {
                return Err(ImportFault::TwoParents { node: index }.into());
            }
            let world = parent * local_transform(node);
            if let Some(mesh) = node["mesh"].as_u64() {
                self.read_mesh(node, mesh as usize, world, &mut count, builder)?;
            }
            stack.extend(indices(&node["children"]).rev().map(|child| (child, world)));
        }
        Ok(())
    }

    fn roots(&self, nodes: &[Value]) -> Vec<usize> {
        let scene = self.root["scene"].as_u64().unwrap_or(0) as usize;
        if let Some(scene) = self.root["scenes"].get(scene) {
            return indices(&scene["nodes"]).collect();
        }
        let mut is_child = vec![false; nodes.len()];
        for child in nodes.iter().flat_map(|n| indices(&n["children"])) {
            if let Some(is_child) = is_child.get_mut(child) {
                *is_child = true;
            }
        }
        (0..nodes.len()).filter(|&n| !is_child[n]).collect()
    }

    fn read_mesh(
        &self,
        node: &Value,
        mesh: usize,
        world: DAffine3,
        count: &mut Count,
        builder: &mut Builder,
    ) -> Result<(), Fault> {
        let mesh = self.root["meshes"].get(mesh).ok_or_else(|| unknown("mesh", mesh))?;
        let name = [node, mesh].iter().find_map(|v| v["name"].as_str().filter(|n| !n.is_empty()));
        builder.group(name.unwrap_or_default());
        let mut faces = 0;
        for primitive in mesh["primitives"].as_array().into_iter().flatten() {
            let triangles = self.triangles(primitive)?;
            count.triangles += triangles.len() as u64;
            if count.triangles > MOST_TRIANGLES {
                return Err(ImportFault::TooManyTriangles { limit: MOST_TRIANGLES }.into());
            }
            let positions = self.positions(&primitive["attributes"]["POSITION"], triangles.is_empty())?;
            let face_ids = self.face_ids(primitive, triangles.len())?;
            for (t, triangle) in triangles.into_iter().enumerate() {
                let mut corners = [0; 3];
                for (corner, index) in corners.iter_mut().zip(triangle) {
                    let p = positions.get(index as usize);
                    let p = p.ok_or_else(|| ImportFault::UnknownVertex {
                        vertex: index.to_string(),
                        vertices: positions.len(),
                    })?;
                    *corner = builder.point(world.transform_point3(*p))?;
                }
                if reverses(&world) {
                    corners.swap(1, 2);
                }
                match face_ids.as_ref().map(|ids| i64::from(ids[t])) {
                    Some(id) => {
                        faces = faces.max(id + 1);
                        builder.face_triangle(corners, count.faces + id);
                    }
                    None => builder.triangle(corners),
                }
            }
        }
        count.faces += faces;
        Ok(())
    }

    /// The corners of a primitive's triangles; none for points and lines.
    fn triangles(&self, primitive: &Value) -> Result<Vec<[u32; 3]>, Fault> {
        let mode = primitive["mode"].as_u64().unwrap_or(4);
        if !(4..=6).contains(&mode) {
            return Ok(Vec::new());
        }
        let corners = match &primitive["indices"] {
            Value::Null => {
                let positions = self.accessor(&primitive["attributes"]["POSITION"])?;
                (0..u32::try_from(positions.count).map_err(|_| ImportFault::TooManyVertices)?).collect()
            }
            indices => self.numbers(indices)?,
        };
        Ok(match mode {
            4 => corners.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect(),
            5 => {
                let turned = |(i, c): (usize, &[u32])| {
                    if i % 2 == 0 { [c[0], c[1], c[2]] } else { [c[1], c[0], c[2]] }
                };
                corners.windows(3).enumerate().map(turned).collect()
            }
            _ => corners.get(1..).unwrap_or_default().windows(2).map(|c| [corners[0], c[0], c[1]]).collect(),
        })
    }

    fn face_ids(&self, primitive: &Value, triangles: usize) -> Result<Option<Vec<u32>>, Fault> {
        let accessor = &primitive["extensions"]["TM_brep_faces"]["faceIndices"];
        if accessor.is_null() {
            return Ok(None);
        }
        let ids = self.numbers(accessor)?;
        if ids.len() == triangles {
            Ok(Some(ids))
        } else {
            Err(ImportFault::FaceIds { ids: ids.len(), triangles }.into())
        }
    }

    fn positions(&self, accessor: &Value, unused: bool) -> Result<Vec<DVec3>, Fault> {
        if unused {
            return Ok(Vec::new());
        }
        let data = self.accessor(accessor)?;
        if data.component != 5126 || data.kind != "VEC3" {
            return Err(broken(accessor, AccessorFault::NotPositions));
        }
        let coordinate = |b: &[u8]| f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]]));
        Ok(data
            .items()
            .map(|b| DVec3::new(coordinate(b), coordinate(&b[4..]), coordinate(&b[8..])))
            .collect())
    }

    fn numbers(&self, accessor: &Value) -> Result<Vec<u32>, Fault> {
        let data = self.accessor(accessor)?;
        if data.kind != "SCALAR" || data.component == 5126 {
            return Err(broken(accessor, AccessorFault::NotIntegers));
        }
        let number = |b: &[u8]| b.iter().rev().fold(0_u32, |n, &byte| n << 8 | u32::from(byte));
        Ok(data.items().map(number).collect())
    }

    fn accessor(&self, index: &Value) -> Result<Items<'_>, Fault> {
        let broken = |fault| Err(broken(index, fault));
        let accessor = index.as_u64().and_then(|i| self.root["accessors"].get(i as usize));
        let accessor = accessor.ok_or_else(|| unknown("accessor", index))?;
        if !accessor["sparse"].is_null() {
            return broken(AccessorFault::Sparse);
        }
        let unsigned = |v: &Value| v.as_u64().unwrap_or(0) as usize;
        let component = accessor["componentType"].as_u64().unwrap_or(0);
        let kind = accessor["type"].as_str().unwrap_or_default();
        let width = match component {
            5121 => 1,
            5123 => 2,
            5125 | 5126 => 4,
            other => return broken(AccessorFault::ComponentType(other)),
        };
        let size = width * if kind == "VEC3" { 3 } else { 1 };
        let count = unsigned(&accessor["count"]);
        let view = accessor["bufferView"].as_u64().and_then(|v| self.root["bufferViews"].get(v as usize));
        let Some(view) = view else { return broken(AccessorFault::NoView) };
        if unsigned(&view["buffer"]) != 0 || !self.root["buffers"][0]["uri"].is_null() {
            return broken(AccessorFault::OtherFile);
        }
        let stride = match unsigned(&view["byteStride"]) {
            0 => size,
            stride => stride,
        };
        let (start, length) = (unsigned(&view["byteOffset"]), unsigned(&view["byteLength"]));
        let bytes = self.binary.get(start..start.saturating_add(length));
        let bytes = bytes.and_then(|b| b.get(unsigned(&accessor["byteOffset"])..));
        let needed = count.checked_sub(1).map_or(Some(0), |n| n.checked_mul(stride)?.checked_add(size));
        match (bytes, needed) {
            (Some(bytes), Some(needed)) if needed <= bytes.len() => {
                Ok(Items { bytes, stride, size, count, component, kind })
            }
            _ => broken(AccessorFault::BeyondBuffer),
        }
    }
}

fn unknown(what: &'static str, id: impl ToString) -> ImportFault {
    ImportFault::Unknown { what, id: id.to_string() }
}

fn broken(accessor: &Value, fault: AccessorFault) -> Fault {
    ImportFault::Accessor { accessor: accessor.as_u64().unwrap_or(u64::MAX), fault }.into()
}

/// The items of an accessor, known to lie inside the file.
struct Items<'a> {
    bytes: &'a [u8],
    stride: usize,
    size: usize,
    count: usize,
    component: u64,
    kind: &'a str,
}

impl<'a> Items<'a> {
    fn items(&self) -> impl Iterator<Item = &'a [u8]> {
        let (bytes, stride, size) = (self.bytes, self.stride, self.size);
        (0..self.count).map(move |i| &bytes[i * stride..i * stride + size])
    }
}

fn indices(value: &Value) -> impl DoubleEndedIterator<Item = usize> {
    value.as_array().into_iter().flatten().filter_map(|v| v.as_u64()).map(|v| v as usize)
}

fn local_transform(node: &Value) -> DAffine3 {
    fn numbers<const N: usize>(value: &Value) -> Option<[f64; N]> {
        let numbers: Vec<f64> = value.as_array()?.iter().filter_map(Value::as_f64).collect();
        numbers.try_into().ok()
    }
    if let Some(matrix) = numbers::<16>(&node["matrix"]) {
        return DAffine3::from_mat4(DMat4::from_cols_array(&matrix));
    }
    let scale = numbers(&node["scale"]).map_or(DVec3::ONE, DVec3::from_array);
    let rotation = numbers(&node["rotation"]).map_or(DQuat::IDENTITY, DQuat::from_array);
    let translation = numbers(&node["translation"]).map_or(DVec3::ZERO, DVec3::from_array);
    DAffine3::from_scale_rotation_translation(scale, rotation, translation)
}
