//! A log of a fleet: the row that a batch would write of it, from a process that does nothing else.

use super::one::{Became, Memory, begun, one};
use super::prepare::Batch;
use crate::error::Error;
use std::sync::RwLock;
use stiction_codes::Code;
use stiction_files::batch::LogRow;
use stiction_search::Observer;

impl Batch {
    /// The row of the log of [`Batch::single`], reading within that many bytes of memory; `None` where `known` is the key that the
    /// row would have: nothing that it depends on has changed.
    ///
    /// # Errors
    /// None that a log could make: those are in the row.
    pub fn row(
        &self,
        known: Option<&str>,
        memory: u64,
        observer: &mut dyn Observer,
    ) -> Result<Option<LogRow>, Error> {
        let memory = Memory {
            share: memory,
            all: memory,
            turns: RwLock::new(()),
        };
        let has = |key: &str| known == Some(key);
        let report = |_: &_, _: &_| Ok(());
        let became = one(
            self,
            &self.logs[0],
            &has,
            &memory,
            &report,
            observer,
            &|| false,
        )?;
        Ok(match became {
            Became::Row(_, row) => Some(*row),
            Became::Taken(_) | Became::Stopped => None,
        })
    }

    /// What is known of that log now, whatever was identified of it, for a row that has this key already.
    pub fn known(&self, key: String) -> LogRow {
        LogRow {
            key,
            ..begun(self, &self.logs[0])
        }
    }

    /// The row of that log where it could not even be read, or nothing came back of it. It is tried again by whoever compares keys.
    pub fn unread(&self, code: Code, message: String) -> LogRow {
        let entry = &self.logs[0];
        let mut row = begun(self, entry);
        row.key = self.key_of_failure(entry, &self.key(entry, "unread"));
        row.error = Some(code);
        row.message = Some(message);
        row
    }
}
