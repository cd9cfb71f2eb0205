//! The elementary surfaces that formats with exact faces can name.

use glam::DVec3;

/// An elementary surface under a face, in its part's coordinates; angles in radians, extents those of the
/// face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AnalyticFace {
    /// A plane.
    Plane {
        /// A point of the plane; extents are measured from it.
        origin: DVec3,
        /// The unit normal.
        normal: DVec3,
        /// The unit vector along which `extent_x` is measured.
        x_dir: DVec3,
        /// The least and the largest coordinate along `x_dir`.
        extent_x: [f64; 2],
        /// The least and the largest coordinate along `normal × x_dir`.
        extent_y: [f64; 2],
    },
    /// A circular cylinder.
    Cylinder {
        /// A point of the axis; heights are measured from it.
        origin: DVec3,
        /// The unit vector along the axis.
        axis: DVec3,
        /// The radius.
        radius: f64,
        /// The least and the largest angle.
        extent_angle: [f64; 2],
        /// The least and the largest height along the axis.
        extent_height: [f64; 2],
    },
    /// A circular cone.
    Cone {
        /// The apex.
        apex: DVec3,
        /// The unit vector along the axis, from the apex into the cone.
        axis: DVec3,
        /// The angle between axis and rulings.
        semi_angle: f64,
        /// The radius at the origin of the exact surface.
        ref_radius: f64,
        /// The least and the largest angle.
        extent_angle: [f64; 2],
        /// Along the axis from the apex.
        extent_distance: [f64; 2],
    },
    /// A sphere.
    Sphere {
        /// The centre.
        center: DVec3,
        /// The radius.
        radius: f64,
        /// The least and the largest longitude.
        extent_longitude: [f64; 2],
        /// The least and the largest latitude, −π/2 to π/2.
        extent_latitude: [f64; 2],
    },
    /// A torus.
    Torus {
        /// The centre.
        center: DVec3,
        /// The unit vector along the axis.
        axis: DVec3,
        /// The distance of the tube's centre from the axis.
        major_radius: f64,
        /// The radius of the tube.
        minor_radius: f64,
        /// The least and the largest angle about the axis.
        extent_major_angle: [f64; 2],
        /// The least and the largest angle about the tube.
        extent_minor_angle: [f64; 2],
    },
}
