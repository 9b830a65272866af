//! Whole commands whose instructions `cargo xtask instructions` counts: `whole_commands WHAT`.
//!
//! A short log of a simulated axis is written to a temporary folder; what [`counted`] does with it is what
//! `stiction identify LOG --out DIR` does: reading, conditioning with the choice of cut-offs, search, intervals, the other
//! laws beside it, the files with the report. On one thread. The same of the demo and of measured recordings, where there are.

use std::fmt::Write;
use std::hint::black_box;
use stiction_identify::Silent;
use stiction_pages::bundle;
use stiction_parameters::LawKind;
use stiction_servo::cascade::Cascade;
use stiction_servo::closed_loop::{ClosedLoop, ForceLog};
use stiction_servo::encoder::Encoder;
use stiction_servo::known;
use stiction_servo::path::Path;
use stiction_servo::plant::Plant;
use stiction_workflows::identify::Files;
use stiction_workflows::identify::Options;

const RATE: f64 = 1000.0;
const SECONDS: f64 = 1.5;
/// Encoder step, m.
const STEP: f64 = 100e-9;

/// The function by whose name the counting is switched on.
#[inline(never)]
fn counted(work: &mut dyn FnMut()) {
    work();
}

/// A velocity sine of 50 mm/s and 1 Hz under a cascade, as a log in text.
fn log() -> String {
    let axis = known::find("machine").expect("a known axis");
    let record = ClosedLoop {
        plant: Plant::new(axis.mass, axis.law).expect("a plant"),
        controller: Cascade::tuned(axis.mass, 60.0, 1e3).expect("a controller"),
        path: Path::sine(0.05, 1.0, SECONDS).expect("a path"),
        encoder: Encoder::new(STEP).expect("an encoder"),
        rate: RATE,
        substeps: 10,
        force_noise: 0.3,
        force_log: ForceLog::Held,
        seed: 1,
    }
    .run()
    .expect("a log");
    let mut text = String::from("time [s],position [um],force [N]\n");
    for ((t, x), u) in record.time.iter().zip(&record.position).zip(&record.force) {
        writeln!(text, "{t:.4},{:.1},{u:.4}", 1e6 * x).expect("memory");
    }
    text
}

/// A recording with its axis file.
fn measured(log: &str, axis: &str) -> Files {
    let data = stiction_testkit::recordings().expect("recordings");
    Files {
        logs: vec![data.join(log)],
        axis: Some(data.join(format!("axes/{axis}.toml"))),
        ..Files::default()
    }
}

fn main() {
    let what = std::env::args().nth(1).unwrap_or_default();
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut options = Options::default();
    let files = match what.as_str() {
        "command-identify" | "command-auto" => {
            options.law = (what == "command-identify").then_some(LawKind::LuGre);
            let file = folder.path().join("log.csv");
            std::fs::write(&file, log()).expect("a log on disk");
            Files {
                logs: vec![file],
                ..Files::default()
            }
        }
        "command-demo" => {
            let file = folder.path().join("demo.csv");
            stiction_workflows::demo::write_log(&file, 1).expect("a log on disk");
            Files {
                logs: vec![file],
                ..Files::default()
            }
        }
        "command-emps" => measured("emps/DATA_EMPS.mat", "emps"),
        "command-servo" => measured("servo/sliding_1.txt", "servo"),
        "command-tribometer" => measured("tribometer/presliding.tsv", "tribometer"),
        _ => {
            eprintln!("usage: whole_commands command-identify|auto|demo|emps|servo|tribometer");
            std::process::exit(2);
        }
    };
    let one = rayon::ThreadPoolBuilder::new().num_threads(1);
    one.build().expect("a thread").install(|| {
        counted(&mut || {
            let outcome = stiction_workflows::identify::identify(&files, &options, &mut Silent);
            black_box(bundle::identification(&outcome.expect("an outcome")));
        });
    });
}
