//! Steps 2 and 3: faces that reach beyond their edges.

use super::hull::{bulges, support};
use super::{Direction, TightBox};
use crate::placement::PartUse;
use chordal_brep::{Face, FaceGeometry, Part};
use chordal_nurbs::Surface;
use chordal_tessellate::{Bound, Cancel, Options, tessellate_part};
use glam::{DAffine3, DVec2, DVec3};
use std::time::Duration;

/// Tolerance of the coarse mesh, relative to the box of the edges.
const COARSE: f64 = 0.01;
/// Samples per side of a triangle that is searched, and how often the search narrows.
const SIDE: usize = 6;
const ZOOMS: usize = 8;
/// A face that cannot be meshed coarsely in this time will fail later as well, and with a reason.
const GIVE_UP: Duration = Duration::from_secs(20);

pub(super) fn include(found: &mut TightBox, part: &Part, part_use: &PartUse, cancel: &Cancel) {
    let faces: Vec<&Face> = part.faces.iter().filter(|f| reaches_out(f, found, part_use)).collect();
    if faces.is_empty() {
        return;
    }
    let coarse = Part {
        name: part.name.clone(),
        vertices: part.vertices.clone(),
        edges: part.edges.clone(),
        faces: faces.iter().map(|&f| f.clone()).collect(),
        uncertainty: part.uncertainty,
        ..Part::default()
    };
    // A model without edges (a full sphere) has no size yet: its surfaces have.
    let outer = outer_size(&faces, part_use);
    let size = if found.diagonal() > 1e-6 * outer { found.diagonal() } else { outer };
    let tolerance = COARSE * size / part_use.scale;
    if !(tolerance > 0.0 && tolerance.is_finite()) {
        return;
    }
    let options = Options::new(tolerance)
        .with_angle(Some(0.6))
        .with_bound(Bound::Estimated)
        .with_face_timeout(Some(GIVE_UP));
    let (mesh, _) = tessellate_part(&coarse, &options, cancel, &|_| ());
    for world in &part_use.worlds {
        mesh.positions.iter().for_each(|&p| found.include(world.transform_point3(p)));
    }
    for (face, face_mesh) in faces.iter().zip(&mesh.faces) {
        let FaceGeometry::Surface(surface) = &face.geometry else { continue };
        for triangle in &face_mesh.triangles {
            let corners = triangle.map(|c| face_mesh.corners[c as usize]);
            let uv = corners.map(|c| c.uv);
            let xyz = corners.map(|c| mesh.positions[c.position as usize]);
            for world in &part_use.worlds {
                Direction::ALL.iter().for_each(|&d| search(found, surface, uv, xyz, tolerance, world, d));
            }
        }
    }
}

/// True where the whole surface of the face leaves the box in some placement.
fn reaches_out(face: &Face, found: &TightBox, part_use: &PartUse) -> bool {
    let FaceGeometry::Surface(surface) = &face.geometry else { return false };
    bulges(surface)
        && part_use.worlds.iter().any(|world| {
            let slack = 1e-6 * found.diagonal();
            Direction::ALL.iter().any(|&d| {
                let (gradient, constant) = d.in_part(world);
                support(surface, gradient) + constant > found.extreme(d) + slack
            })
        })
}

/// The size of the largest of the surfaces, in millimetres.
fn outer_size(faces: &[&Face], part_use: &PartUse) -> f64 {
    let width = |surface: &Surface| {
        DVec3::AXES
            .map(|axis| support(surface, axis) + support(surface, -axis))
            .into_iter()
            .fold(0.0, f64::max)
    };
    let of_face = |face: &&Face| match &face.geometry {
        FaceGeometry::Surface(surface) => Some(width(surface)).filter(|w| w.is_finite()),
        FaceGeometry::Failed(_) => None,
    };
    faces.iter().filter_map(of_face).fold(0.0, f64::max) * part_use.scale
}

/// Climbs on the exact surface over one triangle, where it can matter.
fn search(
    found: &mut TightBox,
    surface: &Surface,
    uv: [DVec2; 3],
    xyz: [DVec3; 3],
    tolerance: f64,
    world: &DAffine3,
    direction: Direction,
) {
    let (gradient, constant) = direction.in_part(world);
    let value = |p: DVec3| gradient.dot(p) + constant;
    let highest = xyz.iter().map(|&p| value(p)).fold(f64::NEG_INFINITY, f64::max);
    // The coarse mesh is only estimated to keep its tolerance: twice that is looked at.
    if highest + 2.0 * tolerance * gradient.length() <= found.extreme(direction) {
        return;
    }
    let point = |s: f64, t: f64| surface.point(uv[0] + (uv[1] - uv[0]) * s + (uv[2] - uv[0]) * t);
    let (mut center, mut half) = (DVec2::splat(1.0 / 3.0), 1.0);
    let mut best = (f64::NEG_INFINITY, DVec3::NAN);
    for _ in 0..ZOOMS {
        let around = center;
        for i in 0..=SIDE {
            for j in 0..=SIDE {
                let offset = DVec2::new(i as f64, j as f64) * (2.0 / SIDE as f64) - 1.0;
                let st = inside(around + offset * half);
                let p = point(st.x, st.y);
                if value(p) > best.0 {
                    best = (value(p), p);
                    center = st;
                }
            }
        }
        half *= 0.4;
    }
    if best.0.is_finite() {
        found.include(world.transform_point3(best.1));
    }
}

/// The nearest barycentric coordinates inside the triangle, roughly.
fn inside(st: DVec2) -> DVec2 {
    let st = st.clamp(DVec2::ZERO, DVec2::ONE);
    let excess = st.x + st.y - 1.0;
    if excess <= 0.0 { st } else { (st - 0.5 * excess).clamp(DVec2::ZERO, DVec2::ONE) }
}
