//! Prints every threshold as a table.

fn main() {
    println!("| threshold | value | unit | decides | source |");
    println!("|---|---|---|---|---|");
    for (table, rows) in stiction_policy::TABLES {
        for row in *rows {
            let [name, value, unit] = [row.name, row.value, row.unit];
            println!(
                "| {table}::{name} | {value} | {unit} | {} | {} |",
                row.meaning, row.source
            );
        }
    }
}
