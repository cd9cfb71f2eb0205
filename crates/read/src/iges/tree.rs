//! What the file is about: entities that no other uses, gathered into parts; subfigures (308) placed by their
//! instances (408); groups (402) as bodies.

use super::builder::Builder;
use super::curves::is_curve;
use super::document::{Doc, Ix, Res};
use super::looks;
use super::matrix;
use super::surfaces::is_surface;
use chordal_brep::{
    Body, BodyKind, FaceId, LooseItem, LooseKind, Node, NodeId, Part, PartId, ReadIssue, Real, Shell,
    ShellId, Source,
};
use chordal_nurbs::{DAffine3, DVec3};
use rustc_hash::{FxHashMap, FxHashSet};

/// The parts of a file and the tree that places them.
#[derive(Debug, Default)]
pub(crate) struct Placed {
    pub parts: Vec<Part>,
    pub nodes: Vec<Node>,
    pub roots: Vec<NodeId>,
}

/// The number of nodes after which the tree is not followed: no exporter's file has more.
const MOST_NODES: usize = 200_000;

/// Subfigures within subfigures, deeper than this, refer in a circle.
const MAX_DEPTH: u32 = 64;

/// What is made of a list of entities: a part, and instances.
#[derive(Clone, Debug, Default)]
struct Content {
    part: Option<PartId>,
    instances: Vec<Ix>,
}

struct Tree<'d, 'a> {
    doc: &'d Doc<'a>,
    placed: Placed,
    /// Groups by member.
    groups: FxHashMap<Ix, Ix>,
    /// By subfigure definition.
    known: FxHashMap<Ix, Content>,
    /// By instance.
    read: FxHashMap<Ix, Res<(String, DAffine3, Content)>>,
    too_many: bool,
}

/// Builds all parts.
pub(crate) fn build(doc: &Doc<'_>, name: &str) -> Placed {
    let used = used(doc);
    let mut tree = Tree {
        doc,
        placed: Placed::default(),
        groups: groups(doc),
        known: FxHashMap::default(),
        read: FxHashMap::default(),
        too_many: false,
    };
    let top: Vec<Ix> = (0..doc.entries.len()).filter(|ix| !used.contains(ix)).collect();
    let product = &doc.global.product;
    let part_name = if product.is_empty() { name } else { product };
    let content = tree.content(&top, part_name);
    if content.part.is_some() || !content.instances.is_empty() {
        let scale = DAffine3::from_scale(DVec3::splat(doc.global.length_mm));
        let root = tree.node(name.to_owned(), scale, content.part, Source::default());
        tree.placed.roots.push(root);
        tree.instances(root, &content.instances, 0);
    }
    tree.placed
}

/// Everything that others are made of.
fn used(doc: &Doc<'_>) -> FxHashSet<Ix> {
    let mut used = FxHashSet::default();
    for ix in 0..doc.entries.len() {
        if let Ok(list) = references(doc, ix) {
            used.extend(list);
        }
    }
    used
}

/// The entities that an entity refers to; of a broken entity, those that can be read.
fn references(doc: &Doc<'_>, ix: Ix) -> Res<Vec<Ix>> {
    let kind = doc.kind(ix);
    let is_known = matches!(kind, 102 | 108 | 118 | 120 | 122 | 130 | 140..=144 | 186 | 190..=198 | 308)
        || matches!(kind, 504 | 508 | 510 | 514);
    if !is_known {
        return Ok(Vec::new());
    }
    let mut args = doc.open(ix)?;
    let mut found = Vec::new();
    // `-` is a parameter that is no reference, `+` a reference, and `n` the number of repetitions of the
    // letters that follow.
    let (head, rounds) = match kind {
        102 => ("n", "+"),
        108 => ("----+", ""),
        118 | 120 => ("++", ""),
        122 | 130 => ("+", ""),
        140 => ("----+", ""),
        142 => ("-+++", ""),
        143 => ("-+n", "+"),
        144 => ("+-n+", "+"),
        186 => ("+-n", "+-"),
        190 => ("+++", ""),
        192 => ("++-+", ""),
        194 | 198 => ("++--+", ""),
        196 => ("+-++", ""),
        308 => ("--n", "+"),
        504 => ("n", "++-+-"),
        510 => ("+n-", "+"),
        514 => ("n", "+-"),
        _ => return nested_references(doc, ix),
    };
    let mut count = 0;
    let mut take = |letter: char, count: &mut usize| -> Res<()> {
        match letter {
            '+' => found.extend(args.optional_reference().ok().flatten()),
            'n' => *count = args.count()?,
            _ => args.skip(1),
        }
        Ok(())
    };
    for letter in head.chars() {
        take(letter, &mut count)?;
    }
    for _ in 0..count {
        for letter in rounds.chars() {
            take(letter, &mut 0)?;
        }
    }
    Ok(found)
}

/// Lists within lists: boundaries (141) and loops (508).
fn nested_references(doc: &Doc<'_>, ix: Ix) -> Res<Vec<Ix>> {
    let mut args = doc.open(ix)?;
    let mut found = Vec::new();
    let is_loop = doc.kind(ix) == 508;
    if !is_loop {
        args.skip(2);
        found.extend(args.optional_reference()?);
    }
    for _ in 0..args.count()? {
        args.skip(usize::from(is_loop));
        found.extend(args.optional_reference()?);
        args.skip(if is_loop { 2 } else { 1 });
        for _ in 0..args.count()? {
            args.skip(usize::from(is_loop));
            found.extend(args.optional_reference()?);
        }
    }
    Ok(found)
}

/// The group of each member of a group.
fn groups(doc: &Doc<'_>) -> FxHashMap<Ix, Ix> {
    let mut groups = FxHashMap::default();
    for ix in 0..doc.entries.len() {
        if doc.kind(ix) != 402 || !matches!(doc.entry(ix).form, 1 | 7 | 14 | 15) {
            continue;
        }
        let Ok(mut args) = doc.open(ix) else { continue };
        for _ in 0..args.count().unwrap_or(0) {
            if let Ok(Some(member)) = args.optional_reference() {
                groups.entry(member).or_insert(ix);
            }
        }
    }
    groups
}

impl Tree<'_, '_> {
    fn node(&mut self, name: String, transform: DAffine3, part: Option<PartId>, source: Source) -> NodeId {
        let id = NodeId::from(self.placed.nodes.len());
        self.placed.nodes.push(Node { name, transform, part, children: Vec::new(), color: None, source });
        id
    }

    /// The part that a list of entities makes, and the instances among them.
    fn content(&mut self, list: &[Ix], name: &str) -> Content {
        let mut builder = Builder::new(self.doc, name.to_owned());
        let mut instances = Vec::new();
        // Faces by group, in the order of their first face.
        let mut sets: Vec<(Option<Ix>, Vec<FaceId>)> = Vec::new();
        for &ix in list {
            if self.doc.kind(ix) == 408 {
                instances.push(ix);
                continue;
            }
            let faces = builder.item(ix);
            if faces.is_empty() {
                continue;
            }
            let group = self.groups.get(&ix).copied();
            match sets.iter_mut().find(|set| set.0 == group) {
                Some(set) => set.1.extend(faces),
                None => sets.push((group, faces)),
            }
        }
        for (group, faces) in sets {
            builder.face_set(group, faces);
        }
        let part = builder.build.finish();
        if part.faces.is_empty() && part.loose.is_empty() {
            return Content { part: None, instances };
        }
        self.placed.parts.push(part);
        Content { part: Some(PartId::from(self.placed.parts.len() - 1)), instances }
    }

    /// Adds the nodes of instances below a node.
    fn instances(&mut self, parent: NodeId, list: &[Ix], depth: u32) {
        for &ix in list {
            if self.placed.nodes.len() >= MOST_NODES || depth > MAX_DEPTH {
                if !std::mem::replace(&mut self.too_many, true) {
                    self.doc.lose(ix, ReadIssue::AssemblyTooLarge { nodes: MOST_NODES });
                }
                return;
            }
            match self.instance(ix) {
                Ok((name, transform, content)) => {
                    let node = self.node(name, transform, content.part, self.doc.source(ix));
                    self.placed.nodes[parent.index()].children.push(node);
                    self.instances(node, &content.instances, depth + 1);
                }
                Err(bad) => self.doc.lose_bad(&bad),
            }
        }
    }

    /// Name, placement and content of an instance; read once, however often its subfigure is placed.
    fn instance(&mut self, ix: Ix) -> Res<(String, DAffine3, Content)> {
        if let Some(known) = self.read.get(&ix) {
            return known.clone();
        }
        let made = self.read_instance(ix);
        self.read.insert(ix, made.clone());
        made
    }

    /// 408: subfigure, translation, scale.
    fn read_instance(&mut self, ix: Ix) -> Res<(String, DAffine3, Content)> {
        let mut args = self.doc.open(ix)?;
        let (definition, shift) = (args.reference()?, args.point()?);
        let scale = args.optional_real().unwrap_or(1.0);
        if scale == 0.0 {
            return Err(self.doc.bad(ix, ReadIssue::BadValue { what: "scale", value: Real(0.0) }));
        }
        if self.doc.kind(definition) != 308 {
            return Err(self.doc.unknown(definition, "a subfigure definition"));
        }
        let (name, content) = self.definition(definition)?;
        let local =
            DAffine3::from_scale_rotation_translation(DVec3::splat(scale), glam::DQuat::IDENTITY, shift);
        let stated = looks::name(self.doc, ix);
        let name = if stated.is_empty() { name } else { stated };
        Ok((name, matrix::of_entity(self.doc, ix)? * local, content))
    }

    /// 308: depth, name, members; built once.
    fn definition(&mut self, ix: Ix) -> Res<(String, Content)> {
        let mut args = self.doc.open(ix)?;
        args.skip(1);
        let name = args.string();
        if let Some(known) = self.known.get(&ix) {
            return Ok((name, known.clone()));
        }
        let count = args.count()?;
        let members = (0..count).map(|_| args.reference()).collect::<Res<Vec<Ix>>>()?;
        let content = self.content(&members, &name);
        self.known.insert(ix, content.clone());
        Ok((name, content))
    }
}

impl Builder<'_, '_> {
    /// Adds what an entity is; faces that belong to no shell are handed back.
    fn item(&mut self, ix: Ix) -> Vec<FaceId> {
        let entry = self.doc.entry(ix);
        let (kind, form) = (entry.kind, entry.form);
        // Physically dependent on something else, or the curve of a parameter space.
        let dependent = matches!(entry.status[1], 1 | 3) || entry.status[2] == 5;
        match kind {
            186 => {
                if let Err(bad) = self.solid(ix) {
                    self.doc.lose_bad(&bad);
                }
            }
            514 => {
                if let Err(bad) = self.sheet(ix) {
                    self.doc.lose_bad(&bad);
                }
            }
            510 => return vec![self.lone_face(ix)],
            143 | 144 => return self.faces(ix),
            108 if form != 1 => self.doc.warn(ix, ReadIssue::SurfaceIgnored),
            190 | 192 | 194 => self.doc.warn(ix, ReadIssue::SurfaceIgnored),
            kind if is_surface(kind) && !dependent => return self.faces(ix),
            116 if !dependent => self.loose(ix, LooseKind::Point),
            106 if matches!(form, 1..=3) && !dependent => self.loose(ix, LooseKind::Point),
            kind if is_curve(kind, form) && !dependent => self.loose(ix, LooseKind::Wire),
            150..=184 | 430 => {
                let what = format!("a solid of {}", self.doc.word(ix)).into();
                self.doc.lose(ix, ReadIssue::Unsupported { what })
            }
            416 => self.doc.lose(ix, ReadIssue::OtherFile { name: String::new() }),
            _ => {}
        }
        Vec::new()
    }

    fn loose(&mut self, ix: Ix, kind: LooseKind) {
        let name = looks::name(self.doc, ix);
        self.build.part.loose.push(LooseItem { kind, name, source: self.doc.source(ix) });
    }

    /// One body for the faces of a group, or for those of none.
    fn face_set(&mut self, group: Option<Ix>, faces: Vec<FaceId>) {
        let look = group.map(|group| self.look(group)).unwrap_or_default();
        let shell = ShellId::from(self.build.part.shells.len());
        self.build.part.shells.push(Shell { faces, closed: false, source: look.source });
        self.build.part.bodies.push(Body {
            kind: BodyKind::FaceSet,
            shells: vec![shell],
            name: look.name,
            color: look.color,
            layer: look.layer,
            source: look.source,
        });
    }
}
