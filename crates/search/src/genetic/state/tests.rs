//! The elite, the rounds, and what becomes of a population's children.

use super::*;
use crate::genetic::{Rates, Ratio};

#[test]
fn rounds_shrink_around_the_best_and_stay_inside() {
    let mut ga = Genetic::new(Settings::default(), "annealing-ga", 2, 1).expect("defaults");
    ga.best = Some(Individual {
        point: vec![0.1, 0.6],
        cost: 1.0,
    });
    ga.next_round();
    assert_eq!((ga.low[0], ga.high[0]), (0.0, 0.5));
    assert!((ga.low[1] - 0.35).abs() < 1e-15 && (ga.high[1] - 0.85).abs() < 1e-15);
    ga.next_round();
    assert!((ga.high[0] - ga.low[0] - 0.25).abs() < 1e-15 && ga.low[0] >= 0.0);
}

/// A first population, and its children with all rates at one.
fn bred(change: impl FnOnce(&mut Settings)) -> Genetic {
    let mut settings = Settings {
        population: 1000,
        ratio: Ratio::Constant(0.5),
        crossover_rate: Rates::fixed(1.0),
        mutation_rate: Rates::fixed(1.0),
        ..Settings::default()
    };
    change(&mut settings);
    let mut ga = Genetic::new(settings, "ga", 5, 2).expect("a setting");
    let drawn = ga.ask().expect("a draw").points.len();
    ga.tell(&Answers::Costs((1..=drawn).map(|c| c as f64).collect()));
    assert_eq!(ga.ask().expect("children").points.len(), drawn);
    ga
}

fn differing(a: &[f64], b: &[f64]) -> Vec<usize> {
    (0..a.len()).filter(|&j| a[j] != b[j]).collect()
}

#[test]
fn mutation_draws_one_gene_anew_each_as_often() {
    let ga = bred(|s| s.crossover_rate = Rates::fixed(0.0));
    let mut counts = [0; 5];
    for (parent, child) in ga.population.iter().zip(&ga.children) {
        let genes = differing(&parent.point, &child.individual.point);
        assert_eq!(genes.len(), 1);
        counts[genes[0]] += 1;
    }
    // Four deviations of a binomial with p = 1/5.
    let most = 4.0 * (1000.0f64 * 0.2 * 0.8).sqrt();
    assert!(
        counts.iter().all(|&c| f64::from(c - 200).abs() < most),
        "{counts:?}"
    );
}

/// Half-way between the same two parents both children are alike; mutation after that makes them
/// differ, mutation before does not.
#[test]
fn a_concentrated_population_mutates_before_it_crosses() {
    let alike = |ga: &Genetic| {
        let mut points: Vec<_> = ga.children.iter().map(|c| &c.individual.point).collect();
        points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
        points.windows(2).filter(|w| w[0] == w[1]).count()
    };
    assert_eq!(alike(&bred(|s| s.adaptive_evolution = Some(0.0))), 500);
    assert_eq!(alike(&bred(|s| s.adaptive_evolution = Some(1.0))), 0);
    assert_eq!(alike(&bred(|_| {})), 0);
}

#[test]
fn the_elite_is_never_lost() {
    let mut ga = Genetic::new(Settings::default(), "annealing-ga", 3, 7).expect("defaults");
    let mut dice = Dice::new(1);
    let mut before: Vec<f64> = Vec::new();
    for _ in 0..100 {
        let request = ga.ask().expect("one round is longer");
        // Costs that have nothing to do with the points: children are no better than chance.
        let costs = request.points.rows().map(|_| dice.unit()).collect();
        ga.tell(&Answers::Costs(costs));
        let mut now = costs_of(&ga.population);
        now.sort_by(f64::total_cmp);
        now.truncate(ga.settings.elite);
        assert!(before.iter().zip(&now).all(|(a, b)| b <= a));
        before = now;
    }
}
