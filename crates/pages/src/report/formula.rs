//! The identified law as a formula, with its numbers.

use super::dependences;
use super::sign::sign;
use stiction_report::math::{Math, abs, dot, frac, id, num, op, paren, quantity, row, sub, sup};
use stiction_report::{Block, number};
use stiction_workflows::identify::Outcome;

/// The formula of the law, then the same with the identified numbers.
pub(super) fn with_numbers(outcome: &Outcome) -> Block {
    let law = outcome.result.law.as_str();
    let asymmetric = outcome.result.asymmetric;
    let mut force = vec![id("F"), op("=")];
    if dependences::level_changes(outcome) {
        force.push(id("L"));
    }
    let mut lines = Vec::new();
    match law {
        "gms" | "maxwell-slip" => {
            let (sum, motion) = elements(law == "gms");
            force.extend(sum);
            lines.extend(motion);
        }
        "lugre" | "dahl" | "elasto-plastic" => {
            force.extend([sub(id("σ"), num("0")), id("z")]);
            if law != "dahl" {
                force.extend([op("+"), sub(id("σ"), num("1")), dot(id("z"))]);
            }
            lines.push(deflection(law == "elasto-plastic"));
        }
        _ => force.extend([id("g"), paren(id("v")), id("sgn"), id("v")]),
    }
    if law == "elasto-plastic" {
        lines.push(breakaway(outcome));
    }
    force.extend([op("+"), sub(id("σ"), num("2")), id("v")]);
    if outcome.law().terms.quadratic_viscous {
        force.extend([op("+"), sub(id("σ"), num("22")), abs(id("v")), id("v")]);
    }
    lines.insert(0, row(force));
    lines.insert(0, balance(outcome));
    let sides: &[&str] = if asymmetric { &["_pos", "_neg"] } else { &[""] };
    for side in sides {
        lines.push(level(outcome, side));
    }
    let sigma = |name: &str, digit: &str, side: &str| {
        let wanted = format!("{name}{side}");
        let p = outcome
            .result
            .parameters
            .iter()
            .find(|p| p.name == wanted)?;
        let symbol = sub(id("σ"), num(digit));
        let symbol = match sign(side) {
            "" => symbol,
            sign => sup(symbol, op(sign)),
        };
        let value = quantity(number::sig(p.value, 4), p.unit.clone());
        Some(row([symbol, op("="), value]))
    };
    lines.extend(sigma("sigma0", "0", ""));
    lines.extend(sigma("sigma1", "1", ""));
    for side in sides {
        lines.extend(sigma("sigma2", "2", side));
        lines.extend(dependences::lines(outcome, side));
    }
    for (name, symbol) in BESIDE {
        if let Some(p) = outcome.result.parameters.iter().find(|p| p.name == name) {
            let value = quantity(number::sig(p.value, 4), p.unit.clone());
            lines.push(row([symbol_of(symbol), op("="), value]));
        }
    }
    let caption = match law {
        "lugre" => "LuGre (Canudas de Wit, Olsson, Åström, Lischinsky 1995), g in units of force.",
        "elasto-plastic" => {
            "Elasto-plastic (Dupont, Hayward, Armstrong, Altpeter 2002): α is 0 where z and v point \
             opposite ways and up to the break-away deflection, rises as half a sine, and is 1 from \
             the steady deflection g/σ₀ on."
        }
        "dahl" => "Dahl: LuGre without Stribeck curve and micro-damping.",
        "stribeck" => "Static Stribeck curve.",
        "gms" => {
            "Generalised Maxwell slip (Al-Bender, Lampaert, Swevers 2005): an element sticks until it \
             reaches the limit, then slips until the velocity changes its sign. The k and d of each \
             element are in the table."
        }
        "maxwell-slip" => {
            "Maxwell slip: an element sticks until it reaches its limit, then slips until the velocity \
             changes its sign. The k and d of each element are in the table."
        }
        _ => "Coulomb and viscous friction.",
    };
    let caption = format!("{caption} {}", meaning(outcome));
    Block::Formula(lines, caption.into())
}

/// What the symbols are that the law does not explain itself.
fn meaning(outcome: &Outcome) -> String {
    let has = |name: &str| outcome.result.parameters.iter().any(|p| p.name == name);
    let mut known = vec!["u is the force of the drive", "F friction", "v velocity"];
    if has("mass") {
        known.push("M the moving mass or inertia");
    }
    if has("offset") {
        known.push("F₀ a constant force");
    }
    if has("delay") {
        known.push("τ the time by which the logged force is later than its motion");
    }
    if has("coulomb_log2") {
        known.push("L a factor on the level, 1 in the first log");
    }
    format!("{}.", known.join(", "))
}

/// Parameters beside the law, with their symbols.
const BESIDE: [(&str, &str); 3] = [("mass", "M"), ("offset", "F0"), ("delay", "τ")];

fn symbol_of(text: &str) -> Math {
    match text.strip_suffix('0') {
        Some(letter) => sub(id(letter), num("0")),
        None => id(text),
    }
}

/// What the drive gives: friction, and everything that was fitted beside it.
fn balance(outcome: &Outcome) -> Math {
    let has = |start: &str| {
        let mut parameters = outcome.result.parameters.iter();
        parameters.any(|p| p.name.starts_with(start))
    };
    let mut out = vec![id("u")];
    if has("delay") {
        out.push(paren(row([id("t"), op("+"), id("τ")])));
    }
    out.extend([op("="), id("F")]);
    if has("mass") {
        out.extend([op("+"), id("M"), dot(id("v"))]);
    }
    if has("offset") {
        out.extend([op("+"), symbol_of("F0")]);
    }
    for force in ["gravity", "cogging"] {
        if has(force) {
            out.extend([op("+"), id(force)]);
        }
    }
    row(out)
}

/// How the bristle deflects; the elasto-plastic one only in part.
fn deflection(in_part: bool) -> Math {
    let mut rate = vec![dot(id("z")), op("="), id("v"), op("−")];
    if in_part {
        rate.extend([id("α"), paren(row([id("z"), op(","), id("v")]))]);
    }
    rate.extend([
        frac(
            row([sub(id("σ"), num("0")), abs(id("v"))]),
            row([id("g"), paren(id("v"))]),
        ),
        id("z"),
    ]);
    row(rate)
}

/// The break-away deflection of the elasto-plastic law with its number.
fn breakaway(outcome: &Outcome) -> Math {
    let share = outcome.law().value("breakaway_ratio").unwrap_or(0.0);
    row([
        sub(id("z"), row([id("b"), id("a")])),
        op("="),
        num(number::sig(share, 3)),
        frac(row([id("g"), paren(id("v"))]), sub(id("σ"), num("0"))),
    ])
}

/// Sum of the elements; how one sticks, and how it slips.
fn elements(curve: bool) -> (Vec<Math>, [Math; 2]) {
    let of = |name: &str| sub(id(name), id("i"));
    let deflection = || sub(id("z"), id("i"));
    let sum = vec![op("∑"), of("k"), deflection()];
    let stick = row([id("stick:"), dot(deflection()), op("="), id("v")]);
    let limit = || {
        let mut limit = vec![of("d")];
        if curve {
            let over = frac(
                row([id("g"), paren(id("v"))]),
                row([id("g"), paren(num("0"))]),
            );
            limit.push(over);
        }
        limit
    };
    let mut slip = vec![id("slip:")];
    if curve {
        let part = frac(
            deflection(),
            row(limit().into_iter().chain([id("sgn"), id("v")])),
        );
        slip.extend([dot(deflection()), op("="), id("a"), of("d")]);
        slip.extend([paren(row([num("1"), op("−"), part])), id("sgn"), id("v")]);
    } else {
        slip.extend([deflection(), op("=")]);
        slip.extend(limit());
        slip.extend([id("sgn"), id("v")]);
    }
    (sum, [stick, row(slip)])
}

/// `g(v)` of one direction with its numbers.
fn level(outcome: &Outcome, side: &str) -> Math {
    let value = |name: &str| {
        outcome
            .result
            .parameters
            .iter()
            .find(|p| p.name == format!("{name}{side}"))
    };
    let g = match sign(side) {
        "" => id("g"),
        sign => sup(id("g"), op(sign)),
    };
    let mut parts = vec![g, paren(id("v")), op("=")];
    if let Some(coulomb) = value("coulomb") {
        match (value("static"), value("stribeck_velocity")) {
            (Some(fixed), Some(velocity)) => {
                parts.push(num(number::sig(coulomb.value, 4)));
                parts.push(op("+"));
                parts.push(num(number::sig(fixed.value - coulomb.value, 4)));
                let ratio = frac(abs(id("v")), num(number::sig(velocity.value, 4)));
                let exponent = outcome
                    .result
                    .parameters
                    .iter()
                    .find(|p| p.name == "stribeck_exponent")
                    .map_or(2.0, |p| p.value);
                let power = sup(
                    paren(ratio),
                    num(number::sig(exponent, 3).trim_end_matches(".00")),
                );
                parts.push(id("exp"));
                parts.push(paren(row([op("−"), power])));
                parts.push(Math::Unit(coulomb.unit.clone()));
            }
            _ => parts.push(quantity(
                number::sig(coulomb.value, 4),
                coulomb.unit.clone(),
            )),
        }
    }
    row(parts)
}
