//! `chordal render`: a picture of a model.

use crate::exit::{Exit, say};
use crate::render_args::RenderArgs;

/// Says how to get a build that draws.
#[cfg(not(feature = "render"))]
pub fn run(_args: &RenderArgs) -> Exit {
    say(
        "this build draws no pictures; build one that does with `cargo build --release -p chordal-cli --features render`",
    );
    Exit::Nothing
}

#[cfg(feature = "render")]
pub fn run(args: &RenderArgs) -> Exit {
    drawing::run(args)
}

#[cfg(feature = "render")]
mod drawing {
    use super::{Exit, RenderArgs, say};
    use crate::render_args::{DeviceArg, ModeArg, NormalsArg, ProjectionArg, StyleArg, TrimArg};
    use chordal::gpu::{
        Background, DeviceChoice, Normals, Projection, RenderOptions, SectionPlane, Style, Trim, View,
    };
    use chordal::nurbs::DVec3;
    use chordal::{RenderJob, RenderMode, Rendered};

    pub fn run(args: &RenderArgs) -> Exit {
        let job = match job(args) {
            Ok(job) => job,
            Err(sentence) => {
                say(&sentence);
                return Exit::Nothing;
            }
        };
        match chordal::render(&job) {
            Ok(rendered) => {
                if !args.quiet {
                    tell(args, &rendered);
                }
                rendered.report.error_sentences().iter().for_each(|problem| say(problem));
                if rendered.report.clean { Exit::Clean } else { Exit::Undone }
            }
            Err(error) => {
                say(&error.to_string());
                Exit::Nothing
            }
        }
    }

    fn job(args: &RenderArgs) -> Result<RenderJob, String> {
        let of = |option: &str, reason: String| format!("--{option}: {reason}");
        let view: View = args.camera.parse().map_err(|e| of("camera", e))?;
        let background: Background = args.background.parse().map_err(|e| of("background", e))?;
        let section = args.section.as_deref().map(section).transpose().map_err(|e| of("section", e))?;
        let [width, height] = args.size.0;
        let picture = RenderOptions::default()
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
            .with_trim(match args.trim {
                TrimArg::Exact => Trim::Exact,
                TrimArg::Texture => Trim::Texture,
            })
            .with_normals(match args.normals {
                NormalsArg::Exact => Normals::Exact,
                NormalsArg::Interpolated => Normals::Interpolated,
            });
        Ok(RenderJob {
            input: args.input.clone(),
            output: args.output.clone(),
            mesh: chordal::JobOptions::default().with_tolerance(args.tolerance),
            picture,
            mode: match args.mode {
                ModeArg::Mesh => RenderMode::Mesh,
                ModeArg::Nurbs => RenderMode::Nurbs,
            },
            device: match args.device {
                DeviceArg::Best => DeviceChoice::Best,
                DeviceArg::Hardware => DeviceChoice::Hardware,
                DeviceArg::Software => DeviceChoice::Software,
            },
            cancel: Default::default(),
            on_progress: None,
        })
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

    fn tell(args: &RenderArgs, rendered: &Rendered) {
        let report = &rendered.report;
        let what = match rendered.evaluated {
            None => format!("{} triangles of {} faces", report.triangles, report.faces.total),
            Some(e) if e.meshed > 0 => {
                format!("{} points of {} faces ({} drawn as triangles)", e.points, e.drawn, e.meshed)
            }
            Some(e) => format!("{} points of {} faces", e.points, e.drawn),
        };
        say(&format!("{}: {what}, drawn by {}", args.output.display(), rendered.adapter));
        if let Some(legend) = rendered.legend {
            let what = match args.style {
                StyleArg::Curvature => "mean curvature, 1/mm",
                _ => "distance from the exact surface, mm",
            };
            say(&format!("colours from {:.3e} to {:.3e} ({what})", legend.low, legend.high));
        }
    }
}
