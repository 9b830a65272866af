//! Simulated logs against closed forms.

use std::collections::BTreeSet;
use stiction_testkit::worlds::{
    Compliance, Controller, Drive, Machine, Motion, Recording, Running, Set, Setup, World, record,
};

fn positions(log: &Recording) -> &[f64] {
    log.position.as_deref().unwrap()
}

/// Samples at which the axis moves at that speed, towards positive positions.
fn moving(machine: &Machine, log: &Recording, speed: f64) -> Vec<usize> {
    let x = positions(log);
    let span = 20;
    (span..x.len() - span)
        .filter(|&k| {
            let v = (x[k + span] - x[k - span]) * machine.rate / (2 * span) as f64;
            (v / speed - 1.0).abs() < 0.01
        })
        .collect()
}

#[test]
fn sliding_at_one_speed_takes_the_steady_force() {
    for (name, machine) in Machine::all(3) {
        let log = record(&machine, Motion::Trapezoid, World::Faithful, 3);
        let speed = 0.5 * machine.top_speed;
        let at = moving(&machine, &log, speed);
        let force: f64 = at.iter().map(|&k| log.force[k]).sum::<f64>() / at.len() as f64;
        let expected = machine.coulomb + machine.sigma2 * speed;
        assert!(
            (force / expected - 1.0).abs() < 0.01,
            "{name}: {force} for {expected}"
        );
    }
}

#[test]
fn the_first_travel_is_as_stiff_as_the_bristles() {
    // From rest, with z = x and far from break-away: F = M a + sigma1 v + sigma0 x (1 - |z| / 2 zss ...).
    let machine = Machine::stage(1);
    let log = record(&machine, Motion::Trapezoid, World::Faithful, 1);
    let x = positions(&log);
    let breakaway = machine.static_friction / machine.sigma0;
    let end = x
        .iter()
        .position(|&x| x - log.position.as_ref().unwrap()[0] > 0.3 * breakaway);
    let stiffness = log.force[end.unwrap()] / (x[end.unwrap()] - x[0]);
    assert!(stiffness > 0.8 * machine.sigma0, "{stiffness}");
}

#[test]
fn a_seed_gives_the_same_log_and_every_world_another() {
    let machine = Machine::joint(7);
    let faithful = record(&machine, Motion::Sine, World::Faithful, 7);
    let bits = |log: &Recording| -> Vec<u64> {
        let motion = log.position.iter().chain(&log.velocity).flatten();
        log.time
            .iter()
            .chain(motion)
            .chain(&log.force)
            .map(|x| x.to_bits())
            .collect()
    };
    assert_eq!(
        bits(&faithful),
        bits(&record(&machine, Motion::Sine, World::Faithful, 7))
    );
    for world in World::ALL.into_iter().filter(|w| *w != World::Faithful) {
        let log = record(&machine, Motion::Sine, world, 7);
        assert_ne!(bits(&log), bits(&faithful), "{}", world.name());
        assert!(log.force.iter().all(|u| u.is_finite()), "{}", world.name());
    }
}

#[test]
fn elements_slip_one_after_another_up_to_the_level_of_one_bristle() {
    let machine = Machine::screw(2);
    let log = record(&machine, Motion::Trapezoid, World::MaxwellSlip, 2);
    let at = moving(&machine, &log, 0.5 * machine.top_speed);
    let force: f64 = at.iter().map(|&k| log.force[k]).sum::<f64>() / at.len() as f64;
    let expected = machine.coulomb + 0.5 * machine.sigma2 * machine.top_speed;
    assert!(
        (force / expected - 1.0).abs() < 0.02,
        "{force} for {expected}"
    );
}

#[test]
fn a_drive_without_anything_is_none_and_rows_are_left_out() {
    let machine = Machine::joint(3);
    let log = |drive| record(&machine, Motion::Sine, drive, 3);
    let driven = |periods, lag, every| {
        log(World::Driven(Drive {
            periods,
            lag,
            every,
        }))
    };
    let faithful = log(World::Faithful);
    assert_eq!(positions(&driven(0, 0.0, 1)), positions(&faithful));
    assert_eq!(driven(0, 0.0, 1).force, faithful.force);
    let (all, some) = (driven(1, 1e-3, 1), driven(1, 1e-3, 4));
    let fourth: Vec<f64> = positions(&all).iter().copied().step_by(4).collect();
    assert_eq!(positions(&some), fourth);
}

#[test]
fn a_force_acts_behind_its_current_loop() {
    // A step F behind a lag of tau: v = F/M (t - tau (1 - exp(-t/tau))).
    let machine = Machine::joint(3).with_friction(1e-6);
    let lag = 2e-3;
    let drive = World::Driven(Drive {
        periods: 0,
        lag,
        every: 1,
    });
    let mut axis = Running::after(&machine, Motion::Sine, drive, 3);
    let force = 1e3 * machine.mass;
    for k in 1..=5 {
        let (_, found) = axis.advance(force, 1e-3);
        let t = 1e-3 * f64::from(k);
        let expected = force / machine.mass * (t - lag * (1.0 - (-t / lag).exp()));
        assert!(
            (found / expected - 1.0).abs() < 1e-2,
            "{found} for {expected} m/s"
        );
    }
}

#[test]
fn a_current_loop_is_that_of_a_drive() {
    let machine = Machine::joint(3);
    let lag = 1e-3;
    let setup = Setup {
        current_loop: lag,
        ..World::Faithful.into()
    };
    let drive = Drive {
        periods: 0,
        lag,
        every: 1,
    };
    let log = |setup: Setup| record(&machine, Motion::Sine, setup, 3);
    let (own, driven) = (log(setup), log(World::Driven(drive).into()));
    assert_eq!(positions(&own), positions(&driven));
    assert_eq!(own.force, driven.force);
}

/// Motor and load share the friction, and the bristles of the load give way behind their spring.
#[test]
fn a_belt_has_the_friction_of_both_ends() {
    let machine = Machine::stage(3);
    let setup = Setup {
        compliance: Some(Compliance {
            frequency: 25.0,
            damping: 0.1,
            load: 0.6,
            friction: 0.7,
            is_read_at_load: false,
        }),
        ..World::Faithful.into()
    };
    let axis = || Running::after(&machine, Motion::Trapezoid, setup, 3);
    let (mut slides, speed) = (axis(), 0.5 * machine.top_speed);
    slides.advance(3.0 * machine.static_friction, 0.03);
    let force = machine.coulomb + machine.sigma2 * speed;
    let (_, found) = (0..2000).fold((0.0, 0.0), |_, _| slides.advance(force, 1e-3));
    assert!((found / speed - 1.0).abs() < 0.02, "{found} {speed}");

    let (mut sticks, push) = (axis(), 2e-3 * machine.coulomb);
    let (x, _) = (0..2000).fold((0.0, 0.0), |_, _| sticks.advance(push, 1e-3));
    let (_, stiffness) = setup.truth(&machine)[0];
    assert!((push / x / stiffness - 1.0).abs() < 0.03, "{x} {stiffness}");
    assert!(setup.truth(&machine).iter().all(|t| t.0 != "sigma1"));
}

/// Without feedforward, and as one loop, an axis follows what it is asked for.
#[test]
fn every_controller_holds_its_axis() {
    for (name, machine) in Machine::all(2) {
        let most = machine.static_friction
            + machine.sigma2 * machine.top_speed
            + machine.mass * machine.acceleration;
        let logs = [Controller::Feedforward, Controller::PPi, Controller::Pid].map(|controller| {
            let setup = Setup {
                controller,
                ..World::Faithful.into()
            };
            record(&machine, Motion::Strokes(4), setup, 2)
        });
        let end = |log: &Recording| positions(log)[log.time.len() - 1];
        let moved = positions(&logs[0])
            .iter()
            .fold(0.0_f64, |m, x| m.max(x.abs()));
        for log in &logs {
            let largest = log.force.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
            assert!(largest < 2.0 * most, "{name}: {largest} of {most}");
            let off = (end(log) - end(&logs[0])).abs() / moved;
            assert!(off < 0.05, "{name}: {off}");
        }
    }
}

#[test]
fn the_sets_share_no_axis_no_motion_and_no_seed_and_all_have_what_is_common() {
    let all = Set::ALL.map(|set| set.cases(1..3));
    let [tuning, test, report] = &all;
    let of = |cases: &[stiction_testkit::worlds::Case]| -> BTreeSet<String> {
        let strokes = |name: &&str| *name != "strokes";
        let names = cases.iter().flat_map(|c| [c.axis, c.motion.name()]);
        let seeds = cases.iter().map(|c| c.seed.to_string());
        // A brake needs rests, and few strokes are few everywhere.
        let own = cases.iter().filter(|c| c.world != "brake").count();
        assert!(own > 300, "{own}");
        let names = names.filter(strokes).filter(|name| *name != "moves");
        names.map(str::to_owned).chain(seeds).collect()
    };
    for (one, other) in [(tuning, test), (tuning, report), (test, report)] {
        let (one, other) = (of(one), of(other));
        assert!(
            one.is_disjoint(&other),
            "{:?}",
            one.intersection(&other).next()
        );
    }
    let worlds = |cases: &[stiction_testkit::worlds::Case]| -> BTreeSet<String> {
        cases.iter().map(|c| c.world.clone()).collect()
    };
    for cases in &all {
        let has = worlds(cases);
        for world in [
            "current loop",
            "encoder steps",
            "PID",
            "few strokes",
            "belt",
        ] {
            assert!(has.contains(world), "{world}");
        }
    }
    assert_eq!(worlds(test), worlds(report));
    // A seed gives the same machine again, and the next one another.
    assert_eq!(test[0].machine, Set::Test.cases(1..2)[0].machine);
    assert_ne!(test[0].machine, test[1].machine);
}
