//! A part under construction: what of it exists already, by entity.

use super::document::{Bad, Doc, Ix, Res};
use super::geometry::Geometry;
use super::styles::Styles;
use super::units::Units;
use crate::assemble::PartBuilder;
use chordal_brep::{Color, EdgeId, Part, Source, VertexId};
use chordal_nurbs::{Curve2, DVec3, Range};
use rustc_hash::{FxHashMap, FxHashSet};
use std::sync::Arc;

/// A curve of an edge in the parameter space of the surface of entity `surface`.
#[derive(Clone, Debug)]
pub(crate) struct SurfaceUse {
    pub surface: Ix,
    pub curve: Arc<Curve2>,
    pub range: Range,
}

/// An edge that exists already.
#[derive(Clone, Debug)]
pub(crate) struct KnownEdge {
    pub id: EdgeId,
    /// The part's edge runs against the entity's start and end.
    pub swapped: bool,
    pub pcurves: Arc<[SurfaceUse]>,
}

/// A part under construction.
#[derive(Debug)]
pub(crate) struct Builder<'d> {
    pub doc: &'d Doc<'d>,
    pub geometry: Geometry<'d>,
    pub styles: &'d Styles,
    pub build: PartBuilder,
    pub vertices: FxHashMap<Ix, VertexId>,
    pub edges: FxHashMap<Ix, Res<KnownEdge>>,
    /// Corners of polygons by the bits of their coordinates: files repeat the points of one corner.
    corners: FxHashMap<[u64; 3], VertexId>,
    /// By edge: true where a loop uses it already.
    pub settled: Vec<bool>,
    /// Items taken already; one entity makes one body however often it is listed.
    pub taken: FxHashSet<Ix>,
}

impl<'d> Builder<'d> {
    pub(crate) fn new(
        doc: &'d Doc<'d>,
        styles: &'d Styles,
        units: Units,
        name: String,
        source: Source,
    ) -> Self {
        let part = Part { name, uncertainty: units.uncertainty, source, ..Part::default() };
        Self {
            doc,
            geometry: Geometry::new(doc, units),
            styles,
            build: PartBuilder::new(part),
            vertices: FxHashMap::default(),
            edges: FxHashMap::default(),
            corners: FxHashMap::default(),
            settled: Vec::new(),
            taken: FxHashSet::default(),
        }
    }

    /// The finished part.
    pub(crate) fn finish(self) -> Part {
        self.build.finish()
    }

    /// The vertex of a polygon's corner: one for all corners with the same coordinates.
    pub(crate) fn corner(&mut self, point: DVec3, source: Source) -> VertexId {
        // Adding zero makes -0 and 0 one.
        let key = (point + DVec3::ZERO).to_array().map(f64::to_bits);
        if let Some(&known) = self.corners.get(&key) {
            return known;
        }
        let id = self.build.new_vertex(point, source);
        self.corners.insert(key, id);
        id
    }

    /// Records why something is ignored.
    pub(crate) fn warn_bad(&self, bad: &Bad) {
        self.doc.warn_bad(bad);
    }

    /// Notes what is wrong with something whose shape will be missing.
    pub(crate) fn lose_bad(&self, bad: &Bad) {
        self.doc.lose_bad(bad);
    }

    pub(crate) fn color(&self, ix: Ix) -> Option<Color> {
        self.styles.colors.get(&ix).copied()
    }

    pub(crate) fn layer(&self, ix: Ix) -> Option<String> {
        self.styles.layers.get(&ix).cloned()
    }
}
