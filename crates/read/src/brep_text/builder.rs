//! A part under construction: what of it exists already, by record and location.

use super::document::{Document, numbered};
use super::locations::{Loc, NOWHERE};
use super::shapes::{Ix, Kind, Shape};
use crate::assemble::PartBuilder;
use chordal_brep::{EdgeId, Pcurve, ReadIssue, VertexId};
use chordal_nurbs::{Curve, Curve2, DVec2, Range, Surface, UvBox, math};
use rustc_hash::FxHashMap;
use std::sync::Arc;

/// A surface in the part's coordinates.
#[derive(Clone, Debug)]
pub(crate) struct PlacedPatch {
    pub surface: Arc<Surface>,
    /// What the file's (u, v) are multiplied by.
    pub factors: DVec2,
    /// Our Su × Sv points against the file's.
    pub reversed: bool,
    pub trims: Option<UvBox>,
}

/// A part under construction.
#[derive(Debug)]
pub(crate) struct Builder<'d> {
    pub doc: &'d mut Document,
    pub build: PartBuilder,
    vertices: FxHashMap<(Ix, Loc), Result<VertexId, ReadIssue>>,
    pub edges: FxHashMap<(Ix, Loc), Result<EdgeId, ReadIssue>>,
    patches: FxHashMap<(i64, Loc), Result<PlacedPatch, ReadIssue>>,
    /// Uses of shapes that may still be followed: it bounds the work on files whose shapes use each other in
    /// ever new places. Files of exporters need about one for each use they state.
    pub budget: usize,
}

impl<'d> Builder<'d> {
    pub(crate) fn new(doc: &'d mut Document, name: String, budget: usize) -> Self {
        let mut build = PartBuilder::default();
        build.part.name = name;
        Self {
            doc,
            build,
            vertices: FxHashMap::default(),
            edges: FxHashMap::default(),
            patches: FxHashMap::default(),
            budget,
        }
    }

    /// Counts one use of a shape; false where there were too many.
    pub(crate) fn spend(&mut self) -> bool {
        self.budget = self.budget.saturating_sub(1);
        self.budget > 0
    }

    pub(crate) fn shape(&self, ix: Ix) -> Result<Shape, ReadIssue> {
        self.doc.shapes[ix].clone()
    }

    /// The location of a use within a location.
    pub(crate) fn within(&mut self, outer: Loc, number: i64) -> Result<Loc, ReadIssue> {
        let inner = self.doc.locations.of_file(number);
        let inner = inner.ok_or(ReadIssue::NotFound { what: "location", number })?;
        Ok(self.doc.locations.compose(outer, inner))
    }

    pub(crate) fn vertex(&mut self, ix: Ix, loc: Loc) -> Result<VertexId, ReadIssue> {
        if let Some(known) = self.vertices.get(&(ix, loc)) {
            return known.clone();
        }
        let made = self.new_vertex(ix, loc);
        self.vertices.insert((ix, loc), made.clone());
        made
    }

    fn new_vertex(&mut self, ix: Ix, loc: Loc) -> Result<VertexId, ReadIssue> {
        let Kind::Vertex { point, tolerance } = self.shape(ix)?.kind else {
            return Err(ReadIssue::UnknownKind { found: "an end of the edge".into(), expected: "a vertex" });
        };
        if !point.is_finite() {
            return Err(ReadIssue::NotFinite { what: "vertex" });
        }
        self.note_tolerance(tolerance, loc);
        let source = self.doc.source(ix);
        let point = self.doc.locations.matrix(loc).transform_point3(point);
        Ok(self.build.new_vertex(point, source))
    }

    /// Keeps the largest tolerance of the part.
    pub(crate) fn note_tolerance(&mut self, tolerance: f64, loc: Loc) {
        let scale = math::cbrt(self.doc.locations.matrix(loc).matrix3.determinant().abs());
        let known = &mut self.build.part.uncertainty;
        if tolerance.is_finite() && tolerance > 0.0 {
            *known = Some(known.unwrap_or(0.0).max(tolerance * scale));
        }
    }

    /// A surface of the file at a place.
    pub(crate) fn patch(&mut self, number: i64, loc: Loc) -> Result<PlacedPatch, ReadIssue> {
        if let Some(known) = self.patches.get(&(number, loc)) {
            return known.clone();
        }
        let made = self.new_patch(number, loc);
        self.patches.insert((number, loc), made.clone());
        made
    }

    fn new_patch(&self, number: i64, loc: Loc) -> Result<PlacedPatch, ReadIssue> {
        let patch = numbered(&self.doc.surfaces, number, "surface")?;
        if loc == NOWHERE {
            return Ok(PlacedPatch {
                surface: Arc::new(patch.surface.clone()),
                factors: patch.factors,
                reversed: patch.reversed,
                trims: patch.trims,
            });
        }
        let moved = patch.surface.transformed(&self.doc.locations.matrix(loc));
        let moved = moved.ok_or(ReadIssue::NotTransformable { what: "surface" })?;
        let by = moved.factors();
        let trims = patch.trims.map(|b| UvBox::from_points([b.min * by, b.max * by]));
        Ok(PlacedPatch {
            factors: patch.factors * by,
            reversed: patch.reversed != moved.flip_u,
            trims,
            surface: Arc::new(moved.surface),
        })
    }

    /// A curve of the file at a place.
    pub(crate) fn curve(&self, number: i64, loc: Loc) -> Result<Curve, ReadIssue> {
        let curve = &numbered(&self.doc.curves, number, "curve")?.curve;
        if loc == NOWHERE {
            return Ok(curve.clone());
        }
        let moved = curve.transformed(&self.doc.locations.matrix(loc));
        moved.ok_or(ReadIssue::NotTransformable { what: "curve" })
    }

    /// A curve of the file in parameter space, in the parameters of a patch.
    pub(crate) fn pcurve(&self, number: i64, range: Range, patch: &PlacedPatch) -> Result<Pcurve, ReadIssue> {
        let bounded = numbered(&self.doc.curves2, number, "curve in parameter space")?;
        let range = if range.is_finite() && range.start < range.end { range } else { bounded.range };
        if !range.is_finite() || range.start >= range.end {
            return Err(ReadIssue::CurveUnbounded.within("curve in parameter space", number as usize));
        }
        let curve = scaled(&bounded.curve, range, patch.factors)
            .ok_or(ReadIssue::NotTransformable { what: "curve in parameter space" })?;
        Ok(Pcurve { curve: Arc::new(curve), range })
    }
}

fn scaled(curve: &Curve2, range: Range, by: DVec2) -> Option<Curve2> {
    if by == DVec2::ONE {
        return Some(curve.clone());
    }
    curve.scaled(by).or_else(|| curve.to_nurbs(range).ok().and_then(|nurbs| Curve2::Nurbs(nurbs).scaled(by)))
}
