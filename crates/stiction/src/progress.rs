//! Who sees the progress of long work, and may stop it.

use std::ops::ControlFlow;
use stiction_identify::{Control, Observer, Stage};

/// The present state of running work.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Progress {
    /// What is being done.
    pub stage: Stage,
    /// Part of the stage that is done, 0 to 1; 0 where it is not known.
    pub fraction: f64,
    /// Evaluations of the model so far.
    pub evaluations: usize,
    /// Least rms(residual)/rms(measured) so far, 0 to 1; `None` before the first evaluation.
    pub relative_error: Option<f64>,
}

type Watch<'a> = Box<dyn FnMut(&Progress) -> ControlFlow<()> + Send + 'a>;

/// A closure that watches, or nobody.
#[derive(Default)]
pub(crate) struct Watched<'a>(Option<Watch<'a>>);

impl<'a> Watched<'a> {
    pub fn by(watch: impl FnMut(&Progress) -> ControlFlow<()> + Send + 'a) -> Self {
        Self(Some(Box::new(watch)))
    }
}

impl Observer for Watched<'_> {
    fn progress(&mut self, progress: &stiction_identify::Progress) -> Control {
        let Some(watch) = &mut self.0 else {
            return Control::Continue;
        };
        let seen = Progress {
            stage: progress.stage,
            fraction: progress.fraction,
            evaluations: progress.counts.total(),
            relative_error: Some(progress.best).filter(|best| best.is_finite()),
        };
        match watch(&seen) {
            ControlFlow::Continue(()) => Control::Continue,
            ControlFlow::Break(()) => Control::Stop,
        }
    }
}
