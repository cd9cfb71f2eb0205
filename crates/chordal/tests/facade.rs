//! The facade as a library user meets it.

use chordal::{
    Cancel, Closedness, Error, FileError, InputFormat, MeshOptions, Meshed, Mesher, Model, OutputFormat,
    Phase, Report, RequestError, Tolerance,
};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};

fn corpus(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../corpus").join(name).with_extension("step")
}

fn mesh(path: impl AsRef<Path>, options: MeshOptions) -> Meshed {
    Mesher::new(options).mesh(&Model::open(path).expect("a model")).expect("a mesh")
}

fn report(path: impl AsRef<Path>) -> Report {
    mesh(path, MeshOptions::default()).into_report()
}

#[test]
fn progress_runs_through_the_phases() {
    let heard = Arc::new(Mutex::new(Vec::new()));
    let listener = heard.clone();
    let mesher = Mesher::default().with_progress(move |phase, fraction| {
        listener.lock().expect("no panic").push((phase, fraction));
        ControlFlow::Continue(())
    });
    mesher.mesh(&Model::open(corpus("bracket")).expect("a model")).expect("a mesh");
    let heard = heard.lock().expect("no panic");
    assert_eq!(heard.first(), Some(&(Phase::Sewing, 0.0)));
    assert!(heard.contains(&(Phase::Meshing, 0.0)) && heard.contains(&(Phase::Meshing, 1.0)), "{heard:?}");
    assert_eq!(heard.last(), Some(&(Phase::Auditing, 0.0)));
}

#[test]
fn a_run_is_cancelled_by_its_callback_or_by_a_flag() {
    let model = Model::open(corpus("bracket")).expect("a model");
    let breaks = Arc::new(AtomicBool::new(true));
    let flag = breaks.clone();
    let mesher = Mesher::default().with_progress(move |phase, _| {
        let stops = phase == Phase::Meshing && flag.load(Ordering::Relaxed);
        if stops { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    assert!(matches!(mesher.mesh(&model), Err(Error::Cancelled)));
    // A run that was cancelled by its callback leaves later ones alone.
    breaks.store(false, Ordering::Relaxed);
    assert!(mesher.mesh(&model).is_ok());

    let cancel = Cancel::default();
    cancel.cancel();
    assert!(matches!(Mesher::default().with_cancel(cancel).mesh(&model), Err(Error::Cancelled)));
}

#[test]
fn triangles_of_mirrored_and_scaled_placements_face_outwards() {
    for name in ["mapped_items", "mapped_cylinder_mirrored"] {
        let meshed = mesh(corpus(name), MeshOptions::default());
        assert_eq!(meshed.triangles().count(), meshed.report().triangles, "{name}");
        for triangle in meshed.triangles() {
            let [a, b, c] = triangle.positions;
            let normal = (b - a).cross(c - a).normalize();
            assert!(triangle.normals.iter().all(|n| n.dot(normal) > 0.5), "{name}: {triangle:?}");
        }
        let mirrored = (0..meshed.placement_count())
            .filter(|&i| meshed.placement(i).is_some_and(|world| world.matrix3.determinant() < 0.0));
        assert!(mirrored.count() > 0, "{name}");
    }
}

#[test]
fn a_file_in_memory_is_the_file_on_disk() {
    let folder = tempfile::tempdir().expect("a folder");
    let bytes = std::fs::read(corpus("bracket")).expect("bytes");
    let meshed = Mesher::default().mesh(&Model::from_bytes(&bytes, None).expect("a model")).expect("a mesh");
    for (name, format) in
        [("a.ply", OutputFormat::Ply), ("a.stl", OutputFormat::StlBinary), ("a.3mf", OutputFormat::ThreeMf)]
    {
        let path = folder.path().join(name);
        meshed.write(&path).expect("written");
        assert!(std::fs::read(&path).expect("bytes") == meshed.to_bytes(format).expect("bytes"), "{name}");
    }
    assert!(matches!(
        meshed.write(folder.path().join("a.dwg")),
        Err(Error::Request(RequestError::OutputExtension { .. }))
    ));
    let wrong = Model::from_bytes(&bytes, InputFormat::Iges).map(|model| model.face_count());
    assert!(matches!(wrong, Err(Error::File { .. })), "{wrong:?}");
}

#[test]
fn what_cannot_be_is_an_error_that_can_be_matched() {
    let model = Model::open(corpus("bracket")).expect("a model");
    let fine = MeshOptions::default().with_tolerance(Tolerance::Millimetres(1e-18));
    let error = Mesher::new(fine).mesh(&model).expect_err("too fine");
    assert!(
        matches!(error, Error::Request(RequestError::ToleranceTooFine { minimum, .. }) if minimum > 1e-18)
    );
    let missing = Model::open("no-such-file.step").expect_err("no file");
    assert!(matches!(missing, Error::File { reason: FileError::Io(_), .. }), "{missing}");
}

/// A part placed three times as large must be meshed three times as finely in its own units.
#[test]
fn parts_get_their_tolerance_from_their_largest_placement() {
    let options = MeshOptions::default().with_tolerance(Tolerance::Millimetres(0.3));
    let report = mesh(corpus("mapped_items"), options).into_report();
    let part = report.parts.iter().find(|p| p.instances > 1).expect("a part that is placed often");
    assert!((part.tolerance - 0.1).abs() < 1e-9, "{}", part.tolerance);
    assert_eq!(report.faces.total, 32);
    assert_eq!(report.options.tolerance, 0.3);
}

/// What lies on the last fold belongs to the panel before it, with that panel's normal.
#[test]
fn a_face_that_ends_at_a_crease_gets_two_triangles_per_panel() {
    let report = report(corpus("folded_strip"));
    assert!(report.clean, "{:?}", report.error_sentences());
    assert_eq!((report.triangles, report.edge_rounds), (6, 0));
}

/// The border of an offset of a free surface has no proven bound: that is said, and no edge is halved for it
/// without end.
#[test]
fn edges_of_which_nothing_is_proven_end() {
    let path = corpus("bracket").with_file_name("iges").join("untrimmed.igs");
    let report = report(path);
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
        let report = report(folder.join(name));
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
    let report = report(corpus("bracket"));
    let back: Report = serde_json::from_str(&report.to_json()).expect("JSON");
    assert_eq!(report, back);
}

#[test]
fn nothing_to_mesh_is_an_error_that_says_so() {
    let error = Model::open(corpus("wireframe_only")).expect_err("no face");
    let sentence = error.to_string();
    assert!(sentence.contains("wireframe_only.step") && !sentence.contains('\n'), "{sentence}");
}

/// Two arcs that leave a corner in one direction: chords of equal steps lie on one line, and the triangle
/// between them has no area.
#[test]
fn no_corner_stays_shut() {
    for percent in [0.2, 0.5, 1.0, 2.0, 5.0] {
        for angle in [None, Some(10f64.to_radians()), Some(20f64.to_radians())] {
            let options =
                MeshOptions::default().with_tolerance(Tolerance::Percent(percent)).with_angle(angle);
            let report = mesh(corpus("crescent"), options).into_report();
            assert!(report.clean, "{percent} %, {angle:?}: {:?}", report.error_sentences());
        }
    }
}

/// A bent sheet with a strip between two creases that is far narrower than the tolerance and folded over: no
/// facet there keeps the angle.
#[test]
fn where_no_facet_keeps_the_angle_the_tolerance_comes_first() {
    let rows = [(-1.0, -0.8, 0.0), (0.0, 0.0, 0.0), (0.0006, 0.0002, 0.3), (1.0, -0.9, 0.0)];
    let columns = [(0.0, 0.0), (0.5, 0.6), (1.0, 0.6), (1.5, 0.0)];
    let at =
        |(y, z, shift): (f64, f64, f64)| columns.map(|(u, bend)| format!("{} {} {z}", u + shift, y + bend));
    let points = rows.map(|row| at(row).join(", ")).join(", ");
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("pleat.x3d");
    let text = format!(
        "#X3D V3.3 utf8\nPROFILE Interchange\nCOMPONENT NURBS : 4\n\nShape {{ geometry NurbsPatchSurface {{ \
         solid FALSE \
         uOrder 4 vOrder 2 uDimension 4 vDimension 4 controlPoint Coordinate {{ point [ {points} ] }} }} }}\n"
    );
    std::fs::write(&path, text).expect("written");
    let report = report(path);
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

/// Weights from 0.001 to 1000: bounds are wild over the chords and beside them, and there are only so many
/// rounds to make edges finer.
#[test]
fn wild_bounds_leave_rounds_enough() {
    for percent in [0.2, 0.5, 1.0] {
        for angle in [None, Some(20f64.to_radians())] {
            let options =
                MeshOptions::default().with_tolerance(Tolerance::Percent(percent)).with_angle(angle);
            let report = mesh(corpus("weight_range"), options).into_report();
            assert!(report.clean, "{percent} %, {angle:?}: {:?}", report.error_sentences());
        }
    }
}

/// Everything that a program passes between its threads can be passed, and printed for debugging.
#[test]
fn types_of_the_facade_can_be_shared_between_threads() {
    fn shared<T: Send + Sync + std::fmt::Debug + 'static>() {}
    fn shared_and_cloned<T: Send + Sync + Clone + std::fmt::Debug + 'static>() {}
    shared_and_cloned::<Model>();
    shared_and_cloned::<MeshOptions>();
    shared_and_cloned::<Mesher>();
    shared_and_cloned::<Meshed>();
    shared_and_cloned::<Report>();
    shared_and_cloned::<Cancel>();
    shared_and_cloned::<chordal::QuantityError>();
    shared::<Error>();
}
