//! The elementary surfaces that formats with exact faces can name.

use glam::DVec3;

/// An elementary surface under a face, in its part's coordinates; angles in radians, extents those of the face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AnalyticFace {
    Plane {
        origin: DVec3,
        normal: DVec3,
        x_dir: DVec3,
        extent_x: [f64; 2],
        extent_y: [f64; 2],
    },
    Cylinder {
        origin: DVec3,
        axis: DVec3,
        radius: f64,
        extent_angle: [f64; 2],
        extent_height: [f64; 2],
    },
    Cone {
        apex: DVec3,
        axis: DVec3,
        semi_angle: f64,
        ref_radius: f64,
        extent_angle: [f64; 2],
        /// Along the axis from the apex.
        extent_distance: [f64; 2],
    },
    Sphere {
        center: DVec3,
        radius: f64,
        extent_longitude: [f64; 2],
        extent_latitude: [f64; 2],
    },
    Torus {
        center: DVec3,
        axis: DVec3,
        major_radius: f64,
        minor_radius: f64,
        extent_major_angle: [f64; 2],
        extent_minor_angle: [f64; 2],
    },
}
