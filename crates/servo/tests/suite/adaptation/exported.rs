//! The compensator of a case as exported C, in a program of its own.

use super::case::{Assumed, Case};
use std::io::{Read, Write};
use std::process::{Command, Stdio};
use stiction_export::{Model, Provenance, Target, export};
use stiction_friction::compensator::{Input, Terms};
use stiction_testkit::programs::run;
use tempfile::TempDir;

/// Law and settings in, then for each sample velocity, error and force of the drive in and the force out.
const PROGRAM: &str = r#"
#include "axis_friction.h"
#include <stdio.h>
int main(void) {
    double law[10];
    axis_params_t p;
    axis_state_t s;
    axis_params(&p);
    if (fread(law, sizeof law, 1, stdin) != 1) { return 1; }
    p.sigma0 = law[0];
    p.sigma1 = law[1];
    p.pos.coulomb = law[2];
    p.pos.static_friction = law[3];
    p.pos.stribeck_velocity = law[4];
    p.pos.viscous = law[5];
    p.neg = p.pos;
    p.cycle_time = law[6];
    p.limit = law[7];
    p.slew = law[8];
    p.mass = law[9];
    if (!axis_init(&p, &s)) { return 1; }
    double in[3];
    while (fread(in, sizeof in, 1, stdin) == 1) {
        const axis_input_t input = { in[0], in[1], true, in[2], true };
        const double force = axis_step(&p, &s, &input);
        if (fwrite(&force, sizeof force, 1, stdout) != 1 || fflush(stdout) != 0) { return 1; }
    }
    return 0;
}
"#;

/// The program, which takes the numbers of any axis.
pub struct Exported(TempDir);

impl Exported {
    pub fn compile() -> Self {
        let compensator = Case::random(0, 0).compensator(Assumed::Adapted).unwrap();
        let model = Model {
            title: "axis".into(),
            identifier: "axis".into(),
            rotary: false,
            force_unit: "N".into(),
            friction: *compensator.friction(),
            terms: Terms::default(),
            load_unit: String::new(),
            backlash: None,
            settings: *compensator.settings(),
            rated_force: None,
            top_speed: None,
            parameters: vec![],
            domain: stiction_export::Domain::default(),
            draws: None,
            notes: vec![],
            provenance: Provenance {
                version: "0".into(),
                model_sha256: "00".repeat(32),
                inputs: vec![],
            },
        };
        let dir = tempfile::tempdir().unwrap();
        for file in export(&model, Target::C).unwrap() {
            std::fs::write(dir.path().join(&file.path), &file.bytes).unwrap();
        }
        std::fs::write(dir.path().join("program.c"), PROGRAM).unwrap();
        let arguments = ["-std=c99", "-O2", "program.c", "axis_friction.c", "-lm"];
        run("gcc", &arguments, dir.path());
        Exported(dir)
    }

    /// Largest error of a cycle with factors that the C finds.
    pub fn run(&self, case: &Case) -> f64 {
        let compensator = case.compensator(Assumed::Adapted).unwrap();
        let settings = compensator.settings();
        let law = compensator.friction().bristle().unwrap();
        let side = law.curve().positive();
        let mut child = Command::new(self.0.path().join("a.out"))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut to = child.stdin.take().unwrap();
        let mut from = child.stdout.take().unwrap();
        let mut give = |numbers: &[f64]| {
            let bytes: Vec<u8> = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
            to.write_all(&bytes).unwrap();
        };
        give(&[
            law.stiffness(),
            law.damping().at_rest(),
            side.coulomb,
            side.static_friction,
            side.stribeck_velocity,
            side.viscous,
            settings.cycle_time,
            settings.limit,
            settings.slew,
            settings.adaptation.unwrap().mass,
        ]);
        let peak = case.start(Assumed::Adapted).run(&mut |input: Input<f64>| {
            give(&[
                input.reference_velocity,
                input.tracking_error,
                input.drive_force,
            ]);
            let mut force = [0; 8];
            from.read_exact(&mut force).unwrap();
            f64::from_le_bytes(force)
        });
        drop(to);
        assert!(child.wait().unwrap().success());
        peak
    }
}
