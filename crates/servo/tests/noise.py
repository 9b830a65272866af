"""The first normal numbers of the noise stream, from the published definitions alone.

SplitMix64 (Steele, Lea, Flood 2014) seeds xoshiro256++ (Blackman, Vigna 2021); the upper 53 bits make a uniform number;
Box and Muller (1958) make two normal ones of two uniform ones. The values in noise.rs are this script's output:

    python3 crates/servo/tests/noise.py
"""

import math

MASK = (1 << 64) - 1


def splitmix64(state):
    while True:
        state = (state + 0x9E3779B97F4A7C15) & MASK
        z = state
        z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & MASK
        z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & MASK
        yield z ^ (z >> 31)


def rotl(x, k):
    return ((x << k) | (x >> (64 - k))) & MASK


def xoshiro256pp(seed):
    words = splitmix64(seed)
    s = [next(words) for _ in range(4)]
    while True:
        yield (rotl((s[0] + s[3]) & MASK, 23) + s[0]) & MASK
        t = (s[1] << 17) & MASK
        s[2] ^= s[0]
        s[3] ^= s[1]
        s[1] ^= s[2]
        s[0] ^= s[3]
        s[2] ^= t
        s[3] = rotl(s[3], 45)


def normal(seed):
    bits = xoshiro256pp(seed)
    while True:
        u, w = ((next(bits) >> 11) / 2.0**53 for _ in range(2))
        radius = math.sqrt(-2.0 * math.log(1.0 - u))
        yield radius * math.cos(2.0 * math.pi * w)
        yield radius * math.sin(2.0 * math.pi * w)


for seed in (0, 42):
    stream = normal(seed)
    print(seed, [next(stream) for _ in range(6)])
