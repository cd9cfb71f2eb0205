//! `chordal convert`: the model as JSON meshes as the file it came from does.

mod common;

use common::{files_in, model, run};
use std::fs;

#[test]
fn a_converted_model_meshes_to_the_same_bytes() {
    let folder = tempfile::tempdir().expect("a folder");
    let [json, one, two] = ["whole.json", "step.ply", "json.ply"].map(|name| folder.path().join(name));
    let bracket = model("bracket");
    run("convert {} -o {}", &[&bracket, &json]).exits(&[0]);
    run("mesh {} -o {} --quiet", &[&bracket, &one]).exits(&[0]);
    run("mesh {} -o {} --quiet", &[&json, &two]).exits(&[0]);
    assert!(fs::read(&one).expect("a mesh") == fs::read(&two).expect("a mesh"));
}

#[test]
fn islands_are_not_closed() {
    let folder = tempfile::tempdir().expect("a folder");
    let json = folder.path().join("apart.json");
    run("convert {} -o {} --unsewn", &[&model("bracket"), &json]).exits(&[0]);
    let said = run("info {}", &[&json]).exits(&[0]).stdout;
    assert!(said.contains("face set") && !said.contains("closed"), "{said}");
}

#[test]
fn mistakes_are_one_sentence_and_leave_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let (mesh, nowhere) = (folder.path().join("out.stl"), folder.path().join("none/out.json"));
    let said = run("convert {} -o {}", &[&model("bracket"), &mesh]).exits(&[2]).says_one_sentence();
    assert!(said.stderr.contains(".json"), "{}", said.stderr);
    run("convert {} -o {}", &[&model("bracket"), &nowhere]).exits(&[2]).says_one_sentence();
    run("convert {} -o {}", &[&mesh, &nowhere]).exits(&[2]).says_one_sentence();
    assert_eq!(files_in(folder.path()), [""; 0]);
}
