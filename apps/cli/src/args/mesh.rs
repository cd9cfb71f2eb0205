//! `chordal mesh`.

use super::AccuracyArgs;
use super::values::{FormatArg, UpArg};
use crate::messages::Talk;
use chordal::{MeshOptions, OutputFormat, Unit, UpAxis};
use clap::{Args, ValueEnum};
use std::path::PathBuf;

#[derive(Debug, Args)]
pub struct MeshArgs {
    /// CAD files; folders, which stand for the STEP, IGES, BREP, 3DM, Open Inventor, VRML and X3D files in
    /// them; `-` for standard input.
    #[arg(required = true, value_name = "IN")]
    pub inputs: Vec<PathBuf>,
    /// The mesh file; a folder (one that exists, or a name that ends in `/`); `-` for standard output
    /// [default: beside the input, for standard input to standard output].
    #[arg(short, long, value_name = "OUT")]
    pub output: Option<PathBuf>,
    #[command(flatten)]
    pub accuracy: AccuracyArgs,
    /// The format of the output; it must agree with the extension of OUT [default: by that extension, else
    /// glb].
    #[arg(long, value_enum)]
    pub format: Option<FormatArg>,
    /// Unit of the written coordinates: um, mm, cm, m, in or ft [default: mm, in GLB and glTF m].
    #[arg(long)]
    pub unit: Option<Unit>,
    /// The axis that points up in the written file [default: z, in GLB and glTF y].
    #[arg(long, value_enum)]
    pub up: Option<UpArg>,
    /// Write the quadrilaterals of `--strategy bezier` as such (OBJ and PLY only).
    #[arg(long)]
    pub quads: bool,
    /// Also write the edges of the model as lines (GLB and glTF only).
    #[arg(long)]
    pub edges: bool,
    /// Where to evaluate large faces; errors are proven on the CPU either way. `gpu` needs a build with the
    /// feature `gpu` and a device with double precision.
    #[arg(long, value_enum, default_value = "cpu")]
    pub device: EvaluateArg,
    /// Write the report to this file as JSON: one object for one input, a batch for several.
    #[arg(long, value_name = "R.json")]
    pub report: Option<PathBuf>,
    /// Print the report to standard output as JSON.
    #[arg(long)]
    pub json: bool,
    /// Draw the subdivision and the triangles of every face in its parameter plane, as SVG files in this
    /// folder.
    #[arg(long, value_name = "DIR")]
    pub debug_svg: Option<PathBuf>,
    /// Write nothing and exit with 2 if there is any problem.
    #[arg(long)]
    pub strict: bool,
    /// Suppress progress, results and warnings; only problems are shown.
    #[arg(short, long)]
    pub quiet: bool,
    /// Show all warnings and notes, and the time of every stage.
    #[arg(short, long, conflicts_with = "quiet")]
    pub verbose: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum EvaluateArg {
    /// The processor.
    Cpu,
    /// A graphics device, else a software device such as Mesa's lavapipe.
    Gpu,
}

impl MeshArgs {
    /// The format where the output does not name one.
    pub fn format(&self) -> OutputFormat {
        self.format.map_or(OutputFormat::Glb, FormatArg::format)
    }

    /// The axis that points up.
    pub fn up(&self) -> Option<UpAxis> {
        self.up.map(|up| match up {
            UpArg::Y => UpAxis::Y,
            UpArg::Z => UpAxis::Z,
        })
    }

    /// How many messages are printed.
    pub fn talk(&self) -> Talk {
        match (self.quiet, self.verbose) {
            (true, _) => Talk::Quiet,
            (false, true) => Talk::Verbose,
            (false, false) => Talk::Normal,
        }
    }

    /// As options of the library.
    pub fn options(&self, format: OutputFormat) -> MeshOptions {
        self.accuracy
            .options()
            .with_output_format(Some(format))
            .with_quads(self.quads)
            .with_cells_recorded(self.debug_svg.is_some())
    }
}
