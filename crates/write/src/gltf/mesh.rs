//! Parts as glTF meshes, each made once per colour that overrides its own.

use super::buffer::Data;
use super::json::{self, Attributes, BrepFaces, Extensions, LINES, Material, Pbr, Primitive, TRIANGLES};
use super::{origin_of, surfaces};
use crate::color::{self, ColorKey};
use crate::flat::{Patch, Remap, Source, UNUSED, groups};
use crate::frame::{Frame, triangle_normal, unit};
use crate::summary::{Tally, finite};
use crate::{WriteError, WriteOptions};
use chordal_mesh::{PlacedPart, Rgba, Scene, ScenePart};
use glam::{DVec3, Vec3};
use std::collections::BTreeMap;

/// Almost black: edges must be seen on parts of any colour.
const EDGE_COLOR: Rgba = [0.02, 0.02, 0.02, 1.0];

/// A part in the colours of one kind of placement.
#[derive(Clone, Debug)]
pub(super) struct Variant {
    pub mesh: usize,
    /// The mesh's origin in file coordinates; its node moves it there.
    pub origin: DVec3,
    triangles: u64,
    collapsed: u64,
    /// How far rounding moved a vertex, in units of the part.
    rounding: f64,
}

/// The meshes so far.
#[derive(Debug)]
pub(super) struct Meshes<'a> {
    scene: &'a Scene,
    frame: Frame,
    options: &'a WriteOptions,
    data: Data,
    meshes: Vec<json::Mesh>,
    materials: Vec<Material>,
    material_of: BTreeMap<Option<ColorKey>, usize>,
    edge_material: Option<usize>,
    variants: BTreeMap<(usize, Option<ColorKey>), Option<Variant>>,
    pub vertices: u64,
    pub has_faces: bool,
}

impl<'a> Meshes<'a> {
    pub fn new(scene: &'a Scene, frame: Frame, options: &'a WriteOptions) -> Self {
        Self {
            scene,
            frame,
            options,
            data: Data::default(),
            meshes: Vec::new(),
            materials: Vec::new(),
            material_of: BTreeMap::new(),
            edge_material: None,
            variants: BTreeMap::new(),
            vertices: 0,
            has_faces: false,
        }
    }

    /// The mesh for a placed part, counted in the tally; none for a part without triangles and edge lines.
    pub fn variant(
        &mut self,
        placed: &PlacedPart,
        tally: &mut Tally,
    ) -> Result<Option<&Variant>, WriteError> {
        let key = (placed.part, placed.color.map(color::key));
        if !self.variants.contains_key(&key) {
            let variant = self.build(&self.scene.parts[placed.part], placed.color)?;
            self.variants.insert(key, variant);
        }
        let variant = self.variants[&key].as_ref();
        if let Some(v) = variant {
            tally.triangles += v.triangles;
            tally.collapsed += v.collapsed;
            tally.rounding_mm = tally.rounding_mm.max(v.rounding * stretch(placed));
        }
        Ok(variant)
    }

    /// Completes the JSON and hands out the bytes.
    pub fn into_root(self, root: impl FnOnce(&Self) -> json::Root) -> (json::Root, Vec<u8>) {
        let mut root = root(&self);
        root.meshes = self.meshes;
        root.materials = self.materials;
        root.accessors = self.data.accessors;
        root.buffer_views = self.data.views;
        if !self.data.bytes.is_empty() {
            root.buffers = vec![json::Buffer { byte_length: self.data.bytes.len(), uri: None }];
        }
        (root, self.data.bytes)
    }

    fn build(&mut self, part: &ScenePart, color: Option<Rgba>) -> Result<Option<Variant>, WriteError> {
        let groups = groups(part, color);
        let placed = self.placed_points(part, &groups)?;
        let used = placed.iter().flatten().flatten();
        let bounds = used.fold(None, |b: Option<(DVec3, DVec3)>, p| {
            Some(b.map_or((*p, *p), |(low, high)| (low.min(*p), high.max(*p))))
        });
        let Some((low, high)) = bounds else { return Ok(None) };
        let origin = origin_of(low, high);
        let mut tally = Tally::default();
        let mut primitives = Vec::new();
        for (group, placed) in groups.iter().zip(placed) {
            let points = Points::new(&placed, origin, &mut tally, self.frame.mm);
            for patches in by_color(group) {
                primitives.push(self.primitive(part, &patches, &points, origin, &mut tally));
            }
        }
        if self.options.edge_lines {
            primitives.extend(self.edge_primitive(part, origin)?);
        }
        let mesh = self.meshes.len();
        self.meshes.push(json::Mesh { name: part.name.clone(), primitives });
        let (triangles, collapsed, rounding) = (tally.triangles, tally.collapsed, tally.rounding_mm);
        Ok(Some(Variant { mesh, origin, triangles, collapsed, rounding }))
    }

    /// Per group the points in file coordinates; none where no triangle uses one.
    fn placed_points(
        &self,
        part: &ScenePart,
        groups: &[Vec<Patch<'_>>],
    ) -> Result<Vec<Vec<Option<DVec3>>>, WriteError> {
        let place = |group: &Vec<Patch<'_>>| -> Result<Vec<Option<DVec3>>, WriteError> {
            let remap = Remap::new(group);
            let points = group.first().map_or(&[][..], |p| p.points);
            let place = |(&p, &index): (&DVec3, &u32)| match index {
                UNUSED => Ok(None),
                _ => finite(self.frame.apply(p), &part.name, self.options).map(Some),
            };
            points.iter().zip(&remap.new_index).map(place).collect()
        };
        groups.iter().map(place).collect()
    }

    /// One primitive of patches of one colour.
    fn primitive(
        &mut self,
        part: &ScenePart,
        patches: &[&Patch<'_>],
        points: &Points,
        origin: DVec3,
        tally: &mut Tally,
    ) -> Primitive {
        let mut builder = Builder::new(points);
        patches.iter().for_each(|patch| builder.patch(patch, self.frame, tally));
        self.vertices += builder.vertices.len() as u64;
        let attributes = Attributes {
            position: self.data.vectors(&builder.vertices, true),
            normal: builder.with_normals.then(|| self.data.vectors(&builder.normals, false)),
        };
        let indices = self.data.indices(&builder.indices, builder.vertices.len());
        let extensions = (!builder.face_ids.is_empty()).then(|| {
            self.has_faces = true;
            let face_indices = self.data.numbers(&builder.face_ids);
            let faces = brep_faces(part, patches, self.frame, origin);
            Extensions { faces: BrepFaces { face_indices, faces } }
        });
        let material = self.material(patches[0].color);
        Primitive { attributes, indices, material, mode: TRIANGLES, extensions }
    }

    fn material(&mut self, color: Option<Rgba>) -> usize {
        let color = color.map(color::clamped);
        *self.material_of.entry(color.map(color::key)).or_insert_with(|| {
            let name = color.map_or_else(|| "uncoloured".to_owned(), |c| format!("color_{}", color::hex(c)));
            self.materials.push(material(name, color.unwrap_or(color::UNCOLORED)));
            self.materials.len() - 1
        })
    }

    /// The part's edges as separate lines, if it has any.
    fn edge_primitive(&mut self, part: &ScenePart, origin: DVec3) -> Result<Option<Primitive>, WriteError> {
        let mesh = &part.mesh;
        let mut new_index = vec![UNUSED; mesh.positions.len()];
        let (mut vertices, mut indices) = (Vec::new(), Vec::new());
        for edge in &mesh.edges {
            for line in edge.windows(2) {
                for &p in line {
                    if new_index[p as usize] == UNUSED {
                        new_index[p as usize] = vertices.len() as u32;
                        let point = self.frame.apply(mesh.positions[p as usize]) - origin;
                        vertices.push(finite(point, &part.name, self.options)?.as_vec3());
                    }
                    indices.push(new_index[p as usize]);
                }
            }
        }
        if indices.is_empty() {
            return Ok(None);
        }
        let position = self.data.vectors(&vertices, true);
        let indices = self.data.indices(&indices, vertices.len());
        let material = *self.edge_material.get_or_insert_with(|| {
            self.materials.push(material("edges".to_owned(), EDGE_COLOR));
            self.materials.len() - 1
        });
        let attributes = Attributes { position, normal: None };
        Ok(Some(Primitive { attributes, indices, material, mode: LINES, extensions: None }))
    }
}

fn material(name: String, color: Rgba) -> Material {
    Material {
        name,
        pbr_metallic_roughness: Pbr {
            base_color_factor: color.map(f64::from),
            metallic_factor: 0.0,
            roughness_factor: 0.5,
        },
        alpha_mode: (color[3] < 1.0).then_some("BLEND"),
        // Open shells are seen from both sides.
        double_sided: true,
    }
}

/// By how much a placement may lengthen a vector, at most.
fn stretch(placed: &PlacedPart) -> f64 {
    let m = placed.world.matrix3;
    let gram = m.transpose() * m;
    // The largest eigenvalue of the Gram matrix lies under its largest absolute row sum: exact for a scaled
    // rotation.
    let row = |v: DVec3| v.abs().element_sum();
    row(gram.x_axis).max(row(gram.y_axis)).max(row(gram.z_axis)).sqrt()
}

/// The patches with triangles, gathered by colour in the order of their first use; tessellated items stay
/// apart.
fn by_color<'p, 'a>(group: &'p [Patch<'a>]) -> Vec<Vec<&'p Patch<'a>>> {
    let mut order: BTreeMap<Option<ColorKey>, usize> = BTreeMap::new();
    let mut sets: Vec<Vec<&Patch<'_>>> = Vec::new();
    for patch in group.iter().filter(|p| !p.triangles.is_empty()) {
        let set = *order.entry(patch.color.map(color::key)).or_insert_with(|| {
            sets.push(Vec::new());
            sets.len() - 1
        });
        sets[set].push(patch);
    }
    sets
}

/// By face index the elementary surfaces of a primitive's faces; empty where none is known.
fn brep_faces(
    part: &ScenePart,
    patches: &[&Patch<'_>],
    frame: Frame,
    origin: DVec3,
) -> Vec<Option<json::BrepFace>> {
    let mut faces: Vec<Option<json::BrepFace>> = Vec::new();
    if part.face_surfaces.iter().all(Option::is_none) {
        return faces;
    }
    for patch in patches {
        let Source::Face { face, .. } = patch.source else { continue };
        let index = face as usize;
        while faces.len() <= index {
            faces.push(None);
        }
        let surface = part.face_surfaces.get(index).copied().flatten();
        faces[index] = surface.map(|s| surfaces::brep_face(face, &s, frame, origin));
    }
    faces
}

/// The points of a group relative to the mesh's origin.
struct Points {
    exact: Vec<DVec3>,
    rounded: Vec<Vec3>,
}

impl Points {
    /// `mm` turns the rounding from file units back into units of the part.
    fn new(placed: &[Option<DVec3>], origin: DVec3, tally: &mut Tally, mm: f64) -> Self {
        let exact: Vec<_> = placed.iter().map(|p| p.map_or(DVec3::ZERO, |p| p - origin)).collect();
        let rounded = exact.iter().map(|&p| tally.round(p, mm)).collect();
        Self { exact, rounded }
    }
}

/// Gathers a primitive's vertices: one per point and normal.
struct Builder<'p> {
    points: &'p Points,
    vertices: Vec<Vec3>,
    normals: Vec<Vec3>,
    /// Per point its first vertex, per vertex the next one of the same point.
    first: Vec<u32>,
    next: Vec<u32>,
    /// Per corner of the present patch its vertex.
    of_corner: Vec<u32>,
    indices: Vec<u32>,
    face_ids: Vec<u32>,
    with_normals: bool,
}

impl<'p> Builder<'p> {
    fn new(points: &'p Points) -> Self {
        Self {
            points,
            vertices: Vec::new(),
            normals: Vec::new(),
            first: vec![UNUSED; points.exact.len()],
            next: Vec::new(),
            of_corner: Vec::new(),
            indices: Vec::new(),
            face_ids: Vec::new(),
            with_normals: true,
        }
    }

    fn patch(&mut self, patch: &Patch<'_>, frame: Frame, tally: &mut Tally) {
        self.with_normals &= patch.has_normals();
        self.of_corner.clear();
        for &triangle in patch.triangles {
            let points = patch.point_indices(triangle);
            tally.count_triangle(points.map(|p| self.points.rounded[p as usize]));
            for (corner, point) in triangle.into_iter().zip(points) {
                let vertex = self.corner(patch, corner, point, points, frame);
                self.indices.push(vertex);
            }
            if let Source::Face { face, .. } = patch.source {
                self.face_ids.push(face);
            }
        }
    }

    /// The vertex of a corner; a pole without a normal takes that of each triangle, as glTF allows no zero
    /// normal.
    fn corner(&mut self, patch: &Patch<'_>, corner: u32, point: u32, points: [u32; 3], frame: Frame) -> u32 {
        let index = corner as usize;
        if index >= self.of_corner.len() {
            self.of_corner.resize(index + 1, UNUSED);
        }
        if self.of_corner[index] != UNUSED {
            return self.of_corner[index];
        }
        if !self.with_normals {
            return self.vertex(point, Vec3::Z);
        }
        if let Some(normal) = patch.normal(corner).and_then(|n| unit(frame.rotation * n)) {
            self.of_corner[index] = self.vertex(point, normal.as_vec3());
            return self.of_corner[index];
        }
        let normal = triangle_normal(points.map(|p| self.points.exact[p as usize]));
        self.vertex(point, if normal == DVec3::ZERO { Vec3::Z } else { normal.as_vec3() })
    }

    fn vertex(&mut self, point: u32, normal: Vec3) -> u32 {
        let mut vertex = self.first[point as usize];
        while vertex != UNUSED {
            if self.normals[vertex as usize] == normal {
                return vertex;
            }
            vertex = self.next[vertex as usize];
        }
        let vertex = self.vertices.len() as u32;
        self.vertices.push(self.points.rounded[point as usize]);
        self.normals.push(normal);
        self.next.push(self.first[point as usize]);
        self.first[point as usize] = vertex;
        vertex
    }
}
