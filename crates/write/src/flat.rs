//! A scene as a list of placed patches, for formats without a tree.

use crate::frame::{Frame, Place};
use crate::names::{Unique, placed_name};
use crate::summary::finite;
use crate::{WriteError, WriteOptions};
use chordal_mesh::{Corner, FaceMesh, PassThrough, Rgba, Scene, ScenePart};
use glam::DVec3;

/// One placed part.
#[derive(Debug)]
pub(crate) struct Item<'a> {
    /// Unique among the items.
    pub name: String,
    pub part_index: usize,
    pub part: &'a ScenePart,
    pub place: Place,
    /// Overrides the colours of the part.
    pub color: Option<Rgba>,
    /// How many faces the items before it have.
    pub first_face: u64,
}

/// Triangles that share points, a colour and, unless they came with the file, a face.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Patch<'a> {
    pub points: &'a [DVec3],
    pub source: Source<'a>,
    pub triangles: &'a [[u32; 3]],
    /// The first `2 · quads` triangles are halves of quadrilaterals.
    pub quads: u32,
    pub name: &'a str,
    pub color: Option<Rgba>,
}

/// Where a patch's triangles came from, and what their indices mean.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Source<'a> {
    /// Triangles index `corners`.
    Face { corners: &'a [Corner], face: u32, body: Option<u32> },
    /// Triangles index the points; there are as many normals as points, or none.
    PassThrough { normals: &'a [DVec3] },
}

/// A polygon of a patch: which of all corners of its triangles (three times the triangle's index, and its
/// own) are its own.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Polygon {
    slots: [usize; 4],
    len: usize,
}

impl Polygon {
    pub fn slots(&self) -> &[usize] {
        &self.slots[..self.len]
    }
}

impl Patch<'_> {
    /// The quadrilaterals, then the triangles that are no half of one.
    pub fn polygons(&self) -> impl Iterator<Item = Polygon> + '_ {
        let triangle = |t: usize| Polygon { slots: [3 * t, 3 * t + 1, 3 * t + 2, 0], len: 3 };
        let halves = self.triangles[..2 * self.quads as usize].chunks_exact(2).enumerate();
        let quads = halves.flat_map(move |(q, pair)| match FaceMesh::quad_of(pair[0], pair[1]) {
            Some(quad) => [Some(Polygon { slots: quad.map(|(t, i)| 3 * (2 * q + t) + i), len: 4 }), None],
            None => [Some(triangle(2 * q)), Some(triangle(2 * q + 1))],
        });
        quads.flatten().chain((2 * self.quads as usize..self.triangles.len()).map(triangle))
    }

    /// The points' indices of a polygon's corners.
    pub fn polygon_points(&self, polygon: &Polygon) -> impl Iterator<Item = u32> + use<'_> {
        let slots = polygon.slots;
        (0..polygon.len).map(move |i| self.point_indices(self.triangles[slots[i] / 3])[slots[i] % 3])
    }

    /// The points' indices of a triangle's corners.
    pub fn point_indices(&self, triangle: [u32; 3]) -> [u32; 3] {
        match self.source {
            Source::Face { corners, .. } => triangle.map(|c| corners[c as usize].position),
            Source::PassThrough { .. } => triangle,
        }
    }

    /// Whether [`Patch::normal`] has normals.
    pub fn has_normals(&self) -> bool {
        !matches!(self.source, Source::PassThrough { normals: [] })
    }

    /// The exact normal at a corner, if the patch has it.
    pub fn normal(&self, corner: u32) -> Option<DVec3> {
        match self.source {
            Source::Face { corners, .. } => Some(corners[corner as usize].normal),
            Source::PassThrough { normals } => normals.get(corner as usize).copied(),
        }
    }
}

/// Every placed part in the order of the tree.
pub(crate) fn items<'a>(scene: &'a Scene, options: &WriteOptions) -> Vec<Item<'a>> {
    let frame = Frame::new(options);
    let mut unique = Unique::default();
    let mut first_face = 0;
    let item = |placed: chordal_mesh::PlacedPart| {
        let part = &scene.parts[placed.part];
        let name = unique.name(&placed_name(scene, &scene.nodes[placed.node], placed.part));
        let place = Place::new(placed.world, frame);
        let item = Item { name, part_index: placed.part, part, place, color: placed.color, first_face };
        first_face += part.mesh.faces.len() as u64;
        item
    };
    scene.placements().into_iter().map(item).collect()
}

/// The patches of the exact faces, in their order; `color` overrides theirs.
pub(crate) fn face_patches(part: &ScenePart, color: Option<Rgba>) -> impl Iterator<Item = Patch<'_>> {
    part.mesh.faces.iter().map(move |face| {
        let index = face.face as usize;
        Patch {
            points: &part.mesh.positions,
            source: Source::Face {
                corners: &face.corners,
                face: face.face,
                body: part.face_bodies.get(index).copied(),
            },
            triangles: &face.triangles,
            quads: face.quads,
            name: part.face_names.get(index).map_or("", String::as_str),
            color: color.or(part.face_colors.get(index).copied().flatten()),
        }
    })
}

/// What came tessellated; `color` overrides its own.
pub(crate) fn pass_patch(item: &PassThrough, color: Option<Rgba>) -> Patch<'_> {
    let complete = item.normals.len() == item.points.len();
    Patch {
        points: &item.points,
        source: Source::PassThrough { normals: if complete { &item.normals } else { &[] } },
        triangles: &item.triangles,
        quads: 0,
        name: &item.name,
        color: color.or(item.color),
    }
}

impl<'a> Item<'a> {
    /// The patches in groups that share their points: the exact faces, then each item that came tessellated.
    pub fn groups(&self) -> Vec<Vec<Patch<'a>>> {
        groups(self.part, self.color)
    }

    /// All of a group's points in file coordinates, into a buffer that is used again.
    pub fn place_points(
        &self,
        points: &[DVec3],
        remap: Option<&Remap>,
        placed: &mut Vec<DVec3>,
        options: &WriteOptions,
    ) -> Result<(), WriteError> {
        placed.clear();
        placed.reserve(points.len());
        for (index, &p) in points.iter().enumerate() {
            let used = remap.is_none_or(|r| r.new_index[index] != UNUSED);
            placed.push(if used { finite(self.place.point(p), &self.name, options)? } else { p });
        }
        Ok(())
    }
}

/// A part's patches in groups that share their points.
pub(crate) fn groups(part: &ScenePart, color: Option<Rgba>) -> Vec<Vec<Patch<'_>>> {
    let mut groups = vec![face_patches(part, color).collect()];
    groups.extend(part.pass_through.iter().map(|item| vec![pass_patch(item, color)]));
    groups
}

/// Marks a point that no triangle uses.
pub(crate) const UNUSED: u32 = u32::MAX;

/// The points that triangles use, numbered anew in their order.
#[derive(Debug)]
pub(crate) struct Remap {
    /// Per point its new index, or [`UNUSED`].
    pub new_index: Vec<u32>,
    pub used: u32,
}

impl Remap {
    pub fn new(group: &[Patch<'_>]) -> Self {
        let points = group.first().map_or(0, |p| p.points.len());
        let mut new_index = vec![UNUSED; points];
        for patch in group {
            for &triangle in patch.triangles {
                for p in patch.point_indices(triangle) {
                    new_index[p as usize] = 0;
                }
            }
        }
        let mut used = 0;
        for index in new_index.iter_mut().filter(|i| **i == 0) {
            *index = used;
            used += 1;
        }
        Self { new_index, used }
    }
}

/// The remaps of every part's groups, each made once however often the part is placed.
pub(crate) fn remaps(scene: &Scene, items: &[Item<'_>]) -> Vec<Vec<Remap>> {
    let mut placed = vec![false; scene.parts.len()];
    items.iter().for_each(|i| placed[i.part_index] = true);
    let part_remaps = |(part, placed): (&ScenePart, bool)| {
        if placed { groups(part, None).iter().map(|g| Remap::new(g)).collect() } else { Vec::new() }
    };
    scene.parts.iter().zip(placed).map(part_remaps).collect()
}
