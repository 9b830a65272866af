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
    /// Least damping, likewise. Default 1e-14: less is lost in the rounding of the diagonal.
    pub least_damping: f64,
    /// Whether a good step lowers the damping by how much of its promise it kept (Nielsen 1999), or always to a
    /// third. Default yes.
    pub damping_by_gain: bool,
    /// Damping above which a descent has stalled: no step is left that is short enough. Default 1e12: a step
    /// is then 1e-12 of that of steepest descent.
    pub most_damping: f64,
    /// Longest step of one unknown. Default 3, that is `e^3` for a logarithm: further off the quadratic model
    /// means nothing.
    pub longest_step: f64,
    /// Step below which the unknowns are settled. Default 1e-9, a millionth of what any log determines.
    pub settled_step: f64,
    /// Gain for a step of 1 below which the cost is flat, as a part of it. Default 1e-9. It tells a settled
    /// descent from one whose steps are short because all longer ones failed.
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
    /// Step within which the quadratic model is believed: a trial there that it promises no gain is not
    /// made. Default 1e-3.
    pub trusted_step: f64,
    /// What counts as no gain then, as a part of the cost. Default 1e-13.
    pub trusted_gain: f64,
    /// Whether such a step is taken all the same, without a trial: the derivatives last seen then belong to the
    /// point before. Default no.
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
