//! The noise stream against its published definition in another language, and its distribution.

use stiction_servo::noise::Noise;

/// Output of tests/noise.py.
const EXPECTED: [(u64, [f64; 6]); 2] = [
    (
        0,
        [
            -0.6542651266405949,
            0.5972974560105194,
            0.9416837800043749,
            0.06789694564659411,
            1.159637185289785,
            0.1506823246249944,
        ],
    ),
    (
        42,
        [
            -0.7689930538210061,
            1.6661184587142,
            -0.8684461074702454,
            -2.7391511556643047,
            -1.5109749830006707,
            -0.9337600430935515,
        ],
    ),
];

#[test]
fn stream_is_the_published_one() {
    for (seed, expected) in EXPECTED {
        let mut noise = Noise::new(seed);
        for e in expected {
            let got = noise.normal();
            assert!(
                (got - e).abs() <= 4e-16 * e.abs().max(1.0),
                "seed {seed}: {got} {e}"
            );
        }
    }
}

#[test]
fn moments_are_those_of_the_normal_distribution() {
    let mut noise = Noise::new(7);
    let n = 1_000_000;
    let (mut m1, mut m2, mut m4, mut lag) = (0.0, 0.0, 0.0, 0.0);
    let mut last = 0.0;
    for _ in 0..n {
        let x = noise.normal();
        m1 += x;
        m2 += x * x;
        m4 += x * x * x * x;
        lag += x * last;
        last = x;
    }
    let n = f64::from(n);
    // Four standard errors each: 1, sqrt 2, sqrt 96, 1 over sqrt n.
    let bound = 4.0 / n.sqrt();
    assert!((m1 / n).abs() < bound);
    assert!((m2 / n - 1.0).abs() < 1.42 * bound);
    assert!((m4 / n - 3.0).abs() < 9.8 * bound);
    assert!((lag / n).abs() < bound);
}
