//! Codes of refused recordings; that each has a page is held by the crate of the codes.

use std::collections::BTreeSet;
use stiction_formats::Kind;

const KINDS: [Kind; 8] = [
    Kind::Io,
    Kind::Format,
    Kind::Limit,
    Kind::Ambiguous,
    Kind::Missing,
    Kind::Unit,
    Kind::Time,
    Kind::Value,
];

#[test]
fn every_kind_has_a_code_of_its_own() {
    let codes: BTreeSet<_> = KINDS.iter().map(|kind| kind.code()).collect();
    assert_eq!(codes.len(), KINDS.len());
    assert!(codes.iter().all(|code| code.as_str().starts_with("log-")));
}
