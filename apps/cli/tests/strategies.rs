//! Strategies on the command line: by name, compared, drawn, the same for any number of threads.

mod common;

use common::{files_in, model, run};

#[test]
fn a_comparison_is_a_table_and_a_plot() {
    let folder = tempfile::tempdir().expect("a folder");
    let plot = folder.path().join("plot.svg");
    let ran = run(
        "compare {} --tolerance 0.5% --strategies default,kd-worst,quadtree --both-bounds --json -q --plot \
         {}",
        &[&model("blade"), &plot],
    )
    .exits(&[0]);
    let found: serde_json::Value = serde_json::from_str(&ran.stdout).expect("JSON");
    let rows = found["rows"].as_array().expect("rows");
    assert_eq!(rows.len(), 6);
    let tolerance = found["tolerance"].as_f64().expect("a number");
    for row in rows {
        let proven = row["bound"] == "proven";
        assert_eq!(row["proven_error"].as_f64().is_some_and(|e| e <= tolerance), proven, "{row}");
        assert!(row["triangles"].as_u64() > Some(0) && row["ratio"].as_f64() > Some(1.0), "{row}");
        assert!(!row["stages"].as_array().expect("stages").is_empty(), "{row}");
    }
    let drawn = std::fs::read_to_string(plot).expect("a plot");
    assert!(drawn.starts_with("<svg") && drawn.contains("quadtree, estimated"));

    let table = run("compare {} --tolerance 1% --strategies grid -q", &[&model("blade")]).exits(&[0]).stdout;
    assert!(table.contains("triangles") && table.lines().any(|l| l.starts_with("grid")), "{table}");
}

#[test]
fn unknown_strategies_are_refused_by_name() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out.stl");
    let ran = run("mesh {} -o {} --strategy kd", &[&model("blade"), &out]).exits(&[2]).says_one_sentence();
    assert!(ran.stderr.contains("kd"), "{}", ran.stderr);
    assert!(!out.exists());
}

/// An option of the accuracy changes the mesh of a strategy or edge method, or is refused by its name.
#[test]
fn options_have_an_effect_on_every_method_or_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out.ply");
    let strategies = chordal::methods::strategies().iter().map(|entry| ("--strategy", entry.name));
    let edge_methods = chordal::methods::edge_methods().iter().map(|entry| ("--edge-method", entry.name));
    for (kind, method) in strategies.chain(edge_methods) {
        for bound in ["proven", "estimated"] {
            let mesh = |options: &str| {
                let line = format!(
                    "mesh {{}} -o {{}} -q --tolerance 0.5% {kind} {method} --bound {bound} {options}"
                );
                let ran = run(&line, &[&model("fillet_bspline"), &out]).exits(&[0, 2]);
                if ran.code == 2 { Err(ran.stderr) } else { Ok(std::fs::read(&out).expect("a mesh")) }
            };
            let plain = mesh("").expect("a mesh");
            for option in ["--angle 3deg", "--max-edge 3mm", "--boundary-tolerance 0.01%"] {
                let name = option.split(' ').next().unwrap_or_default();
                match mesh(option) {
                    Ok(bytes) => assert!(bytes != plain, "{option} has no effect: {method}, {bound}"),
                    Err(sentence) => assert!(sentence.contains(name), "{method}, {bound}: {sentence}"),
                }
            }
        }
    }
}

#[test]
fn every_meshed_face_is_drawn() {
    let folder = tempfile::tempdir().expect("a folder");
    let (out, drawings) = (folder.path().join("out.stl"), folder.path().join("drawings"));
    run("mesh {} -o {} --strategy kd-worst --debug-svg {}", &[&model("blade"), &out, &drawings]).exits(&[0]);
    assert_eq!(files_in(&drawings).len(), 4);
    let face = std::fs::read_to_string(drawings.join("part0_face0.svg")).expect("a drawing");
    assert!(face.matches("<rect").count() > 2, "cells are drawn");
}

#[test]
fn threads_do_not_change_a_byte_of_any_strategy() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out.ply");
    for strategy in ["kd-worst", "cells", "quadtree", "delaunay-adaptive"] {
        let bytes = |jobs: &str| {
            let line = format!("mesh {{}} -o {{}} --tolerance 0.5% --strategy {strategy} --jobs {jobs}");
            run(&line, &[&model("fillet_torus"), &out]).exits(&[0]);
            std::fs::read(&out).expect("a mesh")
        };
        assert!(bytes("1") == bytes("4"), "{strategy}");
    }
}

#[test]
fn quadrilaterals_reach_the_file_and_the_file_is_closed() {
    let folder = tempfile::tempdir().expect("a folder");
    for (extension, name) in [("obj", "fillet_bspline"), ("ply", "torus_full")] {
        let out = folder.path().join(format!("out.{extension}"));
        let report = folder.path().join("r.json");
        let line = "mesh {} -o {} --strategy bezier --quads --tolerance 0.5% --report {} -q";
        run(line, &[&model(name), &out, &report]).exits(&[0]);
        run("check {}", &[&out]).exits(&[0]);
        let report: serde_json::Value =
            serde_json::from_slice(&std::fs::read(&report).expect("a report")).expect("JSON");
        let stage = |name: &str| {
            let stages = report["stages"].as_array().expect("stages");
            stages.iter().find(|s| s["name"] == name).map_or(0, |s| s["count"].as_u64().expect("a count"))
        };
        assert!(stage("quadrilaterals") > 0 && stage("scanlines") > 0, "{name}");
        let bytes = std::fs::read(&out).expect("a mesh");
        let text = String::from_utf8_lossy(&bytes);
        let triangles = report["triangles"].as_u64().expect("a number");
        let polygons = match extension {
            "obj" => text.lines().filter(|l| l.starts_with("f ")).count() as u64,
            _ => {
                let line = text.lines().find(|l| l.starts_with("element face ")).expect("a header");
                line.rsplit(' ').next().expect("a word").parse().expect("a number")
            }
        };
        // Every quadrilateral that the proof left whole saves one polygon.
        assert!(polygons < triangles, "{name}: {polygons} of {triangles}");
        assert!(triangles - polygons <= stage("quadrilaterals"), "{name}");
    }
}

#[test]
fn quadrilaterals_of_other_strategies_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out.obj");
    let ran = run("mesh {} -o {} --quads", &[&model("blade"), &out]).exits(&[2]).says_one_sentence();
    assert!(ran.stderr.contains("bezier"), "{}", ran.stderr);
}

#[test]
fn edges_and_facets_have_tolerances_of_their_own() {
    let folder = tempfile::tempdir().expect("a folder");
    let (out, report) = (folder.path().join("out.stl"), folder.path().join("r.json"));
    let line = "mesh {} -o {} --tolerance 0.1mm --boundary-tolerance 0.01mm --report {} -q";
    run(line, &[&model("fillet_torus"), &out, &report]).exits(&[0]);
    let report: serde_json::Value =
        serde_json::from_slice(&std::fs::read(&report).expect("a report")).expect("JSON");
    assert_eq!(report["options"]["boundary_tolerance"], 0.01);
    assert!(report["boundary_error"].as_f64().is_some_and(|e| e > 0.0 && e <= 0.01));
    assert!(report["proven_error"].as_f64().is_some_and(|e| e > 0.01 && e <= 0.1));
}

/// Every edge method runs its own parts, keeps the proof and the file watertight.
#[test]
fn edge_methods_run_their_own_parts_and_keep_the_proof() {
    let folder = tempfile::tempdir().expect("a folder");
    let (out, report) = (folder.path().join("out.ply"), folder.path().join("report.json"));
    for (method, part) in [
        ("bezier2d", "chords in planes of parameters"),
        ("bezier3d", "lifted Bézier pieces"),
        ("bezier3d-point", "lifted Bézier pieces"),
        ("bezier3d-worst-line", "lifted Bézier pieces"),
    ] {
        for name in ["fillet_bspline", "pcurve_trims", "sphere_holes", "fillet_torus", "chamfers"] {
            let line = format!("mesh {{}} -o {{}} --angle off --edge-method {method} --report {{}} -q");
            run(&line, &[&model(name), &out, &report]).exits(&[0]);
            let text = std::fs::read_to_string(&report).expect("a report");
            let found: serde_json::Value = serde_json::from_str(&text).expect("JSON");
            assert_eq!(found["options"]["edge_method"], method);
            let ran = found["stages"].as_array().expect("stages").iter().any(|s| s["name"] == part);
            assert!(ran, "{method} of {name}: {}", found["stages"]);
            let proven = found["proven_error"].as_f64().expect("proven");
            assert!(
                proven <= found["options"]["tolerance"].as_f64().expect("a number"),
                "{method} of {name}"
            );
        }
    }
}

#[test]
fn both_conventions_of_trimming_loops_can_be_asked_for() {
    let folder = tempfile::tempdir().expect("a folder");
    let (file, out, report) =
        (folder.path().join("a.iv"), folder.path().join("a.stl"), folder.path().join("r.json"));
    // A plane, 4 × 4, with a square hole, or a square that alone is left.
    let text = "#Inventor V2.1 ascii\nSeparator { Coordinate3 { point [0 0 0, 4 0 0, 0 4 0, 4 4 0] }\n\
        ProfileCoordinate2 { point [0.25 0.25, 0.75 0.25, 0.75 0.75, 0.25 0.75] }\n\
        LinearProfile { index [0, 1, 2, 3, 0] }\n\
        NurbsSurface { numUControlPoints 2 numVControlPoints 2 uKnotVector [0 0 1 1] vKnotVector [0 0 1 1] \
        } }\n";
    std::fs::write(&file, text).expect("written");
    for (winding, area) in [("odd", 4.0), ("even", 12.0)] {
        let line = format!("mesh {{}} -o {{}} --winding {winding} --unit m --report {{}} -q");
        run(&line, &[&file, &out, &report]).exits(&[0]);
        let report: serde_json::Value =
            serde_json::from_slice(&std::fs::read(&report).expect("a report")).expect("JSON");
        let found = report["area"].as_f64().expect("a number") / 1e6;
        assert!((found - area).abs() < 1e-9, "{winding}: {found}");
    }
}
