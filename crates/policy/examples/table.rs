//! Prints every threshold as a table.

use stiction_policy::VERDICT;

fn main() {
    println!("| threshold | value | unit | decides | source |");
    println!("|---|---|---|---|---|");
    for row in VERDICT.rows() {
        println!(
            "| {}.{} | {:.3} | {} |{} | {} |",
            row.table, row.name, row.value, row.unit, row.meaning, row.source
        );
    }
}
