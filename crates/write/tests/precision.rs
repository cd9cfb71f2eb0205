//! What 32 bits do: the warning, the collapsed triangles, and how GLB keeps its precision.
#![allow(clippy::unwrap_used)] // A failed test says where.

mod common;

use chordal_write::{Format, Unit, WriteOptions, WriteWarning};
use common::*;
use glam::{DAffine3, DVec3};

/// A cube of a millimetre, a kilometre away: 32-bit millimetres are 0.06 mm apart there.
fn far_cube(in_placement: bool) -> chordal_mesh::Scene {
    let away = DVec3::new(1e6, -2e5, 3e5) + DVec3::splat(0.143_456_7);
    if in_placement {
        return single(part("cube", box_mesh(DVec3::ZERO, DVec3::ONE)), DAffine3::from_translation(away));
    }
    single(part("cube", box_mesh(away, away + DVec3::ONE)), DAffine3::IDENTITY)
}

#[test]
fn binary_stl_warns_far_from_the_origin_and_measures_rightly() {
    let scene = far_cube(false);
    for (tolerance, warns) in [(10.0, false), (0.1, true)] {
        let (bytes, summary) =
            write(&scene, &WriteOptions::new(Format::StlBinary).with_tolerance_mm(tolerance));
        assert_eq!(summary.warnings.len(), usize::from(warns), "{:?}", summary.warnings);
        let soup = chordal_mesh::import_bytes(&bytes, "stl").unwrap();
        let exact = expected(&scene);
        let moved = |p: &DVec3| exact.iter().flatten().map(|q| p.distance(*q)).fold(f64::MAX, f64::min);
        let worst = soup.positions.iter().map(moved).fold(0.0, f64::max);
        assert!(
            worst > 0.0 && (worst - summary.rounding_mm).abs() < 1e-12,
            "{worst} {}",
            summary.rounding_mm
        );
    }
}

#[test]
fn glb_keeps_precision_far_from_the_origin() {
    for in_placement in [false, true] {
        let scene = far_cube(in_placement);
        let (_, summary) = write(&scene, &WriteOptions::new(Format::Glb).with_tolerance_mm(1e-3));
        assert!(summary.rounding_mm < 1e-7, "{}", summary.rounding_mm);
        assert!(summary.warnings.is_empty());
        let soup = round_trip(&scene, &WriteOptions::new(Format::Glb)).into_millimetres_z_up();
        assert_same(&soup, &expected(&scene), 1e-7);
    }
}

#[test]
fn rounding_is_stated_in_millimetres_after_the_placement() {
    let thin = box_mesh(DVec3::splat(1.0 / 3.0), DVec3::splat(0.7));
    let scene = |scale: f64| single(part("p", thin.clone()), DAffine3::from_scale(DVec3::splat(scale)));
    for format in [Format::StlBinary, Format::Glb] {
        for unit in [Unit::Millimetre, Unit::Metre, Unit::Inch] {
            let options = WriteOptions::new(format).with_unit(unit);
            let small = write(&scene(1.0), &options).1.rounding_mm;
            let large = write(&scene(1024.0), &options).1.rounding_mm;
            assert!(small > 1e-9 && small < 1e-7, "{format} {unit} {small}");
            assert!((large / small / 1024.0 - 1.0).abs() < 1e-6, "{format} {unit} {large} {small}");
        }
    }
}

#[test]
fn collapsed_triangles_are_counted() {
    let away = DVec3::new(1e6, 0.0, 0.0);
    let sliver = box_mesh(away, away + DVec3::new(1e-3, 1.0, 1.0));
    let scene = single(part("sliver", sliver), DAffine3::IDENTITY);
    let (_, summary) = write(&scene, &WriteOptions::new(Format::StlBinary));
    // The two faces across the thin direction survive, the four others fall on lines.
    assert!(summary.collapsed);
    assert_eq!(summary.warnings, [WriteWarning::Collapsed { triangles: 8 }]);
    assert_eq!(summary.warnings[0].to_string(), "8 triangles have two corners at the same place");
    for format in [Format::Ply, Format::Obj, Format::Glb, Format::ThreeMf] {
        assert!(!write(&scene, &WriteOptions::new(format)).1.collapsed, "{format}");
    }
}

#[test]
fn an_empty_scene_is_written_with_a_warning() {
    let mut empty = cube();
    empty.nodes[0].part = None;
    for format in FORMATS {
        let (_, summary) = write(&empty, &WriteOptions::new(format));
        assert_eq!(summary.triangles, 0);
        assert_eq!(summary.warnings, [WriteWarning::Empty], "{format}");
    }
}

#[test]
fn counts_of_the_summary() {
    let count = |format| {
        let (_, summary) = write(&assembly(), &WriteOptions::new(format));
        (summary.triangles, summary.vertices)
    };
    assert_eq!(count(Format::StlBinary), (38, 114));
    assert_eq!(count(Format::Ply), (38, 28));
    assert_eq!(count(Format::Obj), (38, 28));
    // A brick in its own colours (24 corners), one painted over (24), the sheet (4).
    assert_eq!(count(Format::Glb), (38, 52));
    // The own colours also mirrored.
    assert_eq!(count(Format::ThreeMf), (38, 28));
}
