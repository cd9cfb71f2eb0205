//! Wavefront OBJ: the files of the specification's examples, and what is wrong with made ones.

mod common;

use chordal_brep::{FaceGeometry, LooseKind, Model};
use chordal_nurbs::{DVec2, DVec3};
use common::{read_bytes, read_file};
use proptest::prelude::*;
use std::path::PathBuf;

fn failures(model: &Model) -> Vec<String> {
    let faces = model.parts.iter().flat_map(|part| &part.faces);
    let failed = faces.filter_map(|face| match &face.geometry {
        FaceGeometry::Failed(reason) => Some(reason.to_string()),
        FaceGeometry::Surface(_) => None,
    });
    failed.collect()
}

fn model(text: &str) -> Model {
    read_bytes(text.as_bytes(), "part").expect("readable")
}

#[test]
fn every_surface_of_real_files_arrives() {
    let given = std::env::var_os("CHORDAL_MODELS").map(PathBuf::from);
    let beside = || PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/models");
    let folder = given.unwrap_or_else(beside).join("obj");
    let Ok(entries) = std::fs::read_dir(&folder) else {
        println!("SKIPPED: no models at {}", folder.display());
        return;
    };
    for path in entries.map(|entry| entry.expect("an entry").path()) {
        let text = std::fs::read_to_string(&path).expect("text");
        let model = read_file(&path).expect("readable");
        let surfaces = text.lines().filter(|line| line.starts_with("surf ")).count();
        assert_eq!(model.placed_faces(), surfaces, "{}", path.display());
        // Its knots in v are all the same, and the curve that trims it is not in the file.
        let failed = usize::from(path.ends_with("freeform_geometry__trimmed_surface_obj.obj"));
        assert_eq!(failures(&model).len(), failed, "{}: {:?}", path.display(), failures(&model));
        let loose =
            text.lines().filter(|l| l.starts_with("scrv ") || l.starts_with("sp ") || l.starts_with("curv "));
        assert_eq!(model.parts[0].loose.len(), loose.count(), "{}", path.display());
    }
}

/// A square of side 10 whose control points run first along u = x, with what comes before and inside of it.
fn square(before: &str, inside: &str) -> String {
    format!(
        "# a square\nv 0 0 0\nv 10 0 0\nv 0 10 0\nv 10 10 5\nvp .2 .2\nvp .8 .2\nvp .8 .8\nvp .2 .8\n\
         cstype bezier\ndeg 1\ncurv2 1 2 3 4 1\nparm u 0 1 2 3 4\nend\ndeg 1 1\n{before}\n\
         surf 0 1 0 1 1 2 3 4\nparm u 0 1\nparm v 0 1\n{inside}\nend\n"
    )
}

fn point_of(model: &Model, uv: [f64; 2]) -> DVec3 {
    match &model.parts[0].faces[0].geometry {
        FaceGeometry::Surface(surface) => surface.point(DVec2::from(uv)),
        FaceGeometry::Failed(reason) => panic!("{reason}"),
    }
}

#[test]
fn control_points_run_along_u_first() {
    let model = model(&square("", ""));
    assert_eq!(point_of(&model, [1.0, 0.0]), DVec3::new(10.0, 0.0, 0.0));
    assert_eq!(point_of(&model, [0.0, 1.0]), DVec3::new(0.0, 10.0, 0.0));
}

#[test]
fn trims_and_holes() {
    let loops = |inside: &str| {
        let model = model(&square("", inside));
        assert_eq!(failures(&model), [""; 0]);
        model.parts[0].faces.iter().map(|face| face.loops.len()).collect::<Vec<_>>()
    };
    assert_eq!(loops(""), [1]);
    assert_eq!(loops("trim 0 4 1"), [1]);
    assert_eq!(loops("hole 0 4 1"), [2]);
    // Backwards, and in two parts.
    assert_eq!(loops("hole 4 0 1"), [2]);
    assert_eq!(loops("trim 2 4 1 0 2 1"), [1]);
}

#[test]
fn a_surface_may_be_part_of_its_spline() {
    let whole = model(&square("", ""));
    let quarter = model(&square("", "").replace("surf 0 1 0 1", "surf .25 .5 0 .5"));
    assert_eq!(point_of(&quarter, [0.3, 0.4]), point_of(&whole, [0.3, 0.4]));
    let FaceGeometry::Surface(surface) = &quarter.parts[0].faces[0].geometry else { panic!("a face") };
    assert_eq!((surface.domain().min, surface.domain().max), (DVec2::new(0.25, 0.0), DVec2::splat(0.5)));
}

#[test]
fn weights_count_for_rational_types_only() {
    let text = "v 0 0 0 1\nv 10 0 0 3\nv 0 10 0\nv 10 10 0\ncstype bezier\ndeg 1 1\nsurf 0 1 0 1 1 2 3 \
        4\nparm u 0 1\nparm v 0 1\nend\n";
    assert_eq!(point_of(&model(text), [0.5, 0.0]).x, 5.0);
    assert_eq!(point_of(&model(&text.replace("cstype ", "cstype rat ")), [0.5, 0.0]).x, 7.5);
}

#[test]
fn names_polygons_and_loose_items() {
    let text = "o box\ng front\nusemtl red\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nf -4//1 -3//1 \
        -2//1\n\
                g back\nf 4 3 2 \\\n1\np 1\nl 1 2 3\n";
    let model = model(text);
    let part = &model.parts[0];
    let items: Vec<_> =
        part.tessellated.iter().map(|t| (t.name.as_str(), t.points.len(), t.triangles.len())).collect();
    assert_eq!(items, [("front", 4, 3), ("back", 4, 2)]);
    let kinds: Vec<_> = part.loose.iter().map(|item| item.kind).collect();
    assert_eq!(kinds, [LooseKind::Point, LooseKind::Wire]);
}

#[test]
fn other_files_are_not_read_and_commands_not_run() {
    let folder = std::env::temp_dir().join("chordal-obj-csh-must-not-exist");
    let text = square(&format!("call other.obj\ncsh touch {}\ncsh -touch {0}", folder.display()), "");
    let model = model(&text);
    assert!(!folder.exists());
    let said: Vec<_> = model.issues.iter().map(|w| (w.kind.code(), w.is_error())).collect();
    assert_eq!(said, [("other-file", true), ("program-ignored", false)]);
}

#[test]
fn what_is_wrong_is_said() {
    let whole = square("", "trim 0 4 1");
    for (from, to, phrase) in [
        ("trim 0 4 1", "trim 0 4 7", "trim curve 7 does not exist"),
        ("trim 0 4 1", "trim 0 4", "no list of ranges and curves"),
        ("trim 0 4 1", "trim 9 9 1", "trim curve 1: parameter range 9..9 is empty"),
        ("1 2 3 4\nparm u 0 1\n", "1 2 3 9\nparm u 0 1\n", "v 9 is not defined"),
        ("1 2 3 4\nparm u 0 1\n", "1 2 3\nparm u 0 1\n", "number of control points is 3, expected 4"),
        ("surf 0 1 0 1", "surf 0 1 0 x", "no parameter range of four numbers"),
        ("surf 0 1 0 1", "surf 2 3 0 1", "outside of the domain"),
        ("parm v 0 1", "parm v 1 0", "parameter range 1..0 is empty"),
        ("deg 1 1", "deg 1 0", "degree 0 is"),
        ("deg 1 1", "cstype spline", "no cstype"),
        ("deg 1 1", "cstype bspline", "number of parameters"),
        ("v 10 10 5", "v 10 inf 5", "v 4 is not defined"),
        ("vp .8 .8", "vp .8 zero", "vp 3 is not defined"),
    ] {
        let broken = whole.replacen(from, to, 1);
        assert_ne!(broken, whole, "{from}");
        let model = read_bytes(broken.as_bytes(), "part").expect("a failed face");
        let said = failures(&model);
        assert!(said.len() == 1 && said[0].contains(phrase), "{from} → {to}: {said:?}");
    }
    let said = read_bytes(b"v 0 0 0\nf 1 2 3\n", "part").expect_err("nothing in it").to_string();
    assert!(said.contains("line 2") && said.contains("1 polygon with missing corners"), "{said}");
}

#[test]
fn only_obj_is_taken_for_it() {
    for text in ["hello world\n", "v 1 2 3\nsolid\n", "g a\n", "# v 0 0 0\n"] {
        let said = read_bytes(text.as_bytes(), "part").expect_err("no OBJ").to_string();
        assert!(said.contains("unrecognised file format"), "{text}: {said}");
    }
    let said = read_bytes(b"solid a\nfacet normal 0 0 1\n", "part").expect_err("no OBJ").to_string();
    assert!(said.contains("a triangle mesh (STL) is no CAD model"), "{said}");
}

#[test]
fn a_file_cut_anywhere_ends_in_a_model_or_a_sentence() {
    let whole = square("", "hole 0 4 1");
    for end in 0..whole.len() {
        if let Err(error) = read_bytes(&whole.as_bytes()[..end], "part") {
            assert!(!error.to_string().contains('\n'), "cut at {end}: {error}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3000))]
    #[test]
    fn mutants_end(changes in prop::collection::vec((any::<prop::sample::Index>(), 32u8..127), 1..6)) {
        let mut bytes = square("step 1 1\nbmat u 1 -1 0 1", "hole 0 4 1\nsp 1").into_bytes();
        for (at, byte) in changes {
            let at = at.index(bytes.len());
            bytes[at] = byte;
        }
        // Anything but a panic.
        let _ = read_bytes(&bytes, "part");
    }
}
