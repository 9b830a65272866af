//! Comparisons in memory: every problem can be solved, and what cannot be compared is refused.

use stiction_files::compare_file::CompareFile;
use stiction_identify::candidates::Scheme;
use stiction_identify::{Control, Progress, Silent};
use stiction_workflows::compare::{CompareOptions, Cost, Excitation, Input, compare};

fn options(problem: &str, methods: &[&str]) -> CompareOptions {
    CompareOptions {
        input: Input::Named(problem.into()),
        axis: None,
        methods: methods.iter().map(|m| (*m).to_string()).collect(),
        seeds: 2,
        evaluations: 500,
        noise: Some(0.0),
        excitation: None,
        rate: None,
        other_law: false,
        decades: None,
        integrator: Scheme::Explin,
        cost: None,
        max_samples: u64::MAX,
    }
}

fn run(options: &CompareOptions) -> CompareFile {
    compare(options, &mut Silent).unwrap_or_else(|e| panic!("{options:?}: {e}"))
}

/// Least squares from many starts find every parameter of every problem that determines them.
#[test]
fn every_problem_has_the_answer_that_it_states() {
    for name in [
        "C95", "machine", "motor", "V3", "V5", "V6", "V7", "v10", "V16",
    ] {
        let file = run(&options(name, &["lm"]));
        let [method] = &file.methods[..] else {
            panic!("{name}: one method")
        };
        assert_eq!(file.success, "every parameter within 1 % of the truth");
        assert_eq!(method.own.successes, 2, "{name}: {:?}", method.own.errors);
        assert!(file.reference.cost < 1e-6, "{name}: {:?}", file.reference);
        assert!(!file.reference.beaten, "{name}: {:?}", file.reference);
    }
}

/// V2 says nothing of Fs and vs: the cost reaches its optimum far from the truth.
#[test]
fn v2_does_not_determine_what_it_states() {
    let noisy = CompareOptions {
        noise: Some(0.01),
        ..options("V2", &["lm"])
    };
    let file = run(&noisy);
    let own = &file.methods[0].own;
    assert_eq!(own.successes, 2);
    let error = |name: &str| {
        let found = own.errors.iter().find(|e| e.name == name);
        found.and_then(|e| e.relative).unwrap()[1]
    };
    assert!(error("coulomb_pos") < 0.03);
    assert!(error("static_pos") > 0.1 || error("stribeck_velocity_pos") > 0.1);
}

/// A parameter that is zero stands inside its box as well as its logarithm allows: the noise asks for no
/// more of it than the box leaves.
#[test]
fn a_parameter_of_zero_costs_no_success() {
    for noise in [0.002, 0.01] {
        let noisy = CompareOptions {
            noise: Some(noise),
            ..options("V10", &["lm"])
        };
        let own = &run(&noisy).methods[0].own;
        let excess = own.excess.unwrap()[2];
        assert!(own.successes == 2 && excess < 1e-5, "{noise}: {excess:e}");
    }
}

/// A simplex begins where its seed puts it.
#[test]
fn seeds_differ_in_every_method() {
    let file = run(&options(
        "machine",
        &["nelder-mead", "lm", "de", "niched-ga"],
    ));
    for method in &file.methods {
        let [a, b] = &method.runs[..] else {
            panic!("two runs")
        };
        assert_ne!(a.cost_own, b.cost_own, "{}", method.name);
    }
}

#[test]
fn motions_costs_and_integrators_can_be_chosen() {
    let base = options("machine", &["de"]);
    let files = [
        CompareOptions {
            excitation: Some(Excitation::BreakAway),
            other_law: true,
            noise: None,
            ..base.clone()
        },
        CompareOptions {
            cost: Some(Cost::Position),
            rate: Some(300.0),
            ..base.clone()
        },
        CompareOptions {
            integrator: Scheme::RungeKutta,
            excitation: Some(Excitation::MultiSine),
            ..base.clone()
        },
        CompareOptions {
            cost: Some(Cost::Separable),
            excitation: Some(Excitation::ThreeSegments),
            ..base.clone()
        },
        CompareOptions {
            cost: Some(Cost::Curve),
            ..base.clone()
        },
        CompareOptions {
            cost: Some(Cost::Dynamic),
            ..base
        },
    ]
    .map(|options| run(&options));
    for file in &files {
        let least = file.methods[0].runs.iter().filter_map(|r| r.cost);
        for cost in least {
            assert!(
                cost >= file.reference.cost * (1.0 - 1e-5) - 1e-13,
                "{file:?}"
            );
        }
        // Read back, nothing is lost.
        let text = serde_json::to_string(file).unwrap();
        assert_eq!(&serde_json::from_str::<CompareFile>(&text).unwrap(), file);
        for (name, content) in stiction_pages::bundle::comparison(file).files() {
            let text = std::str::from_utf8(content).unwrap();
            if *name == "report.html" {
                stiction_testkit::assert_tables_fit(text);
                let parsing = roxmltree::ParsingOptions {
                    allow_dtd: true,
                    ..roxmltree::ParsingOptions::default()
                };
                roxmltree::Document::parse_with_options(text, parsing).unwrap();
            }
        }
    }
    assert!(!files[1].least_squares && !files[2].least_squares && files[3].least_squares);
}

/// A best cost so far can only fall, also where some runs have none yet.
#[test]
fn courses_never_rise() {
    let several = CompareOptions {
        seeds: 5,
        ..options("C95", &["niched-ga", "de", "lm"])
    };
    for method in run(&several).methods {
        for course in [&method.by_evaluations, &method.by_time] {
            assert!(!course.at.is_empty(), "{}", method.name);
            for costs in [&course.low, &course.median, &course.high] {
                assert!(
                    costs.is_sorted_by(|a, b| a >= b),
                    "{}: {costs:?}",
                    method.name
                );
            }
        }
    }
}

/// Stops after so many looks.
struct After(usize);

impl stiction_identify::Observer for After {
    fn progress(&mut self, _: &Progress) -> Control {
        self.0 = self.0.saturating_sub(1);
        match self.0 {
            0 => Control::Stop,
            _ => Control::Continue,
        }
    }
}

#[test]
fn what_was_complete_is_kept() {
    let long = CompareOptions {
        seeds: 5000,
        ..options("machine", &["lm"])
    };
    let file = compare(&long, &mut After(40)).unwrap();
    assert_eq!(file.status, "interrupted");
    assert!(file.methods[0].runs.len() < 5000);
    assert!(stiction_pages::text::comparison(&file).ends_with("are left out\n"));
}

#[test]
fn what_cannot_be_compared_is_refused_in_words() {
    let refused = |change: &dyn Fn(&mut CompareOptions)| {
        let mut options = options("machine", &["de"]);
        change(&mut options);
        let e = compare(&options, &mut Silent).expect_err("refused");
        assert_eq!(e.code().as_str(), "usage");
        e.to_string()
    };
    let texts = [
        refused(&|o| o.input = Input::Named("V4".into())),
        refused(&|o| o.methods = vec!["de".into(), "anneal".into()]),
        refused(&|o| o.methods = vec!["de".into(), "de".into()]),
        refused(&|o| o.seeds = 0),
        refused(&|o| o.noise = Some(-0.1)),
        refused(&|o| o.decades = Some(9.0)),
        refused(&|o| o.rate = Some(f64::NAN)),
        refused(&|o| {
            o.methods = vec!["lm".into()];
            o.integrator = Scheme::Euler;
        }),
        refused(&|o| {
            o.input = Input::Named("V7".into());
            o.cost = Some(Cost::Separable);
        }),
        refused(&|o| {
            o.cost = Some(Cost::Separable);
            o.integrator = Scheme::Euler;
        }),
        refused(&|o| {
            o.cost = Some(Cost::Position);
            o.excitation = Some(Excitation::Sine);
        }),
        refused(&|o| {
            o.input = Input::Log {
                logs: vec!["log.csv".into()],
            };
            o.rate = Some(1000.0);
        }),
    ];
    insta::assert_snapshot!(texts.join("\n"));
}
