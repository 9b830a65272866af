//! Addresses under which a browser opens or saves a file by itself: such a request carries no header of the page, so its
//! address carries a secret, and the cookie comes with it all the same.

use crate::held::held;
use crate::refused::Refused;
use crate::secret::secret;
use serde::Deserialize;
use std::collections::VecDeque;
use std::sync::Mutex;

/// Most addresses that are known at once; the oldest go first.
const MOST: usize = 512;

/// What an address stands for: a file or folder of the workspace.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Opened {
    pub name: String,
    pub how: How,
}

/// What a browser does with it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum How {
    /// Shows a file in a tab.
    Show,
    /// Saves a file.
    Save,
    /// Saves a folder.
    Zip,
}

/// The addresses that were given out.
#[derive(Debug, Default)]
pub struct Tickets(Mutex<VecDeque<(String, Opened)>>);

impl Tickets {
    /// The address of something; the same for the same.
    pub fn give(&self, opened: Opened) -> Result<String, Refused> {
        let mut known = held(&self.0);
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
        let known = held(&self.0);
        let mut found = known.iter().filter(|(own, _)| own == ticket);
        found.next().map(|(_, opened)| opened.clone())
    }
}
