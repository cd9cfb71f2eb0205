//! What is requested of a mesh, and the threads.

use super::values::*;
use chordal::methods::{EdgeMethodEntry, StrategyEntry};
use chordal::{Bound, InputFormat, MeshOptions, ReadOptions, Sewing, Tolerance, Winding};
use clap::Args;

/// What is requested of a mesh, and the threads.
#[derive(Debug, Args)]
pub struct AccuracyArgs {
    /// Largest distance between the mesh and the exact surfaces: a length with its unit (0.1mm, 50um,
    /// 0.002in; a bare number is in mm), or a percentage of the diagonal of the model's axis-aligned box
    /// (0.05%).
    #[arg(
        long, visible_aliases = ["sag", "linear-deflection"], value_name = "LENGTH|%", default_value = "0.1%",
        allow_hyphen_values = true
    )]
    pub tolerance: Tolerance,
    /// Separate tolerance for the edges of the model [default: same as --tolerance]. Facets that touch an
    /// edge may be as far off as the larger of the two.
    #[arg(long, value_name = "LENGTH|%", allow_hyphen_values = true)]
    pub boundary_tolerance: Option<Tolerance>,
    /// Largest angle between the exact normals at the two ends of a mesh edge on one face: 20deg, 0.35rad, a
    /// bare number in degrees, or `off` [default: 20deg].
    #[arg(
        long, visible_alias = "angular-deflection", value_name = "ANGLE", value_parser = parse_angle,
        allow_hyphen_values = true
    )]
    pub angle: Option<AngleArg>,
    /// Longest mesh edge: a length with its unit (a bare number is in mm) [default: no limit].
    #[arg(long, value_name = "LENGTH", value_parser = chordal::parse_length, allow_hyphen_values = true)]
    pub max_edge: Option<f64>,
    /// How points are placed and connected.
    #[arg(long, value_name = "NAME", default_value = "default", value_parser = strategies())]
    pub strategy: &'static StrategyEntry,
    /// How edges become chords; every chord is proven against the edge itself.
    #[arg(long, value_name = "NAME", default_value = "default", value_parser = edge_methods())]
    pub edge_method: &'static EdgeMethodEntry,
    /// How the error of a facet is determined.
    #[arg(long, value_enum, default_value = "proven")]
    pub bound: BoundArg,
    /// Join free edges of neighbouring faces that are closer than this: a length (a bare number is in mm),
    /// `auto` (from the resolution of the file and its gaps, see `info`) or `off` [default: auto for parts
    /// without shared edges, else off].
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
    pub sew: Option<Sewing>,
    /// Which points trimming loops keep, where the format does not distinguish outer loops from holes (Open
    /// Inventor, VRML, X3D; refused for others) [default: odd].
    #[arg(long, value_enum)]
    pub winding: Option<WindingArg>,
    /// The format of the input [default: recognised by content].
    #[arg(long, value_name = "FORMAT", value_parser = input_formats())]
    pub input_format: Option<InputFormat>,
    /// Number of threads [default: one per core]. The mesh is the same for any number.
    #[arg(long, value_name = "N", value_parser = parse_jobs, allow_hyphen_values = true)]
    pub jobs: Option<usize>,
    /// Limit of processor time per face and per edge in seconds of an ordinary core, 0 for none [default: 4;
    /// 60 with a named strategy or edge method].
    #[arg(long, value_name = "S", value_parser = parse_seconds, allow_hyphen_values = true)]
    pub face_timeout: Option<TimeoutArg>,
    /// Limit of processor time of all faces of a file in seconds, 0 for none; larger files than a megabyte
    /// and finer tolerances than 0.1 % have proportionally more [default: as --face-timeout].
    #[arg(long, value_name = "S", value_parser = parse_seconds, allow_hyphen_values = true)]
    pub file_timeout: Option<TimeoutArg>,
    /// Limit of the memory that the triangles of a file take in MB, 0 for none; larger files than a megabyte
    /// and finer tolerances than 0.1 % have proportionally more.
    #[arg(long, value_name = "MB", default_value = "1000")]
    pub memory: u64,
    /// Do not look for triangles of closed shells that cut each other, and do not refine where they do.
    #[arg(long)]
    pub no_self_intersections: bool,
}

impl AccuracyArgs {
    /// Refuses limits that a strategy ignores.
    ///
    /// # Errors
    /// One sentence with the option and the strategy.
    pub fn check(&self) -> Result<(), String> {
        match self.limits_of_facets() {
            Some(option) if self.is_estimated() && self.strategy.strategy.is_some() => Err(format!(
                "{option} has no effect on the faces of --strategy {} with --bound estimated; \
                 use --bound proven",
                self.strategy.name
            )),
            _ => Ok(()),
        }
    }

    /// Refuses what has no effect on a command that meshes parts as they are in the file, without an audit.
    ///
    /// # Errors
    /// One sentence with the option.
    pub fn check_without_audit(&self, command: &str) -> Result<(), String> {
        if self.sew.is_some() {
            return Err(format!("--sew has no effect on `{command}`, which meshes faces without sewing"));
        }
        if self.no_self_intersections {
            return Err(format!(
                "--no-self-intersections has no effect on `{command}`, which does not audit its meshes"
            ));
        }
        Ok(())
    }

    /// The first given option that limits facets beside the tolerance.
    pub fn limits_of_facets(&self) -> Option<&'static str> {
        let angle = self.angle.is_some_and(|angle| angle.0.is_some());
        let given = [("--angle", angle), ("--max-edge", self.max_edge.is_some())];
        given.into_iter().find(|(_, is_given)| *is_given).map(|(option, _)| option)
    }

    /// True if errors are estimated, not proven.
    pub fn is_estimated(&self) -> bool {
        matches!(self.bound, BoundArg::Estimated)
    }

    /// As options of the library.
    pub fn options(&self) -> MeshOptions {
        let bound = match self.bound {
            BoundArg::Proven => Bound::Proven,
            BoundArg::Estimated => Bound::Estimated,
        };
        let options = MeshOptions::default();
        let default_angle = options.mesher().angle;
        let options = options
            .with_tolerance(self.tolerance)
            .with_boundary_tolerance(self.boundary_tolerance)
            .with_angle(self.angle.map_or(default_angle, |given| given.0))
            .with_max_edge(self.max_edge)
            .with_fill_method(self.strategy.fill_method())
            .with_edge_splitter(self.edge_method.edge_splitter())
            .with_sewing(self.sew.unwrap_or_default())
            .with_bound(bound)
            .with_self_intersections(!self.no_self_intersections)
            .with_memory((self.memory > 0).then(|| self.memory.saturating_mul(1_000_000)));
        let options = self.face_timeout.iter().fold(options, |o, t| o.with_face_timeout(t.0));
        self.file_timeout.iter().fold(options, |o, t| o.with_file_timeout(t.0))
    }

    /// As options of the readers.
    pub fn read_options(&self) -> ReadOptions {
        let winding = self.winding.map(|winding| match winding {
            WindingArg::Odd => Winding::Odd,
            WindingArg::Even => Winding::Even,
        });
        ReadOptions::default().with_winding(winding)
    }
}
