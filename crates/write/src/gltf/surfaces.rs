//! Elementary surfaces in the coordinates of a mesh.

use super::json::{BrepFace, BrepSurface};
use crate::frame::Frame;
use chordal_mesh::AnalyticFace;
use glam::DVec3;

/// A face's surface as `TM_brep_faces` states it.
pub(super) fn brep_face(face_index: u32, surface: &AnalyticFace, frame: Frame, origin: DVec3) -> BrepFace {
    let convert = Convert { frame, origin };
    let surface = match *surface {
        AnalyticFace::Plane { origin, normal, x_dir, extent_x, extent_y } => BrepSurface::Plane {
            origin: convert.point(origin),
            normal: convert.direction(normal),
            x_dir: convert.direction(x_dir),
            extent_x: convert.lengths(extent_x),
            extent_y: convert.lengths(extent_y),
        },
        AnalyticFace::Cylinder { origin, axis, radius, extent_angle, extent_height } => {
            BrepSurface::Cylinder {
                origin: convert.point(origin),
                axis: convert.direction(axis),
                radius: convert.length(radius),
                extent_angle,
                extent_height: convert.lengths(extent_height),
            }
        }
        AnalyticFace::Cone { apex, axis, semi_angle, ref_radius, extent_angle, extent_distance } => {
            BrepSurface::Cone {
                apex: convert.point(apex),
                axis: convert.direction(axis),
                semi_angle,
                ref_radius: convert.length(ref_radius),
                extent_angle,
                extent_distance: convert.lengths(extent_distance),
            }
        }
        AnalyticFace::Sphere { center, radius, extent_longitude, extent_latitude } => BrepSurface::Sphere {
            center: convert.point(center),
            radius: convert.length(radius),
            extent_longitude,
            extent_latitude,
        },
        AnalyticFace::Torus {
            center,
            axis,
            major_radius,
            minor_radius,
            extent_major_angle,
            extent_minor_angle,
        } => BrepSurface::Torus {
            center: convert.point(center),
            axis: convert.direction(axis),
            major_radius: convert.length(major_radius),
            minor_radius: convert.length(minor_radius),
            extent_major_angle,
            extent_minor_angle,
        },
    };
    BrepFace { face_index, surface }
}

#[derive(Clone, Copy)]
struct Convert {
    frame: Frame,
    /// The mesh's origin in file coordinates.
    origin: DVec3,
}

impl Convert {
    fn point(self, p: DVec3) -> [f64; 3] {
        (self.frame.apply(p) - self.origin).to_array()
    }

    fn direction(self, v: DVec3) -> [f64; 3] {
        (self.frame.rotation * v).to_array()
    }

    fn length(self, length: f64) -> f64 {
        length / self.frame.mm
    }

    fn lengths(self, lengths: [f64; 2]) -> [f64; 2] {
        lengths.map(|l| self.length(l))
    }
}
