//! Lines of the formula for friction that changes with load, temperature or position, or from log to log.

use super::sign::sign;
use stiction_files::result::ParameterEntry;
use stiction_identify::Dependence;
use stiction_report::math::{Math, frac, id, num, op, paren, quantity, row, sub, sup};
use stiction_report::number;
use stiction_workflows::identify::Outcome;

/// Whether the level of friction changes with more than the velocity.
pub(super) fn level_changes(outcome: &Outcome) -> bool {
    let mut terms = outcome.law().terms.dependences.iter();
    let viscous = |d: &Dependence| {
        matches!(
            d,
            Dependence::ViscousTemperature(_) | Dependence::ViscousLog(_)
        )
    };
    terms.any(|d| !viscous(d))
}

/// `L`, by which the level of one direction is multiplied, and what stands beside `sigma2`.
pub(super) fn lines(outcome: &Outcome, side: &str) -> Vec<Math> {
    let mark = |symbol: Math| match sign(side) {
        "" => symbol,
        sign => sup(symbol, op(sign)),
    };
    let mut level = vec![num("1")];
    let mut viscous = Vec::new();
    let find = |name: String| outcome.result.parameters.iter().find(|p| p.name == name);
    let coulomb = find(format!("coulomb{side}")).map_or(1.0, |p| p.value);
    let mut pitch = 0;
    let mut of_logs = Vec::new();
    for dependence in &outcome.law().terms.dependences {
        let name = dependence.name();
        if let Dependence::CoulombPitch(length) = dependence {
            pitch += 1;
            for wave in ["sin", "cos"] {
                if let Some(p) = find(format!("{name}{pitch}_{wave}{side}")) {
                    let turn = row([num("2π"), id("x")]);
                    let angle = frac(turn, num(number::sig(*length, 4)));
                    level.extend(signed(p.value / coulomb));
                    level.extend([id(wave), paren(angle)]);
                }
            }
            continue;
        }
        if let Dependence::CoulombMap(map) = dependence {
            let place = || paren(row([num("π"), id("s")]));
            for k in 1..=map.terms {
                let Some(p) = find(format!("coulomb_map{k}{side}")) else {
                    continue;
                };
                level.extend(signed(p.value / coulomb));
                match k {
                    1 => level.push(paren(row([num("2"), id("s"), op("−"), num("1")]))),
                    2 => level.extend([id("cos"), place()]),
                    _ => level.extend([id("cos"), num((k - 1).to_string()), place()]),
                }
            }
            if map.terms > 0 {
                let along = paren(row([id("x"), op("−"), num(number::sig(map.start, 4))]));
                let stroke = num(number::sig(map.stroke, 4));
                of_logs.push(row([id("s"), op("="), frac(along, stroke)]));
            }
            continue;
        }
        if let Dependence::CoulombLog(logs) | Dependence::ViscousLog(logs) = dependence {
            let others = 2..=*logs;
            of_logs.extend(others.filter_map(|k| {
                let p = find(format!("{name}{k}"))?;
                let log = |symbol: &str, at: String| sub(id(symbol), num(at));
                Some(match dependence {
                    Dependence::CoulombLog(_) => row([
                        log("L", format!("log {k}")),
                        op("="),
                        num(number::sig(1.0 + p.value / coulomb, 4)),
                    ]),
                    _ => {
                        let first = find(format!("sigma2{side}")).map_or(0.0, |p| p.value);
                        row([
                            mark(log("σ", format!("2, log {k}"))),
                            op("="),
                            quantity(number::sig(first + p.value, 4), p.unit.clone()),
                        ])
                    }
                })
            }));
            continue;
        }
        let Some(p) = find(format!("{name}{side}")) else {
            continue;
        };
        match dependence {
            Dependence::CoulombLoad(about) => {
                level.extend(signed(p.value / coulomb));
                level.push(distance("N", *about));
            }
            Dependence::CoulombTemperature(about) => {
                level.extend(signed(p.value / coulomb));
                level.push(distance("T", *about));
            }
            Dependence::CoulombTransmitted(of) => {
                level.extend(signed(p.value / coulomb));
                level.push(distance("|τ|", of.reference));
            }
            Dependence::CoulombDriven(_) => {
                level.extend(signed(p.value / coulomb));
                level.push(sub(id("|τ|"), id("driven")));
            }
            Dependence::CoulombPosition(about) => {
                level.extend(signed(p.value / coulomb));
                level.push(distance("x", *about));
            }
            Dependence::ViscousTemperature(about) => viscous.push((p, *about)),
            Dependence::CoulombPitch(_)
            | Dependence::CoulombMap(_)
            | Dependence::CoulombLog(_)
            | Dependence::ViscousLog(_) => {}
        }
    }
    let mut out = Vec::new();
    if level.len() > 1 {
        level.splice(0..0, [mark(id("L")), op("=")]);
        out.push(row(level));
    }
    out.extend(of_logs);
    let sigma2 = find(format!("sigma2{side}"));
    for (p, about) in viscous {
        out.push(at_temperature(
            mark(sub(id("σ"), num("2"))),
            sigma2,
            p,
            about,
        ));
    }
    if let Some(p) = find(format!("quadratic_viscous{side}")) {
        let value = quantity(number::sig(p.value, 4), p.unit.clone());
        out.push(row([mark(sub(id("σ"), num("22"))), op("="), value]));
    }
    out
}

/// `sigma2` with its change by temperature.
fn at_temperature(
    symbol: Math,
    sigma2: Option<&ParameterEntry>,
    slope: &ParameterEntry,
    about: f64,
) -> Math {
    let mut parts = vec![symbol, paren(id("T")), op("=")];
    if let Some(p) = sigma2 {
        parts.push(num(number::sig(p.value, 4)));
    }
    parts.extend(signed(slope.value));
    parts.push(distance("T", about));
    if let Some(p) = sigma2 {
        parts.push(Math::Unit(p.unit.clone()));
    }
    row(parts)
}

fn signed(x: f64) -> [Math; 2] {
    let sign = if x < 0.0 { "−" } else { "+" };
    [op(sign), num(number::sig(x.abs(), 4))]
}

/// `(N - N0)` with the number of the reference, SI.
fn distance(symbol: &str, about: f64) -> Math {
    let [sign, size] = signed(-about);
    paren(row([id(symbol), sign, size]))
}
