//! The delay of the force beside Maxwell-slip elements, from the profile of the cost.
//!
//! Elements change between stick and slip at instants between samples, where the slope of their force by the delay jumps. So the
//! cost has kinks along the delay, and no descent finds where it is least. On the scale of tenths of a sample thousands of
//! reversals average them out: with all else fitted again at each delay the cost is smooth. It is followed downhill from the delay
//! that LuGre finds to where it rises on both sides, and a parabola through points around there says where it is least.

mod parabola;

use super::ladder::Search;
use super::search::search;
use crate::conditioning::record::Record;
use crate::error::Error;
use crate::estimate::uncertainty::sandwich;
use crate::held_delay;
use crate::law::Law;
use crate::law::terms::{Delay, DelayFrom, Terms};
use crate::separable::descent::descend;
use crate::separable::logs::Logs;
use crate::separable::objective::Objective;
use crate::separable::optimum::Optimum;
use crate::separable::search_box::{MOST_DELAY, SearchBox};
use crate::separable::settings::Settings;
use crate::watch::Watch;
use parabola::Parabola;
use stiction_search::{Observer, Stage, Status};

/// Steps of a descent at a delay, from the end of that at the nearest delay before.
const STEPS: usize = 8;
/// First step of the way downhill, samples; steps double up to the longest.
const FIRST_STEP: f64 = 0.5;
const LONGEST_STEP: f64 = 1.0;
/// Distances between the points of a parabola, samples: on the wide one the minimum is found, on the narrow one it is stated.
const SPACINGS: [f64; 2] = [0.25, 0.1];
/// Points to either side of the middle one.
const SIDE: i32 = 3;
/// Most times that points are laid around the minimum that the last ones show.
const MOST_MOVES: usize = 4;
/// Change of the delay, samples, from which on elements are looked for anew.
const FAR: f64 = 0.25;
/// Standard deviation, samples, from which on the profile counts as flat.
const FLAT: f64 = 1.0;

/// Fits the elements with the delay that they find, beginning at one that is held, which `terms` have and `held` was fitted with. Gives
/// those where the profile has no minimum within the range of a fitted delay, or is flat, and where the law that the delay is from leaves
/// less of the force: then it knows it better. `law` is the one that was asked for.
pub(crate) fn sought(
    record: &Record,
    law: Law,
    terms: &Terms,
    held: Optimum,
    settings: &Settings,
    observer: &mut dyn Observer,
) -> Result<(Terms, Optimum), Error> {
    let Delay::Given(start) = terms.delay else {
        return Ok((terms.clone(), held));
    };
    let start = (start / record.step()).clamp(-MOST_DELAY, MOST_DELAY);
    let mut watch = Watch::new(observer, Stage::Fine);
    watch.counts = held.counts;
    let found = found(record, law, (terms, start), &held, settings, &mut watch)?;
    if let Some(mut found) = found.filter(|_| !watch.stopped) {
        found.1.counts = watch.counts;
        return Ok(found);
    }
    let status = match watch.stopped {
        true => Status::Interrupted,
        false => held.status,
    };
    let kept = Optimum {
        counts: watch.counts,
        status,
        ..held
    };
    Ok((terms.clone(), kept))
}

/// The same from a delay, samples; `None` where nothing is found.
fn found(
    record: &Record,
    law: Law,
    (terms, start): (&Terms, f64),
    held: &Optimum,
    settings: &Settings,
    watch: &mut Watch,
) -> Result<Option<(Terms, Optimum)>, Error> {
    let mut profile = Profile::new(record, terms, held, start)?;
    let Some(mut least) = profile.least(start, watch) else {
        return Ok(None);
    };
    let mut elements = held.elements.clone();
    if (least.at - start).abs() > FAR && !watch.stopped {
        // Beside another delay there may have been other elements, and more or fewer.
        let near = profile.terms(least.at);
        let again = search(record, law, &near, settings, &mut *watch.observer)?;
        watch.counts.add(&again.counts);
        watch.stopped |= again.status == Status::Interrupted;
        let mut anew = Profile::new(record, terms, &again, least.at)?;
        if let Some(there) = anew.least(least.at, watch)
            && (law.elements == 0 || there.cost < least.cost)
        {
            (profile, least) = (anew, there);
            elements = again.elements;
        }
    }
    if watch.stopped {
        return Ok(None);
    }
    let near = profile.terms(least.at);
    let mut search = Search {
        record,
        law: Law {
            elements: 0,
            ..profile.law
        },
        terms: &near,
        settings,
        iterations: 0,
    };
    let rung = search.follow(profile.law, &profile.nearest(least.at).p, STEPS, watch)?;
    let optimum = search.finish(rung, watch)?;
    let variance = variance(record, &near, &optimum, &least);
    let cost = optimum.evaluation.cost;
    let least = match terms.delay_from {
        DelayFrom::OtherLaw(rms) => rms * rms * record.kept() as f64,
        DelayFrom::Stated | DelayFrom::Elements => f64::INFINITY,
    };
    // Fewer elements that hold as well on samples that were left out may leave a little more.
    let no_worse = cost <= held.evaluation.cost || optimum.law.elements < held.law.elements;
    let found = variance < FLAT * FLAT && no_worse && cost < least;
    Ok(found.then(|| {
        let terms = Terms {
            delay_deviation: variance.sqrt() * record.step(),
            delay_from: DelayFrom::Elements,
            ..near
        };
        let iterations = held.iterations + optimum.iterations;
        let optimum = Optimum {
            elements,
            iterations,
            ..optimum
        };
        (terms, optimum)
    }))
}

/// Variance of the delay at a minimum, samples^2: of one more unknown beside all others, with the correlation of what is left counted
/// as for these. Where the cost rises less along the profile than beside linear unknowns, by as much more; and what the points of
/// the profile scatter about the parabola.
fn variance(record: &Record, terms: &Terms, optimum: &Optimum, least: &Parabola) -> f64 {
    let objective = Objective::new(record, optimum.law, terms);
    let at = &optimum.evaluation;
    let (unit, by) = (record.step(), SPACINGS[1]);
    let fit = (&optimum.p[..], at);
    let mut column = held_delay::column(&objective, terms, fit, least.at * unit, by * unit);
    column.iter_mut().for_each(|x| *x /= by);
    let mut jacobian = at.jacobian();
    jacobian.push(&column);
    let within = Logs::of(record).and_then(|logs| logs.within(at));
    let residual = within.as_deref().unwrap_or(at.residual());
    let known = sandwich(&jacobian, residual, &record.breaks());
    let own = jacobian.len() - 1;
    let softer = (1.0 / (known.bread[(own, own)] * least.curvature)).max(1.0);
    known.covariance[(own, own)] * softer * softer + least.scatter
}

/// The cost along the delay, with all else fitted again.
struct Profile<'a> {
    record: &'a Record,
    law: Law,
    terms: &'a Terms,
    bounds: SearchBox,
    points: Vec<Point>,
}

/// The end of a descent at a delay, samples.
struct Point {
    delay: f64,
    cost: f64,
    p: Vec<f64>,
}

impl<'a> Profile<'a> {
    /// With a fit at a delay.
    fn new(record: &'a Record, terms: &'a Terms, fit: &Optimum, delay: f64) -> Result<Self, Error> {
        let first = Point {
            delay,
            cost: fit.evaluation.cost,
            p: fit.p.clone(),
        };
        Ok(Self {
            record,
            law: fit.law,
            terms,
            bounds: SearchBox::from_record(record, &fit.law)?,
            points: vec![first],
        })
    }

    fn terms(&self, delay: f64) -> Terms {
        Terms {
            delay: Delay::Given(delay * self.record.step()),
            ..self.terms.clone()
        }
    }

    fn nearest(&self, delay: f64) -> &Point {
        let far = |point: &&Point| (point.delay - delay).abs();
        let nearest = self.points.iter().min_by(|a, b| far(a).total_cmp(&far(b)));
        nearest.expect("a profile begins with a point")
    }

    /// The cost at a delay.
    fn cost(&mut self, delay: f64, watch: &mut Watch) -> f64 {
        let near = self.nearest(delay);
        if near.delay == delay {
            return near.cost;
        }
        let terms = self.terms(delay);
        let objective = Objective::new(self.record, self.law, &terms);
        let end = descend(&objective, &self.bounds, &near.p, STEPS, watch);
        let cost = end.evaluation.cost;
        self.points.push(Point {
            delay,
            cost,
            p: end.p,
        });
        cost
    }

    /// Where it is least, from a delay on; `None` where it falls to an end of the range, or the points show no minimum.
    fn least(&mut self, start: f64, watch: &mut Watch) -> Option<Parabola> {
        let mut middle = self.valley(start, watch)?;
        let mut wider = None;
        for spacing in SPACINGS {
            let mut found = None;
            for _ in 0..MOST_MOVES {
                let mut parabola = self.parabola(middle, spacing, watch)?;
                let far = parabola.at - middle;
                let most = f64::from(SIDE) * spacing;
                middle += far.clamp(-most, most);
                if middle.abs() >= MOST_DELAY || watch.stopped {
                    return None;
                }
                if far.abs() <= spacing {
                    // What the shape is not, both show otherwise.
                    let apart = wider.map_or(0.0, |wide: Parabola| parabola.at - wide.at);
                    parabola.scatter += apart * apart;
                    found = Some(parabola);
                    break;
                }
            }
            // Where kinks are all that the narrow one shows, the wide one stands.
            let Some(found) = found else { break };
            wider = Some(found);
        }
        wider
    }

    /// A delay with a lower cost than those beside it.
    fn valley(&mut self, start: f64, watch: &mut Watch) -> Option<f64> {
        let here = self.cost(start, watch);
        let sides = [-FIRST_STEP, FIRST_STEP];
        let [early, late] = sides.map(|step| self.cost(start + step, watch));
        if early >= here && late >= here {
            return Some(start);
        }
        let way = if late < early { 1.0 } else { -1.0 };
        let (mut at, mut cost) = (start + way * FIRST_STEP, early.min(late));
        let mut step = FIRST_STEP;
        loop {
            step = (2.0 * step).min(LONGEST_STEP);
            let next = at + way * step;
            if next.abs() > MOST_DELAY || watch.stopped {
                return None;
            }
            let there = self.cost(next, watch);
            if there >= cost {
                return Some(at);
            }
            (at, cost) = (next, there);
        }
    }

    /// The parabola through points around a delay; `None` where it has no minimum.
    fn parabola(&mut self, middle: f64, spacing: f64, watch: &mut Watch) -> Option<Parabola> {
        // From the middle outwards, so that each descent begins at its neighbour.
        let mut points = vec![(0.0, self.cost(middle, watch))];
        for i in 1..=SIDE {
            for side in [-1, 1] {
                let x = f64::from(side * i) * spacing;
                points.push((x, self.cost(middle + x, watch)));
            }
        }
        Parabola::through(&points).map(|found| found.moved(middle))
    }
}
