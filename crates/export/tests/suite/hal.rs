//! The HAL component: built by halcompile, run by LinuxCNC in a real thread, and sample by sample against the compensator.

use crate::common::compiled::{Sample, agree, drive, gcc, kept, passive, run, write};
use crate::common::terms::extras;
use crate::common::{laws, model, models};
use stiction_export::{Model, Target, export};
use stiction_testkit::hal::{self, Installed};

#[test]
fn linuxcnc_gives_the_forces_that_are_due() {
    let _alone = hal::alone();
    if !hal::may_install() {
        return;
    }
    for (name, mut model) in models()
        .into_iter()
        .filter(|(name, _)| ["lugre", "power", "coulomb"].contains(name))
    {
        model.identifier = "Stiction_test".into();
        model.settings.cycle_time = if name == "power" { 250e-6 } else { 1e-3 };
        let dir = tempfile::tempdir().unwrap();
        write(&export(&model, Target::Hal).unwrap(), dir.path());
        let _installed = Installed::new("stiction_test_friction", dir.path());
        let said = run(
            "python3",
            &["stiction_test_friction_selftest.py"],
            dir.path(),
        );
        assert!(said.starts_with("ok 183 samples"), "{name}: {said}");
        assert!(said.contains("in cycles or ns: 0 "), "{name}: {said}");
        println!("{name}: {said}");
    }
}

/// The example of the page, with the model beside it: Fc 12 N and 30 N s/m at 31.4 mm/s, a share of a half.
#[test]
fn the_example_runs() {
    let _alone = hal::alone();
    if !hal::may_install() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let mut model = model(laws().remove(0).1);
    model.identifier = "stiction_example".into();
    write(&export(&model, Target::Hal).unwrap(), dir.path());
    let _installed = Installed::new("stiction_example_friction", dir.path());
    let example = stiction_testkit::workspace().join("examples/export/hal/axis.hal");
    let text = std::fs::read_to_string(example)
        .unwrap()
        .replace("x_axis", "stiction_example")
        .replace("x-axis", "stiction-example");
    std::fs::write(dir.path().join("axis.hal"), text).unwrap();
    let output = hal::command("halrun", dir.path())
        .arg("axis.hal")
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(
        output.status.success(),
        "{said}{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let mut lines = said.lines();
    assert_eq!(lines.next(), Some("TRUE"), "{said}");
    let [v, force, permille] = [(); 3].map(|()| lines.next().unwrap().parse::<f64>().unwrap());
    // How far the sine is after a second of sleep is up to the machine's other work: wherever it moves, the force is that of
    // its speed. Six digits are printed, and it has moved on between two of them.
    assert!(v != 0.0 && v.abs() < 31.5, "{said}");
    assert!(force != 0.0 && force.abs() < 9.1, "{said}");
    if v.abs() > 10.0 {
        let due = 0.5 * (12.0 + 30.0 * v.abs() / 1000.0);
        assert!((force * v.signum() - due).abs() < 0.1, "{said}");
    }
    assert!((permille - 5.0 * force).abs() < 0.1, "{said}");
}

/// HAL as far as a component sees it, and the loop of the other targets' drivers.
const DRIVER: &str = r#"
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "rtapi.h"
#include "hal.h"

static struct { char name[HAL_NAME_LEN + 1]; void *at; } known[64];
static int count;
static void (*function)(void *, long);
static void *instance;

int rtapi_app_main(void);

static void keep(void *at, const char *format, va_list list) {
    (void)vsnprintf(known[count].name, sizeof known[count].name, format, list);
    known[count++].at = at;
}
static void *pin(const char *name) {
    for (int i = 0; i < count; i++) {
        const char *dot = strrchr(known[i].name, '.');
        if (strcmp(dot + 1, name) == 0) { return known[i].at; }
    }
    abort();
}
int hal_init(const char *name) { (void)name; return 1; }
int hal_exit(int id) { (void)id; return 0; }
int hal_ready(int id) { (void)id; return 0; }
void *hal_malloc(long size) { return calloc(1, (size_t)size); }
#define KEEP(at) va_list list; (void)dir; (void)id; va_start(list, format); keep((void *)(at), format, list); va_end(list); return 0
int hal_pin_bit_newf(hal_pin_dir_t dir, hal_bit_t **at, int id, const char *format, ...) { *at = calloc(1, sizeof(hal_bit_t)); KEEP(*at); }
int hal_pin_u32_newf(hal_pin_dir_t dir, hal_u32_t **at, int id, const char *format, ...) { *at = calloc(1, sizeof(hal_u32_t)); KEEP(*at); }
int hal_pin_float_newf(hal_pin_dir_t dir, hal_float_t **at, int id, const char *format, ...) { *at = calloc(1, sizeof(hal_float_t)); KEEP(*at); }
int hal_param_float_newf(hal_param_dir_t dir, hal_float_t *at, int id, const char *format, ...) { KEEP(at); }
int hal_export_funct(const char *name, void (*f)(void *, long), void *arg, int fp, int reentrant, int id) {
    (void)name; (void)fp; (void)reentrant; (void)id;
    function = f;
    instance = arg;
    return 0;
}
int rtapi_snprintf(char *to, unsigned long size, const char *format, ...) {
    va_list list;
    va_start(list, format);
    const int length = vsnprintf(to, size, format, list);
    va_end(list);
    return length;
}
void rtapi_print_msg(msg_level_t level, const char *format, ...) { (void)level; (void)format; }

int main(void) {
    double in[11];
    if (rtapi_app_main() != 0) { return 1; }
    hal_float_t *velocity = pin("velocity"), *error = pin("error"), *force = pin("force");
    hal_bit_t *enable = pin("enable"), *valid = pin("valid");
    while (fread(in, sizeof in, 1, stdin) == 1) {
        double out[2];
        *velocity = in[1];
        *error = in[2];
        *enable = in[3] != 0.0;
        @D@
        function(instance, (long)(in[0] * 1e9 + 0.5));
        if (!*valid) { return 2; }
        out[0] = *force;
        out[1] = @Z@;
        (void)fwrite(out, sizeof out, 1, stdout);
    }
    return 0;
}
"#;

/// The C that halcompile makes of the component, with its pins held by the driver.
fn through_hal(model: &Model, samples: &[Sample]) -> Vec<[f64; 2]> {
    let dir = tempfile::tempdir().unwrap();
    write(&export(model, Target::Hal).unwrap(), dir.path());
    run(
        "halcompile",
        &["--preprocess", "x_axis_friction.comp"],
        dir.path(),
    );
    let number = |name: &str| format!("*(hal_float_t *)pin(\"{name}\")");
    let kept = kept(&model.friction, &number("deflection"), |k| {
        number(&format!("element-{k:02}"))
    });
    let mut fed = String::new();
    if model.settings.adaptation.is_some() {
        fed += "*(hal_float_t *)pin(\"drive-force\") = in[4]; *(hal_bit_t *)pin(\"learn\") = in[5] != 0.0;";
    }
    for (name, at) in extras(model) {
        let pin = name.trim_start_matches("reference_");
        fed += &format!("*(hal_float_t *)pin(\"{pin}\") = in[{at}];");
    }
    std::fs::write(
        dir.path().join("driver.c"),
        DRIVER.replace("@Z@", &kept).replace("@D@", &fed),
    )
    .unwrap();
    gcc(
        "-std=gnu99 -O2 -D_GNU_SOURCE -DRTAPI -DUSPACE -I/usr/include/linuxcnc -fsanitize=undefined -fno-sanitize-recover=all",
        &["driver.c", "x_axis_friction.c", "-lm"],
        dir.path(),
    );
    drive(dir.path(), "./a.out", samples)
}

/// A thread's period is a whole number of nanoseconds.
fn whole(samples: &mut [Sample]) {
    for (h, _) in samples {
        *h = if *h >= 0.0 && *h < 10.0 {
            (*h * 1e9).round() / 1e9
        } else {
            1e-3
        };
    }
}

#[test]
fn the_component_agrees() {
    agree("HAL", whole, through_hal);
}

#[test]
fn the_component_is_passive() {
    passive(1e-12, through_hal);
}
