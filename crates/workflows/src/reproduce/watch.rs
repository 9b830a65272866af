//! How far the work is, and the user's wish to stop.

use stiction_search::{Observer, Shared};

/// Counts what is done, and knows whether to stop.
pub(super) struct Watch<'a>(Shared<'a>);

impl<'a> Watch<'a> {
    pub fn new(all: usize, observer: &'a mut dyn Observer) -> Self {
        Watch(Shared::new(observer, all))
    }

    /// Whether the user wants it to stop.
    pub fn stopped(&self) -> bool {
        !self.0.go_on()
    }

    /// Counts one more step as done.
    pub fn add(&self) {
        self.0.one_more();
    }
}
