//! The command line: what can be asked, with its units and defaults.

use crate::render_args::RenderArgs;
use chordal::methods::{EdgeMethodEntry, StrategyEntry, edge_method_named, strategy_named};
use chordal::{Bound, Format, JobOptions, ReadOptions, Sew, Tolerance, Unit, UpAxis, Winding};
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::path::PathBuf;
use std::time::Duration;

/// CAD geometry in, watertight meshes of proven accuracy out.
///
/// Exit codes: 0, all was done; 1, a mesh was written but something was left undone (the report says what);
/// 2, nothing was written. Data goes to standard output, talk to standard error.
#[derive(Debug, Parser)]
#[command(name = "chordal", version, arg_required_else_help = true)]
pub struct Cli {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Debug, Subcommand)]
pub enum Command {
    /// Mesh CAD files: STEP, IGES, BREP, 3DM, Open Inventor, VRML, X3D, free-form OBJ or JSON in; STL, PLY, OBJ, GLB or 3MF out.
    Mesh(MeshArgs),
    /// Say what is in a CAD file: tree, units, faces by kind, gaps, loose items, warnings.
    Info(InfoArgs),
    /// Sew the borders of a triangle mesh to each other: STL, PLY, OBJ, GLB or 3MF in and out.
    Sew(SewArgs),
    /// Check a mesh file: closed, oriented, without degenerate and duplicate triangles; with --against, its measured
    /// distance from a CAD file.
    Check(CheckArgs),
    /// Write the exact model of a CAD file as Chordal's own JSON, whole and without loss.
    Convert(ConvertArgs),
    /// Draw a picture of a model, as PNG (needs a build with the feature `render`, and a Vulkan device or Mesa's
    /// software one).
    Render(RenderArgs),
    /// Mesh a model by several strategies and compare: triangles, edges, seconds, proven and measured error.
    Compare(CompareArgs),
    /// Time reading and meshing in process.
    #[command(hide = true)]
    Bench(BenchArgs),
}

#[derive(Debug, Args)]
pub struct MeshArgs {
    /// CAD files.
    #[arg(required = true, value_name = "IN")]
    pub inputs: Vec<PathBuf>,
    /// The mesh file, or a folder (one that exists, or a name that ends in `/`); a folder where there are several
    /// inputs.
    #[arg(short, long, value_name = "OUT")]
    pub output: PathBuf,
    #[command(flatten)]
    pub accuracy: AccuracyArgs,
    /// The format of the output [default: by the extension of OUT; needed where OUT is a folder].
    #[arg(long, value_enum)]
    pub format: Option<FormatArg>,
    /// The unit of the written coordinates: um, mm, cm, m, in or ft [default: mm, in GLB m].
    #[arg(long)]
    pub unit: Option<Unit>,
    /// The axis of the written file that points up [default: z, in GLB y].
    #[arg(long, value_enum)]
    pub up: Option<UpArg>,
    /// Write patches of `--strategy bezier` as quadrilaterals (OBJ and PLY only).
    #[arg(long)]
    pub quads: bool,
    /// Write the edges of the model as lines too (GLB only).
    #[arg(long)]
    pub edges: bool,
    /// Who evaluates faces with thousands of points: the CPU, or a GPU with double precision (needs a build with the feature
    /// `render`). Errors are proven on the CPU either way.
    #[arg(long, value_enum, default_value = "cpu")]
    pub device: EvaluateArg,
    /// Write the report to this file, as JSON; one object for one input, a list for several.
    #[arg(long, value_name = "R.json")]
    pub report: Option<PathBuf>,
    /// Draw the subdivision and the triangles of every face in its plane of parameters, as SVG files in this folder.
    #[arg(long, value_name = "DIR")]
    pub debug_svg: Option<PathBuf>,
    /// Write nothing at all, and exit with 2, where anything would be left undone.
    #[arg(long)]
    pub strict: bool,
    /// Show no progress and echo no options.
    #[arg(short, long)]
    pub quiet: bool,
}

/// What is asked of the mesh, and the threads.
#[derive(Debug, Args)]
pub struct AccuracyArgs {
    /// Largest distance between the mesh and the exact surfaces: a length with its unit (0.1mm, 50um, 0.002in; a bare
    /// number is in mm), or a percentage of the diagonal of the tight axis-aligned box of the whole model (0.05%).
    #[arg(
        long, visible_aliases = ["sag", "linear-deflection"], value_name = "LENGTH|%", default_value = "0.1%",
        allow_hyphen_values = true
    )]
    pub tolerance: Tolerance,
    /// Largest distance between the edges of the model and their chords, where it is to be another one than --tolerance:
    /// finer, or coarser (facets that touch an edge may then be as far off as that) [default: as --tolerance].
    #[arg(long, value_name = "LENGTH|%", allow_hyphen_values = true)]
    pub boundary_tolerance: Option<Tolerance>,
    /// Largest angle between the exact normals at the two ends of a mesh edge on one face: 20deg, 0.35rad, a bare
    /// number in degrees, or `off`.
    #[arg(
        long, visible_alias = "angular-deflection", value_name = "ANGLE", default_value = "20deg",
        value_parser = parse_angle, allow_hyphen_values = true
    )]
    pub angle: AngleArg,
    /// Longest mesh edge, a length with its unit (a bare number is in mm) [default: no limit].
    #[arg(long, value_name = "LENGTH", value_parser = chordal::parse_length, allow_hyphen_values = true)]
    pub max_edge: Option<f64>,
    /// How points are placed and connected.
    #[arg(long, value_name = "NAME", default_value = "default", value_parser = strategies())]
    pub strategy: &'static StrategyEntry,
    /// How edges become chords; every chord is proven against the edge itself.
    #[arg(long, value_name = "NAME", default_value = "default", value_parser = edge_methods())]
    pub edge_method: &'static EdgeMethodEntry,
    /// Whether the error of a facet is proven by an upper bound or estimated from samples.
    #[arg(long, value_enum, default_value = "proven")]
    pub bound: BoundArg,
    /// Sew edges that one face alone uses to the borders of other faces that are this near: a length (a bare number is in
    /// mm), `auto` (by the resolution of the file and the histogram of its gaps, see `info`) or `off` [default: auto for
    /// parts no two faces of which share an edge, off for others].
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
    pub sew: Option<Sew>,
    /// Which points trimming loops keep, where the format does not tell outer loops from holes (Open Inventor, VRML, X3D).
    #[arg(long, value_enum, default_value = "odd")]
    pub winding: WindingArg,
    /// Threads [default: one per core]. The output is the same for any number.
    #[arg(long, value_name = "N", value_parser = parse_jobs)]
    pub jobs: Option<usize>,
    /// Seconds after which a face is given up, 0 for never.
    #[arg(long, value_name = "S", default_value = "60", value_parser = parse_seconds)]
    pub face_timeout: TimeoutArg,
}

/// Radians; `None`: no limit.
#[derive(Clone, Copy, Debug)]
pub struct AngleArg(pub Option<f64>);

/// `None`: never.
#[derive(Clone, Copy, Debug)]
pub struct TimeoutArg(pub Option<Duration>);

fn parse_angle(text: &str) -> Result<AngleArg, chordal::QuantityError> {
    chordal::parse_angle(text).map(AngleArg)
}

/// Strategies by name, with a line of help for each.
fn strategies() -> impl TypedValueParser<Value = &'static StrategyEntry> {
    let names = chordal::methods::strategies().iter().map(|e| PossibleValue::new(e.name).help(e.summary));
    PossibleValuesParser::new(names).try_map(|name| strategy_named(&name).ok_or("no such strategy"))
}

/// Edge methods by name, with a line of help for each.
fn edge_methods() -> impl TypedValueParser<Value = &'static EdgeMethodEntry> {
    let names = chordal::methods::edge_methods().iter().map(|e| PossibleValue::new(e.name).help(e.summary));
    PossibleValuesParser::new(names).try_map(|name| edge_method_named(&name).ok_or("no such edge method"))
}

fn parse_jobs(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(n @ 1..=1024) => Ok(n),
        _ => Err("not a number of threads from 1 to 1024".into()),
    }
}

fn parse_seconds(text: &str) -> Result<TimeoutArg, String> {
    let seconds: f64 =
        text.trim().trim_end_matches('s').parse().map_err(|_| "not a number of seconds".to_owned())?;
    match Duration::try_from_secs_f64(seconds) {
        Ok(time) => Ok(TimeoutArg((!time.is_zero()).then_some(time))),
        Err(_) => Err("not a number of seconds".into()),
    }
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum BoundArg {
    /// The tolerance is a promise.
    Proven,
    /// Faster, no promise.
    Estimated,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum WindingArg {
    /// Those that an odd number of loops goes around.
    Odd,
    /// Those that an even number of loops, or none, goes around: the outermost loops are holes.
    Even,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum FormatArg {
    /// Binary STL.
    Stl,
    /// ASCII STL, one named solid per part.
    StlAscii,
    /// Binary PLY with double coordinates.
    Ply,
    Obj,
    Glb,
    /// glTF as text with its buffer embedded.
    Gltf,
    #[value(name = "3mf")]
    ThreeMf,
}

impl FormatArg {
    pub fn format(self) -> Format {
        match self {
            FormatArg::Stl => Format::StlBinary,
            FormatArg::StlAscii => Format::StlAscii,
            FormatArg::Ply => Format::Ply,
            FormatArg::Obj => Format::Obj,
            FormatArg::Glb => Format::Glb,
            FormatArg::Gltf => Format::Gltf,
            FormatArg::ThreeMf => Format::ThreeMf,
        }
    }
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum UpArg {
    Y,
    Z,
}

impl AccuracyArgs {
    /// As the library's options.
    pub fn options(&self) -> JobOptions {
        let bound = match self.bound {
            BoundArg::Proven => Bound::Proven,
            BoundArg::Estimated => Bound::Estimated,
        };
        let winding = match self.winding {
            WindingArg::Odd => Winding::Odd,
            WindingArg::Even => Winding::Even,
        };
        JobOptions::default()
            .with_tolerance(self.tolerance)
            .with_boundary_tolerance(self.boundary_tolerance)
            .with_angle(self.angle.0)
            .with_max_edge(self.max_edge)
            .with_fill_method(self.strategy.fill_method())
            .with_edge_splitter(self.edge_method.edge_splitter())
            .with_sew(self.sew.unwrap_or_default())
            .with_bound(bound)
            .with_read(ReadOptions::default().with_winding(winding))
            .with_jobs(self.jobs)
            .with_face_timeout(self.face_timeout.0)
    }
}

impl MeshArgs {
    /// As the library's options.
    pub fn options(&self) -> JobOptions {
        let up = self.up.map(|up| match up {
            UpArg::Y => UpAxis::Y,
            UpArg::Z => UpAxis::Z,
        });
        self.accuracy
            .options()
            .with_format(self.format.map(FormatArg::format))
            .with_unit(self.unit)
            .with_up(up)
            .with_edges(self.edges)
            .with_quads(self.quads)
            .with_strict(self.strict)
            .with_debug_svg(self.debug_svg.clone())
    }
}

#[derive(Debug, Args)]
pub struct InfoArgs {
    /// A CAD file.
    #[arg(value_name = "IN")]
    pub input: PathBuf,
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
    /// Borders this near are sewn: a length (a bare number is in mm), or `auto`, by the resolution of the coordinates and the
    /// histogram of the gaps. No vertex moves further.
    #[arg(long, value_name = "LENGTH", default_value = "auto", allow_hyphen_values = true)]
    pub tolerance: Sew,
    /// Write so many coarser meshes as well, each with half the triangles of the one before, to OUT.level1, … (needs a
    /// build with the feature `levels`).
    #[arg(long, value_name = "N", default_value = "0")]
    pub levels: usize,
    /// The unit of the mesh's coordinates [default: what the file says, else mm].
    #[arg(long)]
    pub unit: Option<Unit>,
    /// The format of the output [default: by the extension of OUT].
    #[arg(long, value_enum)]
    pub format: Option<FormatArg>,
    /// Print JSON instead of text.
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
pub struct CheckArgs {
    /// A mesh file: STL, PLY, OBJ, GLB or 3MF.
    #[arg(value_name = "MESH")]
    pub mesh: PathBuf,
    /// A CAD file to measure the mesh against, both ways, at samples.
    #[arg(long, value_name = "IN")]
    pub against: Option<PathBuf>,
    /// With --against: exit with 1 where a measured distance is larger than this length (a bare number is in mm).
    #[arg(long, value_name = "LENGTH", value_parser = chordal::parse_length, allow_hyphen_values = true)]
    pub tolerance: Option<f64>,
    /// The unit of the mesh's coordinates [default: what the file says, else mm].
    #[arg(long)]
    pub unit: Option<Unit>,
    /// Print JSON instead of text.
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
pub struct ConvertArgs {
    /// A CAD file.
    #[arg(value_name = "IN")]
    pub input: PathBuf,
    /// The file to write; its name ends in .json.
    #[arg(short, long, value_name = "OUT.json")]
    pub output: PathBuf,
    /// Make every face an island, with edges of its own that it shares with no other face.
    #[arg(long)]
    pub unsewn: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum EvaluateArg {
    Cpu,
    /// Hardware if there is any, else a software device such as Mesa's lavapipe.
    Gpu,
}

#[derive(Debug, Args)]
pub struct CompareArgs {
    /// A CAD file.
    #[arg(value_name = "IN")]
    pub input: PathBuf,
    #[command(flatten)]
    pub accuracy: AccuracyArgs,
    /// Which strategies, separated by commas [default: all].
    #[arg(long, value_name = "NAMES", value_delimiter = ',', value_parser = strategies())]
    pub strategies: Vec<&'static StrategyEntry>,
    /// Compare the proven and the estimated bound instead of the one of --bound.
    #[arg(long)]
    pub both_bounds: bool,
    /// Draw the comparison into this file, as SVG.
    #[arg(long, value_name = "OUT.svg")]
    pub plot: Option<PathBuf>,
    /// Print JSON instead of a table; it also says which parts of the tessellator ran.
    #[arg(long)]
    pub json: bool,
    /// Say nothing on the way.
    #[arg(short, long)]
    pub quiet: bool,
}

/// All strategies where none is named.
pub fn strategies_named(asked: &[&'static StrategyEntry]) -> Vec<&'static StrategyEntry> {
    if asked.is_empty() { chordal::methods::strategies().iter().collect() } else { asked.to_vec() }
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
    /// The tables of Balázs, Guthe, Klein 2004 instead; `tools/paper_tables.py` makes a page of them.
    #[arg(long)]
    pub papers: bool,
}
