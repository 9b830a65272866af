//! A weight that is fed forward stays through a reset and goes where it is not enabled, in code as in the compensator.

use crate::common::compiled::{gcc, run, write};
use crate::common::laws;
use crate::common::terms::with_terms;
use stiction_export::{Model, Target, export};
use stiction_friction::compensator::{Input, Settings};
use stiction_testkit::st::Library;

/// A ramp of ten cycles, no watchdog.
fn hanging() -> Model {
    let mut model = with_terms(laws().remove(0).1, 0);
    model.settings = Settings {
        ramp: 0.01,
        watchdog: None,
        ..Settings::new(1e-3, 60.0)
    };
    model
}

/// At standstill at 0.1 m: 100 cycles with friction in, a reset, ten cycles, and ten that are not enabled. The force before the
/// reset, after each of the three, and the weight.
fn due() -> [f64; 5] {
    let mut compensator = hanging().in_rust().unwrap();
    let input = |reference_velocity, enable| Input {
        reference_velocity,
        enable,
        position: 0.1,
        load: 120.0,
        temperature: 301.5,
        transmitted: 6.0,
        ..Input::default()
    };
    let mut steps = |n, v, enable| (0..n).fold(0.0, |_, _| compensator.step(input(v, enable)));
    let before = steps(100, 0.01, true);
    compensator.reset();
    let reset = compensator.state().output;
    let mut steps = |n, v, enable| (0..n).fold(0.0, |_, _| compensator.step(input(v, enable)));
    let after = steps(10, 0.0, true);
    let weight = compensator.state().beside.parts.gravity;
    let mut steps = |n, v, enable| (0..n).fold(0.0, |_, _| compensator.step(input(v, enable)));
    [before, reset, after, steps(10, 0.0, false), weight]
}

#[test]
fn it_stays_through_a_reset() {
    let [before, reset, after, off, weight] = due();
    let expected = 3.5 + 6.0 * 0.1_f64.sin() - 1.5 * 0.1_f64.cos();
    assert!((weight - expected).abs() < 1e-12, "{weight}");
    assert!(before > weight + 5.0, "{before}");
    assert!((reset - weight).abs() < 1e-12, "{reset}");
    // Cogging has come back within the ramp, and bristles that have not moved have no force.
    let angle = 2.0 * std::f64::consts::PI * 0.1;
    let cogging = 0.9 * (angle / 0.03).sin() - 0.4 * (angle / 0.03).cos() + 0.2;
    assert!((after - weight - cogging).abs() < 1e-9, "{after}");
    assert!(off.abs() < 1e-12, "{off}");
}

const MAIN: &str = r#"
#include "x_axis_friction.h"
#include <stdio.h>
static x_axis_params_t p;
static x_axis_state_t s;
static double steps(int n, double v, bool enable)
{
    const x_axis_input_t input = { v, 0.0, enable, 0.0, 0.1, 120.0, 301.5, 6.0 };
    double force = 0.0;
    for (int i = 0; i < n; i++) { force = x_axis_step(&p, &s, &input); }
    return force;
}
int main(void)
{
    x_axis_params(&p);
    if (!x_axis_init(&p, &s) || s.output != 0.0) { return 1; }
    const double before = steps(100, 0.01, true);
    x_axis_reset(&p, &s);
    const double reset = s.output;
    const double after = steps(10, 0.0, true);
    const double weight = s.part_gravity;
    printf("%.15g %.15g %.15g %.15g %.15g", before, reset, after, steps(10, 0.0, false), weight);
    return 0;
}
"#;

#[test]
fn it_stays_through_a_reset_in_c() {
    let dir = tempfile::tempdir().unwrap();
    write(&export(&hanging(), Target::C).unwrap(), dir.path());
    std::fs::write(dir.path().join("main.c"), MAIN).unwrap();
    gcc(
        "-std=c99 -O1",
        &["main.c", "x_axis_friction.c", "-lm"],
        dir.path(),
    );
    let said = run("./a.out", &[], dir.path());
    let found: Vec<f64> = said.split(' ').map(|x| x.parse().unwrap()).collect();
    for (found, due) in found.iter().zip(due()) {
        assert!((found - due).abs() < 1e-12, "{said}: {due}");
    }
}

/// The block takes a reset as an input: held for ten cycles it keeps the weight all the time.
#[test]
fn it_stays_while_a_block_is_reset() {
    let mut library = Library::default();
    for file in export(&hanging(), Target::St).unwrap() {
        library
            .add(&String::from_utf8(file.bytes).unwrap())
            .unwrap();
    }
    let mut block = library.instance("FB_x_axis_Friction");
    let [enable, reset, velocity, position, force, weight] = [
        "enable",
        "reset",
        "reference_velocity",
        "position",
        "force",
        "part_gravity",
    ]
    .map(|name| block.slot(name));
    let [before, _, _, off, due] = due();
    let mut steps = |n: usize, v, on: bool, reset_now: bool| {
        block.set(enable, f64::from(u8::from(on)));
        block.set(reset, f64::from(u8::from(reset_now)));
        block.set(velocity, v);
        block.set(position, 0.1);
        for _ in 0..n {
            block.call();
        }
        [block.get(force), block.get(weight)]
    };
    assert!((steps(100, 0.01, true, false)[0] - before).abs() < 1e-12);
    for _ in 0..10 {
        let [force, weight] = steps(1, 0.0, true, true);
        assert!(
            (force - due).abs() < 1e-12 && (weight - due).abs() < 1e-12,
            "{force}"
        );
    }
    assert!((steps(20, 0.0, false, false)[0] - off).abs() < 1e-12);
}
