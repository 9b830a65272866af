//! The experiments of Zhang et al. 2025: the axis that was simulated is found, compensation reduces what it should, and a
//! stop keeps what is done.

use crate::common::counted;
use stiction_files::reproduce_file::ReproduceFile;
use stiction_identify::{Control, Progress, Silent};
use stiction_workflows::reproduce::{
    Body, Budget, Compensation, Control as StageControl, Hold, OwnAxis, Reproduction, zhang_2025,
    zhang_2025_on,
};

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
    assert_eq!(steps, (25, 25));
    let file = &outcome.file;
    assert_eq!(file.status, "complete");
    for check in &file.checks {
        assert!(check.within, "{check:?}");
    }
    // Four static, without and with outliers, two dynamic, six at once, six as measured, two from the step, three masses.
    assert_eq!(file.checks.len(), 8 + 2 + 6 + 6 + 2 + 3);
    // Static, dynamic, six with each method; as measured static, dynamic, six.
    assert_eq!(file.searches.len(), 3 * 3 + 3);
    assert!(!file.assumptions.is_empty());
    assert!(file.not_run.is_empty(), "{:?}", file.not_run);

    let claim = |name: &str, compensation: &str| {
        let found = file
            .claims
            .iter()
            .find(|c| c.name == name && c.compensation == compensation);
        found.unwrap_or_else(|| panic!("no {name}, {compensation}"))
    };
    // The stage under its fuzzy PID tracks to 60 to 80 um where friction turns round: presliding held against the
    // stiffness of the loop, as in docs/compensation.md for a slower sine.
    let reversal = claim(
        "largest error at reversals, sine",
        "LuGre, reference velocity",
    );
    assert!((5e-5..9e-5).contains(&reversal.without), "{reversal:?}");
    for (name, least) in [
        ("largest error at reversals, sine", 99.0),
        ("largest speed error, sine", 99.0),
        ("largest contour error, corner with a stop", 90.0),
        // Two encoder steps are left, with the coupling on.
        (
            "largest contour error, corner with a stop, cross-coupled",
            75.0,
        ),
        (
            "largest feed error, corner with a stop, cross-coupled",
            95.0,
        ),
        ("largest contour error, corner at speed", 90.0),
    ] {
        let reference = claim(name, "LuGre, reference velocity");
        let measured = claim(name, "LuGre, measured velocity");
        assert!(reference.reduction_percent > least, "{reference:?}");
        // Fed back it does something, and less where more than encoder steps are left.
        assert!(measured.reduction_percent > 50.0, "{measured:?}");
        if least > 80.0 {
            assert!(measured.with > reference.with, "{measured:?}");
        }
    }
    let published = file.claims.iter().filter(|c| !c.published.is_empty());
    assert!(
        published
            .clone()
            .all(|c| c.name.ends_with("corner at speed, cross-coupled"))
    );
    assert_eq!(published.count(), 4);
    baselines(file);
    what_the_measured_velocity_does(&outcome);
    let bundle = stiction_pages::bundle::reproduction(&outcome);
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
        "FIG. 2)",
        "FIG. 3)",
        "FIG. 4–6",
        "End of a round",
        "FIG. 7)",
        "FIG. 8)",
        "FIG. 12",
        "FIG. 13",
        "FIG. 14",
        "FIG. 15",
        "FIG. 16",
        "FIG. 17",
        "FIG. 18",
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

/// Standstill and delay: what the measured velocity does to a law.
fn what_the_measured_velocity_does(outcome: &Reproduction) {
    let Body::Zhang2025(paper) = &outcome.body else {
        panic!("another publication");
    };
    let at = |hold: Hold, of: Compensation| {
        let mut runs = paper.rested.iter();
        runs.find(|r| r.hold == hold && r.compensation == of)
            .expect("the run")
    };
    let [pd, pid] = [Hold::Pd, Hold::Control(StageControl::Pid)];
    // Without an integral it stands where friction holds it.
    let bare = at(pd, Compensation::Nothing);
    assert!(bare.standing > 1e-7, "{}", bare.standing);
    // The steady curve on the measured velocity makes it hunt, the bristles on it do not.
    let curve = at(pid, Compensation::StribeckMeasured);
    let bristles = at(pid, Compensation::Measured);
    assert!(curve.hunting.is_some() && bristles.hunting.is_none());
    assert!(curve.swing > 10.0 * bristles.swing);
    // Delay: known ahead it costs little, fed back the more the later it comes.
    let [first, .., last] = &paper.delayed[..] else {
        panic!("delays");
    };
    let [_, reference, measured] = last.tracking.map(|t| t.reversal_peak);
    assert!(measured > first.tracking[2].reversal_peak);
    assert!(measured > 10.0 * reference, "{measured} {reference}");
}

/// Less than the law leaves more, under either controller.
fn baselines(file: &ReproduceFile) {
    for controller in ["PID", "fuzzy PID", "cascade"] {
        let peak = |compensation: &str| {
            let run = file.runs.iter().find(|r| {
                r.experiment == "sine"
                    && r.controller == controller
                    && r.compensation == compensation
            });
            let metrics = &run.expect("the run").metrics;
            let reversals = metrics
                .iter()
                .find(|m| m.name == "largest error at reversals");
            reversals.expect("the metric").value
        };
        let [none, coulomb, stribeck, simplified, lugre] = [
            "none",
            "Coulomb",
            "Stribeck",
            "simplified",
            "LuGre, reference velocity",
        ]
        .map(peak);
        // Bristles are worth more than the Stribeck effect where the motion turns back.
        assert!(
            simplified < coulomb.min(stribeck),
            "{simplified} {coulomb} {stribeck}"
        );
        // Neither knows presliding: Stribeck may even leave more than Coulomb.
        for simple in [coulomb, stribeck] {
            assert!(none > 3.0 * simple, "{none} {simple}");
            assert!(simple > 100.0 * lugre, "{simple} {lugre}");
        }
    }
    for experiment in [
        "sine",
        "corner with a stop",
        "corner with a stop, cross-coupled",
        "corner at speed",
        "corner at speed, cross-coupled",
    ] {
        let runs = file.runs.iter().filter(|r| r.experiment == experiment);
        assert_eq!(runs.count(), 18, "{experiment}");
    }
}

/// A rotary axis of a user, asymmetric and without viscous friction: what its model says is found, in its units, and what
/// cannot be run on it is said.
#[test]
fn on_an_axis_of_the_user() {
    let folder = tempfile::tempdir().unwrap();
    let [model, axis] = ["model.toml", "axis.toml"].map(|name| folder.path().join(name));
    let mut text = String::from(
        "schema = \"stiction.model/1\"\nkind = \"rotary\"\nlaw = \"lugre\"\nasymmetric = true\nforce_unit = \"N*m\"\n\
         trustworthy = true\n[source]\nversion = \"0\"\nmethod = \"separable\"\nseed = 0\ninputs = []\n",
    );
    for (name, value, unit) in [
        ("sigma0", 2750.0, "N*m/rad"),
        ("sigma1", 45.2, "N*m*s/rad"),
        ("coulomb_pos", 6.9, "N*m"),
        ("coulomb_neg", 7.1, "N*m"),
        ("static_pos", 8.5, "N*m"),
        ("static_neg", 8.5, "N*m"),
        ("stribeck_velocity_pos", 0.06, "rad/s"),
        ("stribeck_velocity_neg", 0.06, "rad/s"),
        ("sigma2_pos", 0.0, "N*m*s/rad"),
        ("sigma2_neg", 0.0, "N*m*s/rad"),
    ] {
        text.push_str(&format!(
            "[[parameter]]\nname = \"{name}\"\nsymbol = \"x\"\nvalue = {value:?}\nunit = \"{unit}\"\n\
             identifiable = true\norigin = \"identified\"\n"
        ));
    }
    std::fs::write(&model, text).unwrap();
    let known = "name = \"wrist\"\nkind = \"rotary\"\nmass = \"0.045 kg m2\"\n[log]\nresolution = \"1e-6 rad\"\n\
                 [terms]\ngravity = true\n[search.ga]\npopulation = 40\n";
    // A unit that does not fit the force of the model is refused with its line, not taken for another.
    for wrong in ["2 kN", "5 V"] {
        let text = known.replace("[terms]", &format!("force_limit = \"{wrong}\"\n[terms]"));
        std::fs::write(&axis, text).unwrap();
        let own = OwnAxis {
            axis: Some(axis.clone()),
            model: model.clone(),
        };
        let said = zhang_2025_on(&own, SMALL, &mut Silent)
            .err()
            .unwrap()
            .to_string();
        assert!(
            said.contains("line 6, column 15, log.force_limit: "),
            "{said}"
        );
        assert!(said.contains("the force of this model is in N*m"), "{said}");
    }
    std::fs::write(&axis, known).unwrap();
    let own = OwnAxis {
        axis: Some(axis),
        model,
    };
    let outcome = zhang_2025_on(&own, SMALL, &mut Silent).unwrap();
    let file = &outcome.file;
    assert_eq!(file.status, "complete");
    let checked = |experiment: &'static str| {
        let checks = file
            .checks
            .iter()
            .filter(move |c| c.experiment == experiment);
        checks.map(|c| (c.name.as_str(), c.unit.as_str(), c.reference, c.within))
    };
    let statics: Vec<_> = checked("static").collect();
    assert_eq!(
        statics,
        [
            ("coulomb", "N*m", 7.0, true),
            ("static", "N*m", 8.5, true),
            ("stribeck_velocity", "rad/s", 0.06, true),
        ]
    );
    assert!(
        checked("dynamic").all(|(.., within)| within),
        "{:?}",
        file.checks
    );
    assert!(file.not_run.is_empty(), "{:?}", file.not_run);
    for check in file.checks.iter().filter(|c| c.experiment != "six") {
        assert!(check.within, "{check:?}");
    }
    assert!(file.runs.iter().any(|r| r.experiment == "corner at speed"));
    let said = file.assumptions.join("\n");
    assert!(said.contains("differs between the directions"), "{said}");
    assert!(
        said.contains("Of the axis file search, terms.gravity are not used"),
        "{said}"
    );
    let html = stiction_pages::bundle::reproduction(&outcome);
    let (_, html) = html
        .files()
        .iter()
        .find(|(n, _)| *n == "report.html")
        .unwrap();
    let html = String::from_utf8(html.clone()).unwrap();
    for words in [
        "wrist of 0.045",
        "Not checked, since this axis has none: σ₂",
        "N·m",
    ] {
        assert!(html.contains(words), "{words}");
    }
}

#[test]
fn a_stop_keeps_what_is_done() {
    let outcome = zhang_2025(
        SMALL,
        &mut |progress: &Progress| match counted(progress).0 {
            ..7 => Control::Continue,
            _ => Control::Stop,
        },
    );
    let file = &outcome.file;
    assert_eq!(file.status, "interrupted");
    let experiments: Vec<&str> = file.checks.iter().map(|c| c.experiment.as_str()).collect();
    assert_eq!(experiments[..4], ["static"; 4]);
    assert_eq!(experiments[4..], ["outliers"; 4]);
    assert!(file.claims.is_empty());
    assert_eq!(
        stiction_pages::bundle::reproduction(&outcome).files().len(),
        2
    );
    let text = stiction_pages::text::reproduction(file);
    assert!(text.contains("STOPPED EARLY"), "{text}");
}
