//! Limits that the user sets.

use crate::error::Error;
use stiction_formats::Unit;

/// On which side of a limit a level is beyond it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// `>`
    Above,
    /// `<`
    Below,
}

/// A limit of a parameter, such as `coulomb > 1.3` times its reference, or `coulomb > 25 N`.
#[derive(Clone, Debug, PartialEq)]
pub struct Limit {
    /// As it was typed.
    pub text: String,
    /// Parameter.
    pub parameter: String,
    /// Where it is exceeded.
    pub side: Side,
    /// The level, or times the reference.
    pub level: f64,
    /// Unit of the level; none where it is times the reference.
    pub unit: Option<String>,
}

impl Limit {
    /// Reads a limit.
    ///
    /// # Errors
    /// Where it is not a parameter, `>` or `<`, a number above 0, and a unit or none.
    pub fn read(text: &str) -> Result<Self, Error> {
        let refused = || {
            Error::usage(
                format!("the limit {text:?}"),
                "a parameter, > or <, and a number: \"coulomb > 1.3\" for 1.3 times the first logs, \"coulomb > 25 N\" for a level",
            )
        };
        let at = text.find(['>', '<']).ok_or_else(refused)?;
        let side = if text[at..].starts_with('>') {
            Side::Above
        } else {
            Side::Below
        };
        let parameter = text[..at].trim();
        let mut rest = text[at + 1..].split_whitespace();
        let level: Option<f64> = rest.next().and_then(|number| number.parse().ok());
        let level = level
            .filter(|x| x.is_finite() && *x > 0.0)
            .ok_or_else(refused)?;
        let unit = rest.next().map(String::from);
        if parameter.is_empty() || rest.next().is_some() {
            return Err(refused());
        }
        Ok(Limit {
            text: text.trim().into(),
            parameter: parameter.into(),
            side,
            level,
            unit,
        })
    }

    /// The same with its level in the unit of a number; `None` where that is of another kind.
    pub(super) fn in_unit(&self, unit: &str) -> Option<Self> {
        let Some(own) = &self.unit else {
            return Some(self.clone());
        };
        let (own, wanted) = (Unit::parse(own).ok()?, Unit::parse(unit).ok()?);
        (own.dimension() == wanted.dimension()).then(|| Self {
            level: self.level * own.factor() / wanted.factor(),
            unit: Some(unit.into()),
            ..self.clone()
        })
    }

    /// The level over the limit where it is beyond it, 1 or more; `None` where not. The limit is in the unit of the level.
    pub(super) fn over(&self, last: f64, reference: f64) -> Option<f64> {
        let allowed = match self.unit {
            Some(_) => self.level,
            None => self.level * reference,
        };
        let over = match self.side {
            Side::Above => last / allowed,
            Side::Below => allowed / last,
        };
        let beyond = match self.side {
            Side::Above => last > allowed,
            Side::Below => last < allowed,
        };
        beyond.then_some(if over >= 1.0 { over } else { 1.0 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_are_read_and_exceeded() {
        let limit = Limit::read("coulomb > 1.3").unwrap();
        assert_eq!((limit.side, limit.unit.as_deref()), (Side::Above, None));
        assert_eq!(limit.over(25.0, 20.0), None);
        assert!(limit.over(27.0, 20.0).is_some_and(|over| over > 1.03));
        let level = Limit::read(" sigma2<50 N·s/m ").unwrap();
        assert_eq!(
            (level.side, level.unit.as_deref()),
            (Side::Below, Some("N·s/m"))
        );
        let same = level.in_unit("N*s/m").unwrap();
        assert_eq!(same.over(25.0, 1.0), Some(2.0));
        let kilo = Limit::read("static > 0.03 kN").unwrap();
        let kilo = kilo.in_unit("N").unwrap();
        assert!((kilo.level - 30.0).abs() < 1e-12);
        assert_eq!(kilo.in_unit("m/s"), None);
        assert_eq!(level.over(60.0, 1.0), None);
        assert_eq!(level.over(25.0, 1.0), Some(2.0));
        for text in [
            "",
            "coulomb",
            "coulomb > ",
            "> 3",
            "coulomb > much",
            "coulomb > 1 N m",
            "coulomb > -1",
            "a > inf",
        ] {
            assert!(Limit::read(text).is_err(), "{text}");
        }
    }
}
