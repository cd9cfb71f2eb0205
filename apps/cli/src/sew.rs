//! `chordal sew`: joins the borders of a triangle mesh.

use crate::args::{FormatArg, SewArgs};
use crate::exit::{Exit, print, say};
use chordal::{MeshSewing, MeshSewingReport};
use std::fmt::Write;

/// So many open borders are shown; JSON has more.
const SHOWN: usize = 8;

pub fn run(args: &SewArgs) -> Exit {
    let options = MeshSewing::default()
        .with_tolerance(args.tolerance)
        .with_unit(args.unit)
        .with_format(args.format.map(FormatArg::format))
        .with_levels(args.levels);
    match chordal::sew_mesh_file(&args.mesh, &args.output, &options) {
        Ok(found) => {
            print(&if args.json { found.to_json() } else { text(&found) });
            if found.open_after == 0 && found.inconsistent == 0 { Exit::Clean } else { Exit::Undone }
        }
        Err(error) => {
            say(&error.to_string());
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
            format!(
                " (resolution {:.1e}, no gaps from {:.1e} to {:.1e}{sure})",
                auto.resolution, auto.empty_range[0], auto.empty_range[1]
            )
        }
    };
    let _ = writeln!(out, "tolerance     {:.3e} mm{how}", found.tolerance);
    let _ = writeln!(out, "triangles     {} → {}", found.triangles_before, found.triangles);
    let _ = writeln!(
        out,
        "open edges    {} in {} borders → {}",
        found.open_before, found.borders, found.open_after
    );
    let _ = writeln!(
        out,
        "sewn          {} stretches, {} vertices inserted, {} merged, {} refused",
        found.sewn, found.inserted, found.merged, found.refused
    );
    let _ = writeln!(out, "largest move  {:.3e} mm", found.largest_move);
    let _ = writeln!(out, "shells        {}, {} closed", found.shells, found.closed_shells);
    let faults = [
        (found.turned, "triangles turned over"),
        (found.inconsistent, "inconsistent edges"),
        (found.folded, "triangles folded"),
        (found.degenerate, "triangles without area left out"),
    ];
    for (count, what) in faults.iter().filter(|f| f.0 > 0) {
        let _ = writeln!(out, "              {count} {what}");
    }
    for open in found.open.iter().take(SHOWN) {
        let nearest = open.nearest.map_or_else(
            || "no other border".into(),
            |[low, high]| format!("{low:.3e} to {high:.3e} mm from the nearest"),
        );
        let [x, y, z] = open.at.map(|c| format!("{c:.4}"));
        let _ = writeln!(
            out,
            "open          {} edges, {:.4} mm long, {nearest}, at ({x}, {y}, {z})",
            open.edges, open.length
        );
    }
    if found.open.len() > SHOWN {
        let _ = writeln!(out, "              and {} more", found.open.len() - SHOWN);
    }
    for level in &found.levels {
        let _ = writeln!(
            out,
            "level         {}: {} triangles, about {:.3e} mm off",
            level.path, level.triangles, level.error
        );
    }
    out
}
