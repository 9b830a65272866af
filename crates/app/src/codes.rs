//! Every code that a user can see, with its meaning in a line; each has a page in `docs/codes/`.

use stiction_log::{CODES as LOG, Kind};

/// Codes of warnings and errors that arise after a log was read.
pub const OWN: &[(&str, &str)] = &[
    ("not-identifiable", "the data do not determine a parameter"),
    ("not-converged", "the search ended without converging"),
    (
        "interrupted",
        "the search was stopped; the best found so far is given",
    ),
    ("poor-fit", "the law explains too little of the force"),
    (
        "richer-law-holds-better",
        "a law with more parameters predicts unseen samples much better",
    ),
    (
        "correlated-residual",
        "the residual is not noise: something systematic is left",
    ),
    (
        "delay-out-of-range",
        "the fitted delay between force and motion is too long to be one",
    ),
    (
        "static-law-at-rest",
        "a static law is fitted to an axis at rest or in presliding",
    ),
    (
        "simpler-law-holds-better",
        "a law with fewer parameters predicts unseen samples better",
    ),
    (
        "too-few-samples",
        "too few usable samples are left after conditioning",
    ),
    (
        "bad-setting",
        "a setting of the conditioning is out of range for this log",
    ),
    (
        "too-few-speeds",
        "too few constant-velocity stretches for a static map",
    ),
    (
        "still-learning",
        "a watchdog lets no force through while a run counts",
    ),
    ("at-force-limit", "a simulated command is at its limit"),
    ("unsteady-command", "a simulated command shakes"),
    ("few-speeds", "fewer speeds than a static map should have"),
    (
        "large-shift",
        "encoder, filters and noise shift a parameter far",
    ),
    (
        "unsteady-stretches",
        "stretches of nearly constant velocity were left out",
    ),
    (
        "outlying-points",
        "points of the static map lie far off its curve",
    ),
    (
        "no-step",
        "the force does not step as the procedure needs it",
    ),
    (
        "no-overshoot",
        "a step response without overshoot cannot be inverted",
    ),
    (
        "statics-assumed",
        "the steady curve is not known and was simplified",
    ),
    ("no-break-away", "the force does not ramp up to break-away"),
    (
        "not-simulated",
        "a log that cannot be simulated: position, reference or mass is missing",
    ),
    ("bad-record", "the channels of a log do not fit together"),
    ("bad-config", "an axis, study or model file was refused"),
    (
        "bad-checkpoint",
        "a checkpoint is damaged or belongs to another search",
    ),
    ("usage", "the command as typed cannot be carried out"),
    ("output", "the output folder or file cannot be used"),
    (
        "model-in-doubt",
        "the model of a study is not one to rely on",
    ),
    (
        "not-in-study",
        "the model has terms that a study does not simulate",
    ),
    ("not-run", "a combination of a study could not be run"),
    ("not-exported", "a model that the target cannot express"),
    (
        "export-untrusted",
        "a compensator with numbers that the identification did not stand by",
    ),
    (
        "export-damping",
        "micro-damping is limited so that the compensator releases no energy",
    ),
    (
        "export-cycle-time",
        "the cycle time is too long to resolve a reversal",
    ),
    (
        "export-limit",
        "the force limit is below the friction to compensate, or reached at speed",
    ),
    (
        "export-name",
        "a name in the code is not all of the axis' name",
    ),
    (
        "export-rated-force",
        "the friction table goes beyond the rated force",
    ),
    (
        "export-terms",
        "terms beside friction are not in the compensator",
    ),
    ("export-source", "FMUs were written without a binary"),
];

/// Every code with its meaning: findings in logs, refusals of logs, and our own.
pub fn all() -> Vec<(&'static str, &'static str)> {
    const KINDS: [(Kind, &str); 8] = [
        (Kind::Io, "a recording cannot be opened or read"),
        (Kind::Format, "a file does not follow the format it claims"),
        (Kind::Limit, "a file asks for more than is allowed"),
        (
            Kind::Ambiguous,
            "a recording can be read in more than one way",
        ),
        (
            Kind::Missing,
            "something that is needed is not in the recording",
        ),
        (Kind::Unit, "a unit is unknown or does not fit"),
        (Kind::Time, "time stamps that no rule can mend"),
        (Kind::Value, "a number outside what is allowed"),
    ];
    let kinds = KINDS.iter().map(|(kind, meaning)| (kind.code(), *meaning));
    LOG.iter()
        .copied()
        .chain(kinds)
        .chain(OWN.iter().copied())
        .collect()
}
