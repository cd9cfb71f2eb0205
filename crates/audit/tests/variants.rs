//! Rotated, mirrored and scaled by 1000, a model gets the same mesh: as closed, as near, with as many
//! triangles.

#![allow(clippy::unwrap_used)]

mod common;

use chordal_brep::{Coedge, Edge, FaceGeometry, Loop, Part, Pcurve, Vertex};
use chordal_mesh::PartMesh;
use chordal_nurbs::{Curve, DAffine3, DVec2, DVec3, Surface, math};
use chordal_tessellate::PartReport;
use glam::DMat3;
use std::collections::HashMap;
use std::fmt::Write;
use std::sync::Arc;

/// The part moved by a map that keeps shapes; `None` where one of its curves or surfaces has no such form.
fn moved(part: &Part, by: &DAffine3) -> Option<Part> {
    let mirrored = by.matrix3.determinant() < 0.0;
    let mut moved = part.clone();
    moved.vertices =
        part.vertices.iter().map(|v| Vertex { point: by.transform_point3(v.point), ..v.clone() }).collect();
    for edge in &mut moved.edges {
        if let Some(curve) = &edge.curve {
            *edge = Edge { curve: Some(moved_curve(curve, by)?), ..edge.clone() };
        }
    }
    let mut surfaces: HashMap<*const Surface, (Arc<Surface>, bool, DVec2)> = HashMap::new();
    for face in &mut moved.faces {
        let FaceGeometry::Surface(surface) = &face.geometry else { continue };
        let known = match surfaces.get(&Arc::as_ptr(surface)) {
            Some(known) => known.clone(),
            None => {
                let (image, turned, factors) = moved_surface(surface, by)?;
                let known = (Arc::new(image), turned, factors);
                surfaces.insert(Arc::as_ptr(surface), known.clone());
                known
            }
        };
        face.geometry = FaceGeometry::Surface(known.0);
        // The material keeps its side; the surface's own normal may not.
        face.same_sense ^= known.1;
        for a_loop in &mut face.loops {
            match a_loop {
                Loop::Vertex(_) => {}
                Loop::Polygon { vertices, .. } if mirrored => vertices.reverse(),
                Loop::Polygon { .. } => {}
                Loop::Edges { coedges, .. } => {
                    if mirrored {
                        coedges.reverse();
                    }
                    for coedge in coedges {
                        let image = |p: &Pcurve| {
                            Some(Pcurve { curve: Arc::new(p.curve.scaled(known.2)?), range: p.range })
                        };
                        let pcurves = coedge.pcurves.iter().map(image).collect::<Option<_>>()?;
                        *coedge = Coedge { forward: coedge.forward ^ mirrored, pcurves, ..*coedge };
                    }
                }
            }
        }
    }
    Some(moved)
}

fn moved_curve(curve: &Curve, by: &DAffine3) -> Option<Arc<Curve>> {
    curve.transformed(by).map(Arc::new)
}

/// The surface, whether its normal is now on the other side of the material, and what its parameters are
/// multiplied by.
fn moved_surface(surface: &Surface, by: &DAffine3) -> Option<(Surface, bool, DVec2)> {
    let image = surface.transformed(by)?;
    let domain = surface.domain();
    let uv = if domain.is_finite() { domain.min + domain.size() * 0.37 } else { DVec2::new(0.3, 0.4) };
    let uv = domain.clamp(uv);
    let (before, after) = (surface.normal(uv)?, image.surface.normal(image.parameters(uv))?);
    // Normals go with the inverse transpose; for maps that keep shapes that is the map itself, but for its
    // scale.
    let carried = by.transform_vector3(before).normalize();
    let factors = image.factors();
    Some((image.surface, carried.dot(after) < 0.0, factors))
}

fn variants() -> Vec<(&'static str, DAffine3, f64)> {
    let turn = DMat3::from_quat(math::rotation(DVec3::new(0.3, -0.5, 0.8).normalize(), 1.234));
    let mirror = DMat3::from_diagonal(DVec3::new(1.0, 1.0, -1.0));
    let at = |matrix3: DMat3, by: DVec3| DAffine3 { matrix3, translation: by };
    vec![
        ("rotated", at(turn, DVec3::new(3.0, -2.0, 5.0)), 1.0),
        ("mirrored", at(turn * mirror, DVec3::ZERO), 1.0),
        ("scaled by 1000", at(DMat3::from_diagonal(DVec3::splat(1e3)), DVec3::ZERO), 1e3),
    ]
}

fn failed(report: &PartReport) -> usize {
    report.faces.iter().filter(|f| f.failed.is_some()).count()
}

/// The centre of gravity of the triangles: it tells which side of a loop a face lies on.
fn middle(mesh: &PartMesh) -> DVec3 {
    let mut sum = (DVec3::ZERO, 0.0);
    for face in &mesh.faces {
        for corners in &face.triangles {
            let [a, b, c] = corners.map(|i| mesh.positions[face.corners[i as usize].position as usize]);
            let area = (b - a).cross(c - a).length();
            sum = (sum.0 + (a + b + c) / 3.0 * area, sum.1 + area);
        }
    }
    sum.0 / sum.1.max(f64::MIN_POSITIVE)
}

/// Models that the mesher is known to treat differently, and why.
const KNOWN: &[(&str, &str)] = &[(
    "torus_villarceau",
    "the chart of a mirrored torus is a mirror image, which is filled from its other side",
)];

#[test]
fn variants_get_the_same_mesh() {
    let mut faults = String::new();
    let mut compared = 0;
    for name in common::names() {
        // The control net of the one is out of time, the other is half a million triangles.
        if ["weight_range", "degree_100"].contains(&name.as_str()) {
            continue;
        }
        let model = common::load(&name);
        let Some(part) = model.parts.iter().find(|p| !p.faces.is_empty()) else { continue };
        let tolerance = 1e-3 * common::diagonal(part);
        if tolerance == 0.0 {
            continue;
        }
        let (mesh, report) = common::mesh(part, tolerance, None);
        let before = common::audit(part, &mesh, &report, tolerance);
        for (what, by, scale) in variants() {
            let Some(variant) = moved(part, &by) else {
                println!("{name} {what}: has a curve or surface that cannot be moved");
                continue;
            };
            compared += 1;
            let (moved_mesh, moved_report) = common::mesh(&variant, tolerance * scale, None);
            let after = common::audit(&variant, &moved_mesh, &moved_report, tolerance * scale);
            let (n, m) = (mesh.triangle_count(), moved_mesh.triangle_count());
            let mut add = |fault: String| match KNOWN.iter().find(|k| k.0 == name) {
                Some(known) => println!("known ({}): {name} {what}: {fault}", known.1),
                None => writeln!(faults, "{name} {what}: {fault}").unwrap(),
            };
            if n.abs_diff(m) > (n / 100).max(4) {
                add(format!("{n} triangles become {m}"));
            }
            if failed(&report) != failed(&moved_report) {
                add(format!("{} failed faces become {}", failed(&report), failed(&moved_report)));
            }
            if before.problems.len() < after.problems.len() {
                add(format!("new problems: {:?}", after.problems));
            }
            let (there, here) = (by.transform_point3(middle(&mesh)), middle(&moved_mesh));
            if there.distance(here) > 20.0 * scale * tolerance {
                add(format!("its middle is {here}, not {there}"));
            }
            for (a, b) in before.shells.iter().zip(&after.shells) {
                let volume = a.volume * math::powi(scale, 3);
                if a.watertight != b.watertight {
                    add(format!("watertight {} becomes {}", a.watertight, b.watertight));
                } else if a.watertight && (volume - b.volume).abs() > 1e-2 * volume.abs() {
                    add(format!("a volume of {volume} becomes {}", b.volume));
                }
            }
        }
    }
    assert!(compared > 150, "only {compared} variants");
    assert!(faults.is_empty(), "\n{faults}");
}
