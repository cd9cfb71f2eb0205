//! Small scenes, and what is measured on the soups that they come back as.
#![allow(dead_code)] // Every test file uses its own part of this.

use chordal_mesh::{
    Corner, FaceMesh, Origin, PartMesh, PassThrough, Scene, SceneNode, ScenePart, TriangleSoup, import_bytes,
};
use chordal_write::{Format, WriteOptions, WriteSummary, write_to};
use glam::{DAffine3, DQuat, DVec2, DVec3};
use std::collections::BTreeMap;
use std::sync::Arc;

pub const FORMATS: [Format; 7] = [
    Format::StlBinary,
    Format::StlAscii,
    Format::Glb,
    Format::Gltf,
    Format::Obj,
    Format::Ply,
    Format::ThreeMf,
];

pub const RED: [f32; 4] = [1.0, 0.0, 0.0, 1.0];
pub const GLASS: [f32; 4] = [0.0, 0.5, 1.0, 0.25];

/// An axis-aligned box: 8 shared positions, 6 faces of 4 corners and 2 triangles, 12 edges. A ninth position
/// is unused.
pub fn box_mesh(low: DVec3, high: DVec3) -> PartMesh {
    let corner = |i: usize| {
        let pick = |bit: usize, axis: usize| if i >> bit & 1 == 1 { high[axis] } else { low[axis] };
        DVec3::new(pick(0, 0), pick(1, 1), pick(2, 2))
    };
    let mut positions: Vec<_> = (0..8).map(corner).collect();
    positions.push(DVec3::splat(1e6));
    let quads = [
        ([0, 4, 6, 2], -DVec3::X),
        ([1, 3, 7, 5], DVec3::X),
        ([0, 1, 5, 4], -DVec3::Y),
        ([2, 6, 7, 3], DVec3::Y),
        ([0, 2, 3, 1], -DVec3::Z),
        ([4, 5, 7, 6], DVec3::Z),
    ];
    let face = |(face, (quad, normal)): (usize, &([u32; 4], DVec3))| FaceMesh {
        face: face as u32,
        corners: quad.iter().map(|&position| Corner { position, uv: DVec2::ZERO, normal: *normal }).collect(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        quads: 0,
    };
    let faces = quads.iter().enumerate().map(face).collect();
    let pairs =
        [[0, 1], [2, 3], [4, 5], [6, 7], [0, 2], [1, 3], [4, 6], [5, 7], [0, 4], [1, 5], [2, 6], [3, 7]];
    PartMesh {
        origins: vec![Origin::Vertex(0); 9],
        positions,
        faces,
        edges: pairs.map(|p| p.to_vec()).to_vec(),
    }
}

pub fn part(name: &str, mesh: PartMesh) -> ScenePart {
    let faces = mesh.faces.len();
    ScenePart {
        name: name.to_owned(),
        mesh: Arc::new(mesh),
        face_colors: vec![None; faces],
        face_names: vec![String::new(); faces],
        face_bodies: vec![0; faces],
        body_names: vec!["body".to_owned()],
        ..ScenePart::default()
    }
}

pub fn node(name: &str, transform: DAffine3, part: Option<usize>, children: &[usize]) -> SceneNode {
    SceneNode { name: name.to_owned(), transform, part, children: children.to_vec(), color: None }
}

/// One placed part.
pub fn single(part: ScenePart, transform: DAffine3) -> Scene {
    Scene {
        name: "model".to_owned(),
        parts: vec![part],
        nodes: vec![node("root", transform, Some(0), &[])],
        roots: vec![0],
    }
}

pub fn cube() -> Scene {
    single(part("cube", box_mesh(DVec3::ZERO, DVec3::ONE)), DAffine3::IDENTITY)
}

/// A rotation whose numbers are the same on every platform.
fn rotation(axis: DVec3, angle: f64) -> DAffine3 {
    let (sine, cosine) = libm::sincos(0.5 * angle);
    DAffine3::from_quat(DQuat::from_vec4((axis * sine).extend(cosine)))
}

/// Two parts: a brick placed three times (turned and moved, mirrored below an assembly, coloured by one), and
/// a sheet that came tessellated. Some faces have colours and names. Lengths are inches turned into
/// millimetres by the root.
pub fn assembly() -> Scene {
    let mut brick =
        part("brick & \"mortar\"", box_mesh(DVec3::new(0.5, -1.0, 2.0), DVec3::new(1.7, 3.0, 2.3)));
    brick.face_colors[1] = Some(RED);
    brick.face_colors[2] = Some(GLASS);
    brick.face_colors[3] = Some(RED);
    brick.face_names[0] = "left side".to_owned();
    let mut sheet = part("", PartMesh::default());
    sheet.pass_through.push(PassThrough {
        name: "scan".to_owned(),
        points: vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(1.0, 1.0, 0.5)],
        triangles: vec![[0, 1, 2], [2, 1, 3]],
        normals: Vec::new(),
        color: Some(GLASS),
    });
    let inch = DAffine3::from_scale(DVec3::splat(25.4));
    let turned = rotation(DVec3::Z, 0.3) * DAffine3::from_translation(DVec3::new(5.0, -1.0, 0.25));
    let mirror = DAffine3::from_scale(DVec3::new(1.0, -1.0, 1.0));
    let moved = rotation(DVec3::new(1.0, 2.0, 2.0) / 3.0, 1.1);
    let mut painted = node("painted", DAffine3::from_translation(DVec3::new(0.0, 9.0, 0.0)), Some(0), &[4]);
    painted.color = Some(GLASS);
    Scene {
        name: "assembly".to_owned(),
        parts: vec![brick, sheet],
        nodes: vec![
            node("top", inch, None, &[1, 2, 3]),
            node("first", turned, Some(0), &[]),
            node("mirrored", mirror, None, &[5]),
            painted,
            node("scan", moved, Some(1), &[]),
            node("second", moved, Some(0), &[]),
        ],
        roots: vec![0],
    }
}

pub fn write(scene: &Scene, options: &WriteOptions) -> (Vec<u8>, WriteSummary) {
    let mut bytes = Vec::new();
    let summary = write_to(scene, &mut bytes, options).unwrap();
    assert_eq!(summary.bytes, bytes.len() as u64);
    (bytes, summary)
}

/// Writes and reads back.
pub fn round_trip(scene: &Scene, options: &WriteOptions) -> TriangleSoup {
    let (bytes, _) = write(scene, options);
    import_bytes(&bytes, options.format.extension()).unwrap()
}

/// The triangles that a scene means, in millimetres and Z up, corner by corner, turned where mirrored.
pub fn expected(scene: &Scene) -> Vec<[DVec3; 3]> {
    let mut triangles = Vec::new();
    for placed in scene.placements() {
        let part = &scene.parts[placed.part];
        let mut add = |[a, b, c]: [DVec3; 3]| {
            let [a, b, c] = [a, b, c].map(|p| placed.world.transform_point3(p));
            triangles.push(if placed.world.matrix3.determinant() < 0.0 { [a, c, b] } else { [a, b, c] });
        };
        for face in &part.mesh.faces {
            for t in &face.triangles {
                add(t.map(|c| part.mesh.positions[face.corners[c as usize].position as usize]));
            }
        }
        for pass in &part.pass_through {
            pass.triangles.iter().for_each(|t| add(t.map(|p| pass.points[p as usize])));
        }
    }
    triangles
}

/// A triangle starting at its least corner: cyclic order does not matter.
fn canonical(t: [DVec3; 3]) -> [DVec3; 3] {
    let key = |p: DVec3| p.to_array().map(|c| (c * 64.0).round() as i64);
    let least = (0..3).min_by_key(|&i| key(t[i])).unwrap();
    [t[least], t[(least + 1) % 3], t[(least + 2) % 3]]
}

/// Asserts that two sets of triangles agree within `tolerance`, whatever their order, orientation included.
pub fn assert_same(found: &TriangleSoup, wanted: &[[DVec3; 3]], tolerance: f64) {
    assert_eq!(found.triangles.len(), wanted.len());
    let mut found: Vec<_> =
        found.triangles.iter().map(|t| canonical(t.map(|p| found.positions[p as usize]))).collect();
    for wanted in wanted {
        let wanted = canonical(*wanted);
        let close =
            |t: &[DVec3; 3]| (0..3).any(|r| (0..3).all(|i| t[(i + r) % 3].distance(wanted[i]) <= tolerance));
        let index = found.iter().position(close).unwrap_or_else(|| panic!("{wanted:?} is missing"));
        found.swap_remove(index);
    }
}

/// Six times the signed volume over the triangles.
pub fn volume(soup: &TriangleSoup) -> f64 {
    let p = |i: u32| soup.positions[i as usize];
    soup.triangles.iter().map(|&[a, b, c]| p(a).dot(p(b).cross(p(c)))).sum::<f64>() / 6.0
}

/// Edges whose two directions do not occur equally often.
pub fn open_edges(soup: &TriangleSoup) -> usize {
    let mut balance: BTreeMap<[u32; 2], i64> = BTreeMap::new();
    for &[a, b, c] in &soup.triangles {
        for [a, b] in [[a, b], [b, c], [c, a]] {
            *balance.entry([a.min(b), a.max(b)]).or_default() += if a < b { 1 } else { -1 };
        }
    }
    balance.values().filter(|b| **b != 0).count()
}
