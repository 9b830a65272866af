//! Values that were notified one by one, joined to rows by their time stamps.

use crate::source::MANY;
use std::collections::BTreeMap;

/// Rows that are not whole yet.
pub(super) struct Join {
    columns: usize,
    /// By time stamp: how many values are missing, and all of them.
    open: BTreeMap<u64, (usize, Vec<Option<f64>>)>,
    incomplete: u64,
    /// Rows that were given up on this connection before the first whole one: notifications that begin one by one.
    before: usize,
    began: bool,
}

impl Join {
    pub fn new(columns: usize) -> Self {
        Self {
            columns,
            open: BTreeMap::new(),
            incomplete: 0,
            before: 0,
            began: false,
        }
    }

    /// Forgets what a lost connection began.
    pub fn restart(&mut self) {
        if self.began {
            self.incomplete += self.open.len() as u64;
        }
        self.open.clear();
        self.before = 0;
        self.began = false;
    }

    /// Adds a value; the row where it was the last of it. Each column comes in the order of time, so older rows will not be
    /// whole any more.
    pub fn add(&mut self, stamp: u64, column: usize, value: f64) -> Option<Vec<f64>> {
        let row = self.open.entry(stamp);
        let (missing, values) = row.or_insert_with(|| (self.columns, vec![None; self.columns]));
        let slot = values.get_mut(column)?;
        *missing -= usize::from(slot.is_none());
        *slot = Some(value);
        if *missing > 0 {
            while self.open.len() > MANY {
                self.open.pop_first();
                self.give_up(1);
            }
            return None;
        }
        let newer = self.open.split_off(&stamp.saturating_add(1));
        let older = std::mem::replace(&mut self.open, newer);
        self.give_up(older.len() - 1);
        self.began = true;
        let (_, (_, values)) = older.last_key_value()?;
        values.iter().copied().collect()
    }

    fn give_up(&mut self, rows: usize) {
        match self.began {
            true => self.incomplete += rows as u64,
            false => self.before += rows,
        }
    }

    /// Rows that were left out because a value was missing.
    pub fn incomplete(&self) -> u64 {
        self.incomplete
    }

    /// Rows of this connection where none was whole; 0 once one was.
    pub fn hopeless(&self) -> usize {
        match self.began {
            true => 0,
            false => self.before + self.open.len(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Join;

    #[test]
    fn rows_are_whole_whatever_the_order_of_columns() {
        let mut join = Join::new(2);
        // All of one column, then all of the other.
        assert_eq!(join.add(10, 0, 1.0), None);
        assert_eq!(join.add(20, 0, 2.0), None);
        assert_eq!(join.add(10, 1, 3.0), Some(vec![1.0, 3.0]));
        assert_eq!(join.add(20, 1, 4.0), Some(vec![2.0, 4.0]));
        assert_eq!((join.incomplete(), join.hopeless()), (0, 0));
        // A value that never comes.
        assert_eq!(join.add(30, 0, 5.0), None);
        assert_eq!(join.add(40, 0, 6.0), None);
        assert_eq!(join.add(40, 1, 7.0), Some(vec![6.0, 7.0]));
        assert_eq!(join.incomplete(), 1);
    }

    #[test]
    fn columns_of_different_instants_are_hopeless_and_bounded() {
        let mut join = Join::new(2);
        for k in 0..50_000_u64 {
            assert_eq!(join.add(10 * k + k % 2, (k % 2) as usize, 1.0), None);
        }
        assert_eq!(join.hopeless(), 50_000);
        assert!(join.open.len() <= super::MANY);
        assert_eq!(join.incomplete(), 0);
    }
}
