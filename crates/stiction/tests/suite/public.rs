//! What a program sees: typed keys, one builder, and numbers that are not to be used kept apart.

use crate::common::{Bench, both_ways, friction, noise};
use std::ops::ControlFlow;
use stiction::{
    Axis, Code, Export, Identification, LawKind, Log, Method, Name, Origin, Quantity, Search,
    SearchMethod, Side, Stage, Status, Target, Verdict,
};

#[test]
fn names_that_users_type_are_keys() {
    let name: Name = "coulomb_pos".parse().unwrap();
    assert_eq!(name, Name::new(Quantity::Coulomb, Side::Positive));
    assert_eq!(name.to_string(), "coulomb_pos");
    assert_eq!("gms".parse(), Ok(LawKind::Gms));
    assert_eq!("tcpou".parse(), Ok(Target::TcPou));
    let searches = [
        ("ga", SearchMethod::Genetic),
        ("adaptive-ga", SearchMethod::AdaptiveGenetic),
        ("annealing-ga", SearchMethod::AnnealingGenetic),
        ("niched-ga", SearchMethod::NichedGenetic),
        ("de", SearchMethod::DifferentialEvolution),
        ("cma-es", SearchMethod::CmaEs),
        ("pso", SearchMethod::ParticleSwarm),
        ("annealing", SearchMethod::Annealing),
        ("nelder-mead", SearchMethod::NelderMead),
        ("lm", SearchMethod::LevenbergMarquardt),
    ];
    assert_eq!(searches.map(|(_, search)| search), SearchMethod::ALL);
    for (name, search) in searches {
        assert_eq!(name.parse::<SearchMethod>().unwrap(), search);
    }
    let refused = [
        "lugree".parse::<LawKind>().unwrap_err().to_string(),
        "x".parse::<Target>().unwrap_err().to_string(),
        "x".parse::<SearchMethod>().unwrap_err().to_string(),
        "x".parse::<Name>().unwrap_err().to_string(),
    ];
    insta::assert_snapshot!(refused.join("\n"));
}

#[test]
fn a_number_that_is_not_determined_has_to_be_asked_for() {
    let bench = Bench::new();
    let axis = Axis::parse("mass = \"9 kg\"\n").unwrap();
    let log = [Log::open_with(bench.good("a.csv", 1), &axis).unwrap()];
    let asked = Identification::of(&log).axis(&axis).law(LawKind::LuGre);
    let fit = asked.without_comparison().run().unwrap();
    let own = |quantity: Quantity| fit.parameter(quantity).unwrap();

    let coulomb = own(Quantity::Coulomb).determined().unwrap();
    let (low, high) = coulomb.interval;
    assert!(low < 20.0 && 20.0 < high && high - low < 3.0, "{coulomb:?}");
    assert!(low < coulomb.value && coulomb.value < high);
    // It was given, and is exact.
    let mass = own(Quantity::Mass);
    assert_eq!(mass.origin(), Origin::Given);
    assert_eq!(mass.determined().unwrap().interval, (9.0, 9.0));
    // The force jumps where the axis reverses: no stiffness.
    let stiffness = own(Quantity::Sigma0);
    assert!(stiffness.value().is_finite() && !stiffness.reason().is_empty());
    assert_eq!(stiffness.determined(), None);

    // 60 N s/m, and 1 N of a constant force.
    for v in [-0.2, 0.1, 0.3] {
        let at = fit.friction(v).unwrap();
        let due = 20.0 * f64::signum(v) + 60.0 * v + 1.0;
        assert!((at.force - due).abs() < 0.5, "{v}: {at:?}, {due}");
        assert!(0.0 < at.at_once && at.at_once <= at.repeat && at.repeat <= at.transfer);
    }
    let (_, top) = fit.friction_speeds().unwrap();
    assert!(fit.friction(top).is_some());
    assert_eq!((fit.friction(0.0), fit.friction(1.01 * top)), (None, None));
    let variance = fit
        .covariance(Quantity::Coulomb, Quantity::Coulomb)
        .unwrap();
    let std = own(Quantity::Coulomb).std().unwrap();
    assert!(
        (variance.sqrt() / std - 1.0).abs() < 1e-6,
        "{variance} {std}"
    );
}

#[test]
fn a_log_that_was_read_and_its_file_are_one() {
    let bench = Bench::new();
    let (file, unseen) = (bench.good("a.csv", 1), bench.good("b.csv", 2));
    let (log, other) = (Log::open(&file).unwrap(), Log::open(&unseen).unwrap());
    let law = |asked: Identification<'_>| {
        let asked = asked.law(LawKind::CoulombViscous).without_comparison();
        asked.run().unwrap().model().to_toml()
    };
    let of_files = law(Identification::of([&file]).validate([&unseen]));
    assert_eq!(law(Identification::of([&log]).validate(&[other])), of_files);
    let mixed = Identification::of([&log]).validate([unseen.as_path()]);
    assert_eq!(law(mixed), of_files);

    // Listed in an axis file, from where that is.
    let text = "[[log]]\nfile = \"a.csv\"\n\n[[log]]\nfile = \"b.csv\"\nvalidate = \"all\"\n";
    let axis = Axis::read(bench.write("axis.toml", text)).unwrap();
    let asked = Identification::listed(&axis).law(LawKind::CoulombViscous);
    let listed = asked.without_comparison().run().unwrap();
    assert_eq!(listed.result()["validation"].as_array().unwrap().len(), 1);
}

#[test]
fn an_observer_stops_the_work_and_keeps_what_was_found() {
    let bench = Bench::new();
    let file = bench.good("a.csv", 1);
    let mut stages = Vec::new();
    let fit = Identification::of([&file])
        .law(LawKind::LuGre)
        .search(Search::new(SearchMethod::CmaEs).evaluations(2000))
        .observer(|progress| {
            stages.push(progress.stage);
            match progress.stage {
                Stage::Search if progress.evaluations > 200 => ControlFlow::Break(()),
                _ => ControlFlow::Continue(()),
            }
        })
        .run()
        .unwrap();
    assert_eq!(
        (fit.status(), fit.verdict()),
        (Status::Interrupted, Verdict::Interrupted)
    );
    assert!(stages.contains(&Stage::Search), "{stages:?}");
}

#[test]
fn errors_have_parts() {
    let bench = Bench::new();
    let file = bench.good("a.csv", 1);
    let both = Identification::of([&file]).asymmetric().run().unwrap_err();
    assert_eq!(both.code(), Code::Usage);
    assert_eq!(
        (both.place(), both.found()),
        ("", "law = auto with asymmetric")
    );
    assert!(
        both.allowed().starts_with("one law, such as law = lugre"),
        "{both}"
    );

    let other = Identification::of([&file])
        .method(Method::OutputError)
        .search(Search::new(SearchMethod::CmaEs));
    let other = other.run().unwrap_err();
    assert!(other.found().contains("search = cma-es"), "{other}");

    let axis = bench.write("axis.toml", "name = \"X\"\nmass = \"4 s\"\n");
    let refused = Axis::read(&axis).unwrap_err();
    assert_eq!(refused.code(), Code::BadConfig);
    assert_eq!(refused.to_correct(), [(axis.as_path(), Some(2))]);
    assert!(
        refused
            .place()
            .ends_with("axis.toml: line 2, column 8, mass"),
        "{}",
        refused.place()
    );

    let motion = bench.log(
        "b.csv",
        100,
        |t| both_ways(t)[0],
        |i, t| friction(both_ways(t)) + noise(1, i),
    );
    let short = Identification::of([&motion]).run().unwrap_err();
    assert_eq!(short.code(), Code::TooFewSamples);
    assert!(
        short.place().ends_with("b.csv") && !short.found().is_empty(),
        "{short}"
    );
}

/// Options are told as the builders have them, and one that is wrong by itself is the place.
#[test]
fn errors_advise_what_a_builder_has() {
    let bench = Bench::new();
    let file = bench.good("a.csv", 1);
    let asked = || Identification::of([&file]);
    let search = || Search::new(SearchMethod::Genetic);
    let refused = [
        asked().method(Method::OutputError).search(search()),
        asked().search(search().evaluations(0)),
        asked().search(search()).law(LawKind::CoulombViscous),
        asked().search(search().without_least_squares().target(-1.0)),
        asked()
            .method(Method::Static)
            .search(search().checkpoint("x")),
        asked().without_comparison(),
        asked().split(f64::NAN),
    ];
    let said = refused.map(|asked| {
        let error = asked.run().unwrap_err();
        assert_eq!(error.code(), Code::Usage);
        format!("{}: {error}", error.place())
    });
    insta::assert_snapshot!(said.join("\n"));
}

#[test]
fn the_last_word_on_the_directions_counts() {
    let bench = Bench::new();
    let file = bench.good("a.csv", 1);
    let asked = || {
        let asked = Identification::of([&file]).law(LawKind::CoulombViscous);
        asked.without_comparison()
    };
    let is_asymmetric = |asked: Identification| asked.run().unwrap().is_asymmetric();
    assert!(!is_asymmetric(asked().asymmetric().symmetric()));
    assert!(is_asymmetric(asked().symmetric().asymmetric()));
}

/// What no export takes is no compensator either.
#[test]
fn a_cycle_time_is_refused_alike() {
    let text = stiction::library::machine("xl330")
        .unwrap()
        .model()
        .unwrap();
    for cycle_time in [1e9, 0.2, 1e-7, 0.0, f64::NAN] {
        let export = Export::new(Target::Rust, cycle_time).model(&text);
        let (export, own) = (
            export.unwrap_err(),
            text.compensator(cycle_time).unwrap_err(),
        );
        assert_eq!(own.code(), Code::NotExported);
        assert_eq!(own.to_string(), export.to_string());
    }
    assert!(text.compensator(1e-3).is_ok());
}

#[test]
fn the_law_of_a_drive_has_its_types_here() {
    let law = stiction::library::machine("xl330")
        .unwrap()
        .model()
        .unwrap()
        .law()
        .unwrap();
    let lugre: Option<stiction::friction::LuGre<f64>> = law.lugre();
    assert_eq!(
        lugre.is_some(),
        matches!(law.kind(), LawKind::LuGre | LawKind::Dahl)
    );
}

#[test]
fn what_is_found_goes_from_thread_to_thread() {
    fn shared<T: Send + Sync + 'static>() {}
    shared::<stiction::Error>();
    shared::<stiction::Fit>();
    shared::<stiction::SavedFit>();
    shared::<stiction::Check>();
    shared::<stiction::Exported>();
    shared::<stiction::robot::RobotFit>();
    shared::<(Log, Axis, stiction::Model, stiction::Law)>();
}
