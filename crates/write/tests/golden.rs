//! The text formats, byte for byte. `CHORDAL_BLESS=1` writes the files anew; look at the difference before
//! keeping it.
#![allow(clippy::unwrap_used)] // A failed test says where.

mod common;

use chordal_mesh::Scene;
use chordal_write::{Format, WriteOptions, write_scene};
use common::*;
use glam::{DAffine3, DVec3};
use std::fs;
use std::io::Read;
use std::path::Path;

/// A small box placed and mirrored, in two colours.
fn scene() -> Scene {
    let mut part = part("tiny box", box_mesh(DVec3::ZERO, DVec3::new(1.0, 2.0, 0.1)));
    part.face_colors[5] = Some(RED);
    part.face_names[5] = "top".to_owned();
    let mut scene = single(part, DAffine3::IDENTITY);
    let mirror = DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0)) * DAffine3::from_translation(DVec3::X);
    scene.nodes.push(node("mirrored <2>", mirror, Some(0), &[]));
    scene.roots.push(1);
    scene
}

fn check(name: &str, found: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden").join(name);
    let found = found.replace(env!("CARGO_PKG_VERSION"), "VERSION");
    if std::env::var_os("CHORDAL_BLESS").is_some() {
        fs::write(&path, &found).unwrap();
    }
    let wanted = fs::read_to_string(&path).unwrap();
    assert!(found == wanted, "{name} differs from what it was:\n{found}");
}

#[test]
fn text_formats_are_as_they_were() {
    let folder = tempfile::tempdir().unwrap();
    for (format, name) in
        [(Format::StlAscii, "box.stl"), (Format::Obj, "box.obj"), (Format::ThreeMf, "box.3mf")]
    {
        let path = folder.path().join(name);
        write_scene(&scene(), &path, &WriteOptions::new(format)).unwrap();
        if format == Format::ThreeMf {
            let mut archive = zip::ZipArchive::new(fs::File::open(&path).unwrap()).unwrap();
            for (member, name) in
                [("3D/3dmodel.model", "box.model.xml"), ("[Content_Types].xml", "types.xml")]
            {
                let mut text = String::new();
                archive.by_name(member).unwrap().read_to_string(&mut text).unwrap();
                check(name, &text);
            }
        } else {
            check(name, &fs::read_to_string(&path).unwrap());
        }
    }
    check("box.mtl", &fs::read_to_string(folder.path().join("box.mtl")).unwrap());
}

#[test]
fn the_header_of_ply_is_as_it_was() {
    let (bytes, _) = write(&scene(), &WriteOptions::new(Format::Ply));
    let end = bytes.windows(11).position(|w| w == b"end_header\n").unwrap() + 11;
    check("box.ply.header", std::str::from_utf8(&bytes[..end]).unwrap());
    // 16 vertices of 24 bytes, 24 triangles of 21.
    assert_eq!(bytes.len() - end, 16 * 24 + 24 * 21);
}
