//! A fleet that is not what the test takes it for: scatter with heavy tails (Student's t with 3 degrees of freedom), wandering with
//! two memories and a week in it, Arrhenius temperature of another strength on each machine, a load that is not logged, intervals
//! that differ from log to log, one to three logs a day and days without any.

use stiction_drift::Point;

pub const DAY: f64 = 86_400.0;
/// What is followed on each machine: a name and how uncertain it is beside Coulomb friction.
pub const NUMBERS: [(&str, f64, f64); 6] = [
    ("coulomb", 20.0, 1.0),
    ("static", 28.0, 1.5),
    ("sigma2", 60.0, 1.5),
    ("sigma0", 1.2e5, 3.0),
    ("stribeck_velocity", 0.005, 4.0),
    ("mass", 10.0, 0.7),
];

/// How large the parts of the noise of Coulomb friction are, as parts of it.
#[derive(Clone, Copy)]
pub struct World {
    /// Median deviation of an estimate, as its interval says.
    pub interval: f64,
    /// Scale of the scatter between logs: 1.7 times that is its standard deviation.
    pub scatter: f64,
    /// Standard deviation of the wandering.
    pub wandering: f64,
    /// Fall for each degree at 20 degrees Celsius.
    pub temperature: f64,
    /// Spread of the load's part.
    pub load: f64,
}

/// What happens to Coulomb friction.
#[derive(Clone, Copy)]
pub enum Event {
    Nothing,
    /// On that day, as a part of it.
    Step(f64, f64),
    /// From that day on within 30 days.
    Creep(f64, f64),
}

pub struct Machine {
    /// A course for each of [`NUMBERS`].
    pub courses: Vec<Vec<Point>>,
}

pub struct Dice(u64);

impl Dice {
    pub fn new(seed: u64) -> Self {
        let mut dice = Dice(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1);
        for _ in 0..8 {
            let _ = dice.uniform();
        }
        dice
    }

    /// xorshift64* (Vigna 2016): other numbers than those of the library.
    pub fn uniform(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        ((self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 11) as f64 + 0.5) / (1u64 << 53) as f64
    }

    /// By the polar method (Marsaglia 1964).
    pub fn normal(&mut self) -> f64 {
        loop {
            let (x, y) = (2.0 * self.uniform() - 1.0, 2.0 * self.uniform() - 1.0);
            let square = x * x + y * y;
            if square < 1.0 && square > 0.0 {
                return x * libm::sqrt(-2.0 * libm::log(square) / square);
            }
        }
    }

    /// Student's t with 3 degrees of freedom.
    pub fn heavy(&mut self) -> f64 {
        let squares: f64 = (0..3).map(|_| self.normal()).map(|x| x * x).sum();
        self.normal() / libm::sqrt(squares / 3.0)
    }
}

/// Logs of a machine over so many days.
pub fn machine(world: &World, days: u32, event: Event, seed: u64) -> Machine {
    let mut dice = Dice::new(seed);
    let per_day = 1 + (dice.uniform() * 1.5) as u32;
    let mut times = Vec::new();
    for day in 0..days {
        for shift in 0..per_day {
            if dice.uniform() > 0.05 {
                times.push(
                    DAY * (f64::from(day)
                        + (f64::from(shift) + 0.5 * dice.uniform()) / f64::from(per_day)),
                );
            }
        }
    }
    let season = std::f64::consts::TAU * dice.uniform();
    let hall = 20.0 + 4.0 * dice.normal();
    let mut weather = 0.0;
    let climate: Vec<(f64, f64)> = times
        .iter()
        .map(|time| {
            weather = 0.8 * weather + 0.6 * 2.0 * dice.normal();
            let year = 5.0 * libm::sin(season + std::f64::consts::TAU * time / (365.0 * DAY));
            let day = 2.0 * libm::sin(std::f64::consts::TAU * time / DAY);
            (hall + year + day + weather, dice.normal())
        })
        .collect();
    let courses = NUMBERS.iter().enumerate().map(|(n, &(_, usual, by))| {
        let level = usual * (1.0 + 0.1 * dice.normal());
        let strength =
            world.temperature * (1.0 + 0.2 * dice.normal()) * if n == 5 { 0.0 } else { 1.0 };
        let phase = std::f64::consts::TAU * dice.uniform();
        let (mut short, mut long) = (dice.normal(), dice.normal());
        let mut before = 0.0;
        let points = times.iter().zip(&climate).map(|(&time, &(celsius, load))| {
            for (slow, memory) in [(&mut short, 2.0 * DAY), (&mut long, 15.0 * DAY)] {
                let stays = libm::exp(-(time - before) / memory);
                *slow = stays * *slow + libm::sqrt(1.0 - stays * stays) * dice.normal();
            }
            before = time;
            let week = libm::sin(phase + std::f64::consts::TAU * time / (7.0 * DAY));
            let wandering = world.wandering * (0.6 * short + 0.7 * long + 0.54 * week);
            // Of an activation energy: as strong as that at 20 degrees, weaker above.
            let arrhenius = strength * 293.15 * 293.15 * (1.0 / (273.15 + celsius) - 1.0 / 293.15);
            let slow = by.min(1.5) * wandering + arrhenius + world.load * load;
            let std = world.interval * by * libm::exp(0.4 * dice.normal());
            let new = world.scatter * by * dice.heavy() + std * dice.normal();
            let day = time / DAY;
            let changed = match event {
                Event::Step(from, size) if n == 0 && day >= from => size,
                Event::Creep(from, size) if n == 0 => size * ((day - from) / 30.0).clamp(0.0, 1.0),
                _ => 0.0,
            };
            let value = level * (1.0 + changed) * libm::exp(slow + new);
            Point {
                time,
                value,
                std: value * std,
                temperature: Some(celsius + 0.5 * load.sin()),
            }
        });
        points.collect()
    });
    Machine {
        courses: courses.collect(),
    }
}

/// How a fleet fared.
#[derive(Debug, Default)]
pub struct Fared {
    /// Part of the quiet machines that were alarmed at any time.
    pub false_alarms: f64,
    /// Part of the stepped machines that were found with the fifth log after the step or before.
    pub steps: f64,
    /// Part of the creeping machines that were found within the 30 days.
    pub creeps: f64,
}

/// A fleet of which most machines are quiet; it is looked at every few days, as it would be while it runs, with noise and limits
/// found anew each time, and an alarm at any time counts.
pub fn fared(world: &World, machines: usize, days: u32, seed: u64) -> Fared {
    use stiction_drift::{Limits, Noise, Settings, judge};
    // 1 of 25 steps, 1 of 25 creeps; the others are quiet.
    let event = |k: usize, dice: &mut Dice| {
        let sign = if dice.uniform() < 0.5 { -1.0 } else { 1.0 };
        let latest = f64::from(days) - 36.0;
        match k % 25 {
            7 => Event::Step(15.0 + (f64::from(days) - 25.0) * dice.uniform(), 0.1 * sign),
            19 => Event::Creep(12.0 + (latest - 12.0).max(0.0) * dice.uniform(), 0.1 * sign),
            _ => Event::Nothing,
        }
    };
    let mut dice = Dice::new(seed);
    let events: Vec<Event> = (0..machines).map(|k| event(k, &mut dice)).collect();
    let fleet: Vec<Machine> = (0..machines)
        .map(|k| machine(world, days, events[k], seed * 1_000_003 + k as u64))
        .collect();
    let mut alarmed: Vec<Option<f64>> = vec![None; machines];
    let mut looks: Vec<u32> = (14..days).step_by(6).collect();
    looks.push(days);
    for until in looks {
        let end = DAY * f64::from(until);
        let seen = |course: &[Point]| course.partition_point(|point| point.time < end);
        for n in 0..NUMBERS.len() {
            let courses: Vec<&[Point]> = fleet
                .iter()
                .map(|m| &m.courses[n][..seen(&m.courses[n])])
                .collect();
            let Some(noise) = Noise::of(&courses) else {
                continue;
            };
            let limits = Limits::of(&noise, NUMBERS.len(), &Settings::default());
            for (k, course) in courses.iter().enumerate() {
                let Some(first) =
                    judge(course, &noise, &limits).and_then(|j| j.changes.first().copied())
                else {
                    continue;
                };
                let time = course[first.found].time;
                // Of a machine with an event only what comes after it is a find.
                let early = match events[k] {
                    Event::Nothing => false,
                    Event::Step(from, _) | Event::Creep(from, _) => n != 0 || time < DAY * from,
                };
                if !early && alarmed[k].is_none_or(|before| time < before) {
                    alarmed[k] = Some(time);
                }
            }
        }
    }
    let mut counts = [[0.0f64; 2]; 3];
    for k in 0..machines {
        let course = &fleet[k].courses[0];
        let (which, found) = match events[k] {
            Event::Nothing => (0, alarmed[k].is_some()),
            Event::Step(from, _) => {
                let first = course.partition_point(|p| p.time < DAY * from);
                let fifth = course.get(first + 4).map_or(f64::INFINITY, |p| p.time);
                (1, alarmed[k].is_some_and(|time| time <= fifth))
            }
            Event::Creep(from, _) => (
                2,
                alarmed[k].is_some_and(|time| time <= DAY * (from + 30.0)),
            ),
        };
        counts[which][0] += f64::from(u8::from(found));
        counts[which][1] += 1.0;
    }
    let part = |which: usize| counts[which][0] / counts[which][1].max(1.0);
    Fared {
        false_alarms: part(0),
        steps: part(1),
        creeps: part(2),
    }
}
