//! `chordal info`: the contents of a CAD file.

use crate::args::InfoArgs;
use crate::exit::{Exit, print, say};
use crate::inputs::Input;
use crate::messages::error_sentence;
use crate::reading::read_model;
use crate::tree;
use chordal::brep::issue::words::{count, length_mm, number};
use chordal::report::GapSurvey;
use chordal::{Info, PartInfo, ReadOptions};
use std::fmt::Write;

/// The number of lines of a list that are shown without `--full`.
const SHOWN: usize = 20;

/// Runs the command.
pub fn run(args: &InfoArgs) -> Exit {
    let input = Input::of(&args.input);
    let model = match read_model(&input, args.input_format, &ReadOptions::default()) {
        Ok(model) => model,
        Err(error) => {
            say(&error_sentence(&input.name(), &error));
            return Exit::Nothing;
        }
    };
    let info = model.info();
    if args.json {
        print(&(serde_json::to_string_pretty(&info).expect("info has string keys only") + "\n"));
    } else {
        print(&text(&info, if args.full { usize::MAX } else { SHOWN }));
    }
    Exit::Clean
}

/// Writing to a string cannot fail, so results of `writeln!` are dropped.
fn text(info: &Info, limit: usize) -> String {
    let mut out = String::new();
    let _ = writeln!(out, "name      {}", info.name);
    let _ = writeln!(out, "format    {}", info.format);
    let _ = writeln!(out, "unit      {}", info.unit);
    if let Some([min, max]) = info.r#box {
        let [x, y, z] = [0, 1, 2].map(|i| number(max[i] - min[i], 6));
        let _ = writeln!(out, "box       {x} × {y} × {z} mm, diagonal {} mm", number(info.diagonal, 6));
    }
    let kinds: Vec<String> =
        info.faces_by_kind.iter().map(|(kind, count)| format!("{kind} {count}")).collect();
    let _ = writeln!(out, "faces     {}: {}", info.faces, kinds.join(", "));
    let gap = &info.max_gap;
    let _ = writeln!(
        out,
        "gaps      vertex to curve {}{}, curve to surface {}{} (measured at samples)",
        length_mm(gap.vertex_to_curve),
        at(gap.vertex_to_curve_at.as_deref()),
        length_mm(gap.curve_to_surface),
        at(gap.curve_to_surface_at.as_deref())
    );
    parts(&mut out, info, limit);
    let placed: usize = info.parts.iter().map(|part| part.instances).sum();
    let _ = writeln!(out, "\ntree ({} placed)", count(placed, "part", "parts"));
    out.push_str(&tree::draw(info, limit));
    lists(&mut out, info, limit);
    out
}

fn parts(out: &mut String, info: &Info, limit: usize) {
    let _ = writeln!(out, "\nparts ({})", info.parts.len());
    for part in info.parts.iter().take(limit) {
        let uncertainty =
            part.uncertainty.map_or_else(String::new, |mm| format!("; uncertainty {}", length_mm(mm)));
        let entity = part.entity.as_ref().map_or_else(String::new, |entity| format!(" {entity}"));
        let name = if part.name.is_empty() { "(no name)" } else { &part.name };
        let _ = writeln!(out, "  {name}{entity} × {}: {}{uncertainty}", part.instances, contents(part));
        if let Some(survey) = part.sewing.as_ref().filter(|_| part.open_edges > 0) {
            sewing(out, part, survey);
        }
    }
    more(out, info.parts.len(), limit);
}

/// `1 solid, 1 closed shell, 28 faces, 72 edges, 48 vertices`.
fn contents(part: &PartInfo) -> String {
    let open_shells = part.shells - part.closed_shells;
    let all = [
        (part.solids, "solid", "solids"),
        (part.sheets, "sheet body", "sheet bodies"),
        (part.face_sets, "face set", "face sets"),
        (part.closed_shells, "closed shell", "closed shells"),
        (open_shells, "open shell", "open shells"),
        (part.faces, "face", "faces"),
        (part.edges, "edge", "edges"),
        (part.vertices, "vertex", "vertices"),
        (part.tessellated_triangles, "triangle in the file", "triangles in the file"),
    ];
    let some: Vec<String> =
        all.into_iter().filter(|(n, _, _)| *n > 0).map(|(n, one, many)| count(n, one, many)).collect();
    some.join(", ")
}

/// The tolerance that `--sew auto` would take, and the histogram that it is derived from.
fn sewing(out: &mut String, part: &PartInfo, survey: &GapSurvey) {
    let shared = if part.topology { "" } else { ", no edge shared by two faces" };
    let sure = if survey.unambiguous { "" } else { ", ambiguous" };
    let [low, high] = survey.empty_range.map(length_mm);
    let _ = writeln!(
        out,
        "    {}{shared}; --sew auto: {} (resolution {}, no gaps from {low} to {high}{sure})",
        count(part.open_edges, "open edge", "open edges"),
        length_mm(survey.tolerance),
        length_mm(survey.resolution),
    );
    let bins: Vec<String> =
        survey.histogram.iter().map(|(_, below, count)| format!("<{below:.0e}: {count}")).collect();
    let _ = writeln!(out, "    gaps to the nearest other border, mm  {}", bins.join("  "));
}

fn lists(out: &mut String, info: &Info, limit: usize) {
    if !info.loose.is_empty() {
        let _ = writeln!(out, "\nloose items, which belong to no face ({})", info.loose.len());
        for item in info.loose.iter().take(limit) {
            let entity = item.entity.as_deref().unwrap_or_default();
            let _ = writeln!(out, "  {} {entity} {} in {}", item.kind, item.name, item.part);
        }
        more(out, info.loose.len(), limit);
    }
    if !info.problems.is_empty() {
        let _ = writeln!(out, "\nproblems ({})", info.problems.len());
        for problem in info.problems.iter().take(limit) {
            let _ = writeln!(out, "  {}: {}", problem.severity.name(), problem.sentence());
        }
        more(out, info.problems.len(), limit);
    }
}

fn more(out: &mut String, number: usize, limit: usize) {
    if number > limit {
        let _ = writeln!(out, "  … {} more (--full)", number - limit);
    }
}

fn at(entity: Option<&str>) -> String {
    entity.map_or_else(String::new, |entity| format!(" at {entity}"))
}
