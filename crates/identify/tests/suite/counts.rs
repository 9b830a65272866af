//! Evaluations that the reference identifications cost, as a snapshot: a costlier algorithm shows in
//! review.

use crate::common::trials;
use crate::common::{C95, MACHINE, MOTOR, record, sine_record};
use std::fmt::Write;
use stiction_identify::{
    Conditioning, Cutoff, Law, LawKind, Mass, Record, Settings, Silent, Terms, estimate, intervals,
    separable,
};

fn line(what: &str, record: &Record, law: Law, terms: &Terms) -> String {
    let found = separable(record, law, terms, &Settings::default(), &mut Silent).unwrap();
    let mut e = estimate(record, law, terms, &found, 0.0);
    let search = e.counts;
    intervals(record, &found, &mut e, &mut Silent);
    format!(
        "{what}: search {} cost, {} with sensitivities, {} of them on a thinned record; intervals {} \
         cost, {} with sensitivities",
        search.without_derivatives(),
        search.with_derivatives(),
        search.coarse(),
        e.counts.without_derivatives() - search.without_derivatives(),
        e.counts.with_derivatives() - search.with_derivatives()
    )
}

#[test]
fn evaluations() {
    let friction = Terms {
        mass: Mass::Absent,
        offset: false,
        ..Terms::default()
    };
    let mut out = String::new();
    for set in [C95, MACHINE, MOTOR] {
        let (v, u) = sine_record(&set);
        let record = record(1e-4, v, u);
        let lugre = Law::new(LawKind::LuGre);
        for (what, law) in [
            ("lugre", lugre),
            ("lugre, exponent fitted", lugre.with_fitted_exponent()),
            ("lugre, asymmetric", lugre.asymmetric()),
            ("stribeck", Law::new(LawKind::Stribeck)),
        ] {
            let what = format!("{}, {what}", set.name);
            let _ = writeln!(out, "{}", line(&what, &record, law, &friction));
        }
    }
    let filters = Conditioning {
        source_cutoff: Cutoff::Hz(400.0),
        common_cutoff: Cutoff::Hz(200.0),
        ..Conditioning::default()
    };
    let log = trials::quantised(1e-6, 0.05, &filters, 1);
    let law = Law::new(LawKind::LuGre);
    let _ = writeln!(
        out,
        "{}",
        line("closed loop, 1 um", &log.record, law, &log.terms)
    );
    insta::assert_snapshot!(out);
}
