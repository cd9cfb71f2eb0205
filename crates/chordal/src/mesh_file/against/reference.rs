//! The fine mesh that stands for a model in a comparison, with the exact face behind each of its triangles.
//!
//! The distance of a point from the fine mesh is that from the model to within the error of the fine mesh. So
//! where it matters, the nearest point of the fine mesh is only the start: Gauss–Newton from its parameters
//! leads to the nearest point of the exact surface there, and the shorter of the two distances is taken. What
//! the edges of the file lie off its surfaces is no error of a mesh: each distance is also given without it.

use crate::meshed_part::MeshedPart;
use crate::names::face_kind;
use crate::report::entity_name;
use crate::resolve::Resolved;
use chordal_audit::{Nearest, TriangleTree};
use chordal_brep::{Face, FaceGeometry, Model, Part};
use chordal_mesh::FaceMesh;
use chordal_nurbs::{DAffine3, DVec2, DVec3, Surface, Wrap};
use rayon::prelude::*;

/// Steps of Gauss–Newton: the start is within the error of the fine mesh, and each step about doubles the
/// digits.
const STEPS: usize = 6;

/// The nearest point of the surface may be this many times as far from the nearest point of the fine mesh as
/// the point itself: farther, and it has left the face.
const SLIDE: f64 = 2.0;

/// Points refined together before the largest distance is looked at again.
const BLOCK: usize = 1024;

/// The largest distance of some points.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Farthest {
    pub distance: f64,
    /// The largest after what the file is loose by at each point is subtracted.
    pub beyond_gap: f64,
}

impl Farthest {
    pub fn larger(self, other: Self) -> Self {
        Self {
            distance: self.distance.max(other.distance),
            beyond_gap: self.beyond_gap.max(other.beyond_gap),
        }
    }
}

/// One placed face with triangles.
pub(super) struct PlacedFace<'a> {
    pub face: &'a Face,
    pub part: &'a Part,
    mesh: &'a FaceMesh,
    meshed: &'a MeshedPart,
    world: DAffine3,
    from_world: DAffine3,
    /// How far the face's edges lie off its surface, in millimetres.
    gap: f64,
}

/// The fine mesh of a whole model, in millimetres.
pub(super) struct Reference<'a> {
    pub faces: Vec<PlacedFace<'a>>,
    pub triangles: Vec<[DVec3; 3]>,
    pub tree: TriangleTree,
    /// Of each triangle, its placed face and its place there.
    owners: Vec<(u32, u32)>,
}

impl<'a> Reference<'a> {
    pub fn new(model: &'a Model, resolved: &Resolved, parts: &'a [MeshedPart]) -> Self {
        let mut faces = Vec::new();
        for ((part, meshed), part_use) in model.parts.iter().zip(parts).zip(&resolved.uses) {
            for world in &part_use.worlds {
                let with_triangles = part.faces.iter().zip(&meshed.mesh.faces).enumerate();
                for (index, (face, mesh)) in with_triangles.filter(|(_, (_, m))| !m.triangles.is_empty()) {
                    let gap = meshed.report.faces.get(index).map_or(0.0, |f| f.gap) * part_use.scale;
                    let (world, from_world) = (*world, world.inverse());
                    faces.push(PlacedFace { face, part, mesh, meshed, world, from_world, gap });
                }
            }
        }
        let mut triangles = Vec::new();
        let mut owners = Vec::new();
        for (f, face) in faces.iter().enumerate() {
            triangles.extend(face.mesh.triangles.iter().map(|t| t.map(|c| face.corner(c))));
            owners.extend((0..face.mesh.triangles.len()).map(|t| (f as u32, t as u32)));
        }
        let tree = TriangleTree::new(triangles.clone());
        Self { faces, triangles, tree, owners }
    }

    /// The largest distance of any of the points from the exact faces.
    pub fn farthest(&self, points: &[DVec3]) -> Farthest {
        let found: Vec<(Nearest, DVec3)> =
            points.par_iter().filter_map(|&p| self.tree.nearest(p).map(|n| (n, p))).collect();
        Farthest {
            distance: self.largest(&found, &|_| 0.0),
            beyond_gap: self.largest(&found, &|nearest| self.gap_at(nearest)),
        }
    }

    /// The largest distance after what is loose at each point is subtracted.
    fn largest(&self, found: &[(Nearest, DVec3)], loose: &(dyn Fn(&Nearest) -> f64 + Sync)) -> f64 {
        let mut all: Vec<(f64, &(Nearest, DVec3))> =
            found.par_iter().map(|one| (one.0.distance - loose(&one.0), one)).collect();
        all.par_sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut largest = 0.0f64;
        for block in all.chunks(BLOCK) {
            // Refined distances are no larger, and the next ones are smaller still.
            if block[0].0 <= largest {
                break;
            }
            let refined = block.par_iter().map(|(_, (n, p))| self.refined(*p, n) - loose(n));
            largest = largest.max(refined.reduce(|| 0.0, f64::max));
        }
        largest
    }

    fn gap_at(&self, nearest: &Nearest) -> f64 {
        self.faces[self.owners[nearest.index].0 as usize].gap
    }

    /// The distance of `p` from the exact surface near the nearest point of the fine mesh, where that is
    /// smaller.
    fn refined(&self, p: DVec3, nearest: &Nearest) -> f64 {
        let (face, triangle) = self.owners[nearest.index];
        let face = &self.faces[face as usize];
        let start = TriangleTree::closest_point(p, nearest.triangle);
        let corners = face.mesh.triangles[triangle as usize].map(|c| face.mesh.corners[c as usize].uv);
        let Some(uv) = interpolated(start, nearest.triangle, corners) else { return nearest.distance };
        let Some(q) = face.descend(p, uv) else { return nearest.distance };
        if q.distance(start) > SLIDE * nearest.distance {
            return nearest.distance;
        }
        nearest.distance.min(p.distance(q))
    }
}

impl PlacedFace<'_> {
    fn corner(&self, corner: u32) -> DVec3 {
        let position = self.mesh.corners[corner as usize].position;
        self.world.transform_point3(self.meshed.mesh.positions[position as usize])
    }

    /// The largest distance of a corner, which lies on the exact face, from a mesh; and the number of corners.
    pub fn distance_from(&self, mesh: &TriangleTree) -> (Farthest, usize) {
        let n = self.mesh.corners.len();
        let distances = (0..n as u32).map(|c| mesh.distance(self.corner(c), f64::INFINITY));
        let distance = distances.fold(0.0, f64::max);
        (Farthest { distance, beyond_gap: (distance - self.gap).max(0.0) }, n)
    }

    pub fn id(&self) -> String {
        entity_name(self.face.source).unwrap_or_default()
    }

    pub fn kind(&self) -> String {
        face_kind(self.face).into()
    }

    /// The nearest point of the exact surface, by Gauss–Newton from `uv`.
    fn descend(&self, p: DVec3, mut uv: DVec2) -> Option<DVec3> {
        let FaceGeometry::Surface(surface) = &self.face.geometry else { return None };
        let surface: &Surface = surface;
        let wrap = Wrap::of(surface);
        let domain = surface.domain();
        let periods = surface.periods();
        let p = self.from_world.transform_point3(p);
        for _ in 0..STEPS {
            let (s, du, dv) = surface.jet1(wrap.apply(uv));
            let r = p - s;
            let (a, b, c) = (du.length_squared(), du.dot(dv), dv.length_squared());
            let det = a * c - b * b;
            if det.is_nan() || det <= 1e-12 * a * c {
                return None;
            }
            let (x, y) = (r.dot(du), r.dot(dv));
            uv += DVec2::new(c * x - b * y, a * y - b * x) / det;
            for axis in (0..2).filter(|&axis| periods[axis].is_none()) {
                uv[axis] = uv[axis].clamp(domain.min[axis], domain.max[axis]);
            }
        }
        Some(self.world.transform_point3(surface.point(wrap.apply(uv))))
    }
}

/// The parameters of a point of a triangle; `None` where the triangle has no area.
fn interpolated(p: DVec3, [a, b, c]: [DVec3; 3], uv: [DVec2; 3]) -> Option<DVec2> {
    let n = (b - a).cross(c - a);
    let whole = n.length_squared();
    if whole == 0.0 {
        return None;
    }
    let share = |q: DVec3, r: DVec3| (q - p).cross(r - p).dot(n) / whole;
    Some(uv[0] * share(b, c) + uv[1] * share(c, a) + uv[2] * share(a, b))
}
