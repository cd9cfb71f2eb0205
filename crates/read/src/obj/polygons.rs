//! Polygons, by the object, group and material that they belong to.

use crate::polygons::triangulate;
use chordal_brep::{Source, TessellatedItem};
use chordal_nurbs::DVec3;
use rustc_hash::FxHashMap;

/// Triangles under construction; the points that they use, in the order of their first use.
#[derive(Debug, Default)]
pub(super) struct Polygons {
    item: TessellatedItem,
    places: FxHashMap<usize, u32>,
}

impl Polygons {
    /// Adds a polygon of positions in `points`, which exist.
    pub(super) fn add(&mut self, corners: &[usize], points: &[DVec3], name: &str, source: Source) {
        if self.item.points.is_empty() {
            name.clone_into(&mut self.item.name);
            self.item.source = source;
        }
        let mut own = Vec::with_capacity(corners.len());
        for &corner in corners {
            let next = self.item.points.len() as u32;
            let place = *self.places.entry(corner).or_insert(next);
            if place == next {
                self.item.points.push(points[corner]);
            }
            own.push(place);
        }
        triangulate(&self.item.points, &own, &mut self.item.triangles);
    }

    /// What was added since the last time, if it has triangles.
    pub(super) fn take(&mut self) -> Option<TessellatedItem> {
        let all = std::mem::take(self);
        (!all.item.triangles.is_empty()).then_some(all.item)
    }
}
