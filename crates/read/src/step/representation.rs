//! A representation: its items and the units that its context gives.

use super::document::{Doc, Ix, Res};
use super::keyword::Kw;

/// The attributes of any representation.
#[derive(Clone, Debug)]
pub(crate) struct Representation {
    pub name: String,
    pub items: Vec<Ix>,
    pub context: Option<Ix>,
}

impl Representation {
    /// Reads a representation of any kind, simple or complex.
    pub(crate) fn read(doc: &Doc<'_>, ix: Ix) -> Res<Self> {
        let mut args =
            if doc.kw(ix) == Kw::Complex { doc.leaf(ix, Kw::Representation)? } else { doc.open(ix)? };
        let name = args.string();
        let items = args.references_or_warn();
        Ok(Self { name, items, context: args.optional_reference() })
    }
}

/// True for the kinds of representation whose items are a shape.
pub(crate) fn is_shape(doc: &Doc<'_>, ix: Ix) -> bool {
    match doc.kw(ix) {
        Kw::ShapeRepresentation
        | Kw::AdvancedBrepShapeRepresentation
        | Kw::FacetedBrepShapeRepresentation
        | Kw::ManifoldSurfaceShapeRepresentation
        | Kw::ManifoldSubsurfaceShapeRepresentation
        | Kw::NonManifoldSurfaceShapeRepresentation
        | Kw::GeometricallyBoundedSurfaceShapeRepresentation
        | Kw::GeometricallyBoundedWireframeShapeRepresentation
        | Kw::TessellatedShapeRepresentation
        | Kw::ShapeRepresentationWithParameters => true,
        Kw::Complex => doc.kinds(ix).contains(&Kw::ShapeRepresentation),
        Kw::Unknown => doc.written_name(ix).ends_with("SHAPE_REPRESENTATION"),
        _ => false,
    }
}
