//! The problems of a broken file, as data: codes, severities, entities and lines.

use chordal::report::FaceStatus;
use chordal::{Closedness, Error, FileError, Mesher, Model, RequestError, Severity};
use std::path::Path;

fn main() -> Result<(), Error> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../corpus/bad");
    let meshed = Mesher::default().mesh(&Model::open(folder.join("missing_entity.step"))?)?;
    let report = meshed.report();

    for problem in &report.problems {
        let place = problem.entity.as_deref().unwrap_or("the file");
        println!(
            "{:?} {} at {place}: {} {:?}",
            problem.severity, problem.code, problem.message, problem.values
        );
    }
    let failed = report.faces_detail.iter().filter(|face| face.status == FaceStatus::Failed);
    println!("{} failed faces; {} proven", failed.count(), report.faces.proven);
    if report.closedness == Some(Closedness::Leaking) {
        println!("{} open edges, {} missing faces", report.open_edges, report.missing_faces);
    }
    assert!(report.problems.iter().any(|p| p.severity == Severity::Error));

    // An error is of the request, of the file, or a bug.
    match Model::open(folder.join("empty.step")) {
        Err(Error::File { name, reason: FileError::Read(reason) }) => println!("{name}: {reason}"),
        Err(Error::Request(RequestError::Write { path, .. })) => println!("cannot write {}", path.display()),
        Err(other) => println!("{other}"),
        Ok(_) => println!("not empty after all"),
    }
    Ok(())
}
