//! How well a law with some number of Maxwell-slip elements fits and predicts.

/// One number of elements that was tried.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElementsScore {
    /// How many elements.
    pub elements: usize,
    /// `100 rms(residual) / rms(measured)` where it was fitted.
    pub fitted_error_percent: f64,
    /// The same over blocks of the record, each left out of the fit in turn; `None` where there are
    /// too few samples or the search was stopped.
    pub held_out_error_percent: Option<f64>,
}
