//! Arrays of lanes.

/// Aligned to a cache line: a vector that crosses from one line into the next costs twice.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct Aligned<T>(pub T);

/// The group's members as lanes; unused lanes repeat the last member.
pub(crate) fn lanes<T, U, const N: usize>(group: &[T], of: impl Fn(&T) -> U) -> [U; N] {
    std::array::from_fn(|j| of(&group[j.min(group.len() - 1)]))
}

/// The values that start at an index; the track is padded so that there are as many.
#[inline(always)]
pub(crate) fn chunk<T, const C: usize>(values: &[T], at: usize) -> &[T; C] {
    values[at..]
        .first_chunk()
        .expect("tracks and blocks are whole tiles")
}

/// One value of each row. Not `map`, which is not inlined everywhere, and what is not inlined is not
/// compiled for the instruction set.
#[inline(always)]
pub(crate) fn read<const F: usize, const N: usize>(rows: &[[f64; N]; F], j: usize) -> [f64; F] {
    let mut values = [0.0; F];
    for f in 0..F {
        values[f] = rows[f][j];
    }
    values
}

/// Sets one value of each row.
#[inline(always)]
pub(crate) fn write<const F: usize, const N: usize>(
    rows: &mut [[f64; N]; F],
    j: usize,
    values: [f64; F],
) {
    for f in 0..F {
        rows[f][j] = values[f];
    }
}
