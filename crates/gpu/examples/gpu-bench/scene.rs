//! The scene of the frame measurements: bumpy bicubic sheets side by side, every third one a disc with a
//! hole.

use crate::evaluation::surface;
use chordal_brep::{Face, FaceGeometry, Model, Node, NodeId, Part, PartId, Source};
use chordal_mesh::{Corner, FaceMesh, Origin, PartMesh, Scene, ScenePart};
use chordal_nurbs::{DAffine3, DVec2, DVec3, NurbsSurface, Surface, math};
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::sync::Arc;

/// Surfaces of one part.
const OF_PART: usize = 30;
/// Corners of each loop of a trimmed surface.
const CORNERS: usize = 24;
/// Radii of the loops in a unit square.
const RADII: [f64; 2] = [0.48, 0.2];

/// Surfaces on a square lattice seen from above.
pub struct Scenario {
    pub surfaces: Vec<NurbsSurface>,
}

impl Scenario {
    /// As many surfaces of 4 × 4 control points, each of its own shape.
    pub fn new(count: usize) -> Self {
        let columns = (count as f64).sqrt().ceil() as usize;
        let placed = |k: usize| {
            let sheet = surface(k, 4);
            let corner = DVec3::new((k % columns) as f64, (k / columns) as f64, 0.0) * 3.3;
            let points = sheet.points().iter().map(|p| *p + corner).collect();
            let weights = sheet.weights().map(<[f64]>::to_vec);
            let knots = (sheet.knots_u().to_vec(), sheet.knots_v().to_vec());
            NurbsSurface::new(sheet.degree(), knots.0, knots.1, points, weights).expect("moved, nothing else")
        };
        Self { surfaces: (0..count).map(placed).collect() }
    }

    /// True for every third surface.
    pub fn is_trimmed(index: usize) -> bool {
        index % 3 == 2
    }

    /// The loops of a trimmed surface, outer first; the hole runs the other way round.
    fn loops() -> [Vec<DVec2>; 2] {
        let circle = |radius: f64, sign: f64| -> Vec<DVec2> {
            let at = |k: usize| sign * TAU * k as f64 / CORNERS as f64;
            (0..CORNERS).map(|k| DVec2::splat(0.5) + radius * math::direction(at(k))).collect()
        };
        [circle(RADII[0], 1.0), circle(RADII[1], -1.0)]
    }

    /// A model and a mesh of it that has its loops.
    pub fn model(&self) -> (Model, Scene) {
        let (mut model, mut scene) = (Model::default(), Scene::default());
        for (index, sheets) in self.surfaces.chunks(OF_PART).enumerate() {
            let mut part = Part::default();
            let mut mesh = PartMesh::default();
            for (k, sheet) in sheets.iter().enumerate() {
                push_face(&mut mesh, sheet, Self::is_trimmed(index * OF_PART + k));
                part.faces.push(face(sheet));
            }
            let face_colors = vec![None; sheets.len()];
            scene.parts.push(ScenePart { mesh: Arc::new(mesh), face_colors, ..ScenePart::default() });
            model.parts.push(part);
            model.nodes.push(Node {
                name: String::new(),
                transform: DAffine3::IDENTITY,
                part: Some(PartId(index as u32)),
                children: Vec::new(),
                color: None,
                source: Source::default(),
            });
            scene.nodes.push(chordal_mesh::SceneNode {
                name: String::new(),
                transform: DAffine3::IDENTITY,
                part: Some(index),
                children: Vec::new(),
                color: None,
            });
            model.roots.push(NodeId(index as u32));
            scene.roots.push(index);
        }
        (model, scene)
    }

    /// The same, its first part placed `count` times on a lattice.
    pub fn placed(&self, count: usize) -> (Model, Scene) {
        let (model, mut scene) = self.model();
        let columns = (count as f64).sqrt().ceil() as usize;
        let node = |k: usize| chordal_mesh::SceneNode {
            transform: DAffine3::from_translation(
                DVec3::new((k % columns) as f64, (k / columns) as f64, 0.0) * 7.0,
            ),
            ..scene.nodes[0].clone()
        };
        scene.nodes = (0..count).map(node).collect();
        scene.roots = (0..count).collect();
        (model, scene)
    }

    /// The scene as text that tools/glu_bench.c reads: the number of surfaces and the box; then for each the
    /// control points along each side, the knots, the homogeneous points, the number of loops and each loop's
    /// points.
    pub fn to_text(&self) -> String {
        let points = || self.surfaces.iter().flat_map(|s| s.points());
        let low = points().fold(DVec3::INFINITY, |m, p| m.min(*p));
        let high = points().fold(DVec3::NEG_INFINITY, |m, p| m.max(*p));
        let mut text = format!(
            "{}\n{} {} {}  {} {} {}\n",
            self.surfaces.len(),
            low.x,
            low.y,
            low.z,
            high.x,
            high.y,
            high.z
        );
        // Writing to a string cannot fail.
        for (index, sheet) in self.surfaces.iter().enumerate() {
            let [m, n] = sheet.counts();
            let _ = writeln!(text, "{m} {n}");
            for knots in [sheet.knots_u(), sheet.knots_v()] {
                let line: Vec<String> = knots.iter().map(f64::to_string).collect();
                let _ = writeln!(text, "{}", line.join(" "));
            }
            for (k, p) in sheet.points().iter().enumerate() {
                let w = sheet.weights().map_or(1.0, |w| w[k]);
                let _ = writeln!(text, "{} {} {} {}", p.x * w, p.y * w, p.z * w, w);
            }
            let loops: &[Vec<DVec2>] = if Self::is_trimmed(index) { &Self::loops() } else { &[] };
            let _ = writeln!(text, "{}", loops.len());
            for polygon in loops {
                let _ = writeln!(text, "{}", polygon.len());
                for p in polygon {
                    let _ = writeln!(text, "{} {}", p.x, p.y);
                }
            }
        }
        text
    }
}

fn face(sheet: &NurbsSurface) -> Face {
    Face {
        geometry: FaceGeometry::Surface(Arc::new(Surface::Nurbs(sheet.clone()))),
        same_sense: true,
        flipped: false,
        loops: Vec::new(),
        name: String::new(),
        color: None,
        layer: None,
        source: Source::default(),
    }
}

/// Two triangles, or a ring of them between the loops.
fn push_face(mesh: &mut PartMesh, sheet: &NurbsSurface, trimmed: bool) {
    let (uvs, triangles) = if trimmed {
        let [outer, hole] = Scenario::loops();
        let n = CORNERS as u32;
        // The hole's corner across from outer corner k is the one with the opposite number.
        let across = |k: u32| n + (n - k) % n;
        let ring = (0..n).flat_map(|k| {
            let next = (k + 1) % n;
            [[k, next, across(k)], [next, across(next), across(k)]]
        });
        ([outer, hole].concat(), ring.collect())
    } else {
        let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(DVec2::from);
        (corners.to_vec(), vec![[0, 1, 2], [0, 2, 3]])
    };
    let face = mesh.faces.len() as u32;
    let corner = |uv: DVec2| {
        let jet = sheet.jet(uv);
        mesh.positions.push(jet.p);
        mesh.origins.push(Origin::Face(face));
        let position = mesh.positions.len() as u32 - 1;
        Corner { position, uv, normal: jet.du.cross(jet.dv).normalize_or_zero() }
    };
    let corners = uvs.into_iter().map(corner).collect();
    mesh.faces.push(FaceMesh { face, corners, triangles, quads: 0 });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mesh_covers_what_the_loops_enclose() {
        let scenario = Scenario::new(32);
        let (model, scene) = scenario.model();
        assert_eq!((model.parts.len(), scene.placements().len()), (2, 2));
        let faces: Vec<&FaceMesh> = scene.parts.iter().flat_map(|p| &p.mesh.faces).collect();
        assert_eq!(faces.len(), 32);
        let polygon = |radius: f64| 0.5 * CORNERS as f64 * math::sin(TAU / CORNERS as f64) * radius * radius;
        for (index, face) in faces.into_iter().enumerate() {
            let areas: Vec<f64> = face
                .triangles
                .iter()
                .map(|t| {
                    let [a, b, c] = t.map(|k| face.corners[k as usize].uv);
                    0.5 * (b - a).perp_dot(c - a)
                })
                .collect();
            assert!(areas.iter().all(|&a| a > 0.0), "{index}: a triangle is turned over");
            let wanted =
                if Scenario::is_trimmed(index) { polygon(RADII[0]) - polygon(RADII[1]) } else { 1.0 };
            assert!((areas.iter().sum::<f64>() - wanted).abs() < 1e-12, "{index}: {areas:?}");
        }
    }

    #[test]
    fn the_text_has_every_surface_and_loop() {
        let text = Scenario::new(6).to_text();
        let mut numbers = text.split_whitespace().map(|n| n.parse::<f64>().expect("a number"));
        assert_eq!(numbers.next(), Some(6.0));
        // The box; then sizes, knots, points; two of the six have two closed loops.
        let sheet = 2 + 2 * 8 + 4 * 16 + 1;
        assert_eq!(numbers.count(), 6 + 6 * sheet + 2 * 2 * (1 + 2 * CORNERS));
    }
}
