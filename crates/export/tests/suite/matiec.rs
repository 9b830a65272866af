//! The Structured Text through matiec, the compiler of Beremiz and OpenPLC: all of it is taken, the test programs pass, and
//! the blocks agree with the compensator.

use crate::common::compiled::{Sample, drive, kept, run};
use crate::common::terms::extras;
use crate::common::{laws, model, models};
use crate::st;
use std::path::Path;
use stiction_export::{Model, Target, export};
use stiction_testkit::matiec::{compile, matiec};

/// Steps a block through what comes in, as [`drive`] wants it. NAME, REAL and KEPT are put in their places.
const BLOCK: &str = r#"
int main(void)
{
    static NAME block;
    double in[11];
    NAME_init__(&block, 0);
    while (fread(in, sizeof *in, 11, stdin) == 11) {
        block.CYCLE_TIME.value = (REAL)in[0];
        block.REFERENCE_VELOCITY.value = (REAL)in[1];
        block.TRACKING_ERROR.value = (REAL)in[2];
        block.ENABLE.value = in[3] != 0.0;
        DRIVE
        NAME_body__(&block);
        const double out[2] = { block.FORCE.value, KEPT };
        (void)fwrite(out, sizeof *out, 2, stdout);
    }
    return 0;
}
"#;

/// Runs a test program to its end.
const PROGRAM: &str = r#"
int main(void)
{
    static NAME program;
    NAME_init__(&program, 0);
    for (int i = 0; i < 10000 && !program.DONE.value; i++) {
        NAME_body__(&program);
    }
    printf("%d %d %g\n", program.DONE.value, program.PASSED.value, (double)program.WORST.value);
    return program.DONE.value && program.PASSED.value ? 0 : 1;
}
"#;

fn texts(model: &Model) -> Vec<(String, String)> {
    let files = export(model, Target::St).unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    files
        .into_iter()
        .map(|f| (f.path.trim_end_matches(".st").to_string(), text(f.bytes)))
        .collect()
}

/// What a block gives.
fn compiled(matiec: &Path, model: &Model, name: &str, samples: &[Sample]) -> Vec<[f64; 2]> {
    let dir = tempfile::tempdir().unwrap();
    let texts = texts(model);
    let (_, text) = texts.iter().find(|(found, _)| found == name).unwrap();
    let kept = kept(&model.friction, "block.DEFLECTION.value", |k| {
        format!("(double)block.ELEMENT_{}.value", k + 1)
    });
    let real = if name.ends_with("_R") {
        "float"
    } else {
        "double"
    };
    let mut more = String::new();
    if model.settings.adaptation.is_some() {
        more += "block.DRIVE_FORCE.value = (REAL)in[4]; block.LEARN.value = in[5] != 0.0;";
    }
    for (name, at) in extras(model) {
        more += &format!("block.{}.value = (REAL)in[{at}];", name.to_uppercase());
    }
    let driver = BLOCK
        .replace("NAME", &name.to_uppercase())
        .replace("DRIVE", &more)
        .replace("REAL", real)
        .replace("KEPT }", &format!("{kept} }}"));
    compile(matiec, &[text], &driver, dir.path(), "block");
    drive(dir.path(), "block", samples)
}

#[test]
fn lreal_agrees() {
    if let Some(matiec) = matiec() {
        st::lreal("matiec", |model, samples| {
            compiled(&matiec, model, "FB_x_axis_Friction", samples)
        });
    }
}

#[test]
#[ignore = "soak: the same in single precision"]
fn real_agrees() {
    if let Some(matiec) = matiec() {
        st::real("matiec", |model, samples| {
            compiled(&matiec, model, "FB_x_axis_Friction_R", samples)
        });
    }
}

/// Block and test program of every law, in both precisions, with settings as they are exported.
#[test]
fn the_test_programs_pass() {
    let Some(matiec) = matiec() else {
        return;
    };
    for (name, model) in models() {
        let dir = tempfile::tempdir().unwrap();
        for pair in texts(&model).chunks(2) {
            let [(_, block), (program, test)] = pair else {
                panic!("a block and its test");
            };
            let driver = PROGRAM.replace("NAME", &program.to_uppercase());
            compile(&matiec, &[block, test], &driver, dir.path(), program);
            let path = dir.path().join(program);
            let said = run(path.to_str().unwrap(), &[], dir.path());
            assert!(said.starts_with("1 1"), "{name}: {said}");
        }
    }
}

/// The example, as a controller would compile it.
#[test]
fn the_example_compiles() {
    let Some(matiec) = matiec() else {
        return;
    };
    let example = stiction_testkit::workspace().join("examples/export/st/PRG_Axis.st");
    let example = std::fs::read_to_string(example).unwrap();
    let dir = tempfile::tempdir().unwrap();
    let texts = texts(&model(laws().remove(0).1));
    let driver = "int main(void) { return 0; }";
    compile(
        &matiec,
        &[&texts[0].1, &example],
        driver,
        dir.path(),
        "axis",
    );
}
