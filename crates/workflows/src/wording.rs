//! Words that name the options of a workflow, each caller's own way: a program knows them as fields, a terminal as
//! `--split`.

use std::borrow::Cow;
use std::fmt;
use stiction_number::full;

/// Between two options that exclude each other.
pub(crate) const TOGETHER_WITH: &str = " together with ";

/// An option of a workflow that a message names: a field of
/// [`identify::Options`](crate::identify::Options) and what it holds, [`identify::Files`](crate::identify::Files) or
/// [`CompareOptions`](crate::compare::CompareOptions).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Setting {
    /// The law; `auto` stands for `None`.
    Law,
    /// Whether each direction has parameters of its own.
    Asymmetric,
    /// The method.
    Method,
    /// Logs to validate on.
    Validate,
    /// The part of the samples that is fitted.
    Split,
    /// Logs of constant velocities.
    Statics,
    /// A model of an earlier identification.
    Model,
    /// Logs of force ramps.
    BreakAway,
    /// The search that finds the parameters of each step.
    Search,
    /// Whether the least squares after a search are left out.
    NoFinish,
    /// What a search evaluates.
    Cost,
    /// Most evaluations.
    Evaluations,
    /// The cost at which a search stops.
    Target,
    /// The time after which a search stops.
    Time,
    /// Where the state of a search is kept.
    Checkpoint,
    /// A state of a search to go on from.
    Resume,
    /// A made problem to compare on.
    Problem,
    /// How often each method runs.
    Seeds,
    /// Noise of a made record.
    Noise,
    /// Motion of a made record.
    Excitation,
    /// Sample rate of a made record.
    Rate,
    /// Whether a made record follows another law than the one that is fitted.
    OtherLaw,
    /// Width of the box in which a comparison searches.
    Decades,
    /// What integrates the candidates.
    Integrator,
    /// A wish for an interval of a plan.
    Want,
    /// Where the axis stands when a plan starts.
    Start,
    /// The model that a plan begins with.
    Known,
    /// Whether the levels of a compensator follow the machine.
    Adapt,
    /// What is fed forward.
    Feedforward,
    /// The URDF of a robot.
    Urdf,
}

impl Setting {
    /// Every option.
    pub const ALL: [Setting; 30] = [
        Setting::Law,
        Setting::Asymmetric,
        Setting::Method,
        Setting::Validate,
        Setting::Split,
        Setting::Statics,
        Setting::Model,
        Setting::BreakAway,
        Setting::Search,
        Setting::NoFinish,
        Setting::Cost,
        Setting::Evaluations,
        Setting::Target,
        Setting::Time,
        Setting::Checkpoint,
        Setting::Resume,
        Setting::Problem,
        Setting::Seeds,
        Setting::Noise,
        Setting::Excitation,
        Setting::Rate,
        Setting::OtherLaw,
        Setting::Decades,
        Setting::Integrator,
        Setting::Want,
        Setting::Start,
        Setting::Known,
        Setting::Adapt,
        Setting::Feedforward,
        Setting::Urdf,
    ];

    /// Name of the field.
    pub fn field(self) -> &'static str {
        match self {
            Setting::Law => "law",
            Setting::Asymmetric => "asymmetric",
            Setting::Method => "method",
            Setting::Validate => "validate",
            Setting::Split => "split",
            Setting::Statics => "statics",
            Setting::Model => "model",
            Setting::BreakAway => "break_away",
            Setting::Search => "search",
            Setting::NoFinish => "no_finish",
            Setting::Cost => "cost",
            Setting::Evaluations => "evaluations",
            Setting::Target => "target",
            Setting::Time => "time",
            Setting::Checkpoint => "checkpoint",
            Setting::Resume => "resume",
            Setting::Problem => "problem",
            Setting::Seeds => "seeds",
            Setting::Noise => "noise",
            Setting::Excitation => "excitation",
            Setting::Rate => "rate",
            Setting::OtherLaw => "other_law",
            Setting::Decades => "decades",
            Setting::Integrator => "integrator",
            Setting::Want => "want",
            Setting::Start => "start",
            Setting::Known => "known",
            Setting::Adapt => "adapt",
            Setting::Feedforward => "feedforward",
            Setting::Urdf => "urdf",
        }
    }

    /// The option with a value, for a message.
    pub(crate) fn is(self, value: impl fmt::Display) -> Part {
        Part::Setting(self, Some(quoted(value.to_string())))
    }
}

/// Most characters of a value that are quoted.
const QUOTED: usize = 60;

/// A value as it is quoted: a number of hundreds of digits with a power of ten, a long text cut.
fn quoted(text: String) -> String {
    if text.chars().count() <= QUOTED {
        return text;
    }
    match text.parse::<f64>() {
        Ok(x) => full(x),
        Err(_) => text.chars().take(QUOTED).chain("...".chars()).collect(),
    }
}

/// A part of a message.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Part {
    /// Words.
    Text(Cow<'static, str>),
    /// An option, and the value it has where that is told.
    Setting(Setting, Option<String>),
}

impl From<&'static str> for Part {
    fn from(text: &'static str) -> Self {
        Part::Text(text.into())
    }
}

impl From<String> for Part {
    fn from(text: String) -> Self {
        Part::Text(text.into())
    }
}

impl From<Setting> for Part {
    fn from(setting: Setting) -> Self {
        Part::Setting(setting, None)
    }
}

/// Words that may name options. Displayed, an option is a field: `split = 2`; [`named`](Self::named) gives it another form.
///
/// ```
/// use stiction_files::Axis;
/// use stiction_identify::Silent;
/// use stiction_workflows::identify::{Options, identify_logs};
/// use stiction_workflows::{Error, Wording};
///
/// let mut options = Options::default();
/// (options.law, options.asymmetric) = (None, true);
/// let refused = identify_logs(&options, &Axis::default(), vec![], vec![], &mut Silent);
/// let Err(Error::Usage { found, .. }) = refused else { panic!() };
/// assert_eq!(found.to_string(), "law = auto with asymmetric");
/// let typed = |setting: stiction_workflows::Setting, value: Option<&str>| {
///     format!("--{} {}", setting.field(), value.unwrap_or_default())
/// };
/// assert_eq!(found.named(typed), "--law auto with --asymmetric ");
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Wording(Vec<Part>);

impl Wording {
    /// The words, with each option as `name` writes it, given its value where that is told.
    pub fn named(&self, name: impl Fn(Setting, Option<&str>) -> String) -> String {
        let parts = self.0.iter().map(|part| match part {
            Part::Text(text) => text.to_string(),
            Part::Setting(setting, value) => name(*setting, value.as_deref()),
        });
        parts.collect()
    }

    /// The same words behind others.
    pub(crate) fn behind(mut self, words: String) -> Self {
        self.0.insert(0, words.into());
        self
    }

    /// The options that the words name.
    pub fn settings(&self) -> impl Iterator<Item = Setting> {
        self.0.iter().filter_map(|part| match part {
            Part::Setting(setting, _) => Some(*setting),
            Part::Text(_) => None,
        })
    }

    /// The value that the words give an option.
    pub fn value(&self, of: Setting) -> Option<&str> {
        self.0.iter().find_map(|part| match part {
            Part::Setting(setting, value) if *setting == of => value.as_deref(),
            _ => None,
        })
    }
}

impl fmt::Display for Wording {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.named(|setting, value| match value {
            Some(value) => format!("{} = {value}", setting.field()),
            None => setting.field().into(),
        }))
    }
}

impl<T: Into<Part>> From<T> for Wording {
    fn from(part: T) -> Self {
        Self(vec![part.into()])
    }
}

impl<const N: usize> From<[Part; N]> for Wording {
    fn from(parts: [Part; N]) -> Self {
        Self(parts.into())
    }
}
