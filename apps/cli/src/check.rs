//! `chordal check`: what is wrong with a mesh file.

use crate::args::CheckArgs;
use crate::exit::{Exit, print, say};
use chordal::brep::issue::words::length_mm;
use chordal::mesh_file::{AgainstReport, CheckReport, check_mesh};
use chordal::{InputFormat, MeshOptions, Tolerance};
use std::fmt::Write;
use std::path::Path;

/// The fine mesh that stands for the model: ten times as fine as the default, in percent of the diagonal.
const REFERENCE: Tolerance = Tolerance::Percent(0.01);

pub fn run(args: &CheckArgs) -> Exit {
    let options = MeshOptions::default().with_tolerance(REFERENCE);
    let against = args.against.as_deref().map(|input| (input, &options));
    let found = match check_mesh(&args.mesh, args.unit, against) {
        Ok(found) => found,
        Err(error) => {
            say(&format!("{error}{}", cad_hint(&args.mesh)));
            return Exit::Nothing;
        }
    };
    print(&if args.json { found.to_json() } else { text(&found) });
    // What the file is loose by is no error of the mesh.
    let far = |limit: f64| {
        let largest = |a: &AgainstReport| a.mesh_to_model_beyond_gap.max(a.model_to_mesh_beyond_gap);
        found.against.as_ref().is_some_and(|a| largest(a) > limit)
    };
    if found.clean() && !args.tolerance.is_some_and(far) { Exit::Clean } else { Exit::Problems }
}

/// A hint for a CAD model in place of a mesh.
pub fn cad_hint(path: &Path) -> &'static str {
    let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default();
    match InputFormat::of_extension(extension) {
        None | Some(InputFormat::Obj | InputFormat::Json) => "",
        Some(_) => "; a CAD model is meshed by `chordal mesh` and described by `chordal info`",
    }
}

/// Writing to a string cannot fail, so results of `write!` are dropped.
fn text(found: &CheckReport) -> String {
    let yes = |is: bool| if is { "yes" } else { "no" };
    let volume = found
        .volume
        .map_or_else(|| "n/a (the mesh is not closed and oriented)".into(), |v| format!("{v:.6} mm³"));
    let mut out = format!(
        "triangles   {}\nvertices    {}\nclosed      {} ({} open edges)\n\
         oriented    {} ({} inconsistent edges)\n\
         degenerate  {}\nduplicate   {}\nvolume      {volume}\n",
        found.triangles,
        found.vertices,
        yes(found.closed),
        found.open_edges,
        yes(found.oriented),
        found.inconsistent_edges,
        found.degenerate_triangles,
        found.duplicate_triangles
    );
    if let Some(against) = &found.against {
        distances(&mut out, against);
    }
    out
}

fn distances(out: &mut String, against: &AgainstReport) {
    let within = against.reference_error.map_or_else(String::new, |e| format!(" (± {})", length_mm(e)));
    let _ = writeln!(out, "\nagainst     {}, {}", against.model, against.method);
    let at_most =
        |most: Option<f64>| most.map_or_else(String::new, |m| format!(", at most {}", length_mm(m)));
    let _ = writeln!(
        out,
        "mesh → model  {}{within} at {} samples{}\nmodel → mesh  {} at {} samples{}",
        both(against.mesh_to_model, against.mesh_to_model_beyond_gap),
        against.mesh_samples,
        at_most(against.mesh_to_model_at_most),
        both(against.model_to_mesh, against.model_to_mesh_beyond_gap),
        against.model_samples,
        at_most(against.model_to_mesh_at_most)
    );
    if against.faces_not_compared > 0 {
        let _ = writeln!(out, "{} faces of the model were not compared", against.faces_not_compared);
    }
    for face in &against.worst_faces {
        let distance = both(face.distance, face.beyond_gap);
        let _ = writeln!(out, "  {distance}  {} {} of {}", face.kind, face.id, face.part);
    }
}

/// A distance, and what of it is beyond the gap of the file where that is less.
fn both(distance: f64, beyond_gap: f64) -> String {
    let [whole, beyond] = [distance, beyond_gap].map(length_mm);
    if whole == beyond { whole } else { format!("{whole} ({beyond} beyond the gap of the file)") }
}
