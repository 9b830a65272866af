//! A parameter as code knows it.

use crate::{Dimension, Quantity, UnknownName};
use std::fmt;

/// The direction of motion that a parameter belongs to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Side {
    /// Both directions.
    #[default]
    Both,
    /// Positive velocity.
    Positive,
    /// Negative velocity.
    Negative,
}

impl Side {
    /// What is appended to names in files.
    #[doc(hidden)]
    pub fn suffix(self) -> &'static str {
        match self {
            Side::Both => "",
            Side::Positive => "_pos",
            Side::Negative => "_neg",
        }
    }

    /// Place of the direction where positive comes first; that of both directions is read from the positive one.
    #[doc(hidden)]
    pub fn index(self) -> usize {
        usize::from(self == Side::Negative)
    }

    /// Whether it holds for the direction of this place.
    #[doc(hidden)]
    pub fn holds(self, index: usize) -> bool {
        self == Side::Both || self.index() == index
    }

    /// The directions that have parameters of their own.
    #[doc(hidden)]
    pub fn all(asymmetric: bool) -> &'static [Side] {
        if asymmetric {
            &[Side::Positive, Side::Negative]
        } else {
            &[Side::Both]
        }
    }

    /// The direction of a velocity; that of 0 is positive.
    pub fn of(velocity: f64) -> Self {
        if velocity < 0.0 {
            Side::Negative
        } else {
            Side::Positive
        }
    }
}

/// A parameter: what it is, and of which direction of motion. In files it is text, such as `coulomb_pos`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Name {
    /// What it is.
    pub quantity: Quantity,
    /// Of which direction.
    pub side: Side,
}

impl Name {
    /// A parameter of one direction, or of both.
    pub const fn new(quantity: Quantity, side: Side) -> Self {
        Name { quantity, side }
    }

    /// Symbol in Unicode, such as `Fc⁺`.
    pub fn symbol(self) -> String {
        let side = match self.side {
            Side::Both => "",
            Side::Positive => "⁺",
            Side::Negative => "⁻",
        };
        format!("{}{side}", self.quantity.symbol())
    }

    /// What it measures.
    #[doc(hidden)]
    pub fn dimension(self) -> Dimension {
        self.quantity.dimension()
    }

    /// Whether it holds at velocities of this direction.
    #[doc(hidden)]
    pub fn holds_for(self, side: Side) -> bool {
        self.side == Side::Both || self.side == side
    }
}

impl From<Quantity> for Name {
    /// That of both directions.
    fn from(quantity: Quantity) -> Self {
        Name::new(quantity, Side::Both)
    }
}

impl From<(Quantity, Side)> for Name {
    fn from((quantity, side): (Quantity, Side)) -> Self {
        Name::new(quantity, side)
    }
}

impl fmt::Display for Name {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Padded like any text.
        f.pad(&format!("{}{}", self.quantity.stem(), self.side.suffix()))
    }
}

impl std::str::FromStr for Name {
    type Err = UnknownName;

    /// Names as files have them. A direction is read of any parameter, also of one that does not differ by direction.
    fn from_str(text: &str) -> Result<Self, UnknownName> {
        let (stem, side) = match text.strip_suffix("_pos") {
            Some(stem) => (stem, Side::Positive),
            None => match text.strip_suffix("_neg") {
                Some(stem) => (stem, Side::Negative),
                None => (text, Side::Both),
            },
        };
        match Quantity::from_stem(stem) {
            Some(quantity) => Ok(Name { quantity, side }),
            None => Err(UnknownName(text.chars().take(60).collect())),
        }
    }
}

/// Against the parameter of both directions.
impl PartialEq<Quantity> for Name {
    fn eq(&self, other: &Quantity) -> bool {
        *self == Name::from(*other)
    }
}

/// Against a name as files have it.
impl PartialEq<str> for Name {
    fn eq(&self, other: &str) -> bool {
        other.parse().is_ok_and(|name: Name| name == *self)
    }
}

/// Against a name as files have it.
impl<T: AsRef<str> + ?Sized> PartialEq<&T> for Name {
    fn eq(&self, other: &&T) -> bool {
        *self == *other.as_ref()
    }
}

/// Against a name as files have it.
impl PartialEq<Name> for str {
    fn eq(&self, other: &Name) -> bool {
        other == self
    }
}

/// Against a name as files have it.
impl PartialEq<Name> for &str {
    fn eq(&self, other: &Name) -> bool {
        other == *self
    }
}
