//! Sweeps of a study: each value is the study with that value, and what is refused.

use crate::study::{AXIS, CASCADE, Desk, SHORT, WHOLE, together};
use crate::study_axis::{FRICTIONLESS, LOOP, REST, STIFFNESS, desk};
use stiction_files::study::result::{StudyFile, SweepEntry, SweepRow};
use stiction_identify::Silent;

fn sweep(key: &str, values: &[&str]) -> String {
    let values: Vec<String> = values.iter().map(|v| format!("{v:?}")).collect();
    format!(
        "\n[[sweep]]\nkey = \"{key}\"\nvalues = [{}]\n",
        values.join(", ")
    )
}

fn found<'e>(entry: &'e SweepEntry, compensator: &str) -> &'e SweepRow {
    let row = entry.results.iter().find(|r| r.compensator == compensator);
    row.unwrap_or_else(|| panic!("no {compensator}"))
}

/// A spring that is swept against the closed form: at rest both springs balance.
#[test]
fn a_spring_is_swept() {
    let springs = sweep("axis.spring", &["10 N/mm", "20 N/mm", "0.03 MN/m"]);
    let file = desk().run(&together(&[FRICTIONLESS, REST, LOOP, &springs]));
    let [entry] = &file.sweeps[..] else {
        panic!("{:?}", file.sweeps);
    };
    assert_eq!(
        (entry.key.as_str(), entry.unit.as_str()),
        ("axis.spring", "N/m")
    );
    assert_eq!(entry.values, [10e3, 20e3, 30e3]);
    let errors = &found(entry, "none").metric("peak_error").unwrap().values;
    for (spring, error) in entry.values.iter().zip(errors) {
        let expected = 0.01 * spring / (STIFFNESS + spring);
        assert!((error.unwrap() / expected - 1.0).abs() < 1e-6, "{error:?}");
    }
}

/// An axis that does not give the exponent of its curve has 2, and may be swept over others.
#[test]
fn an_exponent_is_swept_that_the_axis_does_not_give() {
    let desk = Desk::new();
    let study = together(&[AXIS, SHORT, CASCADE, WHOLE]);
    let swept = "\n[[sweep]]\nkey = \"law.stribeck_exponent\"\nvalues = [1, 2]\n";
    let all = desk.run(&together(&[&study, swept]));
    let errors = &found(&all.sweeps[0], "none")
        .metric("peak_error")
        .unwrap()
        .values;
    let alone = desk.run(&study);
    let own = alone
        .results
        .iter()
        .find(|r| r.compensator == "none")
        .unwrap();
    let own = own.metrics.iter().find(|m| m.name == "peak_error").unwrap();
    assert_eq!(errors[1], Some(own.mean));
    assert_ne!(errors[0], errors[1]);
}

/// Whatever is swept, the runs are those of a file that has the value.
#[test]
fn a_value_of_a_sweep_is_the_study_with_that_value() {
    let desk = Desk::new();
    let numbers = "mass = \"4.6 kg\"\nparameters = { sigma0 = \"2e6 N/m\", sigma1 = \"1500 N s/m\", sigma2 = \"30 N s/m\", \
                   coulomb = \"12 N\", static = \"18 N\", stribeck_velocity = \"3 mm/s\" }";
    let axis = AXIS.replace("known        = \"motor\"", numbers);
    let corners = "\n[[parameter_error]]\nkind = \"corners\"\nby = \"10 %\"\n";
    let study = together(&[&axis, SHORT, CASCADE, WHOLE, corners]);
    // The key, its values, and the file with the second of them.
    let cases = [
        ("law.sigma0", ["1e6 N/m", "3 N/um"], ("2e6 N/m", "3e6 N/m")),
        ("axis.parameters.static", ["15 N", "24 N"], ("18 N", "24 N")),
        (
            "axis.mass",
            ["2 kg", "9 kg"],
            ("mass = \"4.6 kg\"", "mass = \"9 kg\""),
        ),
        ("axis.encoder", ["10 nm", "1 um"], ("50 nm", "1 um")),
        (
            "axis.delay",
            ["0.1 ms", "0.5 ms"],
            ("[axis]", "[axis]\ndelay = \"0.5 ms\""),
        ),
        ("path.amplitude", ["20 um", "0.5 mm"], ("0.2 mm", "0.5 mm")),
        (
            "controller.bandwidth",
            ["30 Hz", "90 Hz"],
            ("60 Hz", "90 Hz"),
        ),
    ];
    for cases in cases.chunks(4) {
        let sweeps: String = cases
            .iter()
            .map(|(key, values, _)| sweep(key, values))
            .collect();
        let all = desk.run(&together(&[&study, &sweeps]));
        assert_eq!(all.sweeps.len(), cases.len());
        for ((key, _, (from, to)), entry) in cases.iter().zip(&all.sweeps) {
            let alone = desk.run(&study.replacen(from, to, 1));
            assert_eq!(
                entry.results.len(),
                2,
                "without and with compensation, exact alone"
            );
            for row in &entry.results {
                let of_file = alone
                    .results
                    .iter()
                    .find(|r| r.compensator == row.compensator && r.parameters == "exact");
                for metric in &of_file.unwrap().metrics {
                    let swept = row.metric(&metric.name).unwrap().values[1];
                    assert_eq!(swept, Some(metric.mean), "{key}, {}", metric.name);
                }
            }
        }
        // What is not swept stays as it is.
        assert_eq!(all.results, desk.run(&study).results);
    }
}

/// The same bits with any number of threads, also of sweeps; the report and the terminal show them.
#[test]
fn sweeps_are_shown() {
    let desk = Desk::new();
    let sweeps = together(&[
        &sweep("law.sigma0", &["0.2e6 N/m", "1e6 N/m", "5e6 N/m"]),
        "\n[[sweep]]\nkey = \"compensator.gain\"\nvalues = [0.25, 0.5, 1]\n",
    ]);
    let study = desk
        .study(&together(&[AXIS, SHORT, CASCADE, WHOLE, &sweeps]))
        .unwrap();
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build()
            .unwrap()
            .install(|| stiction_workflows::study::simulate(&study, &mut Silent))
    };
    let [one, three] = [1, 3].map(with);
    let json = |file: &StudyFile| serde_json::to_string(file).unwrap();
    assert!(json(&one.file) == json(&three.file));
    let file: StudyFile = serde_json::from_str(&json(&one.file)).unwrap();
    assert_eq!(file, one.file);
    // More of the right force leaves less of the error.
    let gains = &file.sweeps[1];
    let errors = &found(gains, "whole").metric("peak_error").unwrap().values;
    assert!(
        errors.windows(2).all(|pair| pair[1] < pair[0]),
        "{errors:?}"
    );
    let without = &found(gains, "none").metric("peak_error").unwrap().values;
    assert!(
        without.windows(2).all(|pair| pair[1] == pair[0]),
        "{without:?}"
    );
    let html = String::from_utf8(stiction_pages::bundle::study(&one).files()[0].1.clone()).unwrap();
    stiction_testkit::assert_tables_fit(&html);
    let text = stiction_pages::text::study(&one);
    for words in ["tiffness", "gain of the compensator"] {
        assert!(
            html.contains(words) || html.contains(&words.replacen('g', "G", 1)),
            "{words}"
        );
        assert!(text.contains(words), "{text}");
    }
    // Courses are those of the study itself.
    assert_eq!(one.traces.len(), 2);
}

#[test]
fn what_is_refused_of_sweeps() {
    let desk = Desk::new();
    let good = together(&[AXIS, SHORT, CASCADE, WHOLE]);
    let mut out = String::new();
    for more in [
        "key = \"sigma0\"\nvalues = [1, 2]".into(),
        "key = \"law.\"\nvalues = [1, 2]".into(),
        "key = 5\nvalues = [1, 2]".into(),
        "values = [1, 2]".into(),
        "key = \"law.sigma0\"".into(),
        "key = \"law.sigma0\"\nvalues = \"1e6 N/m\"".into(),
        "key = \"law.sigma0\"\nvalues = [\"1e6 N/m\"]".into(),
        format!("key = \"law.sigma0\"\nvalues = [{}]", "1, ".repeat(17)),
        "key = \"law.sigma0\"\nvalues = [\"1e6 N/m\", \"1 N/um\"]".into(),
        "key = \"law.sigma0\"\nvalues = [\"1e6 N/m\", \"2 mm\"]".into(),
        "key = \"law.sigma0\"\nvalues = [\"1 mm\", \"2 mm\"]".into(),
        "key = \"law.sigma0\"\nvalues = [\"-1 N/m\", \"2 N/m\"]".into(),
        "key = \"law.sigma0\"\nvalues = [\"1 N/m\", \"many\"]".into(),
        "key = \"law.coulomb\"\nvalues = [\"12 N\", \"19 N\"]".into(),
        "key = \"law.mass\"\nvalues = [\"1 kg\", \"2 kg\"]".into(),
        "key = \"axis.mass\"\nvalues = [\"0 kg\", \"2 kg\"]".into(),
        "key = \"axis.mas\"\nvalues = [\"1 kg\", \"2 kg\"]".into(),
        "key = \"axis.encoder\"\nvalues = [\"1 um\", \"1 m\"]".into(),
        "key = \"path.velocity\"\nvalues = [\"1 mm/s\", \"2 mm/s\"]".into(),
        "key = \"path.frequency\"\nvalues = [\"1 Hz\", \"1 kHz\"]".into(),
        "key = \"path.kind\"\nvalues = [1, 2]".into(),
        "key = \"controller.kind\"\nvalues = [\"cascade\", \"pid\"]".into(),
        "key = \"axis.model\"\nvalues = [\"a.toml\", \"b.toml\"]".into(),
        "key = \"compensator.gain\"\nvalues = [0.5, 1.5]".into(),
        "key = \"axis.mass\"\nvalues = [\"1 kg\", \"2 kg\"]\nsteps = 5".into(),
    ] {
        let more: String = more;
        out += &desk.refusal(&format!("{good}\n[[sweep]]\n{more}\n"));
        out.push('\n');
    }
    let five = sweep("axis.mass", &["1 kg", "2 kg"]).repeat(5);
    let twice = sweep("axis.mass", &["1 kg", "2 kg"]).repeat(2);
    for more in [five, twice] {
        out += &desk.refusal(&together(&[&good, &more]));
        out.push('\n');
    }
    insta::assert_snapshot!(out);
}
