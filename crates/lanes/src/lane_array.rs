//! Arrays of lanes.

/// Starts at a cache line: a vector that straddles two costs twice.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct Aligned<T>(pub T);

/// The group's members as lanes; lanes to spare repeat the last.
pub(crate) fn lanes<T, U, const N: usize>(group: &[T], of: impl Fn(&T) -> U) -> [U; N] {
    std::array::from_fn(|j| of(&group[j.min(group.len() - 1)]))
}
