//! Runs the program as a user does.
#![allow(dead_code, reason = "every test file uses its own part of this")]

use std::ffi::OsStr;
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::thread::sleep;
use std::time::{Duration, Instant};

/// The exit code of a program that did not end in time.
pub const HANGS: i32 = -1;
/// Every file of the corpus is small; machines of continuous integration are slow.
const PATIENCE: Duration = Duration::from_secs(60);

/// The output of one run, and its exit code.
#[derive(Debug)]
pub struct Ran {
    pub code: i32,
    pub stdout: String,
    pub stderr: String,
}

impl Ran {
    /// True if the run found no GPU: the test is skipped then, and a line on standard error says so.
    /// `CHORDAL_REQUIRE_GPU=1` makes the test fail instead.
    pub fn lacks_gpu(&self) -> bool {
        if self.code != 2 || !self.stderr.contains("device was found") {
            return false;
        }
        let required = std::env::var_os("CHORDAL_REQUIRE_GPU").is_some_and(|v| v != "0");
        assert!(!required, "CHORDAL_REQUIRE_GPU is set, but {}", self.stderr);
        let thread = std::thread::current();
        // Not by a macro: the test harness hides what a passing test prints by macros.
        let name = thread.name().unwrap_or("a test");
        let _ = writeln!(std::io::stderr(), "{name}: skipped: {}", self.stderr.trim_end());
        true
    }

    /// The exit code must be one of `codes`.
    #[track_caller]
    pub fn exits(self, codes: &[i32]) -> Self {
        assert!(
            codes.contains(&self.code),
            "exit {} is none of {codes:?}; stderr:\n{}",
            self.code,
            self.stderr
        );
        self
    }

    /// One line on standard error, nothing on standard output.
    #[track_caller]
    pub fn says_one_sentence(self) -> Self {
        assert_eq!(self.stderr.lines().count(), 1, "stderr:\n{}", self.stderr);
        assert!(self.stderr.starts_with("chordal: "), "stderr:\n{}", self.stderr);
        assert_eq!(self.stdout, "");
        self
    }
}

/// Runs `chordal` with these arguments.
pub fn chordal<S: AsRef<OsStr>>(args: impl IntoIterator<Item = S>) -> Ran {
    let scratch = tempfile::tempdir().expect("a folder");
    // Files, not pipes: a full pipe would block the program.
    let (out, err) = (scratch.path().join("stdout"), scratch.path().join("stderr"));
    let mut child = Command::new(env!("CARGO_BIN_EXE_chordal"))
        .args(args)
        .stdout(File::create(&out).expect("a file"))
        .stderr(File::create(&err).expect("a file"))
        .spawn()
        .expect("the program starts");
    let started = Instant::now();
    let code = loop {
        if let Some(status) = child.try_wait().expect("a child") {
            break status.code().expect("the program was not killed");
        }
        if started.elapsed() > PATIENCE {
            child.kill().and_then(|()| child.wait()).expect("a child");
            break HANGS;
        }
        sleep(Duration::from_millis(2));
    };
    let text = |path: &Path| std::fs::read_to_string(path).expect("UTF-8");
    Ran { code, stdout: text(&out), stderr: text(&err) }
}

/// Runs a command line without spaces in its arguments, paths put in for `{}`.
pub fn run(line: &str, paths: &[&Path]) -> Ran {
    let mut paths = paths.iter();
    let args: Vec<String> = line
        .split_whitespace()
        .map(|word| match word {
            "{}" => paths.next().expect("a path for every {}").display().to_string(),
            other => other.to_owned(),
        })
        .collect();
    chordal(args)
}

pub fn corpus() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../corpus")
        .canonicalize()
        .expect("the corpus is in the repository")
}

pub fn model(name: &str) -> PathBuf {
    corpus().join(name).with_extension("step")
}

/// The rows of an index, each by the names of its columns.
pub struct Row {
    columns: Vec<(String, String)>,
}

impl Row {
    #[track_caller]
    pub fn get(&self, column: &str) -> &str {
        &self.columns.iter().find(|(name, _)| name == column).expect("a column of the index").1
    }
}

pub fn index(path: &Path) -> Vec<Row> {
    let text = std::fs::read_to_string(path).expect("the index is in the repository");
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().expect("a header").split('\t').collect();
    lines
        .map(|line| Row {
            columns: names
                .iter()
                .zip(line.split('\t'))
                .map(|(n, v)| ((*n).to_owned(), v.to_owned()))
                .collect(),
        })
        .collect()
}

pub fn files_in(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = std::fs::read_dir(folder)
        .expect("a folder")
        .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

pub fn json(path: &Path) -> serde_json::Value {
    serde_json::from_str(&std::fs::read_to_string(path).expect("a report")).expect("JSON")
}
