//! Parts of the samples that a fit sees, each to be left out in its turn.

use crate::conditioning::record::Record;
use stiction_policy::conditioning;

/// Stretches of a fold: so many that each of them holds every kind of motion of a log (rests, slow reversals,
/// strokes) that lasts a tenth of it.
const STRETCHES: usize = 16;
/// Fewest kept samples of a stretch. The common filter correlates two or three of them.
const SHORTEST_STRETCH: usize = 24;

/// Which fold each kept sample belongs to.
#[derive(Clone, Debug)]
pub(crate) struct Folds {
    /// In the order of the kept samples.
    pub of: Vec<usize>,
    pub count: usize,
}

impl Folds {
    /// Deals the stretches of a record out to `count` folds, at least 1.
    ///
    /// The folds are dealt in turn, and each round begins with the next fold, so that one does not meet a periodic
    /// motion always at the same place.
    pub fn of(record: &Record, count: usize) -> Self {
        let count = count.max(1);
        let kept = record.kept();
        let rounds = STRETCHES.min(kept / (SHORTEST_STRETCH * count)).max(1);
        let stretches = rounds * count;
        let fold = |k: usize| {
            let stretch = k * stretches / kept.max(1);
            (stretch + stretch / count) % count
        };
        Self {
            of: (0..kept).map(fold).collect(),
            count,
        }
    }

    /// Whether what is left without a fold is enough for a fit of so many unknowns.
    pub fn leave_enough(&self, unknowns: usize) -> bool {
        let kept = self.of.len();
        self.count > 1 && kept - kept / self.count >= conditioning::SAMPLES_PER_UNKNOWN * unknowns
    }

    /// The record with only those samples of the regression that are (`inside`) or are not in a fold.
    pub fn masked(&self, record: &Record, fold: usize, inside: bool) -> Record {
        let mut folds = self.of.iter();
        let mut out = record.clone();
        for keep in out.segments.iter_mut().flat_map(|s| &mut s.keep) {
            if *keep {
                *keep = (folds.next() == Some(&fold)) == inside;
            }
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conditioning::record::tests::of_velocities;

    /// A phase of an eighth of the log lies in every fold, and so does every phase of a motion with the period of four
    /// stretches.
    #[test]
    fn every_fold_holds_every_part_of_a_log() {
        let record = of_velocities(1e-3, &[&[0.0; 6400]]);
        let folds = Folds::of(&record, 4);
        for phase in folds.of.chunks(800) {
            for fold in 0..4 {
                let many = phase.iter().filter(|f| **f == fold).count();
                assert!((100..=300).contains(&many), "fold {fold}: {many}");
            }
        }
        for phase in 0..4 {
            let here = |k: &usize| k / 100 % 4 == phase;
            let seen: Vec<usize> = (0..6400).filter(here).map(|k| folds.of[k]).collect();
            assert!((0..4).all(|fold| seen.contains(&fold)));
        }
    }

    #[test]
    fn a_mask_and_its_rest_are_the_record() {
        let mut record = of_velocities(1e-3, &[&[0.0; 500], &[0.0; 300]]);
        record.segments[0].keep[100..200].fill(false);
        let folds = Folds::of(&record, 3);
        let kept = |inside| folds.masked(&record, 1, inside).kept();
        assert_eq!(kept(true), folds.of.iter().filter(|f| **f == 1).count());
        assert_eq!(kept(true) + kept(false), 700);
        assert_eq!(Folds::of(&record, 0).count, 1);
    }
}
