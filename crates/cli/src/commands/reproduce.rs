//! `stiction reproduce`: what was published.

use super::{put, written_to};
use crate::arguments::{self, Common};
use crate::exit::Exit;
use crate::output;
use crate::progress::Bar;
use std::path::PathBuf;
use stiction_files::{check_folder_of, check_inputs};
use stiction_pages::bundle;
use stiction_workflows::Error;
use stiction_workflows::reproduce::{Budget, OwnAxis, canudas_1995, zhang_2025, zhang_2025_on};

/// Simulates what was published and writes both figures.
pub fn run(reproduce: &arguments::Reproduce, common: &Common) -> Result<Exit, Error> {
    let dir = &reproduce.out;
    check_folder_of(dir, stiction_files::reproduce_file::SCHEMA, reproduce.force)?;
    let inputs: Vec<PathBuf> = [&reproduce.model, &reproduce.axis]
        .into_iter()
        .flatten()
        .cloned()
        .collect();
    check_inputs(dir, &inputs)?;
    let mut bar = Bar::new(common.json || common.quiet);
    let budget = Budget::default();
    let outcome = match (reproduce.publication, &reproduce.model) {
        (arguments::Publication::Canudas1995, None) => canudas_1995(&mut bar),
        (arguments::Publication::Canudas1995, Some(_)) => {
            return Err(Error::Usage {
                found: "reproduce 1995 --model".into(),
                allowed: "reproduce paper --model: the experiments of 1995 are those of one block"
                    .into(),
            });
        }
        (arguments::Publication::Zhang2025, None) => zhang_2025(budget, &mut bar),
        (arguments::Publication::Zhang2025, Some(model)) => {
            let own = OwnAxis {
                axis: reproduce.axis.clone(),
                model: model.clone(),
            };
            zhang_2025_on(&own, budget, &mut bar)?
        }
    };
    bar.finish();
    let schema = stiction_files::reproduce_file::SCHEMA;
    let (dir, written) = put(&bundle::reproduction(&outcome), dir, schema)?;
    if common.json {
        output::json(&outcome.file)?;
    } else if !common.quiet {
        let text = stiction_pages::text::reproduction(&outcome.file);
        output::print(&format!("{text}{}", written_to(&dir, &written)))?;
    }
    Ok(outcome.verdict().into())
}
