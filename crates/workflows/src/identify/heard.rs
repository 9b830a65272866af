//! An observer that remembers whether it has asked to stop: steps that only make a result better are then left out.

use stiction_identify::{Control, Observer, Progress};

pub(super) struct Heard<'o> {
    observer: &'o mut dyn Observer,
    pub stopped: bool,
}

impl<'o> Heard<'o> {
    pub fn new(observer: &'o mut dyn Observer) -> Self {
        Self {
            observer,
            stopped: false,
        }
    }
}

impl Observer for Heard<'_> {
    fn progress(&mut self, progress: &Progress) -> Control {
        let control = self.observer.progress(progress);
        self.stopped |= control == Control::Stop;
        control
    }
}
