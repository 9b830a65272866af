//! Tables of a database, by what SQLite wrote down of their making: `CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT ...)`.

/// A table: its first page, and its columns.
#[derive(Debug)]
pub(super) struct Schema {
    pub(super) root: u32,
    columns: Vec<String>,
}

impl Schema {
    /// A table of rows with a number each; `None` where the statement is of something else.
    pub(super) fn new(root: i64, statement: &str) -> Option<Self> {
        let root = u32::try_from(root).ok().filter(|&root| root > 0)?;
        let (_, list) = statement.split_once('(')?;
        let (mut columns, mut depth, mut part) = (Vec::new(), 0, String::new());
        for character in list.chars() {
            match character {
                '(' => depth += 1,
                ')' if depth == 0 => break,
                ')' => depth -= 1,
                ',' if depth == 0 => columns.push(std::mem::take(&mut part)),
                other if depth == 0 => part.push(other),
                _ => {}
            }
        }
        columns.push(part);
        let name = |column: &String| {
            let name = column.split_whitespace().next().unwrap_or("");
            name.trim_matches(['"', '`', '[', ']', '\''])
                .to_ascii_lowercase()
        };
        Some(Self {
            root,
            columns: columns.iter().map(name).collect(),
        })
    }

    /// The places of these columns; `None` where one of them is not there.
    pub(super) fn columns<const N: usize>(&self, names: [&str; N]) -> Option<[usize; N]> {
        let mut places = [0; N];
        for (place, name) in places.iter_mut().zip(names) {
            *place = self.columns.iter().position(|column| column == name)?;
        }
        Some(places)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_of_statements() {
        let statement = "CREATE TABLE topics(\n id INTEGER PRIMARY KEY,\n \"name\" TEXT NOT NULL,\n x DECIMAL(3, 4), type TEXT)";
        let schema = Schema::new(4, statement).unwrap();
        assert_eq!(schema.columns(["type", "id", "name"]), Some([3, 0, 1]));
        assert_eq!(schema.columns(["data"]), None);
        assert!(Schema::new(0, statement).is_none());
        assert!(Schema::new(2, "CREATE").is_none());
    }
}
