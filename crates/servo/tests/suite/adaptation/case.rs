//! Random axes whose friction is not what was identified, and the loop around their compensator.

use rand::{Rng, RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use std::f64::consts::TAU;
use stiction_friction::compensator::{
    Adaptation, Channel, Channels, Compensator, Friction, Input, Levels, Settings, Source,
    Watchdog, Wave,
};
use stiction_friction::{Damping, Direction, LuGre, Shape, Stribeck};
use stiction_servo::axis::{Axis, AxisSettings, Correction, Sample};
use stiction_servo::cascade::Cascade;
use stiction_servo::controller::Controller;
use stiction_servo::drive::Drive;
use stiction_servo::encoder::Encoder;
use stiction_servo::feedforward::Feedforward;
use stiction_servo::integrator::Mid;
use stiction_servo::levelled::{Depending, Depends, Levelled};
use stiction_servo::load::scaled;
use stiction_servo::metrics::Tracking;
use stiction_servo::motion::{Limits, Move, Moves, Sine};
use stiction_servo::path::Reference;
use stiction_servo::plant::Plant;
use stiction_servo::trajectory::Trajectory;

/// Cycles before the factors are judged: twenty reversals.
const CYCLES: usize = 10;
/// Cycles over which a drift goes: friction changes by some percent in each.
const DRIFT: usize = 40;
/// Cycles in which the error is judged, and those where that is close: where an axis jumps at its reversals, the largest error of
/// a cycle scatters by up to 2 % of that without compensation with exact parameters already.
const JUDGED_CYCLES: usize = 4;
const CLOSELY_JUDGED_CYCLES: usize = 40;
/// Time in which a watchdog learns its five windows of 2 s, whatever their strokes, and switches off, s.
const WATCHED_FOR: f64 = 40.0;
/// Changes of a drifting axis in a cycle.
const STEPS: usize = 20;

/// How the axis differs from what was identified.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Change {
    Nothing,
    /// Factors on the dry and the viscous part.
    Apart([f64; 2]),
    /// The same, reached over [`DRIFT`] cycles.
    Drift([f64; 2]),
    /// Of the level along the stroke: amplitude, periods in a stroke, phase.
    Wave([f64; 3]),
    /// From one end of the stroke to the other.
    Ramp([f64; 2]),
    /// Height, and place as a part of the stroke.
    Bump([f64; 2]),
    /// Factors on static friction, Stribeck velocity, stiffness.
    Static(f64),
    Velocity(f64),
    Stiffness(f64),
    /// Factor on the mass.
    Load(f64),
}

/// The kinds of changes, in the order in which [`Case::random`] numbers them.
pub const KINDS: [&str; 11] = [
    "nothing",
    "level and viscous friction",
    "drift of both",
    "wave along the stroke",
    "ramp along the stroke",
    "bump on the stroke",
    "static friction",
    "Stribeck velocity",
    "stiffness",
    "mass",
    "viscous friction",
];

#[derive(Clone, Debug)]
pub struct Case {
    law: LuGre<f64>,
    mass: f64,
    change: Change,
    rate: f64,
    bandwidth: f64,
    count: f64,
    noise: f64,
    seed: u64,
    motion: Motion,
    /// The compensator is told differences of the reference in counts instead of its velocity.
    counted: bool,
    /// Cycles in which the error is judged.
    judged: usize,
}

#[derive(Clone, Copy, Debug)]
enum Motion {
    Sine {
        amplitude: f64,
        frequency: f64,
    },
    Moves {
        distance: f64,
        limits: Limits,
        dwell: f64,
    },
}

/// What the compensator assumes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Assumed {
    Identified,
    Adapted,
    /// As it is by default: the watchdog learns first, and speaks.
    Watched,
    Exact,
    Nothing,
}

/// A cycle of the reference, over and over.
enum Cycle {
    Sine(Sine),
    Moves(Moves),
}

impl Cycle {
    fn at(&self, t: f64) -> Reference {
        match self {
            Cycle::Sine(sine) => sine.at(t),
            Cycle::Moves(moves) => moves.at(t % moves.duration()),
        }
    }
}

/// An axis in motion, which asks for a force at each sample.
pub struct Running {
    axis: Axis<Levelled<LuGre<f64>>, Depending<Mid>>,
    case: Case,
    cycle: Cycle,
    preview: f64,
    samples: usize,
    next: usize,
    command: f64,
    reference: (Reference, f64),
    kept: Vec<Sample>,
}

fn logarithmic(random: &mut impl Rng, from: f64, to: f64) -> f64 {
    from * (to / from).powf(random.random_range(0.0..1.0))
}

/// Raised cosine to the fourth power: a bump over a third of its period.
const BUMP: [f64; 5] = [
    35.0 / 128.0,
    56.0 / 128.0,
    28.0 / 128.0,
    8.0 / 128.0,
    1.0 / 128.0,
];

impl Case {
    pub fn random(kind: usize, seed: u64) -> Self {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
        let random = &mut random;
        let mass = logarithmic(random, 0.5, 100.0);
        // Friction as an acceleration of the mass, m/s^2.
        let coulomb = mass * logarithmic(random, 0.3, 5.0);
        let both = Direction {
            coulomb,
            static_friction: coulomb * random.random_range(1.0..2.0),
            stribeck_velocity: logarithmic(random, 1e-3, 2e-2),
            viscous: coulomb * random.random_range(0.0..4.0),
        };
        let presliding = logarithmic(random, 3e-6, 3e-5);
        let stiffness = coulomb / presliding;
        let damping = 2.0 * random.random_range(0.1..0.8) * (stiffness * mass).sqrt();
        let curve = Stribeck::symmetric(Shape::Gaussian, both, 0.0).unwrap();
        let law = LuGre::new(stiffness, Damping::Capped(damping), curve).unwrap();
        let motion = if random.random_bool(0.5) {
            Motion::Sine {
                amplitude: logarithmic(random, 1e-3, 5e-2),
                frequency: logarithmic(random, 0.2, 2.0),
            }
        } else {
            let velocity = logarithmic(random, 1e-2, 0.3);
            Motion::Moves {
                distance: velocity * random.random_range(0.3..1.0),
                limits: Limits {
                    velocity,
                    acceleration: velocity * random.random_range(5.0..20.0),
                    jerk: velocity * 500.0,
                },
                dwell: random.random_range(0.05..0.5),
            }
        };
        let mut case = Case {
            law,
            mass,
            change: Change::Nothing,
            rate: [1000.0, 2000.0, 4000.0][random.random_range(0..3)],
            bandwidth: random.random_range(20.0..60.0),
            count: logarithmic(random, 1e-8, 2e-7),
            noise: 1e-8,
            seed,
            motion,
            counted: false,
            judged: JUDGED_CYCLES,
        };
        let mut within = |size: f64| random.random_range(-size..size);
        let [a, b] = [within(1.0), within(1.0)];
        let part = 0.5 * (within(1.0) + 1.0);
        case.change = match kind {
            0 => Change::Nothing,
            1 => Change::Apart([1.0 + 0.4 * a, 1.0 + 0.4 * b]),
            2 => Change::Drift([1.0 + 0.4 * a, 1.0 + 0.4 * b]),
            3 => Change::Wave([0.3 * a.abs(), 2.25 + 1.75 * b, TAU * part]),
            4 => Change::Ramp([1.0 + 0.3 * a, 1.0 + 0.3 * b]),
            5 => Change::Bump([0.3 * a, part]),
            // Static friction is at least that of Coulomb.
            6 => Change::Static((1.0 + 0.3 * a).max(coulomb / both.static_friction)),
            7 => Change::Velocity(1.0 + 0.3 * a),
            8 => Change::Stiffness(1.0 + 0.3 * a),
            9 => Change::Load(1.0 + 0.3 * a),
            10 => Change::Apart([1.0, 1.0 + 0.4 * b]),
            _ => unreachable!(),
        };
        case.counted = random.random_bool(0.5);
        case
    }

    /// Whether exact parameters are among those that are found.
    pub fn is_known(&self) -> bool {
        matches!(
            self.change,
            Change::Nothing | Change::Apart(_) | Change::Drift(_)
        )
    }

    /// The same axis, judged for longer.
    pub fn closely(&self) -> Self {
        Case {
            judged: CLOSELY_JUDGED_CYCLES,
            ..self.clone()
        }
    }

    /// Cycles before those in which the error is judged.
    fn before(&self, assumed: Assumed) -> usize {
        let watched = match assumed {
            Assumed::Watched => WATCHED_FOR / self.cycle() + 1.0,
            _ => 0.0,
        };
        let changing = match self.change {
            Change::Drift(_) => DRIFT,
            _ => CYCLES,
        };
        watched.ceil() as usize + changing
    }

    /// Duration of a cycle, s.
    fn cycle(&self) -> f64 {
        match self.motion {
            Motion::Sine { frequency, .. } => 1.0 / frequency,
            Motion::Moves { .. } => self.moves().duration(),
        }
    }

    fn moves(&self) -> Moves {
        let Motion::Moves {
            distance,
            limits,
            dwell,
        } = self.motion
        else {
            unreachable!("a sine has no moves");
        };
        let there_and_back = [distance, -distance].map(|distance| Move { distance, dwell });
        Moves::new(&there_and_back, limits).unwrap()
    }

    /// Where the stroke begins, and how long it is, m.
    fn stroke(&self) -> [f64; 2] {
        match self.motion {
            Motion::Sine { amplitude, .. } => [-amplitude, 2.0 * amplitude],
            Motion::Moves { distance, .. } => [0.0, distance],
        }
    }

    /// The law of the axis where a part of the change has come about.
    fn truth(&self, part: f64) -> LuGre<f64> {
        let of = |law: &LuGre<f64>, [level, viscous]: [f64; 2]| {
            let whole = scaled(law, level).unwrap();
            let sigma2 = law.curve().positive().viscous;
            with(&whole, |side| side.viscous = viscous * sigma2)
        };
        match self.change {
            Change::Apart(factors) => of(&self.law, factors),
            Change::Drift(factors) => of(&self.law, factors.map(|f| 1.0 + part * (f - 1.0))),
            Change::Bump([height, _]) => of(&self.law, [1.0 + height * BUMP[0], 1.0]),
            Change::Static(f) => with(&self.law, |side| side.static_friction *= f),
            Change::Velocity(f) => with(&self.law, |side| side.stribeck_velocity *= f),
            Change::Stiffness(f) => LuGre::new(
                f * self.law.stiffness(),
                self.law.damping(),
                *self.law.curve(),
            )
            .unwrap(),
            _ => self.law,
        }
    }

    /// The level along the stroke.
    fn depends(&self) -> Depends {
        let [start, length] = self.stroke();
        let mut levels = Levels::default();
        let mut reference = 0.0;
        let wave = |rate: f64, size: f64, phase: f64| Wave {
            rate,
            whole: true,
            sine: size * phase.cos(),
            cosine: size * phase.sin(),
        };
        match self.change {
            Change::Wave([size, periods, phase]) => {
                let wave = wave(TAU * periods / length, size, phase);
                for waves in &mut levels.waves {
                    waves[0] = wave;
                }
            }
            Change::Ramp([from, to]) => {
                levels.position = [(to - from) / length; 2];
                // Where the level is 1, on the stroke or beyond it.
                reference = match to == from {
                    true => start,
                    false => start + length * (1.0 - from) / (to - from),
                };
            }
            Change::Bump([height, place]) => {
                let size = height / (1.0 + height * BUMP[0]);
                for (k, part) in BUMP.iter().enumerate().skip(1) {
                    let rate = TAU * k as f64 / length;
                    let at = rate * (start + place * length);
                    let wave = wave(rate, size * part, TAU / 4.0 - at);
                    for waves in &mut levels.waves {
                        waves[k - 1] = wave;
                    }
                }
            }
            _ => {}
        }
        let channel = |reference: f64| Channel {
            reference,
            range: [-1e9, 1e9],
            turns: false,
        };
        Depends {
            levels,
            channels: Channels {
                position: channel(reference),
                ..Channels::default()
            },
            ..Depends::default()
        }
    }

    fn drive(&self) -> Drive {
        Drive {
            peak_current: f64::INFINITY,
            rated_current: f64::INFINITY,
            ..Drive::linear_motor(1.0 / self.rate)
        }
    }

    /// The compensator, if there is one.
    pub fn compensator(&self, assumed: Assumed) -> Option<Compensator<f64>> {
        let period = 1.0 / self.rate;
        let law = match assumed {
            Assumed::Nothing => return None,
            // In the middle of what is judged.
            Assumed::Exact => self.truth(1.0 - 0.5 * self.judged as f64 / self.all(assumed) as f64),
            _ => self.law,
        };
        let settings = Settings {
            gain: 1.0,
            adaptation: [Assumed::Adapted, Assumed::Watched]
                .contains(&assumed)
                .then(|| Adaptation {
                    mass: self.mass,
                    ..Adaptation::default()
                }),
            watchdog: (assumed == Assumed::Watched).then(Watchdog::default),
            // Limits are settings, not parameters: those of what was identified, also with exact parameters.
            ..Settings::for_law(&Friction::LuGre(self.law), period)
        };
        Some(Compensator::new(Friction::LuGre(law), Source::Reference, settings).unwrap())
    }

    fn all(&self, assumed: Assumed) -> usize {
        self.before(assumed) + self.judged
    }

    pub fn start(&self, assumed: Assumed) -> Running {
        let mass = match self.change {
            Change::Load(f) => f * self.mass,
            _ => self.mass,
        };
        let drive = self.drive();
        let settings = AxisSettings {
            plant: Plant::new(mass, Levelled::unchanged(self.truth(0.0))).unwrap(),
            drive,
            encoder: Encoder::new(self.count).unwrap(),
            position_noise: self.noise,
            cogging: None,
            disturbance: None,
            controller: Controller::Cascade(
                Cascade::tuned(self.mass, self.bandwidth, f64::MAX).unwrap(),
            ),
            feedforward: Feedforward::default(),
            rate: self.rate,
            substeps: (1e4 / self.rate) as u32,
            seed: self.seed,
        };
        let integrator = Depending::new(Mid::new(1).unwrap(), self.depends());
        let cycles = self.all(assumed) as f64;
        Running {
            axis: Axis::new(settings, integrator).unwrap(),
            cycle: match self.motion {
                Motion::Sine {
                    amplitude,
                    frequency,
                } => Cycle::Sine(Sine::new(amplitude, frequency, cycles + 1.0).unwrap()),
                Motion::Moves { .. } => Cycle::Moves(self.moves()),
            },
            preview: drive.preview(1.0 / self.rate),
            samples: (cycles * self.cycle() * self.rate) as usize,
            next: 0,
            command: 0.0,
            reference: Default::default(),
            kept: Vec::new(),
            case: self.clone(),
        }
    }

    /// Largest error of a cycle with a compensator in Rust, and whether its watchdog has switched off.
    pub fn run(&self, assumed: Assumed) -> (f64, bool) {
        let mut compensator = self.compensator(assumed);
        let peak = self.start(assumed).run(&mut |input| {
            let compensator = compensator.as_mut();
            compensator.map_or(0.0, |compensator| compensator.step(input))
        });
        let tripped = compensator.is_some_and(|c| c.state().watch.tripped());
        (peak, tripped)
    }
}

fn with(law: &LuGre<f64>, change: impl Fn(&mut Direction<f64>)) -> LuGre<f64> {
    let curve = law.curve();
    let [positive, negative] = [curve.positive(), curve.negative()].map(|side| {
        let mut side = *side;
        change(&mut side);
        side
    });
    let curve = Stribeck::new(curve.shape(), positive, negative, curve.offset()).unwrap();
    LuGre::new(law.stiffness(), law.damping(), curve).unwrap()
}

impl Running {
    /// Largest error of a cycle, with forces that are given for what the compensator is told.
    pub fn run(mut self, force: &mut dyn FnMut(Input<f64>) -> f64) -> f64 {
        while let Some(input) = self.ask() {
            self.give(force(input));
        }
        self.peak()
    }

    /// What the compensator is told at the next sample; `None` at the end.
    fn ask(&mut self) -> Option<Input<f64>> {
        if self.next == self.samples {
            return None;
        }
        let period = 1.0 / self.case.rate;
        if let Change::Drift(_) = self.case.change {
            let each = (self.case.cycle() * self.case.rate) as usize / STEPS;
            if self.next.is_multiple_of(each) {
                let part = self.next as f64 / self.samples as f64;
                self.axis
                    .set_law(Levelled::unchanged(self.case.truth(part)));
            }
        }
        let time = self.next as f64 * period;
        let now = self.cycle.at(time);
        let ahead = self.cycle.at(time + self.preview * period).velocity;
        self.reference = (now, ahead);
        let count = |time: f64| {
            let position = self.cycle.at(time + (self.preview - 0.5) * period).position;
            (position / self.case.count).round() * self.case.count
        };
        Some(Input {
            reference_velocity: match self.case.counted {
                true => (count(time + period) - count(time)) / period,
                false => ahead,
            },
            tracking_error: now.position - self.axis.measure(),
            enable: true,
            drive_force: self.command,
            learn: true,
            ..Input::default()
        })
    }

    fn give(&mut self, force: f64) {
        let correction = Correction {
            force,
            ..Correction::default()
        };
        let (now, ahead) = self.reference;
        let sample = self.axis.step(now, ahead, correction);
        self.command = sample.command;
        if self.next + self.judged() * self.in_cycle() >= self.samples {
            self.kept.push(sample);
        }
        self.next += 1;
    }

    fn judged(&self) -> usize {
        self.case.judged
    }

    /// Samples of a cycle.
    fn in_cycle(&self) -> usize {
        (self.case.cycle() * self.case.rate).round() as usize
    }

    /// Largest error of a cycle, in the mean of the last cycles.
    fn peak(&self) -> f64 {
        let cycles = self.kept.chunks_exact(self.in_cycle());
        cycles.map(|cycle| Tracking::of(cycle).peak).sum::<f64>() / self.judged() as f64
    }
}
