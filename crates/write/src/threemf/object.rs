//! One part as a mesh object.

use super::materials::{self, Materials};
use super::{mirror, name_attribute};
use crate::flat::{Remap, UNUSED, groups};
use crate::frame::Frame;
use crate::number::push_number;
use crate::summary::finite;
use crate::{WriteError, WriteOptions};
use chordal_mesh::{Rgba, ScenePart};
use glam::DVec3;
use std::io::Write;

/// An object in the file.
#[derive(Debug)]
pub(super) struct Written {
    pub id: u32,
    pub vertices: u64,
    pub triangles: u64,
    /// Triangles omitted because two of their corners are one vertex, which 3MF forbids.
    pub collapsed: u64,
}

/// A part's triangles in file coordinates.
#[derive(Debug)]
pub(super) struct Mesh<'a> {
    name: &'a str,
    vertices: Vec<DVec3>,
    triangles: Vec<([u32; 3], Option<Rgba>)>,
    collapsed: u64,
}

/// The triangles of a part, tessellated items included.
pub(super) fn triangle_count(part: &ScenePart) -> usize {
    part.mesh.triangle_count() + part.pass_through.iter().map(|p| p.triangles.len()).sum::<usize>()
}

impl<'a> Mesh<'a> {
    pub fn new(
        part: &'a ScenePart,
        color: Option<Rgba>,
        mirrored: bool,
        frame: Frame,
        options: &WriteOptions,
    ) -> Result<Self, WriteError> {
        let triangles = Vec::with_capacity(triangle_count(part));
        let mut mesh = Self { name: &part.name, vertices: Vec::new(), triangles, collapsed: 0 };
        let mirror = mirror(mirrored).matrix3;
        for group in groups(part, color) {
            let Some(first) = group.first() else { continue };
            let remap = Remap::new(&group);
            let start = mesh.vertices.len() as u32;
            for (&p, _) in first.points.iter().zip(&remap.new_index).filter(|(_, index)| **index != UNUSED) {
                mesh.vertices.push(finite(mirror * frame.apply(p), &part.name, options)?);
            }
            for patch in &group {
                for &triangle in patch.triangles {
                    let [a, b, c] =
                        patch.point_indices(triangle).map(|p| start + remap.new_index[p as usize]);
                    if a == b || b == c || c == a {
                        mesh.collapsed += 1;
                    } else {
                        mesh.triangles.push((if mirrored { [a, c, b] } else { [a, b, c] }, patch.color));
                    }
                }
            }
        }
        Ok(mesh)
    }

    /// Writes the object unless it is empty.
    pub fn write(
        &self,
        id: u32,
        materials: &Materials,
        out: &mut impl Write,
    ) -> Result<Option<Written>, WriteError> {
        let Some(&(_, first_color)) = self.triangles.first() else { return Ok(None) };
        let colored = self.triangles.iter().any(|(_, color)| color.is_some());
        let default = colored.then(|| materials.index(first_color));
        let property =
            default.map_or_else(String::new, |i| format!(" pid=\"{}\" pindex=\"{i}\"", materials::ID));
        let kind = if self.is_closed() { "model" } else { "surface" };
        writeln!(out, "<object id=\"{id}\" type=\"{kind}\"{}{property}>", name_attribute(self.name))?;
        writeln!(out, "<mesh>\n<vertices>")?;
        let mut text = Vec::new();
        for p in &self.vertices {
            text.clear();
            for (start, value) in [(&b"<vertex x=\""[..], p.x), (b"\" y=\"", p.y), (b"\" z=\"", p.z)] {
                text.extend_from_slice(start);
                push_number(&mut text, value);
            }
            text.extend_from_slice(b"\"/>\n");
            out.write_all(&text)?;
        }
        writeln!(out, "</vertices>\n<triangles>")?;
        let mut last = (first_color, default);
        for &([a, b, c], color) in &self.triangles {
            if last.0 != color {
                last = (color, colored.then(|| materials.index(color)));
            }
            write!(out, "<triangle v1=\"{a}\" v2=\"{b}\" v3=\"{c}\"")?;
            match last.1 {
                Some(index) if last.1 != default => {
                    writeln!(out, " pid=\"{}\" p1=\"{index}\"/>", materials::ID)?;
                }
                _ => writeln!(out, "/>")?,
            }
        }
        writeln!(out, "</triangles>\n</mesh>\n</object>")?;
        Ok(Some(Written {
            id,
            vertices: self.vertices.len() as u64,
            triangles: self.triangles.len() as u64,
            collapsed: self.collapsed,
        }))
    }

    /// Whether every edge has exactly one triangle on each side: 3MF demands it of objects of type `model`.
    fn is_closed(&self) -> bool {
        let key = |a: u32, b: u32| u64::from(a) << 32 | u64::from(b);
        let directed = |&([a, b, c], _): &([u32; 3], _)| [key(a, b), key(b, c), key(c, a)];
        let mut edges: Vec<u64> = self.triangles.iter().flat_map(directed).collect();
        edges.sort_unstable();
        let twice = edges.windows(2).any(|pair| pair[0] == pair[1]);
        !twice && edges.iter().all(|&edge| edges.binary_search(&edge.rotate_left(32)).is_ok())
    }
}
