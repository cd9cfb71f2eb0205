//! The assembly tree: products and mapped items unfolded into nodes, representations turned into parts.

use super::builder::Builder;
use super::document::{Bad, Doc, Ix, Res};
use super::keyword::Kw;
use super::products::{Products, Relation, Usage};
use super::representation::{Representation, is_shape};
use super::styles::Styles;
use super::transforms::{self, Side};
use super::units::Units;
use chordal_brep::{Color, Node, NodeId, Part, PartId, Source};
use chordal_nurbs::{DAffine3, DVec3};
use rustc_hash::{FxHashMap, FxHashSet};

/// A tree that unfolds to more nodes than this is cut off.
const MAX_NODES: usize = 1_000_000;
/// Assemblies nest a few dozen levels at most.
const MAX_DEPTH: usize = 100;

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
            reached: FxHashSet::default(),
            path: Vec::new(),
            cut_off: false,
        }
    }

    /// Unfolds everything: products, then representations that no product leads to, then bodies without either.
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
                self.doc.warn(first, "every product is part of another; this one is taken for the whole");
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
        let scale = DAffine3::from_scale(DVec3::splat(self.product_mm(definition, 1.0)));
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

    /// Millimetres per unit of a representation; `otherwise` where it has no context.
    fn rep_mm(&mut self, rep: Ix, otherwise: f64) -> f64 {
        match Representation::read(self.doc, rep) {
            Ok(Representation { context: Some(context), .. }) => self.units_of(Some(context)).length_mm,
            _ => otherwise,
        }
    }

    fn product_mm(&mut self, definition: Ix, otherwise: f64) -> f64 {
        match self.products.shapes.get(&definition).and_then(|shapes| shapes.first()).copied() {
            Some(rep) => self.rep_mm(rep, otherwise),
            None => otherwise,
        }
    }

    fn new_node(&mut self, name: String, ix: Ix) -> Option<NodeId> {
        if self.nodes.len() >= MAX_NODES {
            if !self.cut_off {
                self.doc.warn(
                    ix,
                    format!("the assembly unfolds to more than {MAX_NODES} nodes; the rest is left out"),
                );
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
        if self.path.contains(&ix) || self.path.len() >= MAX_DEPTH {
            self.doc.warn(ix, "the assembly contains itself; cut off here");
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
        let name = Products::name(self.doc, definition);
        let id = self.new_node(name.clone(), definition);
        if let Some(id) = id {
            let mm = self.product_mm(definition, parent_mm);
            for (rep, to_product) in self.shape_of(definition) {
                self.attach(id, rep, to_product, mm, &name);
            }
            let usages = self.products.usages.get(&definition).map_or(&[][..], Vec::as_slice);
            for usage in usages {
                self.component(id, usage, definition, mm);
            }
        }
        self.path.pop();
        id
    }

    /// The representations of a product: those given to it, and those that relations lead to without crossing into
    /// another product; each with its transformation to the product's first one.
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
                    Err(bad) => self.doc.warn_bad(&bad),
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
            self.doc.warn(transformation, "its two items belong to the other representation each; exchanged");
            std::mem::swap(&mut ours, &mut theirs);
        }
        let (from, to) =
            (Side { item: ours, length_mm: child_mm }, Side { item: theirs, length_mm: parent_mm });
        transforms::between(self.doc, from, to)
    }

    /// True where the child's item is listed only by the parent and the parent's only by the child.
    fn crossed(&self, child: Ix, parent: Ix, ours: Ix, theirs: Ix) -> bool {
        let lists = |rep: Ix, item: Ix| {
            Representation::read(self.doc, rep).is_ok_and(|rep| rep.items.contains(&item))
        };
        ours != theirs
            && !lists(child, ours)
            && lists(parent, ours)
            && lists(child, theirs)
            && !lists(parent, theirs)
    }

    /// One use of a product in another.
    fn component(&mut self, parent: NodeId, usage: &Usage, parent_definition: Ix, parent_mm: f64) {
        let Some(id) = self.product(usage.child, parent_mm) else { return };
        let child_mm = self.product_mm(usage.child, parent_mm);
        let transform = self.usage_transform(usage, parent_definition, child_mm, parent_mm);
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
            self.doc.warn(usage.ix, "nothing places this component; it is put at the origin");
            return unplaced;
        };
        let of_child: Vec<Ix> = self.shape_of(usage.child).into_iter().map(|(rep, _)| rep).collect();
        let of_parent: Vec<Ix> = self.shape_of(parent).into_iter().map(|(rep, _)| rep).collect();
        // Usually the first representation is the child's; some writers have it the other way round.
        let second = (of_child.contains(&relation.rep_2) && !of_parent.contains(&relation.rep_2))
            || (!of_child.contains(&relation.rep_1) && of_parent.contains(&relation.rep_1));
        let child = if second { relation.rep_2 } else { relation.rep_1 };
        match self.relation_transform(&relation, child) {
            Ok(transform) => transform,
            Err(bad) => {
                self.doc.warn(usage.ix, format!("the component is put at the origin: {bad}"));
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
        match Representation::read(self.doc, rep) {
            Ok(read) => self.attach_items(id, rep, &read, to_node, mm, name),
            Err(bad) => self.doc.warn_bad(&bad),
        }
        self.path.pop();
    }

    fn attach_items(
        &mut self,
        id: NodeId,
        rep: Ix,
        read: &Representation,
        to_node: DAffine3,
        mm: f64,
        name: &str,
    ) {
        let part = self.part(rep, read, name);
        let own_mm = read.context.map_or(mm, |context| self.units_of(Some(context)).length_mm);
        let plain = to_node == DAffine3::IDENTITY && own_mm == mm;
        let mut target = id;
        let mapped: Vec<Ix> = read.items.iter().copied().filter(|&item| is_mapped(self.doc, item)).collect();
        let taken = part.is_some() && self.nodes[id.index()].part.is_some();
        if taken || (!plain && (part.is_some() || !mapped.is_empty())) {
            let Some(child) = self.new_node(read.name.clone(), rep) else { return };
            self.nodes[child.index()].transform = to_node;
            self.nodes[id.index()].children.push(child);
            target = child;
        }
        if part.is_some() {
            self.nodes[target.index()].part = part;
        }
        for item in mapped {
            if let Err(bad) = self.mapped(target, item, own_mm, name) {
                self.doc.warn_bad(&bad);
            }
        }
    }

    /// MAPPED_ITEM(name, source, target): a copy of another representation.
    fn mapped(&mut self, parent: NodeId, ix: Ix, parent_mm: f64, name: &str) -> Res<()> {
        let mut args = self.doc.leaf(ix, Kw::MappedItem)?;
        let own_name = args.string();
        let map = args.reference()?;
        let target = args.reference()?;
        let mut args = self.doc.leaf(map, Kw::RepresentationMap)?;
        let origin = args.reference()?;
        let rep = args.reference()?;
        let mm = self.rep_mm(rep, parent_mm);
        let transform = transforms::between(
            self.doc,
            Side { item: origin, length_mm: mm },
            Side { item: target, length_mm: parent_mm },
        )?;
        let Some(id) = self.new_node(if own_name.is_empty() { name.to_owned() } else { own_name }, ix) else {
            return Ok(());
        };
        self.nodes[id.index()].transform = transform;
        self.nodes[id.index()].color = self.styles.colors.get(&ix).copied();
        self.nodes[parent.index()].children.push(id);
        self.attach(id, rep, DAffine3::IDENTITY, mm, name);
        Ok(())
    }

    /// The part of a representation, built once.
    fn part(&mut self, rep: Ix, read: &Representation, name: &str) -> Option<PartId> {
        if let Some(&known) = self.part_of.get(&rep) {
            return known;
        }
        let name = if name.is_empty() { read.name.clone() } else { name.to_owned() };
        let items: Vec<Ix> = read.items.iter().copied().filter(|&item| !is_mapped(self.doc, item)).collect();
        let part = self.build_part(&items, read.context, name, self.doc.source(rep));
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

    /// Shape representations that no product leads to; those of features and properties only where nothing else is.
    fn orphans(&mut self, auxiliary: bool) {
        let doc = self.doc;
        let candidates = doc.all(|kw| !matches!(kw, Kw::CartesianPoint | Kw::Direction | Kw::OrientedEdge));
        let reps: Vec<Ix> = candidates.into_iter().filter(|&ix| is_shape(doc, ix)).collect();
        for rep in reps {
            if self.reached.contains(&rep) || (!auxiliary && self.products.auxiliary.contains(&rep)) {
                continue;
            }
            let Ok(read) = Representation::read(doc, rep) else { continue };
            let before = self.nodes.len();
            let Some(id) = self.new_node(read.name.clone(), rep) else { return };
            let mm = self.rep_mm(rep, 1.0);
            self.attach(id, rep, DAffine3::IDENTITY, mm, "");
            let node = &mut self.nodes[id.index()];
            if node.part.is_none() && node.children.is_empty() {
                self.nodes.truncate(before);
                continue;
            }
            node.transform = DAffine3::from_scale(DVec3::splat(mm));
            self.roots.push(id);
            doc.warn(rep, "no product leads to this shape; it is a root of its own");
        }
    }

    /// Bodies of a file without any representation, in the units of the first context that states any.
    fn bodies_alone(&mut self) {
        let doc = self.doc;
        let solids = doc.all(|kw| {
            matches!(
                kw,
                Kw::ManifoldSolidBrep
                    | Kw::FacetedBrep
                    | Kw::BrepWithVoids
                    | Kw::ShellBasedSurfaceModel
                    | Kw::FaceBasedSurfaceModel
                    | Kw::TessellatedSolid
                    | Kw::TessellatedShell
            )
        });
        let shells = || doc.all(|kw| matches!(kw, Kw::ClosedShell | Kw::OpenShell | Kw::ConnectedFaceSet));
        let faces = || doc.all(|kw| matches!(kw, Kw::AdvancedFace | Kw::FaceSurface));
        let lists: [&dyn Fn() -> Vec<Ix>; 3] = [&|| solids.clone(), &shells, &faces];
        let contexts = doc.all(|kw| matches!(kw, Kw::Complex));
        let context = contexts.into_iter().find(|&ix| doc.kinds(ix).contains(&Kw::GlobalUnitAssignedContext));
        for list in lists {
            let items = list();
            let Some(&first) = items.first() else { continue };
            if let Some(part) = self.build_part(&items, context, String::new(), doc.source(first)) {
                doc.warn(first, "the file has no product structure; its bodies are read as they are");
                if let Some(id) = self.new_node(String::new(), first) {
                    let mm = self.units_of(context).length_mm;
                    self.nodes[id.index()].part = Some(part);
                    self.nodes[id.index()].transform = DAffine3::from_scale(DVec3::splat(mm));
                    self.roots.push(id);
                }
                return;
            }
        }
    }

    /// The first thing that went wrong, for a file that yields nothing.
    pub(crate) fn first_problem(&self) -> Option<Bad> {
        self.doc.first_warning().map(|warning| Bad::new(warning.source, warning.message))
    }
}

fn is_mapped(doc: &Doc<'_>, ix: Ix) -> bool {
    match doc.kw(ix) {
        Kw::MappedItem => true,
        Kw::Complex => doc.kinds(ix).contains(&Kw::MappedItem),
        _ => false,
    }
}
