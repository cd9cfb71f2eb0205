//! Surfaces moved by maps that keep shapes.

use crate::curve::similarity;
use crate::{Frame, Surface};
use glam::{DAffine3, DVec2, DVec3};

/// A moved surface and what became of its parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct TransformedSurface {
    /// The moved surface.
    pub surface: Surface,
    /// The parameters (u, v) of the old surface are (−u, v) of the new one. Happens where a mirror meets a
    /// surface with a placement, since placements stay right-handed.
    pub flip_u: bool,
    /// Lengths among the parameters (u and v of a plane, v of a cylinder and a cone) are multiplied by this.
    pub length_scale: f64,
}

impl TransformedSurface {
    /// The parameters on the moved surface of what had the parameters `p_uv`.
    pub fn parameters(&self, p_uv: DVec2) -> DVec2 {
        p_uv * self.factors()
    }

    /// What the two parameters are multiplied by.
    pub fn factors(&self) -> DVec2 {
        let mut by = DVec2::ONE;
        match self.surface.basis() {
            Surface::Plane { .. } => by *= self.length_scale,
            Surface::Cylinder { .. } | Surface::Cone { .. } => by.y *= self.length_scale,
            _ => {}
        }
        if self.flip_u {
            by.x = -by.x;
        }
        by
    }
}

impl Surface {
    /// The surface moved by a map that keeps shapes (turn, shift, uniform scale, mirror); it keeps its kind.
    ///
    /// Angles and free-form parameters stay as they are; lengths are scaled and a mirror turns `u` round on
    /// surfaces with a placement other than planes: see [`TransformedSurface::parameters`]. The normal Su ×
    /// Sv then points to the other side of the moved material where the map mirrors and the parameters do not
    /// flip, and to the same side where they do. `None` where the map distorts and the surface is not NURBS,
    /// or collapses.
    pub fn transformed(&self, by: &DAffine3) -> Option<TransformedSurface> {
        if let Surface::Nurbs(nurbs) = self {
            let surface = Surface::Nurbs(nurbs.transformed(by));
            return Some(TransformedSurface { surface, flip_u: false, length_scale: 1.0 });
        }
        let signed = similarity(by)?;
        let (scale, mirrored) = (signed.abs(), signed < 0.0);
        let place = |f: &Frame| moved_frame(f, by, mirrored);
        let (surface, flip_u) = match self {
            Surface::Plane { frame: f } => {
                // A plane keeps both axes: its normal is what turns.
                let x = by.transform_vector3(f.x).normalize();
                let z = x.cross(by.transform_vector3(f.y)).normalize();
                let frame = Frame { origin: by.transform_point3(f.origin), x, y: z.cross(x), z };
                (Surface::Plane { frame }, false)
            }
            Surface::Cylinder { frame, radius } => {
                (Surface::Cylinder { frame: place(frame), radius: radius * scale }, mirrored)
            }
            Surface::Cone { frame, radius, half_angle } => {
                let frame = place(frame);
                (Surface::Cone { frame, radius: radius * scale, half_angle: *half_angle }, mirrored)
            }
            Surface::Sphere { frame, radius } => {
                (Surface::Sphere { frame: place(frame), radius: radius * scale }, mirrored)
            }
            Surface::Torus { frame, major, minor } => {
                let frame = place(frame);
                (Surface::Torus { frame, major: major * scale, minor: minor * scale }, mirrored)
            }
            Surface::Extrusion { profile, direction } => {
                let direction = by.transform_vector3(*direction);
                (Surface::Extrusion { profile: profile.transformed(by)?, direction }, false)
            }
            Surface::Revolution { profile, axis_origin, axis } => {
                // Turning the axis round as a mirror does keeps the angle's sense.
                let axis = by.transform_vector3(*axis).normalize_or(DVec3::Z) * signed.signum();
                let axis_origin = by.transform_point3(*axis_origin);
                (Surface::Revolution { profile: profile.transformed(by)?, axis_origin, axis }, false)
            }
            Surface::Offset { basis, distance } => {
                let moved = basis.transformed(by)?;
                // A mirror that keeps the parameters turns the normal round.
                let side = if mirrored && !moved.flip_u { -1.0 } else { 1.0 };
                let surface =
                    Surface::Offset { basis: Box::new(moved.surface), distance: distance * scale * side };
                (surface, moved.flip_u)
            }
            Surface::Nurbs(_) => return None,
        };
        Some(TransformedSurface { surface, flip_u, length_scale: scale })
    }

    /// The surface under all offsets.
    fn basis(&self) -> &Surface {
        match self {
            Surface::Offset { basis, .. } => basis.basis(),
            other => other,
        }
    }
}

/// The frame moved, its axis kept; where mirrored its y turned round to keep it right-handed.
fn moved_frame(f: &Frame, by: &DAffine3, mirrored: bool) -> Frame {
    let z = by.transform_vector3(f.z).normalize();
    let hint = by.transform_vector3(f.x);
    let x = (hint - z * hint.dot(z)).normalize();
    debug_assert!(mirrored == (x.cross(by.transform_vector3(f.y)).dot(z) < 0.0));
    Frame { origin: by.transform_point3(f.origin), x, y: z.cross(x), z }
}
