//! Right-handed orthonormal placements.

use crate::math;
use glam::{DVec2, DVec3};

/// A right-handed orthonormal placement in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// The origin.
    pub origin: DVec3,
    /// The first axis, a unit vector.
    pub x: DVec3,
    /// The second axis, a unit vector.
    pub y: DVec3,
    /// The third axis, a unit vector: `x × y`.
    pub z: DVec3,
}

impl Frame {
    /// The world frame.
    pub const WORLD: Frame = Frame { origin: DVec3::ZERO, x: DVec3::X, y: DVec3::Y, z: DVec3::Z };

    /// A frame with axis `z`; `x_hint` is made orthogonal to it, and replaced where it is parallel.
    /// A zero `z` becomes the world's.
    pub fn new(origin: DVec3, z: DVec3, x_hint: DVec3) -> Self {
        let z = z.try_normalize().unwrap_or(DVec3::Z);
        let flat = x_hint - z * x_hint.dot(z);
        let x = if flat.length_squared() > 1e-20 * x_hint.length_squared() && flat.length_squared() > 0.0 {
            flat.normalize()
        } else {
            z.any_orthonormal_vector()
        };
        Self { origin, x, y: z.cross(x), z }
    }

    /// Coordinates of `p_xyz` in this frame.
    pub fn local(&self, p_xyz: DVec3) -> DVec3 {
        let d = p_xyz - self.origin;
        DVec3::new(d.dot(self.x), d.dot(self.y), d.dot(self.z))
    }

    /// The point with these coordinates in this frame.
    pub fn global(&self, local: DVec3) -> DVec3 {
        self.origin + self.x * local.x + self.y * local.y + self.z * local.z
    }

    /// The unit radial direction at `angle`.
    pub fn radial(&self, angle: f64) -> DVec3 {
        let (s, c) = math::sin_cos(angle);
        self.x * c + self.y * s
    }
}

/// An orthonormal placement in the plane; `y` is `x` turned by a right angle, or its negative where mirrored.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame2 {
    /// The origin.
    pub origin: DVec2,
    /// The first axis, a unit vector.
    pub x: DVec2,
    /// The second axis, a unit vector at right angles to `x`.
    pub y: DVec2,
}

impl Frame2 {
    /// A right-handed frame; a zero `x` becomes the unit axis.
    pub fn new(origin: DVec2, x: DVec2) -> Self {
        let x = x.try_normalize().unwrap_or(DVec2::X);
        Self { origin, x, y: x.perp() }
    }
}
