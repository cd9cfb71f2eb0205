//! `chordal sew`: joins the borders of a triangle mesh.

use crate::args::{FormatArg, SewArgs};
use crate::check::cad_hint;
use crate::exit::{Exit, print, say};
use crate::outputs::format_of;
use chordal::brep::issue::words::{count, length_mm};
use chordal::mesh_file::{MeshSewing, MeshSewingReport, sew_mesh_file};
use std::fmt::Write;

/// The number of open borders that are shown; JSON has more.
const SHOWN: usize = 8;

/// Runs the command.
pub fn run(args: &SewArgs) -> Exit {
    let format = match format_of(&args.output, args.format.map(FormatArg::format)) {
        Ok(format) => format,
        Err(sentence) => {
            say(&sentence);
            return Exit::Nothing;
        }
    };
    let options = MeshSewing::default()
        .with_tolerance(args.tolerance)
        .with_unit(args.unit)
        .with_format(Some(format))
        .with_levels(args.levels);
    match sew_mesh_file(&args.mesh, &args.output, &options) {
        Ok(found) => {
            print(&if args.json { found.to_json() } else { text(&found) });
            if found.open_after == 0 && found.inconsistent == 0 { Exit::Clean } else { Exit::Problems }
        }
        Err(error) => {
            say(&format!("{error}{}", cad_hint(&args.mesh)));
            Exit::Nothing
        }
    }
}

/// Writing to a string cannot fail, so results of `writeln!` are dropped.
fn text(found: &MeshSewingReport) -> String {
    let mut out = String::new();
    let how = match &found.auto {
        None => String::new(),
        Some(auto) => {
            let sure = if auto.unambiguous { "" } else { ", ambiguous" };
            let [low, high] = auto.empty_range.map(length_mm);
            let resolution = length_mm(auto.resolution);
            format!(" (resolution {resolution}, no gaps from {low} to {high}{sure})")
        }
    };
    let _ = writeln!(out, "tolerance     {}{how}", length_mm(found.tolerance));
    let _ = writeln!(out, "triangles     {} → {}", found.triangles_before, found.triangles);
    let borders = count(found.borders, "border", "borders");
    let _ = writeln!(out, "open edges    {} in {borders} → {}", found.open_before, found.open_after);
    let _ = writeln!(
        out,
        "joined        {}, {} inserted, {} merged, {} rejected",
        count(found.joined, "edge segment", "edge segments"),
        count(found.inserted, "vertex", "vertices"),
        found.merged,
        found.rejected
    );
    let _ = writeln!(out, "largest move  {}", length_mm(found.largest_move));
    let _ = writeln!(out, "shells        {}, {} closed", found.shells, found.closed_shells);
    faults(&mut out, found);
    borders_left(&mut out, found);
    for level in &found.levels {
        let triangles = count(level.triangles, "triangle", "triangles");
        let _ = writeln!(
            out,
            "level         {}: {triangles}, error about {}",
            level.path,
            length_mm(level.error)
        );
    }
    out
}

fn faults(out: &mut String, found: &MeshSewingReport) {
    let faults = [
        (found.flipped, "triangle reversed", "triangles reversed"),
        (found.inconsistent, "inconsistent edge", "inconsistent edges"),
        (found.folded, "folded triangle", "folded triangles"),
        (found.degenerate, "triangle without area removed", "triangles without area removed"),
    ];
    for (number, one, many) in faults.into_iter().filter(|f| f.0 > 0) {
        let _ = writeln!(out, "              {}", count(number, one, many));
    }
}

fn borders_left(out: &mut String, found: &MeshSewingReport) {
    for open in found.open.iter().take(SHOWN) {
        let nearest = open.nearest.map_or_else(
            || "no other border".into(),
            |[low, high]| format!("{} to {} from the nearest border", length_mm(low), length_mm(high)),
        );
        let [x, y, z] = open.at.map(|c| format!("{c:.4}"));
        let edges = count(open.edges, "edge", "edges");
        let _ = writeln!(
            out,
            "open          {edges}, {} long, {nearest}, at ({x}, {y}, {z})",
            length_mm(open.length)
        );
    }
    if found.open.len() > SHOWN {
        let _ = writeln!(out, "              and {} more", found.open.len() - SHOWN);
    }
}
