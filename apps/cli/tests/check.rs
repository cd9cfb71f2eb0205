//! `chordal check`: meshes of ours, and meshes with faults put in.

mod common;

use common::{model, run};
use std::fs;
use std::path::Path;

fn report(line: &str, paths: &[&Path], code: i32) -> serde_json::Value {
    let ran = run(line, paths).exits(&[code]);
    serde_json::from_str(&ran.stdout).expect("JSON")
}

#[test]
fn our_meshes_are_sound_in_every_format() {
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["m.stl", "m.ply", "m.obj", "m.glb", "m.3mf"] {
        let out = folder.path().join(name);
        run("mesh {} -o {} -q", &[&model("bracket"), &out]).exits(&[0]);
        let found = report("check {} --json", &[&out], 0);
        assert_eq!((&found["closed"], &found["oriented"]), (&true.into(), &true.into()), "{name}");
        // The volume of the mesh does not depend on the unit or the axes of the format.
        let volume = found["volume"].as_f64().expect("a volume");
        assert!((volume / 76352.0 - 1.0).abs() < 0.01, "{name}: {volume}");
    }
}

#[test]
fn distances_are_measured_both_ways() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("m.ply");
    run("mesh {} -o {} -q --tolerance 0.1mm", &[&model("bracket"), &out]).exits(&[0]);
    let line = "check {} --against {} --tolerance 0.12mm --json";
    let found = report(line, &[&out, &model("bracket")], 0);
    let against = &found["against"];
    let within = against["reference_error"].as_f64().expect("a proof");
    for way in ["mesh_to_model", "model_to_mesh"] {
        let distance = against[way].as_f64().expect("a distance");
        assert!(distance > 0.02 && distance <= 0.1 + within, "{way}: {distance}");
        let beyond = against[format!("{way}_beyond_gap")].as_f64().expect("a distance");
        assert!(beyond <= distance && beyond <= 0.1, "{way}: {beyond}");
    }
    report("check {} --against {} --tolerance 0.01mm --json", &[&out, &model("bracket")], 1);
    let other = report("check {} --against {} --json", &[&out, &model("sphere_full")], 0);
    assert!(other["against"]["mesh_to_model"].as_f64() > Some(1.0));
}

#[test]
fn a_triangle_taken_out_turned_or_doubled_is_found() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("m.stl");
    run("mesh {} -o {} -q", &[&model("bracket"), &out]).exits(&[0]);
    let sound = fs::read(&out).expect("a mesh");
    let count = u32::from_le_bytes(sound[80..84].try_into().expect("four bytes"));
    let triangles: Vec<[u8; 50]> =
        sound[84..].chunks_exact(50).map(|t| t.try_into().expect("fifty")).collect();
    let write = |triangles: &[[u8; 50]]| {
        let mut bytes = sound[..80].to_vec();
        bytes.extend((triangles.len() as u32).to_le_bytes());
        bytes.extend(triangles.iter().flatten());
        fs::write(&out, bytes).expect("a file");
    };
    assert_eq!(triangles.len(), count as usize);

    write(&triangles[1..]);
    let found = report("check {} --json", &[&out], 1);
    assert_eq!((&found["closed"], &found["open_edges"]), (&false.into(), &3.into()));

    let mut turned = triangles.clone();
    for byte in 12..24 {
        turned[0].swap(byte, byte + 12);
    }
    write(&turned);
    let found = report("check {} --json", &[&out], 1);
    assert_eq!((&found["oriented"], &found["inconsistent_edges"]), (&false.into(), &3.into()));

    let mut doubled = triangles.clone();
    doubled.push(triangles[0]);
    write(&doubled);
    assert_eq!(report("check {} --json", &[&out], 1)["duplicate_triangles"], 1);
}

#[test]
fn what_is_no_mesh_is_one_sentence() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("m.ply");
    fs::write(&out, "ply\nno such thing\n").expect("a file");
    run("check {}", &[&out]).exits(&[2]).says_one_sentence();
    run("check nowhere.stl", &[]).exits(&[2]).says_one_sentence();
    run("check {}", &[&model("bracket")]).exits(&[2]).says_one_sentence();
}

#[test]
fn distances_are_given_with_and_without_the_gap_of_the_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("m.ply");
    let report_at = folder.path().join("r.json");
    run("mesh {} -o {} -q --tolerance 0.1mm --report {}", &[&model("loose_edges"), &out, &report_at])
        .exits(&[0, 1]);
    let found = report("check {} --against {} --json", &[&out, &model("loose_edges")], 0);
    let value = |name: &str| found["against"][name].as_f64().expect("a distance");
    let claimed: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(&report_at).expect("a report")).expect("JSON");
    let proven = claimed["proven_error"].as_f64().expect("a proof");
    for way in ["mesh_to_model", "model_to_mesh"] {
        assert!(value(&format!("{way}_beyond_gap")) <= 1.000_001 * proven, "{way}: {proven}");
    }
    // The edges lie 0.3 mm off the cylinder, on which the mesh is farthest from the model.
    assert!(value("mesh_to_model") > 0.05 && value("mesh_to_model_beyond_gap") < 0.01);
}
