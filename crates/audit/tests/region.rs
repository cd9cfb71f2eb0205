//! Meshes of the wrong part of a surface, each as near to it as a right mesh, and each to be found.

#![allow(clippy::unwrap_used)]

mod common;

use chordal_audit::{AuditOptions, PartAudit, audit_part, facet_crossings};
use chordal_brep::{
    Body, BodyKind, Coedge, Edge, EdgeId, Face, FaceGeometry, FaceId, Loop, Part, Shell, ShellId, Source,
    Vertex, VertexId,
};
use chordal_mesh::{Corner, FaceMesh, Origin, PartMesh};
use chordal_nurbs::{Curve, DVec2, DVec3, Frame, NurbsCurve3, Range, Surface, math};
use chordal_tessellate::{
    Cancel, FacetCut, Options, Remembered, tessellate_part_apart, tessellate_part_remembered,
};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

const TOLERANCE: f64 = 0.02;

fn codes(audit: &PartAudit) -> Vec<&'static str> {
    audit.problems.iter().map(|p| p.issue.code()).collect()
}

fn audited(part: &Part, mesh: &PartMesh) -> PartAudit {
    audit_part(part, mesh, &AuditOptions::new(TOLERANCE), None)
}

fn expect(what: &str, part: &Part, mesh: &PartMesh, code: &str) {
    let audit = audited(part, mesh);
    assert!(codes(&audit).contains(&code), "{what}: {:?}", audit.problems);
}

fn vertex(part: &mut Part, point: DVec3) -> VertexId {
    part.vertices.push(Vertex { point, source: Source::default() });
    VertexId::from(part.vertices.len() - 1)
}

fn edge(part: &mut Part, curve: Curve, range: Range, ends: [VertexId; 2]) -> EdgeId {
    let [start, end] = ends;
    part.edges.push(Edge { curve: Some(Arc::new(curve)), range, start, end, source: Source::default() });
    EdgeId::from(part.edges.len() - 1)
}

/// The straight edge between two vertices, or the one that is there, and whether it runs that way.
fn line(part: &mut Part, from: VertexId, to: VertexId) -> (EdgeId, bool) {
    let runs = |a: VertexId, b: VertexId| part.edges.iter().position(|e| e.start == a && e.end == b);
    if let Some(e) = runs(from, to) {
        return (EdgeId::from(e), true);
    }
    if let Some(e) = runs(to, from) {
        return (EdgeId::from(e), false);
    }
    let (p, q) = (part.vertices[from.index()].point, part.vertices[to.index()].point);
    let curve = Curve::Line { origin: p, direction: q - p };
    (edge(part, curve, Range::new(0.0, 1.0), [from, to]), true)
}

fn a_loop(edges: impl IntoIterator<Item = (EdgeId, bool)>) -> Loop {
    let coedges = edges.into_iter().map(|(edge, forward)| Coedge { edge, forward, pcurves: Vec::new() });
    Loop::Edges { coedges: coedges.collect(), outer: false }
}

fn face(part: &mut Part, surface: Surface, loops: Vec<Loop>) -> FaceId {
    part.faces.push(Face {
        geometry: FaceGeometry::Surface(Arc::new(surface)),
        same_sense: true,
        flipped: false,
        loops,
        name: String::new(),
        color: None,
        layer: None,
        source: Source::default(),
    });
    FaceId::from(part.faces.len() - 1)
}

/// Puts all faces into one shell.
fn close(part: &mut Part, closed: bool) {
    let faces = (0..part.faces.len()).map(FaceId::from).collect();
    part.shells = vec![Shell { faces, closed, source: Source::default() }];
    part.bodies = vec![Body {
        kind: if closed { BodyKind::Solid } else { BodyKind::Sheet },
        shells: vec![ShellId(0)],
        name: String::new(),
        color: None,
        layer: None,
        source: Source::default(),
    }];
}

fn mesh(part: &Part) -> PartMesh {
    let (mesh, report) = common::mesh(part, TOLERANCE, None);
    assert!(report.faces.iter().all(|f| f.failed.is_none()), "{:?}", report.faces);
    mesh
}

/// A cap of the unit sphere above z = 0.6, bounded by one circle.
fn cap(forward: bool) -> Part {
    let mut part = Part::default();
    let frame = Frame::new(DVec3::new(0.0, 0.0, 0.6), DVec3::Z, DVec3::X);
    let at = vertex(&mut part, DVec3::new(0.8, 0.0, 0.6));
    let circle = Curve::Circle { frame, radius: 0.8 };
    let rim = edge(&mut part, circle, Range::new(0.0, std::f64::consts::TAU), [at, at]);
    let sphere = Surface::Sphere { frame: Frame::new(DVec3::ZERO, DVec3::Z, DVec3::X), radius: 1.0 };
    face(&mut part, sphere, vec![a_loop([(rim, forward)])]);
    close(&mut part, false);
    part
}

#[test]
fn the_other_side_of_a_loop_is_found() {
    for (wanted, meshed) in [(true, false), (false, true)] {
        let part = cap(wanted);
        let right = mesh(&part);
        assert!(audited(&part, &right).clean(), "{:?}", audited(&part, &right).problems);
        expect("the complement", &part, &mesh(&cap(meshed)), "other-side");
    }
}

#[test]
fn the_rest_of_a_sphere_in_place_of_a_cap_is_found() {
    // Both close the hole of a plate; they differ by the side to which they face.
    let lid = |same_sense: bool| {
        let mut part = cap(true);
        part.faces[0].same_sense = same_sense;
        part
    };
    let meshed = lid(false);
    let mesh = mesh(&meshed);
    assert!(audited(&meshed, &mesh).clean(), "{:?}", audited(&meshed, &mesh).problems);
    expect("the rest of the sphere", &lid(true), &mesh, "other-side");
}

/// The unit sphere with a loop that runs out along a chord and back.
fn folded_loop() -> Part {
    let mut part = Part::default();
    let (p, q) = (DVec3::X, DVec3::new(math::cos(0.1), math::sin(0.1), 0.0));
    let curve = NurbsCurve3::new(1, vec![0.0, 0.0, 1.0, 2.0, 2.0], vec![p, q, p], None).unwrap();
    let at = vertex(&mut part, p);
    let fold = edge(&mut part, Curve::Nurbs(curve), Range::new(0.0, 2.0), [at, at]);
    let sphere = Surface::Sphere { frame: Frame::new(DVec3::ZERO, DVec3::Z, DVec3::X), radius: 1.0 };
    face(&mut part, sphere, vec![a_loop([(fold, true)])]);
    close(&mut part, false);
    part
}

#[test]
fn a_whole_sphere_for_a_sliver_is_found() {
    let part = folded_loop();
    let mut whole = part.clone();
    whole.faces[0].loops.clear();
    whole.edges.clear();
    let mut mesh = mesh(&whole);
    // The samples of the edge, which no triangle uses.
    let first = mesh.positions.len() as u32;
    mesh.positions.extend([DVec3::X, DVec3::new(math::cos(0.1), math::sin(0.1), 0.0)]);
    mesh.origins.extend([Origin::Vertex(0), Origin::Edge { edge: 0, index: 1 }]);
    mesh.edges = vec![vec![first, first + 1, first]];
    expect("a sphere", &part, &mesh, "whole-surface");
}

/// Grid lines each way of the mesh of a torus; a multiple of three, so that the poles lie on lines.
const LINES: u32 = 24;

/// The whole torus with a circle of radius 1 and a tube of radius 2, both sheets, as one face without loops.
fn spindle() -> (Part, PartMesh) {
    let mut part = Part::default();
    let frame = Frame::new(DVec3::ZERO, DVec3::Z, DVec3::X);
    let torus = Surface::Torus { frame, major: 1.0, minor: 2.0 };
    face(&mut part, torus.clone(), Vec::new());
    close(&mut part, false);
    let angle = |i: u32| f64::from(i) * std::f64::consts::TAU / f64::from(LINES);
    // On these lines the tube meets the axis: one vertex each.
    let is_pole = |j: u32| j % LINES == LINES / 3 || j % LINES == 2 * LINES / 3;
    let position = |i: u32, j: u32| (j % LINES) * LINES + if is_pole(j) { 0 } else { i % LINES };
    let uv = |i: u32, j: u32| DVec2::new(angle(i), angle(j));
    let mut of_face = FaceMesh::default();
    for (i, j) in (0..=LINES).flat_map(|i| (0..=LINES).map(move |j| (i, j))) {
        let normal = torus.normal(uv(i, j)).unwrap();
        of_face.corners.push(Corner { position: position(i, j), uv: uv(i, j), normal });
    }
    let corner = |i: u32, j: u32| i * (LINES + 1) + j;
    for (i, j) in (0..LINES).flat_map(|i| (0..LINES).map(move |j| (i, j))) {
        if !is_pole(j) {
            of_face.triangles.push([corner(i, j), corner(i + 1, j), corner(i + 1, j + 1)]);
        }
        if !is_pole(j + 1) {
            of_face.triangles.push([corner(i, j), corner(i + 1, j + 1), corner(i, j + 1)]);
        }
    }
    let all = (0..LINES).flat_map(|j| (0..LINES).map(move |i| (i, j)));
    let mesh = PartMesh {
        positions: all.map(|(i, j)| torus.point(uv(i, j))).collect(),
        origins: vec![Origin::Face(0); (LINES * LINES) as usize],
        faces: vec![of_face],
        edges: Vec::new(),
    };
    (part, mesh)
}

#[test]
fn both_sheets_of_a_torus_are_found() {
    let (part, mesh) = spindle();
    expect("a torus that meets itself", &part, &mesh, "both-sheets");
    for name in ["torus_lemon", "torus_apple"] {
        let part = common::load(name).parts.into_iter().find(|p| !p.faces.is_empty()).unwrap();
        let tolerance = 1e-3 * common::diagonal(&part);
        let (mesh, report) = common::mesh(&part, tolerance, None);
        let audit = common::audit(&part, &mesh, &report, tolerance);
        assert!(audit.clean(), "{name}: {:?}", audit.problems);
    }
}

/// Three quarters of a cylinder of radius 1 and height 1.
fn three_quarters() -> Part {
    let mut part = Part::default();
    let turn = 1.5 * std::f64::consts::PI;
    let frame = |z: f64| Frame::new(DVec3::Z * z, DVec3::Z, DVec3::X);
    let at = [(1.0, 0.0, 0.0), (0.0, -1.0, 0.0), (0.0, -1.0, 1.0), (1.0, 0.0, 1.0)];
    let v = at.map(|p| vertex(&mut part, DVec3::from(p)));
    let arc = |part: &mut Part, z: f64, ends: [VertexId; 2]| {
        edge(part, Curve::Circle { frame: frame(z), radius: 1.0 }, Range::new(0.0, turn), ends)
    };
    let (low, high) = (arc(&mut part, 0.0, [v[0], v[1]]), arc(&mut part, 1.0, [v[3], v[2]]));
    let (up, down) = (line(&mut part, v[1], v[2]), line(&mut part, v[3], v[0]));
    let cylinder = Surface::Cylinder { frame: frame(0.0), radius: 1.0 };
    face(&mut part, cylinder, vec![a_loop([(low, true), up, (high, false), down])]);
    close(&mut part, false);
    part
}

#[test]
fn the_short_way_round_is_found() {
    let part = three_quarters();
    let good = mesh(&part);
    assert!(audited(&part, &good).clean());
    // One chord for each arc, which leads to the right point, but the other way round.
    let quarter = std::f64::consts::FRAC_PI_2;
    let corner = |i: u32| {
        let p = part.vertices[i as usize].point;
        let uv = DVec2::new(if p.x > 0.5 { 0.0 } else { -quarter }, p.z);
        Corner { position: i, uv, normal: DVec3::new(p.x, p.y, 0.0) }
    };
    let short = PartMesh {
        positions: part.vertices.iter().map(|v| v.point).collect(),
        origins: (0..4).map(Origin::Vertex).collect(),
        faces: vec![FaceMesh {
            face: 0,
            corners: (0..4).map(corner).collect(),
            triangles: vec![[0, 2, 1], [0, 3, 2]],
            quads: 0,
        }],
        edges: part.edges.iter().map(|e| vec![e.start.0, e.end.0]).collect(),
    };
    let unproven = AuditOptions::new(TOLERANCE).with_proven(false);
    let audit = audit_part(&part, &short, &unproven, None);
    assert!(codes(&audit).contains(&"wrong-area"), "{:?}", audit.problems);
}

fn square(part: &mut Part, corner: DVec3, size: f64) -> Vec<(EdgeId, bool)> {
    let at = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
    let v = at.map(|(x, y)| vertex(part, corner + size * DVec3::new(x, y, 0.0)));
    (0..4).map(|i| line(part, v[i], v[(i + 1) % 4])).collect()
}

/// The mesh of one plane face at z = 0: two triangles over every square of four vertices of the part.
fn squares_meshed(part: &Part) -> PartMesh {
    let n = part.vertices.len() as u32;
    let corner = |i: u32| {
        let p = part.vertices[i as usize].point;
        Corner { position: i, uv: DVec2::new(p.x, p.y), normal: DVec3::Z }
    };
    let triangles = (0..n).step_by(4).flat_map(|i| [[i, i + 1, i + 2], [i, i + 2, i + 3]]).collect();
    PartMesh {
        positions: part.vertices.iter().map(|v| v.point).collect(),
        origins: (0..n).map(Origin::Vertex).collect(),
        faces: vec![FaceMesh { face: 0, corners: (0..n).map(corner).collect(), triangles, quads: 0 }],
        edges: part.edges.iter().map(|e| vec![e.start.0, e.end.0]).collect(),
    }
}

#[test]
fn a_region_that_is_covered_twice_is_found() {
    let plane = || Surface::Plane { frame: Frame::new(DVec3::ZERO, DVec3::Z, DVec3::X) };
    // Side by side it is a face in two pieces; the others cross, or lie one in the other.
    for (x, size, twice) in [(3.0, 2.0, false), (1.0, 2.0, true), (0.5, 1.0, true)] {
        let mut part = Part::default();
        let loops = [square(&mut part, DVec3::ZERO, 2.0), square(&mut part, DVec3::new(x, 0.5, 0.0), size)];
        face(&mut part, plane(), loops.into_iter().map(a_loop).collect());
        close(&mut part, false);
        let audit = audited(&part, &squares_meshed(&part));
        assert_eq!(
            codes(&audit),
            if twice { vec!["overlap"] } else { vec![] },
            "at {x}: {:?}",
            audit.problems
        );
    }
}

#[test]
fn a_dropped_hole_is_found() {
    let part = common::load("bracket").parts.into_iter().find(|p| !p.faces.is_empty()).unwrap();
    let tolerance = 1e-3 * common::diagonal(&part);
    let mut tried = 0;
    for f in 0..part.faces.len() {
        let planar = matches!(&part.faces[f].geometry,
            FaceGeometry::Surface(s) if matches!(**s, Surface::Plane { .. }));
        if !planar || part.faces[f].loops.len() < 2 {
            continue;
        }
        tried += 1;
        let mut without = part.clone();
        without.faces[f].loops.truncate(1);
        let (mesh, report) = common::mesh(&without, tolerance, None);
        let audit = common::audit(&part, &mesh, &report, tolerance);
        assert!(codes(&audit).contains(&"missing-chords"), "face {f}: {:?}", audit.problems);
    }
    assert!(tried > 0, "no hole");
}

/// True for a corner with triangles all round: as many as neighbours.
fn is_surrounded(mesh: &FaceMesh, corner: u32) -> bool {
    let around: Vec<_> = mesh.triangles.iter().filter(|t| t.contains(&corner)).collect();
    let others = around.iter().flat_map(|t| t.iter()).filter(|&&c| c != corner);
    let neighbours: std::collections::BTreeSet<u32> = others.copied().collect();
    !around.is_empty() && around.len() == neighbours.len()
}

#[test]
fn a_facet_far_outside_is_found() {
    let mut tried = 0;
    for name in ["fillets", "torus_bands", "fillet_bspline"] {
        let part = common::load(name).parts.into_iter().find(|p| !p.faces.is_empty()).unwrap();
        let tolerance = 1e-3 * common::diagonal(&part);
        let (good, report) = common::mesh(&part, tolerance, None);
        for f in 0..part.faces.len() {
            let FaceGeometry::Surface(surface) = &part.faces[f].geometry else { continue };
            if part.faces[f].loops.is_empty() {
                continue;
            }
            let is_inside = |&c: &usize| is_surrounded(&good.faces[f], c as u32);
            let Some(c) = (0..good.faces[f].corners.len()).find(is_inside) else { continue };
            tried += 1;
            let mut mesh = good.clone();
            let of_face = &mut mesh.faces[f];
            let extent =
                of_face.corners.iter().fold(DVec2::ZERO, |m, o| m.max((o.uv - of_face.corners[c].uv).abs()));
            of_face.corners[c].uv += 1.5 * extent;
            mesh.positions[of_face.corners[c].position as usize] = surface.point(of_face.corners[c].uv);
            let audit = common::audit(&part, &mesh, &report, tolerance);
            assert!(codes(&audit).contains(&"out-of-reach"), "{name} face {f}: {:?}", audit.problems);
        }
    }
    assert!(tried > 5, "only {tried} faces with vertices inside");
}

#[test]
fn a_face_turned_over_is_found() {
    for name in ["fillets", "bracket", "fillet_bspline"] {
        let part = common::load(name).parts.into_iter().find(|p| !p.faces.is_empty()).unwrap();
        let tolerance = 1e-3 * common::diagonal(&part);
        let (good, report) = common::mesh(&part, tolerance, None);
        for f in (0..part.faces.len()).step_by(3) {
            let mut mesh = good.clone();
            mesh.faces[f].triangles.iter_mut().for_each(|t| t.swap(0, 1));
            mesh.faces[f].corners.iter_mut().for_each(|c| c.normal = -c.normal);
            let audit = common::audit(&part, &mesh, &report, tolerance);
            assert!(codes(&audit).contains(&"inconsistent-edges"), "{name} face {f}: {:?}", audit.problems);
        }
    }
}

/// A tetrahedron of plane faces with one corner at `at`.
fn tetrahedron(part: &mut Part, at: DVec3) {
    let v = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z].map(|p| vertex(part, at + p));
    for corners in [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]] {
        triangle(part, corners.map(|c: usize| v[c]));
    }
}

/// A plane face between three vertices.
fn triangle(part: &mut Part, corners: [VertexId; 3]) {
    let edges: Vec<_> = (0..3).map(|i| line(part, corners[i], corners[(i + 1) % 3])).collect();
    let [p, q, r] = corners.map(|v| part.vertices[v.index()].point);
    let frame = Frame::new(p, (q - p).cross(r - p).normalize(), (q - p).normalize());
    face(part, Surface::Plane { frame }, vec![a_loop(edges)]);
}

#[test]
fn facets_that_cut_each_other_are_found() {
    for (apart, cut) in [(3.0, false), (0.25, true)] {
        let mut part = Part::default();
        tetrahedron(&mut part, DVec3::ZERO);
        tetrahedron(&mut part, DVec3::new(apart, 0.1, 0.15));
        close(&mut part, true);
        let audit = audited(&part, &mesh(&part));
        assert_eq!(
            codes(&audit),
            if cut { vec!["self-intersections"] } else { vec![] },
            "{:?}",
            audit.problems
        );
        assert_eq!(audit.self_intersections.is_empty(), !cut);
        let off = AuditOptions::new(TOLERANCE).with_self_intersections(false);
        assert!(audit_part(&part, &mesh(&part), &off, None).clean());
    }
}

/// An octahedron of plane faces whose corners are `reach` from its middle.
fn octahedron(part: &mut Part, middle: DVec3, reach: f64) {
    let axes = [DVec3::X, DVec3::Y, -DVec3::X, -DVec3::Y, DVec3::Z, -DVec3::Z];
    let v = axes.map(|axis| vertex(part, middle + reach * axis));
    for i in 0..4 {
        let j = (i + 1) % 4;
        triangle(part, [v[i], v[j], v[4]]);
        triangle(part, [v[j], v[i], v[5]]);
    }
}

#[test]
fn cuts_through_vertices_and_sides_are_found() {
    // The octahedron's four sides in its middle plane lie in the bottom of the tetrahedron: whatever passes
    // through it passes along them. Shifted down, it hangs under the bottom by a corner; up, it is inside.
    let at = |height: f64| DVec3::new(0.25, 0.25, height);
    for (height, reach, cut) in [(0.0, 0.125, true), (-0.125, 0.125, false), (0.1875, 0.0625, false)] {
        let mut part = Part::default();
        tetrahedron(&mut part, DVec3::ZERO);
        octahedron(&mut part, at(height), reach);
        close(&mut part, true);
        let audit = audited(&part, &mesh(&part));
        let expected = if cut { vec!["self-intersections"] } else { vec![] };
        assert_eq!(codes(&audit), expected, "at {height}: {:?}", audit.problems);
        let pairs: usize = audit.self_intersections.iter().map(|crossing| crossing.facet_pairs).sum();
        assert_eq!(pairs, if cut { 4 } else { 0 });
    }
}

#[test]
fn surfaces_that_cut_along_common_sides_are_found() {
    // Two octahedra side by side have an edge in common, vertices of their own; turned into each other, the
    // edges lie on each other and the faces cut along them.
    for (shift, cut) in [(DVec3::new(0.5, 0.5, 0.0), false), (DVec3::new(0.25, 0.25, 0.0), true)] {
        let mut part = Part::default();
        octahedron(&mut part, DVec3::ZERO, 0.5);
        octahedron(&mut part, shift, 0.5);
        close(&mut part, true);
        let audit = audited(&part, &mesh(&part));
        assert_eq!(codes(&audit), if cut { vec!["self-intersections"] } else { vec![] }, "{shift}");
    }
}

/// Two squares of one plane, each a face, with an edge in common.
fn two_squares() -> Part {
    let mut part = Part::default();
    let at = [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (0.0, 1.0)];
    let v = at.map(|(x, y)| vertex(&mut part, DVec3::new(x, y, 0.0)));
    for corners in [[0, 1, 4, 5], [1, 2, 3, 4]] {
        let edges: Vec<_> = (0..4).map(|i| line(&mut part, v[corners[i]], v[corners[(i + 1) % 4]])).collect();
        let plane = Surface::Plane { frame: Frame::new(DVec3::ZERO, DVec3::Z, DVec3::X) };
        face(&mut part, plane, vec![a_loop(edges)]);
    }
    close(&mut part, false);
    part
}

/// The mesh of [`two_squares`] with the far side of the second square moved over the first one.
fn folded(good: &PartMesh, height: f64) -> PartMesh {
    let mut mesh = good.clone();
    for (p, origin) in mesh.positions.iter_mut().zip(&mesh.origins) {
        if let Origin::Vertex(2 | 3) = origin {
            (p.x, p.z) = (0.25, height);
        }
    }
    mesh
}

#[test]
fn facets_that_are_folded_at_an_edge_are_found() {
    let mut part = two_squares();
    let good = mesh(&part);
    assert!(audited(&part, &good).clean(), "{:?}", audited(&part, &good).problems);
    for height in [0.0, 0.03] {
        expect("a fold", &part, &folded(&good, height), "folded-at-edge");
    }
    // Exactly onto it, in a shell that the file calls closed, they overlap.
    part.shells[0].closed = true;
    let mut exact = folded(&good, 0.0);
    for corner in &mut exact.faces[1].corners {
        let p = exact.positions[corner.position as usize];
        corner.uv = DVec2::new(p.x, p.y);
    }
    expect("an overlap", &part, &exact, "self-intersections");
}

#[test]
fn a_fold_of_the_file_is_no_fault() {
    // The second face is the first one's other side.
    let mut part = Part::default();
    let at = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.25, 0.0), (0.25, 1.0)];
    let v = at.map(|(x, y)| vertex(&mut part, DVec3::new(x, y, 0.0)));
    for (corners, same_sense) in [([0, 1, 2, 3], true), ([4, 5, 2, 1], false)] {
        let edges: Vec<_> = (0..4).map(|i| line(&mut part, v[corners[i]], v[corners[(i + 1) % 4]])).collect();
        let plane = Surface::Plane { frame: Frame::new(DVec3::ZERO, DVec3::Z, DVec3::X) };
        let face = face(&mut part, plane, vec![a_loop(edges)]);
        part.faces[face.index()].same_sense = same_sense;
    }
    close(&mut part, false);
    let audit = audited(&part, &mesh(&part));
    assert!(!codes(&audit).contains(&"folded-at-edge"), "{:?}", audit.problems);
}

/// A ball with a tetrahedron inside, one corner of which is this far from the centre.
fn ball_with_spike(reach: f64) -> Part {
    let mut part = Part::default();
    tetrahedron(&mut part, DVec3::splat(-reach / 3.0_f64.sqrt()));
    let sphere = Surface::Sphere { frame: Frame::new(DVec3::ZERO, DVec3::Z, DVec3::X), radius: 1.0 };
    face(&mut part, sphere, Vec::new());
    close(&mut part, true);
    part
}

#[test]
fn facets_that_cut_each_other_are_refined_until_they_part() {
    let part = ball_with_spike(0.999);
    let plain = mesh(&part);
    let audit = audited(&part, &plain);
    assert!(audit.self_intersections.iter().all(|crossing| !crossing.in_file), "the faces are apart");
    let searches = AtomicUsize::new(0);
    let find = |part: &Part, mesh: &PartMesh| -> Vec<FacetCut> {
        searches.fetch_add(1, Ordering::Relaxed);
        let cuts = facet_crossings(part, mesh, &[0]).into_iter();
        cuts.map(|cut| FacetCut { faces: cut.faces, bounds: cut.bounds }).collect()
    };
    let options = Options::new(TOLERANCE);
    let (parted, report) =
        tessellate_part_apart(&part, &options, &Cancel::default(), &find, Remembered::default());
    assert!(audited(&part, &parted).clean(), "{:?}", audited(&part, &parted).problems);
    assert!(report.faces.iter().all(|face| face.proven_error <= TOLERANCE));
    assert!(searches.into_inner() > 1);
    let (before, after) = (plain.triangle_count(), parted.triangle_count());
    assert!(before < after && after < 2 * before, "refined at the corner only: {before}, {after}");
}

/// True where the audit finds crossing facets, and calls all of it as in the file.
fn meets_in_file(part: &Part) -> bool {
    let audit = audited(part, &mesh(part));
    assert_eq!(codes(&audit), ["self-intersections"], "{:?}", audit.problems);
    audit.problems[0].issue.is_as_in_file()
}

/// Two balls with the same centre, one of them turned.
fn ball_in_ball(radius: f64) -> Part {
    let mut part = Part::default();
    let turned = Frame::new(DVec3::ZERO, DVec3::new(0.5, 0.3, 0.8).normalize(), DVec3::X);
    for (frame, radius) in [(Frame::new(DVec3::ZERO, DVec3::Z, DVec3::X), 1.0), (turned, radius)] {
        face(&mut part, Surface::Sphere { frame, radius }, Vec::new());
    }
    close(&mut part, true);
    part
}

#[test]
fn faces_that_lie_on_each_other_touch_in_the_file_and_faces_that_are_hardly_apart_do_not() {
    assert!(meets_in_file(&ball_in_ball(1.0)));
    for apart in [1e-9, 1e-6, 1e-3] {
        assert!(!meets_in_file(&ball_in_ball(1.0 - apart)), "{apart}");
    }
}

#[test]
fn solids_side_by_side_touch_in_the_file() {
    let mut part = Part::default();
    tetrahedron(&mut part, DVec3::ZERO);
    tetrahedron(&mut part, DVec3::new(0.25, 0.125, 0.0));
    close(&mut part, true);
    assert!(meets_in_file(&part), "their floors overlap, and their walls cross");
}

#[test]
fn a_spike_that_just_reaches_a_face_or_not_is_not_called_a_crossing() {
    for reach in [1.0 - 1e-6, 1.0 - 1e-9, 1.0 - 1e-12] {
        assert!(!meets_in_file(&ball_with_spike(reach)), "{reach}");
    }
}

#[test]
fn a_part_is_refined_alike_from_what_is_remembered_of_it() {
    let part = ball_with_spike(0.999);
    let (options, cancel) = (Options::new(TOLERANCE), Cancel::default());
    let find = |part: &Part, mesh: &PartMesh| -> Vec<FacetCut> {
        let cuts = facet_crossings(part, mesh, &[0]).into_iter();
        cuts.map(|cut| FacetCut { faces: cut.faces, bounds: cut.bounds }).collect()
    };
    let (plain, _, remembered) = tessellate_part_remembered(&part, &options, &cancel, &|_| ());
    assert_eq!(plain, mesh(&part));
    let (again, report) = tessellate_part_apart(&part, &options, &cancel, &|_, _| Vec::new(), remembered);
    assert_eq!(again, plain, "nothing to part");
    assert!(report.faces.iter().all(|face| face.proven_error <= TOLERANCE));
    let (_, _, remembered) = tessellate_part_remembered(&part, &options, &cancel, &|_| ());
    let (parted, _) = tessellate_part_apart(&part, &options, &cancel, &find, remembered);
    let (anew, _) = tessellate_part_apart(&part, &options, &cancel, &find, Remembered::default());
    assert_eq!(parted, anew);
    assert_ne!(parted, plain);
}

#[test]
fn faces_that_cut_each_other_in_the_file_are_told_from_facets_that_do() {
    for (reach, in_file) in [(0.999, false), (1.05, true)] {
        let part = ball_with_spike(reach);
        let mesh = mesh(&part);
        let audit = audited(&part, &mesh);
        assert_eq!(codes(&audit), ["self-intersections"], "{:?}", audit.problems);
        assert!(audit.self_intersections.iter().any(|crossing| crossing.in_file == in_file));
        let to_part = facet_crossings(&part, &mesh, &[0]);
        assert_eq!(to_part.is_empty(), in_file, "{to_part:?}");
    }
}
