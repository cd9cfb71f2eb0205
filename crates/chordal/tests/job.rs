//! The facade as a library user meets it.

use chordal::{Cancel, Closedness, Job, JobError, JobOptions, Progress, Tolerance};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

fn corpus(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../corpus").join(name).with_extension("step")
}

#[test]
fn progress_runs_through_the_stages_and_counts_every_face() {
    let heard = Arc::new(Mutex::new(Vec::new()));
    let listener = heard.clone();
    let job = Job::new(corpus("bracket"))
        .with_progress(Arc::new(move |progress| listener.lock().expect("no panic").push(progress)));
    chordal::run(&job).expect("a mesh");
    let heard = heard.lock().expect("no panic");
    assert_eq!(heard.first(), Some(&Progress::Reading));
    assert!(heard.contains(&Progress::Meshing { done: 0, faces: 28 }));
    assert!(heard.contains(&Progress::Meshing { done: 28, faces: 28 }), "{heard:?}");
    assert_eq!(heard.last(), Some(&Progress::Writing));
}

#[test]
fn a_cancelled_job_writes_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out.ply");
    let cancel = Cancel::default();
    let trigger = cancel.clone();
    let job = Job::new(corpus("bracket")).with_output(&out).with_cancel(cancel).with_progress(Arc::new(
        move |progress| {
            if matches!(progress, Progress::Meshing { .. }) {
                trigger.cancel();
            }
        },
    ));
    assert!(matches!(chordal::run(&job), Err(JobError::Cancelled { .. })));
    assert!(!out.exists());
}

/// A part placed three times as large must be meshed three times as finely in its own units.
#[test]
fn parts_get_their_tolerance_from_their_largest_placement() {
    let options = JobOptions::default().with_tolerance(Tolerance::Millimetres(0.3));
    let outcome = chordal::run(&Job::new(corpus("mapped_items")).with_options(options)).expect("a mesh");
    let part = outcome.report.parts.iter().find(|p| p.instances > 1).expect("a part that is placed often");
    assert!((part.tolerance - 0.1).abs() < 1e-9, "{}", part.tolerance);
    assert_eq!(outcome.report.faces.total, 32);
    assert_eq!(outcome.report.options.tolerance, 0.3);
}

/// What lies on the last fold belongs to the panel before it, with that panel's normal.
#[test]
fn a_face_that_ends_at_a_crease_gets_two_triangles_per_panel() {
    let outcome = chordal::run(&Job::new(corpus("folded_strip"))).expect("a mesh");
    assert!(outcome.report.clean, "{:?}", outcome.report.error_sentences());
    assert_eq!((outcome.report.triangles, outcome.report.edge_rounds), (6, 0));
}

/// The border of an offset of a free surface has no proven bound: that is said, and no edge is halved for it without end.
#[test]
fn edges_of_which_nothing_is_proven_end() {
    let path = corpus("bracket").with_file_name("iges").join("untrimmed.igs");
    let report = chordal::run(&Job::new(path)).expect("a mesh").report;
    assert!(
        report.error_sentences().iter().any(|u| u.contains("not proven") && u.contains("1 of 8 faces")),
        "{:?}",
        report.error_sentences()
    );
    assert!(report.triangles < 20_000, "{}", report.triangles);
    assert_eq!(report.faces.failed, 0);
    // One face without a proof takes nothing from the others.
    assert_eq!((report.faces.proven, report.unproven_faces.len()), (7, 1));
    assert!(report.proven_error.is_some_and(|e| e <= report.options.tolerance), "{:?}", report.proven_error);
    let sentence = report.proof_sentence();
    assert!(
        sentence.starts_with("7 of 8 faces proven within ") && sentence.contains("; 1 unproven: #"),
        "{sentence}"
    );
}

/// Only a mesh all of whose shells are closed is called watertight.
#[test]
fn closed_open_and_leaking_are_three_words() {
    let folder = corpus("bracket").with_file_name("");
    let judged = |name: &str| {
        let report = chordal::run(&Job::new(folder.join(name))).expect("a mesh").report;
        (report.closedness, report.closedness_sentence(), report.error_sentences())
    };
    let (closed, sentence, errors) = judged("bracket.step");
    assert_eq!((closed, sentence.as_str(), errors.len()), (Some(Closedness::Closed), "watertight", 0));
    for sheet in ["iges/bounded.igs", "folded_strip.step"] {
        let (open, sentence, errors) = judged(sheet);
        assert_eq!(
            (open, sentence.as_str(), errors.len()),
            (Some(Closedness::OpenByDesign), "open by design", 0)
        );
    }
    let (unknown, sentence, _) = judged("iv/polygons.iv");
    assert_eq!((unknown, sentence.as_str()), (None, "closedness not examined"));
    let (leaking, sentence, errors) = judged("bad/missing_entity.step");
    assert_eq!((leaking, sentence.as_str()), (Some(Closedness::Leaking), "leaking (1 of 1 closed shell)"));
    let leak = errors.iter().find(|e| e.contains("leaks")).expect("a sentence about the leak");
    assert!(leak.contains("1 missing face (#"), "{leak}");
}

#[test]
fn reports_survive_a_round_trip() {
    let report = chordal::run(&Job::new(corpus("bracket"))).expect("a mesh").report;
    let back: chordal::Report = serde_json::from_str(&report.to_json()).expect("JSON");
    assert_eq!(report, back);
}

#[test]
fn nothing_to_mesh_is_an_error_that_says_so() {
    let error = chordal::run(&Job::new(corpus("wireframe_only"))).expect_err("no face");
    let sentence = error.to_string();
    assert!(sentence.contains("wireframe_only.step") && !sentence.contains('\n'), "{sentence}");
}

/// Two arcs that leave a corner in one direction: chords of equal steps lie on one line, and the triangle between them has no area.
#[test]
fn no_corner_stays_shut() {
    for percent in [0.2, 0.5, 1.0, 2.0, 5.0] {
        for angle in [None, Some(10f64.to_radians()), Some(20f64.to_radians())] {
            let options = JobOptions::default().with_tolerance(Tolerance::Percent(percent)).with_angle(angle);
            let report =
                chordal::run(&Job::new(corpus("crescent")).with_options(options)).expect("a mesh").report;
            assert!(report.clean, "{percent} %, {angle:?}: {:?}", report.error_sentences());
        }
    }
}

/// A bent sheet with a strip between two creases that is far narrower than the tolerance and folded over: no facet there keeps
/// the angle.
#[test]
fn where_no_facet_keeps_the_angle_the_tolerance_comes_first() {
    let rows = [(-1.0, -0.8, 0.0), (0.0, 0.0, 0.0), (0.0006, 0.0002, 0.3), (1.0, -0.9, 0.0)];
    let columns = [(0.0, 0.0), (0.5, 0.6), (1.0, 0.6), (1.5, 0.0)];
    let at =
        |(y, z, shift): (f64, f64, f64)| columns.map(|(u, bend)| format!("{} {} {z}", u + shift, y + bend));
    let points = rows.map(|row| at(row).join(", ")).join(", ");
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("pleat.x3d");
    let text = format!(
        "#X3D V3.3 utf8\nPROFILE Interchange\nCOMPONENT NURBS : 4\n\nShape {{ geometry NurbsPatchSurface {{ solid FALSE \
         uOrder 4 vOrder 2 uDimension 4 vDimension 4 controlPoint Coordinate {{ point [ {points} ] }} }} }}\n"
    );
    std::fs::write(&path, text).expect("written");
    let report = chordal::run(&Job::new(path)).expect("a mesh").report;
    assert!(
        report.proven_error.is_some_and(|e| e <= report.options.tolerance),
        "{:?}",
        report.error_sentences()
    );
    assert!(report.triangles < 1_000, "{}", report.triangles);
    assert!(
        report.error_sentences().iter().any(|u| u.contains("along a mesh edge")),
        "{:?}",
        report.error_sentences()
    );
}

/// Weights from 0.001 to 1000: bounds are wild over the chords and beside them, and there are only so many rounds to make edges finer.
#[test]
fn wild_bounds_leave_rounds_enough() {
    for percent in [0.2, 0.5, 1.0] {
        for angle in [None, Some(20f64.to_radians())] {
            let options = JobOptions::default().with_tolerance(Tolerance::Percent(percent)).with_angle(angle);
            let job = Job::new(corpus("weight_range")).with_options(options);
            let report = chordal::run(&job).expect("a mesh").report;
            assert!(report.clean, "{percent} %, {angle:?}: {:?}", report.error_sentences());
        }
    }
}
