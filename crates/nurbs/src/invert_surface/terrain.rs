//! Where a descent may go: the domain, its closed directions, and the creases that cut it into smooth cells.

use crate::conic::wrapped;
use crate::curve::surface_lines;
use crate::{Surface, SurfaceJet, UvBox};
use glam::{DVec2, DVec3};

/// A surface with what bounds a descent on it.
#[derive(Clone, Debug)]
pub(super) struct Terrain<'a> {
    pub surface: &'a Surface,
    pub domain: UvBox,
    pub periods: [Option<f64>; 2],
    /// Ends of the domain and the creases between them.
    stops: [Vec<f64>; 2],
}

impl<'a> Terrain<'a> {
    pub fn new(surface: &'a Surface, periods: [Option<f64>; 2]) -> Self {
        let domain = surface.domain();
        let mut stops = surface_lines(surface, domain, 1);
        for (axis, lines) in stops.iter_mut().enumerate() {
            lines.insert(0, domain.min[axis]);
            lines.push(domain.max[axis]);
        }
        Self { surface, domain, periods, stops }
    }

    /// The same place inside the domain.
    pub fn inside(&self, mut uv: DVec2) -> DVec2 {
        for axis in 0..2 {
            if self.periods[axis].is_some() {
                uv[axis] = wrapped(uv[axis], self.domain.min[axis], self.domain.max[axis]);
            }
        }
        uv
    }

    pub fn jet(&self, uv: DVec2) -> SurfaceJet {
        self.surface.jet(self.inside(uv))
    }

    pub fn point(&self, uv: DVec2) -> DVec3 {
        self.surface.point(self.inside(uv))
    }

    /// The smooth cell around a place inside the domain. Its upper ends stay below the creases, where
    /// derivatives are those of the cell; closed directions without creases have no ends.
    pub fn cell(&self, uv: DVec2) -> UvBox {
        let mut cell = self.domain;
        for axis in 0..2 {
            let stops = &self.stops[axis];
            if stops.len() == 2 {
                if self.periods[axis].is_some() {
                    cell.min[axis] = f64::NEG_INFINITY;
                    cell.max[axis] = f64::INFINITY;
                }
                continue;
            }
            let i = stops[1..stops.len() - 1].partition_point(|s| *s <= uv[axis]);
            cell.min[axis] = stops[i];
            cell.max[axis] = if i + 2 == stops.len() { stops[i + 1] } else { stops[i + 1].next_down() };
        }
        cell
    }

    /// Where the descent may go on from a place on a cell's border: the cells beyond the creases that it lies
    /// on.
    pub fn beyond(&self, uv: DVec2, cell: UvBox) -> impl Iterator<Item = DVec2> {
        let mut found = [None; 2];
        for axis in 0..2 {
            if self.stops[axis].len() == 2 {
                continue;
            }
            let (start, end) = (self.domain.min[axis], self.domain.max[axis]);
            let closed = self.periods[axis].is_some();
            let other = if uv[axis] <= cell.min[axis] {
                if cell.min[axis] > start { Some(cell.min[axis].next_down()) } else { closed.then_some(end) }
            } else if uv[axis] >= cell.max[axis] {
                if cell.max[axis] < end { Some(cell.max[axis].next_up()) } else { closed.then_some(start) }
            } else {
                None
            };
            found[axis] = other.map(|w| {
                let mut next = uv;
                next[axis] = w;
                next
            });
        }
        found.into_iter().flatten()
    }
}
