//! `chordal compare`: the same model by several strategies.

use crate::args::CompareArgs;
use crate::exit::{Exit, print, say};
use crate::messages::error_sentence;
use crate::process::thread_pool;
use crate::whole_file::write_whole;
use chordal::compare::{ComparedRow, Comparison, plot};
use chordal::methods::{StrategyEntry, strategies};
use chordal::{Bound, Cancel};
use std::fmt::Write;

pub fn run(args: &CompareArgs) -> Exit {
    let comparison = match compare(args) {
        Ok(comparison) => comparison,
        Err(error) => {
            say(&error);
            return Exit::Nothing;
        }
    };
    print(&if args.json { comparison.to_json() } else { table(&comparison) });
    if let Some(path) = &args.plot
        && let Err(error) = write_whole(path, plot(&comparison).as_bytes())
    {
        say(&format!("{}: {error}", path.display()));
        return Exit::Problems;
    }
    Exit::Clean
}

fn compare(args: &CompareArgs) -> Result<Comparison, String> {
    if args.accuracy.strategy.strategy.is_some() {
        return Err("--strategy has no effect here: name the strategies to compare with --strategies".into());
    }
    args.accuracy.check_without_audit("chordal compare")?;
    let options = args.accuracy.options();
    let all = || strategies().iter().collect();
    let compared: Vec<&StrategyEntry> =
        if args.strategies.is_empty() { all() } else { args.strategies.clone() };
    let is_default = |entry: &&StrategyEntry| entry.strategy.is_none();
    if let Some(option) = args.accuracy.limits_of_facets()
        && args.accuracy.is_estimated()
        && !compared.iter().any(is_default)
    {
        return Err(format!(
            "{option} has no effect on the faces of these strategies with --bound estimated; use --bound proven"
        ));
    }
    let bound = options.mesher().bound;
    let bounds: &[Bound] = if args.both_bounds { &[Bound::Proven, Bound::Estimated] } else { &[bound] };
    let mut tell = |row: &ComparedRow| {
        if !args.quiet {
            say(&format!(
                "{}, {}: {} triangles, {:.2} s",
                row.strategy, row.bound, row.triangles, row.seconds
            ));
        }
    };
    let cancel = Cancel::default();
    let read = args.accuracy.read_options();
    thread_pool(args.accuracy.jobs)?
        .install(|| {
            let model = chordal::Model::open_with(&args.input, args.accuracy.input_format, &read)?;
            chordal::compare::compare(&model, &options, &compared, bounds, &cancel, &mut tell)
        })
        .map_err(|error| error_sentence(&args.input.display().to_string(), &error))
}

/// Writing to a string cannot fail, so results of `writeln!` are dropped.
fn table(comparison: &Comparison) -> String {
    let mut out = format!(
        "{}: {} faces, tolerance {:.6} mm\n\n{:<18} {:<9} {:>10} {:>8} {:>9} {:>12} {:>12} \
         {:>7} {:>6} {:>8}\n",
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
        "failed",
        "given up"
    );
    for row in &comparison.rows {
        let proven = row.proven_error.map_or_else(|| "none".into(), |e| format!("{e:.4e}"));
        let _ = writeln!(
            out,
            "{:<18} {:<9} {:>10} {:>8} {:>9.3} {proven:>12} {:>12.4e} {:>7.2} {:>6} {:>8}",
            row.strategy,
            row.bound,
            row.triangles,
            row.edges,
            row.seconds,
            row.measured_error,
            row.ratio,
            row.failed_faces,
            row.given_up_faces
        );
    }
    out
}
