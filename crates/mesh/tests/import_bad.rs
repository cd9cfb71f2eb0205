//! Bad mesh files: a sentence, never a panic, never memory by what a header claims.
#![allow(clippy::unwrap_used)] // A failed test says where.

use chordal_mesh::{ImportError, ImportFault, ImportPlace, import_bytes, import_mesh};
use std::path::Path;

/// The sentence that a file is refused with.
fn refusal(bytes: &[u8], extension: &str) -> String {
    match import_bytes(bytes, extension) {
        Err(error @ ImportError::Invalid { .. }) => error.to_string(),
        other => panic!("{extension}: {other:?}"),
    }
}

#[test]
fn counts_beyond_the_file_are_refused() {
    let mut stl = vec![b' '; 80];
    stl.extend_from_slice(&u32::MAX.to_le_bytes());
    stl.extend_from_slice(&[0; 49]);
    assert_eq!(
        refusal(&stl, "stl"),
        "not a valid STL file: the header states 4294967295 triangles, the file holds 0"
    );
    for format in ["ascii", "binary_little_endian", "binary_big_endian"] {
        for elements in [
            "element vertex 18446744073709551615\nproperty double x\nproperty double y\nproperty double z\n",
            "element face 99999999999\nproperty list uchar int vertex_indices\n",
            "element odd 99999999999\nproperty float x\n",
        ] {
            let text = format!("ply\nformat {format} 1.0\n{elements}end_header\n1 2 3 4 5 6 7 8\n");
            let sentence = refusal(text.as_bytes(), "ply");
            assert!(sentence.contains("more than the file can hold"), "{sentence}");
        }
    }
    let list = b"ply\nformat ascii 1.0\nelement face 1\nproperty list int int \
        vertex_indices\nend_header\n4000000000 1\n";
    assert!(
        refusal(list, "ply").contains("refers to vertex 1 of 0")
            || refusal(list, "ply").contains("ends inside")
    );
}

/// A GLB file of a JSON text and bytes.
fn glb(json: &str, binary: &[u8]) -> Vec<u8> {
    let mut bytes = b"glTF\x02\0\0\0\0\0\0\0".to_vec();
    bytes.extend_from_slice(&(json.len() as u32).to_le_bytes());
    bytes.extend_from_slice(b"JSON");
    bytes.extend_from_slice(json.as_bytes());
    bytes.extend_from_slice(&(binary.len() as u32).to_le_bytes());
    bytes.extend_from_slice(b"BIN\0");
    bytes.extend_from_slice(binary);
    bytes
}

#[test]
fn glb_accessors_beyond_the_file_are_refused() {
    let json = |count: u64, offset: u64| {
        format!(
            r#"{{"asset":{{"version":"2.0"}},"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],"buffers":[{{"byteLength":36}}],
            "accessors":[{{"bufferView":0,"componentType":5126,"count":{count},"type":"VEC3"}}],
            "bufferViews":[{{"buffer":0,"byteOffset":{offset},"byteLength":36}}]}}"#
        )
    };
    let mut binary = Vec::new();
    for number in [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0] {
        binary.extend_from_slice(&number.to_le_bytes());
    }
    let soup = import_bytes(&glb(&json(3, 0), &binary), "glb").unwrap();
    assert_eq!(
        (soup.triangles.len(), soup.positions.len(), soup.unit_mm, soup.y_up),
        (1, 3, Some(1000.0), true)
    );
    for (count, offset) in [(4, 0), (3, 4), (u64::MAX, 0), (3, u64::MAX), (1 << 62, 0)] {
        let sentence = refusal(&glb(&json(count, offset), &binary), "glb");
        assert!(sentence.contains("reaches beyond the end of its buffer"), "{sentence}");
    }
}

/// A text file whose buffer has this URI.
fn gltf(uri: &str) -> Vec<u8> {
    format!(
        r#"{{"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],
        "buffers":[{{"byteLength":36,"uri":"{uri}"}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}}],
        "bufferViews":[{{"buffer":0,"byteLength":36}}]}}"#
    )
    .into_bytes()
}

#[test]
fn buffers_of_text_files_must_be_embedded_and_complete() {
    // 36 bytes in base64: (0, 0, 0), (1, 0, 0), (0, 1, 0).
    let data = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
    let soup = import_bytes(&gltf(&format!("data:application/octet-stream;base64,{data}")), "gltf").unwrap();
    assert_eq!((soup.triangles.len(), soup.positions[2].to_array()), (1, [0.0, 1.0, 0.0]));
    assert!(refusal(&gltf("part.bin"), "gltf").contains("another file"));
    assert!(refusal(&gltf("data:;base64,***"), "gltf").contains("not valid base64"));
    assert!(refusal(&gltf("data:;base64,AAAA"), "gltf").contains("reaches beyond the end of its buffer"));
}

#[test]
fn trees_in_circles_are_refused() {
    let json = r#"{"scenes":[{"nodes":[0]}],"nodes":[{"children":[1]},{"children":[0]}]}"#;
    assert!(refusal(&glb(json, b""), "glb").contains("two parents"));
}

#[test]
fn what_is_no_mesh_is_named() {
    for extension in ["stl", "obj", "ply", "glb", "gltf", "3mf"] {
        for bytes in [&b""[..], b"\0", b"hello", b"solid", b"ISO-10303-21;\nHEADER;", &[0xff; 200]] {
            let sentence = refusal(bytes, extension);
            assert!(!sentence.contains('\n') && sentence.len() < 200, "{sentence}");
        }
    }
    assert!(matches!(import_bytes(b"", "step"), Err(ImportError::UnknownFormat(_))));
    assert!(matches!(import_mesh(Path::new("nowhere.stl")), Err(ImportError::File { .. })));
    assert!(matches!(import_mesh(Path::new("nowhere")), Err(ImportError::UnknownFormat(_))));
}

/// The place and the fault that a file is refused with.
fn fault(bytes: &[u8], extension: &str) -> (Option<ImportPlace>, ImportFault) {
    match import_bytes(bytes, extension) {
        Err(ImportError::Invalid { place, fault, .. }) => (place, fault),
        other => panic!("{extension}: {other:?}"),
    }
}

#[test]
fn faults_have_their_place_and_their_values() {
    let line = |n| Some(ImportPlace::Line(n));
    let (place, found) = fault(b"v 0 0 0\nv 1 0 0\nv 0 nan 0\nf 1 2 3\n", "obj");
    assert!(place == line(4) && matches!(found, ImportFault::NotFinite { point } if point[1].is_nan()));
    let unknown = ImportFault::UnknownVertex { vertex: "3".to_owned(), vertices: 2 };
    assert_eq!(fault(b"v 0 0 0\nv 1 0 0\nf 1 2 3\n", "obj"), (line(3), unknown.clone()));
    assert_eq!(fault(b"v 0 0 0\nv 1 0 \\\n0\nf 1 2 3\n", "obj"), (line(4), unknown));
    assert_eq!(fault(b"v 0 0 0\nv 1 0\n", "obj"), (line(2), ImportFault::Vertex));
    assert_eq!(fault(b"v 0 0 0\nv 1 0 0\nf 1 2\n", "obj"), (line(3), ImportFault::Corners { corners: 2 }));
    let open = b"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n";
    assert_eq!(fault(open, "stl"), (None, ImportFault::EndsInside { what: "loop" }));
    let one = fault(b"solid a\nvertex 0 0 0\nendloop\n", "stl");
    assert_eq!(one, (line(3), ImportFault::Corners { corners: 1 }));
    let ply = b"ply\nformat ascii 1.0\nelement vertex many\n";
    let text = "element vertex many".to_owned();
    assert_eq!(fault(ply, "ply"), (line(3), ImportFault::HeaderLine { text }));
    // The second coordinate of the second corner of the second triangle is not a number.
    let mut stl = vec![b' '; 80];
    stl.extend_from_slice(&2_u32.to_le_bytes());
    stl.extend_from_slice(&[0; 100]);
    let at = 84 + 50 + 24 + 4;
    stl[at..at + 4].copy_from_slice(&f32::NAN.to_le_bytes());
    let (place, found) = fault(&stl, "stl");
    assert_eq!(place, Some(ImportPlace::Byte(84 + 50 + 24)));
    assert!(matches!(found, ImportFault::NotFinite { .. }));
    let sentence = refusal(b"v 0 0 0\nv 1 0\n", "obj");
    assert_eq!(sentence, "not a valid OBJ file: line 2: a vertex needs three numbers");
}

#[test]
fn formats_are_read_as_others_write_them() {
    // Relative indices, texture coordinates, a quad, a continued line.
    let obj = b"v 0 0 0\nv 1 0 0 1.0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nf -4/1/1 -3//1 \\\n -2/1 -1\n";
    let soup = import_bytes(obj, "obj").unwrap();
    assert_eq!(soup.triangles, [[0, 1, 2], [0, 2, 3]]);
    // Floats in the other byte order, extra properties, an element between.
    let mut ply = b"ply\r\nformat binary_big_endian 1.0\r\ncomment made elsewhere\r\nelement vertex \
        3\r\nproperty float x\r\n\
        property float y\r\nproperty float z\r\nproperty uchar red\r\nelement edge 1\r\nproperty short v\r\n\
        element face 1\r\nproperty list uchar uint vertex_index\r\nend_header\r\n"
        .to_vec();
    for [x, y, z] in [[0.0_f32, 0.0, 0.0], [1.5, 0.0, 0.0], [0.0, 2.0, 0.0]] {
        for number in [x, y, z] {
            ply.extend_from_slice(&number.to_be_bytes());
        }
        ply.push(7);
    }
    ply.extend_from_slice(&[0, 1, 3, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 2]);
    let soup = import_bytes(&ply, "ply").unwrap();
    assert_eq!(soup.triangles, [[0, 1, 2]]);
    assert_eq!(soup.positions[1].to_array(), [1.5, 0.0, 0.0]);
    // ASCII STL in capitals with tabs, exponents and −0; two solids do not weld.
    let facet = "FACET NORMAL 0 0 1\n\tOUTER LOOP\n\tVERTEX -0 0 0\n\tVERTEX 1e0 0 0\n\tVERTEX 0 +1 \
        0\nENDLOOP\nENDFACET\n";
    let stl = format!("SOLID one\n{facet}{facet}ENDSOLID\nsolid two\n{facet}endsolid");
    let soup = import_bytes(stl.as_bytes(), "stl").unwrap();
    assert_eq!((soup.positions.len(), soup.triangles.len()), (6, 3));
    let names: Vec<_> = soup.groups.iter().map(|g| (g.name.as_str(), g.triangles.clone())).collect();
    assert_eq!(names, [("one", 0..2), ("two", 2..3)]);
    // A binary file that starts with `solid`.
    let mut stl = b"solid but binary".to_vec();
    stl.resize(80, 0);
    stl.extend_from_slice(&1_u32.to_le_bytes());
    for number in [0.0_f32, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0] {
        stl.extend_from_slice(&number.to_le_bytes());
    }
    stl.extend_from_slice(&[0, 0]);
    assert_eq!(import_bytes(&stl, "stl").unwrap().triangles, [[0, 1, 2]]);
}
