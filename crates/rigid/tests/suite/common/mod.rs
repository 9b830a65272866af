//! Robots and numbers that the tests share.

use stiction_rigid::{Document, Robot};

pub const ARM6: &str = include_str!("../../pinocchio/arm6.urdf");
pub const ARM7: &str = include_str!("../../pinocchio/arm7.urdf");
pub const TREE: &str = include_str!("../../pinocchio/tree.urdf");
pub const ALL: [&str; 3] = [ARM6, ARM7, TREE];

pub fn robot(urdf: &str) -> Robot {
    Robot::new(&Document::parse(urdf).unwrap()).unwrap()
}

/// Random numbers, the same in each run (SplitMix64, Steele, Lea and Flood 2014).
pub struct Dice(u64);

impl Dice {
    pub fn new() -> Self {
        Self(1)
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform from -1 to 1.
    pub fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }

    pub fn vector(&mut self, n: usize, most: f64) -> Vec<f64> {
        (0..n).map(|_| most * self.unit()).collect()
    }
}

/// Largest difference of two lists, of the largest number in the second.
pub fn apart(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let most = b.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let off = a.iter().zip(b).map(|(a, b)| (a - b).abs());
    // NaN stays.
    off.fold(0.0, |m: f64, x| if x <= m { m } else { x }) / most
}
