//! The delay of the force that Maxwell-slip elements find themselves.

use crate::common::maxwell::{Maxwell, four, motion};
use crate::common::{MACHINE, Noise, force_along};
use stiction_identify::{
    Conditioning, Delay, DelayFrom, Estimate, Law, LawKind, Record, Samples, Settings, Silent,
    Terms, condition, identify,
};

/// Sample time, s, and steps of a finer grid in it, by which a force can be late.
const STEP: f64 = 5e-4;
const FINE: usize = 10;
const SAMPLES: usize = 12_000;
/// What is left at the start, in which a force that is early lies before the log.
const LEAD: usize = 80;
/// Step of the encoder, m, deviation of the force, N, and the mass, kg.
const COUNT: f64 = 50e-9;
const NOISE: f64 = 0.15;
const MASS: f64 = 6.0;

/// A log of velocities and forces of friction on the fine grid, the force `late` tenths of a sample later than its motion.
fn log((v, friction): &(Vec<f64>, Vec<f64>), late: i32, seed: u64) -> Samples {
    let fine = STEP / FINE as f64;
    let mut noise = Noise::new(seed);
    let mut position = noise.uniform() * COUNT;
    let positions: Vec<f64> = v
        .windows(2)
        .map(|v| {
            position += 0.5 * (v[0] + v[1]) * fine;
            (position / COUNT).round() * COUNT
        })
        .collect();
    let whole = |i: usize| {
        let (h, t) = (1e-6, i as f64 * fine);
        friction[i] + MASS * (motion(t + h) - motion(t - h)) / (2.0 * h)
    };
    let rows = (LEAD..v.len() - LEAD).step_by(FINE);
    let earlier = |i: usize| (i as i32 - late) as usize;
    let force = rows
        .clone()
        .map(|i| whole(earlier(i)) + NOISE * noise.normal());
    Samples {
        force: force.collect(),
        time: (0..rows.len()).map(|i| i as f64 * STEP).collect(),
        position: Some(rows.map(|i| positions[i - 1]).collect()),
        ..Samples::default()
    }
}

fn record(logs: &[Samples]) -> Record {
    condition(logs, &Conditioning::default()).unwrap()
}

/// An axis of four elements along the fine grid.
fn axis(samples: usize) -> (Vec<f64>, Vec<f64>) {
    four().along(samples * FINE, STEP / FINE as f64, 10, motion)
}

fn fitted(record: &Record, law: Law, delay: Delay) -> Estimate {
    let terms = Terms {
        delay,
        ..Terms::default()
    };
    identify(record, law, &terms, 1e-4, &Settings::default(), &mut Silent).unwrap()
}

fn gms(elements: usize) -> Law {
    Law {
        elements,
        ..Law::new(LawKind::Gms)
    }
}

/// How far a parameter is from the truth, in deviations that are stated.
fn off(found: &Estimate, name: &str, truth: f64) -> f64 {
    let p = found.parameter(name).unwrap();
    (p.value - truth) / p.std.unwrap()
}

fn truths(truth: &Maxwell) -> Vec<(String, f64)> {
    let each = (0..truth.elements.len()).flat_map(|i| {
        [
            (format!("stiffness_{}", i + 1), truth.elements[i].0),
            (format!("yield_{}", i + 1), truth.yields(i)),
        ]
    });
    each.chain([("mass".to_string(), MASS)]).collect()
}

/// A force that is late or early by parts of a sample is found so, with intervals that hold the truth as often as they say, and the
/// elements beside it are as well known as where it is given, or nearly.
#[test]
fn elements_find_a_delay() {
    let truth = four();
    let axis = axis(SAMPLES);
    let (mut inside, mut all) = (0, 0);
    for late in [13, -6] {
        let delay = 0.1 * f64::from(late) * STEP;
        for seed in 1..=3 {
            let record = record(&[log(&axis, late, seed)]);
            let found = fitted(&record, gms(4), Delay::Fitted);
            assert_eq!(found.terms.delay_from, DelayFrom::Elements);
            let own = off(&found, "delay", delay);
            println!(
                "{late} {seed}: {:.4} samples, {own:.2} deviations of {:.4}; {:?}",
                found.value("delay").unwrap() / STEP,
                found.terms.delay_deviation / STEP,
                found.counts
            );
            assert!(own.abs() < 4.0, "{late} {seed}: {own}");
            inside += usize::from(own.abs() < 1.96);
            all += 1;
            for (name, value) in truths(&truth) {
                let (low, high) = found.parameter(&name).unwrap().ci95.unwrap();
                inside += usize::from(low <= value && value <= high);
                all += 1;
                println!("    {name} {:.2}", off(&found, &name, value));
            }
            if seed > 1 {
                continue;
            }
            let given = fitted(&record, gms(4), Delay::Given(delay));
            assert_eq!(given.terms.delay_from, DelayFrom::Stated);
            assert!(given.parameter("delay").is_none());
            let evaluations = |found: &Estimate| {
                println!("    {:?}", found.counts);
                found.counts.with_derivatives() + found.counts.coarse()
            };
            assert!(evaluations(&found) < 5 * evaluations(&given));
            for (name, _) in truths(&truth) {
                let std = |found: &Estimate| found.parameter(&name).unwrap().std.unwrap();
                let ratio = std(&found) / std(&given);
                println!("    {name}: {ratio:.2} times as wide");
                assert!((0.8..3.0).contains(&ratio), "{name}: {ratio}");
            }
        }
    }
    println!("{inside} of {all}");
    assert!(10 * inside >= 8 * all, "{inside} of {all}");
}

/// On an axis of bristles LuGre knows the delay, and elements that are fitted beside it do not spoil it.
#[test]
fn elements_do_not_spoil_the_delay_of_bristles() {
    let axis = force_along(
        &MACHINE.law(),
        SAMPLES * FINE,
        STEP / FINE as f64,
        2,
        motion,
    );
    for late in [13, -6] {
        let record = record(&[log(&axis, late, 1)]);
        let found = fitted(&record, gms(4), Delay::Fitted);
        let Delay::Given(delay) = found.terms.delay else {
            panic!("{:?}", found.terms.delay);
        };
        let (found_at, deviation) = (delay / STEP, found.terms.delay_deviation / STEP);
        println!(
            "{late}: {found_at} of {deviation}, {:?}",
            found.terms.delay_from
        );
        assert!(
            (found_at - 0.1 * f64::from(late)).abs() < 0.15,
            "{found_at}"
        );
    }
}

/// Of several logs it is one delay.
#[test]
fn logs_have_one_delay() {
    let axis = axis(SAMPLES / 2);
    let logs = [log(&axis, 13, 1), log(&axis, 13, 2)];
    let found = fitted(&record(&logs), gms(4), Delay::Fitted);
    assert_eq!(found.terms.delay_from, DelayFrom::Elements);
    let own = off(&found, "delay", 1.3 * STEP);
    let deviation = found.terms.delay_deviation / STEP;
    println!("{own} of {deviation}");
    assert!(own.abs() < 4.0 && deviation < 0.1, "{own} of {deviation}");
}

/// A delay beyond all that are looked for is none of the elements either.
#[test]
fn a_delay_out_of_range_is_not_stated() {
    let axis = axis(SAMPLES / 2);
    let found = fitted(&record(&[log(&axis, 60, 1)]), gms(4), Delay::Fitted);
    println!("{:?}", found.terms);
    assert!(matches!(found.terms.delay_from, DelayFrom::OtherLaw(_)));
    assert!(found.parameter("delay").is_none());
}
