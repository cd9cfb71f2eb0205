//! The state in which geometry of one representation is read: units, surfaces already built, nesting.

use super::document::{Doc, Ix, Res};
use super::units::Units;
use chordal_nurbs::Surface;
use rustc_hash::FxHashMap;
use std::sync::Arc;

/// Definitions nested deeper than this are taken for circular.
const MAX_DEPTH: u32 = 32;

/// Reads points, curves and surfaces. Lengths stay in the file's units, angles become radians.
#[derive(Debug)]
pub(crate) struct Geometry<'d> {
    pub doc: &'d Doc<'d>,
    pub units: Units,
    surfaces: FxHashMap<Ix, Res<Arc<Surface>>>,
    depth: u32,
}

impl<'d> Geometry<'d> {
    pub(crate) fn new(doc: &'d Doc<'d>, units: Units) -> Self {
        Self { doc, units, surfaces: FxHashMap::default(), depth: 0 }
    }

    /// Runs `read` one level deeper; fails where the definitions refer in a circle.
    pub(crate) fn nested<T>(&mut self, ix: Ix, read: impl FnOnce(&mut Self) -> Res<T>) -> Res<T> {
        if self.depth >= MAX_DEPTH {
            return Err(self.doc.recursive(ix, MAX_DEPTH));
        }
        self.depth += 1;
        let result = read(self);
        self.depth -= 1;
        result
    }

    /// The surface of this entity, built once.
    pub(crate) fn surface(&mut self, ix: Ix) -> Res<Arc<Surface>> {
        if let Some(known) = self.surfaces.get(&ix) {
            return known.clone();
        }
        let built = self.nested(ix, |geometry| geometry.build_surface(ix)).map(Arc::new);
        self.surfaces.insert(ix, built.clone());
        built
    }
}
