//! Steps 2 and 3: faces that reach beyond their edges.

use super::hull::{bulges, support};
use super::{Direction, TightBox};
use crate::placement::PartUse;
use chordal_brep::{Face, FaceGeometry, Part};
use chordal_mesh::{FaceMesh, PartMesh};
use chordal_nurbs::Surface;
use chordal_tessellate::{Bound, Cancel, Options, tessellate_part};
use glam::{DAffine3, DVec2, DVec3};

/// Tolerance of the coarse mesh, relative to the box of the edges.
const COARSE: f64 = 0.01;
/// Samples per side of a triangle that is searched, and how often the search narrows.
const SIDE: usize = 4;
const ZOOMS: usize = 8;
/// Triangles whose sag stands for that of all of a face.
const SPREAD: usize = 100;
/// The accuracy of the search relative to the box: far finer than any percentage that users give.
const MATTERS: f64 = 1e-6;
/// A face that needs more triangles than this at the coarse tolerance will fail later as well, and with a
/// reason.
const GIVE_UP: usize = 100_000;

pub(super) fn include(
    found: &mut TightBox,
    part: &Part,
    part_use: &PartUse,
    options: &Options,
    cancel: &Cancel,
) {
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
    let mut options = options.clone().with_angle(Some(0.6)).with_bound(Bound::Estimated);
    options.tolerance = tolerance;
    options.face_triangles = options.face_triangles.min(GIVE_UP);
    let (mesh, _) = tessellate_part(&coarse, &options, cancel, &|_| ());
    for world in &part_use.worlds {
        mesh.positions.iter().for_each(|&p| found.include(world.transform_point3(p)));
    }
    for (face, face_mesh) in faces.iter().zip(&mesh.faces) {
        let FaceGeometry::Surface(surface) = &face.geometry else { continue };
        let mut facets: Vec<Facet> =
            face_mesh.triangles.iter().map(|t| Facet::of(&mesh, face_mesh, *t)).collect();
        let slack = slack(&mut facets, surface, tolerance);
        for world in &part_use.worlds {
            for direction in Direction::ALL {
                climb(found, surface, &mut facets, slack, world, direction);
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

/// One triangle of the coarse mesh.
struct Facet {
    uv: [DVec2; 3],
    xyz: [DVec3; 3],
    /// From the triangle to the surface, at samples; found when first needed.
    sag: Option<[DVec3; 4]>,
}

impl Facet {
    fn of(mesh: &PartMesh, face: &FaceMesh, triangle: [u32; 3]) -> Self {
        let corners = triangle.map(|c| face.corners[c as usize]);
        Self {
            uv: corners.map(|c| c.uv),
            xyz: corners.map(|c| mesh.positions[c.position as usize]),
            sag: None,
        }
    }

    fn uv_at(&self, st: DVec2) -> DVec2 {
        self.uv[0] + (self.uv[1] - self.uv[0]) * st.x + (self.uv[2] - self.uv[0]) * st.y
    }

    fn sag(&mut self, surface: &Surface) -> [DVec3; 4] {
        if let Some(sag) = self.sag {
            return sag;
        }
        let [a, b, c] = self.xyz;
        let off = |s: f64, t: f64| {
            let st = DVec2::new(s, t);
            surface.point(self.uv_at(st)) - (a + (b - a) * s + (c - a) * t)
        };
        let sag = [(0.5, 0.0), (0.0, 0.5), (0.5, 0.5), (1.0 / 3.0, 1.0 / 3.0)].map(|(s, t)| off(s, t));
        self.sag = Some(sag);
        sag
    }
}

/// How far the surface may rise over the corners of a triangle. The coarse mesh is only estimated to keep its
/// tolerance, so that twice that is looked at; where a spread of triangles sags far less, four times their
/// sag.
fn slack(facets: &mut [Facet], surface: &Surface, tolerance: f64) -> f64 {
    let stride = facets.len() / SPREAD + 1;
    let sag =
        facets.iter_mut().step_by(stride).flat_map(|f| f.sag(surface)).map(DVec3::length).fold(0.0, f64::max);
    (4.0 * sag).min(2.0 * tolerance)
}

/// Searches the triangles that may hold the extreme along one direction, the most promising first.
fn climb(
    found: &mut TightBox,
    surface: &Surface,
    facets: &mut [Facet],
    slack: f64,
    world: &DAffine3,
    direction: Direction,
) {
    let (gradient, constant) = direction.in_part(world);
    let steep = gradient.length();
    let corner =
        |f: &Facet| f.xyz.iter().map(|&p| gradient.dot(p) + constant).fold(f64::NEG_INFINITY, f64::max);
    let near: Vec<&mut Facet> =
        facets.iter_mut().filter(|f| corner(f) + slack * steep > found.extreme(direction)).collect();
    let rise = |sag: [DVec3; 4]| sag.iter().map(|v| gradient.dot(*v)).fold(0.0, f64::max);
    let mut promising: Vec<(f64, &mut Facet)> =
        near.into_iter().map(|f| (corner(f) + 2.0 * rise(f.sag(surface)), f)).collect();
    promising.sort_by(|a, b| b.0.total_cmp(&a.0));
    let matters = MATTERS * found.diagonal();
    for (promise, facet) in promising {
        if promise <= found.extreme(direction) + matters {
            return;
        }
        if let Some(highest) = search(surface, facet, gradient) {
            found.include(world.transform_point3(highest));
        }
    }
}

/// The highest point of the surface over one triangle: a lattice that narrows around its best point.
fn search(surface: &Surface, facet: &Facet, gradient: DVec3) -> Option<DVec3> {
    let (mut center, mut half) = (DVec2::splat(1.0 / 3.0), 1.0);
    let mut best = (f64::NEG_INFINITY, DVec3::NAN);
    for _ in 0..ZOOMS {
        let around = center;
        for i in 0..=SIDE {
            for j in 0..=SIDE {
                let offset = DVec2::new(i as f64, j as f64) * (2.0 / SIDE as f64) - 1.0;
                let st = inside(around + offset * half);
                let p = surface.point(facet.uv_at(st));
                if gradient.dot(p) > best.0 {
                    best = (gradient.dot(p), p);
                    center = st;
                }
            }
        }
        half *= 0.4;
    }
    best.0.is_finite().then_some(best.1)
}

/// The nearest barycentric coordinates inside the triangle, roughly.
fn inside(st: DVec2) -> DVec2 {
    let st = st.clamp(DVec2::ZERO, DVec2::ONE);
    let excess = st.x + st.y - 1.0;
    if excess <= 0.0 { st } else { (st - 0.5 * excess).clamp(DVec2::ZERO, DVec2::ONE) }
}
