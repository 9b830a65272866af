//! A Maxwell-slip law whose number of elements is known when the program runs.

use stiction_friction::{Element, Gms, ParamError, Stribeck};

/// A (generalised) Maxwell-slip law of 1 to 10 elements, validated. The laws of `stiction-friction` have their number of
/// elements in their type: [`gms`](Self::gms) gives the law of that type.
#[derive(Clone, Debug, PartialEq)]
pub struct MaxwellSlip {
    elements: Vec<Element<f64>>,
    attraction: f64,
    curve: Stribeck<f64>,
}

/// Evaluates an expression with the number of elements as the constant `$n`.
macro_rules! with_count {
    ($count:expr, $n:ident => $body:expr, $else:expr) => {
        with_count!(@arms $count, $n => $body, $else; 1 2 3 4 5 6 7 8 9 10)
    };
    (@arms $count:expr, $n:ident => $body:expr, $else:expr; $($number:literal)*) => {
        match $count {
            $($number => {
                const $n: usize = $number;
                $body
            })*
            _ => $else,
        }
    };
}

impl MaxwellSlip {
    /// Elements, attraction C in N/s (N m/s), infinite for Maxwell slip without a Stribeck curve, and the steady curve.
    pub fn new(
        elements: Vec<Element<f64>>,
        attraction: f64,
        curve: Stribeck<f64>,
    ) -> Result<Self, ParamError> {
        let law = MaxwellSlip {
            elements,
            attraction,
            curve,
        };
        let count = law.elements.len();
        with_count!(
            count,
            N => law.sized::<N>().map(drop)?,
            return Err(ParamError::new("elements", count as f64, "1 to 10"))
        );
        Ok(law)
    }

    /// The elements; of their shares only the ratios count.
    pub fn elements(&self) -> &[Element<f64>] {
        &self.elements
    }

    /// Attraction C, N/s (N m/s).
    pub fn attraction(&self) -> f64 {
        self.attraction
    }

    /// The steady curve.
    pub fn curve(&self) -> &Stribeck<f64> {
        &self.curve
    }

    /// The law of `N` elements; `None` where there are more or fewer.
    pub fn gms<const N: usize>(&self) -> Option<Gms<f64, N>> {
        self.sized().ok()
    }

    fn sized<const N: usize>(&self) -> Result<Gms<f64, N>, ParamError> {
        let count = self.elements.len();
        let elements = <[Element<f64>; N]>::try_from(self.elements.as_slice())
            .map_err(|_| ParamError::new("elements", count as f64, "as many as the type has"))?;
        Gms::new(elements, self.attraction, 0.0, self.curve)
    }
}
