//! What is simulated: stretches of the logs on an even grid.

use crate::conditioning::grid::Grid;
use crate::conditioning::losses::Losses;
use crate::conditioning::record::Samples;
use crate::conditioning::{median_step, stretches};
use crate::error::Error;
use crate::output_error::controller::{Controller, Wanted};

/// How the logged force relates in time to the instants of the samples.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Hold {
    /// The force of a sample holds from its instant to the next, as a drive logs its command.
    #[default]
    Held,
    /// The force of a sample is the mean around its instant, as a sensor or a filtered current shows
    /// it.
    Centred,
}

/// One log to simulate: its samples, and the reference where a controller follows one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recording {
    /// Time, position, force and what is to be left out. The velocity is not used.
    pub samples: Samples,
    /// Position that was asked for, m or rad, one number a sample.
    pub reference: Option<Vec<f64>>,
}

/// A stretch that is simulated from one free initial state.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Run {
    /// Which log it comes from, counted from 0.
    pub log: usize,
    /// Which stretch without a gap it is a piece of, counted from 0 over all logs.
    pub stretch: usize,
    /// Sample time, s.
    pub step: f64,
    pub time: Vec<f64>,
    pub position: Vec<f64>,
    /// The force that drives the axis: in closed loop that of the controller alone, in open loop all that acts.
    pub force: Vec<f64>,
    /// What acts beside the controller in closed loop; empty for nothing.
    pub external: Vec<f64>,
    /// What the controller is asked for, at every control instant; empty in open loop.
    pub wanted: Vec<Wanted>,
    /// Which samples count.
    pub keep: Vec<bool>,
}

/// Most samples that are simulated: with a thousand passes that is about ten minutes.
const MOST_SAMPLES: usize = 2_000_000;
/// Most stretches: each has unknowns of its own.
const MOST_RUNS: usize = 20_000;
/// Fewest samples of a stretch.
const FEWEST_SAMPLES: usize = 10;

/// Why samples of recordings are in no run, given how many samples the runs hold and keep.
pub(crate) fn losses(recordings: &[Recording], held: usize, kept: usize) -> Losses {
    let logged = recordings.iter().map(|r| r.samples.time.len()).sum();
    Losses {
        logged,
        short: logged.saturating_sub(held),
        excluded: held - kept,
        ..Losses::default()
    }
}

/// Cuts recordings into runs, of at most `segment` seconds in open loop.
pub(crate) fn runs(
    recordings: &[Recording],
    controller: Option<&Controller>,
    segment: Option<f64>,
) -> Result<Vec<Run>, Error> {
    let mut out = Vec::new();
    let mut total = 0;
    let mut stretch = 0;
    for (log, recording) in recordings.iter().enumerate() {
        let samples = &recording.samples;
        crate::conditioning::check(log + 1, samples)?;
        let Some(position) = &samples.position else {
            return Err(Error::NotSimulated {
                log: log + 1,
                found: "no position",
                allowed: "a position to compare the simulated one with",
            });
        };
        let reference = match (controller, &recording.reference) {
            (None, _) => None,
            (Some(_), Some(reference)) if reference.len() == samples.time.len() => Some(reference),
            (Some(_), Some(reference)) => {
                return Err(Error::Length {
                    log: log + 1,
                    channel: "reference",
                    found: reference.len(),
                    expected: samples.time.len(),
                });
            }
            (Some(_), None) => {
                return Err(Error::NotSimulated {
                    log: log + 1,
                    found: "a controller is given and no reference",
                    allowed: "the reference that the controller followed",
                });
            }
        };
        if let Some(index) = reference.and_then(|r| r.iter().position(|x| !x.is_finite())) {
            return Err(Error::NotFinite {
                log: log + 1,
                channel: "reference",
                index: index + 1,
            });
        }
        total += samples.time.len();
        if total > MOST_SAMPLES {
            return Err(Error::Setting {
                name: "samples",
                found: total as f64,
                allowed: "at most 2000000 in all can be simulated; crop the log",
            });
        }
        let step = median_step(&samples.time);
        let periods = controller.map_or(Ok(1), |c| c.periods(step))?;
        let least = FEWEST_SAMPLES as f64 * step;
        if let Some(found) = segment.filter(|s| *s < least) {
            return Err(Error::Setting {
                name: "segment",
                found,
                allowed: "a time of at least ten samples, s",
            });
        }
        for range in stretches(samples, step) {
            let Some(grid) = Grid::new(&samples.time[range.clone()], step) else {
                continue;
            };
            let valid = match samples.valid.get(range.clone()) {
                Some(valid) => valid,
                None => &[],
            };
            stretch += 1;
            let mut force = grid.resample(&samples.force[range.clone()]);
            let beside = samples.external.as_ref().filter(|_| controller.is_some());
            let external = beside.map_or(Vec::new(), |x| grid.resample(&x[range.clone()]));
            for (force, external) in force.iter_mut().zip(&external) {
                *force -= external;
            }
            let whole = Run {
                log,
                stretch: stretch - 1,
                step,
                time: grid.times(),
                position: grid.resample(&position[range.clone()]),
                force,
                external,
                wanted: reference.map_or(Vec::new(), |r| {
                    wanted(&grid.resample(&r[range.clone()]), step, periods)
                }),
                keep: grid.keep(valid),
            };
            let length = match (controller, segment) {
                // The controller keeps the axis on its reference, so long runs do not drift; and its
                // memory must not be cut.
                (Some(_), _) | (_, None) => whole.time.len(),
                (None, Some(s)) => whole.samples_in(s),
            };
            out.extend(whole.cut(length));
            if out.len() > MOST_RUNS {
                return Err(Error::Setting {
                    name: "segments",
                    found: out.len() as f64,
                    allowed: "at most 20000; make them longer",
                });
            }
        }
    }
    out.retain(|run| run.keep.iter().filter(|&&k| k).count() >= FEWEST_SAMPLES);
    Ok(out)
}

/// How many stretches without a gap the runs are pieces of.
pub(crate) fn stretches_of(runs: &[Run]) -> usize {
    let begins = |i: &usize| *i == 0 || runs[*i].stretch != runs[i - 1].stretch;
    (0..runs.len()).filter(begins).count()
}

/// Positions less the mean of their stretch, squared and summed: the motion that a simulation is to explain, wherever the
/// origin of the encoder is and however the stretches are cut.
pub(crate) fn motion(runs: &[Run]) -> f64 {
    let mut sum = 0.0;
    for pieces in runs.chunk_by(|a, b| a.stretch == b.stretch) {
        let kept = || {
            pieces
                .iter()
                .flat_map(|run| run.position.iter().zip(&run.keep))
                .filter_map(|(x, keep)| keep.then_some(*x))
        };
        let mean = kept().sum::<f64>() / kept().count().max(1) as f64;
        sum += kept().map(|x| (x - mean) * (x - mean)).sum::<f64>();
    }
    sum
}

/// Reference with its central differences at every control instant.
fn wanted(reference: &[f64], step: f64, periods: usize) -> Vec<Wanted> {
    let n = reference.len();
    let last = n.saturating_sub(1);
    let at = |k: usize| Wanted {
        position: reference[k],
        velocity: (reference[(k + 1).min(last)] - reference[k.saturating_sub(1)])
            / (step * ((k + 1).min(last) - k.saturating_sub(1)).max(1) as f64),
        acceleration: if k == 0 || k == last {
            0.0
        } else {
            (reference[k + 1] - 2.0 * reference[k] + reference[k - 1]) / (step * step)
        },
    };
    let mut out = Vec::with_capacity(n.saturating_mul(periods));
    for k in 0..n {
        let (a, b) = (at(k), at((k + 1).min(last)));
        for i in 0..periods {
            let part = i as f64 / periods as f64;
            let mix = |a: f64, b: f64| a + part * (b - a);
            out.push(Wanted {
                position: mix(a.position, b.position),
                velocity: mix(a.velocity, b.velocity),
                acceleration: mix(a.acceleration, b.acceleration),
            });
        }
    }
    out
}

impl Run {
    /// Samples of a piece of so many seconds.
    pub fn samples_in(&self, seconds: f64) -> usize {
        (seconds / self.step).clamp(FEWEST_SAMPLES as f64, 1e9) as usize
    }

    /// Pieces of `length` samples; a short rest stays with the last piece.
    pub fn cut(self, length: usize) -> Vec<Run> {
        let n = self.time.len();
        if n < 2 * length {
            return vec![self];
        }
        let pieces = n / length;
        (0..pieces)
            .map(|i| {
                let end = if i + 1 == pieces { n } else { (i + 1) * length };
                let range = i * length..end;
                Run {
                    log: self.log,
                    stretch: self.stretch,
                    step: self.step,
                    time: self.time[range.clone()].to_vec(),
                    position: self.position[range.clone()].to_vec(),
                    force: self.force[range.clone()].to_vec(),
                    external: Vec::new(),
                    wanted: Vec::new(),
                    keep: self.keep[range].to_vec(),
                }
            })
            .collect()
    }

    /// Velocity at the start, from a line through the first samples.
    pub fn first_velocity(&self) -> f64 {
        let n = self.position.len().min(FEWEST_SAMPLES);
        let mean = 0.5 * (n as f64 - 1.0);
        let (mut above, mut below) = (0.0, 0.0);
        for (i, x) in self.position.iter().take(n).enumerate() {
            let t = i as f64 - mean;
            above += t * x;
            below += t * t;
        }
        if below > 0.0 {
            above / (below * self.step)
        } else {
            0.0
        }
    }
}
