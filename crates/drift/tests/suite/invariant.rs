//! What does not depend on units, on the order of machines, or on the moment of the look.

use crate::world::{DAY, Dice, Event, machine};
use proptest::prelude::*;
use stiction_drift::{Kind, Limits, Noise, Point, Settings, judge};

const WORLD: crate::world::World = crate::USUAL;

fn courses(machines: u64, seed: u64, event: Event) -> Vec<Vec<Point>> {
    let one = |k| {
        machine(
            &WORLD,
            50,
            if k == 0 { event } else { Event::Nothing },
            seed + k,
        )
    };
    (0..machines)
        .map(|k| one(k).courses.swap_remove(0))
        .collect()
}

fn found(courses: &[Vec<Point>]) -> Vec<Vec<(usize, usize, Kind)>> {
    let slices: Vec<&[Point]> = courses.iter().map(Vec::as_slice).collect();
    let noise = Noise::of(&slices).unwrap();
    let limits = Limits::of(&noise, 1, &Settings::default());
    let of = |course: &&[Point]| {
        let judged = judge(course, &noise, &limits).unwrap();
        judged
            .changes
            .iter()
            .map(|c| (c.found, c.since, c.kind))
            .collect()
    };
    slices.iter().map(of).collect()
}

/// Numbers that repeat differ by nothing at some lags; the noise is theirs all the same, of any size.
#[test]
fn numbers_that_repeat_have_the_noise_that_they_show() {
    for size in [1e-90, 1.0, 1e90] {
        let point = |k: u32| Point {
            time: DAY * f64::from(k),
            value: size * (20.0 + 0.1 * f64::from(k % 3)),
            std: 0.0,
            temperature: None,
        };
        let course: Vec<Point> = (0..40).map(point).collect();
        let noise = Noise::of(&[&course]).unwrap();
        let whole = noise.scatter.hypot(noise.wandering);
        assert!((0.002..0.02).contains(&whole), "{noise:?}");
    }
}

/// However far logs are apart, every window has a limit, and a fleet in which nothing changes is quiet.
#[test]
fn seldom_logs_alarm_no_quiet_machine() {
    let daily = courses(12, 3, Event::Nothing);
    for apart in [7.0, 31.0, 365.0] {
        let later = |p: &Point| Point {
            time: apart * p.time,
            ..*p
        };
        let all: Vec<Vec<Point>> = daily
            .iter()
            .map(|c| c.iter().map(later).collect())
            .collect();
        let slices: Vec<&[Point]> = all.iter().map(Vec::as_slice).collect();
        let noise = Noise::of(&slices).unwrap();
        let limits = Limits::of(&noise, 1, &Settings::default());
        assert!(
            limits.of_window.iter().all(|limit| *limit > 0.0),
            "{limits:?}"
        );
        let alarms: usize = found(&all).iter().map(Vec::len).sum();
        assert!(alarms <= 1, "{alarms} alarms at {apart} days");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(6))]

    /// Other units of a number that is far above 0, and another zero of time, change nothing.
    #[test]
    fn units_do_not_count(seed in 0u64..1000, power in -3i32..4, size in 0.1..0.3f64) {
        let plain = courses(12, seed, Event::Step(25.0, size));
        let unit = 2.0f64.powi(power);
        let other = |p: &Point| Point { time: p.time + 1000.0 * DAY, value: unit * p.value, std: unit * p.std, ..*p };
        let scaled: Vec<Vec<Point>> = plain.iter().map(|c| c.iter().map(other).collect()).collect();
        let count = |all: Vec<Vec<(usize, usize, Kind)>>| all.iter().map(Vec::len).collect::<Vec<_>>();
        prop_assert_eq!(count(found(&plain)), count(found(&scaled)));
    }

    /// With the noise held, what was found is found whenever one looks later.
    #[test]
    fn a_change_that_was_found_stays(seed in 0u64..1000, more in 0usize..20) {
        let all = courses(12, seed, Event::Step(25.0, 0.2));
        let slices: Vec<&[Point]> = all.iter().map(Vec::as_slice).collect();
        let noise = Noise::of(&slices).unwrap();
        let limits = Limits::of(&noise, 1, &Settings::default());
        let whole = judge(slices[0], &noise, &limits).unwrap();
        let first = whole.changes[0];
        let until = (first.found + 1 + more).min(slices[0].len());
        // Temperatures that are usual so far are others than those of the whole; without them it is the same.
        let bare: Vec<Point> = slices[0].iter().map(|p| Point { temperature: None, ..*p }).collect();
        let [late, early] = [bare.len(), until].map(|end| judge(&bare[..end], &noise, &limits).unwrap().changes);
        if let Some(change) = late.first().filter(|c| c.found < until) {
            prop_assert_eq!(early.first(), Some(change));
        }
    }

    /// Whatever numbers come, there is an answer.
    #[test]
    fn any_numbers_are_followed(
        values in prop::collection::vec((-1e6..1e6f64, 0.0..1e3f64, proptest::option::of(-50.0..150.0f64)), 0..60),
        same in any::<bool>(),
    ) {
        let point = |(k, (value, std, temperature)): (usize, &(f64, f64, Option<f64>))| Point {
            time: if same { 0.0 } else { DAY * k as f64 },
            value: *value,
            std: *std,
            temperature: *temperature,
        };
        let course: Vec<Point> = values.iter().enumerate().map(point).collect();
        if let Some(noise) = Noise::of(&[&course]) {
            let limits = Limits::of(&noise, 2, &Settings::default());
            let _ = judge(&course, &noise, &limits);
        }
    }
}

#[test]
fn a_large_step_is_dated_and_measured_and_what_does_not_change_is_quiet() {
    let mut within = 0;
    for seed in 0..20 {
        let all = courses(20, 100 * seed, Event::Step(30.0, 0.2));
        let slices: Vec<&[Point]> = all.iter().map(Vec::as_slice).collect();
        let noise = Noise::of(&slices).unwrap();
        let limits = Limits::of(&noise, 1, &Settings::default());
        let judged = judge(slices[0], &noise, &limits).unwrap();
        let change = judged.changes[0];
        let day = all[0][change.since].time / DAY;
        assert!((day - 30.0).abs() < 3.0, "{seed}: {day} {change:?}");
        within += u32::from(change.low < 0.2 && 0.2 < change.high);
    }
    assert!(within >= 17, "{within} of 20 intervals hold the step");
}

#[test]
fn a_constant_number_has_not_changed() {
    let mut dice = Dice::new(3);
    let point = |k: u32, value: f64| Point {
        time: DAY * f64::from(k),
        value,
        std: 0.01,
        temperature: Some(20.0 + dice.uniform()),
    };
    let mut point = point;
    let course: Vec<Point> = (0..60).map(|k| point(k, 5.0)).collect();
    let noise = Noise::of(&[&course]).unwrap();
    let limits = Limits::of(&noise, 1, &Settings::default());
    assert!(judge(&course, &noise, &limits).unwrap().changes.is_empty());
}

/// On one machine alone, whose logs hardly scatter, a step is none of the scatter that it is held against.
#[test]
fn a_step_of_a_quiet_machine_is_found_however_large() {
    for machines in [1, 2, 6] {
        for size in [0.05, 0.2, 0.5, 1.0] {
            let mut dice = Dice::new(7);
            let mut course = |_| {
                let mut point = |k: u32| {
                    let level = if k < 30 { 20.0 } else { 20.0 * (1.0 + size) };
                    Point {
                        time: DAY * f64::from(k),
                        value: level * (1.0 + 3e-3 * dice.normal()),
                        std: 3e-3 * level,
                        temperature: None,
                    }
                };
                (0..60).map(&mut point).collect()
            };
            let courses: Vec<Vec<Point>> = (0..machines).map(&mut course).collect();
            for changes in found(&courses) {
                let told = changes
                    .iter()
                    .any(|(_, since, kind)| since.abs_diff(30) <= 2 && *kind == Kind::Step);
                assert!(told, "{machines} machines, {size}: {changes:?}");
            }
        }
    }
}

/// Logs of one machine in which nothing but that happens: a log a day, scatter of .2 %, deviations as they are stated.
fn alone(logs: u32, stated: f64, dice: &mut Dice, changed: &dyn Fn(u32) -> f64) -> Vec<Point> {
    let mut point = |k: u32| {
        let value = 20.0 * (1.0 + changed(k)) * (1.0 + 2e-3 * dice.normal());
        Point {
            time: DAY * f64::from(k),
            value,
            std: stated * value,
            temperature: None,
        }
    };
    (0..logs).map(&mut point).collect()
}

/// The scatter of one machine is that of its repeats, however wide the intervals of its logs are, and a step is none of it.
#[test]
fn a_step_of_one_machine_stands_out_of_its_repeats() {
    for stated in [0.0, 2e-3, 0.01, 0.02, 0.05] {
        for at in 5..=15 {
            let mut dice = Dice::new(11 + u64::from(at));
            let step = |k: u32| if k < at { 0.0 } else { 0.25 };
            let course = alone(20, stated, &mut dice, &step);
            let noise = Noise::of(&[&course]).unwrap();
            let limits = Limits::of(&noise, 4, &Settings::default());
            let judged = judge(&course, &noise, &limits).unwrap();
            let [change] = judged.changes[..] else {
                panic!("{stated} {at}: {:?} of {limits:?}", judged.changes);
            };
            assert_eq!(
                (change.since, change.kind),
                (at as usize, Kind::Step),
                "{stated}"
            );
            assert!(
                change.low < 0.25 && 0.25 < change.high,
                "{stated} {at}: {change:?}"
            );
            assert!(change.high - change.low < 0.1, "{stated} {at}: {change:?}");
            assert!(
                limits.tell(&noise) && limits.of_window[0] < 0.1,
                "{limits:?}"
            );
        }
    }
}

/// Of one machine in which nothing changes no more are alarmed than of a fleet, whatever the intervals say and the scatter is like.
#[test]
fn machines_alone_in_which_nothing_changes_are_seldom_alarmed() {
    seldom_alarmed(0..5);
}

#[test]
#[ignore = "soak: the same of more machines"]
fn further_machines_alone_are_seldom_alarmed() {
    seldom_alarmed(5..25);
}

fn seldom_alarmed(seeds: std::ops::Range<u64>) {
    let (mut alarmed, mut all) = (0, 0);
    for logs in [15, 20, 40] {
        for (memory, slow) in [(1.0, 0.0), (3.0, 1.0), (10.0, 1.0), (30.0, 2.0)] {
            for seed in seeds.clone() {
                let mut dice = Dice::new(1_000 * seed + u64::from(logs));
                let mut state = slow * dice.normal();
                let stays = libm::exp(-1.0 / memory);
                let wandering: Vec<f64> = (0..logs)
                    .map(|_| {
                        let now = state;
                        let new = slow * libm::sqrt(1.0 - stays * stays);
                        state = stays * state + new * dice.normal();
                        2e-3 * (now
                            + if seed % 2 == 0 {
                                0.0
                            } else {
                                0.5 * dice.heavy()
                            })
                    })
                    .collect();
                let stated = [0.0, 1e-3, 0.01][seed as usize % 3];
                let course = alone(logs, stated, &mut dice, &|k| wandering[k as usize]);
                let noise = Noise::of(&[&course]).unwrap();
                let limits = Limits::of(&noise, 4, &Settings::default());
                let judged = judge(&course, &noise, &limits).unwrap();
                alarmed += u32::from(!judged.changes.is_empty());
                all += 1;
            }
        }
    }
    assert!(20 * alarmed <= all, "{alarmed} of {all}");
}

/// Of logs that scatter by as much as the number itself nothing can be told.
#[test]
fn logs_that_scatter_widely_tell_nothing() {
    let mut dice = Dice::new(5);
    let wide: Vec<f64> = (0..20).map(|_| libm::exp(dice.normal()) - 1.0).collect();
    let course = alone(20, 0.01, &mut dice, &|k| wide[k as usize]);
    let noise = Noise::of(&[&course]).unwrap();
    assert!(!Limits::of(&noise, 1, &Settings::default()).tell(&noise));
}
