//! The searches of `stiction_search`: over whole records, and over each of two steps.

mod checkpoint;
mod course;
pub(crate) mod ranges;
mod steps;
mod watch;
mod whole;

pub(super) use steps::{curve, dynamic};
pub(super) use whole::{Task, search};

use super::method::Method;
use super::options::{Options, Searching};
use crate::error::Error;
use crate::wording::{Setting, TOGETHER_WITH};
use stiction_identify::LawKind;

/// Refuses a search or its limits beside a method that makes none, and limits that are not positive.
pub(super) fn check(options: &Options) -> Result<(), Error> {
    let method = options.procedures.method;
    let given = &options.searching;
    let in_steps = matches!(method, Method::Static | Method::StaticThenDynamic);
    let names = stiction_search::Method::NAMES;
    if let Some(search) = given.search.filter(|search| !names.contains(search)) {
        return Err(Error::usage(Setting::Search.is(search), names.join(", ")));
    }
    if let Some(search) = given.search.filter(|_| !in_steps) {
        return Err(Error::usage(
            [
                Setting::Search.is(search),
                TOGETHER_WITH.into(),
                Setting::Method.is(method.name()),
            ],
            [
                Setting::Method.is(Method::Static.name()),
                " or ".into(),
                Setting::Method.is(Method::StaticThenDynamic.name()),
                ", whose steps it searches, or over whole records ".into(),
                Setting::Method.is(search),
            ],
        ));
    }
    if !matches!(method, Method::Searched(_)) && given.search.is_none() {
        if *given == Searching::default() {
            return Ok(());
        }
        return Err(Error::usage(
            [
                Setting::NoFinish.into(),
                ", ".into(),
                Setting::Cost.into(),
                ", ".into(),
                Setting::Evaluations.into(),
                ", ".into(),
                Setting::Target.into(),
                ", ".into(),
                Setting::Time.into(),
                ", ".into(),
                Setting::Checkpoint.into(),
                " or ".into(),
                Setting::Resume.into(),
                TOGETHER_WITH.into(),
                Setting::Method.is(method.name()),
            ],
            format!("one of the searches: {}", names.join(", ")),
        ));
    }
    let whole = [
        (Setting::Cost, given.cost.is_some()),
        (Setting::Checkpoint, given.checkpoint.is_some()),
        (Setting::Resume, given.resume.is_some()),
    ];
    if let Some((setting, _)) = whole.iter().find(|(_, is_given)| in_steps && *is_given) {
        return Err(Error::usage(
            [
                (*setting).into(),
                TOGETHER_WITH.into(),
                Setting::Method.is(method.name()),
            ],
            "a search over whole records: the steps have costs of their own, and take seconds",
        ));
    }
    let limits = [(Setting::Target, given.target), (Setting::Time, given.time)];
    for (setting, found) in limits {
        if let Some(found) = found.filter(|x| !(*x > 0.0 && x.is_finite())) {
            return Err(Error::usage(setting.is(found), "a finite number above 0"));
        }
    }
    let law = options.one_law();
    if matches!(method, Method::Searched(_)) && law.needs_no_search() {
        return Err(Error::usage(
            [
                Setting::Law.is(law.name()),
                TOGETHER_WITH.into(),
                Setting::Method.is(method.name()),
                ": this law has no parameter that a search could look for".into(),
            ],
            [
                Setting::Law.is(LawKind::LuGre.name()),
                ", stribeck, dahl or elasto-plastic; or no search: ".into(),
                Setting::Method.is(Method::Separable.name()),
                ", which solves for all parameters of this law at once".into(),
            ],
        ));
    }
    if given.evaluations == Some(0) {
        return Err(Error::usage(Setting::Evaluations.is(0), "at least 1"));
    }
    match &given.checkpoint {
        Some(file) => checkpoint::check_place(file),
        None => Ok(()),
    }
}
