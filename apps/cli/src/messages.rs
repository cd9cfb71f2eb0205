//! The messages about a mesh on standard error.

use crate::exit::say;
use chordal::brep::issue::words::{count, length_mm, number};
use chordal::{Error, Report, Severity};

/// The number of warnings shown per input without `-v`. The report has all of them.
const WARNINGS_SHOWN: usize = 3;

/// How many messages are printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Talk {
    /// Problems only.
    Quiet,
    /// The options, the result, some warnings.
    Normal,
    /// All warnings and notes, and the time of the stages.
    Verbose,
}

/// An error about an input, which is named once.
pub fn error_sentence(input: &str, error: &Error) -> String {
    match error {
        Error::File { .. } => error.to_string(),
        _ => format!("{input}: {error}"),
    }
}

/// Prints the options, the result and the problems.
pub fn tell(talk: Talk, report: &Report) {
    let input = &report.input.path;
    if talk >= Talk::Normal {
        say(&format!("{input}: {}", options_line(report)));
        say(&format!("{input}: {}", result_line(report)));
        if let Some(sentence) = report.given_up_sentence() {
            say(&format!("{input}: {sentence}"));
        }
        warnings(talk, report);
    }
    if talk == Talk::Verbose {
        say(&format!("{input}: {}", seconds_line(report)));
    }
    for sentence in report.error_sentences() {
        say(&format!("{input}: problem: {sentence}"));
    }
}

fn warnings(talk: Talk, report: &Report) {
    let input = &report.input.path;
    let shown = |severity| talk == Talk::Verbose || severity == Severity::Warning;
    let warnings: Vec<_> = report.warnings().filter(|p| shown(p.severity)).collect();
    let limit = if talk == Talk::Verbose { usize::MAX } else { WARNINGS_SHOWN };
    for warning in warnings.iter().take(limit) {
        say(&format!("{input}: {}: {}", warning.severity.name(), warning.sentence()));
    }
    if warnings.len() > limit {
        say(&format!("{input}: {} (see -v)", count(warnings.len() - limit, "more warning", "more warnings")));
    }
}

/// `tolerance 0.1 % = 0.2 mm, angle 20°, proven bound, 4 threads`.
fn options_line(report: &Report) -> String {
    let options = &report.options;
    let tolerance = match options.tolerance_requested.ends_with('%') {
        true => format!("{} = {}", options.tolerance_requested, length_mm(options.tolerance)),
        false => length_mm(options.tolerance),
    };
    let angle = options.angle.map_or_else(|| "off".into(), |a| format!("{}°", number(a, 4)));
    let max_edge = options.max_edge.map_or_else(String::new, |l| format!(", longest edge {}", length_mm(l)));
    let threads = count(report.threads, "thread", "threads");
    format!("tolerance {tolerance}, angle {angle}{max_edge}, {} bound, {threads}", options.bound)
}

/// `28 faces, 412 triangles, all 28 faces proven within 0.05 mm, gap 0 mm, watertight, 0.02 s`.
fn result_line(report: &Report) -> String {
    let (meshed, all) = (report.faces.meshed, count(report.faces.total, "face", "faces"));
    let faces = if meshed == report.faces.total { all } else { format!("{meshed} of {all} meshed") };
    format!(
        "{faces}, {}, {}, gap {}, {}, {:.2} s",
        count(report.triangles, "triangle", "triangles"),
        report.proof_sentence(),
        length_mm(report.max_edge_gap),
        report.closedness_sentence(),
        report.seconds.total
    )
}

/// `read 0.01 s, sew 0 s, …`.
fn seconds_line(report: &Report) -> String {
    let s = &report.seconds;
    let stages = [
        ("read", s.read),
        ("sew", s.sew),
        ("measure", s.resolve),
        ("trim", s.trim),
        ("edges", s.edges),
        ("faces", s.faces),
        ("stitch", s.stitch),
        ("audit", s.audit),
        ("write", s.write),
    ];
    let stages: Vec<String> =
        stages.iter().map(|(name, time)| format!("{name} {} s", number(*time, 2))).collect();
    stages.join(", ")
}
