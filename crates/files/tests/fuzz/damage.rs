//! Inputs from seeds: bytes changed, cut, repeated, put in from elsewhere, and numbers that are at the edge of something.

/// SplitMix64 (Steele, Lea, Flood 2014): the same inputs in every run.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15))
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number below a limit, 0 where that is 0.
    pub fn below(&mut self, limit: usize) -> usize {
        (self.next() % limit.max(1) as u64) as usize
    }
}

/// Words at the edge of something, in text.
const WORDS: [&str; 34] = [
    "0",
    "-0",
    "1e308",
    "-1e308",
    "1e309",
    "1e-320",
    "nan",
    "inf",
    "-inf",
    "9007199254740993",
    "1e999999999",
    "0x1p4",
    "\u{1b}]0;x\u{7}",
    "\u{202e}",
    "\"",
    "\"\"\"",
    "[",
    "]",
    "[[",
    "{",
    "}",
    "=",
    "#",
    ",",
    ";",
    "\t",
    "\n",
    "\r\n",
    "1 km/s",
    "1e15 N",
    "0 s",
    "-1 Hz",
    "true",
    "18446744073709551616",
];
/// Numbers at the edge of something, in binary.
const EDGES: [u64; 12] = [
    0,
    1,
    0x7f,
    0xff,
    0x7fff,
    0xffff,
    1 << 20,
    1 << 28,
    0x7fff_ffff,
    0xffff_ffff,
    0x7fff_ffff_ffff_ffff,
    u64::MAX,
];
/// Longest part that is moved, bytes.
const PART: usize = 96;
/// Longest input, bytes.
const LONGEST: usize = 1 << 16;

/// A seed with one to four pieces of damage, for some of which another seed gives the bytes.
pub fn damaged(seed: &[u8], other: &[u8], random: &mut Random) -> Vec<u8> {
    let mut bytes = seed.to_vec();
    for _ in 0..1 + random.below(4) {
        once(&mut bytes, other, random);
    }
    bytes.truncate(LONGEST);
    bytes
}

fn once(bytes: &mut Vec<u8>, other: &[u8], random: &mut Random) {
    let at = random.below(bytes.len());
    let part = |of: &[u8], random: &mut Random| {
        let from = random.below(of.len());
        let to = (from + 1 + random.below(PART)).min(of.len());
        of[from..to].to_vec()
    };
    match random.below(12) {
        0 | 1 => set(bytes, at, &[random.next() as u8]),
        2 => {
            if let Some(byte) = bytes.get_mut(at) {
                *byte ^= 1 << random.below(8);
            }
        }
        3 | 4 => {
            let edge = EDGES[random.below(EDGES.len())].wrapping_add(random.below(3) as u64);
            let width = [1, 2, 4, 8][random.below(4)];
            let at = at - at % width;
            match random.below(4) {
                0 => set(bytes, at, &edge.to_be_bytes()[8 - width..]),
                _ => set(bytes, at, &edge.to_le_bytes()[..width]),
            }
        }
        5 => bytes.truncate(at),
        6 => {
            let part = part(bytes, random);
            bytes.splice(at..at, part);
        }
        7 => {
            let part = part(other, random);
            bytes.splice(at..at, part);
        }
        8 => {
            let part = part(bytes, random);
            set(bytes, at, &part);
        }
        9 => {
            let end = (at + 1 + random.below(PART)).min(bytes.len());
            bytes.drain(at.min(end)..end);
        }
        _ => {
            let word = WORDS[random.below(WORDS.len())].as_bytes();
            // In place of a number or a name, or between two.
            let here = |b: &u8| b.is_ascii_alphanumeric() || b"+-._".contains(b);
            let end = at + bytes[at..].iter().take_while(|b| here(b)).count();
            let end = if random.below(3) == 0 { at } else { end };
            bytes.splice(at..end, word.iter().copied());
        }
    }
}

/// Puts bytes over others, as far as there are any.
fn set(bytes: &mut [u8], at: usize, with: &[u8]) {
    let over = bytes.iter_mut().skip(at);
    over.zip(with).for_each(|(to, from)| *to = *from);
}
