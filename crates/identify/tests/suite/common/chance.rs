//! How often intervals may hold the truth: from both sides, by chance.

/// Probability of at most `k` hits in `n` runs of `p` each.
pub fn at_most(k: usize, n: usize, p: f64) -> f64 {
    // In logarithms: the first term of many runs is below all numbers.
    let mut term = n as f64 * (1.0 - p).ln();
    let mut sum = term.exp();
    for i in 1..=k {
        term += ((n - i + 1) as f64 / i as f64 * p / (1.0 - p)).ln();
        sum += term.exp();
    }
    sum.min(1.0)
}

/// Probability of at least `k` hits in `n` runs of `p` each.
pub fn at_least(k: usize, n: usize, p: f64) -> f64 {
    at_most(n - k, n, 1.0 - p)
}

/// Refuses a count of 95 % intervals that hold the truth which would come about once in a thousand times if they held it
/// in 90 % of the cases, or in 98.5 %: too narrow, or too wide. Below 460 cases none are too many.
pub fn neither_too_narrow_nor_too_wide(what: &str, inside: usize, all: usize) {
    println!("{what}: {inside} of {all}");
    assert!(
        at_most(inside, all, 0.90) > 1e-3,
        "{what}: only {inside} of {all} intervals hold the truth"
    );
    assert!(
        at_least(inside, all, 0.985) > 1e-3,
        "{what}: as many as {inside} of {all} intervals hold the truth: they are too wide"
    );
}

#[test]
fn probabilities_are_those_of_the_binomial() {
    // scipy 1.17 `binom.cdf(34, 40, .95)`.
    assert!((at_most(34, 40, 0.95) / 0.013_876_949_213_303_673 - 1.0).abs() < 1e-9);
    assert!((at_least(550, 550, 0.985) / 0.985_f64.powi(550) - 1.0).abs() < 1e-9);
    assert!((at_most(720, 800, 0.9) + at_least(721, 800, 0.9) - 1.0).abs() < 1e-9);
}
