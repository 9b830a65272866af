//! The methods of identification, by name.

/// How the parameters are found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Method {
    /// All at once, motion in and force out, by separable least squares.
    #[default]
    Separable,
    /// Force in, position out: the axis is simulated and its position fitted.
    OutputError,
    /// The static map, from constant velocities.
    Static,
    /// The static map first, then sigma0 and sigma1 with it held.
    StaticThenDynamic,
    /// sigma0 and sigma1 from force steps below break-away.
    PreslidingStep,
    /// All at once, by one of the searches of `stiction_search`, then least squares.
    Searched(&'static str),
}

impl Method {
    /// All but the searches.
    pub const ALL: [Method; 5] = [
        Method::Separable,
        Method::OutputError,
        Method::Static,
        Method::StaticThenDynamic,
        Method::PreslidingStep,
    ];

    /// Names of the searches.
    pub const SEARCHES: [&'static str; 10] = stiction_search::Method::NAMES;

    /// The method of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        let own = Self::ALL.into_iter();
        let searches = stiction_search::Method::NAMES.map(Method::Searched);
        own.chain(searches).find(|method| method.name() == name)
    }

    /// Name as typed and as written to files.
    pub fn name(self) -> &'static str {
        match self {
            Method::Separable => "separable",
            Method::OutputError => "output-error",
            Method::Static => "static",
            Method::StaticThenDynamic => "static-then-dynamic",
            Method::PreslidingStep => "presliding-step",
            Method::Searched(name) => name,
        }
    }

    /// Whether the force of a whole record is fitted, which rests at its ends would mislead.
    pub(crate) fn fits_force(self) -> bool {
        self.fits_records() && self != Method::OutputError
    }

    /// Whether a law is fitted to the whole record, sample by sample.
    pub(crate) fn fits_records(self) -> bool {
        matches!(
            self,
            Method::Separable
                | Method::StaticThenDynamic
                | Method::OutputError
                | Method::Searched(_)
        )
    }
}
