//! The third step: the record to a law, by the method that is asked for.

use super::choice::{self, Choice};
use super::condition::Conditioned;
use super::ladder::Ladder;
use super::load::{Asked, Loaded};
use super::logs::paths;
use super::method::Method;
use super::procedure::{BreakAways, TwoStep, TwoSteps, break_away, two_step};
use super::searched;
use crate::error::Error;
use stiction_files::result::SearchedEntry;
use stiction_identify as engine;
use stiction_identify::{Law, Observer};

/// A fitted law, and how it was found.
pub(super) struct Fitted {
    /// The law, and those it was compared with.
    pub choice: Choice,
    /// What a search found, where one was asked for.
    pub searched: Option<SearchedEntry>,
    /// Why the state of the search could not be saved.
    pub not_kept: Option<Error>,
    /// Both fits, where static parameters come first.
    pub two_steps: Option<TwoSteps>,
    /// What the law says of the break-away runs.
    pub break_away: BreakAways,
}

/// Fits the record.
pub(super) fn fit(
    asked: Asked,
    loaded: &Loaded,
    conditioned: &Conditioned,
    observer: &mut dyn Observer,
) -> Result<Fitted, Error> {
    let mut fitted = match asked.options.procedures.method {
        Method::StaticThenDynamic => in_two_steps(asked, loaded, conditioned, observer)?,
        Method::Searched(_) => by_search(asked, loaded, conditioned, observer)?,
        _ => at_once(asked, loaded, conditioned, observer)?,
    };
    fitted.break_away = break_away(&loaded.beside, &fitted.choice.estimate)?;
    Ok(fitted)
}

impl Fitted {
    fn new(choice: Choice) -> Self {
        Self {
            choice,
            searched: None,
            not_kept: None,
            two_steps: None,
            break_away: BreakAways::default(),
        }
    }
}

/// The law that is asked for.
fn law(asked: Asked) -> Law {
    let Asked { options, axis, .. } = asked;
    Law {
        asymmetric: options.asymmetric,
        exponent: axis.exponent(),
        exponent_fitted: axis.exponent_fitted,
        elements: axis.gms_elements.unwrap_or(0),
        ..Law::new(options.one_law())
    }
}

/// What laws are fitted and compared on.
fn ladder<'a>(asked: Asked, conditioned: &'a Conditioned) -> Ladder<'a> {
    Ladder {
        record: &conditioned.record,
        held_out: &conditioned.unseen,
        terms: &conditioned.terms,
        bent: (!conditioned.terms.symmetric.quadratic_viscous).then(|| conditioned.terms.bent()),
        held_delay: None,
        low_speed: conditioned.low_speed,
        symmetric: asked.options.symmetric,
        exponent_is_open: asked.axis.leaves_exponent_open(),
    }
}

/// All parameters at once, by separable least squares.
fn at_once(
    asked: Asked,
    loaded: &Loaded,
    conditioned: &Conditioned,
    observer: &mut dyn Observer,
) -> Result<Fitted, Error> {
    let options = asked.options;
    let mut ladder = ladder(asked, conditioned);
    let settings = &conditioned.settings;
    let refused =
        |source: engine::Error| Error::identify(paths(&loaded.sources).join(", "), source);
    let law = law(asked);
    let choice = match options.law {
        Some(_) => {
            let other = ladder.hold_delay(law, settings, observer);
            let fitted: Vec<_> = other.into_iter().collect();
            let compare = options.compare_laws;
            choice::asked(law, &ladder, &fitted, compare, settings, observer)
        }
        None => {
            // What the law is to be judged by must not choose it.
            let ladder = Ladder {
                held_out: &[],
                ..ladder
            };
            choice::auto(law, &ladder, settings, observer)
        }
    };
    Ok(Fitted::new(choice.map_err(refused)?))
}

/// All parameters at once, by one of the searches.
fn by_search(
    asked: Asked,
    loaded: &Loaded,
    conditioned: &Conditioned,
    observer: &mut dyn Observer,
) -> Result<Fitted, Error> {
    let options = asked.options;
    let settings = &conditioned.settings;
    let found = searched::search(
        searched::Task {
            options,
            axis: asked.axis,
            inputs: &loaded.sources,
            record: &conditioned.record,
            law: law(asked),
            terms: conditioned.terms(options.asymmetric),
            low_speed: conditioned.low_speed,
            settings,
            clock: asked.clock,
            keep: conditioned.repeatable,
        },
        observer,
    )?;
    let choice = match options.searching.no_finish {
        // Nothing that least squares have to give: neither intervals nor a comparison of laws.
        true => Choice::alone(found.estimate),
        false => choice::fitted_already(
            (found.estimate, found.optimum),
            &ladder(asked, conditioned),
            options.compare_laws,
            settings,
            observer,
        ),
    };
    Ok(Fitted {
        searched: Some(found.entry),
        not_kept: found.lost,
        ..Fitted::new(choice)
    })
}

/// Static parameters first, then stiffness and micro-damping.
fn in_two_steps(
    asked: Asked,
    loaded: &Loaded,
    conditioned: &Conditioned,
    observer: &mut dyn Observer,
) -> Result<Fitted, Error> {
    let asymmetric = asked.options.asymmetric;
    let (estimate, both) = two_step(
        TwoStep {
            asked,
            sources: &loaded.sources,
            beside: &loaded.beside,
            record: &conditioned.record,
            terms: [
                conditioned.terms(asymmetric),
                conditioned.terms(!asymmetric),
            ],
            low_speed: conditioned.low_speed,
            settings: &conditioned.settings,
        },
        observer,
    )?;
    Ok(Fitted {
        two_steps: Some(both),
        ..Fitted::new(Choice::alone(estimate))
    })
}
