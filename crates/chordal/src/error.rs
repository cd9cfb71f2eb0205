//! Why a job wrote nothing; each message is one sentence.

use chordal_read::ReadError;
use chordal_write::WriteError;
use std::path::{Path, PathBuf};

/// Why a job wrote nothing.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum JobError {
    #[error("{}", read_sentence(path, source))]
    Read { path: PathBuf, source: ReadError },
    #[error("{}: {source}", path.display())]
    Write { path: PathBuf, source: WriteError },
    #[error("{}: {source}", path.display())]
    Mesh { path: PathBuf, source: chordal_mesh::ImportError },
    #[error("{}: {reason}", path.display())]
    Output { path: PathBuf, reason: String },
    #[error("{}: the file holds no face and no triangle{}", path.display(), but_holds(.loose))]
    Empty { path: PathBuf, loose: usize },
    #[error(
        "{}: a tolerance of {tolerance} mm is below {floor:.1e} mm, the finest that double-precision coordinates of this size can keep",
        path.display()
    )]
    BelowFloor { path: PathBuf, tolerance: f64, floor: f64 },
    #[error("{}: {at}: a coordinate of {reach:.1e} is too large to be meant", path.display())]
    TooLarge { path: PathBuf, at: String, reach: f64 },
    #[error("{}: none of {faces} faces could be meshed: {first}", path.display())]
    NothingMeshed { path: PathBuf, faces: usize, first: String },
    #[error("{}: nothing was written because of --strict: {}", path.display(), first_of(.problems))]
    Strict { path: PathBuf, problems: Vec<String> },
    #[error("{}: cancelled", path.display())]
    Cancelled { path: PathBuf },
    #[error("no pool of {threads} threads: {reason}")]
    Threads { threads: usize, reason: String },
}

/// The reader names the file only where it cannot open it.
fn read_sentence(path: &Path, source: &ReadError) -> String {
    if matches!(source, ReadError::Io { .. }) {
        source.to_string()
    } else {
        format!("{}: {source}", path.display())
    }
}

fn but_holds(loose: &usize) -> String {
    match loose {
        0 => String::new(),
        1 => ", only a loose wire or point".into(),
        n => format!(", only {n} loose wires and points"),
    }
}

fn first_of(problems: &[String]) -> String {
    match problems {
        [] => "the mesh has problems".into(),
        [one] => one.clone(),
        [first, rest @ ..] => format!("{first} (and {} more)", rest.len()),
    }
}
