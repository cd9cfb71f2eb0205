//! Progress on standard error, where that is a terminal.

use chordal::Phase;
use indicatif::{ProgressBar, ProgressStyle};
use std::ops::ControlFlow;
use std::time::Duration;

/// Steps of the bar.
const STEPS: u64 = 1000;

/// A bar that follows one run; it draws nothing unless standard error is a terminal.
#[derive(Debug)]
pub struct Bar(ProgressBar);

impl Bar {
    /// A bar with the name of the input.
    pub fn new(name: &str, quiet: bool) -> Self {
        if quiet {
            return Self(ProgressBar::hidden());
        }
        let bar = ProgressBar::new(STEPS);
        let style = ProgressStyle::with_template("{prefix} {msg:10} {wide_bar} {percent:>3} % {elapsed}")
            .unwrap_or_else(|_| ProgressStyle::default_bar());
        bar.set_style(style);
        bar.set_prefix(name.to_owned());
        bar.enable_steady_tick(Duration::from_millis(200));
        Self(bar)
    }

    /// Shows what is done at the moment.
    pub fn phase(&self, what: &'static str) {
        self.0.set_message(what);
    }

    /// The callback for a mesher.
    pub fn listener(&self) -> impl Fn(Phase, f64) -> ControlFlow<()> + Send + Sync + 'static {
        let bar = self.0.clone();
        move |phase, fraction| {
            bar.set_message(match phase {
                Phase::Sewing => "sewing",
                Phase::Measuring => "measuring",
                Phase::Meshing => "meshing",
                Phase::Auditing => "auditing",
                _ => "",
            });
            if phase == Phase::Meshing {
                bar.set_position((fraction * STEPS as f64) as u64);
            }
            ControlFlow::Continue(())
        }
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}
