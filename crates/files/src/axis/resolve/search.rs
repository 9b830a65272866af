//! `[search]`: a table for each method, and the box.

use super::simulation::gain;
use crate::axis::gain::Gain;
use crate::axis::search::{BOX_KEYS, SearchValues};
use crate::config::{ANY_COUNT, Given, Table};
use crate::error::Error;
use stiction_number::full;
use stiction_search::genetic::{self, Annealing, Crossover, Rates, Ratio, Selection};
use stiction_search::{Error as Refused, Method};

/// Larger than any count that a search allows: what it allows, it says itself.
const LARGE_COUNT: u64 = 1 << 32;

/// The methods with settings, and the box.
pub(super) fn search(root: &Table<'_>) -> Result<SearchValues, Error> {
    let mut out = SearchValues::default();
    let Some(table) = root.table("search")? else {
        return Ok(out);
    };
    for name in Method::NAMES {
        if let Some(own) = table.table(name)? {
            let usual = Method::named(name).expect("a method of the searches");
            let method = settings(usual, &own)?;
            own.end()?;
            method.check().map_err(|error| misfit(&own, &error))?;
            out.methods.push(method);
        }
    }
    if let Some(own) = table.table("box")? {
        for (key, ends) in BOX_KEYS.into_iter().zip(&mut out.bounds) {
            *ends = own.get(key).map(|given| range(&given)).transpose()?;
        }
        own.end()?;
    }
    table.end()?;
    Ok(out)
}

/// A method with what its table changes.
fn settings(mut method: Method, table: &Table<'_>) -> Result<Method, Error> {
    let count = |key, out: &mut usize| -> Result<(), Error> {
        if let Some(n) = table.count(key, 0, ANY_COUNT)? {
            *out = n.min(LARGE_COUNT) as usize;
        }
        Ok(())
    };
    let number = |key, out: &mut f64| -> Result<(), Error> {
        if let Some(x) = table.number(key, -f64::MAX, f64::MAX)? {
            *out = x;
        }
        Ok(())
    };
    match &mut method {
        Method::Ga(s) | Method::AdaptiveGa(s) | Method::AnnealingGa(s) => {
            count("population", &mut s.population)?;
            count("generations", &mut s.generations)?;
            count("rounds", &mut s.rounds)?;
            count("elite", &mut s.elite)?;
            genetic(s, table)?;
        }
        Method::NichedGa(s) => {
            count("draw", &mut s.draw)?;
            count("population", &mut s.population)?;
            count("generations", &mut s.generations)?;
            count("rounds", &mut s.rounds)?;
            number("temperature", &mut s.annealing.start)?;
            number("cooling", &mut s.annealing.factor)?;
            count("niches", &mut s.niches)?;
            number("apart", &mut s.apart)?;
            count("steps", &mut s.steps)?;
        }
        Method::De(s) => {
            count("per_dimension", &mut s.per_dimension)?;
            count("generations", &mut s.generations)?;
            if let Some(given) = table.get("scale") {
                let Rates { low, high } = rates(&given)?;
                s.scale = [low, high];
            }
            number("crossover", &mut s.crossover)?;
            number("spread", &mut s.spread)?;
        }
        Method::CmaEs(s) => {
            if let Some(n) = table.count("population", 0, ANY_COUNT)? {
                s.population = Some(n.min(LARGE_COUNT) as usize);
            }
            number("deviation", &mut s.deviation)?;
            count("restarts", &mut s.restarts)?;
            number("spread", &mut s.spread)?;
        }
        Method::Pso(s) => {
            count("particles", &mut s.particles)?;
            count("generations", &mut s.generations)?;
            number("spread", &mut s.spread)?;
        }
        Method::Annealing(s) => {
            count("chains", &mut s.chains)?;
            number("temperature", &mut s.start)?;
            number("cooling", &mut s.factor)?;
            count("sample", &mut s.sample)?;
            count("temperatures", &mut s.temperatures)?;
            count("adjustments", &mut s.adjustments)?;
            count("cycles", &mut s.cycles)?;
        }
        Method::NelderMead(s) => {
            count("simplices", &mut s.simplices)?;
            number("edge", &mut s.edge)?;
            number("width", &mut s.width)?;
            number("spread", &mut s.spread)?;
        }
        Method::Lm(s) => {
            count("scan", &mut s.scan)?;
            count("starts", &mut s.starts)?;
            count("steps", &mut s.steps)?;
        }
    }
    Ok(method)
}

/// What only the genetic algorithms have.
fn genetic(s: &mut genetic::Settings, table: &Table<'_>) -> Result<(), Error> {
    match table.choice("selection", &["rank", "roulette"])? {
        Some("roulette") => s.selection = Selection::Roulette,
        Some(_) => s.selection = Selection::Rank { pressure: 1.5 },
        None => {}
    }
    if let Some(given) = table.get("selection_pressure") {
        match &mut s.selection {
            Selection::Rank { pressure } => *pressure = given.number(-f64::MAX, f64::MAX)?,
            Selection::Roulette => {
                return Err(given.refused("nothing beside selection = \"roulette\""));
            }
        }
    }
    match table.choice("crossover", &["blend", "heuristic"])? {
        Some("heuristic") => s.crossover = Crossover::Heuristic,
        Some(_) => s.crossover = Crossover::Blend,
        None => {}
    }
    if let Some(given) = table.get("crossover_ratio") {
        s.ratio = match given.or_word(&["uniform"]) {
            (_, Some(_)) => Ratio::Uniform,
            (given, None) => Ratio::Constant(given.number(0.0, 1.0)?),
        };
    }
    for (key, out) in [
        ("crossover_rate", &mut s.crossover_rate),
        ("mutation_rate", &mut s.mutation_rate),
    ] {
        if let Some(given) = table.get(key) {
            *out = rates(&given)?;
        }
    }
    let none = |key| -> Result<Option<Option<f64>>, Error> {
        let Some(given) = table.get(key) else {
            return Ok(None);
        };
        match given.or_word(&["none"]) {
            (_, Some(_)) => Ok(Some(None)),
            (given, None) => given.number(-f64::MAX, f64::MAX).map(|x| Some(Some(x))),
        }
    };
    let usual = genetic::Settings::default().annealing;
    match none("temperature")? {
        Some(None) => s.annealing = None,
        Some(Some(start)) => {
            let factor = s.annealing.or(usual).map_or(1.0, |a| a.factor);
            s.annealing = Some(Annealing { start, factor });
        }
        None => {}
    }
    if let Some(given) = table.get("cooling") {
        match &mut s.annealing {
            Some(annealing) => annealing.factor = given.number(-f64::MAX, f64::MAX)?,
            None => return Err(given.refused("nothing where there is no temperature")),
        }
    }
    if let Some(factor) = none("shrink")? {
        s.precision = factor;
    }
    if let Some(threshold) = none("adaptive_evolution")? {
        s.adaptive_evolution = threshold;
    }
    Ok(())
}

/// One number, or a lower and an upper one.
fn rates(given: &Given<'_>) -> Result<Rates, Error> {
    if let Some(rate) = given.as_number() {
        return Ok(Rates::fixed(rate));
    }
    let numbers = given.as_list().unwrap_or_default();
    let numbers: Vec<f64> = numbers.iter().filter_map(Given::as_number).collect();
    match numbers[..] {
        [low, high] => Ok(Rates { low, high }),
        _ => Err(given.refused("a number, or a lower and an upper one such as [0.6, 0.9]")),
    }
}

/// Two values with units, the lower one first.
fn range(given: &Given<'_>) -> Result<[Gain; 2], Error> {
    let allowed = "a lower and an upper end with units, such as [\"1e4 N/m\", \"1e8 N/m\"]";
    let ends = given.as_list().unwrap_or_default();
    let [low, high] = &ends[..] else {
        return Err(given.refused(allowed));
    };
    let ends = [gain(low)?, gain(high)?];
    let (low, high) = (ends[0].value.si(), ends[1].value.si());
    if ends[0].value.unit.dimension() != ends[1].value.unit.dimension() || low >= high {
        let found = format!("{} to {}", ends[0].value, ends[1].value);
        return Err(given.refuse(found, allowed));
    }
    Ok(ends)
}

/// What a method refuses, at the key of its table.
fn misfit(table: &Table<'_>, error: &Refused) -> Error {
    let Refused::Setting {
        name,
        found,
        allowed,
        ..
    } = error
    else {
        return table.refuse("", error.to_string(), "other settings");
    };
    let key = match *name {
        "start" => "temperature",
        "factor" => "cooling",
        "precision" => "shrink",
        "pressure" => "selection_pressure",
        "ratio" => "crossover_ratio",
        same => same,
    };
    match table.find(key) {
        Some(given) if given.as_number().is_some() => given.refused(allowed),
        _ => table.refuse(key, full(*found), allowed),
    }
}
