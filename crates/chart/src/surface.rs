//! The surface of a face, evaluated in its chart: charts may reach over the seam of a closed surface.

use chordal_nurbs::{DVec2, DVec3, Pole, Surface, SurfaceInverter, SurfaceJet, UvBox, Wrap};
use std::sync::OnceLock;

/// The surface of one face, with what the stages need often.
#[derive(Debug)]
pub struct FaceSurface<'a> {
    /// The surface itself.
    pub surface: &'a Surface,
    /// The periods of u and v, where the surface is closed.
    pub periods: [Option<f64>; 2],
    /// Sides of the domain that are one point of space.
    pub poles: Vec<Pole>,
    /// Points nearer together than this are one point.
    pub resolution: f64,
    /// Values of u and of v at which the normal changes at once.
    pub creases: [Vec<f64>; 2],
    wrap: Wrap,
    inverter: OnceLock<SurfaceInverter<'a>>,
}

/// The parameters of the point of a surface nearest to some point, with a distance that inversion of the next
/// point may start from.
#[derive(Clone, Copy, Debug)]
pub struct Near {
    /// The parameters.
    pub uv: DVec2,
    /// The distance.
    pub distance: f64,
}

impl Near {
    /// A point of the surface itself.
    pub fn on_surface(uv: DVec2) -> Self {
        Self { uv, distance: 0.0 }
    }
}

/// Inversion is exact to this share of the domain.
const BESIDE_SIDE: f64 = 1e-9;

impl<'a> FaceSurface<'a> {
    /// Control rows closer together than `point` count as a pole.
    pub fn new(surface: &'a Surface, point: f64) -> Self {
        Self {
            surface,
            periods: surface.periods(),
            poles: surface.poles_within(point),
            resolution: point,
            creases: surface.creases(),
            wrap: Wrap::of(surface),
            inverter: OnceLock::new(),
        }
    }

    /// The point of space at this place.
    pub fn point(&self, p_uv: DVec2) -> DVec3 {
        self.wrap.point(self.surface, p_uv)
    }

    /// The parameters of the same point in the domain of the surface.
    pub fn wrapped(&self, p_uv: DVec2) -> DVec2 {
        self.wrap.apply(p_uv)
    }

    /// Point and derivatives at this place.
    pub fn jet(&self, p_uv: DVec2) -> SurfaceJet {
        self.wrap.jet(self.surface, p_uv)
    }

    /// The unit normal at a point whose derivatives are known; zero where it is undefined.
    pub fn normal_at(&self, p_uv: DVec2, jet: &SurfaceJet) -> DVec3 {
        self.surface.normal_of(self.wrap.apply(p_uv), jet).unwrap_or(DVec3::ZERO)
    }

    /// The unit normal; zero where it is undefined.
    pub fn normal(&self, p_uv: DVec2) -> DVec3 {
        self.surface.normal(self.wrap.apply(p_uv)).unwrap_or(DVec3::ZERO)
    }

    /// True for surfaces whose closest point has a closed form: their pcurves need not be read.
    pub fn is_elementary(&self) -> bool {
        use Surface::{Cone, Cylinder, Plane, Sphere, Torus};
        matches!(self.surface, Plane { .. } | Cylinder { .. } | Cone { .. } | Sphere { .. } | Torus { .. })
    }

    /// The parameters of the nearest point, in the period nearest to `near`.
    pub fn invert(&self, p_xyz: DVec3, near: Option<DVec2>) -> DVec2 {
        self.invert_from(p_xyz, near.map(Near::on_surface)).uv
    }

    /// Inverts one point after another, as [`Self::invert`] does. If the last point lay off the surface, a
    /// point that is as far off near the same place is not searched for on the whole surface.
    pub fn invert_from(&self, p_xyz: DVec3, near: Option<Near>) -> Near {
        if self.is_elementary() {
            return Near::on_surface(self.surface.invert(p_xyz, near.map(|n| n.uv)));
        }
        let inverter =
            self.inverter.get_or_init(|| SurfaceInverter::new(self.surface, self.surface.domain()));
        let expected = near.map_or(0.0, |n| n.distance);
        let enough = 2.0 * expected;
        let mut found = inverter.invert_within(p_xyz, near.map(|n| self.wrap.apply(n.uv)), enough);
        found.uv = self.on_side(found.uv);
        Near {
            uv: near.map_or(found.uv, |near| self.nearest_turn(found.uv, near.uv)),
            distance: if found.distance <= enough { expected } else { found.distance },
        }
    }

    /// The parameters of a local minimum of the distance to `p_xyz`, by a few Gauss–Newton steps from
    /// `start`.
    pub fn descend(&self, p_xyz: DVec3, start: DVec2) -> DVec2 {
        const STEPS: usize = 3;
        let mut uv = start;
        for _ in 0..STEPS {
            let jet = self.jet(uv);
            let r = p_xyz - jet.p;
            let (e, f, g) = (jet.du.length_squared(), jet.du.dot(jet.dv), jet.dv.length_squared());
            let (a, b) = (jet.du.dot(r), jet.dv.dot(r));
            let det = e * g - f * f;
            let step = DVec2::new((a * g - b * f) / det, (b * e - a * f) / det);
            if !step.is_finite() {
                break;
            }
            uv += step;
        }
        uv
    }

    /// Moves a place onto a side of the domain if only rounding keeps it off.
    fn on_side(&self, mut p_uv: DVec2) -> DVec2 {
        let UvBox { min, max } = self.domain();
        for axis in 0..2 {
            let rounding = BESIDE_SIDE * (max[axis] - min[axis]);
            for side in [min[axis], max[axis]] {
                if rounding.is_finite() && (p_uv[axis] - side).abs() <= rounding {
                    p_uv[axis] = side;
                }
            }
        }
        p_uv
    }

    /// The place, clamped to the domain in directions that are not closed.
    pub fn inside(&self, p_uv: DVec2) -> DVec2 {
        let held = self.domain().clamp(p_uv);
        DVec2::new(
            if self.periods[0].is_some() { p_uv.x } else { held.x },
            if self.periods[1].is_some() { p_uv.y } else { held.y },
        )
    }

    /// The parameters of the same point, moved by whole periods to be nearest to `near`.
    pub fn nearest_turn(&self, p_uv: DVec2, near: DVec2) -> DVec2 {
        let turn =
            |t: f64, near: f64, period: Option<f64>| period.map_or(t, |p| t + p * ((near - t) / p).round());
        DVec2::new(turn(p_uv.x, near.x, self.periods[0]), turn(p_uv.y, near.y, self.periods[1]))
    }

    /// How far a coordinate lies beyond `value`, at the nearest period of a closed direction.
    pub fn offset_from(&self, axis: usize, value: f64, p_uv: DVec2) -> f64 {
        let off = p_uv[axis] - value;
        self.periods[axis].map_or(off, |p| off - p * (off / p).round())
    }

    /// The pole within `distance` of this point of space.
    pub fn pole_at(&self, p_xyz: DVec3, distance: f64) -> Option<&Pole> {
        self.poles.iter().find(|pole| pole.point.distance(p_xyz) <= distance)
    }

    /// The parameter box of the surface itself.
    pub fn domain(&self) -> UvBox {
        self.surface.domain()
    }
}
