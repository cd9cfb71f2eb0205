//! The tables of an archive, and its objects in their order.

use super::blocks::{BlockPlacement, Content, Definition, Id, Placed, definitions, placed, reference};
use super::bytes::{Bytes, Chunk, Res};
use super::object::{Class, object};
use super::surfaces::{RhinoSurface, surface};
use super::tables::{Attributes, Layer, attributes, layers, units};
use super::{MAGIC, brep, build, curves, extrusion, legacy, mesh};
use crate::assemble::Notes;
use crate::flat::LengthUnit;
use crate::trimmed::{Look, Piece, Role, TrimLoop, add_body, add_faces, add_failed};
use chordal_brep::{BodyKind, Issue, LooseItem, LooseKind, ReadIssue, Source};
use chordal_nurbs::{DAffine3, DVec2, DVec3};
use rustc_hash::FxHashMap;
use std::sync::Arc;

const PROPERTIES: u32 = 0x1000_0014;
const SETTINGS: u32 = 0x1000_0015;
const LAYERS: u32 = 0x1000_0011;
const OBJECTS: u32 = 0x1000_0013;
const BLOCKS: u32 = 0x1000_0021;
const OPENNURBS_VERSION: u32 = 0xa000_0026;
const OBJECT_RECORD: u32 = 0x2000_8070;
const OBJECT_ATTRIBUTES: u32 = 0x0200_8072;
const OBJECT_TYPE: u32 = 0x8200_0071;
const END_OF_FILE: u32 = 0x0000_7fff;
const END_OF_TABLE: u32 = 0xffff_ffff;

/// A file's parts, its unit, and what was noted on the way.
pub(super) struct Read {
    pub placed: Placed,
    pub unit: LengthUnit,
    /// How many objects there are.
    pub objects: usize,
    pub issues: Vec<Issue>,
}

/// What is known of the archive so far.
struct Reader<'a> {
    whole: &'a [u8],
    /// What the file itself holds, then what each block does.
    contents: Vec<Content>,
    /// The content that the object at hand belongs to.
    at: usize,
    definitions: Vec<Definition>,
    /// The content that objects belong to which define blocks.
    member_of: FxHashMap<Id, usize>,
    notes: Notes,
    unit: LengthUnit,
    /// The absolute tolerance.
    uncertainty: Option<f64>,
    layers: Vec<Layer>,
    opennurbs: u32,
    objects: usize,
    subdivision_surfaces: usize,
    /// Texts, dimensions, lights, hatches.
    annotations: usize,
}

pub(super) fn read(whole: &[u8], version: u32, name: &str) -> Read {
    let mut reader = Reader {
        whole,
        contents: vec![Content::default()],
        at: 0,
        definitions: Vec::new(),
        member_of: FxHashMap::default(),
        notes: Notes::default(),
        unit: LengthUnit::unstated(),
        uncertainty: None,
        layers: Vec::new(),
        opennurbs: 0,
        objects: 0,
        subdivision_surfaces: 0,
        annotations: 0,
    };
    let file = Bytes::new(&whole[MAGIC.len() + 8..], version);
    if version == 1 {
        reader.unit = legacy::read(file, whole, &mut reader.contents[0].builder.part, &reader.notes);
    } else {
        reader.tables(file);
    }
    reader.note_ignored();
    let Reader { mut contents, definitions, unit, uncertainty, objects, notes, .. } = reader;
    if uncertainty.is_some() {
        contents.iter_mut().for_each(|content| content.builder.part.uncertainty = uncertainty);
    }
    let scale = DAffine3::from_scale(DVec3::splat(unit.millimetres));
    let placed = placed(name, scale, &definitions, contents, &notes);
    Read { placed, unit, objects, issues: notes.take() }
}

impl<'a> Reader<'a> {
    /// Names what is not read, one line for each kind.
    fn note_ignored(&self) {
        if self.subdivision_surfaces > 0 {
            let what = "subdivision surfaces (SubD)";
            let lost = ReadIssue::ObjectsIgnored { objects: self.subdivision_surfaces, what };
            self.notes.lose(Source::default(), lost);
        }
        if self.annotations > 0 {
            let what = "annotations, hatches, lights and other objects without exact shape";
            let ignored = ReadIssue::ObjectsIgnored { objects: self.annotations, what };
            self.notes.warn(Source::default(), ignored);
        }
    }

    fn tables(&mut self, mut file: Bytes<'a>) {
        while !file.is_empty() {
            let source = self.source(&file);
            let before = file;
            match file.chunk() {
                Ok(chunk) if chunk.code == END_OF_FILE => return,
                Ok(chunk) => self.table(chunk),
                Err(why) => {
                    // Its last table may be cut off: the objects before the cut can be saved.
                    let cut = cut_table(before);
                    self.notes.lose(source, ReadIssue::Damaged { what: "the archive", cause: why.boxed() });
                    if let Some(table) = cut {
                        self.table(table);
                    }
                    return;
                }
            }
        }
    }

    fn table(&mut self, table: Chunk<'a>) {
        let mut body = table.body;
        match table.code {
            PROPERTIES => {
                while let Ok(chunk) = body.chunk() {
                    if chunk.code == OPENNURBS_VERSION {
                        self.opennurbs = chunk.value as u32;
                    }
                }
            }
            SETTINGS => {
                if let Some((unit, tolerance)) = units(body) {
                    self.unit = unit;
                    self.uncertainty = Some(tolerance).filter(|t| t.is_finite() && *t > 0.0);
                }
            }
            LAYERS => self.layers = layers(body),
            BLOCKS => self.blocks(body),
            OBJECTS => self.objects(body),
            _ => {}
        }
    }

    fn blocks(&mut self, table: Bytes<'a>) {
        for definition in definitions(table) {
            let content = self.contents.len();
            self.contents.push(Content::default());
            self.member_of.extend(definition.members.iter().map(|&id| (id, content)));
            self.definitions.push(definition);
        }
    }

    fn objects(&mut self, mut table: Bytes<'a>) {
        while !table.is_empty() {
            let source = self.source(&table);
            match table.chunk() {
                Ok(chunk) if chunk.code == OBJECT_RECORD => self.object(chunk.body, source),
                Ok(chunk) if chunk.code == END_OF_TABLE => return,
                Ok(_) => {}
                Err(why) => {
                    self.notes.lose(
                        source,
                        ReadIssue::Damaged { what: "the table of objects", cause: why.boxed() },
                    );
                    return;
                }
            }
        }
    }

    fn object(&mut self, mut record: Bytes<'a>, source: Source) {
        self.objects += 1;
        let mut kind = None;
        let mut shape: Res<(Class, Bytes)> = Err(ReadIssue::Missing { what: "geometry" });
        let mut found = Attributes::default();
        while !record.is_empty() {
            let mut ahead = record;
            match ahead.chunk() {
                Ok(chunk) if chunk.code == OBJECT_TYPE => kind = Some(chunk.value),
                Ok(chunk) if chunk.code == OBJECT_ATTRIBUTES => {
                    found = attributes(chunk.body).unwrap_or_default();
                }
                Ok(_) if shape.is_err() && kind.is_some() => shape = object(&mut record),
                Ok(_) => {}
                Err(_) => break,
            }
            record = ahead;
        }
        // A member of a definition that is not in the file is nowhere.
        match self.member_of.get(&found.id) {
            Some(&content) if found.in_block => self.at = content,
            _ if found.in_block => return,
            _ => self.at = 0,
        }
        let look = self.look(found, source);
        match shape {
            Ok((class, data)) => self.shape(class, data, &look),
            Err(why) => {
                self.notes.lose(source, ReadIssue::Ignored { what: "object".into(), cause: why.boxed() })
            }
        }
    }

    fn look(&self, found: Attributes, source: Source) -> Look {
        let layer = self.layers.iter().find(|layer| layer.index == found.layer);
        Look {
            name: found.name,
            // A layer's colour is that of its wires, black by default: it is not the colour of surfaces.
            color: found.color,
            layer: layer.map(|layer| layer.name.clone()).filter(|name| !name.is_empty()),
            flipped: false,
            source,
        }
    }

    fn shape(&mut self, class: Class, data: Bytes, look: &Look) {
        match class {
            Class::Brep => match brep::read(data, self.opennurbs) {
                Ok(raw) => build::add(
                    &mut self.contents[self.at].builder,
                    &raw,
                    look,
                    &self.notes,
                    self.unit.millimetres,
                ),
                Err(why) => _ = add_failed(&mut self.contents[self.at].builder.part, why, look),
            },
            class if class.is_surface() => self.bare_surface(surface(class, data), look),
            class if class.is_curve() => {
                if let Err(why) = curves::curve(class, data) {
                    self.notes
                        .warn(look.source, ReadIssue::Ignored { what: "curve".into(), cause: why.boxed() });
                }
                self.loose(LooseKind::Wire, look);
            }
            Class::Point | Class::PointCloud => self.loose(LooseKind::Point, look),
            Class::InstanceRef => match reference(data) {
                Ok((definition, transform)) => {
                    let (name, source) = (look.name.clone(), look.source);
                    let placement = BlockPlacement { definition, transform, name, source };
                    self.contents[self.at].placements.push(placement);
                }
                Err(why) => self.notes.lose(
                    look.source,
                    ReadIssue::Ignored { what: "placement of a block".into(), cause: why.boxed() },
                ),
            },
            Class::Mesh => match mesh::mesh(data, look) {
                Ok(item) => self.contents[self.at].builder.part.tessellated.push(item),
                Err(why) => self
                    .notes
                    .lose(look.source, ReadIssue::Ignored { what: "mesh".into(), cause: why.boxed() }),
            },
            Class::Extrusion => {
                if let Err(why) = extrusion::add(&mut self.contents[self.at].builder, data, look) {
                    add_failed(&mut self.contents[self.at].builder.part, why, look);
                }
            }
            Class::SubD => self.subdivision_surfaces += 1,
            _ => self.annotations += 1,
        }
    }

    /// A surface without trims is bounded by its own domain.
    fn bare_surface(&mut self, found: Res<RhinoSurface>, look: &Look) {
        let part = &mut self.contents[self.at].builder.part;
        match found {
            Ok(found) => {
                let surface = Arc::new(found.surface.clone());
                let trims =
                    if surface.domain().is_finite() { Vec::new() } else { vec![border(&found, look.source)] };
                let faces = add_faces(part, &surface, &trims, look, &self.notes);
                add_body(part, faces, BodyKind::Sheet, look);
            }
            Err(why) => _ = add_failed(part, why, look),
        }
    }

    fn loose(&mut self, kind: LooseKind, look: &Look) {
        self.contents[self.at].builder.part.loose.push(LooseItem {
            kind,
            name: look.name.clone(),
            source: look.source,
        });
    }

    /// The place in the file, in bytes.
    fn source(&self, at: &Bytes) -> Source {
        Source { entity: at.place_in(self.whole), line: 0 }
    }
}

/// The border of a surface's domain as a loop.
fn border(found: &RhinoSurface, source: Source) -> TrimLoop {
    let (min, max) = (found.domain.min, found.domain.max);
    let corners = [min, DVec2::new(max.x, min.y), max, DVec2::new(min.x, max.y)].map(|p| found.parameters(p));
    let pieces = (0..4).map(|k| Piece::line(corners[k], corners[(k + 1) % 4])).collect();
    TrimLoop { pieces, role: Role::Outer, source }
}

/// What is there of a table that the file ends in.
fn cut_table(mut file: Bytes) -> Option<Chunk> {
    let code = file.u32().ok()?;
    file.take(if file.version >= 50 { 8 } else { 4 }).ok()?;
    Some(Chunk { code, value: 0, body: file })
}
