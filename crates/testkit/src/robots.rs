//! Simulated robots: rigid bodies other than the URDF says, LuGre friction in every joint, a controller, and what is logged.
//!
//! The rigid body is that of `stiction-rigid`, which is compared with Pinocchio; friction and controller are written out here.
//!
//! ```
//! use stiction_testkit::robots::{Arm, Motion, Names};
//!
//! let arm = Arm::pendulum(1);
//! let log = arm.record(Motion::Harmonic, 2.0, 1);
//! assert_eq!(log.time.len(), log.torque[1].len());
//! assert!(log.csv(Names::Numbered).starts_with("time,q1,q2,tau1,tau2\n"));
//! ```

use crate::random::Random;
use std::f64::consts::TAU;
use std::fmt::Write;
use stiction_rigid::consistency::{of_pseudo_inertia, pseudo_inertia};
use stiction_rigid::urdf::Kind;
use stiction_rigid::{Document, Robot, Workspace};

/// Period of the controller, s.
const PERIOD: f64 = 1e-3;
/// Steps of the simulation in one of them.
const FINE: usize = 4;
/// Bandwidth of the controller, Hz, and its damping ratio.
const CONTROLLER: (f64, f64) = (6.0, 0.8);
/// Standard deviation of the logarithm of a mass over that of the URDF, and of extents and places over the extent.
const MASS_SPREAD: f64 = 0.25;
const EXTENT_SPREAD: f64 = 0.15;
/// The same of friction and armature over those of the kind of robot.
const FRICTION_SPREAD: f64 = 0.2;
/// Part of a joint's range and speed that motions use.
const USED: f64 = 0.8;
/// Fundamental of harmonic motions, Hz, and how many harmonics they have.
const FOURIER: (f64, usize) = (0.1, 5);

/// Friction of a joint; N m and rad, or N and m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    /// Coulomb level without load.
    pub coulomb: f64,
    /// Static over Coulomb level.
    pub rise: f64,
    /// Stribeck velocity, rad/s.
    pub stribeck_velocity: f64,
    /// N m s/rad.
    pub viscous: f64,
    /// Constant torque.
    pub offset: f64,
    /// Deflection of the bristle at the Coulomb level, rad.
    pub presliding: f64,
    /// Coulomb level for each N m that the joint transmits to its link.
    pub per_torque: f64,
}

/// A robot; its true parameters are drawn by a seed and differ from those of its URDF.
#[derive(Clone, Debug)]
pub struct Arm {
    /// The URDF.
    pub urdf: &'static str,
    /// The robot of the URDF.
    pub robot: Robot,
    /// True inertial parameters, ten a body.
    pub parameters: Vec<f64>,
    /// True rotor inertias at the joints, kg m^2 or kg.
    pub armature: Vec<f64>,
    /// True friction.
    pub friction: Vec<Friction>,
    /// Standard deviation of the logged torques, N m or N.
    pub noise: Vec<f64>,
    /// Encoder steps, rad or m.
    pub encoder: Vec<f64>,
    /// Time constant of the current loops, s.
    pub lag: f64,
    /// Rate of the log, Hz, that divides 1000.
    pub rate: usize,
}

/// How the robot moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// A finite Fourier series of every joint (Swevers et al. 1997, doi 10.1109/70.631234).
    Harmonic,
    /// From place to place with all joints, and rests between.
    PointToPoint,
}

/// How the columns of a log are named.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Names {
    /// `q1`, `tau1`.
    Numbered,
    /// `joint_states.NAME.position [rad]`, `joint_states.NAME.effort [N*m]`.
    States,
}

/// What was logged.
#[derive(Clone, Debug, Default)]
pub struct Recording {
    /// Names of the joints.
    pub joints: Vec<String>,
    /// Whether each slides.
    pub linear: Vec<bool>,
    /// s.
    pub time: Vec<f64>,
    /// Positions as the encoders count them, by joint.
    pub position: Vec<Vec<f64>>,
    /// Torques that the currents stand for, by joint.
    pub torque: Vec<Vec<f64>>,
    /// Torques that the controller asked for, by joint.
    pub commanded: Vec<Vec<f64>>,
}

/// What the joints of a kind of robot are like: Coulomb and viscous friction, armature, presliding, encoder step.
type Joint = [f64; 5];

impl Arm {
    /// Six joints with the sizes and the friction of a common arm for ten kilograms.
    pub fn six(seed: u64) -> Self {
        let joints: [Joint; 6] = [
            [15.0, 15.0, 2.0, 2e-3, 1e-5],
            [16.0, 16.0, 2.0, 2e-3, 1e-5],
            [9.5, 9.5, 1.0, 2e-3, 1e-5],
            [3.0, 3.0, 0.2, 2e-3, 1e-5],
            [2.6, 2.6, 0.2, 2e-3, 1e-5],
            [2.5, 2.5, 0.2, 2e-3, 1e-5],
        ];
        Self::drawn(include_str!("robots/arm.urdf"), &joints, 0.02, seed)
    }

    /// A double pendulum on direct drives: its friction is a hundredth of its weight.
    pub fn pendulum(seed: u64) -> Self {
        let joints: [Joint; 2] = [
            [0.02, 0.004, 5e-4, 2e-3, 1e-5],
            [0.01, 0.002, 2e-4, 2e-3, 1e-5],
        ];
        Self::drawn(include_str!("robots/pendulum.urdf"), &joints, 0.2, seed)
    }

    /// A column that turns, a carriage that slides up an incline on it, and a hand that tilts.
    pub fn slider(seed: u64) -> Self {
        let joints: [Joint; 3] = [
            [4.0, 5.0, 0.5, 2e-3, 1e-5],
            [25.0, 60.0, 3.0, 1e-4, 1e-6],
            [1.5, 0.8, 0.05, 2e-3, 1e-5],
        ];
        Self::drawn(include_str!("robots/slider.urdf"), &joints, 0.02, seed)
    }

    /// `noise` is that of the torques as a part of the Coulomb levels.
    fn drawn(urdf: &'static str, joints: &[Joint], noise: f64, seed: u64) -> Self {
        let document = Document::parse(urdf).expect("own URDFs are sound");
        let robot = Robot::new(&document).expect("own URDFs are sound");
        let mut random = Random::new(seed ^ 0x726f_626f);
        let nominal = robot.parameters();
        let (ten, _) = nominal.as_chunks::<10>();
        let parameters = ten.iter().flat_map(|own| changed(own, &mut random));
        let parameters = parameters.collect();
        let mut near = |x: f64| x * (FRICTION_SPREAD * random.normal()).exp();
        let armature = joints.iter().map(|own| near(own[2])).collect();
        let friction: Vec<Friction> = joints
            .iter()
            .map(|[coulomb, viscous, _, presliding, _]| Friction {
                coulomb: near(*coulomb),
                rise: 1.0,
                stribeck_velocity: 0.05,
                viscous: near(*viscous),
                offset: 0.0,
                presliding: near(*presliding),
                per_torque: 0.0,
            })
            .collect();
        let offset = |own: &Friction| Friction {
            offset: 0.05 * own.coulomb * random.normal(),
            ..*own
        };
        let friction: Vec<Friction> = friction.iter().map(offset).collect();
        Self {
            urdf,
            robot,
            parameters,
            armature,
            noise: friction.iter().map(|own| noise * own.coulomb).collect(),
            friction,
            encoder: joints.iter().map(|own| own[4]).collect(),
            lag: 1e-3,
            rate: 100,
        }
    }

    /// The same carrying a load that its URDF does not have: a mass, kg, at a place in the frame of a link, m.
    ///
    /// # Panics
    /// If no joint moves the link.
    pub fn carrying(mut self, link: &str, mass: f64, at: [f64; 3]) -> Self {
        let mut loaded = self.robot.clone();
        let attached = loaded.attach(link, mass, at, [0.0; 6]);
        attached.expect("a link that a joint moves");
        let more = loaded.parameters();
        let both = more.iter().zip(self.robot.parameters());
        for (own, (more, before)) in self.parameters.iter_mut().zip(both) {
            *own += more - before;
        }
        self
    }

    /// A recording of so many seconds; the seed draws motion and noise.
    ///
    /// # Panics
    /// If the robot leaves its controller.
    pub fn record(&self, motion: Motion, seconds: f64, seed: u64) -> Recording {
        let n = self.robot.len();
        let mut random = Random::new(seed ^ 0x6d6f_7665);
        let path = Path::drawn(&self.robot, motion, seconds, &mut random);
        let mut out = Recording {
            joints: self.robot.joints().iter().map(|j| j.name.clone()).collect(),
            linear: self.robot.joints().iter().map(is_linear).collect(),
            ..Recording::default()
        };
        for columns in [&mut out.position, &mut out.torque, &mut out.commanded] {
            *columns = vec![Vec::new(); n];
        }
        let nominal = self.robot.parameters();
        let mut workspace = Workspace::new(&self.robot);
        let (mut q, mut v) = path.at(0.0);
        let gains = self.gains(&q, &nominal, &mut workspace);
        let mut gravity = vec![0.0; n];
        let mut eta = vec![0.0; n];
        let mut link = vec![0.0; n];
        let mut torque: Option<Vec<f64>> = None;
        let (mut sum, mut acceleration) = (vec![0.0; n], vec![0.0; n]);
        let still = vec![0.0; n];
        let h = PERIOD / FINE as f64;
        let follows = 1.0 - (-h / self.lag.max(f64::MIN_POSITIVE)).exp();
        for k in 0..(seconds / PERIOD) as usize {
            let t = k as f64 * PERIOD;
            let is_logged = k % (1000 / self.rate) == 0;
            if is_logged {
                out.time.push(t);
            }
            let read: Vec<f64> = q
                .iter()
                .zip(&self.encoder)
                .map(|(x, step)| (x / step).round() * step)
                .collect();
            let (at, speed) = path.at(t);
            self.robot.torque(
                [&read, &still, &still],
                &nominal,
                &mut workspace,
                &mut gravity,
            );
            let asked: Vec<f64> = (0..n)
                .map(|i| {
                    gravity[i] + gains[i].0 * (at[i] - read[i]) + gains[i].1 * (speed[i] - v[i])
                })
                .collect();
            let torque = torque.get_or_insert_with(|| asked.clone());
            for step in 0..FINE {
                for i in 0..n {
                    torque[i] += follows * (asked[i] - torque[i]);
                    // The torque of the first step makes the second difference of the positions about the one that was read.
                    if is_logged && step == 0 {
                        out.position[i].push(read[i]);
                        out.torque[i].push(torque[i] + self.noise[i] * random.normal());
                        out.commanded[i].push(asked[i]);
                    }
                    sum[i] = torque[i] - self.friction[i].step(v[i], link[i], &mut eta[i], h);
                }
                let motion = [&q[..], &v, &sum];
                let moves = self.robot.acceleration(
                    motion,
                    &self.parameters,
                    &self.armature,
                    &mut workspace,
                    &mut acceleration,
                );
                assert!(
                    moves && v.iter().all(|v| v.abs() < 100.0),
                    "diverged at {t} s"
                );
                for i in 0..n {
                    link[i] = sum[i] - self.armature[i] * acceleration[i];
                    v[i] += h * acceleration[i];
                    q[i] += h * v[i];
                }
            }
        }
        out
    }

    /// Stiffness and damping of the controller of each joint, by the mass that the URDF gives it.
    fn gains(&self, q: &[f64], nominal: &[f64], workspace: &mut Workspace) -> Vec<(f64, f64)> {
        let n = q.len();
        let mut mass = vec![0.0; n * n];
        self.robot.mass_matrix(q, nominal, workspace, &mut mass);
        let (bandwidth, damping) = CONTROLLER;
        let omega = TAU * bandwidth;
        let of_mass = |m: f64| (omega * omega * m, 2.0 * damping * omega * m);
        (0..n)
            .map(|i| of_mass(mass[i * n + i] + self.armature[i]))
            .collect()
    }
}

impl Friction {
    /// Friction over a step at a speed, by the exact solution of the bristle's equation at that speed; eta is its deflection over that
    /// at the Coulomb level.
    fn step(&self, v: f64, link: f64, eta: &mut f64, h: f64) -> f64 {
        let rise = 1.0 + (self.rise - 1.0) * (-(v / self.stribeck_velocity).powi(2)).exp();
        let end = rise * sign(v);
        *eta = end + (*eta - end) * (-v.abs() * h / (self.presliding * rise)).exp();
        (self.coulomb + self.per_torque * link.abs()) * *eta + self.viscous * v + self.offset
    }

    /// The same without load, of a joint that transmits this torque.
    pub fn at_load(&self, torque: f64) -> Self {
        Self {
            coulomb: self.coulomb + self.per_torque * torque,
            ..*self
        }
    }

    /// What an identification calls its parameters, and their values.
    pub fn truth(&self) -> [(&'static str, f64); 6] {
        [
            ("coulomb", self.coulomb),
            ("sigma2", self.viscous),
            ("offset", self.offset),
            ("sigma0", self.coulomb / self.presliding),
            ("static", self.coulomb * self.rise),
            ("coulomb_transmitted", self.per_torque),
        ]
    }
}

impl Recording {
    /// Its columns with their names, time first.
    pub fn columns(&self, names: Names) -> Vec<(String, Vec<f64>)> {
        let time = match names {
            Names::Numbered => "time",
            Names::States => "time [s]",
        };
        let mut out = vec![(time.to_string(), self.time.clone())];
        let both = [
            ("q", "position", &self.position),
            ("tau", "effort", &self.torque),
        ];
        for (short, long, columns) in both {
            for (i, column) in columns.iter().enumerate() {
                let name = match names {
                    Names::Numbered => format!("{short}{}", i + 1),
                    Names::States => {
                        let unit = match (self.linear[i], short) {
                            (true, "q") => "m",
                            (true, _) => "N",
                            (false, "q") => "rad",
                            (false, _) => "N*m",
                        };
                        format!("joint_states.{}.{long} [{unit}]", self.joints[i])
                    }
                };
                out.push((name, column.clone()));
            }
        }
        out
    }

    /// As a file.
    pub fn csv(&self, names: Names) -> String {
        csv(&self.columns(names))
    }
}

/// Columns with their names as a file.
///
/// # Panics
/// If the columns differ in length.
pub fn csv(columns: &[(String, Vec<f64>)]) -> String {
    let names: Vec<&str> = columns.iter().map(|(name, _)| name.as_str()).collect();
    let mut text = names.join(",") + "\n";
    for row in 0..columns.first().map_or(0, |(_, values)| values.len()) {
        for (i, (_, values)) in columns.iter().enumerate() {
            let comma = if i == 0 { "" } else { "," };
            write!(text, "{comma}{:.7}", values[row]).expect("a text takes more");
        }
        text.push('\n');
    }
    text
}

/// Where the joints are to be.
enum Path {
    /// Centre, then sine and cosine amplitudes of each harmonic, by joint.
    Harmonic(Vec<(f64, Vec<[f64; 2]>)>),
    /// Start, end and places, in the order of time.
    Moves(Vec<(f64, f64, Vec<f64>)>),
}

impl Path {
    fn drawn(robot: &Robot, motion: Motion, seconds: f64, random: &mut Random) -> Self {
        let ranges: Vec<[f64; 3]> = robot
            .joints()
            .iter()
            .map(|joint| {
                let limit = joint.limit;
                let (low, high) = (limit.lower.unwrap_or(-1.0), limit.upper.unwrap_or(1.0));
                let speed = limit.velocity.unwrap_or(1.0);
                [0.5 * (low + high), USED * 0.5 * (high - low), USED * speed]
            })
            .collect();
        match motion {
            Motion::Harmonic => {
                Path::Harmonic(ranges.iter().map(|range| series(range, random)).collect())
            }
            Motion::PointToPoint => {
                let place = |random: &mut Random| -> Vec<f64> {
                    let within = |[centre, most, _]: &[f64; 3]| {
                        centre + most * (2.0 * random.uniform() - 1.0)
                    };
                    ranges.iter().map(within).collect()
                };
                let mut moves = vec![(0.0, 0.0, place(random))];
                while moves.last().is_some_and(|(_, end, _)| *end < seconds) {
                    let (_, before, from) = &moves[moves.len() - 1];
                    let to = place(random);
                    let start = before + random.between(0.2, 0.8);
                    // The fastest instant of the fifth-order move.
                    let steps = from.iter().zip(&to).zip(&ranges);
                    let times = steps.map(|((a, b), range)| 1.875 * (b - a).abs() / range[2]);
                    let fastest = times.fold(0.5, f64::max);
                    moves.push((start, start + fastest * random.between(1.0, 2.5), to));
                }
                Path::Moves(moves)
            }
        }
    }

    /// Positions and speeds.
    fn at(&self, t: f64) -> (Vec<f64>, Vec<f64>) {
        match self {
            Path::Harmonic(joints) => joints
                .iter()
                .map(|(centre, parts)| {
                    let mut sum = (*centre, 0.0);
                    for (k, [a, b]) in parts.iter().enumerate() {
                        let omega = TAU * FOURIER.0 * (k + 1) as f64;
                        let (sine, cosine) = (omega * t).sin_cos();
                        sum.0 += a * sine + b * cosine;
                        sum.1 += omega * (a * cosine - b * sine);
                    }
                    sum
                })
                .unzip(),
            Path::Moves(moves) => {
                let next = moves.partition_point(|(start, ..)| *start <= t);
                let (start, end, to) = &moves[next.max(1) - 1];
                let from = &moves[next.max(2) - 2].2;
                let length = (end - start).max(f64::MIN_POSITIVE);
                let u = ((t - start) / length).clamp(0.0, 1.0);
                let s = u.powi(3) * (10.0 - 15.0 * u + 6.0 * u * u);
                let rate = 30.0 * (u * (1.0 - u)).powi(2) / length;
                let both = from.iter().zip(to);
                both.map(|(a, b)| (a + (b - a) * s, (b - a) * rate)).unzip()
            }
        }
    }
}

/// A series within range and speed.
fn series([centre, most, speed]: &[f64; 3], random: &mut Random) -> (f64, Vec<[f64; 2]>) {
    let mut parts: Vec<[f64; 2]> = (1..=FOURIER.1)
        .map(|k| [0; 2].map(|_| random.normal() / (k as f64).sqrt()))
        .collect();
    let path = Path::Harmonic(vec![(0.0, parts.clone())]);
    let (mut far, mut fast) = (0.0_f64, 0.0_f64);
    for k in 0..1000 {
        let (q, v) = path.at(k as f64 * 1e-3 / FOURIER.0);
        far = far.max(q[0].abs());
        fast = fast.max(v[0].abs());
    }
    let scale = (most / far).min(speed / fast);
    for amplitude in parts.as_flattened_mut() {
        *amplitude *= scale;
    }
    (*centre, parts)
}

/// Another body: of another mass, and with its mass moved by a linear map and a shift, so that a body can have the parameters.
fn changed(parameters: &[f64; 10], random: &mut Random) -> [f64; 10] {
    let pseudo = pseudo_inertia(parameters);
    let mass = pseudo[3][3];
    let heavier = (MASS_SPREAD * random.normal()).exp();
    let extent = ((pseudo[0][0] + pseudo[1][1] + pseudo[2][2]) / mass).sqrt();
    let mut map = [[0.0; 4]; 4];
    for (i, row) in map.iter_mut().enumerate().take(3) {
        for (j, x) in row.iter_mut().enumerate() {
            let size = if j == 3 { 0.5 * extent } else { 1.0 };
            *x = EXTENT_SPREAD * size * random.normal() + f64::from(u8::from(i == j));
        }
    }
    map[3][3] = 1.0;
    let mut out = [[0.0; 4]; 4];
    for (i, row) in out.iter_mut().enumerate() {
        for (j, x) in row.iter_mut().enumerate() {
            for (k, inner) in pseudo.iter().enumerate() {
                for (l, value) in inner.iter().enumerate() {
                    *x += heavier * map[i][k] * value * map[j][l];
                }
            }
        }
    }
    of_pseudo_inertia(&out)
}

fn is_linear(joint: &stiction_rigid::Joint) -> bool {
    joint.kind == Kind::Prismatic
}

/// -1, 0 or 1.
fn sign(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { x.signum() }
}
