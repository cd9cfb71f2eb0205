//! Shapes that belong to no product, and bodies without any representation.

use super::Tree;
use crate::step::document::{Doc, Ix};
use crate::step::keyword::Kw;
use crate::step::representation::is_shape;
use chordal_brep::ReadIssue;
use chordal_nurbs::{DAffine3, DVec3};
use rustc_hash::FxHashSet;

impl Tree<'_> {
    /// Shape representations that belong to no product; those of features and properties only if there are no
    /// others (`auxiliary`).
    pub(super) fn orphans(&mut self, auxiliary: bool) {
        let doc = self.doc;
        let candidates = doc.all(|kw| !matches!(kw, Kw::CartesianPoint | Kw::Direction | Kw::OrientedEdge));
        let copied = copied(doc);
        let reps: Vec<Ix> = candidates.into_iter().filter(|&ix| is_shape(doc, ix)).collect();
        for rep in reps {
            if !auxiliary && copied.contains(&rep) {
                continue;
            }
            if self.reached.contains(&rep) || (!auxiliary && self.products.auxiliary.contains(&rep)) {
                continue;
            }
            let Some(shape) = self.shape(rep) else { continue };
            let before = self.nodes.len();
            let Some(id) = self.new_node(shape.name.clone(), rep) else { return };
            let mm = shape.mm.unwrap_or(1.0);
            self.attach(id, rep, DAffine3::IDENTITY, mm, "");
            let node = &mut self.nodes[id.index()];
            if node.part.is_none() && node.children.is_empty() {
                self.nodes.truncate(before);
                continue;
            }
            node.transform = DAffine3::from_scale(DVec3::splat(mm));
            self.roots.push(id);
            doc.warn(rep, ReadIssue::ShapeWithoutProduct);
        }
    }

    /// Bodies of a file without any representation, in the units of the first context that states any.
    pub(super) fn bodies_alone(&mut self) {
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
                doc.warn(first, ReadIssue::NoProducts);
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
}

/// The representations that mapped items copy. They have no placement of their own.
fn copied(doc: &Doc<'_>) -> FxHashSet<Ix> {
    let maps = doc.all(|kw| kw == Kw::RepresentationMap).into_iter();
    let copied = maps.filter_map(|map| {
        let mut args = doc.open(map).ok()?;
        args.skip(1);
        args.optional_reference()
    });
    copied.collect()
}
