//! The command that brings more logs into a batch that has too few of them to follow anything.

use crate::next::ANOTHER_LOG;
use std::path::Path;
use stiction_files::batch::{BatchFile, RESULTS};
use stiction_files::shell::{quoted, quoted_path};
use stiction_workflows::drift::least_logs;

/// What leads from a batch of too few logs to a drift: how many there have to be, the batch with them, and what follows them.
pub(crate) fn more_logs(batch: &BatchFile, dir: &Path) -> String {
    let table = quoted_path(&dir.join(RESULTS));
    // A folder or a pattern takes a log that is put there, a list one that is written there.
    let single = |input: &String| {
        let path = Path::new(input);
        path.is_file() && !stiction_files::batch::is_list(path)
    };
    let (where_to, another) = match batch.inputs.iter().find(|input| !single(input)) {
        Some(input) => (format!("put the others into {}", quoted(input)), None),
        None => (
            format!("name the others beside these, as {ANOTHER_LOG} here"),
            Some(ANOTHER_LOG),
        ),
    };
    format!(
        "{} logs of one machine are followed at least, and {} were identified: {where_to}, then\nnext: {}\nthen: stiction drift {table}\n",
        least_logs(),
        batch.identified,
        batch.command_with(dir, another)
    )
}
