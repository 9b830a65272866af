//! The functions of MATLAB, run by Octave beside the compensator, and the S-function behind a stand-in for Simulink. Neither
//! MATLAB nor Simulink is run.

use crate::common::compiled::{Sample, agree, agree_over, drive, gcc, run, through_rust, write};
use crate::common::terms::extras;
use crate::common::{GUARDED, all_laws, busy, guarded, laws, model, models, random};
use crate::mujoco::python;
use std::path::Path;
use stiction_export::{Model, Target, export};
use stiction_friction::compensator::Friction;

fn octave(script: &str, dir: &Path) -> String {
    let options = ["--no-gui", "--no-history", "--no-init-file", "--quiet"];
    let program = ["--eval", script];
    run("octave-cli", &[&options[..], &program].concat(), dir)
}

#[test]
fn the_self_test_passes() {
    for (name, model) in models() {
        let dir = tempfile::tempdir().unwrap();
        write(&export(&model, Target::Matlab).unwrap(), dir.path());
        let said = octave("x_axis_friction_selftest;", dir.path());
        assert!(said.contains("ok: 183 samples"), "{name}: {said}");
    }
}

/// MISS_HIT, a parser and checker of MATLAB, reads all files as those of version 2017b.
const LINT: &str = "
import sys
from miss_hit.mh_lint import main
sys.argv = ['mh_lint', '--ignore-config', '--matlab', '2017b', '.']
sys.exit(main())
";

#[test]
fn miss_hit_reads_it_as_matlab() {
    for (name, model) in models() {
        let dir = tempfile::tempdir().unwrap();
        write(&export(&model, Target::Matlab).unwrap(), dir.path());
        std::fs::write(dir.path().join("lint.py"), LINT).unwrap();
        let said = python("lint.py", &[], dir.path());
        assert!(
            said.contains("8 file(s) analysed, everything seems fine"),
            "{name}: {said}"
        );
    }
}

/// Reads the samples of the other targets' drivers from a file, and writes what they write.
const DRIVER: &str = "
file = fopen('in.bin'); in = fread(file, [11, Inf], 'double'); fclose(file);
params = x_axis_params(); state = x_axis_init(params);
out = zeros(2, size(in, 2));
for k = 1:size(in, 2)
    x = in(:, k);
    input.reference_velocity = x(2); input.tracking_error = x(3); input.enable = x(4) ~= 0;
    @MORE@
    [force, state] = x_axis_step(params, state, input, x(1));
    out(:, k) = [force; @KEPT@];
end
file = fopen('out.bin', 'w'); fwrite(file, out, 'double'); fclose(file);
";

fn through_octave(model: &Model, samples: &[Sample]) -> Vec<[f64; 2]> {
    let dir = tempfile::tempdir().unwrap();
    write(&export(model, Target::Matlab).unwrap(), dir.path());
    let bytes: Vec<u8> = samples
        .iter()
        .flat_map(|(h, input)| {
            [
                *h,
                input.reference_velocity,
                input.tracking_error,
                f64::from(u8::from(input.enable)),
                input.drive_force,
                f64::from(u8::from(input.learn)),
                input.reference_acceleration,
                input.position,
                input.load,
                input.temperature,
                input.transmitted,
            ]
        })
        .flat_map(f64::to_le_bytes)
        .collect();
    std::fs::write(dir.path().join("in.bin"), bytes).unwrap();
    let drive = "input.drive_force = x(5); input.learn = x(6) ~= 0;";
    let drive = model.settings.adaptation.map(|_| drive.to_string());
    let each = extras(model)
        .into_iter()
        .map(|(name, at)| format!(" input.{name} = x({});", at + 1));
    let more: String = drive.into_iter().chain(each).collect();
    let kept = match &model.friction {
        Friction::Gms(_) => "sum(state.element_force .^ 2 ./ (2 * params.element_stiffness))",
        law if law.bristle().is_some() => "state.deflection",
        _ => "0",
    };
    let script = DRIVER.replace("@MORE@", &more).replace("@KEPT@", kept);
    octave(&script, dir.path());
    let out = std::fs::read(dir.path().join("out.bin")).unwrap();
    let number = |bytes: &[u8]| f64::from_le_bytes(bytes.try_into().unwrap());
    out.chunks_exact(16)
        .map(|pair| [number(&pair[..8]), number(&pair[8..])])
        .collect()
}

/// Samples of a run: Octave takes some 0.3 ms for each.
const SAMPLES: usize = 500;

#[test]
fn octave_agrees() {
    agree_over("Octave", laws(), SAMPLES, |_| {}, through_octave);
}

#[test]
#[ignore = "soak: every law with every curve and number of elements, for minutes"]
fn octave_agrees_in_every_law() {
    agree_over("Octave", all_laws(), 2_000, |_| {}, through_octave);
}

/// A watchdog that learns, judges and trips over a motion that is long enough for it.
#[test]
fn the_watchdog_agrees() {
    let (_, friction) = laws().pop().unwrap();
    let mut model = model(friction);
    model.settings = busy();
    let mut samples = guarded(friction, busy(), GUARDED[2], &mut random(2));
    samples.truncate(9_000);
    let due = through_rust(friction, busy(), model.terms, &samples);
    let on = due.iter().filter(|force| **force != 0.0).count();
    assert!(due[8_999] == 0.0 && on > 1_000, "{on}");
    for (i, ([force, _], due)) in through_octave(&model, &samples)
        .into_iter()
        .zip(due)
        .enumerate()
    {
        assert!(
            (force - due).abs() <= 1e-12 * friction.scale(),
            "{i}: {force} {due}"
        );
    }
}

/// The page of the target runs this file.
#[test]
fn the_example_runs() {
    let dir = tempfile::tempdir().unwrap();
    write(
        &export(&model(laws().remove(0).1), Target::Matlab).unwrap(),
        dir.path(),
    );
    let example = stiction_testkit::workspace().join("examples/export/matlab/axis.m");
    let example = example.to_string_lossy();
    let said = run("octave-cli", &["--path", ".", &example], dir.path());
    // A share of a half of 12 N and 30 N s/m at 10 mm/s, both ways.
    assert!(
        said.contains("6.15 N at 10 mm/s") && said.contains("-6.15 N at -10 mm/s"),
        "{said}"
    );
}

const STRICT: &str = "-std=c99 -pedantic -Wall -Wextra -Wconversion -Wshadow -Wfloat-equal -Wsign-conversion -Wundef -Wcast-qual -O2 -Werror";

/// The S-function behind the stand-in, with the places of its inputs in a sample.
fn build(model: &Model, dir: &Path) {
    write(&export(model, Target::Matlab).unwrap(), dir);
    let adapts = model.settings.adaptation.is_some();
    let drive = if adapts { &[4, 5][..] } else { &[] };
    let inputs = [1, 2, 3, -1].into_iter().chain(drive.iter().copied());
    let inputs: Vec<String> = inputs
        .chain(extras(model).into_iter().map(|(_, at)| at as i32))
        .map(|at| at.to_string())
        .collect();
    let stand_in = stiction_testkit::workspace().join("crates/export/tests/matlab");
    let options = format!("{STRICT} -DMATLAB_MEX_FILE -I{}", stand_in.display());
    let order = format!("-DORDER={}", inputs.join(","));
    let rest = [&order, "x_axis_friction_sfun.c", "x_axis_friction.c", "-lm"];
    gcc(&options, &rest, dir);
}

fn through_block(model: &Model, samples: &[Sample]) -> Vec<[f64; 2]> {
    let dir = tempfile::tempdir().unwrap();
    build(model, dir.path());
    let (gain, limit) = (model.settings.gain, model.settings.limit);
    std::fs::write(
        dir.path().join("block"),
        format!("#!/bin/sh\nexec ./a.out {gain:?} {limit:?}\n"),
    )
    .unwrap();
    run("chmod", &["+x", "block"], dir.path());
    drive(dir.path(), "./block", samples)
}

#[test]
fn the_block_agrees() {
    let regular = |samples: &mut [Sample]| samples.iter_mut().for_each(|(h, _)| *h = 1e-3);
    agree("S-function", regular, through_block);
}

/// A reset is held: nothing comes out, but a weight that is fed forward; what was learnt is gone after it.
#[test]
fn a_block_is_reset() {
    let (_, friction) = laws().pop().unwrap();
    let mut model = model(friction);
    model.settings = busy();
    let mut samples = guarded(friction, busy(), GUARDED[0], &mut random(1));
    let before = through_block(&model, &samples);
    for (h, _) in &mut samples[10_000..10_010] {
        *h = -1.0;
    }
    let found = through_block(&model, &samples);
    assert_eq!(before[..10_000], found[..10_000]);
    assert!(
        before[10_000..10_010]
            .iter()
            .any(|[force, _]| force.abs() > 1.0)
    );
    assert!(found[10_000..14_000].iter().all(|[force, _]| *force == 0.0));
    assert!(found[19_000..].iter().any(|[force, _]| force.abs() > 1.0));
}

/// What is wrong with a parameter of the block is said in words.
#[test]
fn a_block_refuses_its_parameters() {
    let dir = tempfile::tempdir().unwrap();
    build(&model(laws().pop().unwrap().1), dir.path());
    for (gain, limit, says) in [
        (
            "1.1",
            "40",
            "the first parameter, the gain, has to be from 0 to 1",
        ),
        ("nan", "40", "the first parameter"),
        (
            "0.5",
            "0",
            "the second parameter, the limit in N, has to be above 0",
        ),
    ] {
        let said = run("./a.out", &[gain, limit], dir.path());
        assert!(said.contains(says), "{said}");
    }
}

/// The script that makes the block, with functions of Octave that write down what they are asked in place of those of Simulink.
#[test]
fn the_script_makes_the_block() {
    let dir = tempfile::tempdir().unwrap();
    for (_, model) in models() {
        write(&export(&model, Target::Matlab).unwrap(), dir.path());
        for name in ["mex", "new_system", "add_block", "set_param", "open_system"] {
            let text = format!(
                "function {name}(varargin)\nprintf('{name}'); printf(' %s', cellfun(@(x) strtrim(disp(x)), varargin, 'UniformOutput', false){{:}}); printf('\\n');\nend\n"
            );
            std::fs::write(dir.path().join(format!("{name}.m")), text).unwrap();
        }
        let said = octave("x_axis_friction_block();", dir.path());
        for part in [
            "x_axis_friction_sfun.c",
            "add_block simulink/User-Defined Functions/S-Function x_axis_friction_model/x_axis friction",
            "FunctionName x_axis_friction_sfun Parameters 0.75, 60.0 SFunctionModules x_axis_friction",
            "port_label('input', 4, 'reset')",
            "port_label('output', 1, 'force')",
        ] {
            assert!(said.contains(part), "{said}");
        }
        let parts = said.contains("part_friction");
        assert_eq!(parts, model.terms.mass > 0.0, "{said}");
    }
}
