//! A key of a file that has several values in turn.

use super::given::Given;
use std::cell::Cell;

/// The value that a key has instead of its own.
#[derive(Clone, Copy)]
pub(crate) struct Swept<'a> {
    /// The key without places in lists, such as `path.amplitude`: that of every entry that gives it.
    pub key: &'a str,
    /// Its value, where it stands in the file.
    pub value: &'a Given<'a>,
    /// Set where the value is taken.
    pub taken: &'a Cell<bool>,
}

impl<'a> Swept<'a> {
    /// The value for a key of a table whose keys begin with `prefix`, such as `path[2].`; `stands` says whether the file has
    /// the key there. An entry of a list that does not give it keeps its default.
    pub(super) fn of(&self, prefix: &str, key: &str, stands: bool) -> Option<Given<'a>> {
        let named = plain(prefix).chain(key.chars()).eq(self.key.chars());
        if !named || prefix.contains('[') && !stands {
            return None;
        }
        self.taken.set(true);
        Some(self.value.clone())
    }
}

/// The letters of a prefix without places in lists.
fn plain(prefix: &str) -> impl Iterator<Item = char> {
    let mut inside = false;
    prefix.chars().filter(move |c| {
        inside |= *c == '[';
        let shown = !inside;
        inside &= *c != ']';
        shown
    })
}
