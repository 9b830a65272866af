//! The cost of elements along the delay of the force.

use super::parabola::Parabola;
use crate::conditioning::record::Record;
use crate::error::Error;
use crate::law::Law;
use crate::law::terms::{Delay, Terms};
use crate::separable::descent::descend;
use crate::separable::objective::Objective;
use crate::separable::search_box::{MOST_DELAY, SearchBox};
use crate::watch::Watch;

/// Steps of a descent at a delay on the way downhill.
const STEPS: usize = 8;
/// And at one beside which others were, from where those lead.
const FEW_STEPS: usize = 3;
/// First step of the way downhill, samples; steps double up to the longest.
const FIRST_STEP: f64 = 0.5;
const LONGEST_STEP: f64 = 1.0;
/// Distances between the points of a parabola, samples: on the wide one the minimum is found, on the narrow one it is stated.
const WIDE: f64 = 0.25;
pub(super) const NARROW: f64 = 0.1;
/// Points to either side of the middle one.
const SIDE: i32 = 3;
/// Most times that points are laid around the minimum that the last ones show.
const MOST_MOVES: usize = 4;

/// The cost along the delay, with all else fitted again.
pub(super) struct Profile<'a> {
    record: &'a Record,
    pub law: Law,
    terms: &'a Terms,
    bounds: SearchBox,
    /// One sample of the delay, s.
    unit: f64,
    points: Vec<Point>,
}

/// The end of a descent at a delay, samples.
struct Point {
    delay: f64,
    cost: f64,
    p: Vec<f64>,
}

impl<'a> Profile<'a> {
    /// Without a point; the sample of the delay may be that of another record.
    pub fn new(record: &'a Record, law: Law, terms: &'a Terms, unit: f64) -> Result<Self, Error> {
        Ok(Self {
            record,
            law,
            terms,
            bounds: SearchBox::from_record(record, &law)?,
            unit,
            points: Vec::new(),
        })
    }

    pub fn terms(&self, delay: f64) -> Terms {
        Terms {
            delay: Delay::Given(delay * self.unit),
            ..self.terms.clone()
        }
    }

    /// Takes a point that is known.
    pub fn begin(&mut self, delay: f64, cost: f64, p: Vec<f64>) {
        self.points.push(Point { delay, cost, p });
    }

    /// Takes the end of a descent from a point.
    pub fn descend(&mut self, delay: f64, start: &[f64], watch: &mut Watch) -> f64 {
        self.descend_for(STEPS, delay, start, watch)
    }

    fn descend_for(&mut self, steps: usize, delay: f64, start: &[f64], watch: &mut Watch) -> f64 {
        let terms = self.terms(delay);
        let objective = Objective::new(self.record, self.law, &terms);
        let end = descend(&objective, &self.bounds, start, steps, watch);
        let cost = end.evaluation.cost;
        self.begin(delay, cost, end.p);
        cost
    }

    /// Where the unknowns are at a delay, on the line through the ends at two others: the nearest, and the next that is far enough from it
    /// for what the line does.
    pub fn start(&self, delay: f64) -> Vec<f64> {
        let far = |point: &Point, from: f64| (point.delay - from).abs();
        let by = |a: &&Point, b: &&Point| far(a, delay).total_cmp(&far(b, delay));
        let near = self.points.iter().min_by(by);
        let near = near.expect("a profile begins with a point");
        let apart = far(near, delay);
        let others = self.points.iter();
        let others = others.filter(|point| apart > 0.0 && far(point, near.delay) >= apart);
        let Some(other) = others.min_by(by) else {
            return near.p.clone();
        };
        let part = (delay - near.delay) / (other.delay - near.delay);
        let both = near.p.iter().zip(&other.p);
        both.map(|(a, b)| a + part * (b - a)).collect()
    }

    /// The cost at a delay.
    pub fn cost(&mut self, delay: f64, watch: &mut Watch) -> f64 {
        self.cost_after(STEPS, delay, watch)
    }

    fn cost_after(&mut self, steps: usize, delay: f64, watch: &mut Watch) -> f64 {
        if let Some(known) = self.points.iter().find(|point| point.delay == delay) {
            return known.cost;
        }
        let start = self.start(delay);
        self.descend_for(steps, delay, &start, watch)
    }

    /// Where it is least, from a delay near it on; `None` where it falls to an end of the range, or the points show no minimum.
    pub fn least(&mut self, start: f64, watch: &mut Watch) -> Option<Parabola> {
        let mut middle = start;
        let mut wider = None;
        for spacing in [WIDE, NARROW] {
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

    /// Where it is least near a delay with a lower cost than those beside it, roughly.
    pub fn near(&mut self, valley: f64, watch: &mut Watch) -> f64 {
        let most = f64::from(SIDE) * WIDE;
        let found = self.parabola(valley, WIDE, watch);
        let far = found.map_or(0.0, |found| found.at - valley);
        (valley + far.clamp(-most, most)).clamp(-MOST_DELAY, MOST_DELAY)
    }

    /// A delay with a lower cost than those beside it.
    pub fn valley(&mut self, start: f64, watch: &mut Watch) -> Option<f64> {
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
        let mut points = vec![(0.0, self.cost_after(FEW_STEPS, middle, watch))];
        for i in 1..=SIDE {
            for side in [-1, 1] {
                let x = f64::from(side * i) * spacing;
                points.push((x, self.cost_after(FEW_STEPS, middle + x, watch)));
            }
        }
        Parabola::through(&points).map(|found| found.moved(middle))
    }
}
