//! How much searching an experiment does.

/// How much searching is done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Budget {
    /// Generations of a round, of 50 individuals each.
    pub generations: usize,
    /// Rounds of the annealing search; the others have as many generations in one.
    pub rounds: usize,
    /// Searches with each method, in the static step, in the dynamic step and of all six at once.
    pub seeds: u64,
}

impl Default for Budget {
    /// 5 rounds of 100 generations, 30 seeds.
    fn default() -> Self {
        Budget {
            generations: 100,
            rounds: 5,
            seeds: 30,
        }
    }
}
