//! What names the runs of a table, which stands before its time: path, controller and compensator.

use super::series::is_time;
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::Path;

/// Most runs that are named.
const MOST: usize = 1000;

/// The names of each run, in its order; nothing where the time is the first column.
pub fn runs(path: &Path) -> std::io::Result<Vec<Vec<String>>> {
    let mut lines = BufReader::new(File::open(path)?).lines();
    let header = lines.next().transpose()?.unwrap_or_default();
    let names = cells(&header, usize::MAX);
    let Some(before) = names.iter().position(|name| is_time(name)) else {
        return Ok(Vec::new());
    };
    let mut out: Vec<Vec<String>> = Vec::new();
    for line in lines {
        let line = line?;
        if before == 0 || out.len() == MOST {
            break;
        }
        let names = cells(&line, before);
        if out.last() != Some(&names) {
            out.push(names);
        }
    }
    Ok(out)
}

/// The first cells of a line; quotes hold commas together.
fn cells(line: &str, most: usize) -> Vec<String> {
    let mut out = vec![String::new()];
    let mut quoted = false;
    for c in line.chars() {
        match c {
            '"' => quoted = !quoted,
            ',' if !quoted && out.len() == most => break,
            ',' if !quoted => out.push(String::new()),
            c => {
                if let Some(last) = out.last_mut() {
                    last.push(c);
                }
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::runs;

    #[test]
    fn runs_are_named_by_what_stands_before_their_time() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("t.csv");
        let text = "path,compensator,time [s],x\n\"a, b\",none,0,1\n\"a, b\",none,1,1\n\"a, b\",lugre,0,1\n";
        std::fs::write(&file, text).unwrap();
        assert_eq!(runs(&file).unwrap(), [["a, b", "none"], ["a, b", "lugre"]]);
        std::fs::write(&file, "t [s],x\n0,1\n").unwrap();
        assert!(runs(&file).unwrap().is_empty());
    }
}
