//! A force that was logged behind a low-pass or as a mean over rows, as drives smooth the torque that they show.
//!
//! To first order that is a delay of its time constant, which a fit finds. To second order the force is smaller too, by half of
//! the square of frequency and time constant, and around reversals the step of friction is smeared: taken for a delay, the
//! Stribeck peak is too low and stiffness and micro-damping take up what is left. So where a force is later than one that is
//! held, the low-pass is undone with time constants up to that lateness, and the law fitted behind each. What is left of the
//! force, passed through the same low-pass again so that its noise counts alike, is least where the time constant is that of the
//! drive. From there it is found as the lag of a current loop is: its square is what a force shows of it (see [`lag`](crate::lag)).
//! A mean over rows is late by half of them, so that one number of rows has to be tried beside.

use crate::alignment::moved;
use crate::conditioning::record::{Record, Samples};
use crate::conditioning::{Conditioning, condition_as, median_step, stretches};
use crate::lag;
use crate::law::Law;
use crate::law::terms::{Delay, Terms};
use crate::replica::HELD_DELAY;
use crate::separable::follow;
use crate::separable::optimum::Optimum;
use crate::separable::search_box::MOST_DELAY;
use crate::separable::settings::Settings;
use stiction_policy::delay;
use stiction_search::{Observer, Status};
use stiction_signal::{of_mean, undo_low_pass, undo_mean};

/// Time constants that are tried, samples.
const TRIED: [f64; 10] = [0.5, 1.0, 1.7, 2.6, 3.8, 5.5, 8.0, 11.5, 16.5, 24.0];
/// How much later than a fit says the force may be, samples, where the delay of that fit is at the end of its range.
const BEYOND: f64 = 24.0;
/// Most fits from the best of the tried ones on, and the change of the square, in parts of its deviation, that is none any more.
const MOST_FITS: usize = 6;
const SETTLED: f64 = 0.1;

/// What the force was logged behind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Smoothing {
    /// A low-pass of first order with that time constant, s.
    LowPass(f64),
    /// A mean over that many rows.
    Mean(usize),
}

/// A low-pass of first order behind which the force was logged, or a mean over rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceFilter {
    /// What it is.
    pub what: Smoothing,
    /// Variance of the square of a time constant, s^4; 0 for a mean.
    pub variance: f64,
    /// Rows by which the force has to be taken later (earlier where negative) once the low-pass is undone.
    pub rows: isize,
    /// The delay that is left then, samples.
    pub delay: f64,
    /// What is left of the square of the force, in parts of what is left without it.
    pub left: f64,
}

impl ForceFilter {
    /// Whether there surely is one.
    pub fn is_certain(&self) -> bool {
        let shows = match self.what {
            Smoothing::LowPass(time) => {
                time * time > delay::MIN_LOW_PASS_DEVIATIONS * self.variance.sqrt()
                    && self.left < delay::MAX_LOW_PASS_ERROR
            }
            Smoothing::Mean(_) => true,
        };
        shows && (self.delay - HELD_DELAY).abs() < delay::MAX_LOW_PASS_DELAY
    }
}

/// What is undone before a fit.
#[derive(Clone, Copy)]
enum Undone {
    Nothing,
    /// A low-pass of that time constant, samples.
    LowPass(f64),
    /// A mean over that many rows.
    Mean(f64),
}

/// A fit behind what was undone.
struct Tried {
    /// Time constant, samples of the record.
    lag: f64,
    rows: isize,
    record: Record,
    optimum: Optimum,
    /// Mean square of what is left, behind the low-pass.
    left: f64,
}

/// The low-pass that logs of one axis show, `near` being the end of a fit of them, whose force was taken `laid` rows later before;
/// `None` where the force is no later than one that is held, none shows, or the observer stops it.
pub fn force_filter(
    logs: &[Samples],
    conditioning: &Conditioning,
    (near, laid): (&(Law, Vec<f64>), isize),
    terms: &Terms,
    settings: &Settings,
    observer: &mut dyn Observer,
) -> Option<ForceFilter> {
    let (law, start) = near;
    let delay = *start.get(law.nonlinear())?;
    if terms.delay != Delay::Fitted || law.layout().kappa.is_none() {
        return None;
    }
    let step = median_step(&logs.first()?.time);
    let beyond = match delay >= 0.75 * MOST_DELAY {
        true => BEYOND,
        false => 0.0,
    };
    let late = laid as f64 + delay - HELD_DELAY;
    if late < delay::MIN_FORCE_LAG {
        return None;
    }
    let most = late + beyond + delay::MAX_LOW_PASS_EXCESS;
    let mut fit = |undone: Undone, start: &[f64], late: f64| {
        fitted(
            logs,
            conditioning,
            (law, start),
            (undone, laid, late),
            terms,
            settings,
            observer,
        )
    };
    let without = fit(Undone::Nothing, start, late)?;
    let mut best: Option<Tried> = None;
    let mut from = without.optimum.p.clone();
    for lag in TRIED.into_iter().filter(|lag| *lag <= most) {
        let Some(tried) = fit(Undone::LowPass(lag), &from, late.max(lag)) else {
            continue;
        };
        from.clone_from(&tried.optimum.p);
        if best.as_ref().is_none_or(|best| tried.left < best.left) {
            best = Some(tried);
        }
    }
    let mut best = best?;
    let unit = step * step;
    let mut variance = f64::INFINITY;
    for _ in 0..MOST_FITS {
        let (found, spread) =
            lag::further(&best.record, &terms.about(&best.record), &best.optimum)?;
        variance = spread;
        let square = (best.lag * best.lag - found).clamp(0.0, most * most);
        let change = (square - best.lag * best.lag).abs();
        if change < SETTLED * variance.sqrt() {
            break;
        }
        let start = best.optimum.p.clone();
        let lag = square.sqrt();
        let undone = if lag > 0.0 {
            Undone::LowPass(lag)
        } else {
            Undone::Nothing
        };
        best = fit(undone, &start, late.max(lag))?;
    }
    let mean = mean(&mut fit, &without, late);
    let own = best.optimum.p.last().copied().unwrap_or(0.0);
    // A low-pass alone says no more than a mean does; one of a force that is some rows later has two numbers where a mean has one.
    let is_alone = best.rows + laid == 0 && (own - HELD_DELAY).abs() < delay::MAX_LOW_PASS_DELAY;
    let of_low_pass = match is_alone {
        true => delay::MAX_MEAN_OVER_LOW_PASS,
        false => 1.0 / delay::MAX_MEAN_OVER_LOW_PASS,
    };
    // What is later than the fit without it said may be anything that leaves less.
    let least = |rows: f64| match (0.5 * (rows - 1.0) - late).abs() <= delay::MAX_LOW_PASS_EXCESS {
        true => delay::MAX_MEAN_ERROR,
        false => delay::MAX_FURTHER_ERROR,
    };
    let shows = |(rows, mean): &(f64, Tried)| {
        mean.left < of_low_pass * best.left && mean.left < least(*rows) * without.left
    };
    if let Some((rows, mean)) = mean.filter(shows) {
        return Some(ForceFilter {
            what: Smoothing::Mean(rows as usize),
            variance: 0.0,
            rows: mean.rows,
            delay: mean.optimum.p.last().copied().unwrap_or(0.0),
            left: mean.left / without.left,
        });
    }
    let left = best.left / without.left;
    // A low-pass that leaves next to nothing is one, also where a drive logs a row or two later still.
    let further = match left < delay::MAX_FURTHER_ERROR {
        true => (own - HELD_DELAY)
            .round()
            .clamp(0.0, delay::MAX_FURTHER_DELAY),
        false => 0.0,
    };
    Some(ForceFilter {
        what: Smoothing::LowPass(best.lag * step),
        variance: variance * unit * unit,
        rows: best.rows + further as isize,
        delay: own - further,
        left,
    })
}

/// The mean over rows, and a fit with it undone, that is late by as much as the force is; `None` where that is by less than a row.
fn mean(
    fit: &mut impl FnMut(Undone, &[f64], f64) -> Option<Tried>,
    without: &Tried,
    mut late: f64,
) -> Option<(f64, Tried)> {
    let mut found: Option<(f64, Tried)> = None;
    for _ in 0..MOST_FITS {
        let rows = (2.0 * late + 1.0).round();
        if rows < delay::MIN_MEAN_ROWS || found.as_ref().is_some_and(|(before, _)| *before == rows)
        {
            break;
        }
        let start = found.as_ref().map_or(without, |(_, tried)| tried);
        let tried = fit(Undone::Mean(rows), &start.optimum.p.clone(), late)?;
        // Where the delay was at the end of its range the force is later.
        let own = tried.optimum.p.last().copied().unwrap_or(HELD_DELAY);
        late = (late + own - HELD_DELAY - (late - late.round())).max(0.0);
        found = Some((rows, tried));
    }
    found
}

/// A fit of the logs with something undone, `late` being by how many samples their force was late in all.
fn fitted(
    logs: &[Samples],
    conditioning: &Conditioning,
    (law, start): (&Law, &[f64]),
    (undone, laid, late): (Undone, isize, f64),
    terms: &Terms,
    settings: &Settings,
    observer: &mut dyn Observer,
) -> Option<Tried> {
    let own = undone.delay();
    // As near to a force that is held as whole rows allow.
    let rows = match undone {
        Undone::Nothing => 0,
        _ => (late - own).round() as isize - laid,
    };
    let logs: Vec<Samples> = logs
        .iter()
        .map(|log| moved(&undone.of(log), rows))
        .collect();
    let record = condition_as(&logs, conditioning, 0.0).ok()?;
    let conditioning = lag::asked(conditioning, &record);
    let record = condition_as(&logs, &conditioning, 0.0).ok()?;
    let terms = terms.about(&record);
    let mut start = start.to_vec();
    if let (Some(delay), false) = (start.last_mut(), matches!(undone, Undone::Nothing)) {
        *delay = late - own - (laid + rows) as f64 + HELD_DELAY;
    }
    let optimum = follow(&start, &record, *law, &terms, settings, observer).ok()?;
    if optimum.status == Status::Interrupted {
        return None;
    }
    let thinned = record.decimate as f64;
    let mut residual = optimum.evaluation.residual().to_vec();
    match undone {
        Undone::Nothing => {}
        Undone::LowPass(lag) => pass(residual.iter_mut(), lag / thinned),
        Undone::Mean(rows) => {
            let lag = of_mean(rows) / thinned;
            pass(residual.iter_mut(), lag);
            pass(residual.iter_mut().rev(), lag);
        }
    }
    let square = residual.iter().map(|r| r * r);
    let left = square.sum::<f64>() / residual.len().max(1) as f64;
    left.is_finite().then_some(Tried {
        lag: match undone {
            Undone::LowPass(lag) => lag,
            _ => 0.0,
        },
        rows,
        record,
        optimum,
        left,
    })
}

/// Passes samples through a low-pass of first order with that time constant, samples.
fn pass<'a>(samples: impl Iterator<Item = &'a mut f64>, lag: f64) {
    let kept = if lag > 0.0 {
        libm::exp(-1.0 / lag)
    } else {
        0.0
    };
    let mut behind = 0.0;
    for x in samples {
        behind = *x + (behind - *x) * kept;
        *x = behind;
    }
}

impl Undone {
    /// By how many samples less the force is late once it is undone, both rows being those of the same instants.
    fn delay(self) -> f64 {
        match self {
            Undone::LowPass(lag) => 1.0 / libm::expm1(1.0 / lag),
            Undone::Nothing | Undone::Mean(_) => 0.0,
        }
    }

    /// A log whose force is what it has made into the logged one, within each stretch.
    fn of(self, log: &Samples) -> Samples {
        let mut out = log.clone();
        if matches!(self, Undone::Nothing) {
            return out;
        }
        out.valid.resize(log.force.len(), true);
        for stretch in stretches(log, median_step(&log.time)) {
            let force = &mut out.force[stretch.clone()];
            match self {
                Undone::Nothing => {}
                Undone::LowPass(lag) => undo_low_pass(force, lag),
                Undone::Mean(rows) => {
                    undo_mean(force, rows);
                    out.valid[stretch.end - 1] = false;
                }
            }
            out.valid[stretch.start] = false;
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conditioning::{Cutoff, condition};
    use crate::separable::separable;
    use stiction_parameters::LawKind;
    use stiction_search::Silent;
    use stiction_testkit::worlds::{self, Machine, Motion, World};

    fn found(world: World) -> Option<ForceFilter> {
        let machine = Machine::screw(1);
        let log = worlds::record(&machine, Motion::Commissioning, world, 1);
        let logs = [Samples {
            time: log.time,
            position: log.position,
            force: log.force,
            ..Samples::default()
        }];
        let conditioning = Conditioning {
            resolution: Some(machine.count),
            source_cutoff: Cutoff::Hz(283.0),
            common_cutoff: Cutoff::Hz(70.0),
            ..Conditioning::default()
        };
        let terms = Terms {
            delay: Delay::Fitted,
            ..Terms::default()
        };
        let (law, settings) = (Law::new(LawKind::LuGre), Settings::default());
        let record = condition(&logs, &conditioning).unwrap();
        let near = separable(&record, law, &terms, &settings, &mut Silent).unwrap();
        let near = (law, near.p);
        force_filter(
            &logs,
            &conditioning,
            (&near, 0),
            &terms,
            &settings,
            &mut Silent,
        )
    }

    /// 3 ms are six samples, beyond the delays that a fit looks for.
    #[test]
    fn a_low_pass_is_found_and_a_delay_is_none() {
        for time in [1.7e-3, 3e-3] {
            let filter = found(World::Filtered(time)).unwrap();
            assert!(filter.is_certain(), "{filter:?}");
            let Smoothing::LowPass(found) = filter.what else {
                panic!("{filter:?}");
            };
            assert!((found / time - 1.0).abs() < 0.05, "{filter:?}");
            assert!(filter.left < 0.5, "{filter:?}");
        }
        for world in [World::Late(1), World::Faithful] {
            let filter = found(world).filter(ForceFilter::is_certain);
            assert_eq!(filter, None, "{world:?}");
        }
    }

    #[test]
    fn a_mean_over_rows_is_told_from_a_low_pass() {
        // Of fewer rows it shows too little.
        for rows in [9, 12, 16] {
            let filter = found(World::Averaged(rows)).unwrap();
            assert!(filter.is_certain(), "{filter:?}");
            assert_eq!(filter.what, Smoothing::Mean(rows), "{filter:?}");
        }
    }

    #[test]
    fn undone_and_laid_the_rows_are_those_of_a_held_force() {
        let log = Samples {
            time: (0..60).map(|k| 1e-3 * f64::from(k)).collect(),
            force: (0..60)
                .map(|k| (1.0 - libm::exp(-0.4 * f64::from(k))).max(0.0))
                .collect(),
            ..Samples::default()
        };
        let before = Undone::LowPass(2.5).of(&log);
        assert!(before.force[1..].iter().all(|u| (u - 1.0).abs() < 1e-9));
        assert!(!before.valid[0] && before.valid[1..].iter().all(|valid| *valid));
        assert!((Undone::LowPass(2.5).delay() - 2.0332).abs() < 1e-3);
    }
}
