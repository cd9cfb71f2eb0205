//! The sentences that people read about a whole report: problems of one kind become one sentence.

use super::{Closedness, Problem, Report};
use chordal_brep::issue::words::{count, length_mm};

/// A sentence names at most this many entities; the report lists all of them.
const NAMED: usize = 5;

impl Report {
    /// One sentence for every kind of error, in the order of the stages; empty where the report is clean.
    pub fn error_sentences(&self) -> Vec<String> {
        let mut sentences = Vec::new();
        let (of_faces, others): (Vec<&Problem>, Vec<&Problem>) =
            self.errors().partition(|p| p.face.is_some());
        let coded =
            |code: &str| -> Vec<&Problem> { of_faces.iter().copied().filter(|p| p.code == code).collect() };
        let (unproven, over) = (coded("unproven-face"), coded("over-tolerance"));
        let failed: Vec<&Problem> = of_faces
            .iter()
            .copied()
            .filter(|p| p.stage != "audit" && p.code != "unproven-face" && p.code != "over-tolerance")
            .collect();
        if let Some(first) = failed.first() {
            let number = format!("{} of {}", self.faces.failed, count(self.faces.total, "face", "faces"));
            sentences.push(format!("{number} failed: {}{}", first.sentence(), and_more(failed.len())));
        }
        if !unproven.is_empty() {
            let number = self.faces.meshed - self.faces.proven;
            let total = count(self.faces.meshed, "face", "faces");
            sentences.push(format!("the error of {number} of {total} is not proven: {}", places(&unproven)));
        }
        if let Some(first) = over.first() {
            sentences.push(format!("{}{}", first.sentence(), and_more(over.len())));
        }
        let lost: Vec<&Problem> = others.iter().copied().filter(|p| p.stage == "read").collect();
        if let Some(first) = lost.first() {
            sentences.push(format!(
                "some geometry may be missing: {}{}",
                first.sentence(),
                and_more(lost.len())
            ));
        }
        let leaking: Vec<&Problem> = others.iter().copied().filter(|p| p.code == "leaking-shell").collect();
        if let Some(first) = leaking.first() {
            let total = count(self.shells.closed_in_file, "closed shell", "closed shells");
            sentences.push(format!("{} ({} of {total})", first.sentence(), self.shells.leaking));
        }
        let of_audit: Vec<&Problem> = self.errors().filter(|p| p.stage == "audit").collect();
        if let Some(first) = of_audit.first() {
            let part = first.part.as_ref().map_or_else(String::new, |part| format!(" of part `{part}`"));
            sentences.push(format!(
                "the audit{part} found: {}{}",
                first.sentence(),
                and_more(of_audit.len())
            ));
        }
        let known = |p: &Problem| p.stage == "read" || p.stage == "audit" || p.code == "leaking-shell";
        sentences.extend(others.iter().filter(|p| !known(p)).map(|p| p.sentence()));
        sentences
    }

    /// What is proven of the faces: `290 of 292 faces proven within 0.55 mm; 2 unproven: #6387 (line 9),
    /// #6390`.
    pub fn proof_sentence(&self) -> String {
        let meshed = self.faces.meshed;
        if meshed == 0 {
            return "no face meshed".into();
        }
        if self.options.bound == "estimated" {
            return "error estimated, not proven".into();
        }
        let Some(error) = self.proven_error else {
            return match meshed {
                1 => "error of the face not proven".into(),
                n => format!("error not proven for any of {n} faces"),
            };
        };
        let within = length_mm(error);
        let unproven = meshed - self.faces.proven;
        if unproven == 0 {
            return match meshed {
                1 => format!("1 face proven within {within}"),
                n => format!("all {n} faces proven within {within}"),
            };
        }
        let names = self.unproven_faces.iter().take(NAMED).map(|face| match (&face.entity, face.line) {
            (Some(entity), Some(line)) => format!("{entity} (line {line})"),
            (Some(entity), None) => entity.clone(),
            (None, Some(line)) => format!("line {line}"),
            (None, None) => format!("a face of `{}`", face.part),
        });
        let names: Vec<String> = names.collect();
        let more = self.unproven_faces.len().saturating_sub(NAMED);
        let more = if more > 0 { format!(" and {more} more") } else { String::new() };
        let proven = self.faces.proven;
        let total = count(meshed, "face", "faces");
        format!("{proven} of {total} proven within {within}; {unproven} unproven: {}{more}", names.join(", "))
    }

    /// What the requested methods gave up, so that the default made it: `strategy quadtree gave up 3 of 28
    /// faces`; `None` where they gave up nothing.
    pub fn given_up_sentence(&self) -> Option<String> {
        let options = &self.options;
        let mut given_up = Vec::new();
        if self.faces.given_up > 0 {
            let total = count(self.faces.total, "face", "faces");
            given_up
                .push(format!("strategy {} gave up {} of {total}", options.strategy, self.faces.given_up));
        }
        if self.edges_given_up > 0 {
            let edges = count(self.edges_given_up, "edge", "edges");
            given_up.push(format!("edge method {} gave up {edges}", options.edge_method));
        }
        (!given_up.is_empty()).then(|| format!("{}: made by the default", given_up.join(" and ")))
    }

    /// Whether the surface is closed: `watertight`, `open by design (28 open edges)`, `leaking (1 of 2 closed
    /// shells)`.
    pub fn closedness_sentence(&self) -> String {
        let shells = &self.shells;
        match self.closedness {
            None => "closedness not examined".into(),
            Some(Closedness::Closed) => "watertight".into(),
            Some(Closedness::OpenByDesign) if shells.closed > 0 => {
                let closed = count(shells.closed, "watertight shell", "watertight shells");
                format!("{closed}, {} open by design", shells.open_by_design)
            }
            Some(Closedness::OpenByDesign) => "open by design".into(),
            Some(Closedness::Leaking) => {
                let total = count(shells.closed_in_file, "closed shell", "closed shells");
                format!("leaking ({} of {total})", shells.leaking)
            }
        }
    }
}

/// ` (and 3 more)`, for the problems after the first.
fn and_more(problems: usize) -> String {
    if problems > 1 { format!(" (and {} more)", problems - 1) } else { String::new() }
}

/// `#6387 (line 9), #6390 (line 14) and 3 more`.
fn places(problems: &[&Problem]) -> String {
    let unnamed = || "a face without a number in the file".to_owned();
    let named: Vec<String> = problems.iter().take(NAMED).map(|p| p.place().unwrap_or_else(unnamed)).collect();
    let more = problems.len().saturating_sub(NAMED);
    if more > 0 { format!("{} and {more} more", named.join(", ")) } else { named.join(", ") }
}
