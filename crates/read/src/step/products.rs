//! The products of the file: their shapes, and which product is used where.

use super::args::Args;
use super::document::{Doc, Ix};
use super::keyword::Kw;
use chordal_brep::ReadIssue;
use rustc_hash::{FxHashMap, FxHashSet};

/// One use of a product in another.
#[derive(Clone, Debug)]
pub(crate) struct Usage {
    pub ix: Ix,
    pub child: Ix,
    pub name: String,
}

/// A relation between two representations.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Relation {
    pub ix: Ix,
    pub rep_1: Ix,
    pub rep_2: Ix,
    pub transformation: Option<Ix>,
}

/// The product structure. Vectors keep the order of the file.
#[derive(Debug, Default)]
pub(crate) struct Products {
    /// Product definitions.
    pub definitions: Vec<Ix>,
    /// Representations of a product definition.
    pub shapes: FxHashMap<Ix, Vec<Ix>>,
    /// Representations that belong to some product definition.
    pub owned: FxHashSet<Ix>,
    /// Representations of other things (features, datums): no shapes of their own.
    pub auxiliary: FxHashSet<Ix>,
    pub usages: FxHashMap<Ix, Vec<Usage>>,
    /// Product definitions used in others.
    pub used: FxHashSet<Ix>,
    /// The relation that places a usage, with its entity.
    pub placements: FxHashMap<Ix, (Ix, Relation)>,
    /// Relations between representations that place no usage.
    pub related: FxHashMap<Ix, Vec<Relation>>,
}

impl Products {
    pub(crate) fn read(doc: &Doc<'_>) -> Self {
        let is_definition =
            |kw| matches!(kw, Kw::ProductDefinition | Kw::ProductDefinitionWithAssociatedDocuments);
        let mut products = Self { definitions: doc.all(is_definition), ..Self::default() };
        products.read_shapes(doc);
        products.read_usages(doc);
        let placing = products.read_placements(doc);
        products.read_relations(doc, &placing);
        products
    }

    /// What a PRODUCT_DEFINITION_SHAPE is the shape of.
    fn defined(doc: &Doc<'_>, shape: Ix) -> Option<Ix> {
        let mut args = doc.leaf(shape, Kw::ProductDefinitionShape).ok()?;
        args.skip(2);
        args.optional_reference()
    }

    fn read_shapes(&mut self, doc: &Doc<'_>) {
        for ix in doc.all(|kw| kw == Kw::ShapeDefinitionRepresentation) {
            let Ok(mut args) = doc.open(ix) else { continue };
            let (definition, representation) = (args.reference(), args.reference());
            let (definition, representation) = match (definition, representation) {
                (Ok(definition), Ok(representation)) => (definition, representation),
                (Err(bad), _) | (_, Err(bad)) => {
                    doc.lose_bad(&bad);
                    continue;
                }
            };
            match Self::defined(doc, definition) {
                Some(product) if self.is_definition(doc, product) => {
                    self.owned.insert(representation);
                    let shapes = self.shapes.entry(product).or_default();
                    if !shapes.contains(&representation) {
                        shapes.push(representation);
                    }
                }
                // The shape of a feature or of a property: it repeats items that belong to a product's shape.
                _ => {
                    self.auxiliary.insert(representation);
                }
            }
        }
        self.auxiliary.retain(|rep| !self.owned.contains(rep));
    }

    fn is_definition(&self, doc: &Doc<'_>, ix: Ix) -> bool {
        matches!(doc.kw(ix), Kw::ProductDefinition | Kw::ProductDefinitionWithAssociatedDocuments)
    }

    fn read_usages(&mut self, doc: &Doc<'_>) {
        for ix in doc.all(|kw| kw == Kw::NextAssemblyUsageOccurrence) {
            let Ok(mut args) = doc.open(ix) else { continue };
            let (id, name) = (args.string(), args.string());
            args.skip(1);
            match (args.reference(), args.reference()) {
                (Ok(parent), Ok(child)) => {
                    let designator = args.string();
                    let name =
                        [name, designator, id].into_iter().find(|name| is_name(name)).unwrap_or_default();
                    self.usages.entry(parent).or_default().push(Usage { ix, child, name });
                    self.used.insert(child);
                }
                (Err(bad), _) | (_, Err(bad)) => doc.lose_bad(&bad),
            }
        }
    }

    /// Returns the relations that place usages.
    fn read_placements(&mut self, doc: &Doc<'_>) -> FxHashSet<Ix> {
        let mut placing = FxHashSet::default();
        for ix in doc.all(|kw| kw == Kw::ContextDependentShapeRepresentation) {
            let Ok(mut args) = doc.open(ix) else { continue };
            let (Some(relation), Some(shape)) = (args.optional_reference(), args.optional_reference()) else {
                doc.warn(ix, ReadIssue::NothingPlaced);
                continue;
            };
            placing.insert(relation);
            if let (Some(relation), Some(usage)) = (Relation::read(doc, relation), Self::defined(doc, shape))
            {
                self.placements.entry(usage).or_insert((ix, relation));
            }
        }
        placing
    }

    fn read_relations(&mut self, doc: &Doc<'_>, placing: &FxHashSet<Ix>) {
        let candidates = doc.all(|kw| {
            matches!(
                kw,
                Kw::ShapeRepresentationRelationship
                    | Kw::RepresentationRelationship
                    | Kw::RepresentationRelationshipWithTransformation
                    | Kw::Complex
            )
        });
        for ix in candidates {
            if placing.contains(&ix) {
                continue;
            }
            if let Some(relation) = Relation::read(doc, ix) {
                for rep in [relation.rep_1, relation.rep_2] {
                    self.related.entry(rep).or_default().push(relation);
                }
            }
        }
    }

    /// The product's name, else its id.
    pub(crate) fn name(doc: &Doc<'_>, definition: Ix) -> String {
        let product = || {
            let mut args = doc.open(definition).ok()?;
            args.skip(2);
            let mut args = doc.open(args.optional_reference()?).ok()?;
            args.skip(2);
            let product = args.optional_reference().filter(|&ix| doc.kw(ix) == Kw::Product)?;
            let mut args = doc.open(product).ok()?;
            let (id, name) = (args.string(), args.string());
            Some(if name.trim().is_empty() { id } else { name })
        };
        product().unwrap_or_default()
    }
}

impl Relation {
    /// A representation relationship, simple or complex; `None` where the entity is none.
    fn read(doc: &Doc<'_>, ix: Ix) -> Option<Self> {
        let args = doc.open(ix).ok()?;
        match doc.kw(ix) {
            Kw::Complex => {
                let leaves = args.leaves();
                let leaf = |kw: Kw| leaves.iter().find(|(name, _)| *name == kw).map(|(_, args)| args.clone());
                let with = leaf(Kw::RepresentationRelationshipWithTransformation);
                let transformation = with.and_then(|mut args| args.optional_reference());
                Self::of(ix, leaf(Kw::RepresentationRelationship)?, transformation)
            }
            Kw::RepresentationRelationshipWithTransformation => {
                let mut last = args.clone();
                last.skip(4);
                Self::of(ix, args, last.optional_reference())
            }
            _ => Self::of(ix, args, None),
        }
    }

    fn of(ix: Ix, mut args: Args<'_>, transformation: Option<Ix>) -> Option<Self> {
        args.skip(2);
        let (rep_1, rep_2) = (args.optional_reference()?, args.optional_reference()?);
        Some(Self { ix, rep_1, rep_2, transformation })
    }
}

/// True for names that people give; numbers of occurrences made up by writers are none.
fn is_name(name: &str) -> bool {
    let name = name.trim();
    let numbered = name.trim_start_matches("NAUO").chars().all(|c| c.is_ascii_digit());
    let boilerplate =
        name.to_ascii_lowercase().starts_with("next assembly") || name.eq_ignore_ascii_case("none");
    !name.is_empty() && !name.starts_with("=>[") && !numbered && !boilerplate
}
