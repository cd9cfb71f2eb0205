//! The corpus of exchange formats through the program: exit codes, sentences, closed meshes.

mod common;

use common::{corpus, index, json, run};

#[test]
fn exchange_files_end_as_their_index_says() {
    let folder = corpus().join("exchange");
    let scratch = tempfile::tempdir().expect("a folder");
    let mut wrong = Vec::new();
    for row in index(&folder.join("INDEX.tsv")) {
        let name = row.get("file");
        let (out, report) = (scratch.path().join("out.ply"), scratch.path().join("report.json"));
        let ran = run("mesh {} -o {} --report {}", &[&folder.join(name), &out, &report]);
        let exits: Vec<i32> = row.get("exits").split(',').map(|code| code.parse().expect("a code")).collect();
        if !exits.contains(&ran.code) {
            wrong.push(format!("{name}: exit {}, expected {exits:?}: {}", ran.code, ran.stderr));
            continue;
        }
        if ran.code == 2 {
            if ran.stderr.lines().count() != 1 || !ran.stderr.contains(row.get("phrase")) {
                wrong.push(format!("{name}: {}", ran.stderr));
            }
            continue;
        }
        let report = json(&report);
        if ran.code == 0
            && row.get("closed") == "yes"
            && report["faces"]["meshed"] != 0
            && report["closedness"] != "closed"
        {
            wrong.push(format!("{name}: not closed"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
