//! From a log to the data of a fit: uniform time, velocity and acceleration, one common filter.
//!
//! Why two filters: differentiating a quantised position needs a low-pass on the position alone, and
//! whatever that leaves is removed by a second low-pass that the force *and every regressor* pass
//! alike, so it cannot bias the fit (identification of robots: Gautier 1997,
//! doi 10.1109/ROBOT.1997.606767). Both are zero-phase, so nothing is delayed.

pub(crate) mod accelerometer;
pub(crate) mod blocks;
pub(crate) mod channels;
pub(crate) mod grid;
pub(crate) mod losses;
pub(crate) mod record;
pub(crate) mod settling;
pub(crate) mod shift;

use crate::conditioning::channels::Channels;
use crate::conditioning::grid::Grid;
use crate::conditioning::losses::Losses;
use crate::conditioning::record::{Record, Samples, Segment};
use crate::error::{Error, full};
use stiction_policy::conditioning;
use stiction_signal::{
    Reading, Sos, Thinning, gradient, gradient_sixth_order, noise_deviation, timing_noise,
};

/// Order of both low-pass filters.
const ORDER: usize = 4;

/// Which channel gives the motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// Velocity and acceleration are derivatives of the position.
    Position,
    /// The logged velocity drives the law; the acceleration is its derivative.
    Velocity,
}

/// A low-pass cut-off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cutoff {
    /// Chosen from the sample rate: a tenth of it on a position, a twentieth in common; none where
    /// a velocity is the source.
    Auto,
    /// No filter.
    Off,
    /// This frequency, Hz.
    Hz(f64),
}

/// How a log is conditioned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conditioning {
    /// Channel that gives the motion; `None` takes the position where there is one.
    pub source: Option<Source>,
    /// Low-pass on the source alone, before differentiation.
    pub source_cutoff: Cutoff,
    /// Low-pass on the force and every regressor.
    pub common_cutoff: Cutoff,
    /// Whether the force passed this low-pass before it was logged, so that only the regressors have to.
    pub force_is_filtered: bool,
    /// The regression uses every n-th sample; `None` follows from the common cut-off.
    pub decimate: Option<usize>,
    /// Smallest displacement that the log resolves, m or rad.
    pub resolution: Option<f64>,
    /// Only samples at least this fast count, m/s or rad/s; 0 for all. A static law does not define
    /// friction at rest, and an encoder may not resolve the bristle deflection there.
    pub min_speed: f64,
    /// Distance that the axis must have slid since the start of a log or the end of a gap before its samples count, m or
    /// rad: until then the force depends on how far the bristles were deflected there. 0 counts them all, as if bristles
    /// began undeflected. [`tune`](crate::tune()) finds it.
    pub settling: f64,
}

impl Default for Conditioning {
    fn default() -> Self {
        Self {
            source: None,
            source_cutoff: Cutoff::Auto,
            common_cutoff: Cutoff::Auto,
            force_is_filtered: false,
            decimate: None,
            resolution: None,
            min_speed: 0.0,
            settling: 0.0,
        }
    }
}

/// Conditions logs of one axis for a fit. All must have (nearly) the same sample rate.
pub fn condition(logs: &[Samples], conditioning: &Conditioning) -> Result<Record, Error> {
    let mut record = condition_as(logs, conditioning, 0.0)?;
    let positions = logs.iter().filter_map(|log| log.position.as_deref());
    record.position_noise = noise_deviation(positions.clone());
    let step = conditioning.resolution.unwrap_or(0.0);
    if let Some(timing) = timing_noise(positions, step) {
        record.position_noise = timing.beside;
        record.timing_noise = timing.samples * record.step();
    }
    Ok(record)
}

/// The same where the noise of the position is known, m or rad.
pub(crate) fn condition_as(
    logs: &[Samples],
    conditioning: &Conditioning,
    position_noise: f64,
) -> Result<Record, Error> {
    for (i, log) in logs.iter().enumerate() {
        check(i + 1, log)?;
    }
    let settings = [
        ("min_speed", Some(conditioning.min_speed)),
        ("resolution", conditioning.resolution),
        ("settling", Some(conditioning.settling)),
    ];
    for (name, found) in settings {
        if let Some(found) = found.filter(|x| !(*x >= 0.0 && x.is_finite())) {
            let allowed = "a finite number, not negative";
            return Err(Error::Setting {
                name,
                found,
                allowed,
            });
        }
    }
    let step = logs
        .iter()
        .map(|log| median_step(&log.time))
        .fold(0.0_f64, f64::max);
    let rate = 1.0 / step;
    let source = match conditioning.source {
        Some(source) => source,
        None if logs.iter().all(|log| log.position.is_some()) => Source::Position,
        None => Source::Velocity,
    };
    for (i, log) in logs.iter().enumerate() {
        let (channel, missing) = match source {
            Source::Position => ("position", log.position.is_none()),
            Source::Velocity => ("velocity", log.velocity.is_none()),
        };
        if missing {
            return Err(Error::MissingChannel {
                log: i + 1,
                channel,
                term: match conditioning.source {
                    Some(Source::Position) => "source = \"position\" in [conditioning]",
                    Some(Source::Velocity) => "source = \"velocity\" in [conditioning]",
                    None => "a fit together with a log that has no position",
                },
            });
        }
    }
    let from_position = source == Source::Position;
    let mut notes = vec![match source {
        Source::Position => "velocity and acceleration: central differences of the position".into(),
        Source::Velocity => "velocity as logged, acceleration: its central differences".to_string(),
    }];
    let hertz = |cutoff, auto: f64| match cutoff {
        Cutoff::Auto => from_position.then_some(auto),
        Cutoff::Off => None,
        Cutoff::Hz(f) => Some(f),
    };
    let source_hz = hertz(conditioning.source_cutoff, rate / 10.0);
    let common_hz = hertz(conditioning.common_cutoff, rate / 20.0);
    let source_filter = low_pass("source_cutoff", source_hz, rate)?;
    let common = low_pass("common_cutoff", common_hz, rate)?;
    let what = if from_position {
        "position"
    } else {
        "velocity"
    };
    if let Some(f) = source_hz {
        notes.push(format!(
            "{what}: zero-phase Butterworth low-pass, order {ORDER}, {} Hz",
            cutoff(f)
        ));
    }
    let decimate = match (conditioning.decimate, common_hz) {
        (Some(0), _) => {
            return Err(Error::Setting {
                name: "decimate",
                found: 0.0,
                allowed: "a whole number from 1",
            });
        }
        (Some(n), _) => n,
        // Just above twice the cut-off: a lower rate would alias, a higher one would add no information.
        (None, Some(f)) => ((rate / (2.5 * f)) as usize).max(1),
        (None, None) => 1,
    };
    if let Some(f) = common_hz {
        let what = match conditioning.force_is_filtered {
            true => "every regressor, as the force before it was logged: a",
            false => "force and every regressor: the same",
        };
        notes.push(format!(
            "{what} zero-phase Butterworth low-pass, order {ORDER}, {} Hz, then one sample in {decimate}",
            cutoff(f)
        ));
    }
    let trim = [&source_filter, &common]
        .into_iter()
        .flatten()
        .map(|filter| filter.settling_samples())
        .max()
        .unwrap_or(0);
    if trim > 0 {
        notes.push(format!(
            "{trim} samples at each end dropped (filters settling)"
        ));
    }
    if conditioning.min_speed > 0.0 {
        notes.push(format!(
            "only samples faster than {} m/s or rad/s count",
            full(conditioning.min_speed)
        ));
    }
    let longest = logs.iter().map(|log| log.time.len()).max().unwrap_or(0);
    let filters = Filters {
        source: source_filter,
        thinning: thinning(common.as_ref(), decimate, longest),
        common,
        force_is_filtered: conditioning.force_is_filtered,
        trim,
        decimate,
        reach: common_hz.map_or(0, |f| (0.5 * rate / f) as usize),
        source_kind: source,
        min_speed: conditioning.min_speed,
    };
    let mut segments = Vec::new();
    let mut short = 0;
    let mut losses = Losses {
        logged: logs.iter().map(|log| log.time.len()).sum(),
        decimate,
        ..Losses::default()
    };
    for (i, log) in logs.iter().enumerate() {
        for stretch in stretches(log, step) {
            match filters.segment(i, log, stretch.clone(), step, &mut losses) {
                Some(segment) => segments.push(segment),
                None => {
                    short += 1;
                    losses.short += stretch.len();
                }
            }
        }
    }
    losses.unsettled = settling::settle(&mut segments, decimate, conditioning.settling);
    if losses.unsettled > 0 {
        notes.push(format!(
            "{} s not fitted at the start and after gaps: until the axis has slid {} m or rad, the force depends on what was before",
            cutoff((losses.unsettled * decimate) as f64 * step),
            cutoff(conditioning.settling)
        ));
    }
    if segments.is_empty() {
        let needed = filters.least();
        return Err(Error::TooFewSamples {
            found: 0,
            needed,
            losses,
        });
    }
    if short > 0 {
        notes.push(format!(
            "{short} stretches between gaps were too short to filter and left out"
        ));
    }
    // The chosen cut-offs are written in as numbers, so that conditioning again gives the same filters.
    let fixed = |hz: Option<f64>| hz.map_or(Cutoff::Off, Cutoff::Hz);
    let again = Conditioning {
        source: Some(source),
        source_cutoff: fixed(source_hz),
        common_cutoff: fixed(common_hz),
        force_is_filtered: conditioning.force_is_filtered,
        decimate: Some(decimate),
        resolution: conditioning.resolution,
        min_speed: 0.0,
        settling: conditioning.settling,
    };
    Ok(Record {
        segments,
        common: filters.common,
        force_is_filtered: filters.force_is_filtered,
        decimate,
        position_noise,
        timing_noise: 0.0,
        common_hz,
        notes,
        resolution: conditioning.resolution,
        conditioning: from_position.then_some(again),
        losses,
        is_thinned: false,
    })
}

/// Number of samples from one that counts to the next from which on the common filter is computed for those alone: below,
/// the filter over all of them takes no longer.
const LEAST_THINNED: usize = 3;

/// The common filter, where it is worth computing at the thinned samples of a stretch of this length alone.
pub(crate) fn thinning(common: Option<&Sos>, decimate: usize, length: usize) -> Option<Thinning> {
    if !(LEAST_THINNED..length).contains(&decimate) {
        return None;
    }
    Thinning::new(common?, decimate)
}

/// A frequency in Hz for a note.
fn cutoff(hz: f64) -> String {
    if (1e-3..1e9).contains(&hz) {
        format!("{hz:.4}")
    } else {
        format!("{hz:.4e}")
    }
}

fn low_pass(name: &'static str, hz: Option<f64>, rate: f64) -> Result<Option<Sos>, Error> {
    hz.map(|f| Sos::butterworth_low_pass(ORDER, f, rate))
        .transpose()
        .map_err(|source| Error::Filter { name, source })
}

pub(crate) fn check(number: usize, log: &Samples) -> Result<(), Error> {
    let n = log.time.len();
    let channels = [
        ("position", log.position.as_ref()),
        ("velocity", log.velocity.as_ref()),
        ("force", Some(&log.force)),
        ("load", log.load.as_ref()),
        ("acceleration", log.acceleration.as_ref()),
        ("temperature", log.temperature.as_ref()),
        ("external", log.external.as_ref()),
    ];
    if log.position.is_none() && log.velocity.is_none() {
        return Err(Error::NoMotionChannel { log: number });
    }
    for (channel, values) in channels {
        let Some(values) = values else { continue };
        if values.len() != n {
            return Err(Error::Length {
                log: number,
                channel,
                found: values.len(),
                expected: n,
            });
        }
        if let Some(i) = values.iter().position(|x| !x.is_finite()) {
            return Err(Error::NotFinite {
                log: number,
                channel,
                index: i + 1,
            });
        }
    }
    for (channel, flags) in [("valid", &log.valid), ("at_rest", &log.at_rest)] {
        if !flags.is_empty() && flags.len() != n {
            return Err(Error::Length {
                log: number,
                channel,
                found: flags.len(),
                expected: n,
            });
        }
    }
    if n < 4 {
        return Err(Error::TooFewSamples {
            found: n,
            needed: 4,
            losses: Losses {
                logged: n,
                ..Losses::default()
            },
        });
    }
    // A NaN in time compares as "does not increase" too.
    if let Some(i) = log
        .time
        .windows(2)
        .position(|t| !(t[1] > t[0] && t[1].is_finite()))
    {
        return Err(Error::Time {
            log: number,
            index: i + 2,
        });
    }
    Ok(())
}

pub(crate) fn median_step(time: &[f64]) -> f64 {
    let mut steps: Vec<f64> = time.windows(2).map(|t| t[1] - t[0]).collect();
    let middle = steps.len() / 2;
    let (_, median, _) = steps.select_nth_unstable_by(middle, f64::total_cmp);
    *median
}

/// Index ranges between long gaps.
pub(crate) fn stretches(log: &Samples, step: f64) -> Vec<std::ops::Range<usize>> {
    let mut out = Vec::new();
    let mut start = 0;
    for i in 1..log.time.len() {
        let gap = log.time[i] - log.time[i - 1] > (conditioning::MAX_BRIDGED_SAMPLES + 1.5) * step;
        if gap || log.breaks.binary_search(&i).is_ok() {
            out.push(start..i);
            start = i;
        }
    }
    out.push(start..log.time.len());
    out
}

struct Filters {
    source: Option<Sos>,
    common: Option<Sos>,
    /// The same where it is worth computing at the thinned samples alone.
    thinning: Option<Thinning>,
    /// Whether the force has passed the common filter already.
    force_is_filtered: bool,
    trim: usize,
    decimate: usize,
    /// Samples to each side that the common filter mixes into one.
    reach: usize,
    source_kind: Source,
    min_speed: f64,
}

impl Filters {
    /// Fewest samples of a stretch that leave something to fit.
    fn least(&self) -> usize {
        4usize
            .saturating_mul(self.decimate.max(4))
            .saturating_add(2 * self.trim)
    }

    /// The force after the common filter, every n-th sample of it.
    fn thinned_force(&self, drive: &[f64]) -> Option<Vec<f64>> {
        let every = || (0..drive.len()).step_by(self.decimate);
        let Some(common) = self.common.as_ref().filter(|_| !self.force_is_filtered) else {
            return Some(every().map(|i| drive[i]).collect());
        };
        if drive.iter().any(|x| !x.is_finite()) {
            return None;
        }
        let thinning = self.thinning.as_ref();
        let read = thinning.and_then(|t| t.read(&[drive], 0, every().len(), &[Reading::SAMPLE]));
        match read.into_iter().flatten().flatten().next() {
            Some(force) => Some(force),
            None => {
                let whole = common.zero_phase(drive).ok()?;
                Some(every().map(|i| whole[i]).collect())
            }
        }
    }

    /// One stretch, conditioned; `None` if it is too short.
    fn segment(
        &self,
        log: usize,
        samples: &Samples,
        range: std::ops::Range<usize>,
        step: f64,
        losses: &mut Losses,
    ) -> Option<Segment> {
        let grid = Grid::new(&samples.time[range.clone()], step)?;
        let n = grid.len();
        if n < self.least() {
            return None;
        }
        let on_grid = |x: &Vec<f64>| grid.resample(&x[range.clone()]);
        let smooth = |x: Vec<f64>, filter: &Option<Sos>| match filter {
            Some(f) => f.zero_phase(&x).ok(),
            None => Some(x),
        };
        // With a low-pass on the source, differences over seven samples lose less of the remaining
        // signal. Without one they would let more noise pass.
        let derivative = |x: &[f64]| match self.source {
            Some(_) => gradient_sixth_order(x, step).ok(),
            None => gradient(x, step).ok(),
        };
        let raw_position = samples.position.as_ref().map(on_grid);
        let has_position = raw_position.is_some();
        let (velocity, position, reading) = match self.source_kind {
            Source::Position => {
                let reading = raw_position?;
                let x = smooth(reading.clone(), &self.source)?;
                (derivative(&x)?, x, reading)
            }
            Source::Velocity => {
                let v = smooth(on_grid(samples.velocity.as_ref()?), &self.source)?;
                let x = raw_position.unwrap_or_else(|| integrate(&v, step));
                (v, x, Vec::new())
            }
        };
        let acceleration = derivative(&velocity)?;
        let drive = on_grid(&samples.force);
        let force = self.thinned_force(&drive)?;
        let valid = if samples.valid.is_empty() {
            &[][..]
        } else {
            &samples.valid[range.clone()]
        };
        let valid = grid.keep(valid);
        let at_rest = grid.at_rest(samples.at_rest.get(range.clone()).unwrap_or_default());
        let keep = apart(&valid, self.reach);
        let thin = |x: &[f64]| x.iter().step_by(self.decimate).copied().collect::<Vec<_>>();
        let keep = keep
            .iter()
            .enumerate()
            .step_by(self.decimate)
            .map(|(i, &k)| {
                let inside = i >= self.trim && i + self.trim < n;
                let fast = velocity[i].abs() >= self.min_speed;
                losses.ends += usize::from(!inside);
                losses.excluded += usize::from(inside && !k);
                let still = at_rest.get(i).is_some_and(|&still| still);
                losses.at_rest += usize::from(inside && k && still);
                if inside && k && !still && !fast {
                    losses.slow += 1;
                    losses.fastest_slow = losses.fastest_slow.max(velocity[i].abs());
                }
                k && inside && !still && fast
            })
            .collect();
        Some(Segment {
            log,
            step,
            velocity,
            reading,
            acceleration,
            drive,
            valid,
            at_rest,
            time: thin(&grid.times()),
            force,
            keep,
            channels: Channels {
                position: if has_position {
                    position.clone()
                } else {
                    Vec::new()
                },
                load: samples.load.as_ref().map_or_else(Vec::new, on_grid),
                temperature: samples.temperature.as_ref().map_or_else(Vec::new, on_grid),
                external: samples.external.as_ref().map_or_else(Vec::new, on_grid),
                external_deviations: samples.external_deviations.iter().map(on_grid).collect(),
                acceleration: match &samples.acceleration {
                    Some(measured) => smooth(on_grid(measured), &self.source)?,
                    None => Vec::new(),
                },
            },
            position,
        })
    }
}

/// Drops the samples within `reach` samples of a gap in `keep`. Gaps of one or two samples are ignored:
/// bridged by a line, they hardly change the filter output.
fn apart(keep: &[bool], reach: usize) -> Vec<bool> {
    let mut out = keep.to_vec();
    let mut start = 0;
    while start < keep.len() {
        let length = keep[start..]
            .iter()
            .take_while(|&&k| k == keep[start])
            .count();
        if !keep[start] && length > 2 {
            let end = (start + length + reach).min(keep.len());
            out[start.saturating_sub(reach)..end].fill(false);
        }
        start += length;
    }
    out
}

fn integrate(v: &[f64], step: f64) -> Vec<f64> {
    let mut x = 0.0;
    let mut out = Vec::with_capacity(v.len());
    for i in 0..v.len() {
        if i > 0 {
            x += 0.5 * (v[i - 1] + v[i]) * step;
        }
        out.push(x);
    }
    out
}
