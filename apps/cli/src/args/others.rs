//! The other subcommands.

use super::AccuracyArgs;
use super::values::{FormatArg, input_formats, strategies};
use chordal::methods::StrategyEntry;
use chordal::repro::FaceName;
use chordal::{InputFormat, Sewing, Unit};
use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub struct InfoArgs {
    /// A CAD file, or `-` for standard input.
    #[arg(value_name = "IN")]
    pub input: PathBuf,
    /// Show the whole assembly tree and every part and problem, as --json always does.
    #[arg(long, conflicts_with = "json")]
    pub full: bool,
    /// The format of the input [default: recognised by content].
    #[arg(long, value_name = "FORMAT", value_parser = input_formats())]
    pub input_format: Option<InputFormat>,
    /// Print JSON instead of text.
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
pub struct SewArgs {
    /// A mesh file: STL, PLY, OBJ, GLB or 3MF.
    #[arg(value_name = "MESH")]
    pub mesh: PathBuf,
    /// The mesh file to write; every connected shell becomes an object of its own.
    #[arg(short, long, value_name = "OUT")]
    pub output: PathBuf,
    /// Join borders closer than this: a length (a bare number is in mm), or `auto`, from the resolution of
    /// the coordinates and the gaps. No vertex moves further.
    #[arg(long, value_name = "LENGTH", default_value = "auto", value_parser = parse_sewing,
        allow_hyphen_values = true)]
    pub tolerance: Sewing,
    /// Also write N coarser levels of detail, each with half the triangles of the one before, to OUT.level1,
    /// … (needs a build with the feature `levels`).
    #[arg(long, value_name = "N", default_value = "0")]
    pub levels: usize,
    /// Unit of the mesh's coordinates [default: as the file states, else mm].
    #[arg(long)]
    pub unit: Option<Unit>,
    /// The format of the output [default: by the extension of OUT].
    #[arg(long, value_enum)]
    pub format: Option<FormatArg>,
    /// Print JSON instead of text.
    #[arg(long)]
    pub json: bool,
}

/// Sewing a mesh without sewing it makes no sense.
fn parse_sewing(text: &str) -> Result<Sewing, String> {
    match text.parse() {
        Ok(Sewing::Off) => Err("`off` would not join anything".into()),
        Ok(sewing) => Ok(sewing),
        Err(error) => Err(chordal::QuantityError::to_string(&error)),
    }
}

#[derive(Debug, Args)]
pub struct CheckArgs {
    /// A mesh file: STL, PLY, OBJ, GLB or 3MF.
    #[arg(value_name = "MESH")]
    pub mesh: PathBuf,
    /// A CAD file to measure the mesh against, in both directions, at samples.
    #[arg(long, value_name = "IN")]
    pub against: Option<PathBuf>,
    /// With --against: exit with 1 if a measured distance exceeds this length (a bare number is in mm).
    #[arg(
        long, value_name = "LENGTH", value_parser = chordal::parse_length, allow_hyphen_values = true,
        requires = "against"
    )]
    pub tolerance: Option<f64>,
    /// Unit of the mesh's coordinates [default: as the file states, else mm].
    #[arg(long)]
    pub unit: Option<Unit>,
    /// Print JSON instead of text.
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
pub struct ConvertArgs {
    /// A CAD file, or `-` for standard input.
    #[arg(value_name = "IN")]
    pub input: PathBuf,
    /// The file to write; its name ends in .json. `-` is standard output.
    #[arg(short, long, value_name = "OUT.json")]
    pub output: PathBuf,
    /// Separate all faces: no face shares an edge with another one.
    #[arg(long)]
    pub unsewn: bool,
    /// The format of the input [default: recognised by content].
    #[arg(long, value_name = "FORMAT", value_parser = input_formats())]
    pub input_format: Option<InputFormat>,
    /// Print a summary to standard output as JSON.
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
pub struct ReproArgs {
    /// A CAD file, or `-` for standard input.
    #[arg(value_name = "IN")]
    pub input: PathBuf,
    /// The face: #123, the number of its entity, or @5, its place in `faces_detail` of the report.
    #[arg(long, value_name = "ID")]
    pub face: FaceName,
    /// The file to write: Chordal's JSON, or, where the input is STEP, STEP; its name ends in .json or .step.
    /// `-` writes JSON to standard output.
    #[arg(short, long, value_name = "OUT")]
    pub output: PathBuf,
    #[command(flatten)]
    pub accuracy: AccuracyArgs,
    /// Print a summary to standard output as JSON.
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
pub struct CompareArgs {
    /// A CAD file.
    #[arg(value_name = "IN")]
    pub input: PathBuf,
    #[command(flatten)]
    pub accuracy: AccuracyArgs,
    /// Which strategies, separated by commas [default: all].
    #[arg(long, value_name = "NAMES", value_delimiter = ',', value_parser = strategies(),
        conflicts_with = "strategy")]
    pub strategies: Vec<&'static StrategyEntry>,
    /// Compare the proven and the estimated bound.
    #[arg(long, conflicts_with = "bound")]
    pub both_bounds: bool,
    /// Draw the comparison into this file, as SVG.
    #[arg(long, value_name = "OUT.svg")]
    pub plot: Option<PathBuf>,
    /// Print JSON instead of a table; it also lists the methods of the mesher that ran.
    #[arg(long)]
    pub json: bool,
    /// Suppress progress messages.
    #[arg(short, long)]
    pub quiet: bool,
}

#[derive(Debug, Args)]
pub struct BenchArgs {
    /// CAD files.
    #[arg(required = true, value_name = "IN")]
    pub inputs: Vec<PathBuf>,
    #[command(flatten)]
    pub accuracy: AccuracyArgs,
    /// Timed repetitions.
    #[arg(long, default_value = "5", value_name = "N")]
    pub repeat: usize,
    /// Repetitions before the clock starts.
    #[arg(long, default_value = "1", value_name = "N")]
    pub warm: usize,
    /// Print the tables of Balázs, Guthe, Klein 2004 instead, which name the methods.
    #[arg(long, conflicts_with_all = ["repeat", "warm", "strategy", "edge_method", "bound", "winding", "input_format"])]
    pub papers: bool,
}

#[derive(Debug, Args)]
pub struct CompletionsArgs {
    /// The shell.
    pub shell: clap_complete::Shell,
}
