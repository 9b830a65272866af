//! Prints every threshold as a table, and those that mean the same and differ as another.

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

    println!("\n| means the same | thresholds |\n|---|---|");
    for (meaning, thresholds) in stiction_policy::SAME {
        let list: Vec<String> = thresholds
            .iter()
            .map(|(name, value)| format!("{name} = {value:?}"))
            .collect();
        println!("| {meaning} | {} |", list.join(", "));
    }
}
