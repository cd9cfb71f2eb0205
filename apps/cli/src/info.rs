//! `chordal info`: what is in a CAD file.

use crate::args::InfoArgs;
use crate::exit::{Exit, print, say};
use chordal::{GapSurvey, Info, NodeInfo, PartInfo};
use std::fmt::Write;

pub fn run(args: &InfoArgs) -> Exit {
    let model = match chordal::read_model(&args.input) {
        Ok(model) => model,
        Err(error) => {
            say(&error.to_string());
            return Exit::Nothing;
        }
    };
    let info = chordal::info(&model);
    if args.json {
        print(&(serde_json::to_string_pretty(&info).expect("info has string keys only") + "\n"));
    } else {
        print(&text(&info));
    }
    Exit::Clean
}

/// Writing to a string cannot fail, so results of `writeln!` are dropped.
fn text(info: &Info) -> String {
    let mut out = String::new();
    let _ = writeln!(out, "name      {}", info.name);
    let _ = writeln!(out, "format    {}", info.format);
    let _ = writeln!(out, "unit      {}", info.unit);
    if let Some([min, max]) = info.r#box {
        let size = [max[0] - min[0], max[1] - min[1], max[2] - min[2]];
        let [x, y, z] = size.map(|s| format!("{s:.4}"));
        let _ = writeln!(out, "box       {x} × {y} × {z} mm, diagonal {:.6} mm", info.diagonal);
    }
    let kinds: Vec<String> =
        info.faces_by_kind.iter().map(|(kind, count)| format!("{kind} {count}")).collect();
    let _ = writeln!(out, "faces     {}: {}", info.faces, kinds.join(", "));
    let gap = &info.max_gap;
    let _ = writeln!(
        out,
        "gaps      vertex to curve {:.3e} mm{}, curve to surface {:.3e} mm{} (measured at samples)",
        gap.vertex_to_curve,
        at(gap.vertex_to_curve_at.as_deref()),
        gap.curve_to_surface,
        at(gap.curve_to_surface_at.as_deref())
    );
    parts(&mut out, info);
    let _ = writeln!(out, "\ntree");
    info.tree.iter().for_each(|node| tree(&mut out, info, node, 1));
    lists(&mut out, info);
    out
}

fn parts(out: &mut String, info: &Info) {
    let _ = writeln!(out, "\nparts");
    for part in &info.parts {
        let mut holds = Vec::new();
        let mut count = |number: usize, what: &str| {
            if number > 0 {
                holds.push(format!("{number} {what}"));
            }
        };
        count(part.solids, "solids");
        count(part.sheets, "sheet bodies");
        count(part.face_sets, "face sets");
        count(part.shells, "shells");
        count(part.closed_shells, "of them closed");
        count(part.faces, "faces");
        count(part.edges, "edges");
        count(part.vertices, "vertices");
        count(part.tessellated_triangles, "triangles in the file");
        let uncertainty = part.uncertainty.map_or_else(String::new, |u| format!("; uncertainty {u}"));
        let entity = part.entity.as_deref().unwrap_or_default();
        let name = if part.name.is_empty() { "(no name)" } else { &part.name };
        let _ = writeln!(out, "  {name} {entity} × {}: {}{uncertainty}", part.instances, holds.join(", "));
        if let Some(survey) = part.sewing.as_ref().filter(|_| part.open_edges > 0) {
            sewing(out, part, survey);
        }
    }
}

/// What `--sew auto` would do, and the histogram it rests on.
fn sewing(out: &mut String, part: &PartInfo, survey: &GapSurvey) {
    let shared = if part.topology { "" } else { ", no edge is shared by two faces" };
    let sure = if survey.unambiguous { "" } else { ", ambiguous" };
    let _ = writeln!(
        out,
        "    open edges {}{shared}; --sew auto: {:.3e} mm (resolution {:.1e}, no gaps from {:.1e} to {:.1e}{sure})",
        part.open_edges, survey.tolerance, survey.resolution, survey.empty_range[0], survey.empty_range[1]
    );
    let bins: Vec<String> =
        survey.histogram.iter().map(|(_, below, count)| format!("<{below:.0e}: {count}")).collect();
    let _ = writeln!(out, "    gaps to the nearest other border, mm  {}", bins.join("  "));
}

/// Leaves of one part under one name are counted instead of repeated.
fn tree(out: &mut String, info: &Info, node: &NodeInfo, depth: usize) {
    let line = |node: &NodeInfo| {
        let part =
            node.part.and_then(|p| info.parts.get(p)).map_or_else(String::new, |p| format!(" [{}]", p.name));
        format!("{}{part}", if node.name.is_empty() { "(no name)" } else { &node.name })
    };
    if depth == 1 {
        let _ = writeln!(out, "  {}", line(node));
    }
    let indent = "  ".repeat(depth + 1);
    let same = |a: &NodeInfo, b: &NodeInfo| {
        a.children.is_empty() && b.children.is_empty() && (&a.name, a.part) == (&b.name, b.part)
    };
    for group in node.children.chunk_by(same) {
        let times = if group.len() > 1 { format!(" × {}", group.len()) } else { String::new() };
        let _ = writeln!(out, "{indent}{}{times}", line(&group[0]));
        tree(out, info, &group[0], depth + 1);
    }
}

fn lists(out: &mut String, info: &Info) {
    if !info.loose.is_empty() {
        let _ = writeln!(out, "\nloose items: belong to no face");
        for item in &info.loose {
            let _ = writeln!(
                out,
                "  {} {} {} in {}",
                item.kind,
                item.entity.as_deref().unwrap_or_default(),
                item.name,
                item.part
            );
        }
    }
    if !info.problems.is_empty() {
        let _ = writeln!(out, "\nproblems");
        for problem in &info.problems {
            let _ = writeln!(out, "  {}: {}", problem.severity.name(), problem.sentence());
        }
    }
}

fn at(entity: Option<&str>) -> String {
    entity.map_or_else(String::new, |entity| format!(" at {entity}"))
}
