//! 3MF: the meshes of every build item, through its components. Materials and other files in the archive are
//! skipped.

use super::error::{Fault, ImportFault};
use super::gltf::MOST_TRIANGLES;
use super::weld::{Builder, reverses};
use super::xml::{Tag, tags, unescape};
use glam::{DAffine3, DVec3};
use std::collections::BTreeMap;
use std::io::{Cursor, Read};

/// The largest ratio of unpacked text to the whole file that is read.
///
/// The XML of a mesh compresses by less than 30. A smaller limit could refuse valid files; without one a
/// file of a kilobyte could fill the memory.
const MOST_RATIO: u64 = 200;

/// The most components that are placed in all, for the reason of [`MOST_TRIANGLES`]: components may be empty.
const MOST_COMPONENTS: usize = 10_000_000;

#[derive(Debug, Default)]
struct Object {
    name: String,
    vertices: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    components: Vec<(u64, DAffine3)>,
}

#[derive(Debug, Default)]
struct Model {
    objects: BTreeMap<u64, Object>,
    items: Vec<(u64, DAffine3)>,
}

pub(super) fn read(bytes: &[u8], builder: &mut Builder) -> Result<(), Fault> {
    let text = model_text(bytes)?;
    let model = parse(&text, builder)?;
    // The depth of a tree is at most the number of its objects; a deeper path contains a cycle.
    let most_depth = model.objects.len();
    let (mut triangles, mut placed) = (0, 0);
    for &(item, transform) in &model.items {
        builder.group(model.objects.get(&item).map_or("", |o| o.name.as_str()));
        let mut stack = vec![(item, transform, 0)];
        while let Some((id, transform, depth)) = stack.pop() {
            let object = model
                .objects
                .get(&id)
                .ok_or_else(|| ImportFault::Unknown { what: "object", id: id.to_string() })?;
            triangles += object.triangles.len() as u64;
            placed += 1;
            if triangles > MOST_TRIANGLES || placed > MOST_COMPONENTS {
                return Err(ImportFault::TooManyTriangles { limit: MOST_TRIANGLES }.into());
            }
            if depth > most_depth {
                return Err(ImportFault::ContainsItself { object: id }.into());
            }
            if !object.triangles.is_empty() {
                builder.group(&object.name);
            }
            place(object, transform, builder)?;
            let children = object.components.iter().rev();
            stack.extend(children.map(|&(child, local)| (child, transform * local, depth + 1)));
        }
    }
    Ok(())
}

/// The text of the archive's model.
fn model_text(bytes: &[u8]) -> Result<String, Fault> {
    let mut archive = zip::ZipArchive::new(Cursor::new(bytes))
        .map_err(|e| ImportFault::Archive { member: String::new(), reason: e.to_string() })?;
    let relationships = member(&mut archive, "_rels/.rels", bytes.len()).unwrap_or_default();
    let target = tags(&relationships).find_map(|tag| {
        let is_model = tag.attribute("Type")?.ends_with("/3dmodel");
        is_model.then(|| tag.attribute("Target")).flatten()
    });
    let name = target.unwrap_or("3D/3dmodel.model").trim_start_matches('/').to_owned();
    member(&mut archive, &name, bytes.len())
}

fn member(
    archive: &mut zip::ZipArchive<Cursor<&[u8]>>,
    name: &str,
    compressed: usize,
) -> Result<String, Fault> {
    let broken =
        |e: &dyn std::fmt::Display| ImportFault::Archive { member: name.to_owned(), reason: e.to_string() };
    let limit = MOST_RATIO * compressed as u64 + (1 << 20);
    let member = archive.by_name(name).map_err(|e| broken(&e))?;
    let mut text = Vec::new();
    member.take(limit + 1).read_to_end(&mut text).map_err(|e| broken(&e))?;
    if text.len() as u64 > limit {
        return Err(ImportFault::ArchiveRatio { member: name.to_owned(), limit: MOST_RATIO }.into());
    }
    Ok(String::from_utf8_lossy(&text).into_owned())
}

fn parse(text: &str, builder: &mut Builder) -> Result<Model, Fault> {
    let mut model = Model::default();
    let mut current: Option<(u64, Object)> = None;
    for tag in tags(text) {
        match (tag.name, tag.closing) {
            ("model", false) => builder.unit_mm = unit(tag.attribute("unit")),
            ("object", false) => {
                let id = tag.number("id").ok_or(ImportFault::Missing { what: "id of an object" })?;
                let name = unescape(tag.attribute("name").unwrap_or_default()).into_owned();
                current = Some((id, Object { name, ..Object::default() }));
            }
            ("object", true) => model.objects.extend(current.take()),
            ("item", false) => model.items.push(reference(&tag)?),
            (name, false) => {
                if let Some((id, object)) = &mut current {
                    inside(object, name, &tag)
                        .map_err(|fault| ImportFault::InObject { object: *id, fault: Box::new(fault) })?;
                }
            }
            _ => {}
        }
    }
    if current.is_some() { Err(ImportFault::EndsInside { what: "object" }.into()) } else { Ok(model) }
}

fn inside(object: &mut Object, name: &str, tag: &Tag<'_>) -> Result<(), ImportFault> {
    match name {
        "vertex" => {
            let (Some(x), Some(y), Some(z)) = (tag.number("x"), tag.number("y"), tag.number("z")) else {
                return Err(ImportFault::Vertex);
            };
            object.vertices.push(DVec3::new(x, y, z));
        }
        "triangle" => {
            let (Some(a), Some(b), Some(c)) = (tag.number("v1"), tag.number("v2"), tag.number("v3")) else {
                return Err(ImportFault::Missing { what: "corner of a triangle" });
            };
            object.triangles.push([a, b, c]);
        }
        "component" => object.components.push(reference(tag)?),
        _ => {}
    }
    Ok(())
}

/// The object and the transform of a component or build item.
fn reference(tag: &Tag<'_>) -> Result<(u64, DAffine3), ImportFault> {
    if tag.attribute("path").is_some() {
        return Err(ImportFault::OtherModel);
    }
    let id =
        tag.number("objectid").ok_or(ImportFault::Missing { what: "objectid of a component or item" })?;
    let Some(text) = tag.attribute("transform") else { return Ok((id, DAffine3::IDENTITY)) };
    let numbers: Vec<f64> = text.split_ascii_whitespace().filter_map(|n| n.parse().ok()).collect();
    let numbers: [f64; 12] =
        numbers.try_into().map_err(|_| ImportFault::Transform { text: text.to_owned() })?;
    Ok((id, DAffine3::from_cols_array(&numbers)))
}

fn unit(name: Option<&str>) -> Option<f64> {
    Some(match name {
        Some("micron") => 0.001,
        Some("centimeter") => 10.0,
        Some("inch") => 25.4,
        Some("foot") => 304.8,
        Some("meter") => 1000.0,
        _ => 1.0,
    })
}

fn place(object: &Object, transform: DAffine3, builder: &mut Builder) -> Result<(), ImportFault> {
    for &triangle in &object.triangles {
        let mut corners = [0; 3];
        for (corner, index) in corners.iter_mut().zip(triangle) {
            let p = object.vertices.get(index as usize);
            let p = p.ok_or_else(|| ImportFault::UnknownVertex {
                vertex: index.to_string(),
                vertices: object.vertices.len(),
            })?;
            *corner = builder.point(transform.transform_point3(*p))?;
        }
        if reverses(&transform) {
            corners.swap(1, 2);
        }
        builder.triangle(corners);
    }
    Ok(())
}
