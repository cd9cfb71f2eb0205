//! The command line of `chordal render`.

use chordal::Tolerance;
use clap::{Args, ValueEnum};
use std::path::PathBuf;

#[derive(Debug, Args)]
#[cfg_attr(not(feature = "render"), allow(dead_code, reason = "read by builds that draw"))]
pub struct RenderArgs {
    /// A CAD file.
    #[arg(value_name = "IN")]
    pub input: PathBuf,
    /// The picture to write; its name ends in .png.
    #[arg(short, long, value_name = "OUT.png", value_parser = parse_picture)]
    pub output: PathBuf,
    /// Width and height in pixels.
    #[arg(long, value_name = "WxH", default_value = "1280x960", value_parser = parse_size)]
    pub size: SizeArg,
    /// iso, top, bottom, front, back, left, right, or the positions of the eye and the target in mm, as
    /// x,y,z,x,y,z.
    #[arg(long, value_name = "VIEW", default_value = "iso", allow_hyphen_values = true)]
    pub camera: String,
    /// The projection.
    #[arg(long, value_enum, default_value = "orthographic")]
    pub projection: ProjectionArg,
    /// Move a camera given by position until it sees the whole model; named cameras always do.
    #[arg(long)]
    pub fit: bool,
    /// Magnification about the middle of the picture; 1 shows the whole model.
    #[arg(long, value_name = "FACTOR", default_value = "1", value_parser = parse_zoom,
        allow_hyphen_values = true)]
    pub zoom: ZoomArg,
    /// Draw the mesh or the exact surfaces.
    #[arg(long, value_enum, default_value = "mesh")]
    pub mode: ModeArg,
    /// With --mode nurbs: how faces are trimmed [default: exact].
    #[arg(long, value_enum)]
    pub trim: Option<TrimArg>,
    /// With --mode nurbs: the normals that faces are lit by [default: exact].
    #[arg(long, value_enum)]
    pub normals: Option<NormalsArg>,
    /// How it is drawn.
    #[arg(long, value_enum, default_value = "shaded")]
    pub style: StyleArg,
    /// Do not draw the lines of the style.
    #[arg(long)]
    pub no_lines: bool,
    /// light, dark, transparent, or a colour #rrggbb.
    #[arg(long, value_name = "COLOUR", default_value = "light")]
    pub background: String,
    /// Cut away the part of the model with x·X + y·Y + z·Z > d (mm), given as X,Y,Z,d.
    #[arg(long, value_name = "X,Y,Z,d", allow_hyphen_values = true)]
    pub section: Option<String>,
    /// Largest distance between the triangles drawn and the exact surfaces: a length, or a percentage of the
    /// model's diagonal.
    #[arg(long, value_name = "LENGTH|%", default_value = "0.03%", allow_hyphen_values = true)]
    pub tolerance: Tolerance,
    /// Which device draws.
    #[arg(long, value_enum, default_value = "best")]
    pub device: DeviceArg,
    /// Suppress results; only problems are shown.
    #[arg(short, long)]
    pub quiet: bool,
}

/// Pixels.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(not(feature = "render"), allow(dead_code, reason = "read by builds that draw"))]
pub struct SizeArg(pub [u32; 2]);

/// Above 0.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(not(feature = "render"), allow(dead_code, reason = "read by builds that draw"))]
pub struct ZoomArg(pub f64);

fn parse_picture(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match path.extension() {
        Some(ending) if ending.eq_ignore_ascii_case("png") => Ok(path),
        _ => Err("pictures are written as PNG, into files whose names end in .png".into()),
    }
}

fn parse_size(text: &str) -> Result<SizeArg, String> {
    let numbers = text.split_once(['x', '×']).map(|(w, h)| (w.trim().parse(), h.trim().parse()));
    match numbers {
        Some((Ok(w @ 1..=32_768), Ok(h @ 1..=32_768))) => Ok(SizeArg([w, h])),
        _ => Err("not a width and a height such as 1280x960".into()),
    }
}

fn parse_zoom(text: &str) -> Result<ZoomArg, String> {
    match text.trim().parse::<f64>() {
        Ok(zoom) if zoom > 0.0 && zoom.is_finite() => Ok(ZoomArg(zoom)),
        _ => Err("not a number above 0".into()),
    }
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum TrimArg {
    /// Every sample of a pixel against the curves, sharp at any zoom.
    Exact,
    /// By a texture in which the loops are counted even and odd.
    Texture,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum NormalsArg {
    /// The normals of the surface at every pixel.
    Exact,
    /// The normals at the samples, interpolated between them.
    Interpolated,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum ProjectionArg {
    Orthographic,
    /// 30° from the lower to the upper border.
    Perspective,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum ModeArg {
    /// The triangles of the mesh.
    Mesh,
    /// The exact surfaces, evaluated for the view to half a pixel and trimmed at every sample (shaded and
    /// edges).
    Nurbs,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum StyleArg {
    /// Lit faces in the model's colours, and its edges.
    Shaded,
    /// The edges alone, those behind faces hidden.
    Edges,
    /// The edges of all triangles.
    Wireframe,
    /// Mean curvature: red where the outside is convex, blue where it is hollow.
    Curvature,
    /// Distance between the mesh and the exact surfaces.
    Error,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum DeviceArg {
    /// Hardware if there is any, else software.
    Best,
    Hardware,
    /// Mesa's lavapipe or another program on the CPU.
    Software,
}
