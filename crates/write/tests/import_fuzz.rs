//! Damaged copies of our own files: the importers return a mesh or a sentence, never panic.
#![allow(clippy::unwrap_used)] // A failed test says where.

mod common;

use chordal_mesh::import_bytes;
use chordal_write::WriteOptions;
use common::*;
use proptest::prelude::*;
use std::io::{Cursor, Read, Write};

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn damaged_files_do_no_harm(
        format in 0..FORMATS.len(),
        cut in 0.0..1.5_f64,
        damage in proptest::collection::vec((0.0..1.0_f64, any::<u8>()), 0..8),
    ) {
        let format = FORMATS[format];
        let (mut bytes, _) = write(&assembly(), &WriteOptions::new(format).with_edge_lines(true));
        for (place, value) in damage {
            let index = (place * bytes.len() as f64) as usize;
            bytes[index] = value;
        }
        bytes.truncate((cut * bytes.len() as f64) as usize);
        let _ = import_bytes(&bytes, format.extension());
    }

    /// As above, but inside the archive, whose check sums would stop most damage.
    #[test]
    fn damaged_models_in_sound_archives_do_no_harm(
        cut in 0.0..1.5_f64,
        damage in proptest::collection::vec((0.0..1.0_f64, any::<char>()), 0..8),
    ) {
        let (bytes, _) = write(&assembly(), &WriteOptions::new(chordal_write::Format::ThreeMf));
        let mut text = String::new();
        let mut archive = zip::ZipArchive::new(Cursor::new(bytes)).unwrap();
        archive.by_name("3D/3dmodel.model").unwrap().read_to_string(&mut text).unwrap();
        let mut text: Vec<char> = text.chars().collect();
        for (place, value) in damage {
            let index = (place * text.len() as f64) as usize;
            text[index] = value;
        }
        text.truncate((cut * text.len() as f64) as usize);
        let _ = import_bytes(&archive_of(&text.into_iter().collect::<String>()), "3mf");
    }
}

fn archive_of(model: &str) -> Vec<u8> {
    let mut zip = zip::ZipWriter::new(Cursor::new(Vec::new()));
    zip.start_file("3D/3dmodel.model", zip::write::SimpleFileOptions::default()).unwrap();
    zip.write_all(model.as_bytes()).unwrap();
    zip.finish().unwrap().into_inner()
}

#[test]
fn archives_that_explode_are_refused() {
    let mut model = "<model><resources><object id=\"0\"><mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/>\
        <vertex x=\"1\" y=\"0\" z=\"0\"/><vertex x=\"0\" y=\"1\" z=\"0\"/></vertices><triangles>\
        <triangle v1=\"0\" v2=\"1\" v3=\"2\"/></triangles></mesh></object>"
        .to_owned();
    for id in 1..=40 {
        let below = format!("<component objectid=\"{}\"/>", id - 1);
        model += &format!("<object id=\"{id}\"><components>{below}{below}</components></object>");
    }
    model += "</resources><build><item objectid=\"40\"/></build></model>";
    let error = import_bytes(&archive_of(&model), "3mf").unwrap_err().to_string();
    assert!(error.contains("place over"), "{error}");
    let circle = model.replace("objectid=\"0\"", "objectid=\"40\"");
    let error = import_bytes(&archive_of(&circle), "3mf").unwrap_err().to_string();
    assert!(error.contains("contains itself"), "{error}");
    let blank = format!("<model>{}</model>", " ".repeat(40_000_000));
    let error = import_bytes(&archive_of(&blank), "3mf").unwrap_err().to_string();
    assert!(error.contains("unpacks to over"), "{error}");
}
