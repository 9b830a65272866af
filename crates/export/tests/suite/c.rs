//! The C text: compiled under every warning, its self-test run, and sample by sample against the compensator.

use crate::common::compiled::{
    agree, agree_over, agree_single, drive, gcc, kept, more_inputs, passive, run, write,
};
use crate::common::{adapting, all_laws, laws, model, models};
use std::process::{Command, Stdio};
use stiction_export::{Model, Target, export};
use stiction_friction::compensator::{Friction, Input, Levels};
use stiction_friction::{Damping, Direction, LuGre, Shape, Stribeck};

/// What the C has to pass; the undefined-behaviour sanitizer on top where it runs.
const STRICT: &str = "-std=c99 -pedantic -Wall -Wextra -Wconversion -Wdouble-promotion -Wshadow -Wstrict-prototypes \
     -Wmissing-prototypes -Wfloat-equal -Wsign-conversion -Wundef -Wcast-qual -O2 -Werror";
const SANITIZE: &str = "-fsanitize=undefined,float-divide-by-zero -fno-sanitize-recover=all";

#[test]
fn the_self_test_passes_under_every_warning() {
    for (name, model) in models() {
        let dir = tempfile::tempdir().unwrap();
        write(&export(&model, Target::C).unwrap(), dir.path());
        for file in ["x_axis_friction", "x_axis_friction_f32"] {
            let (source, test) = (format!("{file}.c"), format!("{file}_selftest.c"));
            gcc(&format!("{STRICT} -fanalyzer -c"), &[&source], dir.path());
            gcc(
                &format!("{STRICT} {}", SANITIZE.replace(",float-divide-by-zero", "")),
                &[&source, &test, "-lm"],
                dir.path(),
            );
            let said = run("./a.out", &[], dir.path());
            assert!(said.starts_with("ok: 183 samples"), "{name}: {said}");
        }
    }
}

/// Numbers at the ends of what a number type takes, in all combinations, give a finite self-test that passes (in double
/// precision it is only looked at); beyond them the model is refused.
#[test]
fn the_self_test_holds_to_the_ends_of_the_range() {
    let corners = |k: u32, most: f64| {
        let end = |bit: u32| [1.001 / most, 0.999 * most][(k >> bit & 1) as usize];
        let side = Direction {
            coulomb: end(0),
            static_friction: end(0).max(end(1)),
            stribeck_velocity: end(2),
            viscous: end(3),
        };
        let curve = Stribeck::symmetric(Shape::Gaussian, side, 0.0).unwrap();
        model(Friction::LuGre(
            LuGre::new(end(4), Damping::Capped(end(5)), curve).unwrap(),
        ))
    };
    for k in 0..64 {
        let mut model = corners(k, 1e15);
        model.settings.limit = 1e29;
        let dir = tempfile::tempdir().unwrap();
        write(&export(&model, Target::C).unwrap(), dir.path());
        let file = "x_axis_friction_f32";
        let (source, test) = (format!("{file}.c"), format!("{file}_selftest.c"));
        gcc("-std=c99 -O1 -Werror", &[&source, &test, "-lm"], dir.path());
        let said = run("./a.out", &[], dir.path());
        assert!(said.starts_with("ok: 183 samples"), "{k}: {said}");
        for file in export(&corners(k, 1e100), Target::Hal).unwrap() {
            let text = String::from_utf8(file.bytes).unwrap();
            let rows = text.lines().filter(|line| line.starts_with("    ("));
            assert!(
                !rows
                    .into_iter()
                    .any(|row| row.contains("inf") || row.contains("NaN"))
            );
        }
    }
    let beyond = |large: &Model| export(large, Target::C).unwrap_err().to_string();
    for (limit, typed) in [(1e31, "1e31"), (1e-40, "1e-40"), (1e-300, "1e-300")] {
        let mut model = corners(0, 1e15);
        model.settings.limit = limit;
        let said = format!("limit = {typed}; allowed: from 1e-30 to 1e30 (as float)");
        assert_eq!(beyond(&model), said);
    }
    let curve = Stribeck::symmetric(
        Shape::Gaussian,
        Direction {
            coulomb: 12.0,
            static_friction: 18.0,
            stribeck_velocity: 1e37,
            viscous: 30.0,
        },
        0.0,
    )
    .unwrap();
    let said = "stribeck_velocity = 1e37; allowed: from 1e-15 to 1e15 (as float)";
    assert_eq!(beyond(&model(Friction::Stribeck(curve))), said);

    // In single precision this slope would be 0, and the block without the input that its self-test feeds.
    let mut vanishing = model(laws().remove(0).1);
    let levels = Levels {
        load: [1e-60; 2],
        ..Levels::default()
    };
    vanishing.terms.levels = Some(levels);
    let said = "coulomb_load / coulomb = 1e-60; allowed: from 1e-30 to 1e15 (as float)";
    assert_eq!(beyond(&vanishing), said);
}

/// A self-test that is run with another parameter fails.
#[test]
fn the_self_test_notices() {
    let dir = tempfile::tempdir().unwrap();
    write(
        &export(&model(laws().remove(0).1), Target::C).unwrap(),
        dir.path(),
    );
    let path = dir.path().join("x_axis_friction.c");
    let text = std::fs::read_to_string(&path).unwrap();
    std::fs::write(
        &path,
        text.replace("params->sigma1 = 1500.0;", "params->sigma1 = 1500.1;"),
    )
    .unwrap();
    gcc(
        "-std=c99",
        &["x_axis_friction.c", "x_axis_friction_selftest.c", "-lm"],
        dir.path(),
    );
    let status = Command::new(dir.path().join("a.out"))
        .stdout(Stdio::null())
        .status()
        .unwrap();
    assert_eq!(status.code(), Some(1));
}

/// The deviations are those that stand in the page of the target, and no others.
#[test]
fn misra() {
    let dir = tempfile::tempdir().unwrap();
    let found: std::collections::BTreeSet<String> = models()
        .into_iter()
        .filter(|(name, model)| ["power", "elasto-plastic", "maxwell-slip"].contains(name) || model.settings.adaptation.is_some())
        .flat_map(|(_, model)| {
            write(&export(&model, Target::C).unwrap(), dir.path());
            let arguments = "--addon=misra --enable=style,warning,performance,portability --inconclusive --std=c99 \
                 --suppress=missingIncludeSystem --suppress=unusedStructMember --quiet --template={id} x_axis_friction.c x_axis_friction_f32.c";
            let said = run("cppcheck", &arguments.split_whitespace().collect::<Vec<_>>(), dir.path());
            said.lines().map(str::to_string).collect::<Vec<_>>()
        })
        .collect();
    let page =
        std::fs::read_to_string(stiction_testkit::workspace().join("docs/deploy/c.md")).unwrap();
    for id in &found {
        let rule = id.trim_start_matches("misra-c2012-");
        assert!(
            page.contains(&format!("| {rule} |")),
            "{found:?}: {id} is not justified in docs/deploy/c.md"
        );
    }
}

/// Reads what [`drive`] writes for a sample, writes force and what is kept.
const DRIVER: &str = r#"
#include "x_axis_friction@F@.h"
#include <stdio.h>
int main(void) {
    double in[11];
    x_axis@F@_params_t p;
    x_axis@F@_state_t s;
    x_axis@F@_params(&p);
    if (!x_axis@F@_init(&p, &s)) { return 1; }
    while (fread(in, sizeof in, 1, stdin) == 1) {
        const x_axis@F@_input_t input = { (@R@)in[1], (@R@)in[2], in[3] != 0.0@D@ };
        double out[2];
        out[0] = (double)x_axis@F@_step_in(&p, &s, (@R@)in[0], &input);
        out[1] = @Z@;
        (void)fwrite(out, sizeof out, 1, stdout);
    }
    return 0;
}
"#;

/// Force and what is kept of the compiled C for each sample.
fn through_c(model: &Model, single: bool, samples: &[(f64, Input<f64>)]) -> Vec<[f64; 2]> {
    let dir = tempfile::tempdir().unwrap();
    write(&export(model, Target::C).unwrap(), dir.path());
    let (suffix, real) = if single {
        ("_f32", "float")
    } else {
        ("", "double")
    };
    let kept = kept(&model.friction, "(double)s.deflection", |k| {
        format!("(double)s.element_force[{k}]")
    });
    let driver = DRIVER
        .replace("@F@", suffix)
        .replace(
            "@D@",
            &more_inputs(model, "(@R@)in[4], in[5] != 0.0", |k| {
                format!("(@R@)in[{k}]")
            }),
        )
        .replace("@R@", real)
        .replace("@Z@", &kept);
    std::fs::write(dir.path().join("driver.c"), driver).unwrap();
    let source = format!("x_axis_friction{suffix}.c");
    gcc(
        "-std=c99 -O2 -fsanitize=undefined -fno-sanitize-recover=all",
        &["driver.c", &source, "-lm"],
        dir.path(),
    );
    drive(dir.path(), "./a.out", samples)
}

#[test]
fn double_precision_agrees() {
    agree(
        "C",
        |_| {},
        |model, samples| through_c(model, false, samples),
    );
}

#[test]
#[ignore = "soak: every law with every Stribeck curve and number of elements"]
fn every_law_and_curve_agrees() {
    agree_over(
        "C",
        all_laws(),
        usize::MAX,
        |_| {},
        |model, samples| through_c(model, false, samples),
    );
}

#[test]
fn single_precision_agrees() {
    agree_single("C", |model, samples| through_c(model, true, samples));
}

#[test]
fn the_exported_law_is_passive() {
    for (single, rounding) in [(false, 1e-12), (true, 1e-5)] {
        passive(rounding, |model, samples| through_c(model, single, samples));
    }
}

/// As a compiler takes it that is not told which C it is: with everything that its headers declare beyond the standard.
#[test]
fn plain_compilers_take_it() {
    let dir = tempfile::tempdir().unwrap();
    write(
        &export(&model(laws().remove(0).1), Target::C).unwrap(),
        dir.path(),
    );
    for flags in [
        "",
        "-std=gnu99 -D_GNU_SOURCE",
        "-std=c17",
        "-xc++ -fpermissive",
    ] {
        for file in ["x_axis_friction.c", "x_axis_friction_f32.c"] {
            gcc(&format!("{flags} -Wall -Werror -c"), &[file], dir.path());
        }
    }
}

/// What a step takes of the stack, as gcc counts it: all functions of the file one in the other, which no call is. The
/// page of the target states it.
#[test]
fn the_stack_is_small() {
    let page =
        std::fs::read_to_string(stiction_testkit::workspace().join("docs/deploy/c.md")).unwrap();
    let mut most = 0;
    for (_, model) in models() {
        let dir = tempfile::tempdir().unwrap();
        write(&export(&model, Target::C).unwrap(), dir.path());
        for file in ["x_axis_friction", "x_axis_friction_f32"] {
            for level in ["-O2", "-O0"] {
                let flags = format!("-std=c99 {level} -fstack-usage -c");
                gcc(&flags, &[&format!("{file}.c")], dir.path());
                let usage = std::fs::read_to_string(dir.path().join(format!("{file}.su"))).unwrap();
                let bytes = usage.lines().map(|line| {
                    let fields: Vec<&str> = line.split('\t').collect();
                    assert_eq!(fields[2], "static", "{line}");
                    fields[1].parse::<usize>().unwrap()
                });
                let sum = bytes.sum::<usize>();
                println!("{file} {level}: {sum} bytes");
                if level == "-O2" {
                    most = most.max(sum);
                }
            }
        }
    }
    let stated = format!("at most {most} bytes of stack");
    assert!(
        page.contains(&stated),
        "docs/deploy/c.md does not say {stated}"
    );
}

/// The gain may be set while it runs: one that is no share is none.
#[test]
fn a_gain_out_of_range_is_none() {
    let dir = tempfile::tempdir().unwrap();
    write(
        &export(&model(laws().remove(0).1), Target::C).unwrap(),
        dir.path(),
    );
    let program = r#"
#include "x_axis_friction.h"
#include <math.h>
#include <stdio.h>
int main(void) {
    const double gains[] = { 0.5, (double)NAN, 1.5, -1.0, (double)INFINITY, 0.5 };
    x_axis_params_t p;
    x_axis_state_t s;
    x_axis_params(&p);
    p.watchdog_window = 0.0;
    p.ramp = 0.0;
    if (!x_axis_init(&p, &s)) { return 1; }
    for (int i = -9; i < 6; i++) {
        const x_axis_input_t input = { 0.05, 0.0, true };
        p.gain = gains[(i < 0) ? 0 : i];
        const double force = x_axis_step(&p, &s, &input);
        if (i >= 0) { (void)printf("%.2f ", force); }
    }
    return 0;
}
"#;
    std::fs::write(dir.path().join("main.c"), program).unwrap();
    gcc(
        "-std=c99",
        &["main.c", "x_axis_friction.c", "-lm"],
        dir.path(),
    );
    // Fc and 30 N s/m at 50 mm/s: 13.5 N.
    let said = run("./a.out", &[], dir.path());
    assert_eq!(said, "6.75 0.00 0.00 0.00 0.00 6.75 ");
}

/// A limit or slew that is no number, whenever it comes, lets no force out, and a window that is none no force in; with
/// good ones it comes back.
#[test]
fn settings_that_are_none_give_no_force() {
    let dir = tempfile::tempdir().unwrap();
    write(
        &export(&model(laws().remove(0).1), Target::C).unwrap(),
        dir.path(),
    );
    let program = r#"
#include "x_axis_friction.h"
#include <math.h>
#include <stdio.h>
int main(void) {
    const double bad[] = { (double)NAN, -1.0, 0.0, (double)INFINITY };
    x_axis_params_t p;
    x_axis_state_t s;
    const x_axis_input_t input = { 0.05, 0.0, true };
    x_axis_params(&p);
    p.watchdog_window = 0.0;
    p.ramp = 0.0;
    if (!x_axis_init(&p, &s)) { return 1; }
    for (int which = 0; which < 2; which++) {
        for (int i = 0; i < 4; i++) {
            x_axis_params_t q = p;
            *(which ? &q.limit : &q.slew) = bad[i];
            for (int k = 0; k < 9; k++) { (void)x_axis_step(&p, &s, &input); }
            (void)printf("%.2f ", s.output);
            for (int k = 0; k < 9; k++) { (void)x_axis_step(&q, &s, &input); }
            (void)printf("%.2f, ", s.output);
        }
    }
    p.watchdog_window = (double)NAN;
    x_axis_reset(&p, &s);
    for (int k = 0; k < 9; k++) { (void)x_axis_step(&p, &s, &input); }
    (void)printf("%.2f\n", s.output);
    return 0;
}
"#;
    std::fs::write(dir.path().join("main.c"), program).unwrap();
    gcc(
        "-std=c99",
        &["main.c", "x_axis_friction.c", "-lm"],
        dir.path(),
    );
    // 0.75 of Fc and 30 N s/m at 50 mm/s.
    let said = run("./a.out", &[], dir.path());
    assert_eq!(said, format!("{}0.00\n", "10.12 0.00, ".repeat(8)));
}

#[test]
fn the_example_runs() {
    let dir = tempfile::tempdir().unwrap();
    write(
        &export(&model(laws().remove(0).1), Target::C).unwrap(),
        dir.path(),
    );
    let example = stiction_testkit::workspace().join("examples/export/c/axis.c");
    gcc(
        "-std=c99 -O2 -Wall -Wextra -Werror -I.",
        &[&example.to_string_lossy(), "x_axis_friction.c", "-lm"],
        dir.path(),
    );
    let said = run("./a.out", &[], dir.path());
    assert_eq!(said, "6.15 N at 10 mm/s\n-6.15 N at -10 mm/s\n");
}

/// A program in C++ links what a C compiler made.
#[test]
fn cpp_includes_the_header() {
    let dir = tempfile::tempdir().unwrap();
    write(
        &export(&model(laws().remove(0).1), Target::C).unwrap(),
        dir.path(),
    );
    let program = r#"
#include "x_axis_friction.h"
#include "x_axis_friction_f32.h"
int main()
{
    x_axis_params_t params;
    x_axis_state_t state;
    x_axis_params(&params);
    x_axis_f32_params_t small;
    x_axis_f32_params(&small);
    return x_axis_init(&params, &state) && params.limit == small.limit ? 0 : 1;
}
"#;
    std::fs::write(dir.path().join("main.cpp"), program).unwrap();
    for file in ["x_axis_friction", "x_axis_friction_f32"] {
        gcc("-std=c99 -O2 -c", &[&format!("{file}.c")], dir.path());
    }
    let objects = ["x_axis_friction.o", "x_axis_friction_f32.o"];
    let rest = [
        &["-Wall", "-Wextra", "-Werror", "main.cpp"],
        &objects[..],
        &["-lm"],
    ]
    .concat();
    run("g++", &rest, dir.path());
    run("./a.out", &[], dir.path());
}

/// What was learnt comes back after the drive was off; what is damaged or of another model does not.
#[test]
fn a_memory_is_recalled_or_refused() {
    let program = r#"
#include "x_axis_friction.h"
#include "other_friction.h"
#include <stdio.h>
int main(void)
{
    x_axis_params_t params;
    x_axis_state_t state, morning;
    x_axis_params(&params);
    params.watchdog_window = 0.1;
    (void)x_axis_init(&params, &state);
    for (int k = 0; k < 16000; k++) {
        /* to and fro in 0.2 s, with a force of the drive of 1.2 times 12 N, and 30 N s/m as identified */
        const bool onward = (k / 100) % 2 == 0;
        const double v = onward ? 0.05 : -0.05;
        const x_axis_input_t input = { v, 1e-6, false, (onward ? 1.0 : -1.0) * (1.2 * 12.0 + 1.5), k % 100 > 5 };
        (void)x_axis_step(&params, &state, &input);
    }
    x_axis_memory_t memory = x_axis_memory(&state);
    (void)x_axis_init(&params, &morning);
    (void)printf("%d ", x_axis_recall(&params, &morning, &memory));
    (void)printf("%.2f %.2f %d %d; ", morning.level_dry, morning.level_viscous, morning.learned, morning.baseline == state.baseline);
    int taken = 0;
    for (int k = 0; k < 12; k++) {
        x_axis_memory_t damaged = memory;
        damaged.number[k] *= 1.0 + 1e-15;
        damaged.number[k] += (damaged.number[k] == memory.number[k]) ? 1e-300 : 0.0;
        taken += x_axis_recall(&params, &morning, &damaged) ? 1 : 0;
    }
    /* levels beyond their band, and a mean square beyond the square of the peak */
    const int at[] = { 1, 2, 2, 3 };
    const double no[] = { 5.0, -5.0, 0.4, 1e9 };
    for (int k = 0; k < 4; k++) {
        x_axis_memory_t strange_one = memory;
        strange_one.number[at[k]] = no[k];
        strange_one.number[at[k] + 6] = -no[k];
        taken += x_axis_recall(&params, &morning, &strange_one) ? 1 : 0;
    }
    /* while force is let out */
    const x_axis_input_t moving = { 0.05, 1e-9, true, 1.0, false };
    (void)x_axis_step(&params, &morning, &moving);
    taken += (morning.share > 0.0) ? 0 : 10;
    taken += x_axis_recall(&params, &morning, &memory) ? 1 : 0;
    (void)x_axis_init(&params, &morning);
    const x_axis_memory_t none = { { 0.0 } };
    taken += x_axis_recall(&params, &morning, &none) ? 1 : 0;
    other_params_t strange;
    other_state_t its;
    other_params(&strange);
    (void)other_init(&strange, &its);
    other_memory_t foreign;
    for (int k = 0; k < 12; k++) { foreign.number[k] = memory.number[k]; }
    taken += other_recall(&strange, &its, &foreign) ? 1 : 0;
    (void)printf("%d", taken);
    return 0;
}
"#;
    let dir = tempfile::tempdir().unwrap();
    let mut mine = model(laws().remove(0).1);
    mine.settings = adapting(mine.settings);
    write(&export(&mine, Target::C).unwrap(), dir.path());
    let mut other = model(laws().remove(1).1);
    other.identifier = "other".into();
    write(&export(&other, Target::C).unwrap(), dir.path());
    std::fs::write(dir.path().join("main.c"), program).unwrap();
    let sources = ["main.c", "x_axis_friction.c", "other_friction.c", "-lm"];
    gcc("-std=c99 -O2 -Wall -Wextra", &sources, dir.path());
    assert_eq!(run("./a.out", &[], dir.path()), "1 1.20 1.00 1 1; 0");
}

/// Settings of the levels, or an offset, that become none while it runs: nothing is learnt from them, the force fades, and it comes
/// back with good ones.
#[test]
fn levels_outlive_settings_that_are_none() {
    let program = r#"
#include "x_axis_friction.h"
#include <math.h>
#include <stdio.h>
int main(void)
{
    const double bad[] = { (double)NAN, -1.0, 0.0, 1.0, (double)INFINITY, -(double)INFINITY, -2.0 };
    for (int which = 0; which < 3; which++) {
        for (int b = 0; b < 7; b++) {
            x_axis_params_t params;
            x_axis_state_t state;
            x_axis_params(&params);
            params.watchdog_window = 0.0;
            (void)x_axis_init(&params, &state);
            double most = 0.0;
            for (int k = 0; k < 6000; k++) {
                const bool onward = (k / 100) % 2 == 0;
                const x_axis_input_t input = { onward ? 0.05 : -0.05, 1e-6, k < 5000, onward ? 16.2 : -16.2, k % 100 > 5 };
                x_axis_params_t now = params;
                if (k >= 2000 && k < 2020) {
                    *(which == 0 ? &now.range : which == 1 ? &now.memory : &now.offset) = bad[b];
                }
                const double force = fabs(x_axis_step(&now, &state, &input));
                most = (force <= most) ? most : force;
            }
            if (!(most < 30.0) || !(fabs(state.level_dry - 1.2) < 0.05) || state.output != 0.0) {
                (void)printf("%d %g: %g %g %g; ", which, bad[b], most, state.level_dry, state.output);
            }
        }
    }
    (void)printf("done");
    return 0;
}
"#;
    let dir = tempfile::tempdir().unwrap();
    let mut model = model(laws().remove(0).1);
    model.settings = adapting(model.settings);
    write(&export(&model, Target::C).unwrap(), dir.path());
    std::fs::write(dir.path().join("main.c"), program).unwrap();
    gcc(
        "-std=c99 -O2",
        &["main.c", "x_axis_friction.c", "-lm"],
        dir.path(),
    );
    assert_eq!(run("./a.out", &[], dir.path()), "done");
}

/// A limit that is lowered while it runs holds from the next step on, whatever the slew limit.
#[test]
fn a_lowered_limit_acts_at_once() {
    let dir = tempfile::tempdir().unwrap();
    write(
        &export(&model(laws().remove(0).1), Target::C).unwrap(),
        dir.path(),
    );
    let program = r#"
#include "x_axis_friction.h"
#include <stdio.h>
int main(void)
{
    x_axis_params_t params;
    x_axis_state_t state;
    const x_axis_input_t input = { 0.1, 0.0, true };
    x_axis_params(&params);
    params.watchdog_window = 0.0;
    params.slew = 100.0;
    (void)x_axis_init(&params, &state);
    for (int k = 0; k < 1000; k++) {
        (void)x_axis_step(&params, &state, &input);
    }
    const double before = x_axis_step(&params, &state, &input);
    params.limit = 2.5;
    const double lowered = x_axis_step(&params, &state, &input);
    params.limit = 1.5;
    /* a time that is none */
    (void)printf("%.2f %.2f %.2f", before, lowered, x_axis_step_in(&params, &state, -1.0, &input));
    return 0;
}
"#;
    std::fs::write(dir.path().join("main.c"), program).unwrap();
    gcc(
        "-std=c99 -O2",
        &["main.c", "x_axis_friction.c", "-lm"],
        dir.path(),
    );
    assert_eq!(run("./a.out", &[], dir.path()), "11.25 2.50 1.50");
}

/// A setting that becomes none while it runs counts as a watchdog that tripped: the force is gone after a ramp, whatever the error,
/// and stays away once the setting is good again, until a reset; the weight of an axis is held on.
#[test]
fn a_setting_that_becomes_none_trips() {
    let program = r#"
#include "x_axis_friction.h"
#include <math.h>
#include <stdio.h>
int main(void)
{
    const double bad[] = { (double)NAN, (double)INFINITY, -(double)INFINITY, -1.0 };
    for (int which = 0; which < 5; which++) {
        for (int b = 0; b < 4; b++) {
            x_axis_params_t params;
            x_axis_state_t state;
            x_axis_params(&params);
            params.watchdog_window = 0.1;
            (void)x_axis_init(&params, &state);
            double before = 0.0;
            double during = 0.0;
            double after = 0.0;
            for (int k = 0; k < 12000; k++) {
                /* to and fro in 0.2 s; from 5 s on with an error of 1000 times the one without compensation */
                const bool onward = (k / 100) % 2 == 0;
                const x_axis_input_t input = { onward ? 0.05 : -0.05, (k < 5000) ? 1e-6 : 1e-3, k >= 2000 };
                x_axis_params_t now = params;
                if (k >= 5000 && k < 8000) {
                    double *const settings[] = { &now.dead_zone, &now.ramp, &now.watchdog_window, &now.watchdog_ratio, &now.cycle_time };
                    *settings[which] = bad[b];
                }
                const double force = fabs(x_axis_step(&now, &state, &input));
                double *const most = (k < 5000) ? &before : (k < 5100) ? &(double){ 0.0 } : (k < 8000) ? &during : &after;
                *most = (force > *most) ? force : *most;
            }
            const bool off = which == 4 || (state.tripped && state.reason == 3u && !(after > 0.0));
            if (!(before > 9.0) || during > 0.0 || !off) {
                (void)printf("%d %g: %g %g %g %u; ", which, bad[b], before, during, after, state.reason);
            }
        }
    }
    (void)printf("done");
    return 0;
}
"#;
    let dir = tempfile::tempdir().unwrap();
    write(
        &export(&model(laws().remove(0).1), Target::C).unwrap(),
        dir.path(),
    );
    std::fs::write(dir.path().join("main.c"), program).unwrap();
    gcc(
        "-std=c99 -O2",
        &["main.c", "x_axis_friction.c", "-lm"],
        dir.path(),
    );
    assert_eq!(run("./a.out", &[], dir.path()), "done");
}

/// A header, source or self-test of another model or other settings does not compile with the others.
#[test]
fn files_of_two_exports_do_not_compile_together() {
    let mut other = model(laws().remove(0).1);
    other.settings.gain = 0.5;
    let [own, other] = [model(laws().remove(0).1), other].map(|m| export(&m, Target::C).unwrap());
    for suffix in ["", "_f32"] {
        let names = [".h", ".c", "_selftest.c"].map(|end| format!("x_axis_friction{suffix}{end}"));
        for from_other in [None, Some(0), Some(1), Some(2)] {
            let dir = tempfile::tempdir().unwrap();
            write(&own, dir.path());
            if let Some(k) = from_other {
                let file = other.iter().find(|file| file.path == names[k]).unwrap();
                std::fs::write(dir.path().join(&names[k]), &file.bytes).unwrap();
            }
            let arguments = ["-std=c99", "-c", &names[1], &names[2]];
            let compiled = std::process::Command::new("gcc")
                .args(arguments)
                .current_dir(dir.path())
                .output()
                .unwrap();
            assert_eq!(
                compiled.status.success(),
                from_other.is_none(),
                "{names:?}, {from_other:?}"
            );
        }
    }
}
