//! `chordal check`: what is wrong with a mesh file.

use crate::args::CheckArgs;
use crate::exit::{Exit, print, say};
use chordal::CheckReport;

pub fn run(args: &CheckArgs) -> Exit {
    let found = match chordal::check_mesh(&args.mesh, args.unit) {
        Ok(found) => found,
        Err(error) => {
            say(&error.to_string());
            return Exit::Nothing;
        }
    };
    print(&if args.json { found.to_json() } else { text(&found) });
    if found.clean() { Exit::Clean } else { Exit::Undone }
}

fn text(found: &CheckReport) -> String {
    let yes = |is: bool| if is { "yes" } else { "no" };
    let volume =
        found.volume.map_or_else(|| "none: not closed and oriented".into(), |v| format!("{v:.6} mm³"));
    format!(
        "triangles   {}\nvertices    {}\nclosed      {} ({} open edges)\noriented    {} ({} inconsistent edges)\n\
         degenerate  {}\nduplicate   {}\nvolume      {volume}\n",
        found.triangles,
        found.vertices,
        yes(found.closed),
        found.open_edges,
        yes(found.oriented),
        found.inconsistent_edges,
        found.degenerate_triangles,
        found.duplicate_triangles
    )
}
