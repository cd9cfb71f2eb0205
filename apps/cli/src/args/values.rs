//! Values of options: how each is written and read.

use chordal::methods::{EdgeMethodEntry, StrategyEntry, edge_method_named, strategy_named};
use chordal::{InputFormat, OutputFormat};
use clap::ValueEnum;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use std::time::Duration;

/// Radians; `None`: no limit.
#[derive(Clone, Copy, Debug)]
pub struct AngleArg(pub Option<f64>);

/// `None`: no limit.
#[derive(Clone, Copy, Debug)]
pub struct TimeoutArg(pub Option<Duration>);

pub fn parse_angle(text: &str) -> Result<AngleArg, chordal::QuantityError> {
    chordal::parse_angle(text).map(AngleArg)
}

/// Strategies by name, with a line of help for each.
pub fn strategies() -> impl TypedValueParser<Value = &'static StrategyEntry> {
    let names = chordal::methods::strategies().iter().map(|e| PossibleValue::new(e.name).help(e.summary));
    PossibleValuesParser::new(names).try_map(|name| strategy_named(&name).ok_or("unknown strategy"))
}

/// Edge methods by name, with a line of help for each.
pub fn edge_methods() -> impl TypedValueParser<Value = &'static EdgeMethodEntry> {
    let names = chordal::methods::edge_methods().iter().map(|e| PossibleValue::new(e.name).help(e.summary));
    PossibleValuesParser::new(names).try_map(|name| edge_method_named(&name).ok_or("unknown edge method"))
}

/// The formats that are read, by their names in options.
const INPUT_FORMATS: [(&str, InputFormat); 8] = [
    ("step", InputFormat::Step),
    ("iges", InputFormat::Iges),
    ("brep", InputFormat::Brep),
    ("3dm", InputFormat::Rhino),
    ("inventor", InputFormat::Inventor),
    ("x3d", InputFormat::X3d),
    ("obj", InputFormat::Obj),
    ("json", InputFormat::Json),
];

/// Formats that are read, by name.
pub fn input_formats() -> impl TypedValueParser<Value = InputFormat> {
    PossibleValuesParser::new(INPUT_FORMATS.map(|(name, _)| name)).try_map(|name| {
        let found = INPUT_FORMATS.iter().find(|(known, _)| *known == name);
        found.map(|(_, format)| *format).ok_or("unknown format")
    })
}

pub fn parse_jobs(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(n @ 1..=1024) => Ok(n),
        _ => Err("the number of threads must be from 1 to 1024".into()),
    }
}

pub fn parse_seconds(text: &str) -> Result<TimeoutArg, String> {
    let wrong = || "not a number of seconds".to_owned();
    let seconds: f64 = text.trim().trim_end_matches('s').parse().map_err(|_| wrong())?;
    let time = Duration::try_from_secs_f64(seconds).map_err(|_| wrong())?;
    Ok(TimeoutArg((!time.is_zero()).then_some(time)))
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum BoundArg {
    /// By upper bounds: the tolerance is guaranteed.
    Proven,
    /// From samples: faster, without a guarantee.
    Estimated,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum WindingArg {
    /// Keep points inside an odd number of loops (even-odd rule).
    Odd,
    /// Keep points inside an even number of loops, or none: the outermost loops are holes.
    Even,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum FormatArg {
    /// Binary STL.
    Stl,
    /// ASCII STL, one named solid per part.
    StlAscii,
    /// Binary PLY with 64-bit coordinates.
    Ply,
    /// Wavefront OBJ with 64-bit coordinates.
    Obj,
    /// Binary glTF.
    Glb,
    /// glTF as JSON text.
    Gltf,
    /// 3D Manufacturing Format.
    #[value(name = "3mf")]
    ThreeMf,
}

impl FormatArg {
    /// The format of the library.
    pub fn format(self) -> OutputFormat {
        match self {
            FormatArg::Stl => OutputFormat::StlBinary,
            FormatArg::StlAscii => OutputFormat::StlAscii,
            FormatArg::Ply => OutputFormat::Ply,
            FormatArg::Obj => OutputFormat::Obj,
            FormatArg::Glb => OutputFormat::Glb,
            FormatArg::Gltf => OutputFormat::Gltf,
            FormatArg::ThreeMf => OutputFormat::ThreeMf,
        }
    }
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum UpArg {
    Y,
    Z,
}
