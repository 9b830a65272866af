//! Contiguous blocks of the samples that a fit sees.

use crate::conditioning::record::Record;

/// For each sample of the regression its place among the kept ones.
pub(crate) fn kept_order(record: &Record) -> Vec<Option<usize>> {
    let mut next = 0;
    record
        .segments
        .iter()
        .flat_map(|s| &s.keep)
        .map(|&keep| {
            keep.then(|| {
                next += 1;
                next - 1
            })
        })
        .collect()
}
