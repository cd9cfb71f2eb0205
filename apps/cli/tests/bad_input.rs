//! Broken files: the right exit code, one sentence that names what is broken, no panic, no half-written
//! output.

mod common;

use common::{corpus, files_in, index, run};
use std::time::{Duration, Instant};

#[test]
fn broken_files_end_as_the_index_says() {
    let folder = corpus().join("bad");
    let mut wrong = Vec::new();
    for row in index(&folder.join("INDEX.tsv")) {
        let (name, phrase) = (row.get("name"), row.get("phrase"));
        let codes: Vec<i32> = row.get("exit").split(',').map(|c| c.parse().expect("an exit code")).collect();
        let input = folder.join(name).with_extension("step");
        let scratch = tempfile::tempdir().expect("a folder");
        let (out, report) = (scratch.path().join("out.ply"), scratch.path().join("report.json"));
        let started = Instant::now();
        let ran = run("mesh {} -o {} --report {} --face-timeout 5", &[&input, &out, &report]);
        let mut expect = |holds: bool, what: &str| {
            if !holds {
                wrong.push(format!("{name}: {what}; exit {}, stderr: {}", ran.code, ran.stderr));
            }
        };
        expect(started.elapsed() < Duration::from_secs(30), "takes too long");
        expect(codes.contains(&ran.code), "exit code");
        expect(!ran.stderr.contains("internal error"), "panicked");
        expect(ran.stdout.is_empty(), "standard output");
        let files = files_in(scratch.path());
        if ran.code == 2 {
            expect(ran.stderr.lines().count() == 1, "more than a sentence");
            expect(files.is_empty(), "something was written");
            expect(ran.stderr.contains(phrase), "the phrase is not in the sentence");
        } else {
            expect(files == ["out.ply", "report.json"], "the files that were written");
            let said = std::fs::read_to_string(&report).unwrap_or_default();
            expect(said.contains(phrase) || ran.stderr.contains(phrase), "the phrase is not in the report");
        }
        let strict = run("mesh {} -o {} --strict", &[&input, &scratch.path().join("strict.ply")]);
        expect(strict.code != 1, "strict ends with 1");
        expect(strict.code == 0 || !scratch.path().join("strict.ply").exists(), "strict wrote a file");
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
