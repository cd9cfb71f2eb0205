//! Good meshes with one fault put in on purpose: each kind must be found, and named as what it is.

#![allow(clippy::unwrap_used)]

mod common;

use chordal_audit::{AuditOptions, Claim, PartAudit, audit_part};
use chordal_brep::{FaceGeometry, Part};
use chordal_mesh::{Corner, Origin, PartMesh};
use chordal_nurbs::{DVec2, DVec3, Surface};

/// Models of planes, cylinders, tori, free forms, with seams, holes and poles.
const MODELS: [&str; 6] =
    ["cylinder_seam_hole", "fillets", "bracket", "fillet_bspline", "torus_bands", "revolution_bspline"];

/// At most this many faces of a model get each fault.
const FACES: usize = 10;

struct Sample {
    name: &'static str,
    part: Part,
    mesh: PartMesh,
    claims: Vec<Claim>,
    tolerance: f64,
}

impl Sample {
    fn all() -> Vec<Sample> {
        MODELS.into_iter().map(Sample::new).collect()
    }

    fn new(name: &'static str) -> Sample {
        let part = common::load(name).parts.into_iter().find(|p| !p.faces.is_empty()).unwrap();
        let tolerance = 1e-3 * common::diagonal(&part);
        let (mesh, report) = common::mesh(&part, tolerance, None);
        let claims = common::claims(&report);
        let sample = Sample { name, part, mesh, claims, tolerance };
        let audit = sample.audit(&sample.mesh);
        assert!(audit.clean(), "{name} has faults of its own: {:?}", audit.problems);
        sample
    }

    fn audit(&self, mesh: &PartMesh) -> PartAudit {
        audit_part(&self.part, mesh, &AuditOptions::new(self.tolerance), Some(&self.claims))
    }

    fn faces(&self) -> impl Iterator<Item = usize> {
        let step = self.part.faces.len().div_ceil(FACES);
        (0..self.part.faces.len()).step_by(step)
    }

    fn surface(&self, face: usize) -> &Surface {
        match &self.part.faces[face].geometry {
            FaceGeometry::Surface(surface) => surface,
            FaceGeometry::Failed(why) => panic!("{why}"),
        }
    }

    /// Puts the fault in and expects one of `codes`.
    fn expect(&self, what: &str, codes: &[&str], fault: impl Fn(&mut PartMesh)) {
        let mut mesh = self.mesh.clone();
        fault(&mut mesh);
        let audit = self.audit(&mesh);
        let found = audit.problems.iter().any(|p| codes.contains(&p.issue.code()));
        assert!(found, "{}: {what} is not found, only {:?}", self.name, audit.problems);
    }

    fn position(mesh: &PartMesh, face: usize, corner: u32) -> usize {
        mesh.faces[face].corners[corner as usize].position as usize
    }

    /// Corners of a face whose positions come from `wanted`, a few of them.
    fn corners(&self, face: usize, wanted: impl Fn(Origin) -> bool) -> Vec<u32> {
        let n = self.mesh.faces[face].corners.len() as u32;
        let fits = |c: &u32| wanted(self.mesh.origins[Self::position(&self.mesh, face, *c)]);
        let all: Vec<u32> = (0..n).filter(fits).collect();
        all.iter().copied().step_by(all.len().div_ceil(3).max(1)).collect()
    }
}

#[test]
fn a_removed_triangle_is_found() {
    for sample in Sample::all() {
        for f in sample.faces() {
            let n = sample.mesh.faces[f].triangles.len();
            for t in [0, n / 2, n - 1] {
                let codes: &[&str] =
                    if n == 1 { &["missing-face"] } else { &["stray-boundary", "missing-chords"] };
                let remove = |mesh: &mut PartMesh| {
                    mesh.faces[f].triangles.remove(t);
                };
                sample.expect("a removed triangle", codes, remove);
                if n > 1 && sample.part.shells[0].closed {
                    sample.expect("the hole", &["open-shell"], remove);
                }
            }
        }
    }
}

#[test]
fn a_flipped_triangle_is_found() {
    for sample in Sample::all() {
        for f in sample.faces().filter(|&f| sample.mesh.faces[f].triangles.len() > 2) {
            let t = sample.mesh.faces[f].triangles.len() / 2;
            let flip = |mesh: &mut PartMesh| mesh.faces[f].triangles[t].swap(0, 1);
            sample.expect("a flipped triangle", &["inverted-triangles"], flip);
            sample.expect("its edges", &["inconsistent-edges"], flip);
        }
    }
}

#[test]
fn a_doubled_triangle_is_found() {
    for sample in Sample::all() {
        for f in sample.faces() {
            let t = sample.mesh.faces[f].triangles.len() / 2;
            sample.expect("a doubled triangle", &["duplicate-triangles"], |mesh| {
                let copy = mesh.faces[f].triangles[t];
                mesh.faces[f].triangles.push(copy);
            });
            sample.expect(
                "a triangle on its own back",
                &["duplicate-triangles", "inverted-triangles"],
                |mesh| {
                    let [a, b, c] = mesh.faces[f].triangles[t];
                    mesh.faces[f].triangles.push([b, a, c]);
                },
            );
        }
    }
}

#[test]
fn a_moved_vertex_inside_a_face_is_found() {
    let mut tried = 0;
    for sample in Sample::all() {
        for f in sample.faces() {
            for c in sample.corners(f, |o| matches!(o, Origin::Face(_))) {
                let normal = sample.mesh.faces[f].corners[c as usize].normal;
                for direction in [normal, -normal, normal.any_orthonormal_vector()] {
                    tried += 1;
                    sample.expect("a moved vertex", &["misplaced-vertices"], |mesh| {
                        let p = Sample::position(mesh, f, c);
                        mesh.positions[p] += direction * 2.0 * sample.tolerance;
                    });
                }
            }
        }
    }
    assert!(tried > 20, "only {tried} vertices inside faces");
}

#[test]
fn a_moved_vertex_on_an_edge_is_found() {
    let mut tried = 0;
    for sample in Sample::all() {
        for (e, line) in sample.mesh.edges.iter().enumerate().filter(|(_, line)| line.len() > 2).take(FACES) {
            let i = line.len() / 2;
            let curve = sample.part.edges[e].curve.as_deref().unwrap();
            let p = sample.mesh.positions[line[i] as usize];
            let tangent = curve.jet(curve.invert(p, None)).d1.normalize();
            let across = tangent.any_orthonormal_vector();
            let mut moved = |direction: DVec3, codes: &[&str]| {
                tried += 1;
                sample.expect("a moved vertex on an edge", codes, |mesh| {
                    mesh.positions[line[i] as usize] += direction * 2.0 * sample.tolerance;
                });
            };
            moved(across, &["misplaced-edge-sample"]);
            moved(tangent.cross(across), &["misplaced-edge-sample"]);
            // Along its curve it stays on the curve; but not where the faces' parameters say.
            moved(tangent, &["misplaced-vertices", "understated-gap"]);
        }
        let p = sample.mesh.origins.iter().position(|o| matches!(o, Origin::Vertex(_))).unwrap();
        sample.expect("a moved corner", &["misplaced-model-vertices"], |mesh| {
            mesh.positions[p] += DVec3::X * 2.0 * sample.tolerance;
        });
    }
    assert!(tried > 50, "only {tried} vertices on edges");
}

#[test]
fn a_t_vertex_is_found() {
    for sample in Sample::all() {
        for line in sample.mesh.edges.iter().filter(|line| line.len() > 1).take(FACES) {
            // The triangle of one face along the chord gets a vertex in the middle of it.
            let (p, q) = (line[0], line[1]);
            let of_chord = |mesh: &PartMesh| {
                mesh.faces.iter().enumerate().find_map(|(f, face)| {
                    let at = |c: u32| face.corners[c as usize].position;
                    let runs = |t: &[u32; 3]| (0..3).find(|&i| (at(t[i]), at(t[(i + 1) % 3])) == (p, q));
                    face.triangles.iter().enumerate().find_map(|(t, corners)| Some((f, t, runs(corners)?)))
                })
            };
            let split = |mesh: &mut PartMesh| {
                let (f, t, i) = of_chord(mesh).unwrap();
                let middle = mesh.positions[p as usize].midpoint(mesh.positions[q as usize]);
                mesh.positions.push(middle);
                mesh.origins.push(Origin::Face(f as u32));
                let position = mesh.positions.len() as u32 - 1;
                let face = &mut mesh.faces[f];
                let [a, b, c] = [0, 1, 2].map(|k| face.triangles[t][(i + k) % 3]);
                let (at_a, at_b) = (face.corners[a as usize], face.corners[b as usize]);
                face.corners.push(Corner { position, uv: at_a.uv.midpoint(at_b.uv), normal: at_a.normal });
                let m = face.corners.len() as u32 - 1;
                face.triangles[t] = [a, m, c];
                face.triangles.push([m, b, c]);
            };
            sample.expect("a T-vertex", &["stray-boundary"], split);
            sample.expect("the chord it broke", &["missing-chords"], split);
        }
    }
}

#[test]
fn a_missing_face_is_found() {
    for sample in Sample::all() {
        for f in sample.faces() {
            sample.expect("a missing face", &["missing-face"], |mesh| mesh.faces[f].triangles.clear());
        }
    }
}

#[test]
fn an_understated_bound_is_found() {
    let mut tried = 0;
    for mut sample in Sample::all() {
        for f in sample.faces().collect::<Vec<_>>() {
            let honest = sample.claims[f];
            if matches!(sample.surface(f), Surface::Plane { .. }) && honest.proven_error == 0.0 {
                continue;
            }
            tried += 1;
            sample.claims[f].proven_error = 0.5 * honest.proven_error;
            sample.expect("an understated bound", &["understated-error"], |_| ());
            sample.claims[f] = honest;
        }
    }
    assert!(tried > 10, "only {tried} curved faces");
    let mut sample = Sample::new("cylinder_seam_hole");
    let tightest =
        (0..sample.claims.len()).min_by(|&a, &b| sample.claims[a].gap.total_cmp(&sample.claims[b].gap));
    let f = tightest.unwrap();
    sample.mesh.faces[f].corners.iter_mut().for_each(|c| c.uv += DVec2::new(0.0, 5e-4 * sample.tolerance));
    sample.expect("an understated gap", &["understated-gap"], |_| ());
}

#[test]
fn an_error_proven_with_finer_enclosures_is_not_understated() {
    // As where facets were parted: the mesh, and what is proven of it, is much finer than the tolerance.
    for name in ["spline_ball", "revolution_bspline", "weight_range", "pipe_elbow"] {
        let part = common::load(name).parts.into_iter().find(|p| !p.faces.is_empty()).unwrap();
        let tolerance = 1e-2 * common::diagonal(&part);
        let (mesh, report) = common::mesh(&part, tolerance / 16.0, None);
        let audit = audit_part(&part, &mesh, &AuditOptions::new(tolerance), Some(&common::claims(&report)));
        assert!(audit.clean(), "{name}: {:?}", audit.problems);
    }
}

#[test]
fn a_bound_that_points_exceed_is_found() {
    // As if the bound itself, which mesher and audit share, were too small.
    let mut tried = 0;
    for mut sample in Sample::all() {
        for f in sample.faces().collect::<Vec<_>>() {
            let honest = sample.claims[f];
            if matches!(sample.surface(f), Surface::Plane { .. }) || !(honest.proven_error > 0.0) {
                continue;
            }
            tried += 1;
            sample.claims[f].proven_error = 0.2 * honest.proven_error;
            sample.expect("an unsound bound", &["bound-exceeded"], |_| ());
            sample.claims[f] = honest;
        }
    }
    assert!(tried > 10, "only {tried} curved faces");
}

#[test]
fn too_coarse_a_mesh_is_found() {
    for sample in Sample::all() {
        let tight = AuditOptions::new(0.5 * sample.tolerance);
        let audit = audit_part(&sample.part, &sample.mesh, &tight, Some(&sample.claims));
        assert!(
            audit.problems.iter().any(|p| p.issue.code() == "over-tolerance"),
            "{}: {:?}",
            sample.name,
            audit.problems
        );
        let rounded = AuditOptions::new(sample.tolerance).with_coordinate_rounding(0.5 * sample.tolerance);
        let audit = audit_part(&sample.part, &sample.mesh, &rounded, Some(&sample.claims));
        assert!(
            audit.problems.iter().any(|p| p.issue.code() == "over-tolerance"),
            "{}: {:?}",
            sample.name,
            audit.problems
        );
        let angle = AuditOptions::new(sample.tolerance).with_angle(Some(0.01));
        let audit = audit_part(&sample.part, &sample.mesh, &angle, None);
        assert!(
            audit.problems.iter().any(|p| p.issue.code() == "over-angle"),
            "{}: {:?}",
            sample.name,
            audit.problems
        );
    }
}

#[test]
fn a_filled_hole_is_found() {
    // The rim of a hole in a plane, closed by a fan of triangles.
    let sample = Sample::new("bracket");
    let mut tried = 0;
    for (e, line) in sample.mesh.edges.iter().enumerate() {
        let edge = &sample.part.edges[e];
        if edge.start != edge.end || line.len() < 4 {
            continue;
        }
        for f in 0..sample.part.faces.len() {
            if !matches!(sample.surface(f), Surface::Plane { .. }) || sample.part.faces[f].loops.len() < 2 {
                continue;
            }
            let corner = |p: u32| sample.mesh.faces[f].corners.iter().position(|c| c.position == p);
            let Some(rim) = line[..line.len() - 1].iter().map(|&p| corner(p)).collect::<Option<Vec<_>>>()
            else {
                continue;
            };
            tried += 1;
            sample.expect("a filled hole", &["missing-chords", "stray-boundary"], |mesh| {
                for k in 1..rim.len() - 1 {
                    // Whichever way round fits the triangles around the hole.
                    let fan = [rim[0] as u32, rim[k] as u32, rim[k + 1] as u32];
                    let uv = fan.map(|c| mesh.faces[f].corners[c as usize].uv);
                    let turns = (uv[1] - uv[0]).perp_dot(uv[2] - uv[0]) > 0.0;
                    let reversed = sample.part.faces[f].normal_reversed();
                    let t = if turns != reversed { fan } else { [fan[1], fan[0], fan[2]] };
                    mesh.faces[f].triangles.push(t);
                }
            });
        }
    }
    assert!(tried > 0, "no hole");
}

#[test]
fn other_faults_are_found() {
    for sample in Sample::all() {
        let long = sample.mesh.edges.iter().position(|line| line.len() > 2).unwrap();
        sample.expect("a skipped sample", &["broken-polyline"], |mesh| {
            mesh.edges[long].remove(1);
        });
        for f in sample.faces() {
            sample.expect("a wrong normal", &["wrong-normals"], |mesh| {
                let normal = &mut mesh.faces[f].corners[0].normal;
                *normal = -*normal;
            });
            sample.expect("a triangle without area", &["degenerate-triangles"], |mesh| {
                let [a, b, _] = mesh.faces[f].triangles[0];
                mesh.faces[f].triangles.push([a, b, a]);
            });
            sample.expect("a corner that does not exist", &["malformed-mesh"], |mesh| {
                mesh.faces[f].triangles[0][1] = u32::MAX;
            });
        }
        sample.expect("a crack", &["repeated-model-vertices", "broken-polyline", "malformed-mesh"], |mesh| {
            // One face gets a vertex of its own where it should share the model's.
            let c = mesh.faces[0]
                .corners
                .iter()
                .position(|c| !matches!(mesh.origins[c.position as usize], Origin::Face(_)));
            let corner = &mut mesh.faces[0].corners[c.unwrap()];
            let p = corner.position as usize;
            corner.position = mesh.positions.len() as u32;
            mesh.positions.push(mesh.positions[p]);
            mesh.origins.push(mesh.origins[p]);
        });
        if sample.part.shells[0].closed {
            sample.expect("a mesh inside out", &["inside-out"], |mesh| {
                mesh.faces.iter_mut().flat_map(|f| &mut f.triangles).for_each(|t| t.swap(0, 1));
            });
        }
    }
}
