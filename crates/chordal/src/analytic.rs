//! The elementary surfaces under faces, for formats that can name them.

use chordal_brep::{FaceGeometry, Part};
use chordal_mesh::{AnalyticFace, FaceMesh, PartMesh};
use chordal_nurbs::{Surface, UvBox, math};

/// One per face of the part: its elementary surface with the extents of its mesh.
pub(crate) fn face_surfaces(part: &Part, mesh: &PartMesh) -> Vec<Option<AnalyticFace>> {
    let of_face = |(face, face_mesh): (&chordal_brep::Face, &FaceMesh)| match &face.geometry {
        FaceGeometry::Surface(surface) if !face_mesh.corners.is_empty() => {
            analytic(surface, UvBox::from_points(face_mesh.corners.iter().map(|c| c.uv)))
        }
        _ => None,
    };
    part.faces.iter().zip(&mesh.faces).map(of_face).collect()
}

fn analytic(surface: &Surface, extent: UvBox) -> Option<AnalyticFace> {
    let (u, v) = ([extent.min.x, extent.max.x], [extent.min.y, extent.max.y]);
    Some(match *surface {
        Surface::Plane { frame } => AnalyticFace::Plane {
            origin: frame.origin,
            normal: frame.z,
            x_dir: frame.x,
            extent_x: u,
            extent_y: v,
        },
        Surface::Cylinder { frame, radius } => AnalyticFace::Cylinder {
            origin: frame.origin,
            axis: frame.z,
            radius,
            extent_angle: u,
            extent_height: v,
        },
        Surface::Cone { frame, radius, half_angle } => {
            // Our v runs along the axis from where the radius is `radius`; the apex lies this far below.
            let below = radius / math::tan(half_angle);
            if !below.is_finite() {
                return None;
            }
            AnalyticFace::Cone {
                apex: frame.origin - frame.z * below,
                axis: frame.z,
                semi_angle: half_angle,
                ref_radius: radius,
                extent_angle: u,
                extent_distance: v.map(|along| along + below),
            }
        }
        Surface::Sphere { frame, radius } => {
            AnalyticFace::Sphere { center: frame.origin, radius, extent_longitude: u, extent_latitude: v }
        }
        Surface::Torus { frame, major, minor } => AnalyticFace::Torus {
            center: frame.origin,
            axis: frame.z,
            major_radius: major,
            minor_radius: minor,
            extent_major_angle: u,
            extent_minor_angle: v,
        },
        _ => return None,
    })
}
