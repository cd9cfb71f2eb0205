//! A face's mesh in the parameter space of its surface.

use crate::context::Context;
use crate::halves::Half;
use crate::precision::{ROUNDING, surface_magnitude};
use chordal_mesh::FaceMesh;
use chordal_nurbs::{DVec2, DVec3, Pole, Surface, UvBox, Wrap};
use std::borrow::Cow;

/// A corner on a pole.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AtPole {
    /// The parameter that is constant at the pole.
    pub axis: usize,
    /// Its value there, in the period of the corner.
    pub value: f64,
}

/// A face's mesh in the parameters of its surface.
pub(crate) struct Chart<'a> {
    pub surface: &'a Surface,
    pub mesh: &'a FaceMesh,
    pub uv_box: UvBox,
    pub wrap: Wrap,
    periods: [Option<f64>; 2],
    pub poles: Vec<Pole>,
    /// The poles are points but for rounding, and not sides that are short against the tolerance.
    pub poles_are_points: bool,
    /// For each corner, the pole that it lies on; empty if the surface has no poles.
    at_poles: Vec<Option<AtPole>>,
    /// The surface at every corner.
    pub xyz: Vec<DVec3>,
    /// Its derivatives by u and v there.
    pub derivatives: Vec<[DVec3; 2]>,
    /// Rounding of points on this surface.
    pub rounding: f64,
    /// Triangles run clockwise in the chart.
    pub turned: bool,
}

pub(crate) fn turn(mesh: &FaceMesh, t: &[u32; 3]) -> f64 {
    let [a, b, c] = t.map(|c| mesh.corners[c as usize].uv).map(|uv| robust::Coord { x: uv.x, y: uv.y });
    robust::orient2d(a, b, c)
}

/// How many triangles run clockwise in the chart.
pub(crate) fn turned_triangles(mesh: &FaceMesh) -> usize {
    mesh.triangles.iter().filter(|t| turn(mesh, t) < 0.0).count()
}

impl<'a> Chart<'a> {
    pub fn new(context: &Context<'_>, surface: &'a Surface, mesh: &'a FaceMesh) -> Self {
        Self::of(surface, mesh, context.scale, context.same_point)
    }

    /// The chart of a mesh with coordinates up to `scale`; points within `same_point` may be one vertex.
    pub fn of(surface: &'a Surface, mesh: &'a FaceMesh, scale: f64, same_point: f64) -> Self {
        let mut chart = Self {
            surface,
            mesh,
            uv_box: UvBox::from_points(mesh.corners.iter().map(|c| c.uv)),
            wrap: Wrap::of(surface),
            periods: surface.periods(),
            poles: surface.poles_within(same_point),
            poles_are_points: false,
            at_poles: Vec::new(),
            xyz: Vec::new(),
            derivatives: Vec::new(),
            rounding: ROUNDING * (scale + surface_magnitude(surface)),
            turned: false,
        };
        if !chart.poles.is_empty() {
            chart.poles_are_points = surface.poles_within(chart.rounding).len() == chart.poles.len();
            chart.at_poles = mesh.corners.iter().map(|c| chart.pole_at(c.uv)).collect();
        }
        chart
    }

    pub fn point(&self, p_uv: DVec2) -> DVec3 {
        self.surface.point(self.wrap.apply(p_uv))
    }

    /// The period of a closed direction.
    pub fn period(&self, axis: usize) -> Option<f64> {
        self.periods[axis]
    }

    /// The nearest vector of whole periods.
    pub fn whole_turns(&self, d: DVec2) -> DVec2 {
        let turn = |d: f64, period: Option<f64>| period.map_or(0.0, |p| p * (d / p).round());
        DVec2::new(turn(d.x, self.periods[0]), turn(d.y, self.periods[1]))
    }

    /// The pole that a corner lies on.
    pub fn at_pole(&self, corner: u32) -> Option<AtPole> {
        self.at_poles.get(corner as usize).copied().flatten()
    }

    /// The axis of the pole that a corner lies on.
    pub fn pole_axis(&self, corner: u32) -> Option<usize> {
        self.at_pole(corner).map(|pole| pole.axis)
    }

    fn pole_at(&self, uv: DVec2) -> Option<AtPole> {
        let at = |pole: &Pole| {
            let (t, axis) = (uv[pole.axis], pole.axis);
            let turns = self.periods[axis].map_or(0.0, |p| p * ((t - pole.value) / p).round());
            let value = pole.value + turns;
            let near = 1e-9 * (t.abs() + pole.value.abs() + self.uv_box.size()[axis]);
            ((t - value).abs() <= near).then_some(AtPole { axis, value })
        };
        self.poles.iter().find_map(at)
    }

    /// One end of the half-edge lies on a pole.
    pub fn touches_pole(&self, half: &Half) -> bool {
        self.pole_axis(half.a).or(self.pole_axis(half.b)).is_some()
    }

    /// The corner of a triangle that is its only one on a pole.
    pub fn fan_corner(&self, triangle: &[u32; 3]) -> Option<usize> {
        if self.poles.is_empty() || matches!(self.surface, Surface::Sphere { .. } | Surface::Cone { .. }) {
            return None;
        }
        let at = triangle.map(|c| self.pole_axis(c).is_some());
        let only = at.iter().filter(|&&a| a).count() == 1;
        at.iter().position(|&a| a && only)
    }

    pub fn is_fan(&self, triangle: u32) -> bool {
        self.fan_corner(&self.mesh.triangles[triangle as usize]).is_some()
    }
}

/// The surface that bounds can be given for: offsets of elementary surfaces are elementary themselves.
pub(crate) fn exact(surface: &Surface) -> Cow<'_, Surface> {
    match surface {
        Surface::Offset { .. } => Cow::Owned(surface.clone().simplified()),
        other => Cow::Borrowed(other),
    }
}
