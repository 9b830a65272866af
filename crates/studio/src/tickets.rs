//! Addresses under which a browser opens or saves a file by itself: such a request carries no header of the page, so its
//! address carries a secret, and the cookie comes with it all the same.

use crate::refused::Refused;
use crate::secret::secret;
use std::collections::VecDeque;
use std::sync::Mutex;

/// Most addresses that are known at once; the oldest go first.
const MOST: usize = 512;

/// What an address stands for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Opened {
    /// A file of the workspace, shown in a tab.
    Shown(String),
    /// A file of the workspace, saved.
    Saved(String),
    /// A folder of the workspace, saved as a zip.
    Zipped(String),
}

/// The addresses that were given out.
#[derive(Debug, Default)]
pub struct Tickets(Mutex<VecDeque<(String, Opened)>>);

impl Tickets {
    /// The address of something; the same for the same.
    pub fn give(&self, opened: Opened) -> Result<String, Refused> {
        let mut known = self.0.lock().map_err(|_| Refused::internal("a lock"))?;
        if let Some((ticket, _)) = known.iter().find(|(_, own)| *own == opened) {
            return Ok(ticket.clone());
        }
        let ticket = secret()?;
        if known.len() == MOST {
            known.pop_front();
        }
        known.push_back((ticket.clone(), opened));
        Ok(ticket)
    }

    /// What an address stands for.
    pub fn take(&self, ticket: &str) -> Option<Opened> {
        let known = self.0.lock().ok()?;
        let mut found = known.iter().filter(|(own, _)| own == ticket);
        found.next().map(|(_, opened)| opened.clone())
    }
}
