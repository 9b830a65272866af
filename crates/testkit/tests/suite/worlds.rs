//! Simulated logs against closed forms.

use stiction_testkit::worlds::{Drive, Machine, Motion, Recording, Running, World, record};

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
