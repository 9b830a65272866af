//! What must hold on measured recordings.

use crate::measure;
use stiction_testkit::{CASES, recordings};

#[test]
fn every_limit_holds() {
    let Some(data) = recordings() else {
        return;
    };
    let mut broken = Vec::new();
    for case in CASES {
        let outcome = measure::run(case, &data);
        for limit in case.limits {
            let found = measure::measure(case, limit, &outcome, &data);
            let line = format!(
                "{} {}: {} = {:.5} (at most {})",
                case.name, case.law, found.what, found.value, found.most
            );
            println!("{line}");
            if !found.holds() {
                broken.push(line);
            }
        }
    }
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}

#[test]
fn damiao_reports_its_gaps() {
    let Some(data) = recordings() else {
        return;
    };
    let axis =
        stiction::Axis::read(stiction_testkit::workspace().join("validation/damiao.toml")).unwrap();
    let source = stiction::commands::load(data.join("damiao/motor_2.npz"), &axis).unwrap();
    let longest = source
        .log
        .gaps
        .iter()
        .map(|g| g.seconds)
        .fold(0.0, f64::max);
    assert!((4.5..5.5).contains(&longest), "longest gap {longest} s");
    assert!(source.log.findings.iter().any(|f| f.code.as_str() == "gap"));
}
