//! How reports name things of the model.

use chordal_brep::{Face, FaceGeometry, LooseKind};
use chordal_nurbs::{Surface, SurfaceKind};
use chordal_tessellate::Bound;

/// The kind of a face's surface.
pub(crate) fn face_kind(face: &Face) -> &'static str {
    match &face.geometry {
        FaceGeometry::Surface(surface) => surface_kind(surface),
        FaceGeometry::Failed(_) => "unknown",
    }
}

fn surface_kind(surface: &Surface) -> &'static str {
    match surface.kind() {
        SurfaceKind::Plane => "plane",
        SurfaceKind::Cylinder => "cylinder",
        SurfaceKind::Cone => "cone",
        SurfaceKind::Sphere => "sphere",
        SurfaceKind::Torus => "torus",
        SurfaceKind::Extrusion => "extrusion",
        SurfaceKind::Revolution => "revolution",
        SurfaceKind::Nurbs => "nurbs",
        SurfaceKind::Offset => "offset",
    }
}

pub(crate) fn loose_kind(kind: LooseKind) -> &'static str {
    match kind {
        LooseKind::Wire => "wire",
        LooseKind::Point => "point",
    }
}

pub(crate) fn bound_name(bound: Bound) -> &'static str {
    match bound {
        Bound::Proven => "proven",
        Bound::Estimated => "estimated",
    }
}
