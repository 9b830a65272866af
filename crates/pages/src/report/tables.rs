//! The tables of the report.

use crate::deviation::Deviation;
use crate::inputs;
use crate::names::{is_of_the_counts, law_beside, parameters_shown};
use stiction_files::result::{Input, LawEntry, Origin, SimulationEntry};
use stiction_files::symbols;
use stiction_number::Percent;
use stiction_report::{Align, Block, Severity, Table, Text, number};
use stiction_workflows::identify::Outcome;

/// Parameters with value, unit, deviation, interval and flag.
pub(super) fn parameters(outcome: &Outcome) -> Table {
    let caption = match is_of_the_counts(&outcome.result) {
        true => "Identified parameters, from the counts of the encoder.",
        false => {
            "Effective constants along the motion of this log. The interval is that of the same test on another day; beside it what \
             another motion of the same kind may give."
        }
    };
    let mut table = Table::new([
        ("Parameter", Align::Left),
        ("", Align::Left),
        ("Value", Align::Right),
        ("Unit", Align::Left),
        ("Another day", Align::Right),
        ("95 % interval", Align::Right),
        ("Another motion", Align::Right),
        ("", Align::Left),
    ])
    .caption(caption);
    for p in parameters_shown(&outcome.result) {
        let deviation = Deviation::of(p, &outcome.result);
        let value = match p.std {
            _ if deviation == Deviation::Unbounded => "–".into(),
            Some(std) if p.identifiable && std > 0.0 => digits(p.value, std),
            _ => number::sig(p.value, 4),
        };
        let interval = match (p.range(), p.origin) {
            (Some((f64::NEG_INFINITY, high)), _) => format!("at most {}", number::sig(high, 3)),
            (Some((low, f64::INFINITY)), _) => format!("at least {}", number::sig(low, 3)),
            _ if deviation == Deviation::Unbounded => "not bounded".into(),
            (Some((low, high)), _) => number::interval(low, high),
            (None, Origin::Given) => String::new(),
            _ => "not bounded".into(),
        };
        let transfer = match deviation {
            Deviation::Given | Deviation::Unbounded => String::new(),
            _ => Deviation::of_transfer(p, &outcome.result).cell(&number::unit(&p.unit)),
        };
        let flag = if p.identifiable {
            String::new()
        } else {
            format!("not identifiable: {}", p.reason)
        };
        let cells = [
            Text::from(symbols::meaning(&p.name, outcome.motion)),
            Text::from(p.symbol.as_str()),
            Text::from(value),
            Text::from(number::unit(&p.unit)),
            Text::from(deviation.cell(&number::unit(&p.unit))),
            Text::from(interval),
            Text::from(transfer),
            Text::from(flag),
        ];
        table = if p.identifiable {
            table.row(cells)
        } else {
            table.marked(Severity::Warning, cells)
        };
    }
    table
}

/// A value with as many digits as its deviation allows, and two more for further computation.
fn digits(value: f64, std: f64) -> String {
    let decades = libm::log10(value.abs() / std);
    // A negligible deviation gives infinity here; a deviation of zero does not occur.
    number::sig(value, (decades.ceil().clamp(0.0, 9.0) as usize) + 2)
}

/// Identified against true values of a simulated axis.
pub(super) fn truth(outcome: &Outcome) -> Table {
    let mut table = Table::new([
        ("Parameter", Align::Left),
        ("True", Align::Right),
        ("Identified", Align::Right),
        ("Error", Align::Right),
        ("In the 95 % interval", Align::Center),
    ])
    .caption("The axis is simulated, so the truth is known.");
    for (name, truth) in &outcome.truth {
        let Some(p) = outcome.result.parameters.iter().find(|p| p.name == *name) else {
            continue;
        };
        let inside = p
            .range()
            .is_some_and(|(low, high)| low <= *truth && *truth <= high);
        let error = if *truth == 0.0 {
            number::sig(p.value, 2)
        } else {
            Percent::error(100.0 * (p.value / truth - 1.0)).digits(2)
        };
        let cells = [
            symbols::meaning(name, outcome.motion),
            number::sig(*truth, 5),
            number::sig(p.value, 5),
            error,
            if inside { "yes" } else { "no" }.to_string(),
        ];
        table = if inside {
            table.row(cells)
        } else {
            table.marked(Severity::Warning, cells)
        };
    }
    table
}

/// Fits on data that were not fitted.
pub(super) fn validation(outcome: &Outcome) -> Table {
    if let Some(entry) = &outcome.result.simulation {
        return simulated(outcome, entry);
    }
    let unit = number::unit(&outcome.result.fit.unit);
    let mut table = Table::new([
        ("Data".to_string(), Align::Left),
        ("Samples".into(), Align::Right),
        (format!("Residual rms, {unit}"), Align::Right),
        ("Relative error".into(), Align::Right),
        ("Near zero speed".into(), Align::Right),
    ])
    .caption("The identified law on data it was not fitted to; nothing is fitted again.");
    for v in &outcome.result.validation {
        table = table.row([
            v.path.clone(),
            number::count(v.fit.samples as u64),
            number::sig(v.fit.rmse, 3),
            Percent::error(v.fit.relative_error_percent).digits(3),
            v.low_speed
                .as_ref()
                .map_or("–".into(), |l| number::sig(l.fit.rmse, 3)),
        ]);
    }
    table
}

/// Positions that were not fitted, simulated.
fn simulated(outcome: &Outcome, entry: &SimulationEntry) -> Table {
    let unit = number::unit(&outcome.result.fit.unit);
    let horizon = entry.short_horizon.as_ref();
    let mut columns = vec![
        ("Data".to_string(), Align::Left),
        ("Samples".into(), Align::Right),
        ("Stretches".into(), Align::Right),
        (format!("Residual rms, {unit}"), Align::Right),
        ("Relative error".into(), Align::Right),
    ];
    columns.extend(horizon.map(|h| {
        let title = format!("Over {} s at a time", number::sig(h.seconds, 3));
        (title, Align::Right)
    }));
    let mut table = Table::new(columns).caption(
        "The identified law on data it was not fitted to: each stretch without gaps simulated whole from one start, and \
         nothing but that start fitted. Relative error: against the motion, the position about its mean.",
    );
    for (i, v) in outcome.result.validation.iter().enumerate() {
        let runs = entry.validation_runs.get(i);
        let mut row = vec![
            v.path.clone(),
            number::count(v.fit.samples as u64),
            runs.map_or("–".into(), |n| number::count(*n as u64)),
            number::sig(v.fit.rmse, 3),
            Percent::error(v.fit.relative_error_percent).digits(3),
        ];
        row.extend(horizon.map(|h| match h.validation.get(i) {
            Some(Some(fit)) => Percent::error(fit.relative_error_percent).digits(3),
            _ => "–".into(),
        }));
        table = table.row(row);
    }
    table
}

/// Laws side by side.
pub(super) fn laws(outcome: &Outcome) -> Table {
    let mut table = Table::new([
        ("Law", Align::Left),
        ("Parameters", Align::Right),
        ("Fitted", Align::Right),
        ("Held out", Align::Right),
        ("Held out, near zero speed", Align::Right),
        ("Above the least", Align::Right),
        ("ΔAIC", Align::Right),
        ("ΔBIC", Align::Right),
    ])
    .caption(
        "Relative error where the law was fitted and on held-out samples (validation data where \
         given, else four blocks left out in turn). Above the least: by how much the held-out error \
         is above the least of all laws, with the standard error of that difference. \
         ΔAIC and ΔBIC: information criteria of the fit on effective samples, above the least. \
         Marked: the simplest law whose held-out error is within its noise, or 1 %, of the least.",
    );
    let above = |l: &LawEntry| match (l.held_out_excess_percent, l.held_out_excess_std_percent) {
        (Some(0.0), _) => "least".into(),
        (Some(mean), Some(std)) if Percent::error(mean.max(std)).is_bounded() => {
            format!("{} ± {} %", number::sig(mean, 2), number::sig(std, 2))
        }
        (Some(mean), Some(std)) => Percent::error(mean.max(std)).digits(2),
        _ => "–".into(),
    };
    let criterion = |x: Option<f64>| x.map_or("–".into(), |x| number::sig(x, 3));
    let percent = |x: Option<f64>| x.map_or("–".into(), |x| Percent::error(x).digits(3));
    for l in &outcome.result.laws {
        let cells = [
            law_beside(l),
            l.parameters.to_string(),
            percent(Some(l.fitted_error_percent)),
            percent(l.held_out_error_percent),
            percent(l.held_out_low_speed_error_percent),
            above(l),
            criterion(l.aic_difference),
            criterion(l.bic_difference),
        ];
        table = if l.best {
            table.marked(Severity::Good, cells)
        } else {
            table.row(cells)
        };
    }
    table
}

/// What a file was and how it was understood.
pub(super) fn input(input: &Input) -> Block {
    let mut facts = vec![
        (
            Text::from("File"),
            Text::new()
                .code(input.path.as_str())
                .plain(inputs::part(input)),
        ),
        (
            Text::from("SHA-256"),
            Text::new().code(input.sha256.as_str()),
        ),
        (
            Text::from("Samples"),
            Text::from(format!(
                "{} at {} Hz",
                number::count(input.samples as u64),
                number::sig(input.rate_hz, 5)
            )),
        ),
    ];
    for detected in &input.detected {
        facts.push((Text::from("Detected"), Text::from(detected.as_str())));
    }
    Block::Facts(facts)
}
