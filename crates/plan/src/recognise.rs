//! Which pieces of a motion a log shows.

use crate::motion::Motion;
use std::ops::Range;
use stiction_policy::plan;

/// What became of a piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum How {
    /// It is in the log from its start to its end.
    Whole,
    /// The log begins after its start, or ends before its end.
    CutShort,
    /// It is not in the log.
    Missing,
}

/// A piece in a log.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ran {
    /// What became of it.
    pub how: How,
    /// When it starts, in the time of the log, s; `None` where it is missing.
    pub start: Option<f64>,
    /// How much of its amplitude is in the log, 1 where the axis follows: less where the loop is slow, and hardly any of a piece
    /// that friction holds.
    pub followed: f64,
}

/// A motion in a log.
#[derive(Clone, Debug, PartialEq)]
pub struct Recognised {
    /// Pace at which it ran: 1 as planned, 0.3 at an override of 30 %.
    pub pace: f64,
    /// Its pieces in their order; empty at another pace than 1.
    pub pieces: Vec<Ran>,
    /// How many times as far as the motion the log goes, where it shows the whole of it clearly.
    pub size: Option<f64>,
}

/// Rate at which both are compared, Hz: seven times that of the fastest sine; less where the work would be more than [`WORK`].
const RATE: f64 = 200.0;
const WORK: f64 = 2e8;
/// The same for each of the paces that are tried where it did not run as planned.
const WORK_OF_PACE: f64 = 4e6;
/// How far beside the time at which it is due a piece is sought first, s.
const NEAR: f64 = 0.3;
/// How far from where it is due a piece is sought, s.
const LATER: f64 = 120.0;
/// Least and largest pace that is tried, and the ratio between them; the same of a log that is like the motion at its own.
const PACES: [f64; 3] = [0.02, 3.0, 1.02];
const NEAR_PACES: [f64; 3] = [0.8, 1.25, 1.005];

/// Finds a motion in the position of a log, or better in its set point: times in s, rising, and as many positions, in m (rad),
/// counted from anywhere. `None` where nothing of it is there, at any pace.
///
/// It costs the product of both durations times a rate of at most 200 Hz squared, at most 2e8 steps, and at most a fiftieth of that
/// for each of 90 paces near its own, or of 250 where it is not clearly there.
pub fn recognise(motion: &Motion, time: &[f64], position: &[f64]) -> Option<Recognised> {
    let whole = [*time.first()?, *time.last()?];
    let seconds = whole[1] - whole[0];
    if !(seconds > 0.0 && motion.duration() > 0.0) || time.len() != position.len() {
        return None;
    }
    let log = |rate: f64| Course::of_log(time, position, rate, whole);
    let work = |rate: f64| rate * rate * seconds * motion.duration();
    let rate = RATE.min(RATE * libm::sqrt(WORK / work(RATE)));
    let place = placed(&log(rate), &Course::of(motion, 1.0, rate));
    // Strokes of a slower run are like those of a faster one in part, and near its own pace the whole is like it.
    let is_clear = place.alike >= plan::MIN_MOTION_CORRELATION;
    let [least, most, step] = if is_clear { NEAR_PACES } else { PACES };
    let needed = match is_clear {
        true => 1.0 - plan::MAX_PACE_RESIDUAL * (1.0 - place.alike),
        false => plan::MIN_CORRELATION.max(place.alike),
    };
    let other = other_pace(motion, &log, work(RATE), [least, most, step]);
    if let Some((pace, _)) = other.filter(|(_, alike)| *alike >= needed) {
        return Some(Recognised {
            pace,
            pieces: Vec::new(),
            size: None,
        });
    }
    (place.alike >= plan::MIN_CORRELATION).then(|| {
        // However long the log is: what is far away is not looked at again.
        let from = (place.start - LATER).max(whole[0]);
        let to = (place.start + motion.duration() + LATER).min(whole[1]);
        let near = Course::of_log(time, position, RATE, [from, to]);
        Recognised {
            pace: 1.0,
            pieces: pieces(motion, &near, whole, place.start),
            size: (place.alike >= plan::MIN_MOTION_CORRELATION).then_some(place.followed),
        }
    })
}

/// The pace other than 1 at which a motion is most like a log, as a whole, and how much; `work` is that of the two at [`RATE`].
fn other_pace(
    motion: &Motion,
    log: &impl Fn(f64) -> Course,
    work: f64,
    [least, most, step]: [f64; 3],
) -> Option<(f64, f64)> {
    let rate = RATE.min(RATE * libm::sqrt(WORK_OF_PACE / work));
    let coarse = log(rate);
    let mut paces = Vec::new();
    let mut pace = least;
    while pace <= most {
        if (pace - 1.0).abs() > plan::MAX_PACE_ERROR {
            paces.push(pace);
        }
        pace *= step;
    }
    let tried = paces.into_iter().map(|pace| {
        // As a whole: parts of other motions are like parts of it at some pace.
        let slower = Course::of(motion, pace, rate);
        let last = coarse.positions.len() as isize - slower.positions.len() as isize;
        (pace, best(&coarse, &slower, 0..last + 1).alike)
    });
    tried.max_by(|a, b| a.1.total_cmp(&b.1))
}

/// Positions at a rate from an instant on.
struct Course {
    start: f64,
    step: f64,
    positions: Vec<f64>,
    /// Sum of squares about their mean.
    square: f64,
}

/// Where one course fits into another.
#[derive(Clone, Copy)]
struct Place {
    /// When it starts, s.
    start: f64,
    /// Correlation of both.
    alike: f64,
    /// Part of its amplitude that is there.
    followed: f64,
}

const NOWHERE: Place = Place {
    start: 0.0,
    alike: -1.0,
    followed: 0.0,
};

impl Course {
    fn new(start: f64, step: f64, positions: Vec<f64>) -> Course {
        let mean = positions.iter().sum::<f64>() / positions.len() as f64;
        let square = positions.iter().map(|x| (x - mean) * (x - mean)).sum();
        Course {
            start,
            step,
            positions,
            square,
        }
    }

    /// A stretch of a log of two samples or more.
    fn of_log(time: &[f64], position: &[f64], rate: f64, [start, end]: [f64; 2]) -> Course {
        let step = 1.0 / rate;
        let count = ((end - start) * rate) as usize + 1;
        let first = time.partition_point(|t| *t < start);
        let mut after = first.clamp(1, time.len() - 1);
        let positions = (0..count).map(|k| {
            let t = start + k as f64 * step;
            while after < time.len() - 1 && time[after] < t {
                after += 1;
            }
            let [a, b] = [time[after - 1], time[after]];
            let part = ((t - a) / (b - a)).clamp(0.0, 1.0);
            position[after - 1] + part * (position[after] - position[after - 1])
        });
        Course::new(start, step, positions.collect())
    }

    fn of(motion: &Motion, pace: f64, rate: f64) -> Course {
        Course::between(motion, [0.0, motion.duration()], pace, rate)
    }

    /// A part of a motion.
    fn between(motion: &Motion, [from, to]: [f64; 2], pace: f64, rate: f64) -> Course {
        let step = 1.0 / rate;
        let count = libm::ceil((to - from) / pace * rate) as usize + 1;
        let at = |k: usize| motion.at((from + pace * k as f64 * step).min(to)).position;
        Course::new(from, step, (0..count).map(at).collect())
    }

    /// How alike `other` is where it starts at a sample of this one, which may lie outside; less alike than anything where too
    /// little of it is within.
    fn alike(&self, other: &Course, at: isize) -> Place {
        let within: Range<usize> = {
            let from = (-at).max(0) as usize;
            let left = self.positions.len() as isize - at;
            from..other.positions.len().min(left.max(0) as usize)
        };
        if within.len() < 3 {
            return NOWHERE;
        }
        let mine = &self.positions[(at + within.start as isize) as usize..];
        let its = &other.positions[within.clone()];
        let n = its.len() as f64;
        let [mut x, mut r, mut xx, mut rr, mut xr] = [0.0; 5];
        // From their first values, so that nothing cancels far from 0.
        for (a, b) in mine.iter().zip(its) {
            let (a, b) = (a - mine[0], b - its[0]);
            x += a;
            r += b;
            xx += a * a;
            rr += b * b;
            xr += a * b;
        }
        let [xx, rr, xr] = [xx - x * x / n, rr - r * r / n, xr - x * r / n];
        let little =
            rr <= plan::MIN_COMMON_PART * other.square && xx <= plan::MIN_COMMON_PART * self.square;
        if little || !(xx > 0.0 && rr > 0.0) {
            return NOWHERE;
        }
        let followed = xr / rr;
        // Something larger is something else.
        if followed > plan::MAX_FOLLOWED {
            return NOWHERE;
        }
        Place {
            start: self.start + at as f64 * self.step,
            alike: xr / libm::sqrt(xx * rr),
            followed,
        }
    }

    /// From its lowest to its highest position, m (rad).
    fn size(&self) -> f64 {
        let high = self.positions.iter().copied().fold(f64::MIN, f64::max);
        high - self.positions.iter().copied().fold(f64::MAX, f64::min)
    }

    /// The sample at a time; there is none before the first, and after the last.
    fn sample(&self, t: f64) -> isize {
        libm::rint((t - self.start) / self.step) as isize
    }
}

/// Where a motion fits best into a log, wherever that is.
fn placed(log: &Course, motion: &Course) -> Place {
    let length = motion.positions.len() as isize;
    best(log, motion, -length..log.positions.len() as isize)
}

fn best(log: &Course, motion: &Course, starts: Range<isize>) -> Place {
    let places = starts.map(|at| log.alike(motion, at));
    places.fold(NOWHERE, |best, place| {
        if place.alike > best.alike {
            place
        } else {
            best
        }
    })
}

/// What became of each piece of a motion that starts about `start` in the log.
fn pieces(motion: &Motion, log: &Course, whole: [f64; 2], start: f64) -> Vec<Ran> {
    let spans: Vec<[f64; 2]> = (motion.timed())
        .map(|(from, atom)| [from, from + atom.duration()])
        .collect();
    let courses: Vec<Course> = (spans.iter())
        .map(|span| Course::between(motion, *span, 1.0, RATE))
        .collect();
    // Each where it is due, or much more alike, elsewhere.
    let alone: Vec<Place> = (spans.iter().zip(&courses))
        .map(|(span, piece)| {
            let due = span[0] + start;
            let near = around(log, piece, [due - NEAR, due + NEAR], false);
            if near.alike >= plan::MIN_CERTAIN_CORRELATION {
                return near;
            }
            let other = around(log, piece, [due - LATER, due + LATER], true);
            let better = 1.0 - other.alike < 0.25 * (1.0 - near.alike);
            match other.alike >= plan::MIN_CORRELATION_ELSEWHERE && better {
                true => other,
                false => near,
            }
        })
        .collect();
    // Where they are due first, since one piece may come several times, then the clearest; others only where they stand in their order
    // beside these.
    let mut shown: Vec<Option<Place>> = vec![None; spans.len()];
    let mut order: Vec<usize> = (0..spans.len()).collect();
    let elsewhere = |k: usize| (alone[k].start - spans[k][0] - start).abs() > NEAR + log.step;
    order.sort_by(|&a, &b| {
        let clearer = alone[b].alike.total_cmp(&alone[a].alike);
        elsewhere(a).cmp(&elsewhere(b)).then(clearer)
    });
    for k in order {
        let [low, high] = between(&shown, &spans, k);
        let place = alone[k];
        let duration = spans[k][1] - spans[k][0];
        if place.alike >= plan::MIN_CORRELATION
            && place.start >= low
            && place.start + duration <= high
        {
            shown[k] = Some(place);
        }
    }
    // One that is like another may still be between its neighbours.
    for k in 0..spans.len() {
        if shown[k].is_none() {
            let [low, high] = between(&shown, &spans, k);
            let last = high - (spans[k][1] - spans[k][0]);
            let place = around(log, &courses[k], [low, last.min(low + LATER)], true);
            shown[k] = (place.alike >= plan::MIN_CORRELATION_ELSEWHERE).then_some(place);
        }
    }
    // What is as large as something that is seen would be seen.
    let sizes: Vec<f64> = courses.iter().map(Course::size).collect();
    let seen = shown
        .iter()
        .zip(&sizes)
        .filter(|(place, _)| place.is_some());
    let least = seen.map(|(_, size)| *size).fold(f64::INFINITY, f64::min);
    (0..spans.len())
        .map(|k| {
            let duration = spans[k][1] - spans[k][0];
            let mut followed = shown[k].map_or(0.0, |place| place.followed);
            let begins = match shown[k] {
                Some(place) => place.start,
                None if sizes[k] >= least => {
                    match hardly_followed(&shown, &spans, log, sizes[k], k) {
                        Some((begins, part)) => {
                            followed = part;
                            begins
                        }
                        None => return MISSING,
                    }
                }
                // One that friction holds, or none: whether there is time for it between its neighbours tells.
                None => match held(&shown, &spans, &|i| sizes[i] < least, k) {
                    Some(begins) => begins,
                    None => return MISSING,
                },
            };
            // One that friction leads is found up to a tenth of a second beside where it is.
            let due = spans[k][0] + start;
            let at = match (begins - due).abs() <= NEAR + log.step {
                true => due,
                false => begins,
            };
            let inside = (at + duration).min(whole[1]) - at.max(whole[0]);
            let how = if inside <= 0.0 {
                return MISSING;
            } else if inside < duration - NEAR.min(0.1 * duration) {
                How::CutShort
            } else {
                How::Whole
            };
            Ran {
                how,
                start: Some(begins),
                followed,
            }
        })
        .collect()
}

/// When a piece starts of which friction or a slow loop leaves another shape, and the part of its size that is there; `None` where its
/// neighbours leave no time for it, or the axis hardly moves meanwhile.
fn hardly_followed(
    shown: &[Option<Place>],
    spans: &[[f64; 2]],
    log: &Course,
    size: f64,
    k: usize,
) -> Option<(f64, f64)> {
    let begins = held(shown, spans, &|_| true, k)?;
    let ends = begins + spans[k][1] - spans[k][0];
    let last = log.positions.len() as isize;
    let [from, to] = [begins, ends].map(|t| log.sample(t).clamp(0, last) as usize);
    let moved = Course::new(begins, log.step, log.positions[from..to].to_vec()).size() / size;
    (moved >= plan::MIN_FOLLOWED).then(|| (begins, moved.min(1.0)))
}

/// When a piece starts that does not show itself; `None` where there is no time for it, and for those beside it that do not
/// either, between the neighbours that do.
fn held(
    shown: &[Option<Place>],
    spans: &[[f64; 2]],
    is_small: &dyn Fn(usize) -> bool,
    k: usize,
) -> Option<f64> {
    let duration = |i: usize| spans[i][1] - spans[i][0];
    let before = (0..k).rev().find(|i| shown[*i].is_some());
    let after = (k + 1..spans.len()).find(|i| shown[*i].is_some());
    let gap = before.map_or(0, |i| i + 1)..after.unwrap_or(spans.len());
    let time = |range: Range<usize>| range.filter(|i| is_small(*i)).map(duration).sum::<f64>();
    let end = before.and_then(|i| Some(shown[i]?.start + duration(i)));
    let next = after.and_then(|i| Some(shown[i]?.start));
    match (end, next) {
        (Some(end), Some(next)) if next - end < plan::MIN_FREE_DURATION * time(gap.clone()) => None,
        (Some(end), _) => Some(end + time(gap.start..k)),
        (None, Some(next)) => Some(next - time(k..gap.end)),
        (None, None) => None,
    }
}

/// The stretch of the log between the neighbours of a piece that are found, a little wider.
fn between(shown: &[Option<Place>], spans: &[[f64; 2]], k: usize) -> [f64; 2] {
    let before = (0..k).rev().find_map(|i| {
        let duration = spans[i][1] - spans[i][0];
        Some(shown[i]?.start + duration)
    });
    let after = shown[k + 1..]
        .iter()
        .find_map(|place| Some((*place)?.start));
    [
        before.unwrap_or(f64::NEG_INFINITY) - plan::MAX_OVERLAP,
        after.unwrap_or(f64::INFINITY) + plan::MAX_OVERLAP,
    ]
}

/// Where a piece fits best among starts in a stretch of time; as a whole, or also where the log has but a part of it.
fn around(log: &Course, piece: &Course, [from, to]: [f64; 2], whole: bool) -> Place {
    let last = log.positions.len() as isize - piece.positions.len() as isize;
    let ends = match whole {
        true => [0, last],
        false => [
            -(piece.positions.len() as isize),
            log.positions.len() as isize,
        ],
    };
    let [from, to] = [from, to].map(|t| log.sample(t).clamp(ends[0], ends[1].max(ends[0])));
    best(log, piece, from..to + 1)
}

const MISSING: Ran = Ran {
    how: How::Missing,
    start: None,
    followed: 0.0,
};
