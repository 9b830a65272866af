//! The bits do not depend on instruction set, company or threads.

use crate::common::{candidate, force, motion, sine, spread, track};
use proptest::prelude::*;
use stiction_lanes::{
    Candidate, Directed, InstructionSet, Scheme, Track, costs, directed_levels, directed_slopes,
    residuals,
};

fn bits(track: &Track, all: &[Candidate], scheme: Scheme, set: InstructionSet) -> Vec<u64> {
    let found = costs(track, all, scheme, set).unwrap();
    found.iter().map(|x| x.to_bits()).collect()
}

const SCHEMES: [Scheme; 3] = [Scheme::Explin, Scheme::Euler, Scheme::RungeKutta];

#[test]
fn costs_have_the_same_bits_in_any_company_and_instruction_set() {
    let velocity = sine(700, 1e-3, 0.05, 7.0);
    let track = track(1e-3, &velocity, &force(&velocity));
    for exponents in [false, true] {
        let all = spread(33, exponents);
        for scheme in SCHEMES {
            let right: Vec<u64> = all
                .iter()
                .flat_map(|c| bits(&track, &[*c], scheme, InstructionSet::best()))
                .collect();
            for set in InstructionSet::all() {
                for count in [1, 3, 7, 8, 9, 17, 33] {
                    let found = bits(&track, &all[33 - count..], scheme, set);
                    assert_eq!(found, right[33 - count..], "{set} {count} {scheme:?}");
                }
            }
        }
    }
}

#[test]
fn costs_have_the_same_bits_with_any_number_of_threads() {
    let velocity = sine(700, 1e-3, 0.05, 7.0);
    let track = track(1e-3, &velocity, &force(&velocity));
    let all = spread(33, true);
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let run = || bits(&track, &all, Scheme::Explin, InstructionSet::best());
        pool.build().unwrap().install(run)
    };
    assert_eq!(with(1), with(2));
    assert_eq!(with(1), with(5));
}

/// Residuals written out, in lanes of any number, leave the costs and have the same bits.
#[test]
fn residuals_are_those_of_the_costs() {
    let velocity = sine(700, 1e-3, 0.05, 7.0);
    let track = track(1e-3, &velocity, &force(&velocity));
    for exponents in [false, true] {
        let all = spread(8, exponents);
        let costs = costs(&track, &all, Scheme::Explin, InstructionSet::best()).unwrap();
        let (mut right, mut rows, mut one) = (Vec::new(), Vec::new(), Vec::new());
        residuals::<8>(&track, &all, InstructionSet::best(), &mut right).unwrap();
        assert_eq!(right.len(), velocity.len());
        for (j, cost) in costs.iter().enumerate() {
            let sum: f64 = right.iter().map(|row| row[j] * row[j]).sum();
            assert!((sum / cost - 1.0).abs() < 1e-12, "{sum} {cost}");
        }
        for set in InstructionSet::all() {
            residuals::<8>(&track, &all[1..5], set, &mut rows).unwrap();
            residuals::<1>(&track, &all[2..3], set, &mut one).unwrap();
            for ((right, row), one) in right.iter().zip(&rows).zip(&one) {
                assert_eq!(right[1..5], row[..4], "{set}");
                assert_eq!(right[2], one[0], "{set}");
            }
        }
    }
}

#[test]
fn a_law_of_each_direction_has_the_same_bits_with_any_instruction_set() {
    let velocity = sine(900, 1e-3, 0.05, 7.0);
    let track = track(1e-3, &velocity, &force(&velocity));
    for exponent in [2.0, 1.3] {
        let trial = Directed {
            ln_kappa: 8.7,
            ln_ratio: 0.3,
            ln_excess: [-0.7, -0.2],
            ln_velocity: [-5.0, -5.6],
            exponent,
        };
        let all = |set: InstructionSet| -> Vec<u64> {
            let levels = directed_levels(&track, &trial, set).unwrap();
            let wanted = [true, true, false, true, true, true];
            let slopes = directed_slopes(&track, &trial, [20.0, 600.0], wanted, set).unwrap();
            assert!(slopes[2].is_empty());
            let columns = levels.iter().chain(&slopes).flatten();
            columns.map(|x| x.to_bits()).collect()
        };
        let right = all(InstructionSet::best());
        assert_eq!(right.len(), 7 * velocity.len());
        for set in InstructionSet::all() {
            assert!(all(set) == right, "{set}");
        }
    }
    let far = Directed {
        ln_kappa: 8.7,
        ln_ratio: 61.0,
        ln_excess: [0.0; 2],
        ln_velocity: [0.0; 2],
        exponent: 2.0,
    };
    assert!(directed_levels(&track, &far, InstructionSet::best()).is_err());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn any_cost_has_the_same_bits_everywhere(
        all in prop::collection::vec(candidate(), 1..20),
        velocity in motion(),
        h in 1e-5..0.1,
    ) {
        let track = track(h, &velocity, &force(&velocity));
        let one = |c: &Candidate| bits(&track, &[*c], Scheme::Explin, InstructionSet::best());
        let right: Vec<u64> = all.iter().flat_map(one).collect();
        for set in InstructionSet::all() {
            prop_assert_eq!(&bits(&track, &all, Scheme::Explin, set), &right);
        }
    }
}
