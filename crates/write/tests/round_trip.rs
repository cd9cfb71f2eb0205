//! What is written comes back: every format, unit and axis, instances, mirrors and colours.
#![allow(clippy::unwrap_used)] // A failed test says where.

mod common;

use chordal_mesh::{Scene, import_mesh};
use chordal_write::{
    Format, MeshFault, SceneFault, SolidPer, Unit, UpAxis, WriteError, WriteOptions, to_bytes, write_scene,
};
use common::*;
use glam::{DAffine3, DMat3, DVec3};
use proptest::prelude::*;
use std::fs;

#[test]
fn every_format_returns_the_assembly() {
    let scene = assembly();
    for format in FORMATS {
        let soup = round_trip(&scene, &WriteOptions::new(format)).into_millimetres_z_up();
        let tolerance = if format.is_single_precision() { 4e-5 } else { 1e-11 };
        assert_same(&soup, &expected(&scene), tolerance);
    }
}

/// The same shape with the two triangles of each side of the bricks as one quadrilateral.
fn in_quads() -> Scene {
    let mut scene = assembly();
    for part in &mut scene.parts {
        std::sync::Arc::make_mut(&mut part.mesh).faces.iter_mut().for_each(|face| face.quads = 1);
    }
    scene
}

#[test]
fn quadrilaterals_are_kept_where_the_format_has_them_and_mean_the_same_triangles() {
    let scene = in_quads();
    for format in FORMATS {
        let soup = round_trip(&scene, &WriteOptions::new(format)).into_millimetres_z_up();
        let tolerance = if format.is_single_precision() { 4e-5 } else { 1e-11 };
        assert_same(&soup, &expected(&scene), tolerance);
    }
    let (bytes, summary) = write(&scene, &WriteOptions::new(Format::Ply));
    let text = String::from_utf8_lossy(&bytes);
    // Three bricks of six sides, and a sheet of two triangles.
    assert!(text.contains("element face 20\n"), "{text}");
    assert_eq!(summary.triangles, 38);
    let (bytes, summary) = write(&scene, &WriteOptions::new(Format::Obj));
    let text = String::from_utf8(bytes).unwrap();
    let corners: Vec<usize> =
        text.lines().filter(|l| l.starts_with("f ")).map(|l| l.split(' ').count() - 1).collect();
    assert_eq!(corners.iter().filter(|&&n| n == 4).count(), 18);
    assert_eq!((corners.len(), summary.triangles), (20, 38));
}

#[test]
fn every_unit_and_axis_is_honoured_by_every_format() {
    let scene = assembly();
    let units = [Unit::Micrometre, Unit::Millimetre, Unit::Centimetre, Unit::Metre, Unit::Inch, Unit::Foot];
    for format in FORMATS {
        for unit in units {
            for up in [UpAxis::Y, UpAxis::Z] {
                let options = WriteOptions::new(format).with_unit(unit).with_up(up);
                let mut soup = round_trip(&scene, &options);
                let states_unit = format.is_gltf() || matches!(format, Format::Ply | Format::ThreeMf);
                assert_eq!(soup.unit_mm, states_unit.then(|| unit.millimetres()), "{format} {unit}");
                soup.unit_mm = Some(unit.millimetres());
                soup.y_up = up == UpAxis::Y;
                assert_same(&soup.into_millimetres_z_up(), &expected(&scene), 1e-4);
            }
        }
    }
}

#[test]
fn sixty_four_bit_formats_round_nothing() {
    let odd = DVec3::new(0.1, 1.0 / 3.0, 1e-7);
    let scene = single(part("odd", box_mesh(odd, odd + DVec3::new(1.1, 1e3, 7.7))), DAffine3::IDENTITY);
    for format in [Format::StlAscii, Format::Obj, Format::Ply, Format::ThreeMf] {
        let options = WriteOptions::new(format).with_tolerance_mm(1e-30);
        let (_, summary) = write(&scene, &options);
        assert_eq!((summary.rounding_mm, summary.warnings.len()), (0.0, 0), "{format}");
        assert_same(&round_trip(&scene, &options), &expected(&scene), 0.0);
    }
}

#[test]
fn closed_parts_stay_closed_and_outside_out_also_mirrored() {
    let scene = assembly();
    let solid = Scene { parts: scene.parts.clone(), ..scene };
    let wanted = 3.0 * 1.2 * 4.0 * 0.3 * 25.4 * 25.4 * 25.4;
    for format in FORMATS {
        let soup = round_trip(&solid, &WriteOptions::new(format)).into_millimetres_z_up();
        // The sheet has four open edges, and its cone to the origin some volume of its own.
        assert_eq!(open_edges(&soup), 4, "{format}");
        let sheet = expected(&solid).into_iter().filter(is_sheet).map(|[a, b, c]| a.dot(b.cross(c)) / 6.0);
        let sheet: f64 = sheet.sum();
        assert!((volume(&soup) - sheet - wanted).abs() < 1e-5 * wanted, "{format}");
    }
}

/// The sheet's triangles are the only ones with a side of one inch, times √2 or √1.25.
fn is_sheet([a, b, _]: &[DVec3; 3]) -> bool {
    let side = a.distance(*b) / 25.4;
    (side - 1.0).abs() < 1e-9 || (side - 2_f64.sqrt()).abs() < 1e-9
}

#[test]
fn groups_and_faces_keep_their_names_and_numbers() {
    let scene = assembly();
    let names = |format| -> Vec<String> {
        round_trip(&scene, &WriteOptions::new(format)).groups.into_iter().map(|g| g.name).collect()
    };
    let brick = "brick & \"mortar\"";
    let (second, third) = (format!("{brick}_2"), format!("{brick}_3"));
    for format in [Format::StlAscii, Format::Ply] {
        assert_eq!(names(format), [brick, &second, &third, "scan"], "{format}");
    }
    assert_eq!(
        names(Format::Obj),
        ["brick_&_\"mortar\"", "brick_&_\"mortar\"_2", "brick_&_\"mortar\"_3", "scan"]
    );
    assert_eq!(names(Format::Glb), ["first", "second", "painted", "scan"]);
    assert_eq!(names(Format::ThreeMf).iter().filter(|n| *n == brick).count(), 3);
    let ids = round_trip(&scene, &WriteOptions::new(Format::Ply)).face_ids;
    let wanted: Vec<i64> = (0..18).flat_map(|f| [f, f]).chain([-1, -1]).collect();
    assert_eq!(ids, wanted);
    assert_eq!(round_trip(&scene, &WriteOptions::new(Format::Glb)).face_ids.len(), 38);
}

#[test]
fn solids_of_ascii_stl_by_color_and_body() {
    let names = |scene: &Scene, per| -> Vec<String> {
        let options = WriteOptions::new(Format::StlAscii).with_solid_per(per);
        let soup = round_trip(scene, &options);
        assert_same(&soup, &expected(scene), 1e-11);
        soup.groups.into_iter().map(|g| g.name).collect()
    };
    assert_eq!(names(&assembly(), SolidPer::Color), ["uncoloured", "color_FF0000", "color_00BCFF40"]);
    let mut scene = cube();
    scene.parts[0].face_bodies = vec![0, 0, 1, 1, 2, 2];
    scene.parts[0].body_names = vec!["lid".to_owned(), String::new()];
    assert_eq!(names(&scene, SolidPer::Body), ["cube.lid", "cube.body_1", "cube.body_2"]);
}

#[test]
fn the_same_scene_gives_the_same_bytes() {
    for format in FORMATS {
        let options = WriteOptions::new(format).with_edge_lines(true);
        assert_eq!(write(&assembly(), &options).0, write(&assembly(), &options).0, "{format}");
    }
}

#[test]
fn files_replace_each_other_only_when_complete() {
    let folder = tempfile::tempdir().unwrap();
    for format in FORMATS {
        let path = folder.path().join(format!("out.{}", format.extension()));
        let options = WriteOptions::new(format);
        let summary = write_scene(&assembly(), &path, &options).unwrap();
        assert_eq!(summary.bytes, fs::metadata(&path).unwrap().len());
        assert_eq!(import_mesh(&path).unwrap().triangles.len(), 38);
        let before = fs::read(&path).unwrap();
        let mut broken = assembly();
        broken.nodes[4].transform.translation.x = 1e308;
        broken.nodes[0].transform.translation.x = 1e308;
        let error = write_scene(&broken, &path, &options);
        if !format.is_gltf() && format != Format::ThreeMf {
            assert!(matches!(error, Err(WriteError::NotFinite { .. })), "{format}: {error:?}");
            assert_eq!(fs::read(&path).unwrap(), before, "{format}");
        }
    }
    // OBJ brings its library; nothing else stays behind.
    let mut names: Vec<_> =
        fs::read_dir(folder.path()).unwrap().map(|f| f.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    assert_eq!(names, ["out.3mf", "out.glb", "out.gltf", "out.mtl", "out.obj", "out.ply", "out.stl"]);
    let obj = fs::read_to_string(folder.path().join("out.obj")).unwrap();
    let mtl = fs::read_to_string(folder.path().join("out.mtl")).unwrap();
    assert!(obj.contains("mtllib out.mtl"));
    for used in obj.lines().filter_map(|l| l.strip_prefix("usemtl ")) {
        assert!(mtl.contains(&format!("newmtl {used}\n")), "{used}");
    }
}

#[test]
fn special_files_and_missing_folders_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let options = WriteOptions::new(Format::Ply);
    for path in [folder.path().to_owned(), folder.path().join("none/out.ply")] {
        let error = write_scene(&cube(), &path, &options).unwrap_err();
        assert!(matches!(error, WriteError::File { .. } | WriteError::NotAFile { .. }), "{error}");
    }
    let error = write_scene(&cube(), folder.path(), &options).unwrap_err();
    assert!(matches!(error, WriteError::NotAFile { .. }), "{error}");
}

#[test]
fn files_in_memory_are_the_files_on_disk() {
    let folder = tempfile::tempdir().unwrap();
    for format in FORMATS {
        // The library is named after the file, and `model` is its name in memory.
        let path = folder.path().join(format!("model.{}", format.extension()));
        let options = WriteOptions::new(format);
        let summary = write_scene(&assembly(), &path, &options).unwrap();
        let file = to_bytes(&assembly(), &options).unwrap();
        assert_eq!(file.summary, summary, "{format}");
        assert!(file.bytes == fs::read(&path).unwrap(), "{format}");
        assert_eq!(file.library.is_some(), format == Format::Obj);
        if let Some(library) = file.library {
            assert_eq!(library.bytes, fs::read(folder.path().join(&library.name)).unwrap());
        }
    }
    assert!(to_bytes(&cube(), &WriteOptions::new(Format::Obj)).unwrap().library.is_none());
}

#[test]
fn gltf_text_holds_what_glb_holds() {
    let text = round_trip(&assembly(), &WriteOptions::new(Format::Gltf));
    assert_eq!(text, round_trip(&assembly(), &WriteOptions::new(Format::Glb)));
}

#[test]
fn inconsistent_scenes_are_refused() {
    let mut two_parents = cube();
    two_parents.roots = vec![0, 0];
    let mut circle = cube();
    circle.nodes[0].children = vec![0];
    let mut no_part = cube();
    no_part.nodes[0].part = Some(1);
    let mut no_corner = cube();
    let mut mesh = box_mesh(DVec3::ZERO, DVec3::ONE);
    mesh.faces[3].triangles[0][1] = 4;
    no_corner.parts[0].mesh = mesh.into();
    let mut infinite = cube();
    infinite.nodes[0].transform.translation.x = f64::NAN;
    let broken = [
        (two_parents, SceneFault::TwoParents { node: 0 }),
        (circle, SceneFault::TwoParents { node: 0 }),
        (no_part, SceneFault::UnknownPart { node: 0, part: 1 }),
        (infinite, SceneFault::InfiniteTransform { node: 0 }),
        (
            no_corner,
            SceneFault::Mesh {
                part: 0,
                name: "cube".to_owned(),
                fault: MeshFault::UnknownCorner { face: 3, corner: 4, corners: 4 },
            },
        ),
    ];
    for (scene, wanted) in broken {
        for format in FORMATS {
            let error = chordal_write::write_to(&scene, &mut Vec::new(), &WriteOptions::new(format));
            assert!(matches!(error, Err(WriteError::Scene(ref found)) if *found == wanted), "{format}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    /// Any affine placement, mirrored or not, under another one: all formats agree with the scene.
    #[test]
    fn any_placement_comes_back(
        numbers in proptest::array::uniform18(-2.0..2.0_f64),
        moves in proptest::array::uniform6(-50.0..50.0_f64),
    ) {
        let matrix = |n: &[f64]| DMat3::from_cols_slice(n);
        let transform = |n: &[f64], m: &[f64]| {
            DAffine3 { matrix3: matrix(n), translation: DVec3::from_slice(m) }
        };
        let (above, below) = (transform(&numbers[..9], &moves[..3]), transform(&numbers[9..], &moves[3..]));
        prop_assume!(above.matrix3.determinant().abs() > 0.01 && below.matrix3.determinant().abs() > 0.01);
        let mut scene = cube();
        scene.nodes = vec![node("a", above, Some(0), &[1]), node("b", below, Some(0), &[])];
        for format in FORMATS {
            let soup = round_trip(&scene, &WriteOptions::new(format)).into_millimetres_z_up();
            let tolerance = if format.is_single_precision() { 1e-4 } else { 1e-11 };
            assert_same(&soup, &expected(&scene), tolerance);
            prop_assert_eq!(open_edges(&soup), 0);
        }
    }
}
