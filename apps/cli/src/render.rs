//! `chordal render`: a picture of a model.

use crate::exit::{Exit, say};
use crate::render_args::RenderArgs;

/// Says how to get a build that draws.
#[cfg(not(feature = "gpu"))]
pub fn run(_args: &RenderArgs) -> Exit {
    say("this build lacks the feature `gpu`; rebuild with \
         `cargo build --release -p chordal-cli --features gpu`");
    Exit::Nothing
}

#[cfg(feature = "gpu")]
pub fn run(args: &RenderArgs) -> Exit {
    drawing::run(args)
}

#[cfg(feature = "gpu")]
mod drawing {
    use super::{Exit, RenderArgs, say};
    use crate::inputs::Input;
    use crate::messages::error_sentence;
    use crate::reading::read_model;
    use crate::render_args::{DeviceArg, ModeArg, NormalsArg, ProjectionArg, StyleArg, TrimArg};
    use crate::whole_file::write_whole;
    use chordal::brep::issue::words::{count, number};
    use chordal::gpu::{
        Background, DeviceChoice, Normals, OptionError, Projection, RenderOptions, SectionPlane, Style, Trim,
        View,
    };
    use chordal::nurbs::DVec3;
    use chordal::{Image, ImageRenderer, MeshOptions, Mesher, ReadOptions, RenderMode, Report};

    pub fn run(args: &RenderArgs) -> Exit {
        match draw(args) {
            Ok(report) if report.clean => Exit::Clean,
            Ok(_) => Exit::Problems,
            Err(sentence) => {
                say(&sentence);
                Exit::Nothing
            }
        }
    }

    fn draw(args: &RenderArgs) -> Result<Report, String> {
        let options = picture(args)?;
        // The device first: without one, nothing else is worth doing.
        let renderer = ImageRenderer::open(device(args)).map_err(|e| e.to_string())?;
        let input = Input::of(&args.input);
        let failed = |error: chordal::Error| error_sentence(&input.name(), &error);
        let model = read_model(&input, None, &ReadOptions::default()).map_err(failed)?;
        let mesher = Mesher::new(MeshOptions::default().with_tolerance(args.tolerance));
        let meshed = mesher.mesh(&model).map_err(failed)?;
        let mode = match args.mode {
            ModeArg::Mesh => RenderMode::Mesh,
            ModeArg::Nurbs => RenderMode::Nurbs,
        };
        let image = renderer.render(&meshed, mode, &options).map_err(|e| format!("{}: {e}", input.name()))?;
        write_whole(&args.output, &image.png)
            .map_err(|e| format!("{}: cannot write the file: {e}", args.output.display()))?;
        let report = meshed.into_report();
        if !args.quiet {
            tell(args, &image, &report, renderer.device_name());
        }
        report.error_sentences().iter().for_each(|e| say(&format!("{}: problem: {e}", input.name())));
        Ok(report)
    }

    fn device(args: &RenderArgs) -> DeviceChoice {
        match args.device {
            DeviceArg::Best => DeviceChoice::Best,
            DeviceArg::Hardware => DeviceChoice::Hardware,
            DeviceArg::Software => DeviceChoice::Software,
        }
    }

    /// An option that has no effect is refused.
    fn check(args: &RenderArgs) -> Result<(), String> {
        let is_mesh = matches!(args.mode, ModeArg::Mesh);
        if !is_mesh && !matches!(args.style, StyleArg::Shaded | StyleArg::Edges) {
            return Err("--mode nurbs needs --style shaded or edges: the other styles show the mesh".into());
        }
        if args.normals.is_some() && matches!(args.style, StyleArg::Edges) {
            return Err("--normals has no effect with --style edges, which does not light faces".into());
        }
        if is_mesh && (args.trim.is_some() || args.normals.is_some()) {
            let option = if args.trim.is_some() { "trim" } else { "normals" };
            return Err(format!("--{option} needs --mode nurbs: it has no effect on a mesh"));
        }
        if args.fit && !args.camera.contains(',') {
            return Err(
                "--fit needs a camera with a place of its own: the named ones see the whole model".into()
            );
        }
        Ok(())
    }

    fn picture(args: &RenderArgs) -> Result<RenderOptions, String> {
        check(args)?;
        let of = |option: &str, reason: &dyn std::fmt::Display| format!("--{option}: {reason}");
        let view: View = args.camera.parse().map_err(|e: OptionError| of("camera", &e))?;
        let background: Background =
            args.background.parse().map_err(|e: OptionError| of("background", &e))?;
        let section = args.section.as_deref().map(section).transpose().map_err(|e| of("section", &e))?;
        let [width, height] = args.size.0;
        Ok(RenderOptions::default()
            .with_size(width, height)
            .with_view(view)
            .with_projection(match args.projection {
                ProjectionArg::Orthographic => Projection::Orthographic,
                ProjectionArg::Perspective => Projection::Perspective,
            })
            .with_fit(args.fit)
            .with_zoom(args.zoom.0)
            .with_style(match args.style {
                StyleArg::Shaded => Style::Shaded,
                StyleArg::Edges => Style::Edges,
                StyleArg::Wireframe => Style::Wireframe,
                StyleArg::Curvature => Style::Curvature,
                StyleArg::Error => Style::Error,
            })
            .with_lines(!args.no_lines)
            .with_background(background)
            .with_section(section)
            .with_trim(match args.trim.unwrap_or(TrimArg::Exact) {
                TrimArg::Exact => Trim::Exact,
                TrimArg::Texture => Trim::Texture,
            })
            .with_normals(match args.normals.unwrap_or(NormalsArg::Exact) {
                NormalsArg::Exact => Normals::Exact,
                NormalsArg::Interpolated => Normals::Interpolated,
            }))
    }

    /// A normal and an offset: four numbers, millimetres.
    fn section(text: &str) -> Result<SectionPlane, String> {
        let numbers: Result<Vec<f64>, _> = text.split(',').map(|n| n.trim().parse()).collect();
        match numbers.as_deref() {
            Ok(&[x, y, z, offset]) if DVec3::new(x, y, z).try_normalize().is_some() => {
                let length = DVec3::new(x, y, z).length();
                Ok(SectionPlane { normal: DVec3::new(x, y, z) / length, offset: offset / length })
            }
            _ => Err("not four numbers: a normal that is not zero, and an offset".into()),
        }
    }

    fn tell(args: &RenderArgs, image: &Image, report: &Report, device: &str) {
        let what = match image.evaluated {
            None => format!(
                "{} of {}",
                count(report.triangles, "triangle", "triangles"),
                count(report.faces.total, "face", "faces")
            ),
            Some(e) => {
                let triangles =
                    if e.meshed > 0 { format!(" ({} drawn as triangles)", e.meshed) } else { String::new() };
                let (points, faces) = (count(e.points, "point", "points"), count(e.drawn, "face", "faces"));
                format!("{points} of {faces}{triangles}")
            }
        };
        say(&format!("{}: {what}, drawn by {device}", args.output.display()));
        if let Some(legend) = image.legend {
            let what = match args.style {
                StyleArg::Curvature => "mean curvature, 1/mm",
                _ => "distance from the exact surface, mm",
            };
            let (low, high) = (number(legend.low, 4), number(legend.high, 4));
            say(&format!("colours from {low} to {high} ({what})"));
        }
    }
}
