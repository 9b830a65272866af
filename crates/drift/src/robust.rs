//! Medians, and the scale that follows from them.

/// A median absolute deviation of 1 is this standard deviation, for normal numbers.
pub(crate) const SCALE_OF_MAD: f64 = 1.482_602_218_505_602;

/// The median, which sorts its numbers; NaN of none.
pub(crate) fn median(numbers: &mut [f64]) -> f64 {
    let count = numbers.len();
    if count == 0 {
        return f64::NAN;
    }
    let (below, upper, _) = numbers.select_nth_unstable_by(count / 2, f64::total_cmp);
    let upper = *upper;
    match count % 2 {
        1 => upper,
        _ => f64::midpoint(
            below.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            upper,
        ),
    }
}

/// The median of numbers with weights (number, weight above 0), which are sorted: half of the weight is on either side. NaN of none.
pub(crate) fn weighted_median(numbers: &mut [(f64, f64)]) -> f64 {
    numbers.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    let half = 0.5 * numbers.iter().map(|(_, weight)| weight).sum::<f64>();
    let mut sum = 0.0;
    for (i, &(number, weight)) in numbers.iter().enumerate() {
        sum += weight;
        if sum > half * (1.0 + 1e-12) {
            return number;
        }
        if sum >= half * (1.0 - 1e-12) {
            // Exactly half lies up to here.
            return numbers
                .get(i + 1)
                .map_or(number, |&(next, _)| f64::midpoint(number, next));
        }
    }
    numbers.last().map_or(f64::NAN, |&(number, _)| number)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn half_of_the_numbers_and_of_the_weight_lies_on_either_side(
            numbers in prop::collection::vec((-1e3..1e3f64, 0.1..10.0f64), 1..40),
        ) {
            let mut plain: Vec<f64> = numbers.iter().map(|(x, _)| *x).collect();
            let middle = median(&mut plain);
            let count = |side: &dyn Fn(f64) -> bool| plain.iter().filter(|x| side(**x)).count();
            prop_assert!(2 * count(&|x| x < middle) <= plain.len());
            prop_assert!(2 * count(&|x| x > middle) <= plain.len());
            let weighted = weighted_median(&mut numbers.clone());
            let weight = |side: &dyn Fn(f64) -> bool| -> f64 {
                numbers.iter().filter(|(x, _)| side(*x)).map(|(_, w)| w).sum()
            };
            let half = 0.5 * weight(&|_| true) * (1.0 + 1e-9);
            prop_assert!(weight(&|x| x < weighted) <= half && weight(&|x| x > weighted) <= half);
            // With equal weights it is the median.
            let mut equal: Vec<(f64, f64)> = plain.iter().map(|x| (*x, 0.3)).collect();
            prop_assert!((weighted_median(&mut equal) - middle).abs() < 1e-9);
        }
    }
}
