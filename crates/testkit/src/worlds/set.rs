//! Three sets of logs, so that nothing is tested, and nothing shown, on what its constants were chosen on.

use super::machine::drawn::{FAST, Kind, REPORT, TEST};
use super::{Cogging, Compliance, Controller, Machine, Motion, Recording, Setup, World, record};
use crate::random::Random;
use std::ops::Range;

/// Machines, motions and seeds of their own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Set {
    /// Constants are chosen on it: stage, screw and joint near one point each.
    Tuning,
    /// Tests assert on it: other kinds of axes, drawn anew for every log.
    Test,
    /// Documents show it: again others. Nothing is chosen or asserted on it.
    Report,
}

/// One log of a set.
#[derive(Clone, Debug)]
pub struct Case {
    /// The row of a table that it belongs to.
    pub world: String,
    /// Whether an identification has nothing to name there.
    pub is_as_assumed: bool,
    /// Kind of axis.
    pub axis: &'static str,
    /// The axis.
    pub machine: Machine,
    /// How it moves.
    pub motion: Motion,
    /// What else it has.
    pub setup: Setup,
    /// Of noise and counts; in the drawn sets of machine and motion, too.
    pub seed: u64,
}

impl Case {
    /// Simulates it.
    pub fn record(&self) -> Recording {
        record(&self.machine, self.motion, self.setup, self.seed)
    }

    /// What an identification should find, by name.
    pub fn truth(&self) -> Vec<(&'static str, f64)> {
        self.setup.truth(&self.machine)
    }

    /// Lowers the bandwidth of the loops, Hz, to one at which this machine is stable, as whoever sets it up does.
    fn slow_down(&mut self, most: f64) {
        let machine = &mut self.machine;
        machine.bandwidth = machine.bandwidth.min(most);
        machine.fast = machine.fast.min(FAST * machine.bandwidth);
    }

    fn on_a_spring(&mut self, spring: Compliance) {
        self.setup.compliance = Some(spring);
        let part = if spring.is_read_at_load { 10.0 } else { 3.0 };
        self.slow_down(spring.frequency / part);
    }
}

/// Changes a log that is as assumed.
type Change = fn(&mut Case, &mut Random);

/// What is common in practice: name, whether nothing is to be named, and what it is. In all sets.
const PRACTICE: [(&str, bool, Change); 10] = [
    ("current loop", false, current_loop),
    ("encoder steps", true, encoder_steps),
    ("P-PI", true, |case, _| {
        case.setup.controller = Controller::PPi;
    }),
    ("PID", true, |case, _| {
        case.setup.controller = Controller::Pid;
    }),
    ("few strokes", true, few_strokes),
    ("cogging of any pitch", false, |case, random| {
        case.setup.cogging = Some(Cogging {
            amplitude: case.machine.coulomb * random.between(0.03, 0.3),
            pitch: case.machine.top_speed * random.between(0.01, 0.5),
        });
    }),
    ("50 to 150 Hz, encoder on motor", false, |case, random| {
        case.on_a_spring(Compliance {
            frequency: random.between(50.0, 150.0),
            damping: random.between(0.01, 0.05),
            load: random.between(0.2, 0.7),
            friction: 0.0,
            is_read_at_load: false,
        });
    }),
    ("50 to 150 Hz, encoder on load", false, |case, random| {
        case.on_a_spring(Compliance {
            frequency: random.between(50.0, 150.0),
            damping: random.between(0.05, 0.1),
            load: random.between(0.2, 0.7),
            friction: 0.0,
            is_read_at_load: true,
        });
    }),
    // Most of mass and friction are the carriage's.
    ("belt", false, |case, random| {
        case.on_a_spring(Compliance {
            frequency: random.between(12.0, 40.0),
            damping: random.between(0.03, 0.1),
            load: random.between(0.5, 0.85),
            friction: random.between(0.4, 0.9),
            is_read_at_load: false,
        });
    }),
    ("several of these", false, |case, random| {
        current_loop(case, random);
        encoder_steps(case, random);
        if random.uniform() < 0.5 {
            few_strokes(case, random);
        }
        case.setup.controller = match random.uniform() < 0.5 {
            true => Controller::PPi,
            false => Controller::Pid,
        };
    }),
];

/// What else differs in the drawn sets.
const DRAWN: [(&str, bool, Change); 21] = [
    ("as assumed", true, |_, _| {}),
    ("position", false, |case, _| {
        case.setup.world = World::Position
    }),
    ("position wave", false, |case, _| {
        case.setup.world = World::PositionWave
    }),
    ("warm-up", false, |case, _| case.setup.world = World::WarmUp),
    ("backlash", false, |case, _| {
        case.setup.world = World::Backlash
    }),
    ("hidden force", false, |case, _| {
        case.setup.world = World::HiddenForce
    }),
    ("exponent 1", false, |case, _| {
        case.setup.world = World::Exponent
    }),
    ("Maxwell-slip", false, |case, _| {
        case.setup.world = World::MaxwellSlip
    }),
    ("late force", false, |case, random| {
        case.setup.world = World::Late(random.between(1.0, 41.0) as usize);
    }),
    ("held position", false, |case, _| {
        case.setup.world = World::Held
    }),
    ("lagged velocity", false, |case, _| {
        case.setup.world = World::LaggedVelocity
    }),
    ("saturation", false, |case, _| {
        case.setup.world = World::Saturation
    }),
    ("coarse force", false, |case, _| {
        case.setup.world = World::CoarseForce
    }),
    ("dropped, jitter", false, |case, _| {
        case.setup.world = World::Dropped
    }),
    ("filtered force", false, |case, random| {
        case.setup.world = World::Filtered(random.between(5e-4, 5e-3));
    }),
    ("mean over rows", false, |case, random| {
        case.setup.world = World::Averaged(random.between(2.0, 17.0) as usize);
    }),
    ("rows left out", false, |case, _| {
        case.setup.world = super::Drive::behind(0, 0.0, 2);
    }),
    ("spring", false, |case, _| case.setup.world = World::Spring),
    ("weight", false, |case, _| case.setup.world = World::Weight),
    ("limited drive", false, |case, _| {
        case.setup.world = World::Limited
    }),
    ("brake", false, |case, _| {
        case.setup.world = World::Brake;
        case.motion = Motion::Moves(case.seed);
    }),
];

fn current_loop(case: &mut Case, random: &mut Random) {
    case.setup.current_loop = random.between(3e-4, 1e-3);
}

/// A third to a tenth of the travel at which the axis breaks away, in the loop as in the log.
fn encoder_steps(case: &mut Case, random: &mut Random) {
    let breaks_away = case.machine.static_friction / case.machine.sigma0;
    case.machine.count = breaks_away / random.between(3.0, 10.0);
}

fn few_strokes(case: &mut Case, random: &mut Random) {
    case.motion = Motion::Strokes((1e9 * random.uniform()) as u64);
}

impl Set {
    /// All of them.
    pub const ALL: [Set; 3] = [Set::Tuning, Set::Test, Set::Report];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Set::Tuning => "tuning",
            Set::Test => "test",
            Set::Report => "report",
        }
    }

    /// Its logs, by world, axis, motion and seed. In *tuning* a seed has every world on every axis and motion, in the others
    /// every world on every axis, each with a machine and a motion of its own.
    pub fn cases(self, seeds: Range<u64>) -> Vec<Case> {
        match self {
            Set::Tuning => tuning(seeds),
            Set::Test => drawn(seeds, &TEST, 1, |seed| {
                [
                    Motion::Commissioned(seed),
                    Motion::Places(seed),
                    Motion::Sweep(seed),
                ]
            }),
            Set::Report => drawn(seeds, &REPORT, 2, |seed| {
                [
                    Motion::Speeds(seed),
                    Motion::Sines(seed),
                    Motion::Moves(seed),
                ]
            }),
        }
    }
}

fn tuning(seeds: Range<u64>) -> Vec<Case> {
    let mut worlds: Vec<(String, Setup, Option<Change>)> = World::ALL
        .into_iter()
        .chain(World::DRIVES)
        .chain(World::FILTERS)
        .chain(World::OTHERS)
        .map(|world| (world.name(), world.into(), None))
        .collect();
    let practice =
        PRACTICE.map(|(name, _, change)| (name.into(), World::Faithful.into(), Some(change)));
    worlds.extend(practice);
    let is_as_assumed =
        |name: &str| name == World::Faithful.name() || PRACTICE.iter().any(|p| p.0 == name && p.1);
    let mut cases = Vec::new();
    for (number, (name, setup, change)) in (0..).zip(&worlds) {
        for (axis, _) in Machine::all(0) {
            for motion in Motion::ALL {
                for seed in seeds.clone() {
                    let all = Machine::all(seed).into_iter();
                    let machine = all.filter(|m| m.0 == axis).map(|m| m.1);
                    cases.extend(machine.map(|machine| {
                        let mut case = Case {
                            world: name.clone(),
                            is_as_assumed: is_as_assumed(name),
                            axis,
                            machine,
                            motion,
                            setup: *setup,
                            seed,
                        };
                        if let Some(change) = change {
                            let key = (seed << 8 | number) << 8 | motion.name().len() as u64;
                            change(&mut case, &mut Random::new(key));
                        }
                        case
                    }));
                }
            }
        }
    }
    cases
}

/// Every log with a seed of its own, which is that of no other set.
fn drawn<const N: usize>(
    seeds: Range<u64>,
    kinds: &[Kind],
    set: u64,
    motions: fn(u64) -> [Motion; N],
) -> Vec<Case> {
    let mut cases = Vec::new();
    for (number, (name, is_as_assumed, change)) in (0..).zip(DRAWN.into_iter().chain(PRACTICE)) {
        for (place, kind) in (0..).zip(kinds) {
            for of_set in seeds.clone() {
                let seed = 1_000_000_000 * set + 10_000 * of_set + 100 * number + place;
                let mut random = Random::new(seed ^ 0x6d61_6368);
                let motion = motions(seed)[(number + place + of_set) as usize % N];
                let mut case = Case {
                    world: name.into(),
                    is_as_assumed,
                    axis: kind.name,
                    machine: kind.drawn(&mut random),
                    motion,
                    setup: World::Faithful.into(),
                    seed,
                };
                change(&mut case, &mut random);
                cases.push(case);
            }
        }
    }
    cases
}
