//! What is believed of an axis that was identified once.

use crate::candidate::{Back, Candidate};
use crate::limits::Limits;
use crate::prior::unit;
use stiction_friction::ParamError;

/// A first identification: values and how well they are known.
#[derive(Clone, Debug, PartialEq)]
pub struct Belief {
    /// The identified axis.
    pub axis: Candidate,
    /// Deviation of each parameter in its [unit](Candidate::units); `None` where the data did not determine it.
    pub deviations: Vec<Option<f64>>,
    /// Correlations of these deviations of the parameters of the law and the mass, by rows; empty where they count as independent.
    pub correlations: Vec<Vec<f64>>,
}

/// Deviations to either side that are thought possible.
const WIDE: f64 = 2.0;
/// Factors to either side: at least, since a first fit is rarely as good as it says, of what is not determined, and at most.
const LEAST: f64 = 1.3;
const OPEN: f64 = 3.0;
const MOST: f64 = 10.0;
/// Least part of the variance of a parameter that those before it do not determine.
const LEAST_OWN: f64 = 1e-6;
/// Least Fs/Fc - 1.
const LEAST_EXCESS: f64 = 0.02;

impl Belief {
    /// Refuses an axis that is none.
    pub fn validate(&self) -> Result<(), ParamError> {
        self.axis.validate()
    }

    /// Places of Coulomb and static friction of each direction among the parameters; none of Maxwell-slip elements.
    fn levels(&self) -> impl Iterator<Item = [usize; 2]> + use<> {
        let sides = if self.axis.back.is_some() { 2 } else { 1 };
        let own = if self.axis.slip.is_some() { 0 } else { sides };
        (0..own).map(move |side| [2 + sides + side, 2 + 2 * sides + side])
    }

    /// Fs/Fc - 1 of a direction.
    fn excess(&self, side: usize) -> f64 {
        let Back {
            static_friction,
            coulomb,
            ..
        } = self.axis.direction(side);
        static_friction / coulomb - 1.0
    }

    /// Place of Coulomb friction among the parameters of elements whose level falls: static friction is the sum of theirs, and drawn.
    pub fn coulomb_of_elements(&self) -> Option<usize> {
        let elements = self.axis.subject.elements.filter(|e| e.falls)?;
        Some(2 * elements.count + 1)
    }

    /// The shortest and the longest deflection at which an element may yield, m (rad); none without Maxwell-slip elements.
    pub fn yields(&self) -> Option<[f64; 2]> {
        let slip = self.axis.slip.as_ref()?;
        let factors = self.factors();
        let own = slip
            .elements
            .iter()
            .zip(factors.iter().skip(slip.elements.len()));
        let wide = own.map(|([_, deflection], by)| [deflection / by, deflection * by]);
        wide.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
    }

    /// How many times larger or smaller each parameter of the law may be; for static friction it is the factor of Fs/Fc - 1, as for the
    /// Coulomb friction of Maxwell-slip elements.
    pub fn factors(&self) -> Vec<f64> {
        let law = 0..self.axis.subject.first_term();
        let of_elements = self.coulomb_of_elements();
        let factor = |i: usize| {
            let own = self.levels().position(|[_, level]| level == i);
            let steeper = match own {
                None if of_elements == Some(i) => 1.0 + 1.0 / self.axis.excess(),
                None => 1.0,
                Some(side) => 1.0 + 1.0 / self.excess(side),
            };
            match self.deviations.get(i).copied().flatten() {
                Some(deviation) => libm::exp(WIDE * steeper * deviation).clamp(LEAST, MOST),
                None => OPEN,
            }
        };
        law.map(factor).collect()
    }

    /// The range of a term where it was determined, SI.
    pub fn range(&self, term: usize) -> Option<[f64; 2]> {
        let at = self.axis.subject.first_term() + term;
        let deviation = self.deviations.get(at).copied().flatten()?;
        let size = self.axis.sizes.get(term)?;
        let unit = self.axis.coulomb / self.axis.subject.terms.get(term)?.reach;
        // As rarely as good as it says.
        let wide = (WIDE * deviation * unit).max((LEAST - 1.0) * size.abs());
        Some([size - wide, size + wide])
    }

    /// The axis at a place in the unit cube; terms that were not determined are those that the nameplate allows.
    fn at(&self, limits: &Limits, unit: impl Fn(usize) -> f64) -> Candidate {
        let mut values = self.axis.values();
        let factors = self.factors();
        let draws = (0..factors.len()).map(|i| 2.0 * unit(i) - 1.0).collect();
        let draws = self.correlated(draws);
        let by: Vec<f64> = (factors.iter().zip(draws))
            .map(|(factor, draw)| libm::pow(*factor, draw))
            .collect();
        for (value, by) in values.iter_mut().zip(&by) {
            *value *= by;
        }
        if let (Some(at), Some(elements)) = (self.coulomb_of_elements(), self.axis.subject.elements)
        {
            let (stiffnesses, rest) = values.split_at(elements.count);
            let held: f64 = stiffnesses.iter().zip(rest).map(|(k, d)| k * d).sum();
            values[at] = held / (1.0 + (self.axis.excess() * by[at]).max(LEAST_EXCESS));
        }
        for (side, [coulomb, level]) in self.levels().enumerate() {
            let excess = (self.excess(side) * by[level]).max(LEAST_EXCESS);
            values[level] = values[coulomb] * (1.0 + excess);
        }
        let subject = &self.axis.subject;
        let Some(axis) = Candidate::of(subject, &values) else {
            return self.axis.clone();
        };
        let dressed = subject.dress(axis.clone(), limits, &unit);
        let sizes = dressed.sizes.iter().enumerate();
        let sizes = sizes.map(|(k, open)| match self.range(k) {
            Some([low, high]) => low + (high - low) * unit(by.len() + k),
            None => *open,
        });
        Candidate {
            sizes: sizes.collect(),
            ..axis
        }
    }

    /// Draws between -1 and 1 that go together as the first identification says.
    fn correlated(&self, draws: Vec<f64>) -> Vec<f64> {
        let n = draws.len();
        if self.correlations.len() != n {
            return draws;
        }
        let mut root = vec![vec![0.0; n]; n];
        for i in 0..n {
            for j in 0..=i {
                let before: f64 = (0..j).map(|k| root[i][k] * root[j][k]).sum();
                root[i][j] = if i == j {
                    // What rounding makes of a parameter that others determine.
                    libm::sqrt((1.0 - before).max(LEAST_OWN))
                } else {
                    (self.correlations[i][j] - before) / root[j][j]
                };
            }
        }
        let drawn = |i: usize| (0..=i).map(|k| root[i][k] * draws[k]).sum::<f64>();
        (0..n).map(|i| drawn(i).clamp(-1.0, 1.0)).collect()
    }

    /// `count` axes, spread evenly by a scrambled Sobol sequence; other seeds are other axes.
    pub fn draw(&self, limits: &Limits, count: usize, seed: u32) -> Vec<Candidate> {
        let one = |i: usize| self.at(limits, |d| unit(i, d, seed));
        (0..count).map(one).collect()
    }
}
