//! The command line: what can be requested, with units and defaults.

mod accuracy;
mod mesh;
mod others;
mod values;

pub use accuracy::AccuracyArgs;
pub use mesh::{EvaluateArg, MeshArgs};
pub use others::{
    BenchArgs, CheckArgs, CompareArgs, CompletionsArgs, ConvertArgs, InfoArgs, ReproArgs, SewArgs,
};
pub use values::FormatArg;

use crate::render_args::RenderArgs;
use clap::{Parser, Subcommand};

/// CAD geometry in, watertight triangle meshes with a proven error out.
///
/// `chordal part.step` is short for `chordal mesh part.step`.
///
/// Exit codes: 0, done without problems; 1, done, with problems (standard error and --report list them); 2,
/// nothing was written. Results go to standard output, messages to standard error.
#[derive(Debug, Parser)]
#[command(name = "chordal", version, arg_required_else_help = true)]
pub struct Cli {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Debug, Subcommand)]
pub enum Command {
    /// Mesh CAD files.
    ///
    /// Reads STEP, IGES, BREP, 3DM, Open Inventor, VRML, X3D, free-form OBJ and JSON; writes STL, PLY, OBJ,
    /// GLB, glTF and 3MF.
    Mesh(MeshArgs),
    /// Show the contents of a CAD file: assembly tree, units, faces by kind, gaps, problems.
    Info(InfoArgs),
    /// Join the borders of a triangle mesh (STL, PLY, OBJ, GLB, 3MF).
    Sew(SewArgs),
    /// Check a mesh file (STL, PLY, OBJ, GLB, 3MF): closed, oriented, no degenerate or duplicate triangles.
    ///
    /// With --against, also its measured distance from a CAD file.
    Check(CheckArgs),
    /// Write the exact model of a CAD file as Chordal's own JSON, without loss.
    Convert(ConvertArgs),
    /// Write the smallest piece of a model that shows the problem of a face, to be sent with a report.
    ///
    /// The piece has no names and nothing of the file's header: the surface, loops and edges of the face, and
    /// those of its neighbours where the problem needs them. It is meshed again before it is written.
    Repro(ReproArgs),
    /// Draw a picture of a model, as PNG.
    ///
    /// Needs a build with the feature `gpu`, and a Vulkan device or Mesa's software device.
    Render(RenderArgs),
    /// Mesh a model with several strategies and compare triangles, time, proven and measured error.
    Compare(CompareArgs),
    /// Time reading and meshing in this process.
    #[command(hide = true)]
    Bench(BenchArgs),
    /// Print a completion script for a shell.
    ///
    /// For bash: `chordal completions bash > ~/.local/share/bash-completion/completions/chordal`
    #[command(hide = true)]
    Completions(CompletionsArgs),
    /// Print the manual page.
    ///
    /// `chordal man > chordal.1`
    #[command(hide = true)]
    Man,
}
