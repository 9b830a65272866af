//! The experiments of Zhang et al. 2025: the axis that was simulated is found, compensation reduces what it should, and a
//! stop keeps what is done.

use crate::common::counted;
use stiction::commands::reproduce::{Budget, zhang_2025};
use stiction::commands::reproduce_file::ReproduceFile;
use stiction::{Control, Progress};

/// A fraction of the searching; least squares make up for it.
const SMALL: Budget = Budget {
    generations: 30,
    rounds: 2,
    seeds: 1,
};

#[test]
fn the_simulated_axis_is_found_and_compensated() {
    let mut steps = (0, 0);
    let outcome = zhang_2025(SMALL, &mut |progress: &Progress| {
        steps = counted(progress);
        Control::Continue
    });
    assert_eq!(steps, (11, 11));
    let file = &outcome.file;
    assert_eq!(file.status, "complete");
    for check in &file.checks {
        assert!(check.within, "{check:?}");
    }
    // Four static, two dynamic, six at once, two from the step, one mass.
    assert_eq!(file.checks.len(), 4 + 2 + 6 + 2 + 1);
    assert!(!file.assumptions.is_empty());

    let claim = |name: &str, fed: &str| {
        let found = file
            .claims
            .iter()
            .find(|c| c.name == name && c.compensation == fed);
        found.unwrap_or_else(|| panic!("no {name}, {fed}"))
    };
    // The stage under its fuzzy PID tracks to 60 to 80 um where friction turns round: presliding held against the
    // stiffness of the loop, as in docs/compensation.md for a slower sine.
    let reversal = claim("largest error at reversals", "reference velocity");
    assert!((5e-5..9e-5).contains(&reversal.without), "{reversal:?}");
    for (name, least) in [
        ("largest error at reversals", 99.0),
        ("largest speed error", 99.0),
        ("largest contour error, corner", 90.0),
    ] {
        let reference = claim(name, "reference velocity");
        let measured = claim(name, "measured velocity");
        assert!(reference.reduction_percent > least, "{reference:?}");
        // Fed back it does something, and less.
        assert!(measured.reduction_percent > 50.0, "{measured:?}");
        assert!(measured.with > reference.with, "{measured:?}");
    }
    let bundle = stiction::bundle::reproduction(&outcome);
    let text = |name: &str| {
        let found = bundle.files().iter().find(|(n, _)| *n == name);
        String::from_utf8(found.unwrap().1.clone()).unwrap()
    };
    let read: ReproduceFile = serde_json::from_str(&text("reproduce.json")).unwrap();
    assert_eq!(&read, file);
    let html = text("report.html");
    stiction_testkit::assert_tables_fit(&html);
    for figure in [
        "FIG. 1)",
        "FIG. 4–6",
        "FIG. 7)",
        "FIG. 12",
        "FIG. 13",
        "FIG. 14",
        "FIG. 15",
        "FIG. 16",
        "FIG. 17",
        "FIG. 19",
        "FIG. 20",
        "FIG. 21",
        "FIG. 22",
    ] {
        assert!(html.contains(figure), "{figure}");
    }
    for assumption in &file.assumptions {
        assert!(html.contains(&assumption[..20]), "{assumption}");
    }
}

#[test]
fn a_stop_keeps_what_is_done() {
    let outcome = zhang_2025(
        SMALL,
        &mut |progress: &Progress| match counted(progress).0 {
            ..3 => Control::Continue,
            _ => Control::Stop,
        },
    );
    let file = &outcome.file;
    assert_eq!(file.status, "interrupted");
    let experiments: Vec<&str> = file.checks.iter().map(|c| c.experiment.as_str()).collect();
    assert_eq!(experiments, ["static"; 4]);
    assert!(file.claims.is_empty());
    assert_eq!(stiction::bundle::reproduction(&outcome).files().len(), 2);
    let text = stiction::commands::text::reproduction(file);
    assert!(text.contains("STOPPED EARLY"), "{text}");
}
