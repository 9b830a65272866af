//! The axis under its controller, and what is logged of it.

use super::fine::Fine;
use super::motion::SetPoint;
use super::{Controller, Machine, Motion, Setup, World};
use crate::random::Random;
use std::f64::consts::TAU;

/// Part of the fine instants of a sample that jitter moves it by, at most.
const JITTER: f64 = 0.2;
/// What a limited drive gives, in parts of the largest force that would be asked for without.
const LIMIT: f64 = 0.8;
/// Most that the integrator of a limited drive holds, in parts of what the drive gives.
const WOUND_UP: f64 = 20.0;
/// How long after the end of a motion a brake takes hold, and how long before the next it lets go, s.
const BRAKED: [f64; 2] = [0.06, 0.04];
/// One row in this many is missing.
const DROPPED: f64 = 200.0;

/// A log, SI units.
#[derive(Clone, Debug)]
pub struct Recording {
    /// Time stamps, s.
    pub time: Vec<f64>,
    /// Positions as the encoder counts them, m (rad).
    pub position: Option<Vec<f64>>,
    /// Velocity, where the log has that instead, m/s (rad/s).
    pub velocity: Option<Vec<f64>>,
    /// Force, positive towards positive positions, N (N m).
    pub force: Vec<f64>,
    /// What else was measured: name, unit, values.
    pub beside: Vec<(&'static str, &'static str, Vec<f64>)>,
}

impl Recording {
    /// As a file that a drive might write.
    pub fn to_csv(&self, kind: &str) -> String {
        let rotary = kind == "rotary";
        let (length, force) = if rotary { ("rad", "N*m") } else { ("m", "N") };
        let (name, motion) = match (&self.position, &self.velocity) {
            (Some(x), _) => (format!("position [{length}]"), x),
            (None, Some(v)) => (format!("velocity [{length}/s]"), v),
            (None, None) => unreachable!("a recording has one of the two"),
        };
        let mut text = format!("time [s],{name},force [{force}]\n");
        for ((t, x), u) in self.time.iter().zip(motion).zip(&self.force) {
            text.push_str(&format!("{t:.7},{x:e},{u:.6}\n"));
        }
        text
    }
}

/// Simulates a machine along a motion in a world. The seed sets the noise and the phase of the encoder counts.
pub fn record(machine: &Machine, motion: Motion, setup: impl Into<Setup>, seed: u64) -> Recording {
    let setup = setup.into();
    let world = setup.world;
    let path = motion.of(machine);
    let h = 1.0 / machine.rate;
    let mut random = Random::new(seed ^ 0x6c6f_6773);
    let mut axis = Fine::of(machine, &path, setup);
    let mut cascade = Cascade::new(machine, setup.controller);
    let phase = random.uniform();
    let counted = |x: f64| ((x / machine.count + phase).floor() - phase + 0.5) * machine.count;

    let (mut time, mut position, mut force) = (Vec::new(), Vec::new(), Vec::new());
    let mut velocity = Vec::new();
    let mut lagged = 0.0;
    let mut hidden = Hidden::of(machine, world);
    let most = match world {
        World::Limited => {
            let free = Setup {
                world: World::Faithful,
                ..setup
            };
            let free = record(machine, motion, free, seed).force;
            let largest = free.iter().fold(0.0_f64, |most, u| most.max(u.abs()));
            (LIMIT * largest).max(1.05 * machine.static_friction)
        }
        _ => f64::INFINITY,
    };
    for (k, point) in path.iter().enumerate() {
        let read = counted(axis.position());
        cascade.integral = cascade.integral.clamp(-WOUND_UP * most, WOUND_UP * most);
        let brakes = world == World::Brake && is_braked(&path, k, machine.rate);
        let command = match brakes {
            true => cascade.let_go(),
            false => cascade.force(point.position, point.velocity, point.acceleration, read),
        };
        time.push(k as f64 * h);
        position.push(read);
        force.push(command);
        lagged += (1.0 - (-0.25_f64).exp()) * (axis.velocity() - lagged);
        velocity.push(lagged);
        let acts = match world {
            World::Driven(drive) => k.checked_sub(drive.periods).map_or(0.0, |then| force[then]),
            _ => command.clamp(-most, most),
        };
        match brakes {
            true => axis.hold(h),
            false => axis.advance(acts + hidden.next(h, &mut random), h),
        }
    }
    if let World::Filtered(time) = world {
        let left = (-h / time).exp();
        let mut behind = 0.0;
        for u in &mut force {
            behind = *u + (behind - *u) * left;
            *u = behind;
        }
    }
    if let World::Averaged(rows) = world {
        let whole = force.clone();
        for (k, u) in force.iter_mut().enumerate() {
            let some = &whole[k.saturating_sub(rows - 1)..=k];
            *u = some.iter().sum::<f64>() / some.len() as f64;
        }
    }
    for u in &mut force {
        *u += machine.noise * random.normal();
    }
    let mut log = Recording {
        time,
        position: Some(position),
        velocity: None,
        force,
        beside: Vec::new(),
    };
    spoil(&mut log, velocity, machine, world, &mut random);
    log
}

/// Whether a brake holds at a sample: from some time after the reference has come to rest until shortly before it moves on.
fn is_braked(path: &[SetPoint], sample: usize, rate: f64) -> bool {
    let [after, before] = BRAKED.map(|time| (time * rate) as usize);
    let around = sample.saturating_sub(after)..(sample + before).min(path.len());
    path[around].iter().all(|point| point.velocity == 0.0)
}

/// A random force on the axis that no log shows, with a memory of 5 ms and constant power.
pub(super) struct Hidden {
    /// Its root mean square, N.
    size: f64,
    now: f64,
}

impl Hidden {
    pub fn of(machine: &Machine, world: World) -> Self {
        let size = match world {
            World::HiddenForce => 0.1 * machine.coulomb,
            _ => 0.0,
        };
        Hidden { size, now: 0.0 }
    }

    /// The force over the next `h` seconds, N.
    pub fn next(&mut self, h: f64, random: &mut Random) -> f64 {
        let memory = (-h / 5e-3).exp();
        self.now = memory * self.now + (1.0 - memory * memory).sqrt() * random.normal();
        self.size * self.now
    }
}

/// What the logging makes of it.
fn spoil(
    log: &mut Recording,
    velocity: Vec<f64>,
    machine: &Machine,
    world: World,
    random: &mut Random,
) {
    let n = log.time.len();
    match world {
        World::Late(samples) => {
            log.force = (0..n)
                .map(|k| log.force[k.saturating_sub(samples)])
                .collect();
        }
        World::Held => {
            let x = log.position.take();
            log.position = x.map(|x| (0..n).map(|k| x[k - k % 8]).collect());
        }
        World::LaggedVelocity => {
            // Resolved to a hundred-thousandth of the top speed, as drives give it.
            let step = 1e-5 * machine.top_speed;
            log.position = None;
            log.velocity = Some(velocity.iter().map(|v| (v / step).round() * step).collect());
        }
        World::Saturation => {
            let most = 0.9 * machine.static_friction;
            log.force.iter_mut().for_each(|u| *u = u.clamp(-most, most));
        }
        World::CoarseForce => {
            let step = 0.2 * machine.coulomb;
            log.force
                .iter_mut()
                .for_each(|u| *u = (*u / step).round() * step);
        }
        World::Dropped => dropped(log, machine, random),
        World::Driven(drive) => {
            let rows = |values: &[f64]| values.iter().step_by(drive.every).copied().collect();
            log.time = rows(&log.time);
            log.force = rows(&log.force);
            log.position = log.position.as_deref().map(rows);
        }
        _ => {}
    }
}

/// Leaves rows out, and moves the instants of the others beside their stamps.
fn dropped(log: &mut Recording, machine: &Machine, random: &mut Random) {
    let n = log.time.len();
    let kept: Vec<usize> = (0..n)
        .filter(|_| random.uniform() * DROPPED > 1.0)
        .collect();
    let pick = |values: &[f64]| kept.iter().map(|&k| values[k]).collect::<Vec<f64>>();
    let h = 1.0 / machine.rate;
    log.position = log.position.take().map(|x| {
        let moved = |k: usize, beside: f64| {
            let to = if beside < 0.0 {
                k.saturating_sub(1)
            } else {
                (k + 1).min(n - 1)
            };
            let between = x[k] + beside.abs() * (x[to] - x[k]);
            (between / machine.count).round() * machine.count
        };
        kept.iter()
            .map(|&k| moved(k, JITTER * (2.0 * random.uniform() - 1.0)))
            .collect()
    });
    log.force = pick(&log.force);
    log.time = kept.iter().map(|&k| k as f64 * h).collect();
}

/// The loops; the speed from differences of counts behind a filter of first order.
struct Cascade {
    h: f64,
    controller: Controller,
    /// Of the acceleration fed forward, kg.
    mass: f64,
    position_gain: f64,
    speed_gain: f64,
    integral_gain: f64,
    filter: f64,
    integral: f64,
    speed: f64,
    before: Option<f64>,
}

impl Cascade {
    fn new(machine: &Machine, controller: Controller) -> Self {
        let omega = TAU * machine.bandwidth;
        let h = 1.0 / machine.rate;
        let (mass, position_gain, integral_gain) = match controller {
            Controller::Feedforward => (machine.mass, 0.25, 0.25 * omega),
            Controller::PPi => (0.0, 0.25, 0.25 * omega),
            Controller::Pid => (0.0, 1.0 / 3.0, omega * omega / 27.0),
        };
        Cascade {
            h,
            controller,
            mass,
            position_gain: position_gain * omega,
            speed_gain: machine.mass * omega,
            integral_gain: machine.mass * omega * integral_gain,
            filter: 1.0 - (-h * 5.0 * omega).exp(),
            integral: 0.0,
            speed: 0.0,
            before: None,
        }
    }

    /// No force, and nothing kept of what was asked for.
    fn let_go(&mut self) -> f64 {
        self.integral = 0.0;
        self.speed = 0.0;
        self.before = None;
        0.0
    }

    fn force(&mut self, x: f64, v: f64, a: f64, read: f64) -> f64 {
        let difference = (read - self.before.replace(read).unwrap_or(read)) / self.h;
        self.speed += self.filter * (difference - self.speed);
        let forward = if self.controller == Controller::PPi {
            0.0
        } else {
            v
        };
        let error = self.position_gain * (x - read) + forward - self.speed;
        let summed = if self.controller == Controller::Pid {
            x - read
        } else {
            error
        };
        self.integral += self.h * self.integral_gain * summed;
        self.speed_gain * error + self.integral + self.mass * a
    }
}
