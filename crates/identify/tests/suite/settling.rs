//! Logs that begin, or go on after a gap, while an axis is held by its bristles: how far these are deflected then is not known.

use crate::common::closed_loop::{axis, encoder, identified, truth};
use crate::common::maxwell::four;
use crate::common::{MACHINE, Set};
use std::f64::consts::TAU;
use stiction_friction::{ElastoPlastic, LuGre};
use stiction_identify::{
    Conditioning, Cutoff, Estimate, Law, LawKind, Mass, Record, Samples, Settings, Silent, Terms,
    condition, cross_validate, fit_law, settle,
};
use stiction_servo::cascade::Cascade;
use stiction_servo::closed_loop::{ClosedLoop, ForceLog};
use stiction_servo::path::Path;
use stiction_servo::plant::Plant;

const RATE: f64 = 4000.0;
/// A cut, s, and the end of a gap: within 40 ms after reversals, long before break-away.
const CUT: f64 = 0.53;
const GAP: std::ops::Range<f64> = 1.02..1.03;

/// Slow and fast strokes.
fn motion(t: f64) -> f64 {
    0.004 * (TAU * t).sin() * (1.0 + 9.0 * (TAU * 0.1 * t).sin().powi(2))
}

/// A log of 8 s from the cut on, with a gap.
fn cut(force: impl FnMut(f64, f64) -> f64) -> Samples {
    let mut force = force;
    let mut log = Samples {
        velocity: Some(Vec::new()),
        ..Samples::default()
    };
    for k in 0..(8.0 * RATE) as usize {
        let t = k as f64 / RATE;
        let v = motion(t);
        let u = force(t, v);
        if t >= CUT && !GAP.contains(&t) {
            log.time.push(t);
            log.velocity.as_mut().unwrap().push(v);
            log.force.push(u);
        }
    }
    log
}

/// A law along the motion in fine steps: from a deflection over a step between two velocities.
fn along(
    step: impl Fn(f64, f64, f64, f64) -> f64,
    force: impl Fn(f64, f64) -> f64,
) -> impl FnMut(f64, f64) -> f64 {
    let (mut z, mut at) = (0.0, 0.0);
    move |t, v| {
        let h = (t - at) / 20.0;
        for k in 0..20 {
            let t = at + f64::from(k) * h;
            z = step(z, h, motion(t), motion(t + h));
        }
        at = t;
        force(z, v)
    }
}

fn friction_only() -> Terms {
    Terms {
        mass: Mass::Absent,
        offset: false,
        ..Terms::default()
    }
}

fn raw() -> Conditioning {
    Conditioning {
        source_cutoff: Cutoff::Off,
        common_cutoff: Cutoff::Off,
        ..Conditioning::default()
    }
}

/// The record as it is, and from where it no longer depends on what was before.
fn both(log: Samples) -> [Record; 2] {
    let logs = [log];
    let (law, terms) = (Law::new(LawKind::LuGre), friction_only());
    let settings = Settings::default();
    let settled = settle(&logs, &raw(), law, &terms, &settings, &mut Silent).unwrap();
    [raw(), settled.conditioning].map(|c| condition(&logs, &c).unwrap())
}

fn fitted(record: &Record, law: Law) -> (Estimate, f64) {
    let terms = friction_only();
    let settings = Settings::default();
    let (estimate, optimum) = fit_law(record, law, &terms, 1e-3, &settings, &mut Silent).unwrap();
    let score = cross_validate(record, &estimate, &optimum, 4, &mut Silent);
    (estimate, score.held_out.unwrap().relative_error_percent)
}

fn without_curve() -> LuGre<f64> {
    let dahl = Set {
        fixed: MACHINE.coulomb,
        sigma1: 0.0,
        ..MACHINE
    };
    dahl.law()
}

/// Every law with one bristle finds its stiffness, and predicts blocks left out, as if the log had no start and no gap.
#[test]
fn what_bristles_held_before_is_not_blamed_on_the_law() {
    let lugre = MACHINE.law();
    let plastic = ElastoPlastic::new(lugre, 0.7).unwrap();
    let dahl = without_curve();
    let logs = [
        (
            LawKind::Dahl,
            cut(along(
                |z, h, a, b| dahl.step_record(z, h, a, b),
                |z, v| dahl.force(z, v),
            )),
        ),
        (
            LawKind::LuGre,
            cut(along(
                |z, h, a, b| lugre.step_record(z, h, a, b),
                |z, v| lugre.force(z, v),
            )),
        ),
        (
            LawKind::ElastoPlastic,
            cut(along(
                |z, h, a, b| plastic.step_record(z, h, a, b),
                |z, v| plastic.force(z, v),
            )),
        ),
    ];
    for (kind, log) in logs {
        let [whole, settled] = both(log);
        assert_eq!(whole.segments.len(), 2, "the gap splits the log");
        let lost = 1.0 - settled.kept() as f64 / whole.kept() as f64;
        assert!((0.01..0.3).contains(&lost), "{kind}: {lost} lost");
        let note = settled.notes.iter().any(|n| n.contains("after gaps"));
        assert!(note, "{:?}", settled.notes);
        let (before, left_before) = fitted(&whole, Law::new(kind));
        let (after, left) = fitted(&settled, Law::new(kind));
        let off = after.value("sigma0").unwrap() / MACHINE.sigma0 - 1.0;
        assert!(off.abs() < 2e-3, "{kind}: sigma0 off by {off}");
        assert!(left < 0.5, "{kind}: {left} % left on blocks left out");
        assert!(
            after.fit.rmse < 0.1 * before.fit.rmse && left < 0.2 * left_before,
            "{kind}: {:?} {left_before}, {:?} {left}",
            before.fit,
            after.fit
        );
    }
}

/// Elements that slip hold what they held before, too.
#[test]
fn what_elements_held_before_is_not_blamed_on_the_law() {
    let law = four();
    let fine = 20;
    let n = (8.0 * RATE) as usize;
    let (_, force) = law.along(n, 1.0 / RATE, fine, motion);
    let mut all = force.into_iter();
    let [whole, settled] = both(cut(|_, _| all.next().unwrap()));
    let elements = Law {
        elements: 4,
        ..Law::new(LawKind::Gms)
    };
    let (before, _) = fitted(&whole, elements);
    let (after, _) = fitted(&settled, elements);
    let off = after.value("sigma0").unwrap() / law.stiffness() - 1.0;
    assert!(off.abs() < 5e-3, "total stiffness off by {off}");
    assert!(
        after.fit.rmse < 0.3 * before.fit.rmse,
        "{:?}, {:?}",
        before.fit,
        after.fit
    );
}

/// The first fast strokes of a log in closed loop: the choice of the cut-offs does not lead on to where the delay comes out
/// wrong, and the delay and what moves together with it are inside their intervals.
#[test]
fn a_short_log_of_fast_strokes_keeps_its_delay() {
    let machine = axis("machine");
    let (mut all, mut outside) = (0, Vec::new());
    // With the last three noises the force passed for one that is logged as it is held.
    for seed in [0, 1, 2, 51, 57, 67] {
        let log = ClosedLoop {
            plant: Plant::new(machine.mass, machine.law).unwrap(),
            controller: Cascade::tuned(machine.mass, 60.0, 500.0).unwrap(),
            path: Path::three_segments(0.196, 9.0).unwrap(),
            encoder: encoder(50e-9, 0),
            rate: RATE,
            substeps: 5,
            force_noise: 1.0,
            force_log: ForceLog::Centred,
            seed,
        };
        let mut log = log.run().unwrap();
        let part = (2.49 * RATE) as usize;
        log.time.truncate(part);
        log.position.truncate(part);
        log.force.truncate(part);
        let (_, found) = identified(&log, 50e-9);
        // The force is logged as its mean about the sample: no delay.
        let mut wanted: Vec<(&str, f64)> = truth("machine").into();
        wanted.push(("delay", 0.0));
        for p in found.parameters.iter().filter(|p| p.identified) {
            let name = p.name.to_string();
            let Some((_, right)) = wanted.iter().find(|(n, _)| *n == name) else {
                continue;
            };
            let Some((low, high)) = p.ci95 else { continue };
            all += 1;
            // Of the 48 values two or three may lie a little outside.
            let reach = 0.6 * (high - low);
            if (right - 0.5 * (low + high)).abs() >= reach {
                outside.push(format!("seed {seed}: {name}"));
            }
        }
    }
    // One misses that: at a high cut-off a force logged about its sample passes for one that is held from it on.
    assert!(all >= 48, "{all}");
    assert_eq!(outside, ["seed 51: delay"]);
}
