//! `chordal compare`: the same model by several strategies.

use crate::args::{CompareArgs, strategies_named};
use crate::exit::{Exit, print, say};
use chordal::{Bound, Cancel, ComparedRow, Comparison};
use std::fmt::Write;

pub fn run(args: &CompareArgs) -> Exit {
    let comparison = match compare(args) {
        Ok(comparison) => comparison,
        Err(error) => {
            say(&error.to_string());
            return Exit::Nothing;
        }
    };
    print(&if args.json { comparison.to_json() } else { table(&comparison) });
    if let Some(path) = &args.plot
        && let Err(error) = chordal::write_whole(path, &chordal::plot(&comparison))
    {
        say(&format!("{}: {error}", path.display()));
        return Exit::Undone;
    }
    Exit::Clean
}

fn compare(args: &CompareArgs) -> Result<Comparison, chordal::JobError> {
    let options = args.accuracy.options();
    let strategies = strategies_named(&args.strategies);
    let bounds: &[Bound] =
        if args.both_bounds { &[Bound::Proven, Bound::Estimated] } else { &[options.bound] };
    let mut tell = |row: &ComparedRow| {
        if !args.quiet {
            say(&format!(
                "{}, {}: {} triangles, {:.2} s",
                row.strategy, row.bound, row.triangles, row.seconds
            ));
        }
    };
    let cancel = Cancel::default();
    chordal::thread_pool(options.jobs)?
        .install(|| chordal::compare(&args.input, &options, &strategies, bounds, &cancel, &mut tell))
}

/// Writing to a string cannot fail, so results of `writeln!` are dropped.
fn table(comparison: &Comparison) -> String {
    let mut out = format!(
        "{}: {} faces, tolerance {:.6} mm\n\n{:<18} {:<9} {:>10} {:>8} {:>9} {:>12} {:>12} {:>7} {:>6}\n",
        comparison.model,
        comparison.faces,
        comparison.tolerance,
        "strategy",
        "bound",
        "triangles",
        "edges",
        "seconds",
        "proven mm",
        "measured mm",
        "ratio",
        "failed"
    );
    for row in &comparison.rows {
        let proven = row.proven_error.map_or_else(|| "none".into(), |e| format!("{e:.4e}"));
        let _ = writeln!(
            out,
            "{:<18} {:<9} {:>10} {:>8} {:>9.3} {proven:>12} {:>12.4e} {:>7.2} {:>6}",
            row.strategy,
            row.bound,
            row.triangles,
            row.edges,
            row.seconds,
            row.measured_error,
            row.ratio,
            row.failed_faces
        );
    }
    out
}
