//! Progress and cancelling: work stops when the callback breaks, or when a flag is set from another thread.

use chordal::{Cancel, Error, Mesher, Model, Phase};
use std::ops::ControlFlow;
use std::path::Path;

fn main() -> Result<(), Error> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../corpus/bracket.step");
    let model = Model::open(path)?;

    let shown = Mesher::default().with_progress(|phase, fraction| {
        println!("{phase:?} {:.0} %", 100.0 * fraction);
        ControlFlow::Continue(())
    });
    println!("{} triangles", shown.mesh(&model)?.report().triangles);

    let stopped = Mesher::default().with_progress(|phase, fraction| {
        if phase == Phase::Meshing && fraction >= 0.5 {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    });
    assert!(matches!(stopped.mesh(&model), Err(Error::Cancelled)));

    let cancel = Cancel::default();
    let mesher = Mesher::default().with_cancel(cancel.clone());
    std::thread::spawn(move || cancel.cancel()).join().expect("setting a flag does not panic");
    assert!(matches!(mesher.mesh(&model), Err(Error::Cancelled)));
    Ok(())
}
