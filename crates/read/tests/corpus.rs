//! The corpus of the repository: each file holds what its index says, each broken one ends in a sentence or
//! is saved.

mod common;

use chordal_brep::{BodyKind, FaceGeometry, Loop, LooseKind, Model};
use chordal_nurbs::math;
use chordal_read::ReadError;
use common::{read_bytes, read_file};
use std::path::PathBuf;

fn corpus() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../corpus")
}

fn table(path: PathBuf) -> Vec<Vec<String>> {
    let text = std::fs::read_to_string(path).expect("the index is part of the repository");
    text.lines().skip(1).map(|line| line.split('\t').map(str::to_owned).collect()).collect()
}

fn model(name: &str) -> Model {
    read_file(corpus().join(format!("{name}.step"))).expect("a corpus file is readable")
}

fn failures(model: &Model) -> Vec<String> {
    let faces = model.parts.iter().flat_map(|part| &part.faces);
    let failed = faces.filter_map(|face| match &face.geometry {
        FaceGeometry::Failed(reason) => Some(reason.to_string()),
        FaceGeometry::Surface(_) => None,
    });
    failed.collect()
}

#[test]
fn every_file_has_the_faces_of_its_index() {
    let mut wrong = Vec::new();
    for row in table(corpus().join("INDEX.tsv")) {
        let (name, faces): (_, usize) = (&row[0], row[2].parse().expect("a number of faces"));
        let model = model(name);
        let exact = model.placed_faces();
        let tessellated: usize = model.parts.iter().map(|part| part.tessellated.len()).sum();
        let failed = failures(&model);
        if !failed.is_empty() || (exact != faces && tessellated == 0) {
            wrong.push(format!("{name}: {exact} faces, expected {faces}; failed: {failed:?}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn broken_files_end_in_a_sentence_or_are_saved() {
    let mut wrong = Vec::new();
    for row in table(corpus().join("bad/INDEX.tsv")) {
        let (name, exits, phrase) = (&row[0], &row[2], row[3].to_lowercase());
        let said = match read_file(corpus().join(format!("bad/{name}.step"))) {
            Err(error) if !exits.contains('2') => {
                wrong.push(format!("{name}: not saved: {error}"));
                continue;
            }
            Err(error) => error.to_string(),
            Ok(_) if exits == "2" => {
                wrong.push(format!("{name}: read as if nothing were wrong"));
                continue;
            }
            Ok(model) => {
                let warned = model.issues.iter().map(ToString::to_string);
                warned.chain(failures(&model)).collect::<Vec<_>>().join("\n")
            }
        };
        if !said.to_lowercase().contains(&phrase) {
            wrong.push(format!("{name}: says {said:?}, not {phrase:?}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn strings_in_every_encoding() {
    let model = model("strings");
    assert!(failures(&model).is_empty());
    let names = model.nodes.iter().map(|node| &node.name).chain(model.parts.iter().map(|part| &part.name));
    let all = names.cloned().collect::<String>();
    assert!(!all.contains('\\'), "{all}");
}

#[test]
fn colours_are_linear_and_override() {
    let model = model("styles");
    let part = &model.parts[0];
    let colours: Vec<_> = part.faces.iter().filter_map(|face| face.color).collect();
    assert_eq!(colours.len(), 2, "one overridden, one of a named colour");
    assert!(part.bodies[0].color.is_some());
    assert!(part.bodies[0].layer.is_some() || part.faces.iter().any(|face| face.layer.is_some()));
    for color in colours.iter().chain(&part.bodies[0].color) {
        assert!(color.0.iter().all(|c| (0.0..=1.0).contains(c)));
    }
}

#[test]
fn mapped_items_move_scale_and_mirror() {
    let model = model("mapped_items");
    let determinants: Vec<f64> = model.placements().iter().map(|p| p.world.matrix3.determinant()).collect();
    assert_eq!(model.parts.len(), 1, "one part, however often placed");
    assert!(determinants.iter().any(|&d| d < 0.0), "{determinants:?}");
    assert!(determinants.iter().any(|&d| (d.abs() - 27.0).abs() < 1e-9), "{determinants:?}");
}

#[test]
fn units_differ_within_one_assembly() {
    let model = model("mixed_units");
    let scales: Vec<f64> =
        model.placements().iter().map(|p| math::cbrt(p.world.matrix3.determinant().abs())).collect();
    let inches = scales.iter().filter(|&&s| (s - 25.4).abs() < 1e-9).count();
    assert_eq!(inches, 2, "{scales:?}");
    assert!(scales.iter().any(|&s| (s - 1.0).abs() < 1e-12), "{scales:?}");
    assert_eq!(math::cbrt(self::model("metres").placements()[0].world.matrix3.determinant()).round(), 1000.0);
}

#[test]
fn an_assembly_meshes_each_part_once() {
    let model = model("assembly_200");
    assert_eq!(model.placements().len(), 200);
    assert_eq!(model.parts.len(), 4);
    assert!(model.parts.iter().all(|part| !part.name.is_empty()));
    let coloured =
        |i: usize| model.parts[i].bodies.iter().any(|b| b.color.is_some()) || model.parts[i].color.is_some();
    assert!((0..4).all(|i| coloured(i) || model.parts[i].faces.iter().all(|f| f.color.is_some())));
}

#[test]
fn loose_things_are_reported() {
    let model = model("wires_and_points");
    let loose: Vec<LooseKind> =
        model.parts.iter().flat_map(|part| part.loose.iter().map(|item| item.kind)).collect();
    assert!(loose.contains(&LooseKind::Wire) && loose.contains(&LooseKind::Point), "{loose:?}");
}

#[test]
fn voids_turn_their_faces_over() {
    let model = model("voids_oriented");
    let part = &model.parts[0];
    assert_eq!(part.bodies[0].kind, BodyKind::Solid);
    let flipped = part.faces.iter().filter(|face| face.flipped).count();
    assert_eq!((part.shells.len(), flipped), (2, 6));
}

#[test]
fn loops_that_meet_only_nearly_share_vertices() {
    let model = model("loop_ends_apart");
    let part = &model.parts[0];
    for boundary in part.faces.iter().flat_map(|face| &face.loops) {
        let Loop::Edges { coedges, .. } = boundary else { continue };
        let ends = |i: usize| {
            let coedge = &coedges[i % coedges.len()];
            let edge = &part.edges[coedge.edge.index()];
            if coedge.forward { (edge.start, edge.end) } else { (edge.end, edge.start) }
        };
        assert!((0..coedges.len()).all(|i| ends(i).1 == ends(i + 1).0));
    }
}

#[test]
fn triangles_of_the_file_are_passed_through() {
    for name in ["tessellated_solid", "tessellated_strips"] {
        let model = model(name);
        let items: Vec<_> = model.parts.iter().flat_map(|part| &part.tessellated).collect();
        assert!(!items.is_empty(), "{name}");
        for item in items {
            assert!(item.triangles.iter().flatten().all(|&i| (i as usize) < item.points.len()));
            assert!(item.normals.is_empty() || item.normals.len() == item.points.len());
        }
    }
}

/// Reads whatever it is given; the result does not matter, that there is one does.
fn survives(bytes: &[u8]) -> Result<Model, ReadError> {
    let result = read_bytes(bytes, "mutant");
    if let Ok(model) = &result {
        let _ = model.placed_faces();
        for part in &model.parts {
            assert!(
                part.edges.iter().all(|edge| edge.range.start < edge.range.end && edge.range.is_finite())
            );
            assert!(part.vertices.iter().all(|vertex| vertex.point.is_finite()));
        }
    }
    result
}

/// How many mutants of each file: CHORDAL_MUTANTS times as many as usual for a longer hunt.
fn mutants(usual: usize) -> usize {
    let times = std::env::var("CHORDAL_MUTANTS").ok().and_then(|n| n.parse::<usize>().ok());
    usual * times.unwrap_or(1)
}

#[test]
fn truncation_anywhere_is_survived() {
    for name in ["cone_apex", "styles", "mapped_items", "strings"] {
        let bytes = std::fs::read(corpus().join(format!("{name}.step"))).expect("a corpus file");
        let mut read = 0;
        for piece in 0..=50 {
            read += usize::from(survives(&bytes[..bytes.len() * piece / 50]).is_ok());
        }
        assert!(read > 5, "{name}: {read} of 51 truncations gave a model");
    }
}

#[test]
fn mutants_are_survived() {
    // xorshift with a fixed seed: the same mutants on every run.
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut random = |below: usize| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state % below as u64) as usize
    };
    let interesting = b"()',;#$*.=/\\0123456789-+ETFAZ \n\"&";
    for name in [
        "curve_bounded",
        "mapped_items",
        "tessellated_solid",
        "trimmed_surface",
        "spline_cyclic",
        "styles",
        "faceted",
    ] {
        let original = std::fs::read(corpus().join(format!("{name}.step"))).expect("a corpus file");
        for _ in 0..mutants(400) {
            let mut bytes = original.clone();
            for _ in 0..1 + random(8) {
                let at = random(bytes.len());
                match random(4) {
                    0 => bytes[at] = interesting[random(interesting.len())],
                    1 => bytes[at] = random(256) as u8,
                    2 => {
                        bytes.remove(at);
                    }
                    _ => bytes.insert(at, interesting[random(interesting.len())]),
                }
            }
            let _ = survives(&bytes);
        }
    }
}

#[test]
fn references_swapped_at_random_are_survived() {
    let mut state = 0x2545_f491_4f6c_dd1d_u64;
    let mut random = |below: usize| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state % below as u64) as usize
    };
    for name in ["mapped_items", "curve_kinds", "offset_bspline", "assembly_200", "voids_oriented"] {
        let text = std::fs::read_to_string(corpus().join(format!("{name}.step"))).expect("a corpus file");
        let pieces: Vec<&str> = text.split('#').collect();
        let digits = |piece: &str| piece.bytes().take_while(u8::is_ascii_digit).count();
        for _ in 0..mutants(60) {
            let mut mutant = pieces[0].to_owned();
            for piece in &pieces[1..] {
                let (number, rest) = piece.split_at(digits(piece));
                let is_definition = rest.trim_start().starts_with('=');
                let other = pieces[1 + random(pieces.len() - 1)];
                let number = if !is_definition && random(40) == 0 { &other[..digits(other)] } else { number };
                mutant.push('#');
                mutant.push_str(number);
                mutant.push_str(rest);
            }
            let _ = survives(mutant.as_bytes());
        }
    }
}

#[test]
fn a_hundred_thousand_brackets() {
    let open = "(".repeat(100_000);
    for body in [format!("{open}{}", ")".repeat(100_000)), open] {
        let text =
            format!("ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\n#1=ADVANCED_FACE('',{body},#2,.T.);\nENDSEC;\n");
        let _ = survives(text.as_bytes());
    }
}

#[test]
fn nothing_is_quadratic_in_broken_input() {
    let start = std::time::Instant::now();
    let head = "ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\n";
    for pattern in [
        "/*",
        "'",
        "#1=A(",
        "#1=A('",
        "(",
        "#1=(A(",
        "#1=A((),'x'",
        "\"",
        "#1=&SCOPE ",
        "DATA(",
        "\n#1=A('\n#2=B(",
    ] {
        let text = format!("{head}{}", pattern.repeat(1_000_000 / pattern.len()));
        let _ = survives(text.as_bytes());
    }
    assert!(start.elapsed().as_secs() < 60, "{:?}", start.elapsed());
}
