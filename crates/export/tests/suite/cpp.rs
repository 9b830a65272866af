//! The C++ library: compiled under every warning, its self-test run here, on a simulated AVR and a simulated ARM, and sample
//! by sample against the compensator.

use crate::common::compiled::{
    agree, agree_single, drive, have, kept, more_inputs, passive, run, write,
};
use crate::common::{adapting, laws, model, models};
use std::path::Path;
use std::process::Command;
use stiction_export::{Model, Target, export};
use stiction_friction::compensator::Input;

const STRICT: &str = "-std=c++11 -pedantic -Wall -Wextra -Wconversion -Wdouble-promotion -Wshadow -Wfloat-equal \
     -Wsign-conversion -Wundef -Wcast-qual -fno-exceptions -fno-rtti -Werror";

fn library(model: &Model) -> tempfile::TempDir {
    let dir = tempfile::tempdir().unwrap();
    write(&export(model, Target::Cpp).unwrap(), dir.path());
    dir
}

fn build(compiler: &str, flags: &str, rest: &[&str], dir: &Path) {
    let mut arguments: Vec<&str> = flags.split_whitespace().collect();
    arguments.extend(rest);
    run(compiler, &arguments, dir);
}

/// The page of the target.
fn page() -> String {
    std::fs::read_to_string(stiction_testkit::workspace().join("docs/deploy/cpp.md")).unwrap()
}

fn is_passed(said: &str, name: &str) {
    let ok = |bits: &str| said.contains(&format!("ok {bits}: 183 samples"));
    assert!(ok("f32") && !said.contains("FAIL"), "{name}: {said}");
}

#[test]
fn the_self_test_passes_under_every_warning() {
    for (name, model) in models() {
        let dir = library(&model);
        for (level, more) in [
            ("-O2", ""),
            ("-O0", "-fsanitize=undefined -fno-sanitize-recover=all"),
        ] {
            let flags = format!("{STRICT} {level} {more} -Isrc -o selftest");
            build("g++", &flags, &["extras/selftest.cpp"], dir.path());
            let said = run("./selftest", &[], dir.path());
            is_passed(&said, name);
            assert!(said.contains("ok f64: 183 samples"), "{name}: {said}");
        }
    }
}

/// A self-test that is run with another parameter fails, in both precisions.
#[test]
fn the_self_test_notices() {
    let dir = library(&model(laws().remove(0).1));
    for bits in ["f32", "f64"] {
        let path = dir.path().join(format!("src/x_axis_friction_{bits}.hpp"));
        let text = std::fs::read_to_string(&path).unwrap();
        let changed = text.replace("params->sigma1 = 1500.0", "params->sigma1 = 1501.0");
        assert_ne!(changed, text);
        std::fs::write(&path, changed).unwrap();
    }
    build(
        "g++",
        "-std=c++11 -Isrc -o selftest",
        &["extras/selftest.cpp"],
        dir.path(),
    );
    let output = Command::new(dir.path().join("selftest")).output().unwrap();
    let said = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(
        said.contains("FAIL f32") && said.contains("FAIL f64"),
        "{said}"
    );
}

/// Reads what [`drive`] writes for a sample, writes force and what is kept.
const DRIVER: &str = r#"
#include <stdio.h>
#include <x_axis_friction.hpp>
namespace axis = x_axis_friction::@B@;
int main()
{
    double in[11];
    axis::Compensator compensator;
    if (!compensator.ready()) { return 1; }
    while (fread(in, sizeof in, 1, stdin) == 1) {
        typedef axis::Real Real;
        const axis::Input input = { Real(in[1]), Real(in[2]), in[3] != 0.0@D@ };
        double out[2];
        out[0] = double(compensator.step_in(Real(in[0]), input));
        out[1] = @Z@;
        (void)fwrite(out, sizeof out, 1, stdout);
    }
    return 0;
}
"#;

/// Force and what is kept of the compiled library for each sample.
fn through_cpp(model: &Model, bits: &str, samples: &[(f64, Input<f64>)]) -> Vec<[f64; 2]> {
    let dir = library(model);
    let more = more_inputs(model, "Real(in[4]), in[5] != 0.0", |k| {
        format!("Real(in[{k}])")
    });
    let kept = kept(
        &model.friction,
        "double(compensator.state().deflection)",
        |k| format!("double(compensator.state().element_force[{k}])"),
    );
    let driver = DRIVER
        .replace("@B@", bits)
        .replace("@D@", &more)
        .replace("@Z@", &kept);
    std::fs::write(dir.path().join("driver.cpp"), driver).unwrap();
    let flags = "-std=c++11 -O2 -fno-exceptions -fno-rtti -fsanitize=undefined -fno-sanitize-recover=all -Isrc";
    build("g++", flags, &["driver.cpp"], dir.path());
    drive(dir.path(), "./a.out", samples)
}

#[test]
fn double_precision_agrees() {
    agree(
        "C++",
        |_| {},
        |model, samples| through_cpp(model, "f64", samples),
    );
}

#[test]
fn single_precision_agrees() {
    agree_single("C++", |model, samples| through_cpp(model, "f32", samples));
}

#[test]
fn the_exported_law_is_passive() {
    for (bits, rounding) in [("f64", 1e-12), ("f32", 1e-5)] {
        passive(rounding, |model, samples| through_cpp(model, bits, samples));
    }
}

/// Two axes in two files of a program, newer compilers, and what was learnt: one definition of each function is left, and a
/// memory is taken by the axis that it is of alone.
#[test]
fn two_axes_in_one_program() {
    let dir = library(&model(laws().remove(0).1));
    let mut other = model(laws().remove(1).1);
    other.identifier = "y".into();
    write(&export(&other, Target::Cpp).unwrap(), dir.path());
    let first = r#"
#include <x_axis_friction.hpp>
#include <y_friction.hpp>
bool second(const x_axis_friction::Memory &memory);
int main()
{
    x_axis_friction::Compensator x;
    y_friction::f32::Compensator y;
    x_axis_friction::Compensator again;
    x_axis_friction::Params params = x.params();
    params.limit = -1.0;
    const bool refused = !again.configure(params);
    return x.ready() && y.ready() && refused && second(x.memory()) ? 0 : 1;
}
"#;
    let second = r#"
#include <y_friction.hpp>
#include <x_axis_friction.hpp>
bool second(const x_axis_friction::Memory &memory)
{
    x_axis_friction::Compensator x;
    y_friction::Compensator y;
    y_friction::Memory foreign;
    for (int k = 0; k < 12; k++) { foreign.number[k] = memory.number[k]; }
    return x.recall(memory) && !y.recall(foreign);
}
"#;
    std::fs::write(dir.path().join("first.cpp"), first).unwrap();
    std::fs::write(dir.path().join("second.cpp"), second).unwrap();
    for standard in ["-std=c++11", "-std=c++17", "-std=c++20"] {
        let flags = format!("{standard} -Wall -Wextra -Werror -Isrc");
        build("g++", &flags, &["first.cpp", "second.cpp"], dir.path());
        run("./a.out", &[], dir.path());
    }
}

/// The files by which Arduino and PlatformIO know a library, as their own pages describe them.
#[test]
fn the_layout_is_that_of_a_library() {
    let dir = library(&model(laws().remove(0).1));
    let text = std::fs::read_to_string(dir.path().join("library.properties")).unwrap();
    let mut keys = std::collections::BTreeMap::new();
    for line in text
        .lines()
        .filter(|line| !line.starts_with('#') && !line.is_empty())
    {
        let (key, value) = line.split_once('=').unwrap();
        assert!(
            keys.insert(key, value).is_none() && !value.is_empty(),
            "{line}"
        );
    }
    for due in [
        "name",
        "version",
        "author",
        "maintainer",
        "sentence",
        "paragraph",
        "category",
        "url",
        "architectures",
    ] {
        assert!(keys.contains_key(due), "{due}");
    }
    assert_eq!(keys["category"], "Device Control");
    assert!(dir.path().join("src").join(keys["includes"]).is_file());
    let json = std::fs::read_to_string(dir.path().join("library.json")).unwrap();
    let script = "import json, sys; d = json.loads(sys.stdin.read()); \
         assert len(d['name']) <= 50 and len(d['description']) <= 255; print(d['name'], d['version'], d['headers'])";
    std::fs::write(dir.path().join("read.py"), script).unwrap();
    let read = format!(
        "{} {} {}\n",
        keys["name"], keys["version"], keys["includes"]
    );
    std::fs::write(dir.path().join("json"), json).unwrap();
    let said = run("sh", &["-c", "python3 read.py < json"], dir.path());
    assert_eq!(said, read);
    for sketch in ["SelfTest", "Axis"] {
        let path = format!("examples/{sketch}/{sketch}.ino");
        assert!(dir.path().join(path).is_file());
    }
}

const AVR: &str = "-std=gnu++11 -Os -flto -ffunction-sections -Wl,--gc-sections";

/// The sketches for an AVR, where `fabsf` is `fabs` and both are single, with what they call of the Arduino core; the self-test on a simulated one.
#[test]
#[ignore = "soak: free-standing builds run on a simulator"]
fn the_self_test_passes_on_a_simulated_avr() {
    if !have(&["avr-g++", "simavr"]) {
        return;
    }
    let core = stiction_testkit::workspace().join("crates/export/tests/cpp");
    let core = format!("-I{}", core.display());
    for (name, model) in models() {
        let dir = library(&model);
        // Factors that follow beside all that friction depends on do not fit into 32 KiB together with the rows of the self-test.
        let chip = match model.settings.adaptation.is_some() && model.terms.mass > 0.0 {
            true => "atmega2560",
            false => "atmega328p",
        };
        for sketch in ["SelfTest", "Axis"] {
            let flags = format!(
                "{} {AVR} -mmcu={chip} -DF_CPU=16000000UL {core} -Isrc",
                STRICT.replace("-Wdouble-promotion", "")
            );
            let source = format!("examples/{sketch}/{sketch}.ino");
            let rest = ["-include", "Arduino.h", "-o", sketch, "-x", "c++", &source];
            build("avr-g++", &flags, &rest, dir.path());
        }
        let arguments = ["-m", chip, "-f", "16000000", "SelfTest"];
        is_passed(&run("simavr", &arguments, dir.path()), name);
    }
}

/// For ARM without an operating system: compiled under every warning for what microcontrollers have, and run where numbers are
/// computed by hardware, by hardware that rounds a product with its sum once, and by software.
#[test]
#[ignore = "soak: free-standing builds run on a simulator"]
fn the_self_test_passes_on_a_simulated_arm() {
    if !have(&["arm-none-eabi-g++", "qemu-arm"]) {
        return;
    }
    let some = models()
        .into_iter()
        .filter(|(name, _)| ["lugre", "gaussian", "power", "coulomb"].contains(name));
    for (name, model) in some {
        let dir = library(&model);
        for machine in [
            "-mcpu=cortex-m0plus -mthumb",
            "-mcpu=cortex-m4 -mthumb -mfloat-abi=hard -mfpu=fpv4-sp-d16",
        ] {
            let flags = format!("{STRICT} -O2 {machine} -Isrc -c");
            build(
                "arm-none-eabi-g++",
                &flags,
                &["extras/selftest.cpp"],
                dir.path(),
            );
        }
        for machine in [
            "-march=armv7-a+fp -mfloat-abi=hard",
            "-march=armv7-a+vfpv4 -mfloat-abi=hard",
            "-march=armv7-a -mfloat-abi=soft",
        ] {
            let flags = format!("-std=c++11 -O2 {machine} --specs=rdimon.specs -Isrc -o selftest");
            // The driver of C, which asks for no library of C++.
            let rest = ["extras/selftest.cpp", "-lm"];
            build("arm-none-eabi-gcc", &flags, &rest, dir.path());
            let said = run("qemu-arm", &["-cpu", "cortex-a7", "selftest"], dir.path());
            is_passed(&said, name);
            assert!(said.contains("ok f64: 183 samples"), "{name}: {said}");
        }
    }
}

/// The most cycles that a step of the self-test takes.
const TIMED: &str = r#"
#include "examples/SelfTest/selftest_f32.h"
namespace axis = x_axis_friction::f32;
static axis::Compensator compensator;
void setup()
{
    Serial.begin(115200);
    axis::Params params = compensator.params();
    params.watchdog_window = 8 * params.cycle_time;
    const bool wrong = !compensator.configure(params);
    unsigned long most = 0;
    TCCR1B = 1u << CS10;
    for (unsigned k = 0; k < axis::count; k++) {
        const axis::Input input = axis::row(k).input;
        const unsigned start = TCNT1;
        TIFR1 = 1u << TOV1;
        (void)compensator.step(input);
        const unsigned end = TCNT1;
        // the counter has 16 bits, and a step takes fewer than 2^17 cycles
        const bool over = (TIFR1 & (1u << TOV1)) && end >= start;
        const unsigned long took = (over ? 65536ul : 0ul) + (end - start);
        most = (took > most) ? took : most;
    }
    Serial.print(most);
    Serial.println(wrong ? " wrong" : " cycles");
}
void loop() {}
"#;

/// How long a step takes on an AVR at its slowest, as its simulator counts. The page of the target states it.
#[test]
fn the_time_on_an_avr_is_stated() {
    if !have(&["avr-g++", "simavr"]) {
        return;
    }
    let core = stiction_testkit::workspace().join("crates/export/tests/cpp");
    let mut missing = Vec::new();
    for (name, model) in sized() {
        let dir = library(&model);
        std::fs::write(dir.path().join("timed.cpp"), TIMED).unwrap();
        let flags = format!(
            "{AVR} -mmcu=atmega328p -DF_CPU=16000000UL -I{} -Isrc",
            core.display()
        );
        let rest = ["-include", "Arduino.h", "-o", "timed", "timed.cpp"];
        build("avr-g++", &flags, &rest, dir.path());
        let said = run(
            "simavr",
            &["-m", "atmega328p", "-f", "16000000", "timed"],
            dir.path(),
        );
        let (before, _) = said
            .split_once(" cycles")
            .unwrap_or_else(|| panic!("{said}"));
        let digits = before.rsplit(|c: char| !c.is_ascii_digit()).next().unwrap();
        let row = format!("| {name} | {digits} |");
        if !page().contains(&row) {
            missing.push(row);
        }
    }
    assert!(
        missing.is_empty(),
        "docs/deploy/cpp.md does not say\n{}",
        missing.join("\n")
    );
}

/// The models whose sizes and times are stated.
fn sized() -> [(&'static str, Model); 3] {
    let lugre = laws().remove(0).1;
    let coulomb = laws().remove(7).1;
    let mut following = model(lugre);
    following.settings = adapting(following.settings);
    [
        ("`coulomb-viscous`", model(coulomb)),
        ("`lugre`", model(lugre)),
        ("`lugre` with `--adapt`", following),
    ]
}

/// A program that steps and does nothing else.
const ALONE: &str = r#"
#include <x_axis_friction_f32.hpp>
static x_axis_friction::f32::Compensator compensator;
static volatile float number;
static volatile bool truth;
int main()
{
    for (;;) {
        const x_axis_friction::f32::Input input = { number, number, truth@D@ };
        number = compensator.step(input);
    }
}
"#;

/// What a program takes that steps and does nothing else, in single precision, as the tools of its compiler count it. The page
/// of the target states it.
#[test]
fn the_sizes_are_stated() {
    if !have(&["avr-g++", "arm-none-eabi-g++"]) {
        return;
    }
    let page = page();
    let machines = [
        ("ATmega328P", "avr", "-Os -mmcu=atmega328p"),
        (
            "Cortex-M4F",
            "arm-none-eabi",
            "-Os -mcpu=cortex-m4 -mthumb -mfloat-abi=hard -mfpu=fpv4-sp-d16 --specs=nano.specs -nostartfiles -Wl,-emain",
        ),
        (
            "Cortex-M0+",
            "arm-none-eabi",
            "-Os -mcpu=cortex-m0plus -mthumb --specs=nano.specs -nostartfiles -Wl,-emain",
        ),
    ];
    let mut missing = Vec::new();
    for (machine, tools, flags) in machines {
        for (law, model) in sized() {
            let dir = library(&model);
            let more = match model.settings.adaptation {
                Some(_) => ", number, truth",
                None => "",
            };
            std::fs::write(dir.path().join("alone.cpp"), ALONE.replace("@D@", more)).unwrap();
            let flags = format!(
                "-std=c++11 {flags} -fno-exceptions -fno-rtti -fno-threadsafe-statics -ffunction-sections -fdata-sections \
                 -Wl,--gc-sections -fstack-usage -Isrc -o alone"
            );
            build(
                &format!("{tools}-gcc"),
                &flags,
                &["alone.cpp", "-lm"],
                dir.path(),
            );
            let said = run(&format!("{tools}-size"), &["alone"], dir.path());
            let numbers = said.lines().nth(1).unwrap().split_whitespace();
            let numbers: Vec<usize> = numbers.take(3).map(|n| n.parse().unwrap()).collect();
            let usage = ["alone-alone.su", "alone.su"];
            let usage = usage
                .iter()
                .find_map(|file| std::fs::read_to_string(dir.path().join(file)).ok());
            let stack = usage.unwrap();
            let stack = stack
                .lines()
                .map(|line| line.split('\t').nth(1).unwrap().parse::<usize>().unwrap());
            let row = format!(
                "| {machine} | {law} | {} | {} | {} |",
                numbers[0] + numbers[1],
                numbers[1] + numbers[2],
                stack.sum::<usize>()
            );
            if !page.contains(&row) {
                missing.push(row);
            }
        }
    }
    assert!(
        missing.is_empty(),
        "docs/deploy/cpp.md does not say\n{}",
        missing.join("\n")
    );
}
