//! Blocks: definitions, the objects that place them, and the tree of parts that both make.
//!
//! A definition lists the objects that belong to it by their UUIDs; each becomes a part, meshed once. An object
//! of its own kind, in the file or in another block, places a definition.

use super::bytes::{ANONYMOUS, Bytes, Res};
use super::object::{Class, object};
use super::tables::uuid_list;
use crate::assemble::{Notes, PartBuilder, placement};
use chordal_brep::{Node, NodeId, Part, PartId, ReadIssue, Source};
use chordal_nurbs::DAffine3;
use rustc_hash::FxHashMap;

const DEFINITION_RECORD: u32 = 0x2000_8076;

/// More nodes than this are no honest file's.
const MOST_NODES: usize = 200_000;

/// Blocks within blocks, deeper than this, are no honest file's.
const MAX_DEPTH: usize = 64;

/// The identifier of an object or a definition.
pub(super) type Id = [u8; 16];

/// The definition of a block.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Definition {
    pub id: Id,
    pub name: String,
    /// The objects that belong to it.
    pub members: Vec<Id>,
}

/// An object that places a block.
#[derive(Clone, Debug)]
pub(super) struct BlockPlacement {
    pub definition: Id,
    pub transform: DAffine3,
    pub name: String,
    pub source: Source,
}

/// What the file itself or a block holds.
#[derive(Debug, Default)]
pub(super) struct Content {
    pub builder: PartBuilder,
    pub placements: Vec<BlockPlacement>,
}

/// The definitions of their table; records that make no sense are passed over.
pub(super) fn definitions(mut table: Bytes) -> Vec<Definition> {
    let mut found = Vec::new();
    while let Ok(chunk) = table.chunk() {
        if chunk.code == DEFINITION_RECORD {
            found.extend(definition(chunk.body).ok());
        }
    }
    found
}

fn definition(mut record: Bytes) -> Res<Definition> {
    let (class, mut data) = object(&mut record)?;
    if class != Class::InstanceDefinition {
        let found = "entry of the table of blocks".into();
        return Err(ReadIssue::UnknownKind { found, expected: "a block" });
    }
    let mut ahead = data;
    if data.version >= 60 && ahead.u32()? == ANONYMOUS { recent(data.chunk()?.body) } else { old(&mut data) }
}

/// Up to version 5.
fn old(data: &mut Bytes) -> Res<Definition> {
    data.version()?;
    let (id, members) = (data.uuid()?, uuid_list(data)?);
    Ok(Definition { id, name: data.text()?, members })
}

/// Since version 6. A definition that is linked to another file has no list of members.
fn recent(mut data: Bytes) -> Res<Definition> {
    data.take(4 + 4)?;
    let (id, name) = component(data.chunk()?.body)?;
    // Its type, and the unit of a linked file.
    data.i32()?;
    data.chunk()?;
    for _description_and_addresses in 0..3 {
        data.text()?;
    }
    // A box.
    data.take(6 * 8)?;
    let members = if data.u8()? == 1 { uuid_list(&mut data)? } else { Vec::new() };
    Ok(Definition { id, name, members })
}

/// The identifier and name of a component: each of five attributes is there where a byte says 1.
fn component(mut data: Bytes) -> Res<(Id, String)> {
    data.take(4 + 4)?;
    if data.u8()? == 1 {
        data.take(12)?;
    }
    let id = if data.u8()? == 1 { data.uuid()? } else { Id::default() };
    for _type_and_index in 0..2 {
        if data.u8()? == 1 {
            data.i32()?;
        }
    }
    let name = if data.u8()? == 1 { data.text()? } else { String::new() };
    Ok((id, name))
}

/// The definition that an object places, and where.
pub(super) fn reference(mut data: Bytes) -> Res<(Id, DAffine3)> {
    data.version()?;
    let definition = data.uuid()?;
    let mut rows = [[0.0; 4]; 3];
    for entry in rows.iter_mut().flatten() {
        *entry = data.f64()?;
    }
    Ok((definition, placement(rows)?))
}

/// The parts of a file and the tree that places them.
#[derive(Debug, Default)]
pub(super) struct Placed {
    pub parts: Vec<Part>,
    pub nodes: Vec<Node>,
    pub roots: Vec<NodeId>,
}

/// Places the blocks. `contents`: that of the file itself, then that of each definition.
pub(super) fn placed(
    name: &str,
    to_millimetres: DAffine3,
    definitions: &[Definition],
    contents: Vec<Content>,
    notes: &Notes,
) -> Placed {
    let (parts, placements): (Vec<Part>, Vec<_>) =
        contents.into_iter().map(|c| (c.builder.finish(), c.placements)).unzip();
    let index_of = definitions.iter().enumerate().rev().map(|(index, d)| (d.id, index)).collect();
    let ids = vec![None; definitions.len() + 1];
    let placed = Placed::default();
    let mut tree = Tree { definitions, index_of, parts, placements, ids, placed, notes };
    tree.parts[0].name = name.to_owned();
    for (part, definition) in tree.parts[1..].iter_mut().zip(definitions) {
        part.name.clone_from(&definition.name);
    }
    let root = tree.node(name.to_owned(), to_millimetres, 0, Source::default());
    tree.placed.roots.push(root);
    tree.children(root, 0, &mut vec![0]);
    tree.placed
}

struct Tree<'n> {
    definitions: &'n [Definition],
    index_of: FxHashMap<Id, usize>,
    /// By content; taken away where they are placed first.
    parts: Vec<Part>,
    placements: Vec<Vec<BlockPlacement>>,
    /// The parts that are placed already, by content.
    ids: Vec<Option<PartId>>,
    placed: Placed,
    notes: &'n Notes,
}

impl Tree<'_> {
    fn children(&mut self, parent: NodeId, content: usize, path: &mut Vec<usize>) {
        for placement in self.placements[content].clone() {
            if self.placed.nodes.len() >= MOST_NODES {
                let many = ReadIssue::TooMany { what: "placements of blocks", limit: MOST_NODES };
                self.notes.lose(placement.source, many);
                return;
            }
            let Some(&index) = self.index_of.get(&placement.definition) else {
                self.notes.lose(placement.source, ReadIssue::Missing { what: "definition of this block" });
                continue;
            };
            let (block, own) = (&self.definitions[index].name, index + 1);
            if path.contains(&own) || path.len() > MAX_DEPTH {
                self.notes.lose(placement.source, ReadIssue::UsedInItself { node: block.clone() });
                continue;
            }
            let name = if placement.name.is_empty() { block.clone() } else { placement.name };
            let node = self.node(name, placement.transform, own, placement.source);
            self.placed.nodes[parent.index()].children.push(node);
            path.push(own);
            self.children(node, own, path);
            path.pop();
        }
    }

    fn node(&mut self, name: String, transform: DAffine3, content: usize, source: Source) -> NodeId {
        let id = NodeId::from(self.placed.nodes.len());
        let part = self.part(content);
        self.placed.nodes.push(Node { name, transform, part, children: Vec::new(), color: None, source });
        id
    }

    /// The part of a content, where it holds anything but placements.
    fn part(&mut self, content: usize) -> Option<PartId> {
        if self.ids[content].is_none() && !is_empty(&self.parts[content]) {
            self.ids[content] = Some(PartId::from(self.placed.parts.len()));
            self.placed.parts.push(std::mem::take(&mut self.parts[content]));
        }
        self.ids[content]
    }
}

fn is_empty(part: &Part) -> bool {
    part.faces.is_empty() && part.tessellated.is_empty() && part.loose.is_empty()
}
