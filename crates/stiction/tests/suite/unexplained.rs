//! What a law takes up of an effect that it does not describe is no constant of the machine. Motions and forces by formulas of their
//! own.

use crate::common::{Bench, noise, options};
use stiction_identify::Silent;
use stiction_parameters::LawKind;
use stiction_workflows::identify::Outcome;

fn fitted(bench: &Bench, rows: impl Iterator<Item = [f64; 3]>) -> Outcome {
    let rows: Vec<String> = rows
        .map(|[t, x, force]| format!("{t:.5},{:.5},{force:.4}\n", 1e3 * x))
        .collect();
    let text = format!("Time [s],Position [mm],Force [N]\n{}", rows.concat());
    let log = bench.write("log.csv", &text);
    let mut asked = options(&[&log], LawKind::LuGre);
    (asked.law, asked.compare_laws) = (None, true);
    asked.identify(&mut Silent).unwrap()
}

/// One reversal at constant acceleration: the inertia is a part of the constant force, and where between two samples the axis turned
/// back is not known, which is all that such a log has of a delay.
#[test]
fn one_reversal_at_constant_acceleration_tells_no_offset_and_no_delay() {
    let (sigma2, coulomb, mass, a, rate) = (60.0, 20.0, 10.0, -0.04, 4000.0);
    for (seed, begin) in [(1, 0.1), (2, 0.099_995), (3, 0.1)] {
        let rows = (0..20_000).map(|k| {
            let t = k as f64 / rate;
            let v: f64 = begin + a * t;
            let x = begin * t + 0.5 * a * t * t;
            let force = mass * a + sigma2 * v + coulomb * v.signum();
            [t, (x / 5e-8).round() * 5e-8, force + 0.5 * noise(seed, k)]
        });
        let bench = Bench::new();
        let found = fitted(&bench, rows);
        let result = &found.result;
        let of = |name: &str| result.parameters.iter().find(|p| p.name == name).unwrap();
        for name in ["mass", "offset"] {
            assert!(!of(name).identifiable, "{:?}", of(name));
        }
        let delay = of("delay");
        let [low, high] = delay.ci95.map(|end| end.map(Option::unwrap)).unwrap();
        assert!(
            !delay.identifiable && (low..=high).contains(&0.0),
            "delay: {low} {high}"
        );
        for (name, truth) in [("sigma2", sigma2), ("coulomb", coulomb)] {
            let [low, high] = of(name).ci95.map(|end| end.map(Option::unwrap)).unwrap();
            assert!((low..=high).contains(&truth), "{name}: {low} {high}");
        }
    }
}
