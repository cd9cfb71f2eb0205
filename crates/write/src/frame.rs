//! From model coordinates (millimetres, Z up) to the file's.

use crate::{UpAxis, WriteOptions};
use glam::{DAffine3, DMat3, DVec3};

/// The file's coordinate system: rotated so that the chosen axis is up, then scaled to its unit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    /// A rotation whose entries are 0 and ±1, so that applying it rounds nothing.
    pub rotation: DMat3,
    /// Millimetres per file unit.
    pub mm: f64,
}

impl Frame {
    pub fn new(options: &WriteOptions) -> Self {
        let mm = options.resolved_unit().millimetres();
        let rotation = match options.resolved_up() {
            UpAxis::Z => DMat3::IDENTITY,
            UpAxis::Y => DMat3::from_cols(DVec3::X, -DVec3::Z, DVec3::Y),
        };
        Self { rotation, mm }
    }

    /// A vector in file coordinates.
    pub fn apply(&self, v: DVec3) -> DVec3 {
        self.rotation * v / self.mm
    }

    /// A transform between two systems, both turned into file coordinates: `F · T · F⁻¹`.
    pub fn conjugate(&self, t: DAffine3) -> DAffine3 {
        DAffine3 {
            matrix3: self.rotation * t.matrix3 * self.rotation.transpose(),
            translation: self.apply(t.translation),
        }
    }
}

/// A part's place in the file.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    world: DAffine3,
    frame: Frame,
    /// Takes outward normals to outward normals, up to their length.
    normals: DMat3,
    /// Whether triangles must be reversed to stay counter-clockwise from outside.
    pub mirrored: bool,
}

impl Place {
    pub fn new(world: DAffine3, frame: Frame) -> Self {
        let m = world.matrix3;
        // The cofactor matrix is det(m)·m⁻ᵀ: it needs no division, so a flattening placement is no special
        // case.
        let cofactor =
            DMat3::from_cols(m.y_axis.cross(m.z_axis), m.z_axis.cross(m.x_axis), m.x_axis.cross(m.y_axis));
        let mirrored = m.determinant() < 0.0;
        let sign = if mirrored { -1.0 } else { 1.0 };
        Self { world, frame, normals: frame.rotation * cofactor * sign, mirrored }
    }

    /// A point of the part, in file coordinates.
    pub fn point(&self, p: DVec3) -> DVec3 {
        self.frame.apply(self.world.transform_point3(p))
    }

    /// A unit normal of the part in file axes, if it has a direction.
    pub fn normal(&self, n: DVec3) -> Option<DVec3> {
        unit(self.normals * n)
    }

    /// A triangle's corners, counter-clockwise from outside after mirroring.
    pub fn winding<T>(&self, [a, b, c]: [T; 3]) -> [T; 3] {
        if self.mirrored { [a, c, b] } else { [a, b, c] }
    }

    /// The same for a polygon; its first corner stays the first.
    pub fn wind<T>(&self, corners: &mut [T]) {
        if self.mirrored {
            corners[1..].reverse();
        }
    }
}

/// The unit vector along `v`, if it has a direction.
pub(crate) fn unit(v: DVec3) -> Option<DVec3> {
    let square = v.length_squared();
    if (1e-200..1e200).contains(&square) {
        return Some(v / square.sqrt());
    }
    // Scaled first: the square of a very short or long vector under- or overflows.
    let largest = v.abs().max_element();
    (largest > 0.0 && largest.is_finite()).then(|| (v / largest).normalize())
}

/// The unit normal of a triangle, or zero where it has none.
pub(crate) fn triangle_normal([a, b, c]: [DVec3; 3]) -> DVec3 {
    unit((b - a).cross(c - a)).unwrap_or(DVec3::ZERO)
}
