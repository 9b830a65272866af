//! A PID whose gains follow 49 fuzzy rules.

use crate::path::Reference;
use crate::pid::{Pid, PidState, Scale};
use stiction_friction::ParamError;

/// A fuzzy PID: error and its rate, each on seven triangular sets NB, NM, NS, ZO, PS, PM, PB over -3 to 3, determine the
/// factor on each gain.
///
/// Product inference, singleton consequents and their weighted mean as the result: with triangles that
/// overlap by half that is the bilinear interpolation of the table, exactly, at the cost of four entries.
///
/// The tables are an assumption of ours, in the form that is usual for a fuzzy PID: Zhang et al. 2025 (doi
/// 10.1371/journal.pone.0322844) control their axis with a fuzzy PID of two inputs and 49 rules but print no table. The
/// entries of the proportional and the integral table change sign with error and rate, where an equal response in both directions would need equal gains: so a
/// symmetric axis is controlled asymmetrically.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FuzzyPid {
    /// The gains that the rules modify.
    pub base: Pid,
    /// Error that counts as 3 ("big"), > 0, m (rad).
    pub error_scale: f64,
    /// Error rate that counts as 3, > 0, m/s (rad/s).
    pub rate_scale: f64,
    /// Largest relative change of each gain, 0 to below 1.
    pub range: f64,
}

const NB: i8 = -3;
const NM: i8 = -2;
const NS: i8 = -1;
const ZO: i8 = 0;
const PS: i8 = 1;
const PM: i8 = 2;
const PB: i8 = 3;

type Table = [[i8; 7]; 7];

/// Rows: error NB to PB; columns: error rate NB to PB.
const PROPORTIONAL: Table = [
    [PB, PB, PM, PM, PS, ZO, ZO],
    [PB, PB, PM, PS, PS, ZO, NS],
    [PM, PM, PM, PS, ZO, NS, NS],
    [PM, PM, PS, ZO, NS, NM, NM],
    [PS, PS, ZO, NS, NS, NM, NM],
    [PS, ZO, NS, NM, NM, NM, NB],
    [ZO, ZO, NM, NM, NM, NB, NB],
];
const INTEGRAL: Table = [
    [NB, NB, NM, NM, NS, ZO, ZO],
    [NB, NB, NM, NS, NS, ZO, ZO],
    [NB, NM, NS, NS, ZO, PS, PS],
    [NM, NM, NS, ZO, PS, PM, PM],
    [NM, NS, ZO, PS, PS, PM, PB],
    [ZO, ZO, PS, PS, PM, PB, PB],
    [ZO, ZO, PS, PM, PM, PB, PB],
];
const DERIVATIVE: Table = [
    [PS, NS, NB, NB, NB, NM, PS],
    [PS, NS, NB, NM, NM, NS, ZO],
    [ZO, NS, NM, NM, NS, NS, ZO],
    [ZO, NS, NS, NS, NS, NS, ZO],
    [ZO, ZO, ZO, ZO, ZO, ZO, ZO],
    [PB, NS, PS, PS, PS, PS, PB],
    [PB, PM, PM, PM, PS, PS, PB],
];

impl FuzzyPid {
    /// [`Pid::tuned`] with rules around it, for an axis whose friction is about `friction` > 0, N (N m): the error that
    /// this force causes against Kp counts as big, and so does the rate at which it would change that much within a radian of the
    /// bandwidth. Gains change by up to 30 %, which the phase margin of some 55 degrees allows.
    pub fn tuned(
        mass: f64,
        bandwidth: f64,
        force_limit: f64,
        friction: f64,
    ) -> Result<Self, ParamError> {
        ParamError::positive("friction", friction)?;
        let base = Pid::tuned(mass, bandwidth, force_limit)?;
        let error_scale = friction / base.proportional;
        let fuzzy = FuzzyPid {
            base,
            error_scale,
            rate_scale: error_scale * 2.0 * std::f64::consts::PI * bandwidth,
            range: 0.3,
        };
        fuzzy.validate()?;
        Ok(fuzzy)
    }

    /// Refuses settings out of range.
    pub fn validate(&self) -> Result<(), ParamError> {
        self.base.validate()?;
        ParamError::positive("error_scale", self.error_scale)?;
        ParamError::positive("rate_scale", self.rate_scale)?;
        if !(0.0..1.0).contains(&self.range) {
            return Err(ParamError::new("range", self.range, "0 to below 1"));
        }
        Ok(())
    }

    /// As [`Pid::force`].
    pub fn force(
        &self,
        state: &mut PidState,
        h: f64,
        reference: Reference,
        position: f64,
        feedforward: f64,
    ) -> f64 {
        let errors = self.base.errors(state, h, reference, position);
        let scale = self.scale(errors.0, errors.1);
        self.base
            .scaled(state, h, errors, scale, reference, feedforward)
    }

    /// The factors on the gains for an error (m, rad) and its rate (m/s, rad/s).
    fn scale(&self, error: f64, rate: f64) -> Scale {
        let row = Membership::of(error / self.error_scale);
        let column = Membership::of(rate / self.rate_scale);
        let part = |table: &Table| 1.0 + self.range / 3.0 * infer(table, row, column);
        Scale {
            proportional: part(&PROPORTIONAL),
            integral: part(&INTEGRAL),
            derivative: part(&DERIVATIVE),
        }
    }
}

/// The two neighbouring sets that a value belongs to: `low` by `1 - share`, the next by `share`.
#[derive(Clone, Copy)]
struct Membership {
    low: usize,
    share: f64,
}

impl Membership {
    /// `x` relative to the scale: -1 is NB, 1 is PB. NaN is ZO.
    fn of(x: f64) -> Self {
        let x = if x.is_nan() { 0.0 } else { x };
        let at = 3.0 * x.clamp(-1.0, 1.0) + 3.0;
        let low = (at as usize).min(5);
        Membership {
            low,
            share: at - low as f64,
        }
    }
}

fn infer(table: &Table, row: Membership, column: Membership) -> f64 {
    let along = |row: usize| {
        let (a, b) = (table[row][column.low], table[row][column.low + 1]);
        f64::from(a) + column.share * f64::from(b - a)
    };
    let (a, b) = (along(row.low), along(row.low + 1));
    a + row.share * (b - a)
}

#[cfg(test)]
mod tests {
    use super::{DERIVATIVE, INTEGRAL, Membership, PROPORTIONAL, Table, infer};

    /// The inference as it is defined: every rule fires by the product of its memberships, the result is the weighted mean.
    fn by_definition(table: &Table, e: f64, de: f64) -> f64 {
        let set = |x: f64, i: usize| {
            let x = (3.0 * x).clamp(-3.0, 3.0);
            (1.0 - (x - (i as f64 - 3.0)).abs()).max(0.0)
        };
        let (mut sum, mut weight) = (0.0, 0.0);
        for (i, row) in table.iter().enumerate() {
            for (j, &level) in row.iter().enumerate() {
                let fires = set(e, i) * set(de, j);
                sum += fires * f64::from(level);
                weight += fires;
            }
        }
        sum / weight
    }

    #[test]
    fn interpolation_is_the_inference_of_all_rules() {
        for table in [&PROPORTIONAL, &INTEGRAL, &DERIVATIVE] {
            for i in -25..=25 {
                for j in -25..=25 {
                    let (e, de) = (f64::from(i) / 20.0, f64::from(j) / 20.0);
                    let got = infer(table, Membership::of(e), Membership::of(de));
                    assert!(
                        (got - by_definition(table, e, de)).abs() < 1e-12,
                        "{e} {de}"
                    );
                }
            }
        }
        assert_eq!(
            infer(&INTEGRAL, Membership::of(f64::NAN), Membership::of(0.0)),
            0.0
        );
    }
}
