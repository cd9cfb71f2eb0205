//! Names in the encodings of several countries, in files made here.

use chordal_read::{ReadOptions, read_bytes};
use encoding_rs::{GBK, SHIFT_JIS};

/// The corpus model with another name for its product, in an encoding.
fn step_with(name: &str, encode: impl Fn(&str) -> Vec<u8>) -> Vec<u8> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../corpus/box_holes.step");
    let text = std::fs::read_to_string(path).expect("the corpus is in the repository");
    assert!(text.contains("'box_holes'"), "the name of the product");
    encode(&text.replace("'box_holes'", &format!("'{name}'")))
}

fn part_name(bytes: &[u8]) -> String {
    let model = read_bytes(bytes, None, &ReadOptions::default()).expect("a model");
    assert_eq!(
        model.parts[0].faces.len(),
        model.parts[0].faces.iter().filter(|f| f.failure().is_none()).count()
    );
    model.parts[0].name.clone()
}

fn latin(text: &str) -> Vec<u8> {
    text.chars().map(|c| u8::try_from(c).expect("Latin-1")).collect()
}

#[test]
fn names_of_step_are_readable() {
    for name in ["底板", "齿轮箱盖"] {
        assert_eq!(part_name(&step_with(name, |text| GBK.encode(text).0.into_owned())), name);
    }
    // The second byte of ソ and 表 is that of a backslash.
    for name in ["ソケット表", "部品"] {
        assert_eq!(part_name(&step_with(name, |text| SHIFT_JIS.encode(text).0.into_owned())), name);
    }
    assert_eq!(part_name(&step_with("Gehäuse", latin)), "Gehäuse");
    assert_eq!(part_name(&step_with("底板 Gehäuse", |text| text.as_bytes().to_vec())), "底板 Gehäuse");
    assert_eq!(part_name(&step_with("\\X2\\5E95677F\\X0\\", latin)), "底板");
}

#[test]
fn names_of_obj_are_readable() {
    let text = |name: &str| format!("v 0 0 0\nv 1 0 0\nv 0 1 0\no {name}\nf 1 2 3\n");
    let name = |bytes: &[u8]| {
        let model = read_bytes(bytes, None, &ReadOptions::default()).expect("a model");
        model.parts[0].tessellated[0].name.clone()
    };
    assert_eq!(name(&GBK.encode(&text("底板")).0), "底板");
    assert_eq!(name(&SHIFT_JIS.encode(&text("ボルト")).0), "ボルト");
    assert_eq!(name(&latin(&text("Träger"))), "Träger");
}

#[test]
fn names_of_iges_are_readable() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../corpus/iges/looks.igs");
    let mut bytes = std::fs::read(path).expect("the corpus is in the repository");
    let old = b"10Htwo plates";
    let at = bytes.windows(old.len()).position(|found| found == old).expect("the name");
    for (encoded, name) in
        [(GBK.encode("底板上盖件").0, "底板上盖件"), (SHIFT_JIS.encode("ボルト部品").0, "ボルト部品")]
    {
        bytes[at + 3..at + old.len()].copy_from_slice(&encoded);
        let model = read_bytes(&bytes, None, &ReadOptions::default()).expect("a model");
        assert!(format!("{model:?}").contains(name), "{name}");
    }
}
