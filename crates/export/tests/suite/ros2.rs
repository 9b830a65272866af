//! The class for ROS 2: its self-test, and with parameters that yaml-cpp read from the file beside the compensator with the
//! same settings. No part of ROS is run.

use crate::common::compiled::{drive, run, through_rust, write};
use crate::common::{adapting, adversarial, busy, laws, model, models, random};
use stiction_export::{Target, export};
use stiction_friction::compensator::{Settings, Terms};

const STRICT: &[&str] = &[
    "-std=c++11",
    "-pedantic",
    "-Wall",
    "-Wextra",
    "-Wconversion",
    "-Wshadow",
    "-Wfloat-equal",
    "-Wsign-conversion",
    "-Werror",
    "-fno-exceptions",
    "-fno-rtti",
    "-O2",
    "-Iinclude",
];

#[test]
fn the_self_test_passes() {
    for (name, model) in models() {
        let dir = tempfile::tempdir().unwrap();
        write(&export(&model, Target::Ros2).unwrap(), dir.path());
        run(
            "g++",
            &[STRICT, &["test/selftest.cpp", "-o", "selftest"]].concat(),
            dir.path(),
        );
        let said = run("./selftest", &[], dir.path());
        assert!(said.starts_with("ok f64: 183 samples"), "{name}: {said}");
    }
}

/// What a node does: the parameters come from the file that is named, each by its name.
const NODE: &str = r#"
#include <stdio.h>
#include <string>
#include <x_axis_friction_ros2.hpp>
#include <yaml-cpp/yaml.h>

struct Node {
    YAML::Node tree;
    unsigned asked;
    double declare_parameter(const std::string &name, double)
    {
        asked++;
        const size_t dot = name.find('.');
        return tree[name.substr(0, dot)][name.substr(dot + 1)].as<double>();
    }
};

int main(int, char **argv)
{
    Node node;
    node.asked = 0;
    node.tree = YAML::LoadFile(argv[1])["/**"]["ros__parameters"];
    const x_axis_friction::ros2::Parameters parameters = x_axis_friction::ros2::parameters(
        [&node](const char *name, double preset) { return node.declare_parameter(name, preset); });
    if (node.asked != node.tree["x_axis_friction"].size()) { return 2; }
    x_axis_friction::ros2::Friction friction;
    if (!friction.configure(parameters)) { return 1; }
    double in[11];
    while (fread(in, sizeof in, 1, stdin) == 1) {
        const x_axis_friction::f64::Input input = { in[1], in[2], in[3] != 0.0, in[4], in[5] != 0.0 };
        const double out[2] = { friction.step(in[0], input), 0.0 };
        (void)fwrite(out, sizeof out, 1, stdout);
    }
    return 0;
}
"#;

/// The settings that were exported, and others written into the file by hand.
#[test]
fn the_parameters_are_those_of_the_file() {
    for (k, (name, friction)) in laws().into_iter().enumerate() {
        let dir = tempfile::tempdir().unwrap();
        let mut model = model(friction);
        model.settings = adapting(busy());
        write(&export(&model, Target::Ros2).unwrap(), dir.path());
        std::fs::write(dir.path().join("node.cpp"), NODE).unwrap();
        let rest = [
            "-std=c++11",
            "-O2",
            "-Iinclude",
            "node.cpp",
            "-lyaml-cpp",
            "-o",
            "node",
        ];
        run("g++", &rest, dir.path());
        let file = dir.path().join("config/x_axis_friction.yaml");
        let text = std::fs::read_to_string(&file).unwrap();
        let by_hand = [
            ("gain: 0.9 ", "gain: 0.6 "),
            ("limit: 33.0 ", "limit: 21.0 "),
            ("ramp: 0.02 ", "ramp: 0.01 "),
            ("dead_zone: 1.0e-5 ", "dead_zone: 2.0e-5 "),
            ("slew: 8000.0 ", "slew: 9000.0 "),
            ("window: 0.5 ", "window: 0.0 "),
        ];
        let mut changed = text.clone();
        for (from, to) in by_hand {
            assert!(changed.contains(from), "{changed}");
            changed = changed.replace(from, to);
        }
        std::fs::write(dir.path().join("config/other.yaml"), changed).unwrap();
        let other = Settings {
            gain: 0.6,
            limit: 21.0,
            ramp: 0.01,
            dead_zone: 2e-5,
            slew: 9000.0,
            watchdog: None,
            ..model.settings
        };
        let samples = adversarial(50_000, true, &mut random(k as u64));
        for (file, settings) in [("x_axis_friction", model.settings), ("other", other)] {
            let started = dir.path().join(file);
            let script = format!("#!/bin/sh\nexec ./node config/{file}.yaml\n");
            std::fs::write(&started, script).unwrap();
            run("chmod", &["+x", file], dir.path());
            let found = drive(dir.path(), file, &samples);
            let due = through_rust(friction, settings, Terms::default(), &samples);
            assert_eq!(found.len(), due.len(), "{name} {file}");
            for (i, ([force, _], due)) in found.into_iter().zip(due).enumerate() {
                let allowed =
                    (4.0 * f64::EPSILON * due.abs().max(friction.scale())).max(1e-12 * due.abs());
                assert!(
                    (force - due).abs() <= allowed,
                    "{name} {file} {i}: {force} {due}"
                );
            }
        }
    }
}

/// A parameter out of range lets no force out.
#[test]
fn a_parameter_out_of_range_gives_no_force() {
    let program = r#"
#include <math.h>
#include <stdio.h>
#include <x_axis_friction_ros2.hpp>
int main()
{
    x_axis_friction::ros2::Friction friction;
    x_axis_friction::ros2::Parameters parameters;
    parameters.window = 0.0;
    parameters.ramp = 0.0;
    const x_axis_friction::f64::Input input = { 0.05, 0.0, true };
    for (int k = 0; k < 3; k++) {
        parameters.gain = (k == 1) ? double(NAN) : 0.75;
        const bool taken = friction.configure(parameters);
        for (int i = 0; i < 50; i++) { (void)friction.step(1e-3, input); }
        (void)printf("%d %.2f; ", taken, friction.state().output);
    }
    return 0;
}
"#;
    let dir = tempfile::tempdir().unwrap();
    write(
        &export(&model(laws().remove(0).1), Target::Ros2).unwrap(),
        dir.path(),
    );
    std::fs::write(dir.path().join("main.cpp"), program).unwrap();
    run("g++", &["-std=c++11", "-Iinclude", "main.cpp"], dir.path());
    // 0.75 of Fc and 30 N s/m at 50 mm/s.
    assert_eq!(
        run("./a.out", &[], dir.path()),
        "1 10.12; 0 0.00; 1 10.12; "
    );
}
