//! The FMUs: validated and simulated by FMPy, and sample by sample against the compensator through the functions of the
//! standard.

use crate::common::compiled::{
    Sample, agree, agree_over, drive, gcc, have, kept, passive, run, write,
};
use crate::common::terms::extras;
use crate::common::{laws, model, models, parts};
use std::path::{Path, PathBuf};
use stiction_export::{File, Model, Platform, fmu};
use stiction_friction::compensator::Friction;

fn python(arguments: &[&str], dir: &Path) -> String {
    let local = stiction_testkit::workspace().join(".venv/bin");
    let python = std::env::var_os("STICTION_PYTHON").map_or(local.join("python"), PathBuf::from);
    // Where the packages of the set-up put their programs.
    let path = format!(
        "PATH={}:{}",
        python.parent().unwrap_or(&local).display(),
        std::env::var("PATH").unwrap_or_default()
    );
    let python = python.to_string_lossy().into_owned();
    run("env", &[&[path.as_str(), &python], arguments].concat(), dir)
}

/// With the compiler and the flags of the export.
fn compile_for(source: &File, platform: Platform) -> Vec<u8> {
    let dir = tempfile::tempdir().unwrap();
    let name = source.path.rsplit('/').next().unwrap();
    std::fs::write(dir.path().join(name), &source.bytes).unwrap();
    run(
        platform.gcc(),
        &platform.arguments(name, "fmu.library"),
        dir.path(),
    );
    std::fs::read(dir.path().join("fmu.library")).unwrap()
}

/// For this machine only.
fn compile(source: &File, platform: Platform) -> Option<Vec<u8>> {
    (platform == Platform::LinuxX86_64).then(|| compile_for(source, platform))
}

/// FMPy validates both, simulates them over the samples of the self-test, and finds the forces that are due.
#[test]
fn fmpy_gives_the_forces_that_are_due() {
    for (name, mut model) in models()
        .into_iter()
        .filter(|(name, _)| ["lugre", "power", "gms", "coulomb"].contains(name))
    {
        let dir = tempfile::tempdir().unwrap();
        model.rotary = name == "power";
        write(&fmu(&model, &mut compile).unwrap(), dir.path());
        let said = python(&["x_axis_friction_selftest.py"], dir.path());
        for version in [2, 3] {
            let good = format!("ok FMI {version}.0: 183 samples");
            assert!(said.contains(&good), "{name}: {said}");
        }
        println!("{name}: {said}");
    }
}

/// Without a compiler the source is there, and FMPy builds it as the FMU says.
#[test]
fn the_source_is_enough() {
    let dir = tempfile::tempdir().unwrap();
    let files = fmu(&model(laws().remove(0).1), &mut |_, _| None).unwrap();
    for archive in &files[..2] {
        assert!(!parts(archive).iter().any(|f| f.path.ends_with(".so")));
    }
    write(&files, dir.path());
    let said = python(&["x_axis_friction_selftest.py"], dir.path());
    assert!(
        said.contains("ok FMI 2.0") && said.contains("ok FMI 3.0"),
        "{said}"
    );
}

/// State taken, gone back to, through bytes and back; reset; two instances of one library side by side; refusals.
#[test]
fn states_resets_and_instances() {
    let dir = tempfile::tempdir().unwrap();
    write(
        &fmu(&model(laws().remove(0).1), &mut compile).unwrap(),
        dir.path(),
    );
    let script = stiction_testkit::workspace().join("crates/export/tests/fmu/states.py");
    let said = python(&[&script.to_string_lossy()], dir.path());
    let (refusals, done): (Vec<_>, Vec<_>) = said.lines().partition(|l| l.starts_with("[ERROR]"));
    assert_eq!(done, ["ok 2.0", "ok 3.0"]);
    // Every refusal is said through the logger of the standard.
    assert_eq!(refusals.len(), 2 * 9, "{said}");
}

/// The page of the target runs this file.
#[test]
fn the_example_runs() {
    let dir = tempfile::tempdir().unwrap();
    write(
        &fmu(&model(laws().remove(0).1), &mut compile).unwrap(),
        dir.path(),
    );
    let example = stiction_testkit::workspace().join("examples/export/fmu/simulate.py");
    let said = python(&[&example.to_string_lossy(), "."], dir.path());
    // A share of a half of 12 N and 30 N s/m at 10 mm/s, both ways.
    assert!(
        said.contains("6.15 N at 10 mm/s, -6.15 N at -10 mm/s"),
        "{said}"
    );
}

#[test]
fn the_source_compiles_under_every_warning() {
    for (_, model) in models() {
        let dir = tempfile::tempdir().unwrap();
        for archive in &fmu(&model, &mut |_, _| None).unwrap()[..2] {
            write(&parts(archive), dir.path());
            gcc(
                "-std=c99 -pedantic -Wall -Wextra -Wconversion -Wshadow -Wfloat-equal -Wsign-conversion -Wundef -Wcast-qual -O2 -Werror -c -o fmu.o",
                &["sources/x_axis_friction.c"],
                dir.path(),
            );
        }
    }
}

/// The same bytes at any time of day, every entry with the first date that a zip can hold.
#[test]
fn the_same_model_gives_the_same_bytes() {
    let model = model(laws().remove(0).1);
    let once = fmu(&model, &mut compile).unwrap();
    assert_eq!(once, fmu(&model, &mut compile).unwrap());
    let mut zip = zip::ZipArchive::new(std::io::Cursor::new(&once[0].bytes)).unwrap();
    for i in 0..zip.len() {
        let date = zip.by_index(i).unwrap().last_modified().unwrap();
        assert_eq!((date.year(), date.month(), date.day()), (1980, 1, 1));
    }
}

/// Two models never pass for each other: the token is of the content.
#[test]
fn another_model_has_another_token() {
    let token = |model: &Model| {
        let archive = fmu(model, &mut |_, _| None).unwrap().remove(0);
        let text = String::from_utf8(parts(&archive).remove(0).bytes).unwrap();
        text.split("guid=\"").nth(1).unwrap()[..38].to_string()
    };
    let mut other = model(laws().remove(0).1);
    other.settings.limit += 1.0;
    assert_ne!(token(&model(laws().remove(0).1)), token(&other));
}

/// The functions of the standard, and the loop of the other targets' drivers.
const DRIVER: &str = r#"
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
static void *library;
static void *find(const char *name) {
    void *at = dlsym(library, name);
    if (at == NULL) { (void)fprintf(stderr, "no %s\n", name); abort(); }
    return at;
}
#define COUNT(list) (sizeof list / sizeof *list)
#define GET(type, name, arguments) type (*name)arguments = (type (*)arguments)find(#name)
int main(void) {
    static const unsigned inputs[] = { @INPUTS@ }, flags[] = { @FLAGS@ }, outputs[] = { @OUTPUTS@ };
    double in[11];
    library = dlopen("./binaries/@FOLDER@/x_axis_friction.so", RTLD_NOW);
    if (library == NULL) { return 1; }
@SETUP@
    for (long k = 0; fread(in, sizeof in, 1, stdin) == 1; k++) {
        const double numbers[] = { in[1], in[2]@NUMBERS@ };
        double out[@COUNT@];
@STEP@
        out[1] = @KEPT@;
        (void)fwrite(out, sizeof *out, 2, stdout);
    }
    return 0;
}
"#;

const SETUP_2: &str = r#"
    struct { void (*logger)(void); void *(*allocate)(size_t, size_t); void (*release)(void *); void *finished; void *environment; }
        callbacks = { NULL, calloc, free, NULL, NULL };
    GET(void *, fmi2Instantiate, (const char *, int, const char *, const char *, const void *, int, int));
    GET(int, fmi2SetupExperiment, (void *, int, double, double, int, double));
    GET(int, fmi2EnterInitializationMode, (void *));
    GET(int, fmi2ExitInitializationMode, (void *));
    GET(int, fmi2SetReal, (void *, const unsigned *, size_t, const double *));
    GET(int, fmi2GetReal, (void *, const unsigned *, size_t, double *));
    GET(int, fmi2SetBoolean, (void *, const unsigned *, size_t, const int *));
    GET(int, fmi2DoStep, (void *, double, double, int));
    void *c = fmi2Instantiate("test", 1, "@TOKEN@", "", &callbacks, 0, 0);
    if (c == NULL || fmi2SetupExperiment(c, 0, 0, 0, 0, 0) || fmi2EnterInitializationMode(c) || fmi2ExitInitializationMode(c)) { return 2; }
"#;

const STEP_2: &str = r#"
        const int on[] = { in[3] != 0.0, in[5] != 0.0 };
        if (fmi2SetReal(c, inputs, COUNT(inputs), numbers) || fmi2SetBoolean(c, flags, COUNT(flags), on) || fmi2DoStep(c, (double)k * 1e-3, 1e-3, 1)
            || fmi2GetReal(c, outputs, COUNT(outputs), out)) { return 3; }
"#;

const SETUP_3: &str = r#"
    GET(void *, fmi3InstantiateCoSimulation, (const char *, const char *, const char *, bool, bool, bool, bool, const unsigned *, size_t, void *, void *, void *));
    GET(int, fmi3EnterInitializationMode, (void *, bool, double, double, bool, double));
    GET(int, fmi3ExitInitializationMode, (void *));
    GET(int, fmi3SetFloat64, (void *, const unsigned *, size_t, const double *, size_t));
    GET(int, fmi3GetFloat64, (void *, const unsigned *, size_t, double *, size_t));
    GET(int, fmi3SetBoolean, (void *, const unsigned *, size_t, const bool *, size_t));
    GET(int, fmi3DoStep, (void *, double, double, bool, bool *, bool *, bool *, double *));
    void *c = fmi3InstantiateCoSimulation("test", "@TOKEN@", "", false, false, false, false, NULL, 0, NULL, NULL, NULL);
    if (c == NULL || fmi3EnterInitializationMode(c, false, 0, 0, false, 0) || fmi3ExitInitializationMode(c)) { return 2; }
"#;

const STEP_3: &str = r#"
        const bool on[] = { in[3] != 0.0, in[5] != 0.0 };
        bool event, end, early;
        double last;
        if (fmi3SetFloat64(c, inputs, COUNT(inputs), numbers, COUNT(inputs)) || fmi3SetBoolean(c, flags, COUNT(flags), on, COUNT(flags))
            || fmi3DoStep(c, (double)k * 1e-3, 1e-3, true, &event, &end, &early, &last) || fmi3GetFloat64(c, outputs, COUNT(outputs), out, COUNT(outputs))) { return 3; }
"#;

/// Through the library in the FMU of a version.
fn through_fmu(version: usize, model: &Model, samples: &[Sample]) -> Vec<[f64; 2]> {
    through(Platform::LinuxX86_64, version, model, samples)
}

/// The same on a platform, which is emulated where it is not this machine.
fn through(platform: Platform, version: usize, model: &Model, samples: &[Sample]) -> Vec<[f64; 2]> {
    let dir = tempfile::tempdir().unwrap();
    let mut made = |source: &File, p: Platform| (p == platform).then(|| compile_for(source, p));
    let archive = fmu(model, &mut made).unwrap().remove(version - 2);
    let parts = parts(&archive);
    let text = String::from_utf8(parts[0].bytes.clone()).unwrap();
    let key = ["guid=\"", "instantiationToken=\""][version - 2];
    let token = &text.split(key).nth(1).unwrap()[..38];
    let [folder, setup, step] = [
        ["linux64", SETUP_2, STEP_2],
        [platform.name(), SETUP_3, STEP_3],
    ][version - 2];
    write(&parts, dir.path());
    // Of those variables that it has.
    let references = |names: &[&str]| -> String {
        let found = names.iter().filter_map(|name| {
            let (_, after) = text.split_once(&format!("name=\"{name}\" valueReference=\""))?;
            after.split('"').next()
        });
        found.collect::<Vec<_>>().join(", ")
    };
    // Without anything to keep the force stands twice.
    let elements: Vec<String> = (1..=10).map(|k| format!("element_{k}")).collect();
    let mut outputs = vec!["force"];
    match &model.friction {
        Friction::Gms(law) => {
            outputs.extend(elements[..law.elements().len()].iter().map(String::as_str));
        }
        law if law.bristle().is_some() => outputs.push("deflection"),
        _ => outputs.push("force"),
    }
    let kept = kept(&model.friction, "out[1]", |k| format!("out[{}]", k + 1));
    let force = model.settings.adaptation.map(|_| ("drive_force", 4));
    let more: Vec<_> = force.into_iter().chain(extras(model)).collect();
    let numbers: String = more.iter().map(|(_, at)| format!(", in[{at}]")).collect();
    let mut names = vec!["reference_velocity", "tracking_error"];
    names.extend(more.iter().map(|(name, _)| *name));
    let driver = DRIVER
        .replace("@FOLDER@", folder)
        .replace("@SETUP@", setup)
        .replace("@STEP@", step)
        .replace("@TOKEN@", token)
        .replace("@INPUTS@", &references(&names))
        .replace("@NUMBERS@", &numbers)
        .replace("@FLAGS@", &references(&["enable", "learn"]))
        .replace("@OUTPUTS@", &references(&outputs))
        .replace("@COUNT@", &outputs.len().to_string())
        .replace("@KEPT@", &kept);
    std::fs::write(dir.path().join("driver.c"), driver).unwrap();
    let arguments = ["-std=gnu99", "-O2", "driver.c", "-ldl"];
    run(platform.gcc(), &arguments, dir.path());
    if platform == Platform::LinuxX86_64 {
        return drive(dir.path(), "./a.out", samples);
    }
    // Where Debian's cross compiler has its libraries.
    let emulated = "#!/bin/sh\nexec qemu-aarch64 -L /usr/aarch64-linux-gnu ./a.out\n";
    std::fs::write(dir.path().join("emulated"), emulated).unwrap();
    run("chmod", &["+x", "emulated"], dir.path());
    drive(dir.path(), "./emulated", samples)
}

/// A fixed cycle, as the FMU samples.
fn regular(samples: &mut [Sample]) {
    samples.iter_mut().for_each(|(h, _)| *h = 1e-3);
}

/// A law with a bristle, one with elements and one with neither: the law itself is the source of C, which is run for all.
fn some() -> Vec<(&'static str, Friction<f64>)> {
    let mut some = laws();
    some.retain(|(name, _)| ["lugre", "gms", "power"].contains(name));
    assert_eq!(some.len(), 3);
    some
}

#[test]
fn fmi_2_agrees() {
    agree_over("FMI 2.0", some(), usize::MAX, regular, |model, samples| {
        through_fmu(2, model, samples)
    });
}

#[test]
fn fmi_3_agrees() {
    agree_over("FMI 3.0", some(), usize::MAX, regular, |model, samples| {
        through_fmu(3, model, samples)
    });
}

#[test]
#[ignore = "soak: every law through two libraries"]
fn both_agree_for_every_law() {
    for version in [2, 3] {
        agree(&format!("FMI {version}.0"), regular, |model, samples| {
            through_fmu(version, model, samples)
        });
    }
}

/// The compilers of all platforms.
fn compilers() -> bool {
    have(&Platform::ALL.map(Platform::gcc))
}

/// The binary for ARM under QEMU: two laws and the first samples of every run, since a step takes some ten times as long.
#[test]
#[ignore = "soak: the same on an emulated processor"]
fn fmi_3_agrees_on_arm() {
    if !(compilers() && have(&["qemu-aarch64"])) {
        return;
    }
    let mut some = laws();
    some.retain(|(name, _)| ["lugre", "gms"].contains(name));
    assert_eq!(some.len(), 2);
    agree_over(
        "FMI 3.0 on aarch64",
        some,
        5000,
        regular,
        |model, samples| through(Platform::LinuxAarch64, 3, model, samples),
    );
}

/// What FMPy finds of a binary for each platform. It lists none for aarch64 on Linux, whatever an FMU holds.
#[test]
fn fmpy_lists_the_platforms() {
    if !compilers() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let mut all = |source: &File, platform: Platform| Some(compile_for(source, platform));
    let files = fmu(&model(laws().remove(0).1), &mut all).unwrap();
    write(&files, dir.path());
    let script = "import sys, fmpy, fmpy.validation\n\
         for f in sys.argv[1:]: print(*fmpy.supported_platforms(f), *fmpy.validation.validate_fmu(f))";
    let names = ["x_axis_friction_fmi2.fmu", "x_axis_friction_fmi3.fmu"];
    let said = python(&[&["-c", script], &names[..]].concat(), dir.path());
    assert_eq!(said, "c-code linux64 win64\n".repeat(2));
    let inside = |archive: &File| -> Vec<String> {
        let parts = parts(archive).into_iter().map(|part| part.path);
        parts.filter(|path| path.starts_with("binaries/")).collect()
    };
    assert_eq!(
        inside(&files[0]),
        ["linux64/x_axis_friction.so", "win64/x_axis_friction.dll"]
            .map(|p| format!("binaries/{p}"))
    );
    assert_eq!(
        inside(&files[1]),
        [
            "x86_64-linux/x_axis_friction.so",
            "aarch64-linux/x_axis_friction.so",
            "x86_64-windows/x_axis_friction.dll"
        ]
        .map(|p| format!("binaries/{p}"))
    );
}

/// Each binary has the functions of the standard and no others, and that for Windows needs nothing that Windows has not.
#[test]
fn every_platform_has_the_functions() {
    if !compilers() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let source_only = fmu(&model(laws().remove(0).1), &mut |_, _| None).unwrap();
    for (version, archive) in ["fmi2", "fmi3"].into_iter().zip(&source_only) {
        let source = parts(archive)
            .into_iter()
            .find(|part| part.path.ends_with(".c"))
            .unwrap();
        for platform in Platform::ALL {
            let bytes = compile_for(&source, platform);
            write(
                &[File {
                    path: platform.name().into(),
                    bytes,
                }],
                dir.path(),
            );
        }
        let defined = |nm: &str, platform: Platform| -> Vec<String> {
            let said = run(nm, &["-D", "--defined-only", platform.name()], dir.path());
            let names = said
                .lines()
                .filter_map(|line| Some(line.split_once(" T ")?.1.to_string()));
            names.collect()
        };
        let linux = defined("nm", Platform::LinuxX86_64);
        assert!(
            linux.iter().all(|name| name.starts_with(version)),
            "{linux:?}"
        );
        assert!(linux.contains(&format!("{version}DoStep")), "{linux:?}");
        assert_eq!(
            defined("aarch64-linux-gnu-nm", Platform::LinuxAarch64),
            linux
        );
        let said = run(
            "x86_64-w64-mingw32-objdump",
            &["-p", Platform::WindowsX86_64.name()],
            dir.path(),
        );
        let (_, table) = said.split_once("[Ordinal/Name Pointer] Table").unwrap();
        let names = table
            .lines()
            .skip(1)
            .take_while(|line| !line.trim().is_empty());
        let windows: Vec<&str> = names
            .filter_map(|line| line.split_whitespace().last())
            .collect();
        assert_eq!(windows, linux);
        let needs = said
            .lines()
            .filter_map(|line| line.trim().strip_prefix("DLL Name: "));
        let needs: Vec<&str> = needs.collect();
        assert!(
            needs
                .iter()
                .all(|dll| ["KERNEL32.dll", "msvcrt.dll"].contains(dll)),
            "{needs:?}"
        );
    }
}

#[test]
fn both_are_passive() {
    for version in [2, 3] {
        passive(1e-12, |model, samples| through_fmu(version, model, samples));
    }
}
