//! Pieces, axes, choice, and the whole motion simulated beside hand-made ones.

use super::PlanOptions;
use super::assume::Given;
use super::band::band;
use super::judged::{Judged, judged, refused, repeated};
use super::outcome::Planned;
use super::possible::{beyond, no_piece, peaks, tells_nothing};
use super::wanted;
use crate::error::Error;
use rayon::prelude::*;
use stiction_files::Axis;
use stiction_files::plan::{
    AbortEntry, AtomEntry, ComparedEntry, ExpectedEntry, InputEntry, LargestEntry, LimitsEntry,
    PlanFile, RangeEntry, RigEntry, SCHEMA,
};
use stiction_friction::ParamError;
use stiction_parameters::LawKind;
use stiction_plan::{
    Aim, Atom, Belief, Candidate, Choice, Entry, HandMade, Limits, Motion, Nameplate, Peaks,
    Spread, Subject, Table, dictionary, hand_made, nested, places, select,
};
use stiction_policy::interval;
use stiction_search::{Control, Observer, Progress, Shared, Stage};

/// Axes on which pieces are simulated, and whole motions, at least and at most.
const AXES: [usize; 2] = [8, 48];
const FRESH_AXES: [usize; 2] = [8, 16];
/// Control periods that are simulated in pieces, and in whole motions: they bound the time that a plan takes.
const PERIODS: f64 = 50e6;
const FRESH_PERIODS: f64 = 7e6;
/// Longest motion that needs no design and is simulated whole, s.
const LONGEST_HAND_MADE: f64 = 60.0;
/// Simulations of a motion on an axis.
const PHASES: f64 = 2.0;
/// Realised root mean square deviations over predicted ones, on simulated logs: predictions are given times this.
const TRUST: f64 = 1.25;
/// From a deviation to half a 95 % interval.
const HALF_INTERVAL: f64 = 1.959_963_984_540_054;
/// Most times that a motion which breaks a limit on an axis is slowed down, and by how much more than it went beyond.
const SLOWED: usize = 6;
const MORE: f64 = 0.98;
/// Pieces faster than this part of the limit are slowed down first.
const FAST: f64 = 0.5;

/// Plans.
pub(super) fn design(
    axis: &Axis,
    given: Given,
    inputs: Vec<InputEntry>,
    options: &PlanOptions,
    observer: &mut dyn Observer,
) -> Result<Option<Planned>, Error> {
    let longest = options.longest();
    let plate = &given.nameplate;
    let (limits, rig) = (&plate.limits, &plate.rig);
    let names = given.subject.names();
    let mut pieces = dictionary(limits, rig);
    if given.subject.has_places() {
        pieces.extend(places(limits, rig));
    }
    if let Some(yields) = given.belief.as_ref().and_then(Belief::yields) {
        pieces.extend(nested(limits, rig, yields));
    }
    let atoms: Vec<Atom> = pieces
        .into_iter()
        .filter(|atom| atom.duration() <= longest)
        .collect();
    if atoms.is_empty() {
        return Err(no_piece(axis));
    }
    let periods = rig.rate * rig.periods() as f64 * PHASES;
    let seed = seed(options.seed);
    let time: f64 = atoms.iter().map(Atom::duration).sum();
    let axes = given.draw(fewer(AXES, PERIODS, periods * time), seed);
    let Some(table) = table(atoms, &axes, plate, observer)? else {
        return Ok(None);
    };
    let mut simulated: f64 = table.entries.iter().flatten().map(|e| e.simulated).sum();
    let all = peaks(&table.entries);
    let table = table.safe(limits);
    if table.atoms.is_empty() {
        return Err(beyond(axis, &given, &all));
    }
    let kinds = HandMade::ALL.len() as f64 + 1.0;
    let fresh = fewer(FRESH_AXES, FRESH_PERIODS, periods * longest * kinds);
    // Other axes than those that the pieces were chosen on.
    let axes_fresh = given.draw(fresh, seed ^ OTHER_AXES);
    let mut tried = None;
    let mut interrupted = false;
    let mut evaluations = 0;
    for time in wanted::times(&options.wants, longest) {
        let choice = chosen(&table, &given.aim, time, observer);
        evaluations += choice.evaluations;
        if choice.pieces.is_empty() {
            continue;
        }
        let motion = Motion::new(ordered(&table, &choice, &given.subject)).map_err(refused)?;
        let stopped = choice.interrupted;
        interrupted |= stopped;
        if stopped && tried.is_some() {
            // What was found for a shorter time stands.
            break;
        }
        // What was found is only worth what a simulation says of it, so the first is simulated to its end whoever stops.
        let mut onward = Onward {
            observer,
            stops: tried.is_some(),
        };
        let watch = Shared::new(&mut onward, fresh);
        let designed = within(motion, &axes_fresh, &given, &watch)?;
        let Some(designed) = designed else {
            interrupted = true;
            break;
        };
        let enough = wanted::are_met(&options.wants, &designed.expected, &names);
        tried = Some((time, designed));
        if enough || stopped {
            break;
        }
    }
    if tried.is_none() && observer.progress(&Progress::of(Stage::Search, 1.0)) != Control::Continue
    {
        return Ok(None);
    }
    let Some((time, designed)) = tried else {
        return Err(tells_nothing(axis, longest));
    };
    let watch = Shared::new(observer, fresh * HandMade::ALL.len());
    let mut all = vec![("designed", designed)];
    // A long one is a shorter one again and again.
    let times = (time / LONGEST_HAND_MADE).ceil().max(1.0);
    for kind in HandMade::ALL {
        let made = hand_made(kind, limits, rig, time / times).map_err(refused)?;
        let Some(made) = made else { continue };
        match repeated(made, times as u32, &axes_fresh, &given, &watch)? {
            Some(found) => all.push((kind.name(), found)),
            None => interrupted = true,
        }
    }
    simulated += all.iter().map(|(_, j)| j.simulated).sum::<f64>();
    let compared: Vec<ComparedEntry> = all
        .iter()
        .map(|(name, j)| compared(name, j, limits))
        .collect();
    let whole: Vec<Peaks> = all.iter().map(|(_, j)| j.expected.peaks).collect();
    let finalists = all.into_iter().filter(|(_, j)| j.keeps(limits));
    // One that grants the wishes before one that does not.
    let order = |judged: &Judged| {
        let lacks = !wanted::are_met(&options.wants, &judged.expected, &names);
        (lacks, judged.expected.score)
    };
    let best = finalists.min_by(|(_, a), (_, b)| {
        let (a, b) = (order(a), order(b));
        a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
    });
    let Some((name, best)) = best else {
        return Err(beyond(axis, &given, &whole));
    };
    let largest = best.expected.peaks;
    let file = PlanFile {
        schema: SCHEMA.into(),
        version: env!("CARGO_PKG_VERSION").into(),
        name: axis.name.clone(),
        kind: given.motion.to_string(),
        seed: options.seed,
        status: if interrupted {
            "interrupted"
        } else {
            "complete"
        }
        .into(),
        motion: name.into(),
        duration: best.motion.duration(),
        start: given.start,
        axes: [axes.len(), fresh],
        simulated,
        evaluations,
        trust: TRUST,
        asymmetric: given.subject.asymmetric,
        law: given.subject.elements.map(|elements| {
            let kind = if elements.falls {
                LawKind::Gms
            } else {
                LawKind::MaxwellSlip
            };
            kind.name().into()
        }),
        elements: given.subject.elements.map(|elements| elements.count),
        assumed: given.assumed.clone(),
        inputs,
        limits: LimitsEntry {
            stroke: limits.stroke,
            end_zone: limits.end_zone,
            speed: limits.speed,
            acceleration: limits.acceleration,
            jerk: limits.jerk,
            rated_force: limits.rated_force,
            peak_force: limits.peak_force,
        },
        rig: RigEntry {
            rate: given.logged.rate,
            resolution: given.logged.encoder_step,
            force_noise: given.logged.force_noise,
            bandwidth: given.logged.bandwidth(),
        },
        prior: ranges(&given),
        parameter: expected(&best, &given.subject),
        wanted: wanted::entries(&options.wants, &best.expected, &names),
        compared,
        largest: LargestEntry {
            position: largest.position,
            speed: largest.speed,
            force: largest.force,
            force_rms: largest.rms_force(),
            following_error: largest.error,
            saturated: largest.saturated,
        },
        abort: AbortEntry {
            following_error: 2.0 * largest.error,
            force: (1.2 * largest.force).min(limits.peak_force),
            speed: (1.5 * largest.speed).min(1.1 * limits.speed),
        },
        warning: given.warnings.clone(),
        atom: (best.motion.timed())
            .map(|(start, atom)| AtomEntry::of(start, atom))
            .collect(),
    };
    Ok(Some(Planned {
        band: band(&best.motion, &axes_fresh, plate),
        file,
        motion: best.motion,
        expected: best.expected,
        options: options.clone(),
        given,
        carried: Vec::new(),
    }))
}

/// What tells the seed of the axes for whole motions from that of the axes for pieces.
const OTHER_AXES: u32 = 0x9e37_79b9;

fn seed(seed: u64) -> u32 {
    (seed ^ (seed >> 32)) as u32
}

/// As many axes as the budget allows, of which each takes so many periods.
fn fewer([least, most]: [usize; 2], budget: f64, each: f64) -> usize {
    ((budget / each) as usize).clamp(least, most)
}

/// Every piece on every axis, in parallel; `None` where the observer stopped it.
fn table(
    atoms: Vec<Atom>,
    axes: &[Candidate],
    plate: &Nameplate,
    observer: &mut dyn Observer,
) -> Result<Option<Table>, Error> {
    let n = axes.len();
    let watch = Shared::new(observer, atoms.len() * n);
    let limits = (&plate.limits, &plate.rig);
    let entries: Vec<Option<Result<Entry, ParamError>>> = (0..atoms.len() * n)
        .into_par_iter()
        .map(|k| {
            if watch.is_stopped() {
                return None;
            }
            let entry = Entry::of_piece(&atoms[k / n], &axes[k % n], limits, k as u32);
            watch.one_more();
            watch.go_on();
            Some(entry)
        })
        .collect();
    let Some(entries) = entries.into_iter().collect::<Option<Vec<_>>>() else {
        return Ok(None);
    };
    let entries = entries
        .into_iter()
        .collect::<Result<Vec<_>, _>>()
        .map_err(refused)?;
    let entries = entries.chunks(n).map(<[Entry]>::to_vec).collect();
    Ok(Some(Table { atoms, entries }))
}

/// Tells an observer, and stops for it or does not.
struct Onward<'o> {
    observer: &'o mut dyn Observer,
    stops: bool,
}

impl Observer for Onward<'_> {
    fn progress(&mut self, progress: &Progress) -> Control {
        match self.observer.progress(progress) {
            Control::Stop if self.stops => Control::Stop,
            _ => Control::Continue,
        }
    }
}

/// Scores on all threads.
struct Threads;

impl Spread for Threads {
    fn map(&self, count: usize, score: &(dyn Fn(usize) -> f64 + Sync)) -> Vec<f64> {
        (0..count).into_par_iter().map(score).collect()
    }
}

fn chosen(table: &Table, aim: &Aim, time: f64, observer: &mut dyn Observer) -> Choice {
    let mut go_on = |fraction: f64| {
        observer.progress(&Progress::of(Stage::Search, fraction)) == Control::Continue
    };
    select(table, aim, time, &Threads, &mut go_on)
}

/// The chosen pieces by rising speed, so that the axis shows first what it does slowly.
///
/// Before them those that go as far as any, the slowest that do: a fit of Maxwell-slip elements leaves out what was before the axis has
/// been everywhere.
fn ordered(table: &Table, choice: &Choice, subject: &Subject) -> Vec<Atom> {
    let mut atoms: Vec<Atom> = choice.pieces.iter().map(|p| table.atoms[*p]).collect();
    atoms.sort_by(|a, b| a.extremes().speed.total_cmp(&b.extremes().speed));
    if subject.elements.is_none() {
        return atoms;
    }
    for side in [0, 1] {
        let reach = |atom: &Atom| atom.extremes().position[side].abs();
        let far = atoms.iter().map(reach).fold(0.0, f64::max);
        if let Some(at) = atoms.iter().position(|atom| reach(atom) >= AS_FAR * far) {
            let first = atoms.remove(at);
            atoms.insert(0, first);
        }
    }
    atoms
}

/// Part of the way of the farthest piece at which another goes as far.
const AS_FAR: f64 = 0.97;

/// The motion simulated on every axis, slowed down until it keeps within the limits on all of them.
fn within(
    mut motion: Motion,
    axes: &[Candidate],
    given: &Given,
    watch: &Shared,
) -> Result<Option<Judged>, Error> {
    let limits = &given.nameplate.limits;
    let mut round = 0;
    loop {
        let Some(found) = judged(motion, axes, given, watch)? else {
            return Ok(None);
        };
        if found.keeps(limits) || round == SLOWED {
            return Ok(Some(found));
        }
        let peaks = &found.expected.peaks;
        let part = |limit: f64, found: f64| if found > limit { limit / found } else { 1.0 };
        let by = MORE
            * part(limits.speed, peaks.speed)
                .min(part(limits.rated_force, peaks.rms_force()))
                .min(part(limits.stroke[1], peaks.position[1]))
                .min(part(-limits.stroke[0], -peaks.position[0]));
        let slowed = found.motion.atoms().iter().map(|atom| {
            let is_fast = atom.extremes().speed > FAST * limits.speed;
            // Where it is not the fast ones, it is any.
            if is_fast || round >= SLOWED / 2 {
                atom.scaled(by)
            } else {
                *atom
            }
        });
        motion = Motion::new(slowed.collect()).map_err(refused)?;
        round += 1;
    }
}

/// The ranges of the axes that are thought possible.
fn ranges(given: &Given) -> Vec<RangeEntry> {
    let entry = |name: &str, range: [f64; 2]| RangeEntry {
        name: name.into(),
        range,
    };
    let (subject, limits) = (&given.subject, &given.nameplate.limits);
    let of_nameplate = |term: usize| {
        let (name, range) = subject.term_range(term, limits)?;
        Some(entry(&name, range))
    };
    let terms = 0..subject.terms.len();
    let Some(belief) = &given.belief else {
        let own = given.nameplate.ranges().into_iter();
        let own = own.map(|(name, range)| entry(name, range));
        let between = subject.direction_ranges().into_iter();
        let between = between.map(|(name, range)| entry(&name, range));
        return own
            .chain(between)
            .chain(terms.filter_map(of_nameplate))
            .collect();
    };
    let names = given.subject.names();
    let factors = belief.factors();
    let values = names.iter().zip(belief.axis.values()).zip(&factors);
    let of_elements = belief.coulomb_of_elements();
    let each = values.enumerate().map(|(i, ((name, value), by))| {
        let excess = belief.axis.excess();
        if of_elements == Some(i) {
            return entry(
                "static over coulomb",
                [1.0 + excess / by, 1.0 + excess * by],
            );
        }
        // Its factor is that of what it has above Coulomb friction.
        match name.strip_prefix("static") {
            Some(side) => {
                let of = belief.axis.direction(usize::from(side == "_neg"));
                let excess = of.static_friction / of.coulomb - 1.0;
                let range = [1.0 + excess / by, 1.0 + excess * by];
                entry(&format!("static{side} over coulomb{side}"), range)
            }
            None => entry(name, [value / by, value * by]),
        }
    });
    // What the first identification does not know of the terms is what the nameplate allows.
    let terms = terms.filter_map(|k| match belief.range(k) {
        Some(range) => Some(entry(&subject.terms[k].name.to_string(), range)),
        None => of_nameplate(k),
    });
    each.chain(terms).collect()
}

fn percent(deviation: f64) -> f64 {
    100.0 * TRUST * deviation
}

/// Half of a 95 % interval, percent, of a predicted deviation; no identification states less than its least.
pub(super) fn half_interval(deviation: f64) -> f64 {
    (HALF_INTERVAL * percent(deviation)).max(100.0 * interval::MIN_HALF_WIDTH)
}

/// What is expected of each parameter.
fn expected(found: &Judged, subject: &Subject) -> Vec<ExpectedEntry> {
    let names = subject.names();
    let entry = |(parameter, name): (usize, String)| {
        let deviation = |part: f64| found.expected.quantile(parameter, part);
        let at = |part: f64| percent(deviation(part));
        let term = parameter.checked_sub(subject.first_term());
        let term = term.and_then(|term| subject.terms.get(term));
        // A term in parts of another parameter may be as small as it likes.
        let interval = |part: f64| match term {
            None => half_interval(deviation(part)),
            Some(_) => HALF_INTERVAL * at(part),
        };
        ExpectedEntry {
            name,
            of: term.map(|_| "coulomb".into()),
            at: term.map(|term| term.reach),
            std_percent: at(0.5),
            std90_percent: at(0.9),
            interval_percent: interval(0.5),
            interval90_percent: interval(0.9),
        }
    };
    names.into_iter().enumerate().map(entry).collect()
}

fn compared(name: &str, found: &Judged, limits: &Limits) -> ComparedEntry {
    let at = |part: f64| half_interval(found.expected.worst(part));
    ComparedEntry {
        name: name.into(),
        duration: found.motion.duration(),
        interval_percent: at(0.5),
        interval90_percent: at(0.9),
        keeps_limits: found.keeps(limits),
    }
}
