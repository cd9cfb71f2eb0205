//! The smallest piece of a model that shows the problem of a face.

mod common;

use common::{corpus, json, run};
use std::path::Path;

/// The codes of the problems of a run, with exit code 1 or 2.
fn codes(input: &Path) -> String {
    let ran = run("mesh {} -o - --format stl -v", &[input]);
    assert!(ran.code > 0, "{}", ran.stderr);
    ran.stderr
}

/// Models of the corpus, a face of each, and its problem.
const PROBLEMS: [(&str, &str, &str); 4] = [
    ("bad/zero_direction.step", "#185", "unbounded-face"),
    ("offset_bspline.step", "#363", "unproven-face"),
    ("touching_loops.step", "#201", "loops-untangled"),
    ("weight_negative.step", "#61", "unproven-face"),
];

#[test]
fn a_piece_shows_the_problem_of_the_face_and_has_no_names() {
    let folder = tempfile::tempdir().expect("a folder");
    let (report, piece) = (folder.path().join("r.json"), folder.path().join("piece.json"));
    let model = corpus().join("bad/wrong_types.step");
    run("mesh {} -o {} -q --report {}", &[&model, &folder.path().join("m.stl"), &report]).exits(&[1]);
    let report = json(&report);
    let problems = report["problems"].as_array().expect("problems");
    let failed = problems.iter().filter(|p| p["severity"] == "error" && p["face"].is_u64());
    let mut shown = 0;
    for problem in failed {
        let (face, code) =
            (problem["entity"].as_str().expect("an entity"), problem["code"].as_str().expect("a code"));
        let ran = run(&format!("repro {{}} --face {face} -o {{}} --json"), &[&model, &piece]).exits(&[0]);
        let found: serde_json::Value = serde_json::from_str(&ran.stdout).expect("JSON");
        assert_eq!((&found["shows"], &found["faces"]), (&true.into(), &1.into()), "{found}");
        assert!(found["codes"].as_array().expect("codes").iter().any(|c| c == code), "{found}");
        assert!(codes(&piece).contains(face), "{face}");
        let piece = json(&piece);
        assert_eq!(piece["parts"][0]["faces"].as_array().map(Vec::len), Some(1));
        assert!(piece["name"] == "" && piece["parts"][0]["name"].as_str().is_none_or(str::is_empty));
        shown += 1;
    }
    assert!(shown > 0, "{problems:?}");
}

#[test]
fn problems_of_meshing_are_shown_by_the_piece() {
    let folder = tempfile::tempdir().expect("a folder");
    let piece = folder.path().join("piece.json");
    for (name, face, code) in PROBLEMS {
        let ran =
            run(&format!("repro {{}} --face {face} -o {{}}"), &[&corpus().join(name), &piece]).exits(&[0]);
        assert!(ran.stderr.contains("1 face; `chordal mesh") && ran.stderr.contains(code), "{}", ran.stderr);
        let (mesh, report) = (folder.path().join("m.ply"), folder.path().join("r.json"));
        let ran = run("mesh {} -o {} --report {}", &[&piece, &mesh, &report]);
        // Where the face is all there is and fails, there is no report; the sentence names it.
        match ran.code {
            2 => {
                assert!(ran.stderr.contains("none of 1 face") && ran.stderr.contains(face), "{}", ran.stderr)
            }
            _ => {
                let report = json(&report);
                let problems = report["problems"].as_array().expect("problems");
                assert!(
                    problems.iter().any(|p| p["code"] == code && p["entity"] == face),
                    "{name}: {problems:?}"
                );
            }
        }
    }
}

#[test]
fn a_piece_in_step_shows_the_same_problem() {
    let folder = tempfile::tempdir().expect("a folder");
    let piece = folder.path().join("piece.step");
    for (name, face, code) in PROBLEMS {
        let ran =
            run(&format!("repro {{}} --face {face} -o {{}}"), &[&corpus().join(name), &piece]).exits(&[0]);
        assert!(ran.stderr.contains("`chordal mesh") && ran.stderr.contains(code), "{}", ran.stderr);
        let text = std::fs::read_to_string(&piece).expect("a file");
        assert!(
            text.contains("FILE_NAME('','',(''),(''),'','','')") && text.contains(&format!("\n{face}=")),
            "{name}"
        );
        let info = run("info {} --json", &[&piece]).exits(&[0]).stdout;
        let info: serde_json::Value = serde_json::from_str(&info).expect("JSON");
        assert_eq!(info["faces"], 1, "{name}");
        let problems = info["problems"].as_array().expect("problems");
        let of_frame = ["no-products", "shape-without-product", "no-top-product", "unit-missing"];
        assert!(!problems.iter().any(|p| of_frame.iter().any(|code| p["code"] == *code)), "{problems:?}");
    }
    // Strings are empty, but for the names of units.
    run("repro {} --face @0 -o {}", &[&common::model("mixed_units"), &piece]).exits(&[0]);
    let text = std::fs::read_to_string(&piece).expect("a file");
    let strings: std::collections::BTreeSet<&str> = text.split('\'').skip(1).step_by(2).collect();
    assert!(!strings.iter().any(|s| s.contains("mixed")), "{strings:?}");
    let iges = corpus().join("iges/bounded.igs");
    run("repro {} --face @0 -o {}", &[&iges, &folder.path().join("p.step")]).exits(&[2]).says_one_sentence();
}

#[test]
fn faces_without_problems_are_written_and_unknown_ones_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let piece = folder.path().join("piece.json");
    let model = common::model("bracket");
    let ran = run("repro {} --face @3 -o {}", &[&model, &piece]).exits(&[0]);
    assert!(ran.stderr.contains("has no problem"), "{}", ran.stderr);
    run("mesh {} -o {} -q", &[&piece, &folder.path().join("m.stl")]).exits(&[0]);
    for line in ["repro {} --face 1 -o {}", "repro {} --face @999 -o {}", "repro {} --face x -o {}"] {
        run(line, &[&model, &folder.path().join("b.json")]).exits(&[2]).says_one_sentence();
    }
    run("repro {} --face @3 -o {}", &[&model, &folder.path().join("b.stl")]).exits(&[2]).says_one_sentence();
    assert!(!folder.path().join("b.json").exists());
}
