//! PLY: binary little endian, 64-bit coordinates, each point once per placed part, a face index per triangle
//! (or quadrilateral, where the mesh has them: it counts as one wherever triangles are counted).
//!
//! `face_id` counts the faces of all placed parts in the order of the tree; triangles that came tessellated
//! have −1. A comment `part V NV T NT F NF NAME` per placed part gives its first vertex, triangle and face
//! and how many it has.

use crate::flat::{Item, Patch, Remap, Source, UNUSED, items, remaps};
use crate::names::one_line;
use crate::summary::Tally;
use crate::{Countable, Format, WriteError, WriteOptions, color};
use chordal_mesh::Scene;
use std::io::Write;

pub(crate) fn write(
    scene: &Scene,
    out: &mut impl Write,
    options: &WriteOptions,
    tally: &mut Tally,
) -> Result<(), WriteError> {
    let items = items(scene, options);
    let remaps = remaps(scene, &items);
    let colored = items.iter().flat_map(Item::groups).flatten().any(|p| p.color.is_some());
    out.write_all(&header(&items, &remaps, colored, options)?)?;
    for item in &items {
        write_vertices(item, &remaps[item.part_index], out, options)?;
    }
    let mut first_vertex = 0;
    for item in &items {
        for (group, remap) in item.groups().iter().zip(&remaps[item.part_index]) {
            for patch in group {
                write_faces(item, patch, remap, first_vertex, colored, out, tally)?;
            }
            first_vertex += remap.used;
        }
    }
    tally.vertices = u64::from(first_vertex);
    Ok(())
}

fn header(
    items: &[Item<'_>],
    remaps: &[Vec<Remap>],
    colored: bool,
    options: &WriteOptions,
) -> Result<Vec<u8>, WriteError> {
    let mut text = "ply\nformat binary_little_endian 1.0\n".to_owned();
    text += &format!("comment Chordal {}\n", env!("CARGO_PKG_VERSION"));
    text += &format!("comment unit {}\n", options.resolved_unit());
    text += &format!("comment up {}\n", if options.resolved_up() == crate::UpAxis::Z { "z" } else { "y" });
    let (mut vertices, mut triangles) = (0_u64, 0_u64);
    for item in items {
        let item_vertices: u64 = remaps[item.part_index].iter().map(|r| u64::from(r.used)).sum();
        let item_triangles: usize = item.groups().iter().flatten().map(|p| p.polygons().count()).sum();
        let (item_triangles, faces) = (item_triangles as u64, item.part.mesh.faces.len());
        let (name, face) = (one_line(&item.name), item.first_face);
        text += &format!(
            "comment part {vertices} {item_vertices} {triangles} {item_triangles} {face} {faces} {name}\n"
        );
        vertices += item_vertices;
        triangles += item_triangles;
    }
    let faces: u64 = items.iter().map(|i| i.part.mesh.faces.len() as u64).sum();
    // Indices and face ids are signed 32-bit numbers, and many readers count in them.
    for (what, count) in
        [(Countable::Vertices, vertices), (Countable::Triangles, triangles), (Countable::Faces, faces)]
    {
        if count > i32::MAX as u64 {
            return Err(WriteError::TooLarge { what, count, format: Format::Ply });
        }
    }
    text += &format!("element vertex {vertices}\n");
    text += "property double x\nproperty double y\nproperty double z\n";
    text +=
        &format!("element face {triangles}\nproperty list uchar int vertex_indices\nproperty int face_id\n");
    if colored {
        text += "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n";
    }
    text += "end_header\n";
    Ok(text.into_bytes())
}

fn write_vertices(
    item: &Item<'_>,
    remaps: &[Remap],
    out: &mut impl Write,
    options: &WriteOptions,
) -> Result<(), WriteError> {
    let mut placed = Vec::new();
    for (group, remap) in item.groups().iter().zip(remaps) {
        let Some(first) = group.first() else { continue };
        item.place_points(first.points, Some(remap), &mut placed, options)?;
        for (p, _) in placed.iter().zip(&remap.new_index).filter(|(_, index)| **index != UNUSED) {
            let mut record = [0_u8; 24];
            for (bytes, coordinate) in record.chunks_exact_mut(8).zip(p.to_array()) {
                bytes.copy_from_slice(&coordinate.to_le_bytes());
            }
            out.write_all(&record)?;
        }
    }
    Ok(())
}

fn write_faces(
    item: &Item<'_>,
    patch: &Patch<'_>,
    remap: &Remap,
    first_vertex: u32,
    colored: bool,
    out: &mut impl Write,
    tally: &mut Tally,
) -> Result<(), WriteError> {
    let face_id = match patch.source {
        Source::Face { face, .. } => (item.first_face + u64::from(face)) as i32,
        Source::PassThrough { .. } => -1,
    };
    let color = color::srgb_bytes(patch.color.unwrap_or(color::UNCOLORED));
    let (mut record, mut corners) = (Vec::with_capacity(25), Vec::with_capacity(4));
    for &triangle in patch.triangles {
        tally.count_triangle(patch.point_indices(triangle));
    }
    for polygon in patch.polygons() {
        corners.clear();
        corners.extend(patch.polygon_points(&polygon).map(|p| first_vertex + remap.new_index[p as usize]));
        item.place.wind(&mut corners);
        record.clear();
        record.push(corners.len() as u8);
        corners.iter().for_each(|index| record.extend_from_slice(&index.to_le_bytes()));
        record.extend_from_slice(&face_id.to_le_bytes());
        if colored {
            record.extend_from_slice(&color);
        }
        out.write_all(&record)?;
    }
    Ok(())
}
