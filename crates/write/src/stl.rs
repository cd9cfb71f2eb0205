//! STL: triangles and their normals, nothing shared, no unit.
//!
//! Binary STL is one unnamed solid of 32-bit floats. ASCII STL has named solids and carries 64-bit
//! coordinates here: the fewest digits that read back as the same number. Normals are those of the triangles
//! as written.

use crate::flat::{Item, Patch, Remap, Source, UNUSED, items};
use crate::frame::triangle_normal;
use crate::names::{Unique, one_line};
use crate::number::push_point;
use crate::summary::Tally;
use crate::{Countable, Format, SolidPer, WriteError, WriteOptions, color};
use chordal_mesh::Scene;
use glam::{DVec3, Vec3};
use std::io::Write;

/// Writes one solid of 32-bit floats.
pub(crate) fn write_binary(
    scene: &Scene,
    out: &mut impl Write,
    options: &WriteOptions,
    tally: &mut Tally,
) -> Result<(), WriteError> {
    let items = items(scene, options);
    let count: u64 = items.iter().map(triangle_count).sum();
    let small = |_| WriteError::TooLarge { what: Countable::Triangles, count, format: Format::StlBinary };
    out.write_all(&header(options))?;
    out.write_all(&u32::try_from(count).map_err(small)?.to_le_bytes())?;
    let mm = options.resolved_unit().millimetres();
    let (mut placed, mut rounded) = (Vec::new(), Vec::new());
    for item in &items {
        for group in item.groups() {
            let Some(first) = group.first() else { continue };
            let remap = Remap::new(&group);
            item.place_points(first.points, Some(&remap), &mut placed, options)?;
            rounded.clear();
            let used = placed.iter().zip(&remap.new_index);
            rounded.extend(used.map(|(&p, &i)| if i == UNUSED { Vec3::ZERO } else { tally.round(p, mm) }));
            for patch in &group {
                write_binary_patch(item, patch, &rounded, out, tally)?;
            }
        }
    }
    tally.vertices = 3 * tally.triangles;
    Ok(())
}

/// 80 bytes that must not start with `solid`, by which readers know ASCII files.
fn header(options: &WriteOptions) -> [u8; 80] {
    let text = format!("Chordal {}, binary STL, unit {}", env!("CARGO_PKG_VERSION"), options.resolved_unit());
    let mut header = [b' '; 80];
    let length = text.len().min(80);
    header[..length].copy_from_slice(&text.as_bytes()[..length]);
    header
}

fn triangle_count(item: &Item<'_>) -> u64 {
    let passed: usize = item.part.pass_through.iter().map(|p| p.triangles.len()).sum();
    (item.part.mesh.triangle_count() + passed) as u64
}

fn write_binary_patch(
    item: &Item<'_>,
    patch: &Patch<'_>,
    points: &[Vec3],
    out: &mut impl Write,
    tally: &mut Tally,
) -> Result<(), WriteError> {
    for &triangle in patch.triangles {
        let corners = item.place.winding(patch.point_indices(triangle)).map(|p| points[p as usize]);
        tally.count_triangle(corners);
        let normal = triangle_normal(corners.map(Vec3::as_dvec3)).as_vec3();
        let mut record = [0_u8; 50];
        for (start, vector) in [(0, normal), (12, corners[0]), (24, corners[1]), (36, corners[2])] {
            record[start..start + 4].copy_from_slice(&vector.x.to_le_bytes());
            record[start + 4..start + 8].copy_from_slice(&vector.y.to_le_bytes());
            record[start + 8..start + 12].copy_from_slice(&vector.z.to_le_bytes());
        }
        out.write_all(&record)?;
    }
    Ok(())
}

/// Writes named solids in decimal digits that lose nothing.
pub(crate) fn write_ascii(
    scene: &Scene,
    out: &mut impl Write,
    options: &WriteOptions,
    tally: &mut Tally,
) -> Result<(), WriteError> {
    let items = items(scene, options);
    match options.solid_per {
        SolidPer::Part => {
            for item in &items {
                write_solid(&item.name, &[item], |_| true, out, options, tally)?;
            }
        }
        SolidPer::Body => write_bodies(&items, out, options, tally)?,
        SolidPer::Color => write_colors(&items, out, options, tally)?,
    }
    if items.is_empty() {
        out.write_all(b"solid empty\nendsolid empty\n")?;
    }
    tally.vertices = 3 * tally.triangles;
    Ok(())
}

fn write_bodies(
    items: &[Item<'_>],
    out: &mut impl Write,
    options: &WriteOptions,
    tally: &mut Tally,
) -> Result<(), WriteError> {
    let mut unique = Unique::default();
    for item in items {
        let mut bodies: Vec<Option<u32>> = Vec::new();
        for patch in item.groups().iter().flatten().filter(|p| !p.triangles.is_empty()) {
            if !bodies.contains(&body(patch)) {
                bodies.push(body(patch));
            }
        }
        for wanted in bodies {
            let name = match wanted.map(|b| (b, item.part.body_names.get(b as usize))) {
                Some((_, Some(name))) if !name.trim().is_empty() => format!("{}.{}", item.name, name.trim()),
                Some((number, _)) => format!("{}.body_{number}", item.name),
                None => item.name.clone(),
            };
            write_solid(&unique.name(&name), &[item], |p| body(p) == wanted, out, options, tally)?;
        }
    }
    Ok(())
}

fn body(patch: &Patch<'_>) -> Option<u32> {
    match patch.source {
        Source::Face { body, .. } => body,
        Source::PassThrough { .. } => None,
    }
}

fn write_colors(
    items: &[Item<'_>],
    out: &mut impl Write,
    options: &WriteOptions,
    tally: &mut Tally,
) -> Result<(), WriteError> {
    let mut colors = Vec::new();
    for patch in items.iter().flat_map(Item::groups).flatten().filter(|p| !p.triangles.is_empty()) {
        let name = color_name(&patch);
        if !colors.contains(&name) {
            colors.push(name);
        }
    }
    let all: Vec<_> = items.iter().collect();
    for wanted in colors {
        write_solid(&wanted, &all, |p| color_name(p) == wanted, out, options, tally)?;
    }
    Ok(())
}

fn color_name(patch: &Patch<'_>) -> String {
    patch.color.map_or_else(|| "uncoloured".to_owned(), |c| format!("color_{}", color::hex(c)))
}

fn write_solid(
    name: &str,
    items: &[&Item<'_>],
    wanted: impl Fn(&Patch<'_>) -> bool,
    out: &mut impl Write,
    options: &WriteOptions,
    tally: &mut Tally,
) -> Result<(), WriteError> {
    let name = one_line(name);
    writeln!(out, "solid {name}")?;
    let (mut placed, mut text) = (Vec::new(), Vec::new());
    let mut lines = VertexLines::default();
    for item in items {
        for mut group in item.groups() {
            group.retain(&wanted);
            let Some(first) = group.first() else { continue };
            let remap = Remap::new(&group);
            item.place_points(first.points, Some(&remap), &mut placed, options)?;
            lines.fill(&placed, &remap);
            for patch in &group {
                for &triangle in patch.triangles {
                    let indices = item.place.winding(patch.point_indices(triangle));
                    let corners = indices.map(|p| placed[p as usize]);
                    tally.count_triangle(corners);
                    text.clear();
                    push_facet(&mut text, triangle_normal(corners), indices.map(|p| lines.line(p)));
                    out.write_all(&text)?;
                }
            }
        }
    }
    writeln!(out, "endsolid {name}")?;
    Ok(())
}

/// The line of each used point: most points are corners of six triangles, and formatting digits is slow.
#[derive(Debug, Default)]
struct VertexLines {
    text: Vec<u8>,
    ends: Vec<usize>,
}

impl VertexLines {
    fn fill(&mut self, points: &[DVec3], remap: &Remap) {
        self.text.clear();
        self.ends.clear();
        for (&p, &index) in points.iter().zip(&remap.new_index) {
            if index != UNUSED {
                self.text.extend_from_slice(b"  vertex");
                push_point(&mut self.text, p);
                self.text.push(b'\n');
            }
            self.ends.push(self.text.len());
        }
    }

    fn line(&self, point: u32) -> &[u8] {
        let point = point as usize;
        let start = if point == 0 { 0 } else { self.ends[point - 1] };
        &self.text[start..self.ends[point]]
    }
}

fn push_facet(text: &mut Vec<u8>, normal: DVec3, lines: [&[u8]; 3]) {
    text.extend_from_slice(b"facet normal");
    // Readers use a normal for its direction only: six digits of it are worth their space, more are not.
    push_point(text, (normal * 1e6).round() / 1e6);
    text.extend_from_slice(b"\n outer loop\n");
    lines.into_iter().for_each(|line| text.extend_from_slice(line));
    text.extend_from_slice(b" endloop\nendfacet\n");
}
