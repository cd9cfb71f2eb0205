//! Progress on standard error, where that is a terminal.

use chordal::{OnProgress, Progress};
use indicatif::{ProgressBar, ProgressStyle};
use std::sync::Arc;
use std::time::Duration;

/// A bar that follows one job; it draws nothing unless standard error is a terminal.
#[derive(Debug)]
pub struct Bar(ProgressBar);

impl Bar {
    pub fn new(name: &str, quiet: bool) -> Self {
        if quiet {
            return Self(ProgressBar::hidden());
        }
        let bar = ProgressBar::new(0);
        let style = ProgressStyle::with_template("{prefix} {msg:10} {wide_bar} {pos}/{len} faces {elapsed}")
            .unwrap_or_else(|_| ProgressStyle::default_bar());
        bar.set_style(style);
        bar.set_prefix(name.to_owned());
        bar.enable_steady_tick(Duration::from_millis(200));
        Self(bar)
    }

    /// What a job calls.
    pub fn listener(&self) -> OnProgress {
        let bar = self.0.clone();
        Arc::new(move |progress| match progress {
            Progress::Reading => bar.set_message("reading"),
            Progress::Sewing => bar.set_message("sewing"),
            Progress::Measuring => bar.set_message("measuring"),
            Progress::Meshing { done, faces } => {
                bar.set_message("meshing");
                bar.set_length(faces as u64);
                bar.set_position(done as u64);
            }
            Progress::Auditing => bar.set_message("auditing"),
            Progress::Writing => bar.set_message("writing"),
            _ => (),
        })
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}
