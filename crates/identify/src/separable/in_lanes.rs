//! LuGre and Dahl on the kernels of `stiction-lanes`.

use crate::conditioning::record::{self, Record};
use crate::law::prior::Beside;
use crate::law::terms::{ColumnKind, LinearTerm};
use crate::law::{Law, LawKind, Layout};
use crate::separable::recursion::Trace;
use crate::separable::reduced::{self, Products};
use std::borrow::Cow;
use std::sync::Arc;
use stiction_lanes::{
    Directed, InstructionSet, Segment, Sums, Time, Track, Trial, directed_levels, directed_slopes,
    levels, shared_sums, slopes, sums, sums_alone, trace,
};
use stiction_search::Derivatives;

/// A record as the kernels read it.
#[derive(Clone, Debug)]
pub(crate) struct InLanes {
    track: Arc<Track>,
    /// Samples of each segment.
    lengths: Vec<usize>,
    exponent: f64,
    unknowns: usize,
    /// Where the unknowns of a law with parameters for each direction stand; `None` for a symmetric law.
    directed: Option<Layout>,
    summed: Option<Summed>,
    prior: Beside,
}

/// What is needed to build the reduced problem from sums: only where neither a filter nor a delay lies
/// between the columns of the law and the regression.
#[derive(Clone, Debug)]
struct Summed {
    places: Vec<Place>,
    nonnegative: Vec<bool>,
    shared: Vec<Vec<f64>>,
}

/// Where a column of the regression stands in the sums.
#[derive(Clone, Copy, Debug)]
enum Place {
    /// Made by the trial.
    Own(usize),
    /// The same for all trials.
    Shared(usize),
}

/// Shared columns in the sums before the further ones: force and velocity.
const KNOWN: usize = 2;
const FORCE: Place = Place::Shared(0);

impl InLanes {
    /// Whether the kernels know this law.
    pub fn knows(law: &Law) -> bool {
        let layout = law.layout();
        matches!(law.kind, LawKind::Dahl | LawKind::LuGre) && layout.exponent.is_none()
    }

    /// The motion of a record, for [`traces`](Self::traces); `None` where the kernels do not know the law or
    /// refuse the record.
    pub fn motion(record: &Record, law: &Law) -> Option<Self> {
        let segments = record.segments.iter();
        let none: Vec<Cow<[f64]>> = segments
            .map(|s| vec![0.0; s.velocity.len()].into())
            .collect();
        Self::new(record, law, &none, &[])
    }

    /// A record whose columns pass no filter, for [`reduced`](Self::reduced) too: target and columns at the
    /// kept samples, one column for each linear term that the law does not make.
    pub fn regression(
        record: &Record,
        law: &Law,
        terms: &[LinearTerm],
        target: &[f64],
        columns: &[Option<&[f64]>],
    ) -> Option<Self> {
        let mut further = Vec::new();
        let mut places = Vec::with_capacity(terms.len());
        for (term, column) in terms.iter().zip(columns) {
            places.push(match (term.column, column) {
                (ColumnKind::Level, _) => Place::Own(0),
                (ColumnKind::Rate, _) => Place::Own(1),
                (ColumnKind::Speed(None), _) => Place::Shared(1),
                (_, Some(column)) => {
                    further.push(spread(record, column));
                    Place::Shared(KNOWN + further.len() - 1)
                }
                (_, None) => return None,
            });
        }
        let mut out = Self::new(record, law, &spread(record, target), &further)?;
        out.summed = Some(Summed {
            places,
            nonnegative: terms.iter().map(|term| term.is_never_negative()).collect(),
            shared: shared_sums(&out.track),
        });
        Some(out)
    }

    fn new(
        record: &Record,
        law: &Law,
        force: &[Cow<[f64]>],
        columns: &[Vec<Cow<[f64]>>],
    ) -> Option<Self> {
        if !Self::knows(law) {
            return None;
        }
        let layout = law.layout();
        let keep: Vec<Cow<[bool]>> = record.segments.iter().map(|s| kept(record, s)).collect();
        let columns: Vec<Vec<&[f64]>> = (0..record.segments.len())
            .map(|s| columns.iter().map(|c| &*c[s]).collect())
            .collect();
        let segments: Vec<Segment> = record
            .segments
            .iter()
            .enumerate()
            .map(|(i, s)| Segment {
                time: Time::Step(s.step),
                velocity: &s.velocity,
                force: &force[i],
                keep: &keep[i],
                columns: &columns[i],
            })
            .collect();
        Some(Self {
            track: Arc::new(Track::new(&segments).ok()?),
            lengths: record.segments.iter().map(|s| s.velocity.len()).collect(),
            exponent: law.exponent,
            unknowns: layout.count,
            directed: layout.ratio.is_some().then_some(layout),
            summed: None,
            prior: Beside::default(),
        })
    }

    /// The same with what is known of the law before the record.
    pub fn beside(mut self, prior: Beside) -> Self {
        self.prior = prior;
        self
    }

    /// Whether the reduced problem can be computed here.
    pub fn sums(&self) -> bool {
        self.summed.is_some()
    }

    fn trial(&self, p: &[f64]) -> Trial {
        let curve = self.unknowns == 3;
        Trial {
            ln_kappa: p[0],
            // Dahl: nothing above the Coulomb level.
            ln_excess: if curve { p[1] } else { -230.0 },
            ln_velocity: if curve { p[2] } else { 0.0 },
            exponent: if curve { self.exponent } else { 2.0 },
        }
    }

    /// The unknowns of a law with parameters for each direction.
    fn directed(&self, layout: &Layout, p: &[f64]) -> Directed {
        let read = |index: Option<usize>, otherwise: f64| index.map_or(otherwise, |i| p[i]);
        Directed {
            ln_kappa: read(layout.kappa, 0.0),
            ln_ratio: read(layout.ratio, 0.0),
            // Without a Stribeck curve there is nothing above the Coulomb level.
            ln_excess: layout.excess.map(|i| read(i, -230.0)),
            ln_velocity: layout.velocity.map(|i| read(i, 0.0)),
            exponent: if self.unknowns > 2 {
                self.exponent
            } else {
                2.0
            },
        }
    }

    /// The law along each segment; `None` for unknowns that the kernels refuse, and for the derivatives of a law with
    /// parameters for each direction, of which there are only [`slopes`](Self::slopes).
    pub fn traces(&self, p: &[f64], slopes: bool) -> Option<Vec<Trace>> {
        let set = InstructionSet::best();
        let mut whole = match &self.directed {
            Some(_) if slopes => return None,
            Some(layout) => {
                let found = directed_levels(&self.track, &self.directed(layout, p), set).ok()?;
                let [eta, rate] = found;
                Trace {
                    eta,
                    rate,
                    ..Trace::default()
                }
            }
            None => {
                let found = trace(&self.track, &self.trial(p), slopes, set).ok()?;
                let own = if slopes { self.unknowns } else { 0 };
                Trace {
                    eta: found.eta,
                    rate: found.rate,
                    eta_slope: found.eta_slope.into_iter().take(own).collect(),
                    rate_slope: found.rate_slope.into_iter().take(own).collect(),
                    elements: Vec::new(),
                }
            }
        };
        let mut out = Vec::with_capacity(self.lengths.len());
        // From the last segment on, so that the first, often the only one, is not copied.
        for (i, &n) in self.lengths.iter().enumerate().rev() {
            if i == 0 {
                out.push(std::mem::take(&mut whole));
            } else {
                out.push(whole.split_off(whole.eta.len() - n));
            }
        }
        out.reverse();
        Some(out)
    }

    /// The derivatives of `weights[0] eta + weights[1] rate` along each segment, one column for each unknown;
    /// `None` for unknowns that the kernels refuse.
    pub fn slopes(&self, p: &[f64], weights: [f64; 2]) -> Option<Vec<Vec<Vec<f64>>>> {
        let set = InstructionSet::best();
        let mut whole: Vec<Vec<f64>> = match &self.directed {
            Some(layout) => {
                let [plus, minus] = [0, 1].map(|side| [layout.excess[side], layout.velocity[side]]);
                let places = [
                    layout.kappa,
                    plus[0],
                    plus[1],
                    minus[0],
                    minus[1],
                    layout.ratio,
                ];
                let wanted = places.map(|place| place.is_some());
                let trial = self.directed(layout, p);
                let found = directed_slopes(&self.track, &trial, weights, wanted, set).ok()?;
                let mut whole = vec![Vec::new(); self.unknowns];
                for (place, column) in places.into_iter().zip(found) {
                    if let Some(i) = place {
                        whole[i] = column;
                    }
                }
                whole
            }
            None => {
                let found = slopes(&self.track, &self.trial(p), weights, set).ok()?;
                found.into_iter().take(self.unknowns).collect()
            }
        };
        let mut out = Vec::with_capacity(self.lengths.len());
        for (i, &n) in self.lengths.iter().enumerate().rev() {
            let last = |column: &mut Vec<f64>| match i {
                0 => std::mem::take(column),
                _ => column.split_off(column.len() - n),
            };
            out.push(whole.iter_mut().map(last).collect());
        }
        out.reverse();
        Some(out)
    }

    /// The reduced problem at a trial, samples in lanes; `None` for unknowns that the kernels refuse, or a
    /// record that was not made for it.
    pub fn reduced(&self, p: &[f64]) -> Option<Derivatives> {
        let summed = self.summed.as_ref()?;
        let found = sums_alone(&self.track, &self.trial(p), InstructionSet::best()).ok()?;
        Some(self.prior.add(p, summed.reduce(&found, self.unknowns)))
    }

    /// The reduced problem at many trials, trials in lanes. The same as [`reduced`](Self::reduced) up to
    /// rounding; the result of a trial does not depend, to the last bit, on the other trials.
    pub fn many(&self, trials: &[&[f64]]) -> Option<Vec<Derivatives>> {
        let summed = self.summed.as_ref()?;
        let each: Vec<Trial> = trials.iter().map(|p| self.trial(p)).collect();
        let found = sums(&self.track, &each, InstructionSet::best()).ok()?;
        let found = found.iter().zip(trials);
        let reduce =
            |(sums, p): (&Sums, &&[f64])| self.prior.add(p, summed.reduce(sums, self.unknowns));
        Some(found.map(reduce).collect())
    }

    /// The costs alone of many trials, in the same way.
    pub fn costs(&self, trials: &[&[f64]]) -> Option<Vec<f64>> {
        let summed = self.summed.as_ref()?;
        let each: Vec<Trial> = trials.iter().map(|p| self.trial(p)).collect();
        let found = levels(&self.track, &each, InstructionSet::best()).ok()?;
        let cost = |own| reduced::cost(&Made { summed, own }, &summed.nonnegative);
        let found = found.iter().zip(trials);
        Some(
            found
                .map(|(own, p)| cost(own) + self.prior.cost(p))
                .collect(),
        )
    }
}

impl Summed {
    fn reduce(&self, own: &Sums, unknowns: usize) -> Derivatives {
        let products = Made { summed: self, own };
        reduced::from_products(&products, &self.nonnegative, unknowns)
    }
}

/// The products of one trial.
struct Made<'a, const C: usize> {
    summed: &'a Summed,
    own: &'a Sums<C>,
}

impl<const C: usize> Made<'_, C> {
    fn product(&self, a: Place, b: Place) -> f64 {
        match (a, b) {
            (Place::Own(i), Place::Own(j)) => self.own.own[i][j],
            (Place::Own(i), Place::Shared(s)) | (Place::Shared(s), Place::Own(i)) => {
                self.own.shared[s][i]
            }
            (Place::Shared(s), Place::Shared(t)) => self.summed.shared[s][t],
        }
    }

    /// The derivative with respect to unknown `k` is made of those of eta and rate.
    fn slope(&self, k: usize, coefficients: &[f64]) -> [(f64, Place); 2] {
        let mut out = [(0.0, Place::Own(2 + k)), (0.0, Place::Own(5 + k))];
        for (place, c) in self.summed.places.iter().zip(coefficients) {
            if let Place::Own(i) = place {
                out[*i].0 += c;
            }
        }
        out
    }
}

impl<const C: usize> Products for Made<'_, C> {
    fn linear(&self, i: usize, j: usize) -> f64 {
        self.product(self.summed.places[i], self.summed.places[j])
    }

    fn target(&self, i: usize) -> f64 {
        self.product(self.summed.places[i], FORCE)
    }

    fn energy(&self) -> f64 {
        self.product(FORCE, FORCE)
    }

    fn slope_linear(&self, k: usize, i: usize, coefficients: &[f64]) -> f64 {
        let place = self.summed.places[i];
        let parts = self.slope(k, coefficients);
        parts.iter().map(|(c, s)| c * self.product(*s, place)).sum()
    }

    fn slope_target(&self, k: usize, coefficients: &[f64]) -> f64 {
        let parts = self.slope(k, coefficients);
        parts.iter().map(|(c, s)| c * self.product(*s, FORCE)).sum()
    }

    fn slopes(&self, k: usize, l: usize, coefficients: &[f64]) -> f64 {
        let (a, b) = (self.slope(k, coefficients), self.slope(l, coefficients));
        let pairs = a.iter().flat_map(|x| b.iter().map(move |y| (x, y)));
        pairs
            .map(|((c, s), (d, t))| c * d * self.product(*s, *t))
            .sum()
    }
}

/// Which samples of the full rate count; empty where all do.
fn kept<'s>(record: &Record, segment: &'s record::Segment) -> Cow<'s, [bool]> {
    if record.decimate == 1 {
        let whole = segment.counts_whole();
        return if whole { &[] } else { &segment.keep[..] }.into();
    }
    let mut out = vec![false; segment.velocity.len()];
    for (to, keep) in out.iter_mut().step_by(record.decimate).zip(&segment.keep) {
        *to = *keep;
    }
    out.into()
}

/// A column at the kept samples, put back to the full rate of each segment.
fn spread<'c>(record: &Record, column: &'c [f64]) -> Vec<Cow<'c, [f64]>> {
    if let [only] = &record.segments[..]
        && only.velocity.len() == column.len()
    {
        return vec![column.into()];
    }
    let mut values = column.iter();
    let each = record.segments.iter().map(|segment| {
        let mut out = vec![0.0; segment.velocity.len()];
        for (to, &keep) in out.iter_mut().step_by(record.decimate).zip(&segment.keep) {
            if keep {
                *to = values.next().copied().unwrap_or_default();
            }
        }
        out.into()
    });
    each.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conditioning::record::tests::of_velocities;
    use crate::law::terms::{Mass, Terms};
    use crate::separable::objective::Objective;

    /// Two stretches with samples left out and more linear terms than friction has.
    fn record() -> Record {
        let wave =
            |k: usize| 0.02 * libm::sin(7e-3 * k as f64) + 4e-3 * libm::cos(0.043 * k as f64);
        let velocity: Vec<f64> = (0..2500).map(wave).collect();
        let mut record = of_velocities(1e-3, &[&velocity[..900], &velocity[900..]]);
        for segment in &mut record.segments {
            for (i, &v) in segment.velocity.iter().enumerate() {
                segment.acceleration[i] = libm::sin(0.1 * i as f64);
                segment.force[i] = 19.0 * v.signum() + 55.0 * v + libm::sin(i as f64);
                segment.keep[i] = i % 7 != 3;
            }
        }
        record
    }

    fn near(found: &Derivatives, right: &Derivatives, energy: f64, what: &str) {
        assert!(
            (found.cost - right.cost).abs() < 1e-12 * energy,
            "{what}: cost"
        );
        let n = right.gradient.len();
        let size = |k: usize| right.normal[k * n + k].sqrt();
        for k in 0..n {
            let off = (found.gradient[k] - right.gradient[k]).abs();
            assert!(
                off < 1e-11 * size(k) * energy.sqrt(),
                "{what}: gradient {k}"
            );
            for l in 0..=k {
                let off = (found.normal[k * n + l] - right.normal[k * n + l]).abs();
                assert!(off < 1e-9 * size(k) * size(l), "{what}: normal {k} {l}");
            }
        }
    }

    /// The reduced problem from sums agrees with the one from columns.
    #[test]
    fn sums_lead_where_columns_do() {
        let record = record();
        let given = Terms {
            mass: Mass::Given(0.7),
            gravity: true,
            ..Terms::default()
        };
        for (kind, terms) in [
            (LawKind::LuGre, Terms::default()),
            (LawKind::LuGre, given),
            (LawKind::Dahl, Terms::default()),
        ] {
            let law = Law::new(kind);
            let free = Objective::new(&record, law, &terms);
            {
                let objective = &free;
                let points = [[7.0, -0.7, -5.0], [9.0, 0.3, -6.0], [6.0, -2.0, -4.2]];
                let points: Vec<&[f64]> = points.iter().map(|p| &p[..law.nonlinear()]).collect();
                let sums = objective.sums().unwrap();
                let many = sums.many(&points).unwrap();
                for (p, beside) in points.iter().zip(&many) {
                    let right = objective.evaluate(p, true).reduced();
                    let alone = sums.reduced(p).unwrap();
                    near(&alone, &right, objective.energy(), &format!("{kind} alone"));
                    near(
                        beside,
                        &right,
                        objective.energy(),
                        &format!("{kind} beside"),
                    );
                }
                let one = sums.many(&points[1..2]).unwrap();
                assert_eq!(one[0].cost.to_bits(), many[1].cost.to_bits());
                assert_eq!(one[0].normal, many[1].normal);
            }
        }
    }

    #[test]
    fn what_the_kernels_refuse_is_left_to_the_columns() {
        let record = record();
        let objective = Objective::new(&record, Law::new(LawKind::LuGre), &Terms::default());
        assert!(
            objective
                .sums()
                .unwrap()
                .reduced(&[300.0, 0.0, 0.0])
                .is_none()
        );
        assert!(!objective.evaluate(&[300.0, 0.0, 0.0], true).cost.is_nan());
        let fitted = Law {
            exponent_fitted: true,
            ..Law::new(LawKind::LuGre)
        };
        assert!(!InLanes::knows(&fitted));
        let mut broken = record.clone();
        broken.segments[1].velocity[3] = f64::NAN;
        assert!(InLanes::motion(&broken, &Law::new(LawKind::LuGre)).is_none());
    }
}
