//! The assembly tree: products and mapped items unfolded into nodes, representations turned into parts.

mod orphans;

use super::builder::Builder;
use super::document::{Doc, Ix, Res};
use super::keyword::Kw;
use super::products::{Products, Relation, Usage};
use super::representation::{Representation, is_shape};
use super::styles::Styles;
use super::transforms::{self, Side};
use super::units::Units;
use chordal_brep::{Color, Issue, Node, NodeId, Part, PartId, ReadIssue, Source};
use chordal_nurbs::{DAffine3, DVec3};
use rustc_hash::{FxHashMap, FxHashSet};
use std::rc::Rc;

/// A tree that unfolds to more nodes than this is cut off.
const MAX_NODES: usize = 1_000_000;
/// Assemblies nest a few dozen levels at most.
const MAX_DEPTH: u32 = 256;

/// A representation as the tree needs it, read once.
#[derive(Debug)]
struct Shape {
    name: String,
    /// Items other than mapped ones.
    items: Vec<Ix>,
    mapped: Vec<Ix>,
    context: Option<Ix>,
    /// Millimetres per unit; of the place of use where there is no context.
    mm: Option<f64>,
}

/// A product as the tree needs it, read once.
#[derive(Debug)]
struct Product {
    name: String,
    /// Its representations with their transformations to the first one.
    shapes: Vec<(Ix, DAffine3)>,
    mm: Option<f64>,
}

/// A mapped item: what it copies, where to.
#[derive(Debug)]
struct Copy {
    name: String,
    shape: Ix,
    transform: DAffine3,
    mm: f64,
}

/// Parts and nodes under construction.
#[derive(Debug)]
pub(crate) struct Tree<'d> {
    doc: &'d Doc<'d>,
    styles: &'d Styles,
    products: &'d Products,
    pub parts: Vec<Part>,
    pub nodes: Vec<Node>,
    pub roots: Vec<NodeId>,
    /// The unit of the first context read.
    pub unit: Option<String>,
    units: FxHashMap<Ix, Units>,
    /// The part of a representation; none where it holds no geometry of its own.
    part_of: FxHashMap<Ix, Option<PartId>>,
    shapes: FxHashMap<Ix, Option<Rc<Shape>>>,
    known_products: FxHashMap<Ix, Rc<Product>>,
    /// By mapped item; none where it is broken.
    copies: FxHashMap<Ix, Option<Rc<Copy>>>,
    /// Transformations of usages.
    usages: FxHashMap<Ix, DAffine3>,
    /// Representations that the tree has reached.
    reached: FxHashSet<Ix>,
    /// Products and representations between the root and here.
    path: Vec<Ix>,
    cut_off: bool,
}

impl<'d> Tree<'d> {
    pub(crate) fn new(doc: &'d Doc<'d>, styles: &'d Styles, products: &'d Products) -> Self {
        Self {
            doc,
            styles,
            products,
            parts: Vec::new(),
            nodes: Vec::new(),
            roots: Vec::new(),
            unit: None,
            units: FxHashMap::default(),
            part_of: FxHashMap::default(),
            shapes: FxHashMap::default(),
            known_products: FxHashMap::default(),
            copies: FxHashMap::default(),
            usages: FxHashMap::default(),
            reached: FxHashSet::default(),
            path: Vec::new(),
            cut_off: false,
        }
    }

    /// Unfolds everything: products, then representations that no product leads to, then bodies without
    /// either.
    pub(crate) fn unfold(&mut self) {
        let tops: Vec<Ix> =
            self.products.definitions.iter().copied().filter(|pd| !self.products.used.contains(pd)).collect();
        for &top in &tops {
            self.root_product(top);
        }
        if self.roots.is_empty()
            && let Some(&first) = self.products.definitions.first()
        {
            if tops.is_empty() {
                self.doc.warn(first, ReadIssue::NoTopProduct);
            }
            self.root_product(first);
        }
        self.orphans(false);
        if self.roots.is_empty() {
            self.orphans(true);
        }
        if self.roots.is_empty() {
            self.bodies_alone();
        }
    }

    fn root_product(&mut self, definition: Ix) {
        let Some(id) = self.product(definition, 1.0) else { return };
        let empty = {
            let node = &self.nodes[id.index()];
            node.part.is_none() && node.children.is_empty()
        };
        if empty {
            // A product without a shape (a document, a category) is no root.
            if id.index() + 1 == self.nodes.len() {
                self.nodes.pop();
            }
            return;
        }
        let mm = self.product_info(definition).mm.unwrap_or(1.0);
        let scale = DAffine3::from_scale(DVec3::splat(mm));
        self.nodes[id.index()].transform = scale;
        self.roots.push(id);
    }

    fn units_of(&mut self, context: Option<Ix>) -> Units {
        let Some(context) = context else { return Units::default() };
        if let Some(known) = self.units.get(&context) {
            return known.clone();
        }
        let units = Units::of_context(self.doc, context);
        self.unit.get_or_insert_with(|| units.name.clone());
        self.units.insert(context, units.clone());
        units
    }

    /// A representation, read once; none where it cannot be read.
    fn shape(&mut self, rep: Ix) -> Option<Rc<Shape>> {
        if let Some(known) = self.shapes.get(&rep) {
            return known.clone();
        }
        let shape = match Representation::read(self.doc, rep) {
            Ok(Representation { name, items, context }) => {
                let (mapped, items) = items.into_iter().partition(|&item| is_mapped(self.doc, item));
                let mm = context.map(|context| self.units_of(Some(context)).length_mm);
                Some(Rc::new(Shape { name, items, mapped, context, mm }))
            }
            Err(bad) => {
                self.doc.lose_bad(&bad);
                None
            }
        };
        self.shapes.insert(rep, shape.clone());
        shape
    }

    /// Millimetres per unit of a representation; `otherwise` if it states none.
    fn rep_mm(&mut self, rep: Ix, otherwise: f64) -> f64 {
        self.shape(rep).and_then(|shape| shape.mm).unwrap_or(otherwise)
    }

    fn product_info(&mut self, definition: Ix) -> Rc<Product> {
        if let Some(known) = self.known_products.get(&definition) {
            return known.clone();
        }
        let name = Products::name(self.doc, definition);
        let shapes = self.shape_of(definition);
        let mm = shapes.first().and_then(|&(rep, _)| self.shape(rep)).and_then(|shape| shape.mm);
        let product = Rc::new(Product { name, shapes, mm });
        self.known_products.insert(definition, product.clone());
        product
    }

    fn new_node(&mut self, name: String, ix: Ix) -> Option<NodeId> {
        if self.nodes.len() >= MAX_NODES {
            if !self.cut_off {
                self.doc.lose(ix, ReadIssue::AssemblyTooLarge { nodes: MAX_NODES });
            }
            self.cut_off = true;
            return None;
        }
        let id = NodeId::from(self.nodes.len());
        let source = self.doc.source(ix);
        self.nodes.push(Node {
            name,
            transform: DAffine3::IDENTITY,
            part: None,
            children: Vec::new(),
            color: None,
            source,
        });
        Some(id)
    }

    /// Enters an entity on the way down; false where it is already on the way, or the way is too long.
    fn enter(&mut self, ix: Ix) -> bool {
        if self.path.contains(&ix) {
            self.doc.lose(ix, ReadIssue::AssemblyRecursive);
            return false;
        }
        if self.path.len() >= MAX_DEPTH as usize {
            self.doc.lose(ix, ReadIssue::AssemblyTooDeep { levels: MAX_DEPTH });
            return false;
        }
        self.path.push(ix);
        true
    }

    /// A product with its shape and its components, in the units of its shape.
    fn product(&mut self, definition: Ix, parent_mm: f64) -> Option<NodeId> {
        if !self.enter(definition) {
            return None;
        }
        let product = self.product_info(definition);
        let id = self.new_node(product.name.clone(), definition);
        if let Some(id) = id {
            let mm = product.mm.unwrap_or(parent_mm);
            for &(rep, to_product) in &product.shapes {
                self.attach(id, rep, to_product, mm, &product.name);
            }
            let usages = self.products.usages.get(&definition).map_or(&[][..], Vec::as_slice);
            for usage in usages {
                self.component(id, usage, definition, mm);
            }
        }
        self.path.pop();
        id
    }

    /// The representations of a product: those given to it, and those that relations lead to without crossing
    /// into another product; each with its transformation to the product's first one.
    fn shape_of(&mut self, definition: Ix) -> Vec<(Ix, DAffine3)> {
        let products = self.products;
        let Some(given) = products.shapes.get(&definition) else { return Vec::new() };
        let mut found: Vec<(Ix, DAffine3)> = given.iter().map(|&rep| (rep, DAffine3::IDENTITY)).collect();
        let mut next = 0;
        while let Some(&(rep, to_product)) = found.get(next) {
            next += 1;
            for relation in products.related.get(&rep).map_or(&[][..], Vec::as_slice) {
                let other = if relation.rep_1 == rep { relation.rep_2 } else { relation.rep_1 };
                if products.owned.contains(&other) || found.iter().any(|(known, _)| *known == other) {
                    continue;
                }
                if !is_shape(self.doc, other) {
                    continue;
                }
                match self.relation_transform(relation, other) {
                    Ok(transform) => found.push((other, to_product * transform)),
                    Err(bad) => self.doc.lose_bad(&bad),
                }
            }
        }
        found
    }

    /// From `child`'s coordinates to those of the other representation of a relation.
    fn relation_transform(&mut self, relation: &Relation, child: Ix) -> Res<DAffine3> {
        let child_is_first = relation.rep_1 == child;
        let parent = if child_is_first { relation.rep_2 } else { relation.rep_1 };
        let [child_mm, parent_mm] = [self.rep_mm(child, 1.0), self.rep_mm(parent, 1.0)];
        let Some(transformation) = relation.transformation else {
            return Ok(DAffine3::from_scale(DVec3::splat(child_mm / parent_mm)));
        };
        if self.doc.kw(transformation) != Kw::ItemDefinedTransformation {
            let scale = DAffine3::from_scale(DVec3::splat(child_mm / parent_mm));
            let operator = transforms::placement(self.doc, transformation)?;
            return Ok(if child_is_first { operator * scale } else { operator.inverse() * scale });
        }
        let mut args = self.doc.open(transformation)?;
        args.skip(2);
        let [item_1, item_2] = [args.reference()?, args.reference()?];
        let (mut ours, mut theirs) = if child_is_first { (item_1, item_2) } else { (item_2, item_1) };
        if self.crossed(child, parent, ours, theirs) {
            self.doc.warn(transformation, ReadIssue::PlacementExchanged);
            std::mem::swap(&mut ours, &mut theirs);
        }
        let (from, to) =
            (Side { item: ours, length_mm: child_mm }, Side { item: theirs, length_mm: parent_mm });
        transforms::between(self.doc, from, to)
    }

    /// True where the child's item is listed only by the parent and the parent's only by the child.
    fn crossed(&mut self, child: Ix, parent: Ix, ours: Ix, theirs: Ix) -> bool {
        let (Some(child), Some(parent)) = (self.shape(child), self.shape(parent)) else { return false };
        ours != theirs
            && !child.items.contains(&ours)
            && parent.items.contains(&ours)
            && child.items.contains(&theirs)
            && !parent.items.contains(&theirs)
    }

    /// One use of a product in another.
    fn component(&mut self, parent: NodeId, usage: &Usage, parent_definition: Ix, parent_mm: f64) {
        let Some(id) = self.product(usage.child, parent_mm) else { return };
        let child_mm = self.product_info(usage.child).mm.unwrap_or(parent_mm);
        let transform = match self.usages.get(&usage.ix) {
            Some(&known) => known,
            None => self.usage_transform(usage, parent_definition, child_mm, parent_mm),
        };
        self.usages.insert(usage.ix, transform);
        let color = self.usage_color(usage);
        let node = &mut self.nodes[id.index()];
        node.transform = transform;
        node.color = color;
        node.source = self.doc.source(usage.ix);
        if !usage.name.is_empty() {
            node.name.clone_from(&usage.name);
        }
        self.nodes[parent.index()].children.push(id);
    }

    fn usage_transform(&mut self, usage: &Usage, parent: Ix, child_mm: f64, parent_mm: f64) -> DAffine3 {
        let unplaced = DAffine3::from_scale(DVec3::splat(child_mm / parent_mm));
        let Some((_, relation)) = self.products.placements.get(&usage.ix).copied() else {
            self.doc.warn(usage.ix, ReadIssue::ComponentAtOrigin { cause: None });
            return unplaced;
        };
        let (of_child, of_parent) = (self.product_info(usage.child), self.product_info(parent));
        let has = |product: &Product, rep: Ix| product.shapes.iter().any(|(known, _)| *known == rep);
        // Usually the first representation is the child's; some writers have it the other way round.
        let second = (has(&of_child, relation.rep_2) && !has(&of_parent, relation.rep_2))
            || (!has(&of_child, relation.rep_1) && has(&of_parent, relation.rep_1));
        let child = if second { relation.rep_2 } else { relation.rep_1 };
        match self.relation_transform(&relation, child) {
            Ok(transform) => transform,
            Err(bad) => {
                let cause = Some(bad.into_cause(self.doc.source(usage.ix)));
                self.doc.warn(usage.ix, ReadIssue::ComponentAtOrigin { cause });
                unplaced
            }
        }
    }

    /// A colour given to a component's item only within this use.
    fn usage_color(&self, usage: &Usage) -> Option<Color> {
        let (placement, relation) = self.products.placements.get(&usage.ix)?;
        let names_this =
            |entities: &[Ix]| entities.iter().any(|ix| [*placement, relation.ix, usage.ix].contains(ix));
        self.styles
            .in_context
            .iter()
            .find(|(_, entities, _)| names_this(entities))
            .map(|&(_, _, color)| color)
    }

    /// Adds the content of a representation to a node whose units are `mm` millimetres.
    fn attach(&mut self, id: NodeId, rep: Ix, to_node: DAffine3, mm: f64, name: &str) {
        if !self.enter(rep) {
            return;
        }
        self.reached.insert(rep);
        if let Some(shape) = self.shape(rep) {
            self.attach_items(id, rep, &shape, to_node, mm, name);
        }
        self.path.pop();
    }

    fn attach_items(&mut self, id: NodeId, rep: Ix, shape: &Shape, to_node: DAffine3, mm: f64, name: &str) {
        let part = self.part(rep, shape, name);
        let own_mm = shape.mm.unwrap_or(mm);
        let plain = to_node == DAffine3::IDENTITY && own_mm == mm;
        let mut target = id;
        let taken = part.is_some() && self.nodes[id.index()].part.is_some();
        if taken || (!plain && (part.is_some() || !shape.mapped.is_empty())) {
            let Some(child) = self.new_node(shape.name.clone(), rep) else { return };
            self.nodes[child.index()].transform =
                to_node * DAffine3::from_scale(DVec3::splat(scale_left(to_node, own_mm, mm)));
            self.nodes[id.index()].children.push(child);
            target = child;
        }
        if part.is_some() {
            self.nodes[target.index()].part = part;
        }
        for &item in &shape.mapped {
            self.mapped(target, item, own_mm, name);
        }
    }

    /// MAPPED_ITEM: a copy of another representation.
    fn mapped(&mut self, parent: NodeId, ix: Ix, parent_mm: f64, name: &str) {
        let Some(copy) = self.copy(ix, parent_mm) else { return };
        let name = if copy.name.is_empty() { name } else { &copy.name };
        let Some(id) = self.new_node(name.to_owned(), ix) else { return };
        let node = &mut self.nodes[id.index()];
        node.transform = copy.transform;
        node.color = self.styles.colors.get(&ix).copied();
        self.nodes[parent.index()].children.push(id);
        self.attach(id, copy.shape, DAffine3::IDENTITY, copy.mm, name);
    }

    fn copy(&mut self, ix: Ix, parent_mm: f64) -> Option<Rc<Copy>> {
        if let Some(known) = self.copies.get(&ix) {
            return known.clone();
        }
        let copy = match self.read_copy(ix, parent_mm) {
            Ok(copy) => Some(Rc::new(copy)),
            Err(bad) => {
                self.doc.lose_bad(&bad);
                None
            }
        };
        self.copies.insert(ix, copy.clone());
        copy
    }

    /// MAPPED_ITEM(name, source, target) of a REPRESENTATION_MAP(origin, representation).
    fn read_copy(&mut self, ix: Ix, parent_mm: f64) -> Res<Copy> {
        let complex = self.doc.kw(ix) == Kw::Complex;
        let mut args = self.doc.leaf(ix, Kw::MappedItem)?;
        let name = if complex { String::new() } else { args.string() };
        let map = args.reference()?;
        let target = args.reference()?;
        let mut args = self.doc.leaf(map, Kw::RepresentationMap)?;
        let origin = args.reference()?;
        let shape = args.reference()?;
        let mm = self.rep_mm(shape, parent_mm);
        let from = Side { item: origin, length_mm: mm };
        let transform = transforms::between(self.doc, from, Side { item: target, length_mm: parent_mm })?;
        Ok(Copy { name, shape, transform, mm })
    }

    /// The part of a representation, built once.
    fn part(&mut self, rep: Ix, shape: &Shape, name: &str) -> Option<PartId> {
        if let Some(&known) = self.part_of.get(&rep) {
            return known;
        }
        let name = if name.is_empty() { shape.name.clone() } else { name.to_owned() };
        let part = self.build_part(&shape.items, shape.context, name, self.doc.source(rep));
        if let Some(part) = part {
            self.parts[part.index()].color = self.styles.colors.get(&rep).copied();
        }
        self.part_of.insert(rep, part);
        part
    }

    fn build_part(
        &mut self,
        items: &[Ix],
        context: Option<Ix>,
        name: String,
        source: Source,
    ) -> Option<PartId> {
        let units = self.units_of(context);
        let mut builder = Builder::new(self.doc, self.styles, units, name, source);
        for &item in items {
            builder.item(item);
        }
        let part = builder.finish();
        let empty = part.faces.is_empty() && part.loose.is_empty() && part.tessellated.is_empty();
        (!empty).then(|| {
            self.parts.push(part);
            PartId::from(self.parts.len() - 1)
        })
    }

    /// The first thing that went wrong, for a file that yields nothing.
    pub(crate) fn first_problem(&self) -> Option<Issue> {
        self.doc.notes.first()
    }
}

/// The scale still missing where representations of different units are one: relations carry it already.
fn scale_left(to_node: DAffine3, own_mm: f64, mm: f64) -> f64 {
    if to_node == DAffine3::IDENTITY { own_mm / mm } else { 1.0 }
}

fn is_mapped(doc: &Doc<'_>, ix: Ix) -> bool {
    match doc.kw(ix) {
        Kw::MappedItem => true,
        Kw::Complex => doc.kinds(ix).contains(&Kw::MappedItem),
        _ => false,
    }
}
