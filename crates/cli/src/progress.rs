//! Progress on standard error, while that is a terminal.

use crate::interrupt;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;
use std::mem::discriminant;
use stiction::commands::number::Percent;
use stiction::{Control, Observer, Progress, Stage};

/// Shows a bar with the best cost so far, and passes the user's interrupt on.
pub struct Bar {
    bar: ProgressBar,
    stage: Option<Stage>,
}

impl Bar {
    /// A bar, hidden where standard error is no terminal or the user wants none.
    pub fn new(hidden: bool) -> Self {
        Self {
            bar: bar(1000, hidden),
            stage: None,
        }
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

/// A bar, hidden where standard error is no terminal or the user wants none.
fn bar(length: u64, hidden: bool) -> ProgressBar {
    let bar = ProgressBar::new(length);
    if hidden || !std::io::stderr().is_terminal() {
        bar.set_draw_target(ProgressDrawTarget::hidden());
    }
    if let Ok(style) =
        ProgressStyle::with_template("{prefix:>18} {wide_bar} {percent:>3} %  {msg}  left {eta}")
    {
        bar.set_style(style);
    }
    bar
}

impl Observer for Bar {
    fn progress(&mut self, progress: &Progress) -> Control {
        let same = |stage: &Stage| discriminant(stage) == discriminant(&progress.stage);
        if !self.stage.as_ref().is_some_and(same) {
            self.stage = Some(progress.stage);
            self.bar.reset();
            self.bar.set_prefix(match progress.stage {
                Stage::Tuning => "choosing cut-offs",
                Stage::Calibration => "measuring the bias",
                Stage::Search => "searching",
                Stage::Scan => "scanning the box",
                Stage::Coarse => "first descents",
                Stage::Fine | Stage::Finish => "least squares",
                Stage::CrossValidation => "comparing laws",
                Stage::Experiments { .. } => "simulating",
            });
        }
        self.bar.set_position((1000.0 * progress.fraction) as u64);
        if let Stage::Experiments { done, all } = progress.stage {
            self.bar.set_message(format!("{done} of {all}"));
        }
        if progress.best.is_finite() {
            self.bar.set_message(format!(
                "error {}",
                Percent::error(100.0 * progress.best).decimals(3)
            ));
        }
        if interrupt::asked() {
            Control::Stop
        } else {
            Control::Continue
        }
    }
}
