//! How large a study is: counted before it runs, refused where it is too large.

use crate::study::Desk;
use stiction_files::study::Study;
use stiction_files::study::{MOST_SAMPLES, Size};
use stiction_identify::Silent;

/// 2 s of a sine at 2 kHz, 4001 samples.
const ONE: &str = r#"
[axis]
known      = "motor"
rate       = "2 kHz"
peak_force = "200 N"

[[path]]
kind      = "sine"
amplitude = "1 mm"
frequency = "2 Hz"

[[controller]]
kind      = "cascade"
bandwidth = "40 Hz"
"#;

fn with(parts: &str) -> String {
    format!("{ONE}{parts}")
}

/// The size of a study, whose runs are as many as there are in its result.
fn size(desk: &Desk, parts: &str) -> Size {
    let study = desk.study(&with(parts)).unwrap();
    let size = study.size();
    let mut seen = 0;
    let mut watch = |progress: &stiction_identify::Progress| {
        if let stiction_identify::Stage::Experiments { all, .. } = progress.stage {
            seen = all;
        }
        stiction_identify::Control::Continue
    };
    let file = stiction_workflows::study::simulate(&study, &mut watch).file;
    assert_eq!(size.runs, seen);
    let runs: usize = file.results.iter().map(|row| row.runs).sum();
    assert!(runs <= seen && file.warnings.iter().all(|w| w.code.as_str() != "not-run"));
    size
}

#[test]
fn every_pass_of_every_run_is_counted() {
    let desk = Desk::new();
    let pass = 4001;
    let of = |runs, passes| Size {
        runs,
        samples: passes * pass,
        longest: pass,
    };
    assert_eq!(size(&desk, ""), of(1, 1));
    // A watchdog learns on the motion without compensation, once for all that share it.
    let two = "[[compensator]]\nkind = \"lugre\"\n[[compensator]]\nkind = \"coulomb\"\n";
    assert_eq!(size(&desk, two), of(3, 3 + 1));
    let bold = "[[compensator]]\nkind = \"lugre\"\nwatchdog = false\n";
    assert_eq!(size(&desk, bold), of(2, 2));
    let learning =
        "[[compensator]]\nkind = \"learning\"\nlead = \"4 ms\"\ncutoff = \"100 Hz\"\npasses = 5\n";
    assert_eq!(size(&desk, learning), of(2, 1 + 5));
    // Corners are those of the compensator with a law alone.
    let corners = format!("{bold}[[parameter_error]]\nkind = \"corners\"\nby = \"10 %\"\n");
    assert_eq!(size(&desk, &corners), of(2 + 64, 2 + 64));
    // Every value of a sweep is a study of its own, without them.
    let sweep = "[[sweep]]\nkey = \"path.amplitude\"\nvalues = [\"1 mm\", \"2 mm\", \"3 mm\"]\n";
    let swept = format!("{corners}{sweep}");
    assert_eq!(size(&desk, &swept), of(66 + 3 * 2, 66 + 3 * 2));
}

#[test]
fn a_study_that_is_too_large_is_refused_with_what_makes_it_so() {
    let desk = Desk::new();
    let parts = r#"
[[path]]
kind      = "sine"
name      = "slow"
amplitude = "1 mm"
frequency = "0.01 Hz"

[[compensator]]
kind = "lugre"

[[parameter_error]]
kind = "corners"
by   = "10 %"

[[sweep]]
key    = "axis.mass"
values = ["5 kg", "6 kg"]
"#;
    let file = desk.write("large.toml", &with(parts));
    let study = Study::read(&file).unwrap();
    let samples = study.size().samples;
    assert!(samples <= MOST_SAMPLES);
    assert!(Study::read_within(&file, samples).is_ok());
    let refused = Study::read_within(&file, samples - 1).err().unwrap();
    assert_eq!(refused.code().as_str(), "too-large");
    let said = refused.to_string();
    let said = said.split_once("large.toml: ").unwrap().1;
    assert_eq!(
        said,
        "140 runs simulate 5.869e7 samples: 2 paths x 1 controller x 2 compensators x 65 variants (exact, 64 of ±10 %), and those with 2 \
         values of axis.mass; the longest motion, \"slow\", has 800001 samples; at most 5.869e7 are simulated unless more are allowed"
    );
    // The smallest of them runs.
    let one = Study::read(desk.write("one.toml", ONE)).unwrap();
    assert_eq!(
        stiction_workflows::study::simulate(&one, &mut Silent)
            .file
            .status,
        "complete"
    );
}
