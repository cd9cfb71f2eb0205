//! The parameters of a surface's point closest to a given point.

mod elementary;
mod general;
mod swept;
mod terrain;

use crate::conic::{unwrapped, wrapped};
use crate::{Surface, UvBox};
use general::Grid;
use glam::{DVec2, DVec3};
use std::sync::OnceLock;
use swept::{ExtrusionInverter, RevolutionInverter};
use terrain::Terrain;

/// The closest point of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inversion {
    /// The surface's parameters at the closest point.
    pub uv: DVec2,
    /// From the given point to the surface's point at `uv`, in model units.
    pub distance: f64,
}

/// A surface prepared for many inversions.
///
/// ```
/// use chordal_nurbs::{DVec2, DVec3, Frame, Surface, SurfaceInverter, UvBox};
///
/// let plane = Surface::Plane { frame: Frame::WORLD };
/// let inverter = SurfaceInverter::new(&plane, UvBox::new(DVec2::ZERO, DVec2::ONE));
/// let found = inverter.invert(DVec3::new(0.25, 0.5, 3.0), None);
/// assert_eq!((found.uv, found.distance), (DVec2::new(0.25, 0.5), 3.0));
/// ```
#[derive(Clone, Debug)]
pub struct SurfaceInverter<'a> {
    surface: &'a Surface,
    /// Where closed directions are placed without a hint.
    start: DVec2,
    periods: [Option<f64>; 2],
    method: Method<'a>,
}

#[derive(Clone, Debug)]
enum Method<'a> {
    Elementary,
    Extrusion(ExtrusionInverter<'a>),
    Revolution(RevolutionInverter<'a>),
    /// Samples are taken when first needed.
    Grid {
        terrain: Terrain<'a>,
        grid: OnceLock<Grid>,
        uv: UvBox,
    },
    Offset {
        terrain: Terrain<'a>,
        basis_terrain: Terrain<'a>,
        basis: Box<SurfaceInverter<'a>>,
    },
}

impl Surface {
    /// The parameters of the closest point; closed directions are unrolled to within half a period of `near`,
    /// or else lie in the domain. On an axis or pole the angle is that of `near`, or zero. For many points of
    /// one surface use a [`SurfaceInverter`].
    pub fn invert(&self, p_xyz: DVec3, near: Option<DVec2>) -> DVec2 {
        SurfaceInverter::new(self, self.domain()).invert(p_xyz, near).uv
    }
}

impl<'a> SurfaceInverter<'a> {
    /// Prepares inversions. `uv` is the region of interest: free-form surfaces are sampled there, and
    /// closed directions without a hint are placed in the turn that starts at its lower end. Closest points
    /// are found outside it too as long as they are in the surface's domain.
    pub fn new(surface: &'a Surface, uv: UvBox) -> Self {
        let domain = surface.domain();
        let periods = surface.periods();
        let start = start_of(uv, domain);
        let method = match surface {
            Surface::Extrusion { profile, direction } => {
                Method::Extrusion(ExtrusionInverter::new(profile, *direction, uv.u()))
            }
            Surface::Revolution { profile, axis_origin, axis } => {
                Method::Revolution(RevolutionInverter::new(profile, *axis_origin, *axis, uv.v()))
            }
            Surface::Nurbs(_) => Method::Grid {
                terrain: Terrain::new(surface, periods),
                grid: OnceLock::new(),
                uv: sampled_box(uv, domain, periods),
            },
            Surface::Offset { basis, .. } => Method::Offset {
                terrain: Terrain::new(surface, periods),
                basis_terrain: Terrain::new(basis, periods),
                basis: Box::new(Self::new(basis, uv)),
            },
            _ => Method::Elementary,
        };
        Self { surface, start, periods, method }
    }

    /// The surface that is inverted.
    pub fn surface(&self) -> &'a Surface {
        self.surface
    }

    /// The closest point. With `near`, a close one in its valley is preferred, and closed directions are
    /// unrolled to within half a period of it.
    pub fn invert(&self, p_xyz: DVec3, near: Option<DVec2>) -> Inversion {
        self.invert_within(p_xyz, near, 0.0)
    }

    /// As [`Self::invert`], where a point of the valley of `near` will do that is no farther away than
    /// `enough`: for points that are known to lie off the surface, which would be searched for all over it.
    pub fn invert_within(&self, p_xyz: DVec3, near: Option<DVec2>, enough: f64) -> Inversion {
        let uv = match &self.method {
            Method::Elementary => elementary::invert(self.surface, p_xyz, near),
            Method::Extrusion(inverter) => inverter.invert(p_xyz, near),
            Method::Revolution(inverter) => inverter.invert(p_xyz, near),
            Method::Grid { terrain, grid, uv } => {
                let found = general::invert(terrain, *uv, grid, p_xyz, near, enough);
                return Inversion { uv: self.placed(found.uv, near), ..found };
            }
            Method::Offset { terrain, basis_terrain, basis } => {
                invert_offset(terrain, basis_terrain, basis, p_xyz, near)
            }
        };
        let uv = self.placed(uv, near);
        Inversion { uv, distance: self.surface.point(uv).distance(p_xyz) }
    }

    /// Closed directions in the requested turn.
    fn placed(&self, p_uv: DVec2, near: Option<DVec2>) -> DVec2 {
        let mut placed = p_uv;
        for axis in 0..2 {
            if let Some(period) = self.periods[axis] {
                placed[axis] = match near {
                    Some(near) => unwrapped(p_uv[axis], near[axis], period),
                    None => wrapped(p_uv[axis], self.start[axis], self.start[axis] + period),
                };
            }
        }
        placed
    }
}

/// Normals of an offset are those of its basis, so that a foot on the basis is one on the offset; which of
/// several is closest may differ.
fn invert_offset(
    terrain: &Terrain<'_>,
    basis_terrain: &Terrain<'_>,
    basis: &SurfaceInverter<'_>,
    p: DVec3,
    near: Option<DVec2>,
) -> DVec2 {
    let off = |uv: DVec2| terrain.point(uv).distance(p);
    if let Some(near) = near {
        let foot = general::descend(basis_terrain, p, near).uv;
        if general::is_close(basis_terrain, foot, off(foot)) {
            return foot;
        }
    }
    let foot = basis.invert(p, near).uv;
    if general::is_close(basis_terrain, foot, off(foot)) {
        return foot;
    }
    let starts = [Some(foot), near].into_iter().flatten();
    let found = starts.map(|start| general::descend(terrain, p, start));
    found.min_by(|a, b| a.distance.total_cmp(&b.distance)).map_or(foot, |f| f.uv)
}

/// The lower corner of `uv`, of the domain where that is infinite, or zero.
fn start_of(uv: UvBox, domain: UvBox) -> DVec2 {
    let pick = |axis: usize| {
        [uv.min[axis], domain.min[axis]].into_iter().find(|start| start.is_finite()).unwrap_or(0.0)
    };
    DVec2::new(pick(0), pick(1))
}

/// The part of the domain to sample: `uv` inside it, all of it where nothing would be left.
fn sampled_box(uv: UvBox, domain: UvBox, periods: [Option<f64>; 2]) -> UvBox {
    let mut found = domain;
    for axis in 0..2 {
        if periods[axis].is_some() {
            continue;
        }
        let (low, high) = (uv.min[axis].max(domain.min[axis]), uv.max[axis].min(domain.max[axis]));
        if low < high {
            found.min[axis] = low;
            found.max[axis] = high;
        }
    }
    found
}

#[cfg(test)]
mod tests;
