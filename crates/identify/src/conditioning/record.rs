//! What goes into an identification, before and after conditioning.

use crate::conditioning::Conditioning;
use crate::conditioning::channels::Channels;
use crate::conditioning::losses::Losses;
use crate::conditioning::shift::Shift;
use std::borrow::Cow;
use std::ops::Range;
use stiction_signal::{Reading, Sos, Thinning, Travel, noise_deviation};

/// One log in SI units on its own time axis: m or rad, m/s or rad/s, N or N·m (or A, V).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Samples {
    /// Time, s, strictly increasing.
    pub time: Vec<f64>,
    /// Position, m or rad.
    pub position: Option<Vec<f64>>,
    /// Velocity, m/s or rad/s.
    pub velocity: Option<Vec<f64>>,
    /// Measured acceleration, m/s^2 or rad/s^2.
    pub acceleration: Option<Vec<f64>>,
    /// Force (torque, current, voltage) that drives the axis; with `external`, the sum of both.
    pub force: Vec<f64>,
    /// Normal load, in any unit.
    pub load: Option<Vec<f64>>,
    /// Temperature, K.
    pub temperature: Option<Vec<f64>>,
    /// The part of the force that does not come from the motor, in its unit, for friction that depends on what the
    /// transmission passes on.
    pub external: Option<Vec<f64>>,
    /// By how much `external` may be wrong: of each of some independent errors one standard deviation.
    pub external_deviations: Vec<Vec<f64>>,
    /// Which samples may be used; empty means all.
    pub valid: Vec<bool>,
    /// Which samples are at rest: filters and laws go on through them, and they are not fitted, since the force of an axis
    /// that does not move may have any value up to break-away; empty means none.
    pub at_rest: Vec<bool>,
    /// Samples at which something new starts (after a jump of the position, say), in order; the
    /// record is split there even if the time goes on.
    pub breaks: Vec<usize>,
}

impl Samples {
    /// Keeps the rows of this range.
    pub fn keep(&mut self, range: Range<usize>) {
        fn cut<T>(x: &mut Vec<T>, range: &Range<usize>) {
            x.truncate(range.end);
            x.drain(..range.start.min(x.len()));
        }
        let others = [
            &mut self.position,
            &mut self.velocity,
            &mut self.acceleration,
            &mut self.load,
            &mut self.temperature,
            &mut self.external,
        ];
        let of_each = [&mut self.time, &mut self.force].into_iter();
        let of_each = of_each.chain(&mut self.external_deviations);
        for values in of_each.chain(others.into_iter().flatten()) {
            cut(values, &range);
        }
        cut(&mut self.valid, &range);
        cut(&mut self.at_rest, &range);
        self.breaks
            .retain(|at| *at > range.start && range.contains(at));
        for at in &mut self.breaks {
            *at -= range.start;
        }
    }
}

/// A stretch of uniform samples without gaps.
///
/// The motion stands at the full rate; `force` has passed the common filter and is thinned to every
/// `decimate`-th sample, and so are the columns that the law and the other terms make from the motion,
/// so that both sides of the regression see the same filter.
#[derive(Clone, Debug)]
pub struct Segment {
    /// Which log it comes from, counted from 0.
    pub log: usize,
    /// Sample time of the motion, s.
    pub step: f64,
    /// Velocity that drives the law, at the full rate, m/s or rad/s.
    pub velocity: Vec<f64>,
    /// Position at the full rate, from zero where none was logged, m or rad.
    pub position: Vec<f64>,
    /// Position as logged, at the full rate, no filter; empty where the motion is a logged velocity.
    pub reading: Vec<f64>,
    /// Acceleration at the full rate, not yet passed through the common filter, m/s^2 or rad/s^2.
    pub acceleration: Vec<f64>,
    /// Force as logged, at the full rate, no filter.
    pub drive: Vec<f64>,
    /// Which samples of the full rate may be used.
    pub valid: Vec<bool>,
    /// Which samples of the full rate are at rest and not fitted; empty where none is.
    pub at_rest: Vec<bool>,
    /// Time of the thinned samples, s.
    pub time: Vec<f64>,
    /// Measured force at the thinned samples, filtered.
    pub force: Vec<f64>,
    /// Which thinned samples count.
    pub keep: Vec<bool>,
    /// What friction may depend on beside the velocity, at the full rate.
    pub channels: Channels,
}

/// Everything a fit sees: segments, and the filter that made them.
#[derive(Clone, Debug)]
pub struct Record {
    /// The stretches, in order.
    pub segments: Vec<Segment>,
    /// The common filter, at the full rate, if any.
    pub common: Option<Sos>,
    /// Whether the force passed that filter before it was logged.
    pub(crate) force_is_filtered: bool,
    /// Every how many samples the regression uses.
    pub decimate: usize,
    /// Standard deviation of the noise of the position as logged, its encoder steps included, m or rad.
    pub position_noise: f64,
    /// Standard deviation of the instants at which the position was read about its stamps, s; 0 where none can be told.
    pub timing_noise: f64,
    /// Cut-off of the common filter, Hz.
    pub common_hz: Option<f64>,
    /// How the record was conditioned, as text for the user.
    pub notes: Vec<String>,
    /// Smallest displacement that the log resolves (one encoder count), m or rad, where known.
    pub resolution: Option<f64>,
    /// How to condition a position as this record was; `None` where the motion is a logged velocity.
    pub(crate) conditioning: Option<Conditioning>,
    /// Number of samples left out by conditioning, by reason.
    pub(crate) losses: Losses,
    /// Whether this is a copy with fewer samples, used to look for starting points.
    pub(crate) is_thinned: bool,
}

impl Segment {
    /// Full-rate channels, filtered, at the kept samples, earlier by each of some shifts; an empty channel has none. `None`
    /// where a shift reaches beyond an end.
    fn read(
        &self,
        full: &[&[f64]],
        shifts: &[Shift],
        thinning: &Thinning,
    ) -> Option<Vec<Vec<Vec<f64>>>> {
        let mut readings = shifts.iter().map(Shift::reading);
        let (offset, _) = readings.clone().min_by_key(|(offset, _)| *offset)?;
        // Shifts by a whole number of samples beside others are read among their points.
        let readings: Vec<Reading> = match readings.all(|(own, _)| own == offset) {
            true => shifts.iter().map(|shift| shift.reading().1).collect(),
            false => shifts.iter().map(|shift| shift.among()).collect(),
        };
        self.read_from(full, offset, &readings, thinning)
    }

    /// The same at each of six samples, the first of them relative to the kept ones.
    pub(crate) fn points(
        &self,
        full: &[&[f64]],
        first: isize,
        thinning: &Thinning,
    ) -> Option<Vec<Vec<Vec<f64>>>> {
        self.read_from(full, first, &Shift::points(), thinning)
    }

    /// Readings from an offset to the kept samples on.
    fn read_from(
        &self,
        full: &[&[f64]],
        offset: isize,
        readings: &[Reading],
        thinning: &Thinning,
    ) -> Option<Vec<Vec<Vec<f64>>>> {
        let mut out = vec![vec![Vec::new(); readings.len()]; full.len()];
        let Some(first) = self.keep.iter().position(|&k| k) else {
            return Some(out);
        };
        let last = self.keep.iter().rposition(|&k| k)?;
        let kept = &self.keep[first..=last];
        let at = (first * thinning.every()).checked_add_signed(offset)?;
        let there: Vec<&[f64]> = full.iter().copied().filter(|x| !x.is_empty()).collect();
        let read = thinning.read(&there, at, kept.len(), readings)?;
        let places = out.iter_mut().zip(full).filter(|(_, x)| !x.is_empty());
        for ((out, _), read) in places.zip(read) {
            *out = read;
        }
        if kept.contains(&false) {
            for column in out.iter_mut().flatten() {
                let mut kept = kept.iter();
                column.retain(|_| kept.next() == Some(&true));
            }
        }
        Some(out)
    }

    /// Whether every sample that a regression could see counts.
    pub(crate) fn counts_whole(&self) -> bool {
        // No early exit within a chunk, so that the compiler can process many samples at once.
        let run = |keep: &[bool]| keep.iter().fold(true, |all, &k| all & k);
        self.keep.chunks(256).all(run)
    }
}

impl Record {
    /// Number of samples that count.
    pub fn kept(&self) -> usize {
        self.segments
            .iter()
            .map(|s| s.keep.iter().filter(|&&k| k).count())
            .sum()
    }

    /// Whether any sample of a log, counted from 0, counts.
    pub fn has_samples_of(&self, log: usize) -> bool {
        let mut own = self.segments.iter().filter(|s| s.log == log);
        own.any(|s| s.keep.contains(&true))
    }

    /// Number of samples of the regression, kept or not.
    pub fn len(&self) -> usize {
        self.segments.iter().map(|s| s.keep.len()).sum()
    }

    /// How long the logs are not fitted since the force depends on what was before them, at the start and after gaps, s, and the part
    /// of them that this is; `None` where they are fitted from the first sample on.
    pub fn unsettled(&self) -> Option<(f64, f64)> {
        let (lost, all) = (self.losses.unsettled, self.len());
        let sample = self.losses.decimate.max(1) as f64 * self.step();
        (lost > 0).then(|| (lost as f64 * sample, lost as f64 / all as f64))
    }

    /// Why samples do not count, with their numbers.
    pub(crate) fn losses(&self) -> Losses {
        let mut losses = self.losses.clone();
        let known = losses.excluded + losses.ends + losses.slow + losses.unsettled;
        losses.held_back = (self.len() - self.kept()).saturating_sub(known);
        losses
    }

    /// Whether there are no samples.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Sample time of the motion, s; the same in all segments.
    pub fn step(&self) -> f64 {
        self.segments.first().map_or(0.0, |s| s.step)
    }

    /// Part of the variance of white noise that the common filter lets through: a Butterworth low-pass
    /// of order 4, run both ways, has the noise bandwidth of .898 of its cut-off.
    pub(crate) fn noise_gain(&self) -> f64 {
        self.common_hz
            .map_or(1.0, |f| (2.0 * 0.898 * f * self.step()).min(1.0))
    }

    /// Largest speed, m/s or rad/s.
    pub fn top_speed(&self) -> f64 {
        self.segments.iter().fold(0.0, |top: f64, s| {
            let (low, high) = extent(&s.velocity);
            top.max(high).max(-low)
        })
    }

    /// Largest distance between two positions of one segment, by integration of the velocity, m or
    /// rad.
    pub fn stroke(&self) -> f64 {
        self.segments
            .iter()
            .map(|s| {
                let (mut x, mut low, mut high) = (0.0_f64, 0.0_f64, 0.0_f64);
                for v in s.velocity.windows(2) {
                    x += 0.5 * (v[0] + v[1]) * s.step;
                    low = low.min(x);
                    high = high.max(x);
                }
                high - low
            })
            .fold(0.0, f64::max)
    }

    /// Whether the axis moves in both directions while samples count; movement within the noise is no motion.
    pub fn moves_both_ways(&self) -> bool {
        let has_position = |s: &Segment| !s.reading.is_empty() || !s.channels.position.is_empty();
        let shortest = if self.segments.iter().all(has_position) {
            Travel::shortest_movement(self.resolution.unwrap_or(0.0), self.position_noise)
        } else {
            // White noise of the velocity makes the position that it is integrated to walk at random.
            let noise = noise_deviation(self.segments.iter().map(|s| &s.velocity[..]));
            let lengths = self.segments.iter().map(|s| s.velocity.len());
            let longest = lengths.max().unwrap_or(0);
            Travel::shortest_integrated(noise, self.step() * longest as f64, longest)
        };
        let travel = self.segments.iter().map(|s| {
            let position = match s.reading.is_empty() {
                true => &s.position,
                false => &s.reading,
            };
            // What the axis does while samples do not count is left out.
            let counts = |i: &usize| s.keep.get(i / self.decimate) == Some(&true);
            let moved = (1..position.len())
                .filter(counts)
                .map(|i| position[i] - position[i - 1]);
            let along = moved.scan(0.0, |x, dx| {
                *x += dx;
                Some(*x)
            });
            Travel::of(std::iter::once(0.0).chain(along), shortest)
        });
        !travel.fold(Travel::default(), Travel::and).is_one_way()
    }

    /// The kept samples of a thinned channel, in order.
    pub fn gather(&self, channel: impl Fn(&Segment) -> &[f64]) -> Vec<f64> {
        let mut out = Vec::with_capacity(self.kept());
        for segment in &self.segments {
            kept_runs(channel(segment), &segment.keep, &mut out);
        }
        out
    }

    /// The kept samples of a channel at the full rate, in order; none where the log has no such
    /// channel.
    pub fn pick(&self, channel: impl Fn(&Segment) -> &[f64]) -> Vec<f64> {
        let mut out = Vec::with_capacity(self.kept());
        for segment in &self.segments {
            self.thin(segment, channel(segment), Shift::NONE, &mut out);
        }
        out
    }

    /// The same without a copy where every sample of the record counts.
    pub(crate) fn whole(&self, channel: impl Fn(&Segment) -> &[f64]) -> Cow<'_, [f64]> {
        match &self.segments[..] {
            [only] if only.counts_whole() && channel(only).len() == only.keep.len() => {
                channel(only).into()
            }
            _ => self.gather(channel).into(),
        }
    }

    /// Passes full-rate channels of a segment through the common filter, in place.
    pub(crate) fn filter<'c>(&self, full: impl IntoIterator<Item = &'c mut Vec<f64>>) {
        if let Some(filter) = &self.common {
            let mut columns: Vec<&mut [f64]> = full
                .into_iter()
                .filter(|c| !c.is_empty())
                .map(Vec::as_mut_slice)
                .collect();
            // The segment was conditioned by this very filter, so it is long enough; a column that is
            // not finite stays as it is and makes the cost of this trial not finite.
            let _ = filter.zero_phase_columns(&mut columns);
        }
    }

    /// Appends the kept samples of a full-rate channel of a segment, taken earlier by a shift; an
    /// empty channel has none.
    pub(crate) fn thin(&self, segment: &Segment, full: &[f64], shift: Shift, out: &mut Vec<f64>) {
        if full.is_empty() {
            return;
        }
        if shift == Shift::NONE && self.decimate == 1 {
            kept_runs(full, &segment.keep, out);
            return;
        }
        let mut at = 0;
        for run in segment.keep.chunk_by(|a, b| a == b) {
            let end = at + run.len();
            if run[0] {
                shift.append(full, self.decimate, at..end, out);
            }
            at = end;
        }
    }

    /// Full-rate channels of a segment passed through the common filter and taken earlier by each of some shifts, at the
    /// kept samples: `thinning` computes only those, where it can. An empty channel has none.
    pub(crate) fn filtered(
        &self,
        segment: &Segment,
        full: &[&[f64]],
        shifts: &[Shift],
        thinning: Option<&Thinning>,
    ) -> Vec<Vec<Vec<f64>>> {
        let thinned = thinning.and_then(|thinning| segment.read(full, shifts, thinning));
        thinned.unwrap_or_else(|| {
            let mut full: Vec<Vec<f64>> = full.iter().map(|x| x.to_vec()).collect();
            self.filter(&mut full);
            let kept = |x: &Vec<f64>, shift: Shift| {
                let mut out = Vec::with_capacity(segment.keep.len());
                self.thin(segment, x, shift, &mut out);
                out
            };
            let at_all = |x| shifts.iter().map(|&shift| kept(x, shift)).collect();
            full.iter().map(at_all).collect()
        })
    }

    /// The same for a channel that is not needed afterwards: where the record is this one segment and all
    /// of it counts, the channel becomes the output without a copy.
    pub(crate) fn thin_whole(
        &self,
        segment: &Segment,
        full: Vec<f64>,
        shift: Shift,
        out: &mut Vec<f64>,
    ) {
        let as_it_is = self.segments.len() == 1 && shift == Shift::NONE && self.decimate == 1;
        if as_it_is && full.len() == segment.keep.len() && segment.counts_whole() {
            *out = full;
        } else {
            self.thin(segment, &full, shift, out);
        }
    }

    /// Indices among the kept samples at which a new segment starts (not 0), in order.
    pub(crate) fn breaks(&self) -> Vec<usize> {
        let mut at = 0;
        let mut out = Vec::new();
        for segment in &self.segments {
            if at > 0 {
                out.push(at);
            }
            at += segment.keep.iter().filter(|&&k| k).count();
        }
        out.dedup();
        out
    }

    /// The same record with another choice of what counts: `rule` sees the index of a sample among
    /// all samples of the regression and says whether it counts (if it counted before).
    #[must_use]
    pub fn masked(&self, rule: impl Fn(usize) -> bool) -> Self {
        let mut out = self.clone();
        let mut index = 0;
        for segment in &mut out.segments {
            for keep in &mut segment.keep {
                *keep = *keep && rule(index);
                index += 1;
            }
        }
        out
    }

    /// A copy to look for starting points at low cost, also of a record with a common filter: then its motion in coarser
    /// steps, at least `samples` of them, and columns of the law that pass no filter, although force and acceleration have
    /// passed it. What the filter rounds off moves the optimum a little, and hardly the place where to look for it.
    pub(crate) fn rough(&self, samples: usize) -> Option<Self> {
        if self.common.is_none() {
            return self.thinned(samples);
        }
        let motion: usize = self.segments.iter().map(|s| s.velocity.len()).sum();
        // The thinned samples of the force stay where they are.
        let most = self.decimate.min(motion / samples.max(1));
        let every = (1..=most)
            .rev()
            .find(|every| self.decimate.is_multiple_of(*every))?;
        let pick = |x: &[f64]| x.iter().step_by(every).copied().collect::<Vec<_>>();
        let segments = self.segments.iter().map(|s| {
            let mut acceleration = vec![s.acceleration.clone()];
            self.filter(&mut acceleration);
            Segment {
                log: s.log,
                step: s.step * every as f64,
                velocity: pick(&s.velocity),
                position: pick(&s.position),
                reading: pick(&s.reading),
                acceleration: pick(&acceleration[0]),
                drive: pick(&s.drive),
                valid: s.valid.iter().step_by(every).copied().collect(),
                at_rest: s.at_rest.iter().step_by(every).copied().collect(),
                time: s.time.clone(),
                force: s.force.clone(),
                keep: s.keep.clone(),
                channels: s.channels.every(every),
            }
        });
        Some(Self {
            segments: segments.collect(),
            common: None,
            force_is_filtered: false,
            decimate: self.decimate / every,
            position_noise: self.position_noise,
            timing_noise: self.timing_noise,
            common_hz: None,
            notes: Vec::new(),
            resolution: self.resolution,
            conditioning: None,
            losses: Losses::default(),
            is_thinned: true,
        })
    }

    /// A copy with about `samples` samples to look for starting points at low cost: every n-th sample of
    /// this record. `None` for a short record, or one with a common filter: thinning would then remove
    /// the filter from the columns of the law but not from the force.
    pub(crate) fn thinned(&self, samples: usize) -> Option<Self> {
        let every = self.len() / samples.max(1);
        if every < 2 || self.common.is_some() {
            return None;
        }
        let pick = |x: &[f64]| x.iter().step_by(every).copied().collect::<Vec<_>>();
        let coarse = |x: &[f64]| {
            let every = self.decimate * every;
            x.iter().step_by(every).copied().collect::<Vec<_>>()
        };
        let flags = |x: &[bool]| -> Vec<bool> {
            x.iter().step_by(self.decimate * every).copied().collect()
        };
        let segments = self
            .segments
            .iter()
            .map(|s| Segment {
                log: s.log,
                step: s.step * (self.decimate * every) as f64,
                velocity: coarse(&s.velocity),
                position: coarse(&s.position),
                reading: coarse(&s.reading),
                acceleration: coarse(&s.acceleration),
                drive: coarse(&s.drive),
                valid: flags(&s.valid),
                at_rest: flags(&s.at_rest),
                time: pick(&s.time),
                force: pick(&s.force),
                keep: s.keep.iter().step_by(every).copied().collect(),
                channels: s.channels.every(self.decimate.saturating_mul(every)),
            })
            .collect();
        Some(Self {
            segments,
            common: None,
            force_is_filtered: false,
            decimate: 1,
            position_noise: self.position_noise,
            timing_noise: self.timing_noise,
            common_hz: None,
            notes: Vec::new(),
            resolution: self.resolution,
            conditioning: None,
            losses: Losses::default(),
            is_thinned: true,
        })
    }
}

/// Least and greatest of some values, NaN ignored; (+infinity, -infinity) where there are none.
pub(crate) fn extent(values: &[f64]) -> (f64, f64) {
    let mut low = [f64::INFINITY; 8];
    let mut high = [f64::NEG_INFINITY; 8];
    let mut see = |values: &[f64]| {
        for ((low, high), &x) in low.iter_mut().zip(&mut high).zip(values) {
            *low = if x < *low { x } else { *low };
            *high = if x > *high { x } else { *high };
        }
    };
    let (wide, rest) = values.as_chunks::<8>();
    wide.iter().for_each(|x| see(x));
    see(rest);
    let low = low.into_iter().fold(f64::INFINITY, f64::min);
    (low, high.into_iter().fold(f64::NEG_INFINITY, f64::max))
}

/// Appends the samples that are kept, each run of them in one go.
fn kept_runs(values: &[f64], keep: &[bool], out: &mut Vec<f64>) {
    let mut rest = values;
    for run in keep.chunk_by(|a, b| a == b) {
        let (head, tail) = rest.split_at(run.len().min(rest.len()));
        if run[0] {
            out.extend_from_slice(head);
        }
        rest = tail;
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// A record without force or filter: one segment for each velocity.
    pub(crate) fn of_velocities(step: f64, velocities: &[&[f64]]) -> Record {
        let segments = velocities
            .iter()
            .map(|velocity| Segment {
                log: 0,
                step,
                velocity: velocity.to_vec(),
                position: vec![0.0; velocity.len()],
                reading: Vec::new(),
                acceleration: vec![0.0; velocity.len()],
                drive: vec![0.0; velocity.len()],
                valid: vec![true; velocity.len()],
                at_rest: Vec::new(),
                time: (0..velocity.len()).map(|i| step * i as f64).collect(),
                force: vec![0.0; velocity.len()],
                keep: vec![true; velocity.len()],
                channels: Channels::default(),
            })
            .collect();
        Record {
            segments,
            common: None,
            force_is_filtered: false,
            decimate: 1,
            position_noise: 0.0,
            timing_noise: 0.0,
            common_hz: None,
            notes: Vec::new(),
            resolution: None,
            conditioning: None,
            losses: Losses::default(),
            is_thinned: false,
        }
    }
}
