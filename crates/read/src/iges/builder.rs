//! A part under construction: what of it exists already, by entity.

use super::document::{Bad, Doc, Ix, Res};
use crate::assemble::PartBuilder;
use crate::trimmed::Look;
use chordal_brep::{EdgeId, FaceId, VertexId};
use chordal_nurbs::{DAffine3, DVec3};
use rustc_hash::FxHashMap;
use std::sync::Arc;

/// A row of an edge list: a curve, and its ends as a list with a position in it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EdgeRow {
    pub curve: Ix,
    pub ends: [(Ix, usize); 2],
}

/// An edge that exists already.
#[derive(Clone, Copy, Debug)]
pub(crate) struct KnownEdge {
    pub id: EdgeId,
    /// The part's edge runs against the list's start and end.
    pub swapped: bool,
}

/// A part under construction.
#[derive(Debug)]
pub(crate) struct Builder<'d, 'a> {
    pub doc: &'d Doc<'a>,
    pub build: PartBuilder,
    /// Lists of vertices and of edges, by entity.
    pub vertex_lists: FxHashMap<Ix, Res<Arc<[DVec3]>>>,
    pub edge_lists: FxHashMap<Ix, Res<Arc<[EdgeRow]>>>,
    /// By list and position.
    pub vertices: FxHashMap<(Ix, usize), VertexId>,
    pub edges: FxHashMap<(Ix, usize), Res<KnownEdge>>,
    /// The transformation of the solid that is being read.
    pub by: DAffine3,
}

impl<'d, 'a> Builder<'d, 'a> {
    pub(crate) fn new(doc: &'d Doc<'a>, name: String) -> Self {
        let mut build = PartBuilder::default();
        build.part.name = name;
        build.part.uncertainty = doc.global.resolution;
        Self {
            doc,
            build,
            vertex_lists: FxHashMap::default(),
            edge_lists: FxHashMap::default(),
            vertices: FxHashMap::default(),
            edges: FxHashMap::default(),
            by: DAffine3::IDENTITY,
        }
    }

    /// The resolution that the file states, 0 where it states none.
    pub(crate) fn resolution(&self) -> f64 {
        self.doc.global.resolution.unwrap_or(0.0)
    }

    /// Adds a face that could not be understood.
    pub(crate) fn failed(&mut self, bad: Bad, look: &Look) -> FaceId {
        crate::trimmed::push_failed(&mut self.build.part, bad.into_error(), look)
    }
}
