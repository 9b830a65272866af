//! Rests of a log, from the file to every output.

use crate::common::{Bench, RATE, friction, noise, options};
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};
use stiction_codes::Code;
use stiction_identify::Silent;
use stiction_parameters::LawKind;
use stiction_workflows::identify::Outcome;

/// To and fro from rest, and at rest again after five seconds: position, velocity, acceleration.
fn to_and_fro(t: f64) -> [f64; 3] {
    let mut out = [0.0; 3];
    for (a, w) in [(0.05, TAU), (0.008, 3.0 * TAU)] {
        out[0] += a * (1.0 - (w * t).cos());
        out[1] += a * w * (w * t).sin();
        out[2] += a * w * w * (w * t).cos();
    }
    out
}

/// Three seconds at rest under a creeping integrator, five of motion, four at rest again.
fn log(bench: &Bench) -> PathBuf {
    let moves = |t: f64| (3.0..8.0).contains(&t).then(|| to_and_fro(t - 3.0));
    bench.log(
        "log.csv",
        (12.0 * RATE) as usize,
        |t| moves(t).map_or(0.0, |state| state[0]),
        |i, t| {
            let held = if t < 3.0 {
                17.0
            } else {
                -18.0 + 3.0 * (t - 8.0)
            };
            moves(t).map_or(held, friction) + 0.5 * noise(3, i)
        },
    )
}

fn fit(log: &Path, axis: Option<PathBuf>) -> Outcome {
    let mut asked = options(&[log], LawKind::CoulombViscous);
    asked.files.axis = axis;
    asked.identify(&mut Silent).unwrap()
}

#[test]
fn they_are_left_out_as_by_the_crop_that_is_named() {
    let bench = Bench::new();
    let log = log(&bench);
    let found = fit(&log, None);
    let input = &found.result.inputs[0];
    let times: Vec<(Code, f64, f64)> = input
        .excluded
        .iter()
        .map(|e| (e.code, e.from_s, e.to_s))
        .collect();
    let [(Code::RestAtEnd, start, to), (Code::RestAtEnd, from, end)] = times[..] else {
        panic!("{times:?}");
    };
    assert!((start, end) == (0.0, 11.999), "{times:?}");
    assert!(
        (to - 2.98).abs() < 0.02 && (from - 8.02).abs() < 0.02,
        "{times:?}"
    );
    // With the rests left out the axis is found, whichever way.
    let crop = format!("[log]\ncrop = [\"{to} s\", \"{from} s\"]\n");
    let cropped = fit(&log, Some(bench.write("crop.toml", &crop)));
    assert!(cropped.result.inputs[0].excluded.is_empty());
    let a = &found.result.fit;
    for (name, truth) in [("coulomb", 20.0), ("sigma2", 60.0), ("mass", 9.0)] {
        for outcome in [&found, &cropped] {
            let p = outcome.result.parameters.iter().find(|p| p.name == name);
            let value = p.unwrap().value;
            assert!((value / truth - 1.0).abs() < 0.03, "{name}: {value}");
        }
    }
    // With the rests the law bends towards a force that is no friction.
    let kept = fit(
        &log,
        Some(bench.write("keep.toml", "[log]\nrests = \"keep\"\n")),
    );
    assert!(kept.result.inputs[0].excluded.is_empty());
    assert!(
        kept.result.fit.rmse > 5.0 * a.rmse,
        "{} {}",
        kept.result.fit.rmse,
        a.rmse
    );
    // And it is said at the head of the terminal and of the report.
    let text = stiction_pages::text::outcome(&found);
    let head = text.split("\n\n").next().unwrap();
    assert!(
        head.contains("not fitted: 0 to 2.98") && head.contains("[rest-at-end]"),
        "{head}"
    );
    let bundle = stiction_pages::bundle::identification(&found);
    let (_, report) = bundle
        .files()
        .iter()
        .find(|(name, _)| *name == "report.html")
        .unwrap();
    let report = std::str::from_utf8(report).unwrap();
    let (said, table) = (report.find("not fitted: 0 to 2.98"), report.find("<table"));
    assert!(said.is_some() && said < table, "{said:?} {table:?}");
}

#[test]
fn validation_leaves_them_out_too() {
    let bench = Bench::new();
    let (log, good) = (log(&bench), bench.good("good.csv", 5));
    let mut asked = options(&[&good], LawKind::CoulombViscous);
    asked.files.validate = vec![log];
    let found = asked.identify(&mut Silent).unwrap();
    let (fit, unseen) = (&found.result.fit, &found.result.validation[0].fit);
    // Unlike that of the rests, which is 17 N and more.
    assert!(unseen.rmse < fit.rmse + 2.0, "{} {}", unseen.rmse, fit.rmse);
}

/// Between two motions the force climbs in steps towards break-away, and the axis does not move: no law of the motion
/// follows that, so it is carried along and not fitted. Where the force is held, the rest is fitted.
#[test]
fn rests_in_which_the_force_varies_are_not_fitted() {
    let bench = Bench::new();
    let motion = |t: f64| match t {
        t if t < 5.0 => Some(t),
        t if t < 11.0 => None,
        t => Some(t - 11.0),
    };
    let log = |name: &str, at_rest: &dyn Fn(f64) -> f64| {
        bench.log(
            name,
            (16.0 * RATE) as usize,
            |t| motion(t).map_or(0.0, |t| to_and_fro(t)[0]),
            |i, t| {
                let force = motion(t).map_or_else(|| at_rest(t), |t| friction(to_and_fro(t)));
                force + 0.5 * noise(4, i)
            },
        )
    };
    let steps = fit(&log("steps.csv", &|t| 3.0 * (t - 5.0).floor()), None);
    let codes: Vec<Code> = steps.result.inputs[0]
        .excluded
        .iter()
        .map(|e| e.code)
        .collect();
    assert_eq!(codes, [Code::RestBetween]);
    let excluded = &steps.result.inputs[0].excluded[0];
    assert!(
        (excluded.from_s - 5.02).abs() < 0.02 && (excluded.to_s - 10.98).abs() < 0.02,
        "{excluded:?}"
    );
    for (name, truth) in [("coulomb", 20.0), ("sigma2", 60.0), ("mass", 9.0)] {
        let value = steps.law().value(name).unwrap();
        assert!((value / truth - 1.0).abs() < 0.03, "{name}: {value}");
    }
    let held = fit(&log("held.csv", &|_| 0.0), None);
    assert!(held.result.inputs[0].excluded.is_empty());
}

/// Moves with dwells end in a likelihood of the counts, where nothing speaks against the law.
#[test]
fn short_rests_are_asked_of_the_counts() {
    use stiction_testkit::worlds::{Machine, Motion, World, record};
    let machine = Machine::screw(1);
    let bench = Bench::new();
    let moves = record(&machine, Motion::Trapezoid, World::Faithful, 1);
    let log = bench.write("moves.csv", &moves.to_csv(machine.kind));
    let found = options(&[&log], LawKind::LuGre)
        .identify(&mut Silent)
        .unwrap();
    for (name, truth) in machine.truth() {
        let p = found.result.parameters.iter().find(|p| p.name == name);
        let p = p.unwrap();
        assert_eq!(p.interval.as_deref(), Some("state-space"));
        let (low, high) = p.ci95.map(|[a, b]| (a.unwrap(), b.unwrap())).unwrap();
        assert!(
            (low..=high).contains(&truth),
            "{name}: {truth} {low} {high}"
        );
    }
    let says = |note: &&String| note.contains("rests in much of the log");
    let said: Vec<&String> = found.result.axis.conditioning.iter().filter(says).collect();
    assert_eq!(said.len(), 1);
    insta::assert_snapshot!(said[0]);
    let bundle = stiction_pages::bundle::identification(&found);
    let mut files = bundle.files().iter();
    let (_, report) = files.find(|(name, _)| *name == "report.html").unwrap();
    let report = std::str::from_utf8(report).unwrap();
    assert!(report.contains("rests in much of the log"));
}

/// A joint between dwells, by a simulation of its own: moves of 1.1 rad, LuGre by a step of 5 us under a cascade with a filtered speed, a
/// force that is logged two rows late. Time, position (rad), torque (N m).
fn dwelling_joint(seed: u64) -> Vec<[f64; 3]> {
    let [sigma0, sigma1, sigma2, coulomb, excess, stribeck, mass] =
        [3800.0, 14.0, 3.6, 6.2, 2.6, 0.035, 0.38];
    let (rate, substeps, count) = (1000.0, 200, TAU / 524_288.0);
    let (way, speed, ramp, dwell) = (1.1, 1.6, 1.6 / 9.0, 0.4);
    let travel = way / speed + ramp;
    let wanted = |t: f64| {
        let after = (t - 0.4).max(0.0);
        let (move_, at) = (
            (after / (travel + dwell)) as usize,
            after % (travel + dwell),
        );
        let gone = match at.min(travel) {
            at if at < ramp => 4.5 * at * at,
            at if at < travel - ramp => speed * (at - 0.5 * ramp),
            at => way - 4.5 * (travel - at) * (travel - at),
        };
        if move_ % 2 == 0 { gone } else { way - gone }
    };
    let (mut x, mut v, mut z) = (0.0, 0.0, 0.0_f64);
    let (mut read, mut filtered, mut integral) = (0.0, 0.0, 0.0);
    let mut forces = Vec::new();
    let mut out = Vec::new();
    let step = 1.0 / rate;
    for k in 0..12_000 {
        let t = k as f64 * step;
        let now = (x / count + 0.5_f64).floor() * count;
        filtered += step / (0.002 + step) * ((now - read) * rate - filtered);
        read = now;
        let asked = if k == 0 {
            0.0
        } else {
            (wanted(t) - wanted(t - step)) * rate
        };
        let error = 25.0 * (wanted(t) - now) + asked - filtered;
        let force = mass * 120.0 * (error + integral);
        integral += error * step / 0.05;
        forces.push(force + 0.14 * noise(seed, k));
        out.push([t, now, forces[k.saturating_sub(2)]]);
        let fine = step / f64::from(substeps);
        for _ in 0..substeps {
            let level = coulomb + excess * (-(v / stribeck) * (v / stribeck)).exp();
            // Implicit in the bristle, so that a step of any size is stable.
            let next = (z + fine * v) / (1.0 + fine * sigma0 * f64::abs(v) / level);
            let friction = sigma0 * next + sigma1 * (next - z) / fine + sigma2 * v;
            z = next;
            v += fine * (force - friction - 0.1) / mass;
            x += fine * v;
        }
    }
    out
}

/// By the force a law without the Stribeck range holds as well as one with it, since each move passes it within a sample or two. The counts
/// see it, and would give what they see to the bristles: they came out a tenth too soft, within a percent.
#[test]
fn the_counts_show_a_static_friction_that_the_force_does_not() {
    let bench = Bench::new();
    for seed in 1..=2 {
        let rows: Vec<String> = dwelling_joint(seed)
            .into_iter()
            .map(|[t, x, force]| format!("{t:.3},{:.6},{force:.4}\n", x.to_degrees()))
            .collect();
        let text = format!(
            "Time [s],Joint position [deg],Torque [Nm]\n{}",
            rows.concat()
        );
        let log = bench.write("moves.csv", &text);
        let mut asked = options(&[&log], LawKind::LuGre);
        (asked.law, asked.compare_laws) = (None, true);
        let found = asked.identify(&mut Silent).unwrap();
        let laws = &found.result.laws;
        let reported = laws.iter().find(|law| law.reported).unwrap();
        assert_eq!(
            (reported.law.as_str(), reported.without.len()),
            ("lugre", 0)
        );
        for (name, truth, widest) in [("sigma0", 3800.0, 0.05), ("static", 8.8, 0.15)] {
            let p = found.result.parameters.iter().find(|p| p.name == name);
            let p = p.unwrap();
            assert!(p.identifiable, "{name} is open");
            let (low, high) = p.ci95.map(|[a, b]| (a.unwrap(), b.unwrap())).unwrap();
            assert!((low..=high).contains(&truth), "{name}: {low} {high}");
            let half = p.half_width.unwrap().at_once;
            assert!(half < widest * truth, "{name}: {half}");
        }
    }
}
