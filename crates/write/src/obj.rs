//! OBJ: an object per placed part, a group per face, shared vertices, exact normals, 64-bit numbers in
//! decimal digits; quadrilaterals where the mesh has them.
//!
//! Colours live in a material library (MTL) beside the file. Their parts are sRGB, as viewers show them.

use crate::flat::{Item, Patch, Remap, Source, UNUSED, items, remaps};
use crate::frame::triangle_normal;
use crate::names::one_word;
use crate::number::{push_number, push_point};
use crate::summary::Tally;
use crate::{WriteError, WriteOptions, color};
use chordal_mesh::{Rgba, Scene};
use glam::DVec3;
use rustc_hash::FxHashMap;
use std::io::Write;

/// Writes the mesh; materials are named only if there is a `library`.
pub(crate) fn write(
    scene: &Scene,
    out: &mut impl Write,
    library: Option<&str>,
    options: &WriteOptions,
    tally: &mut Tally,
) -> Result<(), WriteError> {
    let items = items(scene, options);
    let remaps = remaps(scene, &items);
    writeln!(out, "# Chordal {}, unit {}", env!("CARGO_PKG_VERSION"), options.resolved_unit())?;
    if let Some(library) = library {
        writeln!(out, "mtllib {library}")?;
    }
    let mut writer = Writer { vertices: 0, normals: 0, material: None, with_materials: library.is_some() };
    for item in &items {
        writer.item(item, &remaps[item.part_index], out, options, tally)?;
    }
    tally.vertices = writer.vertices;
    Ok(())
}

/// Whether any triangle has a colour.
pub(crate) fn has_colors(scene: &Scene, options: &WriteOptions) -> bool {
    let items = items(scene, options);
    items.iter().flat_map(Item::groups).flatten().any(|p| p.color.is_some() && !p.triangles.is_empty())
}

/// Writes the material library: the colours in the order of their first use.
pub(crate) fn write_library(
    scene: &Scene,
    out: &mut impl Write,
    options: &WriteOptions,
) -> Result<(), WriteError> {
    let mut written = Vec::new();
    writeln!(out, "# Chordal {}", env!("CARGO_PKG_VERSION"))?;
    for patch in items(scene, options).iter().flat_map(Item::groups).flatten() {
        let name = material_name(patch.color);
        if patch.triangles.is_empty() || written.contains(&name) {
            continue;
        }
        let [r, g, b, a] = color::clamped(patch.color.unwrap_or(color::UNCOLORED));
        let mut text = format!("newmtl {name}\nKd").into_bytes();
        for part in [r, g, b] {
            text.push(b' ');
            push_number(&mut text, (color::srgb(part) * 1e6).round() / 1e6);
        }
        text.extend_from_slice(b"\nd ");
        push_number(&mut text, (f64::from(a) * 1e6).round() / 1e6);
        text.extend_from_slice(b"\nillum 1\n");
        out.write_all(&text)?;
        written.push(name);
    }
    Ok(())
}

fn material_name(color: Option<Rgba>) -> String {
    color.map_or_else(|| "uncoloured".to_owned(), |c| format!("color_{}", color::hex(c)))
}

struct Writer {
    vertices: u64,
    normals: u64,
    /// The material in force.
    material: Option<String>,
    with_materials: bool,
}

impl Writer {
    fn item(
        &mut self,
        item: &Item<'_>,
        remaps: &[Remap],
        out: &mut impl Write,
        options: &WriteOptions,
        tally: &mut Tally,
    ) -> Result<(), WriteError> {
        let name = one_word(&item.name);
        writeln!(out, "o {name}")?;
        let (mut placed, mut text) = (Vec::new(), Vec::new());
        for (group, remap) in item.groups().iter().zip(remaps) {
            let Some(first) = group.first() else { continue };
            item.place_points(first.points, Some(remap), &mut placed, options)?;
            for (&p, _) in placed.iter().zip(&remap.new_index).filter(|(_, index)| **index != UNUSED) {
                text.clear();
                text.push(b'v');
                push_point(&mut text, p);
                text.push(b'\n');
                out.write_all(&text)?;
            }
            for patch in group.iter().filter(|p| !p.triangles.is_empty()) {
                self.patch(item, &name, patch, (remap, &placed), out, tally)?;
            }
            self.vertices += u64::from(remap.used);
        }
        Ok(())
    }

    fn patch(
        &mut self,
        item: &Item<'_>,
        item_name: &str,
        patch: &Patch<'_>,
        (remap, placed): (&Remap, &[DVec3]),
        out: &mut impl Write,
        tally: &mut Tally,
    ) -> Result<(), WriteError> {
        let normals = self.patch_normals(item, patch, placed, out)?;
        let kind = match patch.source {
            Source::Face { face, .. } => format!("face_{face}"),
            Source::PassThrough { .. } => "tessellated".to_owned(),
        };
        let name = if patch.name.is_empty() { String::new() } else { format!(".{}", one_word(patch.name)) };
        writeln!(out, "g {item_name}.{kind}{name}")?;
        let material = material_name(patch.color);
        if self.with_materials && self.material.as_ref() != Some(&material) {
            writeln!(out, "usemtl {material}")?;
            self.material = Some(material);
        }
        let mut text = Vec::new();
        for &triangle in patch.triangles {
            tally.count_triangle(patch.point_indices(triangle).map(|p| remap.new_index[p as usize]));
        }
        let mut corners = Vec::with_capacity(4);
        for polygon in patch.polygons() {
            corners.clear();
            corners.extend(patch.polygon_points(&polygon).zip(polygon.slots()).map(|(point, &slot)| {
                let vertex = self.vertices + u64::from(remap.new_index[point as usize]) + 1;
                (vertex, normals.get(slot).copied())
            }));
            item.place.wind(&mut corners);
            text.clear();
            text.push(b'f');
            for &(vertex, normal) in &corners {
                match normal {
                    Some(normal) => write!(text, " {vertex}//{normal}"),
                    None => write!(text, " {vertex}"),
                }
                .expect("writing to memory cannot fail");
            }
            text.push(b'\n');
            out.write_all(&text)?;
        }
        Ok(())
    }

    /// Writes each different normal of a patch once; returns the number of each triangle corner's normal,
    /// nothing where the patch has none.
    fn patch_normals(
        &mut self,
        item: &Item<'_>,
        patch: &Patch<'_>,
        placed: &[DVec3],
        out: &mut impl Write,
    ) -> Result<Vec<u64>, WriteError> {
        let mut numbers = Vec::new();
        let mut of_corner: Vec<Option<u64>> = Vec::new();
        let mut known: FxHashMap<[u64; 3], u64> = FxHashMap::default();
        let mut text = Vec::new();
        for &triangle in patch.triangles.iter().take_while(|_| patch.has_normals()) {
            for corner in triangle {
                let corner = corner as usize;
                if corner >= of_corner.len() {
                    of_corner.resize(corner + 1, None);
                }
                let number = of_corner[corner].unwrap_or_else(|| {
                    let exact = patch.normal(corner as u32).and_then(|n| item.place.normal(n));
                    let normal = exact.unwrap_or_else(|| {
                        let points = item.place.winding(patch.point_indices(triangle));
                        triangle_normal(points.map(|p| placed[p as usize]))
                    });
                    let number = *known.entry(normal.to_array().map(f64::to_bits)).or_insert_with(|| {
                        self.normals += 1;
                        text.extend_from_slice(b"vn");
                        push_point(&mut text, normal);
                        text.push(b'\n');
                        self.normals
                    });
                    // At a pole without a normal each triangle has its own.
                    of_corner[corner] = exact.map(|_| number);
                    number
                });
                numbers.push(number);
            }
        }
        out.write_all(&text)?;
        Ok(numbers)
    }
}
