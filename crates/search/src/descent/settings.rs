//! The rules of a descent.

/// When a descent steps, and when it ends. Steps are in the unit of the unknowns (logarithms, parts of a
/// box), gains and costs in that of the cost, where nothing else is said.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Most trials, the first point not counted. Default 200.
    pub most_trials: usize,
    /// Damping of the first step, relative to the diagonal of `J^T J`. Default 1e-3: Nielsen 1999 for a start
    /// that is thought to be good.
    pub first_damping: f64,
    /// Least damping, likewise. Default 1e-14: a smaller one is lost in the rounding of the diagonal.
    pub least_damping: f64,
    /// Whether a good step lowers the damping according to the ratio of actual to predicted gain
    /// (Nielsen 1999), or always to a third. Default yes.
    pub damping_by_gain: bool,
    /// Damping above which a descent has stalled: no step is left that is short enough. Default 1e12: a step
    /// is then 1e-12 of that of steepest descent.
    pub most_damping: f64,
    /// Longest step of one unknown. Default 3, that is `e^3` for a logarithm: beyond it the quadratic model
    /// is not valid.
    pub longest_step: f64,
    /// Step below which the unknowns count as settled. Default 1e-9, a millionth of the accuracy that any log gives.
    pub settled_step: f64,
    /// Predicted gain per unit of step, as a part of the cost, below which the cost is flat. Default 1e-9.
    /// It distinguishes a settled descent from one whose steps are short because all longer ones failed.
    pub flat_slope: f64,
    /// Gain, as a part of the cost, below which a step has gained nothing. Default 1e-13: some hundred times
    /// the rounding of a sum of squares.
    pub no_gain: f64,
    /// Gain, as a part of the cost, that is small: [`small_gains`](Self::small_gains) of them in a row end the
    /// descent. Default 1e-9: along a valley that the data leave this flat, the unknowns move by a small part
    /// of their own uncertainty.
    pub small_gain: f64,
    /// How many small gains in a row end it. Default 5.
    pub small_gains: usize,
    /// Step below which the quadratic model is trusted: a trial within it for which no gain is
    /// predicted is not evaluated. Default 1e-3.
    pub trusted_step: f64,
    /// Predicted gain, as a part of the cost, that counts as none in such a step. Default 1e-13.
    pub trusted_gain: f64,
    /// Whether such a step is taken nevertheless, without evaluation: the last derivatives then belong to the
    /// point before it. Default no.
    pub take_untried: bool,
    /// Cost at or below which the fit is exact and what is left is rounding. Default 0.
    pub exact_cost: f64,
    /// Difference of two costs that may be rounding alone, where costs have lost digits. Default 0.
    pub cost_rounding: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            most_trials: 200,
            first_damping: 1e-3,
            least_damping: 1e-14,
            damping_by_gain: true,
            most_damping: 1e12,
            longest_step: 3.0,
            settled_step: 1e-9,
            flat_slope: 1e-9,
            no_gain: 1e-13,
            small_gain: 1e-9,
            small_gains: 5,
            trusted_step: 1e-3,
            trusted_gain: 1e-13,
            take_untried: false,
            exact_cost: 0.0,
            cost_rounding: 0.0,
        }
    }
}
